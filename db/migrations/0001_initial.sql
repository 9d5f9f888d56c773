-- Schema 1: what ran, where, and what came out. db/schema.md explains every column.
--
-- Integer keys are internal to one file; what names a thing across files is its
-- UUID, its hash, or the whole of its columns. Parameters are NOT NULL, because
-- UNIQUE holds two NULLs for different: "no limit" is infinity (9e999) for a REAL
-- and the largest integer for a count.

CREATE TABLE commit_ (
  id                 INTEGER PRIMARY KEY,
  hash               TEXT    NOT NULL UNIQUE CHECK (length(hash) >= 7),
  committed_utc      TEXT    NOT NULL,
  subject            TEXT    NOT NULL,
  first_parent_hash  TEXT    NOT NULL,
  ancestor_count     INTEGER NOT NULL CHECK (ancestor_count >= 0),
  first_parent_count INTEGER NOT NULL CHECK (first_parent_count >= 0)
) STRICT;

CREATE TABLE machine (
  id           INTEGER PRIMARY KEY,
  fingerprint  TEXT    NOT NULL UNIQUE,
  host         TEXT    NOT NULL,
  cpu_model    TEXT    NOT NULL,
  cores        INTEGER NOT NULL CHECK (cores >= 0),
  memory_bytes INTEGER NOT NULL CHECK (memory_bytes >= 0),
  kernel       TEXT    NOT NULL
) STRICT;

CREATE TABLE build (
  id               INTEGER PRIMARY KEY,
  compiler         TEXT    NOT NULL,
  compiler_version TEXT    NOT NULL,
  flags            TEXT    NOT NULL,
  build_type       TEXT    NOT NULL,
  assertions       INTEGER NOT NULL CHECK (assertions IN (0, 1)),
  sanitizers       TEXT    NOT NULL,
  binary_hash      TEXT    NOT NULL,
  dirty            INTEGER NOT NULL CHECK (dirty IN (0, 1)),
  UNIQUE (binary_hash, compiler, compiler_version, flags, build_type, assertions, sanitizers, dirty)
) STRICT;

CREATE TABLE run (
  id              INTEGER PRIMARY KEY,
  uuid            TEXT    NOT NULL UNIQUE CHECK (length(uuid) = 36),
  suite           TEXT    NOT NULL,
  started_utc     TEXT    NOT NULL,
  ended_utc       TEXT,
  status          TEXT    NOT NULL CHECK (status IN ('running', 'finished', 'aborted')),
  commit_id       INTEGER REFERENCES commit_,
  machine_id      INTEGER NOT NULL REFERENCES machine,
  build_id        INTEGER NOT NULL REFERENCES build,
  branch          TEXT    NOT NULL,
  command_line    TEXT    NOT NULL,
  options         TEXT    NOT NULL,
  seed            INTEGER NOT NULL,
  time_limit_s    REAL    NOT NULL CHECK (time_limit_s >= 0),
  writer          TEXT    NOT NULL,
  excluded_reason TEXT,
  excluded_utc    TEXT,
  origin          TEXT    NOT NULL DEFAULT '',
  CHECK ((excluded_reason IS NULL) = (excluded_utc IS NULL)),
  CHECK ((ended_utc IS NULL) = (status = 'running'))
) STRICT;
CREATE INDEX run_by_start ON run (started_utc);
CREATE INDEX run_by_commit ON run (commit_id);

CREATE TABLE case_ (
  id                INTEGER PRIMARY KEY,
  environment       TEXT    NOT NULL,
  map_spec          TEXT    NOT NULL,
  instance_set      TEXT    NOT NULL,
  robots            INTEGER NOT NULL CHECK (robots >= 0),
  ssi_s             REAL    NOT NULL CHECK (ssi_s >= 0),
  planner           TEXT    NOT NULL,
  initial_order     TEXT    NOT NULL,
  reschedule        TEXT    NOT NULL,
  any_angle         INTEGER NOT NULL CHECK (any_angle IN (0, 1)),
  connectedness     INTEGER NOT NULL,
  radius_cells      REAL    NOT NULL CHECK (radius_cells >= 0),
  speed_cells_per_s REAL    NOT NULL CHECK (speed_cells_per_s >= 0),
  time_limit_s      REAL    NOT NULL CHECK (time_limit_s >= 0),
  max_expansions    INTEGER NOT NULL CHECK (max_expansions >= 0),
  max_restarts      INTEGER NOT NULL CHECK (max_restarts >= 0),
  seed              INTEGER NOT NULL,
  UNIQUE (environment, robots, ssi_s, reschedule, initial_order, planner, any_angle, connectedness, map_spec,
          instance_set, radius_cells, speed_cells_per_s, time_limit_s, max_expansions, max_restarts, seed)
) STRICT;

CREATE TABLE instance (
  id            INTEGER PRIMARY KEY,
  content_hash  TEXT    NOT NULL UNIQUE,
  map_hash      TEXT    NOT NULL,
  name          TEXT    NOT NULL,
  robots        INTEGER NOT NULL CHECK (robots >= 0),
  width_cells   INTEGER NOT NULL CHECK (width_cells >= 0),
  height_cells  INTEGER NOT NULL CHECK (height_cells >= 0),
  blocked_cells INTEGER NOT NULL CHECK (blocked_cells >= 0)
) STRICT;

-- A case that a run has finished. Its results come in the same transaction.
CREATE TABLE cell (
  id           INTEGER PRIMARY KEY,
  run_id       INTEGER NOT NULL REFERENCES run,
  case_id      INTEGER NOT NULL REFERENCES case_,
  finished_utc TEXT    NOT NULL,
  result_count INTEGER NOT NULL CHECK (result_count >= 0),
  UNIQUE (run_id, case_id)
) STRICT;
CREATE INDEX cell_by_case ON cell (case_id, run_id);

-- The one table that grows to millions of rows: clustered by cell, so that reading a
-- cell touches a few neighbouring pages, and without a second index. Codes instead
-- of words keep a row at about 70 bytes.
CREATE TABLE result (
  cell_id             INTEGER NOT NULL REFERENCES cell,
  instance_id         INTEGER NOT NULL REFERENCES instance,
  position            INTEGER NOT NULL CHECK (position >= 0),
  repetition          INTEGER NOT NULL CHECK (repetition >= 0),
  status              INTEGER NOT NULL CHECK (status BETWEEN 0 AND 3), -- solved, failed, limit, invalid
  planning_time_ns    INTEGER NOT NULL CHECK (planning_time_ns >= 0),
  makespan_s          REAL,
  flowtime_s          REAL,
  tries               INTEGER NOT NULL,
  expansions          INTEGER NOT NULL,
  generations         INTEGER NOT NULL,
  plan_hash           INTEGER,
  valid               INTEGER CHECK (valid IN (0, 1)),
  violations          INTEGER NOT NULL,
  min_clearance_cells REAL,
  peak_memory_bytes   INTEGER,
  limit_struck        TEXT,
  message             TEXT,
  PRIMARY KEY (cell_id, instance_id, position, repetition),
  CHECK (status <> 0 OR (makespan_s IS NOT NULL AND flowtime_s IS NOT NULL AND valid = 1))
) STRICT, WITHOUT ROWID;

-- ---------------------------------------------------------------------------------
-- Views: the public interface. Aggregates are subqueries that depend on the cell at
-- hand, so a query for one run or one case reads its own results and no others, and
-- a column that is not asked for is not computed.

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
  (SELECT count(*) FROM cell JOIN result ON result.cell_id = cell.id
    WHERE cell.run_id = run.id AND result.status = 0) AS solved,
  (SELECT count(*) FROM cell JOIN result ON result.cell_id = cell.id
    WHERE cell.run_id = run.id AND result.status = 3) AS invalid
FROM run
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;

CREATE VIEW v_run_cells AS
SELECT
  run.uuid                  AS run,
  run.suite                 AS suite,
  run.started_utc           AS started_utc,
  run.excluded_reason       AS excluded_reason,
  commit_.hash              AS commit_hash,
  commit_.ancestor_count    AS ancestor_count,
  cell.case_id              AS case_id,
  case_.environment         AS environment,
  case_.map_spec            AS map_spec,
  case_.instance_set        AS instance_set,
  case_.robots              AS robots,
  case_.ssi_s               AS ssi_s,
  case_.reschedule          AS reschedule,
  case_.initial_order       AS initial_order,
  case_.planner             AS planner,
  case_.any_angle           AS any_angle,
  case_.connectedness       AS connectedness,
  case_.radius_cells        AS radius_cells,
  case_.speed_cells_per_s   AS speed_cells_per_s,
  case_.time_limit_s        AS time_limit_s,
  nullif(case_.max_expansions, 9223372036854775807) AS max_expansions,
  nullif(case_.max_restarts, 9223372036854775807)   AS max_restarts,
  case_.seed                AS seed,
  cell.finished_utc         AS finished_utc,
  cell.result_count         AS results,
  (SELECT count(*) FROM result WHERE result.cell_id = cell.id AND result.status = 0) AS solved,
  (SELECT count(*) FROM result WHERE result.cell_id = cell.id AND result.status = 1) AS failed,
  (SELECT count(*) FROM result WHERE result.cell_id = cell.id AND result.status = 2) AS limited,
  (SELECT count(*) FROM result WHERE result.cell_id = cell.id AND result.status = 3) AS invalid,
  (SELECT avg(result.status = 0) FROM result WHERE result.cell_id = cell.id) AS success_rate,
  (SELECT avg(result.planning_time_ns) / 1e9 FROM result WHERE result.cell_id = cell.id)
    AS mean_planning_time_s,
  (SELECT avg(x) / 1e9
     FROM (SELECT result.planning_time_ns AS x, row_number() OVER (ORDER BY result.planning_time_ns) AS k,
                  count(*) OVER () AS n
             FROM result WHERE result.cell_id = cell.id)
    WHERE k IN ((n + 1) / 2, n / 2 + 1)) AS median_planning_time_s,
  (SELECT avg(result.makespan_s) FROM result WHERE result.cell_id = cell.id AND result.status = 0)
    AS mean_makespan_s,
  (SELECT avg(x)
     FROM (SELECT result.makespan_s AS x, row_number() OVER (ORDER BY result.makespan_s) AS k,
                  count(*) OVER () AS n
             FROM result WHERE result.cell_id = cell.id AND result.status = 0)
    WHERE k IN ((n + 1) / 2, n / 2 + 1)) AS median_makespan_s,
  (SELECT avg(result.flowtime_s) FROM result WHERE result.cell_id = cell.id AND result.status = 0)
    AS mean_flowtime_s,
  (SELECT avg(x)
     FROM (SELECT result.flowtime_s AS x, row_number() OVER (ORDER BY result.flowtime_s) AS k,
                  count(*) OVER () AS n
             FROM result WHERE result.cell_id = cell.id AND result.status = 0)
    WHERE k IN ((n + 1) / 2, n / 2 + 1)) AS median_flowtime_s,
  (SELECT avg(result.tries) FROM result WHERE result.cell_id = cell.id) AS mean_tries,
  (SELECT avg(result.expansions) FROM result WHERE result.cell_id = cell.id) AS mean_expansions,
  (SELECT avg(result.generations) FROM result WHERE result.cell_id = cell.id) AS mean_generations
FROM cell
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;

CREATE VIEW v_results AS
SELECT
  run.uuid                    AS run,
  cell.case_id                AS case_id,
  case_.environment           AS environment,
  case_.map_spec              AS map_spec,
  case_.instance_set          AS instance_set,
  case_.robots                AS robots,
  case_.ssi_s                 AS ssi_s,
  case_.reschedule            AS reschedule,
  case_.initial_order         AS initial_order,
  case_.planner               AS planner,
  case_.any_angle             AS any_angle,
  case_.connectedness         AS connectedness,
  case_.time_limit_s          AS time_limit_s,
  case_.seed                  AS seed,
  instance.name               AS instance,
  instance.content_hash       AS instance_hash,
  result.position             AS position,
  result.repetition           AS repetition,
  CASE result.status WHEN 0 THEN 'solved' WHEN 1 THEN 'failed' WHEN 2 THEN 'limit' ELSE 'invalid' END
    AS status,
  result.limit_struck         AS limit_struck,
  result.planning_time_ns / 1e9 AS planning_time_s,
  result.planning_time_ns     AS planning_time_ns,
  result.makespan_s           AS makespan_s,
  result.flowtime_s           AS flowtime_s,
  result.tries                AS tries,
  result.expansions           AS expansions,
  result.generations          AS generations,
  CASE WHEN result.plan_hash IS NOT NULL THEN printf('%016x', result.plan_hash) END AS plan_hash,
  result.valid                AS valid,
  result.violations           AS violations,
  result.min_clearance_cells  AS min_clearance_cells,
  result.peak_memory_bytes    AS peak_memory_bytes,
  result.message              AS message
FROM result
JOIN cell ON cell.id = result.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN instance ON instance.id = result.instance_id;

CREATE VIEW v_slowest AS
SELECT run, planning_time_s, status, environment, robots, ssi_s, reschedule, initial_order, planner, any_angle,
       connectedness, instance, repetition, tries, expansions, limit_struck, instance_hash, case_id
FROM v_results
ORDER BY planning_time_ns DESC;

-- Pairs of results of the same case, instance, position and repetition in two runs, of which one
-- is solved and the other is not. Ask with both runs, or with one of them and a case.
CREATE VIEW v_flips AS
SELECT
  base_run.uuid               AS base_run,
  head_run.uuid               AS head_run,
  CASE WHEN head.status = 0 THEN 'gained' ELSE 'lost' END AS direction,
  case_.environment           AS environment,
  case_.robots                AS robots,
  case_.ssi_s                 AS ssi_s,
  case_.reschedule            AS reschedule,
  case_.initial_order         AS initial_order,
  case_.planner               AS planner,
  case_.any_angle             AS any_angle,
  case_.connectedness         AS connectedness,
  instance.name               AS instance,
  base.position               AS position,
  base.repetition             AS repetition,
  CASE base.status WHEN 0 THEN 'solved' WHEN 1 THEN 'failed' WHEN 2 THEN 'limit' ELSE 'invalid' END
    AS base_status,
  CASE head.status WHEN 0 THEN 'solved' WHEN 1 THEN 'failed' WHEN 2 THEN 'limit' ELSE 'invalid' END
    AS head_status,
  base.planning_time_ns / 1e9 AS base_planning_time_s,
  head.planning_time_ns / 1e9 AS head_planning_time_s,
  base_cell.case_id           AS case_id,
  instance.content_hash       AS instance_hash
FROM run AS base_run
JOIN cell AS base_cell ON base_cell.run_id = base_run.id
JOIN cell AS head_cell ON head_cell.case_id = base_cell.case_id AND head_cell.run_id <> base_cell.run_id
JOIN run AS head_run ON head_run.id = head_cell.run_id
JOIN result AS base ON base.cell_id = base_cell.id
JOIN result AS head ON head.cell_id = head_cell.id AND head.instance_id = base.instance_id
                   AND head.position = base.position AND head.repetition = base.repetition
JOIN case_ ON case_.id = base_cell.case_id
JOIN instance ON instance.id = base.instance_id
WHERE (base.status = 0) <> (head.status = 0);
