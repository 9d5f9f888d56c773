-- Schema 3: questions over the whole history in milliseconds, parents of commits, shards,
-- and measurements of other programs. db/schema.md explains every column.

ALTER TABLE run ADD COLUMN included_utc TEXT;
ALTER TABLE run ADD COLUMN shard TEXT NOT NULL DEFAULT '';

CREATE TABLE commit_parent (
  commit_id   INTEGER NOT NULL REFERENCES commit_,
  position    INTEGER NOT NULL CHECK (position >= 0),
  parent_hash TEXT    NOT NULL,
  PRIMARY KEY (commit_id, position)
) STRICT, WITHOUT ROWID;
INSERT INTO commit_parent (commit_id, position, parent_hash)
SELECT id, 0, first_parent_hash FROM commit_ WHERE first_parent_hash <> '';

-- One row per finished case of a run, made from its results in the same transaction:
-- a cache, which v_recomputed_cells gives again at any time. Clustered by case, so that the
-- history of one case is a few neighbouring pages.
CREATE TABLE cell_summary (
  case_id                INTEGER NOT NULL,
  run_id                 INTEGER NOT NULL,
  results                INTEGER NOT NULL CHECK (results >= 0),
  solved                 INTEGER NOT NULL,
  failed                 INTEGER NOT NULL,
  limited                INTEGER NOT NULL,
  invalid                INTEGER NOT NULL,
  mean_planning_time_s   REAL,
  median_planning_time_s REAL,
  max_planning_time_s    REAL,
  par2_time_s            REAL,
  mean_makespan_s        REAL,
  median_makespan_s      REAL,
  mean_flowtime_s        REAL,
  median_flowtime_s      REAL,
  mean_tries             REAL,
  mean_expansions        REAL,
  mean_generations       REAL,
  PRIMARY KEY (case_id, run_id),
  FOREIGN KEY (run_id, case_id) REFERENCES cell (run_id, case_id),
  CHECK (solved + failed + limited + invalid = results)
) STRICT, WITHOUT ROWID;

-- Numbers that another benchmark program wrote about itself; `run` says when and where.
CREATE TABLE measurement (
  run_id       INTEGER NOT NULL REFERENCES run,
  benchmark    TEXT    NOT NULL,
  repetition   INTEGER NOT NULL CHECK (repetition >= 0),
  iterations   INTEGER NOT NULL CHECK (iterations >= 0),
  real_time_ns REAL,
  cpu_time_ns  REAL,
  error        TEXT,
  PRIMARY KEY (run_id, benchmark, repetition)
) STRICT, WITHOUT ROWID;
CREATE INDEX measurement_by_benchmark ON measurement (benchmark, run_id);

CREATE TABLE measurement_counter (
  run_id     INTEGER NOT NULL,
  benchmark  TEXT    NOT NULL,
  repetition INTEGER NOT NULL,
  counter    TEXT    NOT NULL,
  value      REAL    NOT NULL,
  PRIMARY KEY (run_id, benchmark, repetition, counter),
  FOREIGN KEY (run_id, benchmark, repetition) REFERENCES measurement (run_id, benchmark, repetition)
) STRICT, WITHOUT ROWID;

-- ---------------------------------------------------------------------------------
-- What cell_summary holds, computed from the results. The definition of every aggregate:
-- the recorder fills the table from here (medians apart, which it has at hand), and `sipplab doctor`
-- compares the two, bit by bit.

CREATE VIEW v_recomputed_cells AS
SELECT
  totals.cell_id            AS cell_id,
  totals.case_id            AS case_id,
  totals.run_id             AS run_id,
  totals.results            AS results,
  totals.solved             AS solved,
  totals.failed             AS failed,
  totals.limited            AS limited,
  totals.invalid            AS invalid,
  totals.mean_time_ns / 1e9 AS mean_planning_time_s,
  (SELECT avg(x) / 1e9
     FROM (SELECT result.planning_time_ns AS x, row_number() OVER (ORDER BY result.planning_time_ns) AS k
             FROM result WHERE result.cell_id = totals.cell_id)
    WHERE k IN ((totals.results + 1) / 2, totals.results / 2 + 1)) AS median_planning_time_s,
  totals.max_time_ns / 1e9  AS max_planning_time_s,
  -- Without a wall-clock limit an unsolved result has no time that could be counted twice.
  CASE WHEN totals.solved = totals.results OR totals.time_limit_s < 9e999
       THEN (totals.solved_time_ns / 1e9 +
             iif(totals.solved = totals.results, 0.0, (totals.results - totals.solved) * 2 * totals.time_limit_s))
            / totals.results END AS par2_time_s,
  totals.mean_makespan_s    AS mean_makespan_s,
  (SELECT avg(x)
     FROM (SELECT result.makespan_s AS x, row_number() OVER (ORDER BY result.makespan_s) AS k
             FROM result WHERE result.cell_id = totals.cell_id AND result.status = 0)
    WHERE k IN ((totals.solved + 1) / 2, totals.solved / 2 + 1)) AS median_makespan_s,
  totals.mean_flowtime_s    AS mean_flowtime_s,
  (SELECT avg(x)
     FROM (SELECT result.flowtime_s AS x, row_number() OVER (ORDER BY result.flowtime_s) AS k
             FROM result WHERE result.cell_id = totals.cell_id AND result.status = 0)
    WHERE k IN ((totals.solved + 1) / 2, totals.solved / 2 + 1)) AS median_flowtime_s,
  totals.mean_tries         AS mean_tries,
  totals.mean_expansions    AS mean_expansions,
  totals.mean_generations   AS mean_generations
FROM (SELECT cell.id AS cell_id, cell.case_id AS case_id, cell.run_id AS run_id,
             case_.time_limit_s AS time_limit_s,
             count(result.cell_id) AS results,
             ifnull(sum(result.status = 0), 0) AS solved,
             ifnull(sum(result.status = 1), 0) AS failed,
             ifnull(sum(result.status = 2), 0) AS limited,
             ifnull(sum(result.status = 3), 0) AS invalid,
             avg(result.planning_time_ns) AS mean_time_ns,
             max(result.planning_time_ns) AS max_time_ns,
             total(iif(result.status = 0, result.planning_time_ns, 0)) AS solved_time_ns,
             avg(iif(result.status = 0, result.makespan_s, NULL)) AS mean_makespan_s,
             avg(iif(result.status = 0, result.flowtime_s, NULL)) AS mean_flowtime_s,
             avg(result.tries) AS mean_tries,
             avg(result.expansions) AS mean_expansions,
             avg(result.generations) AS mean_generations
        FROM cell JOIN case_ ON case_.id = cell.case_id LEFT JOIN result ON result.cell_id = cell.id
       GROUP BY cell.id, cell.run_id, cell.case_id) AS totals;

INSERT INTO cell_summary
SELECT case_id, run_id, results, solved, failed, limited, invalid, mean_planning_time_s, median_planning_time_s,
       max_planning_time_s, par2_time_s, mean_makespan_s, median_makespan_s, mean_flowtime_s, median_flowtime_s,
       mean_tries, mean_expansions, mean_generations
FROM v_recomputed_cells;

-- ---------------------------------------------------------------------------------
-- The public views of schema 1, from summaries where they aggregate, with new columns
-- at their ends.

DROP VIEW v_runs;
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
  (SELECT count(*) FROM measurement WHERE measurement.run_id = run.id) AS measurements
FROM run
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;

DROP VIEW v_run_cells;
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
  cell_summary.solved       AS solved,
  cell_summary.failed       AS failed,
  cell_summary.limited      AS limited,
  cell_summary.invalid      AS invalid,
  CAST(cell_summary.solved AS REAL) / cell_summary.results AS success_rate,
  cell_summary.mean_planning_time_s   AS mean_planning_time_s,
  cell_summary.median_planning_time_s AS median_planning_time_s,
  cell_summary.mean_makespan_s        AS mean_makespan_s,
  cell_summary.median_makespan_s      AS median_makespan_s,
  cell_summary.mean_flowtime_s        AS mean_flowtime_s,
  cell_summary.median_flowtime_s      AS median_flowtime_s,
  cell_summary.mean_tries             AS mean_tries,
  cell_summary.mean_expansions        AS mean_expansions,
  cell_summary.mean_generations       AS mean_generations,
  cell_summary.max_planning_time_s    AS max_planning_time_s,
  cell_summary.par2_time_s            AS par2_time_s
FROM cell
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
LEFT JOIN commit_ ON commit_.id = run.commit_id
LEFT JOIN cell_summary ON cell_summary.case_id = cell.case_id AND cell_summary.run_id = cell.run_id;

DROP VIEW v_flips;
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
  instance.content_hash       AS instance_hash,
  base_commit.hash            AS base_commit,
  head_commit.hash            AS head_commit
FROM run AS base_run
JOIN cell AS base_cell ON base_cell.run_id = base_run.id
JOIN cell AS head_cell ON head_cell.case_id = base_cell.case_id AND head_cell.run_id <> base_cell.run_id
JOIN run AS head_run ON head_run.id = head_cell.run_id
JOIN result AS base ON base.cell_id = base_cell.id
JOIN result AS head ON head.cell_id = head_cell.id AND head.instance_id = base.instance_id
                   AND head.position = base.position AND head.repetition = base.repetition
JOIN case_ ON case_.id = base_cell.case_id
JOIN instance ON instance.id = base.instance_id
LEFT JOIN commit_ AS base_commit ON base_commit.id = base_run.commit_id
LEFT JOIN commit_ AS head_commit ON head_commit.id = head_run.commit_id
WHERE (base.status = 0) <> (head.status = 0);

-- ---------------------------------------------------------------------------------
-- New views.

CREATE VIEW v_commits AS
SELECT
  commit_.hash           AS commit_hash,
  commit_.subject        AS subject,
  commit_.committed_utc  AS committed_utc,
  commit_.ancestor_count AS ancestor_count,
  (SELECT group_concat(parent_hash, ' ')
     FROM (SELECT parent_hash FROM commit_parent WHERE commit_id = commit_.id ORDER BY position)) AS parents,
  (SELECT count(*) FROM run WHERE run.commit_id = commit_.id AND run.excluded_reason IS NULL) AS runs,
  (SELECT count(*) FROM property_run WHERE property_run.commit_id = commit_.id) AS property_runs
FROM commit_;

-- Values of one metric and one case by run. Ask with both; then it is one value per run.
CREATE VIEW v_trends AS
SELECT
  metric.name               AS metric,
  cell.case_id              AS case_id,
  run.uuid                  AS run,
  run.suite                 AS suite,
  run.started_utc           AS started_utc,
  commit_.hash              AS commit_hash,
  commit_.subject           AS commit_subject,
  commit_.committed_utc     AS committed_utc,
  commit_.ancestor_count    AS ancestor_count,
  run.branch                AS branch,
  build.dirty               AS dirty,
  build.binary_hash         AS binary_hash,
  build.compiler            AS compiler,
  build.compiler_version    AS compiler_version,
  build.build_type          AS build_type,
  build.assertions          AS assertions,
  build.sanitizers          AS sanitizers,
  machine.fingerprint       AS machine,
  machine.host              AS host,
  run.excluded_reason       AS excluded_reason,
  cell_summary.results      AS results,
  CASE metric.name
    WHEN 'success' THEN CAST(cell_summary.solved AS REAL) / cell_summary.results
    WHEN 'runtime' THEN cell_summary.median_planning_time_s
    WHEN 'mean-runtime' THEN cell_summary.mean_planning_time_s
    WHEN 'max-runtime' THEN cell_summary.max_planning_time_s
    WHEN 'par2' THEN cell_summary.par2_time_s
    WHEN 'makespan' THEN cell_summary.mean_makespan_s
    WHEN 'flowtime' THEN cell_summary.mean_flowtime_s
    WHEN 'tries' THEN cell_summary.mean_tries
    WHEN 'expansions' THEN cell_summary.mean_expansions
    WHEN 'generations' THEN cell_summary.mean_generations
  END                       AS value
FROM (SELECT 'success' AS name UNION ALL SELECT 'runtime' UNION ALL SELECT 'mean-runtime'
      UNION ALL SELECT 'max-runtime' UNION ALL SELECT 'par2' UNION ALL SELECT 'makespan'
      UNION ALL SELECT 'flowtime' UNION ALL SELECT 'tries' UNION ALL SELECT 'expansions'
      UNION ALL SELECT 'generations') AS metric
CROSS JOIN cell
JOIN cell_summary ON cell_summary.case_id = cell.case_id AND cell_summary.run_id = cell.run_id
JOIN run ON run.id = cell.run_id
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;

CREATE VIEW v_measurements AS
SELECT
  measurement.benchmark     AS benchmark,
  run.uuid                  AS run,
  run.suite                 AS suite,
  run.started_utc           AS started_utc,
  commit_.hash              AS commit_hash,
  commit_.ancestor_count    AS ancestor_count,
  machine.host              AS host,
  machine.fingerprint       AS machine,
  run.excluded_reason       AS excluded_reason,
  measurement.repetition    AS repetition,
  measurement.iterations    AS iterations,
  measurement.real_time_ns  AS real_time_ns,
  measurement.cpu_time_ns   AS cpu_time_ns,
  measurement.error         AS error,
  (SELECT json_group_object(counter, value) FROM measurement_counter
    WHERE measurement_counter.run_id = measurement.run_id
      AND measurement_counter.benchmark = measurement.benchmark
      AND measurement_counter.repetition = measurement.repetition) AS counters
FROM measurement
JOIN run ON run.id = measurement.run_id
JOIN machine ON machine.id = run.machine_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;
