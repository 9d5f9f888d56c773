-- Schema 16: plans of other programs as they were given and as they were re-timed, what programs say of their own
-- runs, and best known costs of MovingAI's scenarios.

-- One row for each result whose plan was re-timed; the result itself is of the re-timed plan.
CREATE TABLE retiming (
  cell_id          INTEGER NOT NULL,
  instance_id      INTEGER NOT NULL,
  position         INTEGER NOT NULL,
  repetition       INTEGER NOT NULL,
  executable       INTEGER NOT NULL CHECK (executable IN (0, 1)),
  given_valid      INTEGER NOT NULL CHECK (given_valid IN (0, 1)),
  given_violations INTEGER NOT NULL CHECK (given_violations >= 0),
  given_makespan_s REAL    NOT NULL,
  given_flowtime_s REAL    NOT NULL,
  retime_ns        INTEGER NOT NULL CHECK (retime_ns >= 0),
  unit_step_cost   INTEGER CHECK (unit_step_cost >= 0),
  PRIMARY KEY (cell_id, instance_id, position, repetition),
  FOREIGN KEY (cell_id, instance_id, position, repetition)
    REFERENCES result (cell_id, instance_id, position, repetition)
) STRICT, WITHOUT ROWID;

-- Numbers by the program's own names. Nobody checked them.
CREATE TABLE reported (
  cell_id     INTEGER NOT NULL,
  instance_id INTEGER NOT NULL,
  position    INTEGER NOT NULL,
  repetition  INTEGER NOT NULL,
  name        TEXT    NOT NULL CHECK (name <> ''),
  value       REAL    NOT NULL,
  PRIMARY KEY (cell_id, instance_id, position, repetition, name),
  FOREIGN KEY (cell_id, instance_id, position, repetition)
    REFERENCES result (cell_id, instance_id, position, repetition)
) STRICT, WITHOUT ROWID;

-- Best known sums of unit steps between four neighbours, as MAPF-tracker collects them.
CREATE TABLE best_known (
  map_name      TEXT    NOT NULL CHECK (map_name <> ''),
  scen_type     TEXT    NOT NULL CHECK (scen_type <> ''),
  type_id       INTEGER NOT NULL CHECK (type_id >= 0),
  agents        INTEGER NOT NULL CHECK (agents >= 0),
  lower_cost    INTEGER NOT NULL CHECK (lower_cost >= 0),
  solution_cost INTEGER NOT NULL CHECK (solution_cost >= 0),
  imported_utc  TEXT    NOT NULL,
  PRIMARY KEY (map_name, scen_type, type_id, agents)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_retimed AS
SELECT
  run.uuid                            AS run,
  case_.environment                   AS environment,
  case_.map_spec                      AS map_spec,
  case_.robots                        AS robots,
  case_.planner                       AS planner,
  instance.name                       AS instance,
  result.position                     AS position,
  result.repetition                   AS repetition,
  CASE WHEN NOT retiming.executable THEN 'not_executable' WHEN result.status = 0 THEN 'solved' ELSE 'invalid' END
    AS status,
  retiming.given_valid                AS given_valid,
  retiming.given_violations           AS given_violations,
  retiming.given_makespan_s           AS given_makespan_s,
  retiming.given_flowtime_s           AS given_flowtime_s,
  result.makespan_s                   AS makespan_s,
  result.flowtime_s                   AS flowtime_s,
  retiming.retime_ns / 1e9            AS retime_s,
  result.planning_time_ns / 1e9       AS planning_time_s,
  retiming.unit_step_cost             AS unit_step_cost,
  result.message                      AS message
FROM retiming
JOIN result ON result.cell_id = retiming.cell_id AND result.instance_id = retiming.instance_id
  AND result.position = retiming.position AND result.repetition = retiming.repetition
JOIN cell ON cell.id = result.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN instance ON instance.id = result.instance_id
WHERE run.excluded_reason IS NULL;

CREATE VIEW v_reported AS
SELECT
  run.uuid            AS run,
  case_.environment   AS environment,
  case_.robots        AS robots,
  case_.planner       AS planner,
  instance.name       AS instance,
  reported.position   AS position,
  reported.repetition AS repetition,
  reported.name       AS name,
  reported.value      AS value
FROM reported
JOIN cell ON cell.id = reported.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN instance ON instance.id = reported.instance_id
WHERE run.excluded_reason IS NULL;

-- Our unit-step costs beside them: of plans of unit moves alone, never of any-angle ones.
CREATE VIEW v_best_known AS
SELECT
  best_known.map_name      AS map_name,
  best_known.scen_type     AS scen_type,
  best_known.type_id       AS type_id,
  best_known.agents        AS agents,
  best_known.lower_cost    AS lower_cost,
  best_known.solution_cost AS solution_cost,
  ours.run                 AS run,
  ours.planner             AS planner,
  ours.unit_step_cost      AS unit_step_cost,
  ours.unit_step_cost - best_known.solution_cost AS above_best_known
FROM best_known
LEFT JOIN v_retimed AS ours ON ours.unit_step_cost IS NOT NULL AND ours.robots = best_known.agents
  AND ours.instance LIKE '%' || replace(replace(best_known.map_name, '\', '\\'), '_', '\_') || '-'
    || best_known.scen_type || '-' || best_known.type_id || '.scen%' ESCAPE '\';
