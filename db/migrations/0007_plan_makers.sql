-- Schema 7: who made a plan where a planner has a fallback, and for how long its order keeps
-- the promise of start-safe intervals.

ALTER TABLE result ADD COLUMN made_by TEXT CHECK (made_by IN ('prioritized', 'complete'));
ALTER TABLE result ADD COLUMN ssi_kept_s REAL CHECK (ssi_kept_s >= 0);

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
GROUP BY cell.id, result.made_by;
