-- Schema 4: comparisons of two builds by `sipplab gate`. db/schema.md explains every column.
--
-- A slowdown is the head's time over the base's, minus one: 0.03 is 3 % slower, -0.03 faster.

CREATE TABLE gate_run (
  id                INTEGER PRIMARY KEY,
  uuid              TEXT    NOT NULL UNIQUE CHECK (length(uuid) = 36),
  started_utc       TEXT    NOT NULL,
  kind              TEXT    NOT NULL CHECK (kind IN ('comparison', 'calibration')),
  suite             TEXT    NOT NULL,
  method            INTEGER NOT NULL,
  machine_id        INTEGER NOT NULL REFERENCES machine,
  base_build_id     INTEGER NOT NULL REFERENCES build,
  head_build_id     INTEGER NOT NULL REFERENCES build,
  base_commit_id    INTEGER REFERENCES commit_,
  head_commit_id    INTEGER REFERENCES commit_,
  seed              INTEGER NOT NULL,
  pair_seconds      REAL    NOT NULL CHECK (pair_seconds > 0),
  tolerance         REAL    NOT NULL CHECK (tolerance > 0),
  injected_slowdown REAL    NOT NULL CHECK (injected_slowdown >= 0),
  wall_time_ns      INTEGER NOT NULL CHECK (wall_time_ns >= 0),
  compared          INTEGER NOT NULL CHECK (compared >= 0),
  differing         INTEGER NOT NULL CHECK (differing BETWEEN 0 AND compared),
  verdict           TEXT    NOT NULL CHECK (verdict IN ('regressed', 'equivalent', 'inconclusive')),
  reason            TEXT    NOT NULL,
  origin            TEXT    NOT NULL DEFAULT ''
) STRICT;
CREATE INDEX gate_run_by_machine ON gate_run (machine_id, suite, started_utc);
CREATE INDEX gate_run_by_start ON gate_run (started_utc);

-- A cell without a case is all of them together.
CREATE TABLE gate_cell (
  id               INTEGER PRIMARY KEY,
  gate_run_id      INTEGER NOT NULL REFERENCES gate_run,
  position         INTEGER NOT NULL CHECK (position >= 0),
  case_id          INTEGER REFERENCES case_,
  slowdown         REAL    NOT NULL CHECK (slowdown > -1),
  p_value          REAL    NOT NULL CHECK (p_value BETWEEN 0 AND 1),
  confirm_slowdown REAL             CHECK (confirm_slowdown > -1),
  confirm_p_value  REAL             CHECK (confirm_p_value BETWEEN 0 AND 1),
  at_most          REAL             CHECK (at_most > -1),
  noise            REAL    NOT NULL CHECK (noise >= 0),
  effect_floor     REAL    NOT NULL CHECK (effect_floor >= 0),
  detectable       REAL             CHECK (detectable > 0),
  verdict          TEXT    NOT NULL CHECK (verdict IN ('regressed', 'equivalent', 'inconclusive')),
  CHECK ((confirm_slowdown IS NULL) = (confirm_p_value IS NULL)),
  UNIQUE (gate_run_id, position)
) STRICT;

-- One number for each pair of processes and cell.
CREATE TABLE gate_pair (
  gate_cell_id INTEGER NOT NULL REFERENCES gate_cell,
  stage        INTEGER NOT NULL CHECK (stage IN (1, 2)),
  pair         INTEGER NOT NULL CHECK (pair >= 0),
  slowdown     REAL    NOT NULL CHECK (slowdown > -1),
  PRIMARY KEY (gate_cell_id, stage, pair)
) STRICT, WITHOUT ROWID;

-- What the exact tier found.
CREATE TABLE gate_difference (
  gate_run_id INTEGER NOT NULL REFERENCES gate_run,
  case_id     INTEGER NOT NULL REFERENCES case_,
  instance_id INTEGER NOT NULL REFERENCES instance,
  what        TEXT    NOT NULL CHECK (what IN ('status', 'validity', 'plan', 'work', 'repetition')),
  base        TEXT    NOT NULL,
  head        TEXT    NOT NULL,
  PRIMARY KEY (gate_run_id, case_id, instance_id, what)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_gate_runs AS
SELECT
  gate_run.uuid              AS gate_run,
  gate_run.started_utc       AS started_utc,
  gate_run.kind              AS kind,
  gate_run.verdict           AS verdict,
  gate_run.reason            AS reason,
  gate_run.suite             AS suite,
  gate_run.method            AS method,
  machine.fingerprint        AS machine,
  machine.host               AS host,
  base_commit.hash           AS base_commit_hash,
  head_commit.hash           AS head_commit_hash,
  head_commit.subject        AS head_commit_subject,
  head_commit.ancestor_count AS head_ancestor_count,
  base_build.binary_hash     AS base_binary_hash,
  head_build.binary_hash     AS head_binary_hash,
  base_build.compiler || ' ' || base_build.compiler_version AS base_compiler,
  head_build.compiler || ' ' || head_build.compiler_version AS head_compiler,
  head_build.dirty           AS head_dirty,
  gate_run.seed              AS seed,
  gate_run.pair_seconds      AS pair_seconds,
  gate_run.tolerance         AS tolerance,
  gate_run.injected_slowdown AS injected_slowdown,
  gate_run.wall_time_ns / 1e9 AS wall_time_s,
  gate_run.compared          AS compared,
  gate_run.differing         AS differing,
  (SELECT gate_cell.slowdown FROM gate_cell
    WHERE gate_cell.gate_run_id = gate_run.id AND gate_cell.case_id IS NULL) AS slowdown,
  (SELECT gate_cell.detectable FROM gate_cell
    WHERE gate_cell.gate_run_id = gate_run.id AND gate_cell.case_id IS NULL) AS detectable,
  gate_run.origin            AS origin
FROM gate_run
JOIN machine ON machine.id = gate_run.machine_id
JOIN build AS base_build ON base_build.id = gate_run.base_build_id
JOIN build AS head_build ON head_build.id = gate_run.head_build_id
LEFT JOIN commit_ AS base_commit ON base_commit.id = gate_run.base_commit_id
LEFT JOIN commit_ AS head_commit ON head_commit.id = gate_run.head_commit_id;

CREATE VIEW v_gate_cells AS
SELECT
  gate_run.uuid              AS gate_run,
  gate_run.started_utc       AS started_utc,
  gate_run.kind              AS kind,
  gate_cell.case_id          AS case_id,
  case_.environment          AS environment,
  case_.robots               AS robots,
  case_.ssi_s                AS ssi_s,
  case_.reschedule           AS reschedule,
  gate_cell.slowdown         AS slowdown,
  gate_cell.p_value          AS p_value,
  gate_cell.confirm_slowdown AS confirm_slowdown,
  gate_cell.confirm_p_value  AS confirm_p_value,
  gate_cell.at_most          AS at_most,
  gate_cell.noise            AS noise,
  gate_cell.effect_floor     AS effect_floor,
  gate_cell.detectable       AS detectable,
  gate_cell.verdict          AS verdict,
  (SELECT count(*) FROM gate_pair WHERE gate_pair.gate_cell_id = gate_cell.id) AS pairs
FROM gate_cell
JOIN gate_run ON gate_run.id = gate_cell.gate_run_id
LEFT JOIN case_ ON case_.id = gate_cell.case_id;

CREATE VIEW v_gate_differences AS
SELECT
  gate_run.uuid         AS gate_run,
  gate_run.started_utc  AS started_utc,
  gate_difference.what  AS what,
  case_.environment     AS environment,
  case_.robots          AS robots,
  case_.ssi_s           AS ssi_s,
  case_.reschedule      AS reschedule,
  instance.name         AS instance,
  instance.content_hash AS instance_hash,
  gate_difference.base  AS base,
  gate_difference.head  AS head,
  gate_difference.case_id AS case_id
FROM gate_difference
JOIN gate_run ON gate_run.id = gate_difference.gate_run_id
JOIN case_ ON case_.id = gate_difference.case_id
JOIN instance ON instance.id = gate_difference.instance_id;
