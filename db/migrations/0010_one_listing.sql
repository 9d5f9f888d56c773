-- Schema 10: the table run lists everything that ran, whatever its kind: sweeps, reports of other
-- programs, checks of properties, fuzzing and comparisons by the gate. It says what, when, on
-- which machine, from which build and commit, how it ended, and whether it is excluded. What only one kind
-- has is in a table of that kind, one row for each run. db/schema.md explains every column.

DROP VIEW v_runs;
DROP VIEW v_commits;
DROP VIEW v_property_latest;
DROP VIEW v_property_runs;
DROP VIEW v_property_classes;
DROP VIEW v_property_totals;
DROP VIEW v_gate_runs;
DROP VIEW v_gate_cells;
DROP VIEW v_gate_differences;
DROP VIEW v_fuzz_runs;
DROP VIEW v_fuzz_counts;
DROP VIEW v_fuzz_coverage;

ALTER TABLE run ADD COLUMN kind TEXT NOT NULL DEFAULT 'sweep'
  CHECK (kind IN ('sweep', 'report', 'property', 'fuzz', 'gate'));
ALTER TABLE run ADD COLUMN outcome TEXT NOT NULL DEFAULT ''
  CHECK (CASE kind WHEN 'property' THEN outcome IN ('passed', 'failed', 'gave_up', 'crashed')
                   WHEN 'fuzz' THEN outcome IN ('clean', 'findings', 'broken')
                   WHEN 'gate' THEN outcome IN ('regressed', 'equivalent', 'inconclusive')
                   ELSE outcome = '' END);
CREATE INDEX run_by_kind ON run (kind, started_utc);
-- A sweep has a process that writes it, an imported report has none.
UPDATE run SET kind = 'report' WHERE writer = '' AND NOT EXISTS (SELECT 1 FROM cell WHERE cell.run_id = run.id);

-- ---------------------------------------------------------------------------------
-- Properties.

CREATE TABLE before AS SELECT * FROM property_run;
DROP TABLE property_run;
CREATE TABLE property_run (
  id             INTEGER PRIMARY KEY,
  run_id         INTEGER NOT NULL UNIQUE REFERENCES run,
  title          TEXT    NOT NULL CHECK (title <> ''),
  mutant         TEXT    NOT NULL,
  max_success    INTEGER NOT NULL CHECK (max_success >= 0),
  cases          INTEGER NOT NULL CHECK (cases >= 0),
  discards       INTEGER NOT NULL CHECK (discards >= 0),
  shrinks        INTEGER NOT NULL CHECK (shrinks >= 0),
  shrink_tries   INTEGER NOT NULL CHECK (shrink_tries >= shrinks),
  wall_time_ns   INTEGER NOT NULL CHECK (wall_time_ns >= 0),
  message        TEXT,
  reproduce      TEXT,
  counterexample TEXT,
  plan_case      TEXT,
  case_robots    INTEGER CHECK (case_robots >= 0),
  case_cells     INTEGER CHECK (case_cells >= 0)
) STRICT;
CREATE INDEX property_run_by_title ON property_run (title);

INSERT INTO run (uuid, kind, suite, started_utc, ended_utc, status, outcome, commit_id, machine_id, build_id,
                 branch, command_line, options, seed, time_limit_s, writer, origin)
SELECT uuid, 'property', room, started_utc,
       ifnull(strftime('%Y-%m-%dT%H:%M:%fZ', started_utc, printf('+%.3f seconds', wall_time_ns / 1e9)), started_utc),
       'finished', status, commit_id, machine_id, build_id, branch, '', '', seed, 9e999, '', origin
FROM before ORDER BY id;
INSERT INTO property_run (id, run_id, title, mutant, max_success, cases, discards, shrinks, shrink_tries,
                          wall_time_ns, message, reproduce, counterexample, plan_case, case_robots, case_cells)
SELECT before.id, run.id, title, mutant, max_success, cases, discards, shrinks, shrink_tries,
       wall_time_ns, message, reproduce, counterexample, plan_case, case_robots, case_cells
FROM before JOIN run ON run.uuid = before.uuid;
DROP TABLE before;

-- ---------------------------------------------------------------------------------
-- The gate. A run's build and commit are the head's.

CREATE TABLE before AS SELECT * FROM gate_run;
DROP TABLE gate_run;
CREATE TABLE gate_run (
  id                INTEGER PRIMARY KEY,
  run_id            INTEGER NOT NULL UNIQUE REFERENCES run,
  kind              TEXT    NOT NULL CHECK (kind IN ('comparison', 'calibration')),
  method            INTEGER NOT NULL,
  base_build_id     INTEGER NOT NULL REFERENCES build,
  base_commit_id    INTEGER REFERENCES commit_,
  pair_seconds      REAL    NOT NULL CHECK (pair_seconds > 0),
  tolerance         REAL    NOT NULL CHECK (tolerance > 0),
  injected_slowdown REAL    NOT NULL CHECK (injected_slowdown >= 0),
  wall_time_ns      INTEGER NOT NULL CHECK (wall_time_ns >= 0),
  compared          INTEGER NOT NULL CHECK (compared >= 0),
  differing         INTEGER NOT NULL CHECK (differing BETWEEN 0 AND compared),
  reason            TEXT    NOT NULL
) STRICT;

INSERT INTO run (uuid, kind, suite, started_utc, ended_utc, status, outcome, commit_id, machine_id, build_id,
                 branch, command_line, options, seed, time_limit_s, writer, origin)
SELECT uuid, 'gate', suite, started_utc,
       ifnull(strftime('%Y-%m-%dT%H:%M:%fZ', started_utc, printf('+%.3f seconds', wall_time_ns / 1e9)), started_utc),
       'finished', verdict, head_commit_id, machine_id, head_build_id, '', '', '', seed, 9e999, '', origin
FROM before ORDER BY id;
INSERT INTO gate_run (id, run_id, kind, method, base_build_id, base_commit_id, pair_seconds, tolerance,
                      injected_slowdown, wall_time_ns, compared, differing, reason)
SELECT before.id, run.id, before.kind, method, base_build_id, base_commit_id, pair_seconds, tolerance,
       injected_slowdown, wall_time_ns, compared, differing, reason
FROM before JOIN run ON run.uuid = before.uuid;
DROP TABLE before;

-- ---------------------------------------------------------------------------------
-- Fuzzing. A run's suite is the target.

CREATE TABLE before AS SELECT * FROM fuzz_run;
DROP TABLE fuzz_run;
CREATE TABLE fuzz_run (
  id                INTEGER PRIMARY KEY,
  run_id            INTEGER NOT NULL UNIQUE REFERENCES run,
  campaign          TEXT    NOT NULL CHECK (length(campaign) = 36),
  mode              TEXT    NOT NULL CHECK (mode IN ('smoke', 'for', 'nightly')),
  wall_time_ns      INTEGER NOT NULL CHECK (wall_time_ns >= 0),
  cpu_time_ns       INTEGER NOT NULL CHECK (cpu_time_ns >= 0),
  budget_executions INTEGER CHECK (budget_executions > 0),
  budget_s          REAL    CHECK (budget_s > 0),
  workers           INTEGER NOT NULL CHECK (workers > 0),
  target_hash       TEXT    NOT NULL,
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
  leaks             INTEGER NOT NULL CHECK (leaks >= 0)
) STRICT;
CREATE INDEX fuzz_run_by_campaign ON fuzz_run (campaign);

INSERT INTO run (uuid, kind, suite, started_utc, ended_utc, status, outcome, commit_id, machine_id, build_id,
                 branch, command_line, options, seed, time_limit_s, writer, origin)
SELECT uuid, 'fuzz', target, started_utc,
       ifnull(strftime('%Y-%m-%dT%H:%M:%fZ', started_utc, printf('+%.3f seconds', wall_time_ns / 1e9)), started_utc),
       'finished', status, commit_id, machine_id, build_id, branch, '', '', seed, 9e999, '', origin
FROM before ORDER BY id;
INSERT INTO fuzz_run (id, run_id, campaign, mode, wall_time_ns, cpu_time_ns, budget_executions, budget_s, workers,
                      target_hash, executions, edges, features, corpus_files, corpus_bytes, peak_memory_bytes,
                      slowest_input_s, crashes, timeouts, ooms, leaks)
SELECT before.id, run.id, campaign, mode, wall_time_ns, cpu_time_ns, budget_executions, budget_s, workers,
       target_hash, executions, edges, features, corpus_files, corpus_bytes, peak_memory_bytes,
       slowest_input_s, crashes, timeouts, ooms, leaks
FROM before JOIN run ON run.uuid = before.uuid;
DROP TABLE before;

-- ---------------------------------------------------------------------------------
-- The views as they were, over the one table, with new columns at their ends.

CREATE VIEW v_runs AS
SELECT
  run.uuid                    AS run,
  run.suite                   AS suite,
  run.status                  AS status,
  run.started_utc             AS started_utc,
  run.ended_utc               AS ended_utc,
  commit_.hash                AS commit_hash,
  commit_.subject             AS commit_subject,
  commit_.committed_utc       AS committed_utc,
  commit_.ancestor_count      AS ancestor_count,
  run.branch                  AS branch,
  build.dirty                 AS dirty,
  machine.fingerprint         AS machine,
  machine.host                AS host,
  machine.cpu_model           AS cpu_model,
  machine.cores               AS cores,
  machine.memory_bytes        AS memory_bytes,
  machine.kernel              AS kernel,
  build.compiler              AS compiler,
  build.compiler_version      AS compiler_version,
  build.flags                 AS flags,
  build.build_type            AS build_type,
  build.assertions            AS assertions,
  build.sanitizers            AS sanitizers,
  build.binary_hash           AS binary_hash,
  run.command_line            AS command_line,
  run.options                 AS options,
  run.seed                    AS seed,
  run.time_limit_s            AS time_limit_s,
  run.excluded_reason         AS excluded_reason,
  run.excluded_utc            AS excluded_utc,
  run.origin                  AS origin,
  (SELECT count(*) FROM cell WHERE cell.run_id = run.id) AS cases,
  (SELECT ifnull(sum(cell.result_count), 0) FROM cell WHERE cell.run_id = run.id) AS results,
  (SELECT ifnull(sum(cell_summary.solved), 0) FROM cell JOIN cell_summary USING (case_id, run_id)
    WHERE cell.run_id = run.id) AS solved,
  (SELECT ifnull(sum(cell_summary.invalid), 0) FROM cell JOIN cell_summary USING (case_id, run_id)
    WHERE cell.run_id = run.id) AS invalid,
  run.included_utc            AS included_utc,
  run.shard                   AS shard,
  (SELECT count(*) FROM measurement WHERE measurement.run_id = run.id) AS measurements,
  run.kind                    AS kind,
  run.outcome                 AS outcome
FROM run
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;

CREATE VIEW v_commits AS
SELECT
  commit_.hash           AS commit_hash,
  commit_.subject        AS subject,
  commit_.committed_utc  AS committed_utc,
  commit_.ancestor_count AS ancestor_count,
  (SELECT group_concat(parent_hash, ' ')
     FROM (SELECT parent_hash FROM commit_parent WHERE commit_id = commit_.id ORDER BY position)) AS parents,
  (SELECT count(*) FROM run WHERE run.commit_id = commit_.id AND run.kind IN ('sweep', 'report')
    AND run.excluded_reason IS NULL) AS runs,
  (SELECT count(*) FROM run WHERE run.commit_id = commit_.id AND run.kind = 'property') AS property_runs
FROM commit_;

CREATE VIEW v_property_runs AS
SELECT
  property_run.id             AS id,
  run.uuid                    AS property_run,
  run.started_utc             AS started_utc,
  run.suite                   AS room,
  property_run.title          AS title,
  property_run.mutant         AS mutant,
  run.outcome                 AS status,
  property_run.cases          AS cases,
  property_run.discards       AS discards,
  property_run.shrinks        AS shrinks,
  property_run.shrink_tries   AS shrink_tries,
  property_run.wall_time_ns / 1e9 AS wall_time_s,
  run.seed                    AS seed,
  property_run.max_success    AS max_success,
  property_run.message        AS message,
  property_run.reproduce      AS reproduce,
  property_run.counterexample AS counterexample,
  property_run.plan_case      AS plan_case,
  property_run.case_robots    AS case_robots,
  property_run.case_cells     AS case_cells,
  commit_.hash                AS commit_hash,
  commit_.subject             AS commit_subject,
  commit_.committed_utc       AS committed_utc,
  commit_.ancestor_count      AS ancestor_count,
  run.branch                  AS branch,
  build.dirty                 AS dirty,
  machine.fingerprint         AS machine,
  machine.host                AS host,
  build.compiler              AS compiler,
  build.compiler_version      AS compiler_version,
  build.flags                 AS flags,
  build.build_type            AS build_type,
  build.assertions            AS assertions,
  build.sanitizers            AS sanitizers,
  run.origin                  AS origin,
  run.excluded_reason         AS excluded_reason
FROM property_run
JOIN run ON run.id = property_run.run_id
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;

-- Where each property stands: its newest run. Planted bugs and excluded runs are left out.
CREATE VIEW v_property_latest AS
SELECT * FROM v_property_runs
WHERE id IN (SELECT id FROM (SELECT property_run.id AS id, max(run.started_utc || printf(' %020d', property_run.id))
                               FROM property_run JOIN run ON run.id = property_run.run_id
                              WHERE property_run.mutant = '' AND run.excluded_reason IS NULL
                              GROUP BY run.suite, property_run.title));

CREATE VIEW v_property_classes AS
SELECT
  property_run.id             AS id,
  run.uuid                    AS property_run,
  run.started_utc             AS started_utc,
  run.suite                   AS room,
  property_run.title          AS title,
  property_run.mutant         AS mutant,
  property_class.class     AS class,
  property_class.cases     AS cases,
  CAST(property_class.cases AS REAL) / property_run.cases AS share
FROM property_class
JOIN property_run ON property_run.id = property_class.property_run_id
JOIN run ON run.id = property_run.run_id;

-- All runs of a property at one commit. Planted bugs and excluded runs are left out.
CREATE VIEW v_property_totals AS
SELECT
  commit_.hash                AS commit_hash,
  commit_.ancestor_count      AS ancestor_count,
  run.suite                   AS room,
  property_run.title          AS title,
  count(*)                    AS runs,
  sum(property_run.cases)     AS cases,
  sum(property_run.discards)  AS discards,
  sum(run.outcome = 'failed')  AS failed,
  sum(run.outcome = 'gave_up') AS gave_up,
  sum(property_run.wall_time_ns) / 1e9 AS wall_time_s,
  min(run.started_utc) AS first_utc,
  max(run.started_utc) AS last_utc,
  sum(run.outcome = 'crashed') AS crashed
FROM property_run
JOIN run ON run.id = property_run.run_id
LEFT JOIN commit_ ON commit_.id = run.commit_id
WHERE property_run.mutant = '' AND run.excluded_reason IS NULL
GROUP BY commit_.id, run.suite, property_run.title;

CREATE VIEW v_gate_runs AS
SELECT
  run.uuid                    AS gate_run,
  run.started_utc             AS started_utc,
  gate_run.kind               AS kind,
  run.outcome                 AS verdict,
  gate_run.reason             AS reason,
  run.suite                   AS suite,
  gate_run.method             AS method,
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
  run.seed                    AS seed,
  gate_run.pair_seconds       AS pair_seconds,
  gate_run.tolerance          AS tolerance,
  gate_run.injected_slowdown  AS injected_slowdown,
  gate_run.wall_time_ns / 1e9 AS wall_time_s,
  gate_run.compared           AS compared,
  gate_run.differing          AS differing,
  (SELECT gate_cell.slowdown FROM gate_cell
    WHERE gate_cell.gate_run_id = gate_run.id AND gate_cell.case_id IS NULL) AS slowdown,
  (SELECT gate_cell.detectable FROM gate_cell
    WHERE gate_cell.gate_run_id = gate_run.id AND gate_cell.case_id IS NULL) AS detectable,
  run.origin                  AS origin,
  run.excluded_reason         AS excluded_reason
FROM gate_run
JOIN run ON run.id = gate_run.run_id
JOIN machine ON machine.id = run.machine_id
JOIN build AS base_build ON base_build.id = gate_run.base_build_id
JOIN build AS head_build ON head_build.id = run.build_id
LEFT JOIN commit_ AS base_commit ON base_commit.id = gate_run.base_commit_id
LEFT JOIN commit_ AS head_commit ON head_commit.id = run.commit_id;

CREATE VIEW v_gate_cells AS
SELECT
  run.uuid                    AS gate_run,
  run.started_utc             AS started_utc,
  gate_run.kind               AS kind,
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
JOIN run ON run.id = gate_run.run_id
LEFT JOIN case_ ON case_.id = gate_cell.case_id;

CREATE VIEW v_gate_differences AS
SELECT
  run.uuid                    AS gate_run,
  run.started_utc             AS started_utc,
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
JOIN run ON run.id = gate_run.run_id
JOIN case_ ON case_.id = gate_difference.case_id
JOIN instance ON instance.id = gate_difference.instance_id;

CREATE VIEW v_fuzz_runs AS
SELECT
  fuzz_run.id                 AS id,
  run.uuid                    AS fuzz_run,
  fuzz_run.campaign           AS campaign,
  run.suite                   AS target,
  fuzz_run.mode               AS mode,
  run.started_utc             AS started_utc,
  fuzz_run.wall_time_ns / 1e9 AS wall_time_s,
  fuzz_run.cpu_time_ns / 1e9 AS cpu_time_s,
  run.outcome                 AS status,
  run.seed                    AS seed,
  fuzz_run.budget_executions  AS budget_executions,
  fuzz_run.budget_s           AS budget_s,
  fuzz_run.workers            AS workers,
  fuzz_run.executions         AS executions,
  CASE WHEN fuzz_run.wall_time_ns > 0 THEN fuzz_run.executions * 1e9 / fuzz_run.wall_time_ns END
                             AS executions_per_s,
  CASE WHEN fuzz_run.cpu_time_ns > 0 THEN fuzz_run.executions * 1e9 / fuzz_run.cpu_time_ns END
                             AS executions_per_cpu_s,
  fuzz_run.edges              AS edges,
  fuzz_run.features           AS features,
  fuzz_run.corpus_files       AS corpus_files,
  fuzz_run.corpus_bytes       AS corpus_bytes,
  fuzz_run.peak_memory_bytes  AS peak_memory_bytes,
  fuzz_run.slowest_input_s    AS slowest_input_s,
  fuzz_run.crashes            AS crashes,
  fuzz_run.timeouts           AS timeouts,
  fuzz_run.ooms               AS ooms,
  fuzz_run.leaks              AS leaks,
  fuzz_run.target_hash        AS target_hash,
  commit_.hash               AS commit_hash,
  commit_.subject            AS commit_subject,
  commit_.ancestor_count     AS ancestor_count,
  run.branch                  AS branch,
  build.dirty                AS dirty,
  machine.fingerprint        AS machine,
  machine.host               AS host,
  run.origin                  AS origin,
  run.excluded_reason         AS excluded_reason
FROM fuzz_run
JOIN run ON run.id = fuzz_run.run_id
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;

CREATE VIEW v_fuzz_counts AS
SELECT
  fuzz_run.id                 AS id,
  run.uuid                    AS fuzz_run,
  run.suite                   AS target,
  fuzz_run.mode               AS mode,
  run.started_utc             AS started_utc,
  fuzz_count.kind      AS kind,
  fuzz_count.name      AS name,
  fuzz_count.count     AS count,
  CAST(fuzz_count.count AS REAL) / inputs.count AS per_input
FROM fuzz_count
JOIN fuzz_run ON fuzz_run.id = fuzz_count.fuzz_run_id
JOIN run ON run.id = fuzz_run.run_id
LEFT JOIN fuzz_count AS inputs
  ON inputs.fuzz_run_id = fuzz_run.id AND inputs.kind = 'event' AND inputs.name = 'inputs';

-- Lines that fuzzing alone reaches, by folder below planner/, one row for each campaign that measured.
CREATE VIEW v_fuzz_coverage AS
WITH measured AS (
  SELECT campaign, min(started_utc) AS started_utc, min(commit_id) AS commit_id
  FROM fuzz_run JOIN run ON run.id = fuzz_run.run_id GROUP BY campaign
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
