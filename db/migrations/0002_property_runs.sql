-- Schema 2: what the properties of property_tests/ gave, one row for each time that one
-- was checked. db/schema.md explains every column.

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
  status         TEXT    NOT NULL CHECK (status IN ('passed', 'failed', 'gave_up')),
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

CREATE VIEW v_property_runs AS
SELECT
  property_run.id             AS id,
  property_run.uuid           AS property_run,
  property_run.started_utc    AS started_utc,
  property_run.room           AS room,
  property_run.title          AS title,
  property_run.mutant         AS mutant,
  property_run.status         AS status,
  property_run.cases          AS cases,
  property_run.discards       AS discards,
  property_run.shrinks        AS shrinks,
  property_run.shrink_tries   AS shrink_tries,
  property_run.wall_time_ns / 1e9 AS wall_time_s,
  property_run.seed           AS seed,
  property_run.max_success    AS max_success,
  property_run.message        AS message,
  property_run.reproduce      AS reproduce,
  property_run.counterexample AS counterexample,
  property_run.plan_case      AS plan_case,
  property_run.case_robots    AS case_robots,
  property_run.case_cells     AS case_cells,
  commit_.hash                AS commit_hash,
  commit_.subject             AS commit_subject,
  commit_.committed_utc       AS committed_utc,
  commit_.ancestor_count      AS ancestor_count,
  property_run.branch         AS branch,
  build.dirty                 AS dirty,
  machine.fingerprint         AS machine,
  machine.host                AS host,
  build.compiler              AS compiler,
  build.compiler_version      AS compiler_version,
  build.flags                 AS flags,
  build.build_type            AS build_type,
  build.assertions            AS assertions,
  build.sanitizers            AS sanitizers,
  property_run.origin         AS origin
FROM property_run
JOIN machine ON machine.id = property_run.machine_id
JOIN build ON build.id = property_run.build_id
LEFT JOIN commit_ ON commit_.id = property_run.commit_id;

-- Where each property stands: its newest run, planted bugs left out.
CREATE VIEW v_property_latest AS
SELECT * FROM v_property_runs AS newest
WHERE newest.mutant = '' AND newest.id = (
  SELECT other.id FROM property_run AS other
  WHERE other.title = newest.title AND other.room = newest.room AND other.mutant = ''
  ORDER BY other.started_utc DESC, other.id DESC LIMIT 1);

CREATE VIEW v_property_classes AS
SELECT
  property_run.id          AS id,
  property_run.uuid        AS property_run,
  property_run.started_utc AS started_utc,
  property_run.room        AS room,
  property_run.title       AS title,
  property_run.mutant      AS mutant,
  property_class.class     AS class,
  property_class.cases     AS cases,
  CAST(property_class.cases AS REAL) / property_run.cases AS share
FROM property_class
JOIN property_run ON property_run.id = property_class.property_run_id;

-- All runs of a property at one commit, planted bugs left out.
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
  max(property_run.started_utc) AS last_utc
FROM property_run
LEFT JOIN commit_ ON commit_.id = property_run.commit_id
WHERE property_run.mutant = ''
GROUP BY commit_.id, property_run.room, property_run.title;
