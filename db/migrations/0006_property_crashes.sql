-- Schema 6: a property whose program crashed or was killed leaves a row, too. A CHECK
-- cannot be altered: both tables of property runs are made anew, under their own names,
-- so that what refers to them stays as it is.

CREATE TABLE property_run_before AS SELECT * FROM property_run;
CREATE TABLE property_class_before AS SELECT * FROM property_class;
DROP TABLE property_class;
DROP TABLE property_run;

CREATE TABLE property_run (
  id             INTEGER PRIMARY KEY,
  uuid           TEXT    NOT NULL UNIQUE CHECK (length(uuid) = 36),
  started_utc    TEXT    NOT NULL,
  room           TEXT    NOT NULL,
  title          TEXT    NOT NULL CHECK (title <> ''),
  mutant         TEXT    NOT NULL,
  commit_id      INTEGER REFERENCES commit_,
  machine_id     INTEGER NOT NULL REFERENCES machine,
  build_id       INTEGER NOT NULL REFERENCES build,
  branch         TEXT    NOT NULL,
  seed           INTEGER NOT NULL,
  max_success    INTEGER NOT NULL CHECK (max_success >= 0),
  status         TEXT    NOT NULL CHECK (status IN ('passed', 'failed', 'gave_up', 'crashed')),
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
  case_cells     INTEGER CHECK (case_cells >= 0),
  origin         TEXT    NOT NULL DEFAULT '',
  CHECK (status = 'passed' OR message IS NOT NULL),
  CHECK ((status = 'failed') = (reproduce IS NOT NULL))
) STRICT;
CREATE INDEX property_run_by_title ON property_run (title, started_utc);
CREATE INDEX property_run_by_start ON property_run (started_utc);

CREATE TABLE property_class (
  property_run_id INTEGER NOT NULL REFERENCES property_run,
  class           TEXT    NOT NULL,
  cases           INTEGER NOT NULL CHECK (cases > 0),
  PRIMARY KEY (property_run_id, class)
) STRICT, WITHOUT ROWID;

INSERT INTO property_run (id, uuid, started_utc, room, title, mutant, commit_id, machine_id, build_id, branch,
                          seed, max_success, status, cases, discards, shrinks, shrink_tries, wall_time_ns,
                          message, reproduce, counterexample, plan_case, case_robots, case_cells, origin)
SELECT id, uuid, started_utc, room, title, mutant, commit_id, machine_id, build_id, branch,
       seed, max_success, status, cases, discards, shrinks, shrink_tries, wall_time_ns,
       message, reproduce, counterexample, plan_case, case_robots, case_cells, origin
FROM property_run_before;
INSERT INTO property_class (property_run_id, class, cases)
SELECT property_run_id, class, cases FROM property_class_before;
DROP TABLE property_run_before;
DROP TABLE property_class_before;

DROP VIEW v_property_totals;
CREATE VIEW v_property_totals AS
SELECT
  commit_.hash                AS commit_hash,
  commit_.ancestor_count      AS ancestor_count,
  property_run.room           AS room,
  property_run.title          AS title,
  count(*)                    AS runs,
  sum(property_run.cases)     AS cases,
  sum(property_run.discards)  AS discards,
  sum(property_run.status = 'failed')  AS failed,
  sum(property_run.status = 'gave_up') AS gave_up,
  sum(property_run.wall_time_ns) / 1e9 AS wall_time_s,
  min(property_run.started_utc) AS first_utc,
  max(property_run.started_utc) AS last_utc,
  sum(property_run.status = 'crashed') AS crashed
FROM property_run
LEFT JOIN commit_ ON commit_.id = property_run.commit_id
WHERE property_run.mutant = ''
GROUP BY commit_.id, property_run.room, property_run.title;
