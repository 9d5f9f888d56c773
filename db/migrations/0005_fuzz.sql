-- Schema 5: what fuzzing did and found. One row for each time that one target ran, and
-- one for each finding, which has a life of its own. db/schema.md explains every column.

CREATE TABLE fuzz_run (
  id                INTEGER PRIMARY KEY,
  uuid              TEXT    NOT NULL UNIQUE CHECK (length(uuid) = 36),
  campaign          TEXT    NOT NULL CHECK (length(campaign) = 36),
  target            TEXT    NOT NULL CHECK (target <> ''),
  mode              TEXT    NOT NULL CHECK (mode IN ('smoke', 'for', 'nightly')),
  started_utc       TEXT    NOT NULL,
  wall_time_ns      INTEGER NOT NULL CHECK (wall_time_ns >= 0),
  cpu_time_ns       INTEGER NOT NULL CHECK (cpu_time_ns >= 0),
  status            TEXT    NOT NULL CHECK (status IN ('clean', 'findings', 'broken')),
  seed              INTEGER NOT NULL,
  budget_executions INTEGER CHECK (budget_executions > 0),
  budget_s          REAL    CHECK (budget_s > 0),
  workers           INTEGER NOT NULL CHECK (workers > 0),
  target_hash       TEXT    NOT NULL,
  commit_id         INTEGER REFERENCES commit_,
  machine_id        INTEGER NOT NULL REFERENCES machine,
  build_id          INTEGER NOT NULL REFERENCES build,
  branch            TEXT    NOT NULL,
  executions        INTEGER NOT NULL CHECK (executions >= 0),
  edges             INTEGER NOT NULL CHECK (edges >= 0),
  features          INTEGER NOT NULL CHECK (features >= 0),
  corpus_files      INTEGER NOT NULL CHECK (corpus_files >= 0),
  corpus_bytes      INTEGER NOT NULL CHECK (corpus_bytes >= 0),
  peak_memory_bytes INTEGER NOT NULL CHECK (peak_memory_bytes >= 0),
  slowest_input_s   INTEGER NOT NULL CHECK (slowest_input_s >= 0),
  crashes           INTEGER NOT NULL CHECK (crashes >= 0),
  timeouts          INTEGER NOT NULL CHECK (timeouts >= 0),
  ooms              INTEGER NOT NULL CHECK (ooms >= 0),
  leaks             INTEGER NOT NULL CHECK (leaks >= 0),
  origin            TEXT    NOT NULL DEFAULT ''
) STRICT;
CREATE INDEX fuzz_run_by_target ON fuzz_run (target, started_utc);
CREATE INDEX fuzz_run_by_campaign ON fuzz_run (campaign);

CREATE TABLE fuzz_snapshot (
  fuzz_run_id       INTEGER NOT NULL REFERENCES fuzz_run,
  executions        INTEGER NOT NULL CHECK (executions >= 0),
  elapsed_ns        INTEGER NOT NULL CHECK (elapsed_ns >= 0),
  edges             INTEGER NOT NULL CHECK (edges >= 0),
  features          INTEGER NOT NULL CHECK (features >= 0),
  corpus_files      INTEGER NOT NULL CHECK (corpus_files >= 0),
  memory_bytes      INTEGER NOT NULL CHECK (memory_bytes >= 0),
  PRIMARY KEY (fuzz_run_id, executions)
) STRICT, WITHOUT ROWID;

CREATE TABLE fuzz_count (
  fuzz_run_id       INTEGER NOT NULL REFERENCES fuzz_run,
  kind              TEXT    NOT NULL CHECK (kind IN ('event', 'claim')),
  name              TEXT    NOT NULL,
  count             INTEGER NOT NULL CHECK (count > 0),
  PRIMARY KEY (fuzz_run_id, kind, name)
) STRICT, WITHOUT ROWID;

CREATE TABLE fuzz_coverage (
  campaign          TEXT    NOT NULL CHECK (length(campaign) = 36),
  file              TEXT    NOT NULL,
  lines             INTEGER NOT NULL CHECK (lines >= 0),
  covered_lines     INTEGER NOT NULL CHECK (covered_lines BETWEEN 0 AND lines),
  PRIMARY KEY (campaign, file)
) STRICT, WITHOUT ROWID;

CREATE TABLE finding (
  id                INTEGER PRIMARY KEY,
  target            TEXT    NOT NULL,
  signature         TEXT    NOT NULL CHECK (signature <> ''),
  kind              TEXT    NOT NULL CHECK (kind IN ('claim', 'invariant', 'sanitizer', 'crash', 'timeout',
                                                     'memory', 'leak', 'flaky')),
  claim             TEXT    NOT NULL,
  frames            TEXT    NOT NULL,
  message           TEXT    NOT NULL,
  state             TEXT    NOT NULL CHECK (state IN ('new', 'reproduced', 'fixed', 'regressed')),
  first_utc         TEXT    NOT NULL,
  last_utc          TEXT    NOT NULL,
  first_commit_id   INTEGER REFERENCES commit_,
  last_commit_id    INTEGER REFERENCES commit_,
  fixed_commit_id   INTEGER REFERENCES commit_,
  times_found       INTEGER NOT NULL CHECK (times_found > 0),
  input             BLOB    NOT NULL,
  minimal           BLOB    NOT NULL,
  robots            INTEGER CHECK (robots >= 0),
  cells             INTEGER CHECK (cells >= 0),
  origin            TEXT    NOT NULL DEFAULT '',
  UNIQUE (target, signature)
) STRICT;

-- Known by what happened when, so that the lives of a finding in two files merge into one.
CREATE TABLE finding_event (
  finding_id        INTEGER NOT NULL REFERENCES finding,
  happened_utc      TEXT    NOT NULL,
  event             TEXT    NOT NULL CHECK (event IN ('found', 'reproduced', 'fixed', 'regressed')),
  commit_id         INTEGER REFERENCES commit_,
  fuzz_run_id       INTEGER REFERENCES fuzz_run,
  PRIMARY KEY (finding_id, happened_utc, event)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_fuzz_runs AS
SELECT
  fuzz_run.id                AS id,
  fuzz_run.uuid              AS fuzz_run,
  fuzz_run.campaign          AS campaign,
  fuzz_run.target            AS target,
  fuzz_run.mode              AS mode,
  fuzz_run.started_utc       AS started_utc,
  fuzz_run.wall_time_ns / 1e9 AS wall_time_s,
  fuzz_run.cpu_time_ns / 1e9 AS cpu_time_s,
  fuzz_run.status            AS status,
  fuzz_run.seed              AS seed,
  fuzz_run.budget_executions AS budget_executions,
  fuzz_run.budget_s          AS budget_s,
  fuzz_run.workers           AS workers,
  fuzz_run.executions        AS executions,
  CASE WHEN fuzz_run.wall_time_ns > 0 THEN fuzz_run.executions * 1e9 / fuzz_run.wall_time_ns END
                             AS executions_per_s,
  CASE WHEN fuzz_run.cpu_time_ns > 0 THEN fuzz_run.executions * 1e9 / fuzz_run.cpu_time_ns END
                             AS executions_per_cpu_s,
  fuzz_run.edges             AS edges,
  fuzz_run.features          AS features,
  fuzz_run.corpus_files      AS corpus_files,
  fuzz_run.corpus_bytes      AS corpus_bytes,
  fuzz_run.peak_memory_bytes AS peak_memory_bytes,
  fuzz_run.slowest_input_s   AS slowest_input_s,
  fuzz_run.crashes           AS crashes,
  fuzz_run.timeouts          AS timeouts,
  fuzz_run.ooms              AS ooms,
  fuzz_run.leaks             AS leaks,
  fuzz_run.target_hash       AS target_hash,
  commit_.hash               AS commit_hash,
  commit_.subject            AS commit_subject,
  commit_.ancestor_count     AS ancestor_count,
  fuzz_run.branch            AS branch,
  build.dirty                AS dirty,
  machine.fingerprint        AS machine,
  machine.host               AS host,
  fuzz_run.origin            AS origin
FROM fuzz_run
JOIN machine ON machine.id = fuzz_run.machine_id
JOIN build ON build.id = fuzz_run.build_id
LEFT JOIN commit_ ON commit_.id = fuzz_run.commit_id;

CREATE VIEW v_fuzz_counts AS
SELECT
  fuzz_run.id          AS id,
  fuzz_run.uuid        AS fuzz_run,
  fuzz_run.target      AS target,
  fuzz_run.mode        AS mode,
  fuzz_run.started_utc AS started_utc,
  fuzz_count.kind      AS kind,
  fuzz_count.name      AS name,
  fuzz_count.count     AS count,
  CAST(fuzz_count.count AS REAL) / inputs.count AS per_input
FROM fuzz_count
JOIN fuzz_run ON fuzz_run.id = fuzz_count.fuzz_run_id
LEFT JOIN fuzz_count AS inputs
  ON inputs.fuzz_run_id = fuzz_run.id AND inputs.kind = 'event' AND inputs.name = 'inputs';

-- Lines that fuzzing alone reaches, by folder below planner/, one row for each campaign that measured.
CREATE VIEW v_fuzz_coverage AS
WITH measured AS (
  SELECT campaign, min(started_utc) AS started_utc, min(commit_id) AS commit_id FROM fuzz_run GROUP BY campaign
), rooms AS (
  SELECT campaign, lines, covered_lines,
         substr(file, 1, instr(file, '/') + instr(substr(file, instr(file, '/') + 1), '/') - 1) AS room
  FROM fuzz_coverage
)
SELECT
  rooms.campaign          AS campaign,
  measured.started_utc    AS started_utc,
  commit_.hash            AS commit_hash,
  commit_.ancestor_count  AS ancestor_count,
  rooms.room              AS room,
  sum(rooms.lines)        AS lines,
  sum(rooms.covered_lines) AS covered_lines,
  CAST(sum(rooms.covered_lines) AS REAL) / sum(rooms.lines) AS share
FROM rooms
JOIN measured ON measured.campaign = rooms.campaign
LEFT JOIN commit_ ON commit_.id = measured.commit_id
GROUP BY rooms.campaign, rooms.room;

CREATE VIEW v_findings AS
SELECT
  finding.id          AS id,
  finding.target      AS target,
  finding.state       AS state,
  finding.kind        AS kind,
  finding.claim       AS claim,
  finding.frames      AS frames,
  finding.signature   AS signature,
  finding.message     AS message,
  finding.first_utc   AS first_utc,
  finding.last_utc    AS last_utc,
  first_commit.hash   AS first_commit,
  last_commit.hash    AS last_commit,
  fixed_commit.hash   AS fixed_commit,
  finding.times_found AS times_found,
  length(finding.input)   AS input_bytes,
  length(finding.minimal) AS minimal_bytes,
  finding.minimal     AS minimal,
  finding.robots      AS robots,
  finding.cells       AS cells,
  finding.origin      AS origin
FROM finding
LEFT JOIN commit_ AS first_commit ON first_commit.id = finding.first_commit_id
LEFT JOIN commit_ AS last_commit ON last_commit.id = finding.last_commit_id
LEFT JOIN commit_ AS fixed_commit ON fixed_commit.id = finding.fixed_commit_id;
