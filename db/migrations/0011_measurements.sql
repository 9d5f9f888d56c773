-- Schema 11: what a report says of a measurement beside its numbers. db/schema.md explains every column.

DROP VIEW v_measurements;

ALTER TABLE measurement ADD COLUMN aggregate TEXT NOT NULL DEFAULT '' CHECK (aggregate IN ('', 'median', 'mean'));
ALTER TABLE measurement ADD COLUMN threads INTEGER NOT NULL DEFAULT 1 CHECK (threads >= 1);
ALTER TABLE measurement ADD COLUMN label TEXT NOT NULL DEFAULT '';

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
