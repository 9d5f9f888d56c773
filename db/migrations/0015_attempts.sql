-- Schema 15: a sweep may be written by many processes on many machines, one after the other or each into a
-- file of its own. Each of them is an attempt, and a result says in which one it was made. `planned` tells
-- how much of a sweep is missing. db/schema.md explains every column.

ALTER TABLE run ADD COLUMN planned INTEGER CHECK (planned >= 0);

CREATE TABLE attempt (
  id                 INTEGER PRIMARY KEY,
  uuid               TEXT    NOT NULL UNIQUE CHECK (length(uuid) = 36),
  run_id             INTEGER NOT NULL REFERENCES run,
  machine_id         INTEGER NOT NULL REFERENCES machine,
  shard              TEXT    NOT NULL,
  started_utc        TEXT    NOT NULL,
  ended_utc          TEXT    NOT NULL,
  status             TEXT    NOT NULL CHECK (status IN ('running', 'finished', 'aborted')),
  scheduler          TEXT    NOT NULL,
  job                TEXT    NOT NULL,
  task               TEXT    NOT NULL,
  restarts           INTEGER NOT NULL CHECK (restarts >= 0),
  queued_s           REAL,
  cores              REAL    NOT NULL CHECK (cores >= 0),
  memory_limit_bytes INTEGER,
  cpu_time_ns        INTEGER NOT NULL CHECK (cpu_time_ns >= 0),
  peak_memory_bytes  INTEGER NOT NULL CHECK (peak_memory_bytes >= 0)
) STRICT;
CREATE INDEX attempt_by_run ON attempt (run_id);

ALTER TABLE result ADD COLUMN attempt_id INTEGER REFERENCES attempt;

CREATE VIEW v_sweeps AS
SELECT
  run.uuid        AS run,
  run.suite       AS suite,
  run.status      AS status,
  run.started_utc AS started_utc,
  run.ended_utc   AS ended_utc,
  run.shard       AS shard,
  run.planned     AS planned,
  (SELECT ifnull(sum(cell.result_count), 0) FROM cell WHERE cell.run_id = run.id) AS results,
  run.planned - (SELECT ifnull(sum(cell.result_count), 0) FROM cell WHERE cell.run_id = run.id) AS missing,
  (SELECT count(*) FROM attempt WHERE attempt.run_id = run.id) AS attempts,
  (SELECT count(DISTINCT attempt.machine_id) FROM attempt WHERE attempt.run_id = run.id) AS machines,
  (SELECT sum(attempt.cpu_time_ns) / 1e9 FROM attempt WHERE attempt.run_id = run.id) AS cpu_time_s,
  run.excluded_reason AS excluded_reason
FROM run WHERE run.kind = 'sweep';

CREATE VIEW v_attempts AS
SELECT
  run.uuid            AS run,
  attempt.uuid        AS attempt,
  attempt.shard       AS shard,
  attempt.status      AS status,
  attempt.started_utc AS started_utc,
  attempt.ended_utc   AS ended_utc,
  machine.host        AS host,
  machine.fingerprint AS machine,
  machine.cpu_model   AS cpu_model,
  machine.kernel      AS kernel,
  attempt.cores       AS cores,
  attempt.memory_limit_bytes AS memory_limit_bytes,
  attempt.scheduler   AS scheduler,
  attempt.job         AS job,
  attempt.task        AS task,
  attempt.restarts    AS restarts,
  attempt.queued_s    AS queued_s,
  (julianday(attempt.ended_utc) - julianday(attempt.started_utc)) * 86400 AS wall_time_s,
  attempt.cpu_time_ns / 1e9 AS cpu_time_s,
  attempt.peak_memory_bytes AS peak_memory_bytes
FROM attempt
JOIN run ON run.id = attempt.run_id
JOIN machine ON machine.id = attempt.machine_id;

CREATE VIEW v_machine_cells AS
SELECT
  run.uuid            AS run,
  cell.case_id        AS case_id,
  case_.environment   AS environment,
  case_.robots        AS robots,
  case_.ssi_s         AS ssi_s,
  case_.reschedule    AS reschedule,
  case_.planner       AS planner,
  machine.fingerprint AS machine,
  machine.host        AS host,
  machine.cpu_model   AS cpu_model,
  count(*)            AS results,
  sum(result.status = 0) AS solved,
  avg(result.planning_time_ns) / 1e9 AS mean_planning_time_s,
  max(result.planning_time_ns) / 1e9 AS max_planning_time_s
FROM cell
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN result ON result.cell_id = cell.id
LEFT JOIN attempt ON attempt.id = result.attempt_id
JOIN machine ON machine.id = ifnull(attempt.machine_id, run.machine_id)
WHERE run.excluded_reason IS NULL
GROUP BY cell.id, machine.id;
