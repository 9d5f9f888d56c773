-- Schema 14: questions need one view, which leaves out excluded runs; lower bounds of every instance that was
-- planned; how often each instance was solved, without reading all results. db/schema.md explains every column.

DROP VIEW v_runs;
DROP VIEW v_run_cells;
DROP VIEW v_results;
DROP VIEW v_slowest;
DROP VIEW v_recomputed_cells;
DROP VIEW v_flips;
DROP VIEW v_commits;
DROP VIEW v_trends;
DROP VIEW v_plan_makers;
DROP VIEW v_work;
DROP VIEW v_progress;
DROP VIEW v_measurements;
DROP VIEW v_gate_cells;
DROP VIEW v_gate_differences;
DROP VIEW v_property_classes;
DROP VIEW v_fuzz_counts;
DROP VIEW v_fuzz_coverage;
DROP VIEW v_cases;

-- ---------------------------------------------------------------------------------
-- Every column of a case is part of its key. A test compares the key with the list of columns:
-- a later column needs the table to be built again, as here.

CREATE TABLE before AS SELECT * FROM case_;
DROP TABLE case_;
CREATE TABLE case_ (
  id                     INTEGER PRIMARY KEY,
  environment            TEXT    NOT NULL,
  map_spec               TEXT    NOT NULL,
  instance_set           TEXT    NOT NULL,
  robots                 INTEGER NOT NULL CHECK (robots >= 0),
  ssi_s                  REAL    NOT NULL CHECK (ssi_s >= 0),
  planner                TEXT    NOT NULL,
  initial_order          TEXT    NOT NULL,
  reschedule             TEXT    NOT NULL,
  any_angle              INTEGER NOT NULL CHECK (any_angle IN (0, 1)),
  connectedness          INTEGER NOT NULL,
  radius_cells           REAL    NOT NULL CHECK (radius_cells >= 0),
  speed_cells_per_s      REAL    NOT NULL CHECK (speed_cells_per_s >= 0),
  time_limit_s           REAL    NOT NULL CHECK (time_limit_s >= 0),
  max_expansions         INTEGER NOT NULL CHECK (max_expansions >= 0),
  max_restarts           INTEGER NOT NULL CHECK (max_restarts >= 0),
  seed                   INTEGER NOT NULL,
  weight                 REAL    NOT NULL DEFAULT 1,
  turns                  INTEGER NOT NULL DEFAULT 0 CHECK (turns IN (0, 1)),
  wait_before_move_s     REAL    NOT NULL DEFAULT 0,
  inflate_distance_cells REAL    NOT NULL DEFAULT 0,
  inflate_time_s         REAL    NOT NULL DEFAULT 0,
  method                 TEXT    NOT NULL DEFAULT 'prioritized',
  fallback               TEXT    NOT NULL DEFAULT 'none',
  best                   INTEGER NOT NULL DEFAULT 0 CHECK (best IN (0, 1)),
  improve                TEXT    NOT NULL DEFAULT 'none',
  objective              TEXT    NOT NULL DEFAULT 'flowtime',
  options                TEXT    NOT NULL DEFAULT '{}' CHECK (json_valid(options)),
  UNIQUE (environment, robots, ssi_s, reschedule, initial_order, planner, any_angle, connectedness, map_spec,
          instance_set, radius_cells, speed_cells_per_s, time_limit_s, max_expansions, max_restarts, seed,
          weight, turns, wait_before_move_s, inflate_distance_cells, inflate_time_s, method, fallback, best,
          improve, objective, options)
) STRICT;
INSERT INTO case_ SELECT * FROM before;
DROP TABLE before;

-- ---------------------------------------------------------------------------------
-- Lower bounds belong to the instance and to the moves that are allowed, not to each result.

CREATE TABLE instance_bound (
  instance_id      INTEGER NOT NULL REFERENCES instance,
  any_angle        INTEGER NOT NULL CHECK (any_angle IN (0, 1)),
  connectedness    INTEGER NOT NULL CHECK (any_angle = 0 OR connectedness = 0),
  flowtime_bound_s REAL    NOT NULL CHECK (flowtime_bound_s >= 0),
  makespan_bound_s REAL    NOT NULL CHECK (makespan_bound_s >= 0),
  PRIMARY KEY (instance_id, any_angle, connectedness)
) STRICT, WITHOUT ROWID;

-- Those that improvement recorded.
INSERT INTO instance_bound
SELECT progress.instance_id, case_.any_angle, iif(case_.any_angle, 0, case_.connectedness),
       max(progress.flowtime_bound_s), max(progress.makespan_bound_s)
FROM progress JOIN cell ON cell.id = progress.cell_id JOIN case_ ON case_.id = cell.case_id
GROUP BY 1, 2, 3;

ALTER TABLE result ADD COLUMN cpu_time_ns INTEGER CHECK (cpu_time_ns >= 0);
ALTER TABLE cell ADD COLUMN machine_load REAL CHECK (machine_load >= 0);

-- ---------------------------------------------------------------------------------
-- What the runs of a case made of each instance: a cache, kept by triggers, whoever writes. Excluded runs
-- do not count; their instances have rows all the same, by which v_results finds the cells of an instance.

CREATE TABLE instance_summary (
  instance_id    INTEGER NOT NULL REFERENCES instance,
  case_id        INTEGER NOT NULL REFERENCES case_,
  results        INTEGER NOT NULL,
  solved         INTEGER NOT NULL,
  solved_time_ns INTEGER NOT NULL,
  PRIMARY KEY (instance_id, case_id)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_recomputed_instances AS
SELECT
  result.instance_id AS instance_id,
  cell.case_id       AS case_id,
  sum(run.excluded_reason IS NULL) AS results,
  sum(run.excluded_reason IS NULL AND result.status = 0) AS solved,
  sum(iif(run.excluded_reason IS NULL AND result.status = 0, result.planning_time_ns, 0)) AS solved_time_ns
FROM result
JOIN cell ON cell.id = result.cell_id
JOIN run ON run.id = cell.run_id
GROUP BY result.instance_id, cell.case_id;

INSERT INTO instance_summary SELECT * FROM v_recomputed_instances;

CREATE TRIGGER result_counts AFTER INSERT ON result BEGIN
  INSERT INTO instance_summary (instance_id, case_id, results, solved, solved_time_ns)
  SELECT NEW.instance_id, cell.case_id, run.excluded_reason IS NULL, run.excluded_reason IS NULL AND NEW.status = 0,
         iif(run.excluded_reason IS NULL AND NEW.status = 0, NEW.planning_time_ns, 0)
    FROM cell JOIN run ON run.id = cell.run_id WHERE cell.id = NEW.cell_id
  ON CONFLICT DO UPDATE SET results = results + excluded.results, solved = solved + excluded.solved,
                            solved_time_ns = solved_time_ns + excluded.solved_time_ns;
END;

CREATE TRIGGER exclusion_counts AFTER UPDATE OF excluded_reason ON run
WHEN (OLD.excluded_reason IS NULL) <> (NEW.excluded_reason IS NULL) BEGIN
  UPDATE instance_summary
     SET results = instance_summary.results + iif(NEW.excluded_reason IS NULL, 1, -1) * of_run.results,
         solved = instance_summary.solved + iif(NEW.excluded_reason IS NULL, 1, -1) * of_run.solved,
         solved_time_ns = instance_summary.solved_time_ns +
                          iif(NEW.excluded_reason IS NULL, 1, -1) * of_run.solved_time_ns
    FROM (SELECT result.instance_id AS instance_id, cell.case_id AS case_id, count(*) AS results,
                 sum(result.status = 0) AS solved,
                 sum(iif(result.status = 0, result.planning_time_ns, 0)) AS solved_time_ns
            FROM cell JOIN result ON result.cell_id = cell.id WHERE cell.run_id = NEW.id
           GROUP BY result.instance_id, cell.case_id) AS of_run
   WHERE of_run.instance_id = instance_summary.instance_id AND of_run.case_id = instance_summary.case_id;
END;

-- ---------------------------------------------------------------------------------
-- Times of solved results. A failure is no fast planning: it counts as longer than every solved one, or not at all.

ALTER TABLE cell_summary ADD COLUMN mean_solved_time_s REAL;
ALTER TABLE cell_summary ADD COLUMN median_solved_time_s REAL;
ALTER TABLE cell_summary ADD COLUMN median_time_to_solve_s REAL;

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
  totals.mean_generations   AS mean_generations,
  iif(totals.solved > 0, totals.solved_time_ns / 1e9 / totals.solved, NULL) AS mean_solved_time_s,
  (SELECT avg(x) / 1e9
     FROM (SELECT result.planning_time_ns AS x, row_number() OVER (ORDER BY result.planning_time_ns) AS k
             FROM result WHERE result.cell_id = totals.cell_id AND result.status = 0)
    WHERE k IN ((totals.solved + 1) / 2, totals.solved / 2 + 1)) AS median_solved_time_s,
  -- Solved results are the first: where both middle places are among them, the rest does not matter.
  iif(totals.solved > totals.results / 2,
  (SELECT avg(x) / 1e9
     FROM (SELECT result.planning_time_ns AS x, row_number() OVER (ORDER BY result.planning_time_ns) AS k
             FROM result WHERE result.cell_id = totals.cell_id AND result.status = 0)
    WHERE k IN ((totals.results + 1) / 2, totals.results / 2 + 1)), NULL) AS median_time_to_solve_s
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

UPDATE cell_summary
   SET mean_solved_time_s = made.mean_solved_time_s, median_solved_time_s = made.median_solved_time_s,
       median_time_to_solve_s = made.median_time_to_solve_s
  FROM v_recomputed_cells AS made WHERE made.case_id = cell_summary.case_id AND made.run_id = cell_summary.run_id;

-- ---------------------------------------------------------------------------------
-- Views. Those named v_all_... have excluded runs, too, and say which; a later column goes there, and the view
-- without _all_ has it by itself.

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
  run.outcome                 AS outcome,
  (SELECT max(cell.machine_load) FROM cell WHERE cell.run_id = run.id) AS max_machine_load
FROM run
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id;

-- A column of case_ that a later schema adds is here by itself.
CREATE VIEW v_cases AS SELECT id AS case_id, * FROM case_;

CREATE VIEW v_all_run_cells AS
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
  cell_summary.par2_time_s            AS par2_time_s,
  cell_summary.mean_solved_time_s     AS mean_solved_time_s,
  cell_summary.median_solved_time_s   AS median_solved_time_s,
  cell_summary.median_time_to_solve_s AS median_time_to_solve_s,
  cell_summary.mean_flowtime_s        AS mean_sum_of_costs,
  cell.machine_load         AS machine_load,
  commit_.subject           AS commit_subject,
  run.branch                AS branch,
  machine.host              AS host,
  machine.fingerprint       AS machine,
  machine.cpu_model         AS cpu_model,
  build.compiler            AS compiler,
  build.build_type          AS build_type,
  build.binary_hash         AS binary_hash,
  case_.weight              AS weight,
  case_.turns               AS turns,
  case_.wait_before_move_s  AS wait_before_move_s,
  case_.inflate_distance_cells AS inflate_distance_cells,
  case_.inflate_time_s      AS inflate_time_s,
  case_.method              AS method,
  case_.fallback            AS fallback,
  case_.best                AS best,
  case_.improve             AS improve,
  case_.objective           AS objective,
  case_.options             AS options
FROM cell
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id
LEFT JOIN cell_summary ON cell_summary.case_id = cell.case_id AND cell_summary.run_id = cell.run_id;

CREATE VIEW v_run_cells AS SELECT * FROM v_all_run_cells WHERE excluded_reason IS NULL;

-- instance_summary leads from an instance to the cells that have it: a result has no index of its own.
CREATE VIEW v_all_results AS
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
  result.message              AS message,
  result.flowtime_s           AS sum_of_costs,
  instance_bound.flowtime_bound_s AS flowtime_bound_s,
  instance_bound.makespan_bound_s AS makespan_bound_s,
  CASE WHEN result.flowtime_s > instance_bound.flowtime_bound_s
       THEN 1 - instance_bound.flowtime_bound_s / result.flowtime_s
       WHEN result.flowtime_s IS NOT NULL AND instance_bound.flowtime_bound_s IS NOT NULL THEN 0.0 END AS flowtime_gap,
  CASE WHEN result.makespan_s > instance_bound.makespan_bound_s
       THEN 1 - instance_bound.makespan_bound_s / result.makespan_s
       WHEN result.makespan_s IS NOT NULL AND instance_bound.makespan_bound_s IS NOT NULL THEN 0.0 END AS makespan_gap,
  result.made_by              AS made_by,
  result.ssi_kept_s           AS ssi_kept_s,
  result.instructions         AS instructions,
  result.cpu_time_ns / 1e9    AS cpu_time_s,
  cell.machine_load           AS machine_load,
  run.suite                   AS suite,
  run.started_utc             AS started_utc,
  commit_.hash                AS commit_hash,
  commit_.subject             AS commit_subject,
  commit_.committed_utc       AS committed_utc,
  commit_.ancestor_count      AS ancestor_count,
  run.branch                  AS branch,
  machine.host                AS host,
  machine.fingerprint         AS machine,
  machine.cpu_model           AS cpu_model,
  build.compiler              AS compiler,
  build.build_type            AS build_type,
  build.binary_hash           AS binary_hash,
  run.excluded_reason         AS excluded_reason,
  case_.radius_cells          AS radius_cells,
  case_.speed_cells_per_s     AS speed_cells_per_s,
  nullif(case_.max_expansions, 9223372036854775807) AS max_expansions,
  nullif(case_.max_restarts, 9223372036854775807)   AS max_restarts,
  case_.weight                AS weight,
  case_.turns                 AS turns,
  case_.wait_before_move_s    AS wait_before_move_s,
  case_.inflate_distance_cells AS inflate_distance_cells,
  case_.inflate_time_s        AS inflate_time_s,
  case_.method                AS method,
  case_.fallback              AS fallback,
  case_.best                  AS best,
  case_.improve               AS improve,
  case_.objective             AS objective,
  case_.options               AS options
FROM instance_summary AS of_case
JOIN cell ON cell.case_id = of_case.case_id
JOIN result ON result.cell_id = cell.id AND result.instance_id = of_case.instance_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN instance ON instance.id = of_case.instance_id
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id
LEFT JOIN instance_bound ON instance_bound.instance_id = result.instance_id
      AND instance_bound.any_angle = case_.any_angle
      AND instance_bound.connectedness = iif(case_.any_angle, 0, case_.connectedness);

CREATE VIEW v_results AS SELECT * FROM v_all_results WHERE excluded_reason IS NULL;

CREATE VIEW v_slowest AS
SELECT run, planning_time_s, status, environment, robots, ssi_s, reschedule, initial_order, planner, any_angle,
       connectedness, instance, repetition, tries, expansions, limit_struck, instance_hash, case_id
FROM v_results
ORDER BY planning_time_ns DESC;

CREATE VIEW v_instances AS
SELECT
  instance.name               AS instance,
  instance.content_hash       AS instance_hash,
  of_case.case_id             AS case_id,
  case_.environment           AS environment,
  case_.map_spec              AS map_spec,
  case_.instance_set          AS instance_set,
  case_.robots                AS robots,
  case_.ssi_s                 AS ssi_s,
  case_.reschedule            AS reschedule,
  case_.initial_order         AS initial_order,
  case_.planner               AS planner,
  of_case.results             AS results,
  of_case.solved              AS solved,
  CAST(of_case.solved AS REAL) / of_case.results AS success_rate,
  iif(of_case.solved > 0, of_case.solved_time_ns / 1e9 / of_case.solved, NULL) AS mean_solved_time_s,
  instance_bound.flowtime_bound_s AS flowtime_bound_s,
  instance_bound.makespan_bound_s AS makespan_bound_s,
  instance.width_cells        AS width_cells,
  instance.height_cells       AS height_cells,
  instance.blocked_cells      AS blocked_cells
FROM instance_summary AS of_case
JOIN instance ON instance.id = of_case.instance_id
JOIN case_ ON case_.id = of_case.case_id
LEFT JOIN instance_bound ON instance_bound.instance_id = of_case.instance_id
      AND instance_bound.any_angle = case_.any_angle
      AND instance_bound.connectedness = iif(case_.any_angle, 0, case_.connectedness)
WHERE of_case.results > 0;

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
WHERE (base.status = 0) <> (head.status = 0)
  AND base_run.excluded_reason IS NULL AND head_run.excluded_reason IS NULL;

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
  (SELECT count(*) FROM run WHERE run.commit_id = commit_.id AND run.kind = 'property'
    AND run.excluded_reason IS NULL) AS property_runs
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
    WHEN 'runtime' THEN cell_summary.median_time_to_solve_s
    WHEN 'mean-runtime' THEN cell_summary.mean_solved_time_s
    WHEN 'max-runtime' THEN cell_summary.max_planning_time_s
    WHEN 'par2' THEN cell_summary.par2_time_s
    WHEN 'makespan' THEN cell_summary.mean_makespan_s
    WHEN 'flowtime' THEN cell_summary.mean_flowtime_s
    WHEN 'tries' THEN cell_summary.mean_tries
    WHEN 'expansions' THEN cell_summary.mean_expansions
    WHEN 'generations' THEN cell_summary.mean_generations
  END                       AS value,
  cell_summary.solved       AS solved
FROM (SELECT 'success' AS name UNION ALL SELECT 'runtime' UNION ALL SELECT 'mean-runtime'
      UNION ALL SELECT 'max-runtime' UNION ALL SELECT 'par2' UNION ALL SELECT 'makespan'
      UNION ALL SELECT 'flowtime' UNION ALL SELECT 'tries' UNION ALL SELECT 'expansions'
      UNION ALL SELECT 'generations') AS metric
CROSS JOIN cell
JOIN cell_summary ON cell_summary.case_id = cell.case_id AND cell_summary.run_id = cell.run_id
JOIN run ON run.id = cell.run_id
JOIN machine ON machine.id = run.machine_id
JOIN build ON build.id = run.build_id
LEFT JOIN commit_ ON commit_.id = run.commit_id
WHERE run.excluded_reason IS NULL;

CREATE VIEW v_plan_makers AS
SELECT
  run.uuid                    AS run,
  run.suite                   AS suite,
  case_.environment           AS environment,
  case_.robots                AS robots,
  case_.ssi_s                 AS ssi_s,
  case_.reschedule            AS reschedule,
  case_.planner               AS planner,
  result.made_by              AS made_by,
  count(*)                    AS results,
  sum(result.status = 0)      AS solved,
  avg(result.planning_time_ns) / 1e9 AS mean_planning_time_s,
  max(result.planning_time_ns) / 1e9 AS max_planning_time_s,
  avg(iif(result.status = 0, result.makespan_s, NULL)) AS mean_makespan_s,
  avg(iif(result.status = 0, result.flowtime_s, NULL)) AS mean_flowtime_s,
  min(result.ssi_kept_s)      AS least_ssi_kept_s,
  cell.case_id                AS case_id
FROM result
JOIN cell ON cell.id = result.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
WHERE run.excluded_reason IS NULL
GROUP BY cell.id, result.made_by;

CREATE VIEW v_work AS
SELECT
  run.uuid                    AS run,
  run.suite                   AS suite,
  case_.environment           AS environment,
  case_.map_spec              AS map_spec,
  case_.robots                AS robots,
  case_.ssi_s                 AS ssi_s,
  case_.reschedule            AS reschedule,
  case_.planner               AS planner,
  count(*)                    AS results,
  sum(result.status = 0)      AS solved,
  avg(result.tries)           AS mean_tries,
  avg(result.expansions)      AS mean_expansions,
  avg(result.generations)     AS mean_generations,
  avg(result.instructions)    AS mean_instructions,
  avg(result.planning_time_ns) / 1e9 AS mean_planning_time_s,
  max(result.peak_memory_bytes) AS peak_memory_bytes,
  cell.case_id                AS case_id,
  avg(result.cpu_time_ns) / 1e9 AS mean_cpu_time_s,
  cell.machine_load           AS machine_load
FROM result
JOIN cell ON cell.id = result.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
WHERE run.excluded_reason IS NULL
GROUP BY cell.id;

-- Each point holds from elapsed_s up to until_s: the last one for ever.
CREATE VIEW v_progress AS
SELECT
  run.uuid                    AS run,
  cell.case_id                AS case_id,
  case_.environment           AS environment,
  case_.robots                AS robots,
  case_.ssi_s                 AS ssi_s,
  case_.reschedule            AS reschedule,
  case_.planner               AS planner,
  instance.name               AS instance,
  instance.content_hash       AS instance_hash,
  progress.position           AS position,
  progress.repetition         AS repetition,
  progress.step               AS step,
  progress.iteration          AS iteration,
  progress.elapsed_ns / 1e9   AS elapsed_s,
  progress.flowtime_s         AS flowtime_s,
  progress.makespan_s         AS makespan_s,
  progress.flowtime_bound_s   AS flowtime_bound_s,
  progress.makespan_bound_s   AS makespan_bound_s,
  CASE WHEN progress.flowtime_s > progress.flowtime_bound_s
       THEN 1 - progress.flowtime_bound_s / progress.flowtime_s ELSE 0.0 END AS flowtime_gap,
  CASE WHEN progress.makespan_s > progress.makespan_bound_s
       THEN 1 - progress.makespan_bound_s / progress.makespan_s ELSE 0.0 END AS makespan_gap,
  ifnull(next.elapsed_ns / 1e9, 9e999) AS until_s,
  run.suite                   AS suite,
  run.started_utc             AS started_utc,
  case_.improve               AS improve,
  case_.objective             AS objective
FROM progress
JOIN cell ON cell.id = progress.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN instance ON instance.id = progress.instance_id
LEFT JOIN progress AS next ON next.cell_id = progress.cell_id AND next.instance_id = progress.instance_id
      AND next.position = progress.position AND next.repetition = progress.repetition
      AND next.step = progress.step + 1
WHERE run.excluded_reason IS NULL;

CREATE VIEW v_all_measurements AS
SELECT
  measurement.benchmark     AS benchmark,
  run.uuid                  AS run,
  run.suite                 AS suite,
  run.started_utc           AS started_utc,
  commit_.hash              AS commit_hash,
  commit_.ancestor_count    AS ancestor_count,
  machine.host              AS host,
  machine.fingerprint       AS machine,
  run.options               AS context,
  run.excluded_reason       AS excluded_reason,
  measurement.repetition    AS repetition,
  measurement.aggregate     AS aggregate,
  measurement.threads       AS threads,
  measurement.label         AS label,
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

CREATE VIEW v_measurements AS SELECT * FROM v_all_measurements WHERE excluded_reason IS NULL;

CREATE VIEW v_all_gate_cells AS
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
  (SELECT count(*) FROM gate_pair WHERE gate_pair.gate_cell_id = gate_cell.id) AS pairs,
  run.excluded_reason        AS excluded_reason
FROM gate_cell
JOIN gate_run ON gate_run.id = gate_cell.gate_run_id
JOIN run ON run.id = gate_run.run_id
LEFT JOIN case_ ON case_.id = gate_cell.case_id;

CREATE VIEW v_gate_cells AS SELECT * FROM v_all_gate_cells WHERE excluded_reason IS NULL;

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
JOIN instance ON instance.id = gate_difference.instance_id
WHERE run.excluded_reason IS NULL;

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
JOIN run ON run.id = property_run.run_id
WHERE run.excluded_reason IS NULL;

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
  ON inputs.fuzz_run_id = fuzz_run.id AND inputs.kind = 'event' AND inputs.name = 'inputs'
WHERE run.excluded_reason IS NULL;

-- Lines that fuzzing alone reaches, by folder below planner/, one row for each campaign that measured.
CREATE VIEW v_fuzz_coverage AS
WITH measured AS (
  SELECT campaign, min(started_utc) AS started_utc, min(commit_id) AS commit_id
  FROM fuzz_run JOIN run ON run.id = fuzz_run.run_id WHERE run.excluded_reason IS NULL GROUP BY campaign
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
