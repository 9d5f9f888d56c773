-- Schema 9: instructions of a planning, and the work of each case in counts, which other
-- processes on the machine do not disturb.

ALTER TABLE result ADD COLUMN instructions INTEGER CHECK (instructions >= 0);

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
  cell.case_id                AS case_id
FROM result
JOIN cell ON cell.id = result.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
GROUP BY cell.id;
