-- Schema 8: how plans got better while they were improved. One row for each point of the
-- curve of a result; results without improvement have none. db/schema.md explains every
-- column.

CREATE TABLE progress (
  cell_id           INTEGER NOT NULL,
  instance_id       INTEGER NOT NULL,
  position          INTEGER NOT NULL,
  repetition        INTEGER NOT NULL,
  step              INTEGER NOT NULL CHECK (step >= 0),
  iteration         INTEGER NOT NULL CHECK (iteration >= 0),
  elapsed_ns        INTEGER NOT NULL CHECK (elapsed_ns >= 0),
  flowtime_s        REAL    NOT NULL,
  makespan_s        REAL    NOT NULL,
  flowtime_bound_s  REAL    NOT NULL CHECK (flowtime_bound_s >= 0),
  makespan_bound_s  REAL    NOT NULL CHECK (makespan_bound_s >= 0),
  PRIMARY KEY (cell_id, instance_id, position, repetition, step),
  FOREIGN KEY (cell_id, instance_id, position, repetition)
    REFERENCES result (cell_id, instance_id, position, repetition)
) STRICT, WITHOUT ROWID;

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
       THEN 1 - progress.makespan_bound_s / progress.makespan_s ELSE 0.0 END AS makespan_gap
FROM progress
JOIN cell ON cell.id = progress.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN instance ON instance.id = progress.instance_id;
