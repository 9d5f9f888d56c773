-- Schema 9: what ran, where, and what came out. db/schema.md explains every column.
-- It is the first that a release wrote; later files change it step by step.
--
-- Integer keys are internal to one file; what names a thing across files is its
-- UUID, its hash, or the whole of its columns. Parameters are NOT NULL, because
-- UNIQUE holds two NULLs for different: "no limit" is infinity (9e999) for a REAL
-- and the largest integer for a count.
--
-- `sipplab doctor` compares the text of each statement with what it finds in a file.

CREATE TABLE commit_ (
  id                 INTEGER PRIMARY KEY,
  hash               TEXT    NOT NULL UNIQUE CHECK (length(hash) >= 7),
  committed_utc      TEXT    NOT NULL,
  subject            TEXT    NOT NULL,
  first_parent_hash  TEXT    NOT NULL,
  ancestor_count     INTEGER NOT NULL CHECK (ancestor_count >= 0),
  first_parent_count INTEGER NOT NULL CHECK (first_parent_count >= 0)
) STRICT;

CREATE TABLE commit_parent (
  commit_id   INTEGER NOT NULL REFERENCES commit_,
  position    INTEGER NOT NULL CHECK (position >= 0),
  parent_hash TEXT    NOT NULL,
  PRIMARY KEY (commit_id, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE machine (
  id           INTEGER PRIMARY KEY,
  fingerprint  TEXT    NOT NULL UNIQUE,
  host         TEXT    NOT NULL,
  cpu_model    TEXT    NOT NULL,
  cores        INTEGER NOT NULL CHECK (cores >= 0),
  memory_bytes INTEGER NOT NULL CHECK (memory_bytes >= 0),
  kernel       TEXT    NOT NULL
) STRICT;

CREATE TABLE build (
  id               INTEGER PRIMARY KEY,
  compiler         TEXT    NOT NULL,
  compiler_version TEXT    NOT NULL,
  flags            TEXT    NOT NULL,
  build_type       TEXT    NOT NULL,
  assertions       INTEGER NOT NULL CHECK (assertions IN (0, 1)),
  sanitizers       TEXT    NOT NULL,
  binary_hash      TEXT    NOT NULL,
  dirty            INTEGER NOT NULL CHECK (dirty IN (0, 1)),
  UNIQUE (binary_hash, compiler, compiler_version, flags, build_type, assertions, sanitizers, dirty)
) STRICT;

CREATE TABLE run (
  id              INTEGER PRIMARY KEY,
  uuid            TEXT    NOT NULL UNIQUE CHECK (length(uuid) = 36),
  suite           TEXT    NOT NULL,
  started_utc     TEXT    NOT NULL,
  ended_utc       TEXT,
  status          TEXT    NOT NULL CHECK (status IN ('running', 'finished', 'aborted')),
  commit_id       INTEGER REFERENCES commit_,
  machine_id      INTEGER NOT NULL REFERENCES machine,
  build_id        INTEGER NOT NULL REFERENCES build,
  branch          TEXT    NOT NULL,
  command_line    TEXT    NOT NULL,
  options         TEXT    NOT NULL,
  seed            INTEGER NOT NULL,
  time_limit_s    REAL    NOT NULL CHECK (time_limit_s >= 0),
  writer          TEXT    NOT NULL,
  excluded_reason TEXT,
  excluded_utc    TEXT,
  origin          TEXT    NOT NULL DEFAULT '', included_utc TEXT, shard TEXT NOT NULL DEFAULT '',
  CHECK ((excluded_reason IS NULL) = (excluded_utc IS NULL)),
  CHECK ((ended_utc IS NULL) = (status = 'running'))
) STRICT;
CREATE INDEX run_by_start ON run (started_utc);
CREATE INDEX run_by_commit ON run (commit_id);

CREATE TABLE case_ (
  id                INTEGER PRIMARY KEY,
  environment       TEXT    NOT NULL,
  map_spec          TEXT    NOT NULL,
  instance_set      TEXT    NOT NULL,
  robots            INTEGER NOT NULL CHECK (robots >= 0),
  ssi_s             REAL    NOT NULL CHECK (ssi_s >= 0),
  planner           TEXT    NOT NULL,
  initial_order     TEXT    NOT NULL,
  reschedule        TEXT    NOT NULL,
  any_angle         INTEGER NOT NULL CHECK (any_angle IN (0, 1)),
  connectedness     INTEGER NOT NULL,
  radius_cells      REAL    NOT NULL CHECK (radius_cells >= 0),
  speed_cells_per_s REAL    NOT NULL CHECK (speed_cells_per_s >= 0),
  time_limit_s      REAL    NOT NULL CHECK (time_limit_s >= 0),
  max_expansions    INTEGER NOT NULL CHECK (max_expansions >= 0),
  max_restarts      INTEGER NOT NULL CHECK (max_restarts >= 0),
  seed              INTEGER NOT NULL,
  UNIQUE (environment, robots, ssi_s, reschedule, initial_order, planner, any_angle, connectedness, map_spec,
          instance_set, radius_cells, speed_cells_per_s, time_limit_s, max_expansions, max_restarts, seed)
) STRICT;

CREATE TABLE instance (
  id            INTEGER PRIMARY KEY,
  content_hash  TEXT    NOT NULL UNIQUE,
  map_hash      TEXT    NOT NULL,
  name          TEXT    NOT NULL,
  robots        INTEGER NOT NULL CHECK (robots >= 0),
  width_cells   INTEGER NOT NULL CHECK (width_cells >= 0),
  height_cells  INTEGER NOT NULL CHECK (height_cells >= 0),
  blocked_cells INTEGER NOT NULL CHECK (blocked_cells >= 0)
) STRICT;

-- A case that a run has finished. Its results come in the same transaction.
CREATE TABLE cell (
  id           INTEGER PRIMARY KEY,
  run_id       INTEGER NOT NULL REFERENCES run,
  case_id      INTEGER NOT NULL REFERENCES case_,
  finished_utc TEXT    NOT NULL,
  result_count INTEGER NOT NULL CHECK (result_count >= 0),
  UNIQUE (run_id, case_id)
) STRICT;
CREATE INDEX cell_by_case ON cell (case_id, run_id);

-- The one table that grows to millions of rows: clustered by cell, so that reading a
-- cell touches a few neighbouring pages, and without a second index. Codes instead
-- of words keep a row at about 70 bytes.
CREATE TABLE result (
  cell_id             INTEGER NOT NULL REFERENCES cell,
  instance_id         INTEGER NOT NULL REFERENCES instance,
  position            INTEGER NOT NULL CHECK (position >= 0),
  repetition          INTEGER NOT NULL CHECK (repetition >= 0),
  status              INTEGER NOT NULL CHECK (status BETWEEN 0 AND 3), -- solved, failed, limit, invalid
  planning_time_ns    INTEGER NOT NULL CHECK (planning_time_ns >= 0),
  makespan_s          REAL,
  flowtime_s          REAL,
  tries               INTEGER NOT NULL,
  expansions          INTEGER NOT NULL,
  generations         INTEGER NOT NULL,
  plan_hash           INTEGER,
  valid               INTEGER CHECK (valid IN (0, 1)),
  violations          INTEGER NOT NULL,
  min_clearance_cells REAL,
  peak_memory_bytes   INTEGER,
  limit_struck        TEXT,
  message             TEXT, made_by TEXT CHECK (made_by IN ('prioritized', 'complete')), ssi_kept_s REAL CHECK (ssi_kept_s >= 0), instructions INTEGER CHECK (instructions >= 0),
  PRIMARY KEY (cell_id, instance_id, position, repetition),
  CHECK (status <> 0 OR (makespan_s IS NOT NULL AND flowtime_s IS NOT NULL AND valid = 1))
) STRICT, WITHOUT ROWID;

-- How plans got better while they were improved: one row for each point of the curve of a
-- result. Results without improvement have none.
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
-- What the properties of property_tests/ gave, one row for each time that one was checked.

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

-- ---------------------------------------------------------------------------------
-- Comparisons of two builds by `sipplab gate`. A slowdown is the head's time over the base's,
-- minus one: 0.03 is 3 % slower, -0.03 faster.

CREATE TABLE gate_run (
  id                INTEGER PRIMARY KEY,
  uuid              TEXT    NOT NULL UNIQUE CHECK (length(uuid) = 36),
  started_utc       TEXT    NOT NULL,
  kind              TEXT    NOT NULL CHECK (kind IN ('comparison', 'calibration')),
  suite             TEXT    NOT NULL,
  method            INTEGER NOT NULL,
  machine_id        INTEGER NOT NULL REFERENCES machine,
  base_build_id     INTEGER NOT NULL REFERENCES build,
  head_build_id     INTEGER NOT NULL REFERENCES build,
  base_commit_id    INTEGER REFERENCES commit_,
  head_commit_id    INTEGER REFERENCES commit_,
  seed              INTEGER NOT NULL,
  pair_seconds      REAL    NOT NULL CHECK (pair_seconds > 0),
  tolerance         REAL    NOT NULL CHECK (tolerance > 0),
  injected_slowdown REAL    NOT NULL CHECK (injected_slowdown >= 0),
  wall_time_ns      INTEGER NOT NULL CHECK (wall_time_ns >= 0),
  compared          INTEGER NOT NULL CHECK (compared >= 0),
  differing         INTEGER NOT NULL CHECK (differing BETWEEN 0 AND compared),
  verdict           TEXT    NOT NULL CHECK (verdict IN ('regressed', 'equivalent', 'inconclusive')),
  reason            TEXT    NOT NULL,
  origin            TEXT    NOT NULL DEFAULT ''
) STRICT;
CREATE INDEX gate_run_by_machine ON gate_run (machine_id, suite, started_utc);
CREATE INDEX gate_run_by_start ON gate_run (started_utc);

-- A cell without a case is all of them together.
CREATE TABLE gate_cell (
  id               INTEGER PRIMARY KEY,
  gate_run_id      INTEGER NOT NULL REFERENCES gate_run,
  position         INTEGER NOT NULL CHECK (position >= 0),
  case_id          INTEGER REFERENCES case_,
  slowdown         REAL    NOT NULL CHECK (slowdown > -1),
  p_value          REAL    NOT NULL CHECK (p_value BETWEEN 0 AND 1),
  confirm_slowdown REAL             CHECK (confirm_slowdown > -1),
  confirm_p_value  REAL             CHECK (confirm_p_value BETWEEN 0 AND 1),
  at_most          REAL             CHECK (at_most > -1),
  noise            REAL    NOT NULL CHECK (noise >= 0),
  effect_floor     REAL    NOT NULL CHECK (effect_floor >= 0),
  detectable       REAL             CHECK (detectable > 0),
  verdict          TEXT    NOT NULL CHECK (verdict IN ('regressed', 'equivalent', 'inconclusive')),
  CHECK ((confirm_slowdown IS NULL) = (confirm_p_value IS NULL)),
  UNIQUE (gate_run_id, position)
) STRICT;

-- One number for each pair of processes and cell.
CREATE TABLE gate_pair (
  gate_cell_id INTEGER NOT NULL REFERENCES gate_cell,
  stage        INTEGER NOT NULL CHECK (stage IN (1, 2)),
  pair         INTEGER NOT NULL CHECK (pair >= 0),
  slowdown     REAL    NOT NULL CHECK (slowdown > -1),
  PRIMARY KEY (gate_cell_id, stage, pair)
) STRICT, WITHOUT ROWID;

-- What the exact tier found.
CREATE TABLE gate_difference (
  gate_run_id INTEGER NOT NULL REFERENCES gate_run,
  case_id     INTEGER NOT NULL REFERENCES case_,
  instance_id INTEGER NOT NULL REFERENCES instance,
  what        TEXT    NOT NULL CHECK (what IN ('status', 'validity', 'plan', 'work', 'repetition')),
  base        TEXT    NOT NULL,
  head        TEXT    NOT NULL,
  PRIMARY KEY (gate_run_id, case_id, instance_id, what)
) STRICT, WITHOUT ROWID;

-- ---------------------------------------------------------------------------------
-- What fuzzing did and found: one row for each time that one target ran, and one for each
-- finding, which has a life of its own.

CREATE TABLE fuzz_run (
  id                INTEGER PRIMARY KEY,
  uuid              TEXT    NOT NULL UNIQUE CHECK (length(uuid) = 36),
  campaign          TEXT    NOT NULL CHECK (length(campaign) = 36),
  target            TEXT    NOT NULL CHECK (target <> ''),
  mode              TEXT    NOT NULL CHECK (mode IN ('smoke', 'for', 'nightly')),
  started_utc       TEXT    NOT NULL,
  wall_time_ns      INTEGER NOT NULL CHECK (wall_time_ns >= 0),
  cpu_time_ns       INTEGER NOT NULL CHECK (cpu_time_ns >= 0),
  status            TEXT    NOT NULL CHECK (status IN ('clean', 'findings', 'broken')),
  seed              INTEGER NOT NULL,
  budget_executions INTEGER CHECK (budget_executions > 0),
  budget_s          REAL    CHECK (budget_s > 0),
  workers           INTEGER NOT NULL CHECK (workers > 0),
  target_hash       TEXT    NOT NULL,
  commit_id         INTEGER REFERENCES commit_,
  machine_id        INTEGER NOT NULL REFERENCES machine,
  build_id          INTEGER NOT NULL REFERENCES build,
  branch            TEXT    NOT NULL,
  executions        INTEGER NOT NULL CHECK (executions >= 0),
  edges             INTEGER NOT NULL CHECK (edges >= 0),
  features          INTEGER NOT NULL CHECK (features >= 0),
  corpus_files      INTEGER NOT NULL CHECK (corpus_files >= 0),
  corpus_bytes      INTEGER NOT NULL CHECK (corpus_bytes >= 0),
  peak_memory_bytes INTEGER NOT NULL CHECK (peak_memory_bytes >= 0),
  slowest_input_s   INTEGER NOT NULL CHECK (slowest_input_s >= 0),
  crashes           INTEGER NOT NULL CHECK (crashes >= 0),
  timeouts          INTEGER NOT NULL CHECK (timeouts >= 0),
  ooms              INTEGER NOT NULL CHECK (ooms >= 0),
  leaks             INTEGER NOT NULL CHECK (leaks >= 0),
  origin            TEXT    NOT NULL DEFAULT ''
) STRICT;
CREATE INDEX fuzz_run_by_target ON fuzz_run (target, started_utc);
CREATE INDEX fuzz_run_by_campaign ON fuzz_run (campaign);

CREATE TABLE fuzz_snapshot (
  fuzz_run_id       INTEGER NOT NULL REFERENCES fuzz_run,
  executions        INTEGER NOT NULL CHECK (executions >= 0),
  elapsed_ns        INTEGER NOT NULL CHECK (elapsed_ns >= 0),
  edges             INTEGER NOT NULL CHECK (edges >= 0),
  features          INTEGER NOT NULL CHECK (features >= 0),
  corpus_files      INTEGER NOT NULL CHECK (corpus_files >= 0),
  memory_bytes      INTEGER NOT NULL CHECK (memory_bytes >= 0),
  PRIMARY KEY (fuzz_run_id, executions)
) STRICT, WITHOUT ROWID;

CREATE TABLE fuzz_count (
  fuzz_run_id       INTEGER NOT NULL REFERENCES fuzz_run,
  kind              TEXT    NOT NULL CHECK (kind IN ('event', 'claim')),
  name              TEXT    NOT NULL,
  count             INTEGER NOT NULL CHECK (count > 0),
  PRIMARY KEY (fuzz_run_id, kind, name)
) STRICT, WITHOUT ROWID;

CREATE TABLE fuzz_coverage (
  campaign          TEXT    NOT NULL CHECK (length(campaign) = 36),
  file              TEXT    NOT NULL,
  lines             INTEGER NOT NULL CHECK (lines >= 0),
  covered_lines     INTEGER NOT NULL CHECK (covered_lines BETWEEN 0 AND lines),
  PRIMARY KEY (campaign, file)
) STRICT, WITHOUT ROWID;

CREATE TABLE finding (
  id                INTEGER PRIMARY KEY,
  target            TEXT    NOT NULL,
  signature         TEXT    NOT NULL CHECK (signature <> ''),
  kind              TEXT    NOT NULL CHECK (kind IN ('claim', 'invariant', 'sanitizer', 'crash', 'timeout',
                                                     'memory', 'leak', 'flaky')),
  claim             TEXT    NOT NULL,
  frames            TEXT    NOT NULL,
  message           TEXT    NOT NULL,
  state             TEXT    NOT NULL CHECK (state IN ('new', 'reproduced', 'fixed', 'regressed')),
  first_utc         TEXT    NOT NULL,
  last_utc          TEXT    NOT NULL,
  first_commit_id   INTEGER REFERENCES commit_,
  last_commit_id    INTEGER REFERENCES commit_,
  fixed_commit_id   INTEGER REFERENCES commit_,
  times_found       INTEGER NOT NULL CHECK (times_found > 0),
  input             BLOB    NOT NULL,
  minimal           BLOB    NOT NULL,
  robots            INTEGER CHECK (robots >= 0),
  cells             INTEGER CHECK (cells >= 0),
  origin            TEXT    NOT NULL DEFAULT '',
  UNIQUE (target, signature)
) STRICT;

-- Known by what happened when, so that the lives of a finding in two files merge into one.
CREATE TABLE finding_event (
  finding_id        INTEGER NOT NULL REFERENCES finding,
  happened_utc      TEXT    NOT NULL,
  event             TEXT    NOT NULL CHECK (event IN ('found', 'reproduced', 'fixed', 'regressed')),
  commit_id         INTEGER REFERENCES commit_,
  fuzz_run_id       INTEGER REFERENCES fuzz_run,
  PRIMARY KEY (finding_id, happened_utc, event)
) STRICT, WITHOUT ROWID;

-- ---------------------------------------------------------------------------------
-- Views: the public interface.

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

CREATE VIEW v_results AS
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
  result.message              AS message
FROM result
JOIN cell ON cell.id = result.cell_id
JOIN run ON run.id = cell.run_id
JOIN case_ ON case_.id = cell.case_id
JOIN instance ON instance.id = result.instance_id;

CREATE VIEW v_slowest AS
SELECT run, planning_time_s, status, environment, robots, ssi_s, reschedule, initial_order, planner, any_angle,
       connectedness, instance, repetition, tries, expansions, limit_struck, instance_hash, case_id
FROM v_results
ORDER BY planning_time_ns DESC;

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
WHERE (base.status = 0) <> (head.status = 0);

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
  max(property_run.started_utc) AS last_utc,
  sum(property_run.status = 'crashed') AS crashed
FROM property_run
LEFT JOIN commit_ ON commit_.id = property_run.commit_id
WHERE property_run.mutant = ''
GROUP BY commit_.id, property_run.room, property_run.title;

CREATE VIEW v_gate_runs AS
SELECT
  gate_run.uuid              AS gate_run,
  gate_run.started_utc       AS started_utc,
  gate_run.kind              AS kind,
  gate_run.verdict           AS verdict,
  gate_run.reason            AS reason,
  gate_run.suite             AS suite,
  gate_run.method            AS method,
  machine.fingerprint        AS machine,
  machine.host               AS host,
  base_commit.hash           AS base_commit_hash,
  head_commit.hash           AS head_commit_hash,
  head_commit.subject        AS head_commit_subject,
  head_commit.ancestor_count AS head_ancestor_count,
  base_build.binary_hash     AS base_binary_hash,
  head_build.binary_hash     AS head_binary_hash,
  base_build.compiler || ' ' || base_build.compiler_version AS base_compiler,
  head_build.compiler || ' ' || head_build.compiler_version AS head_compiler,
  head_build.dirty           AS head_dirty,
  gate_run.seed              AS seed,
  gate_run.pair_seconds      AS pair_seconds,
  gate_run.tolerance         AS tolerance,
  gate_run.injected_slowdown AS injected_slowdown,
  gate_run.wall_time_ns / 1e9 AS wall_time_s,
  gate_run.compared          AS compared,
  gate_run.differing         AS differing,
  (SELECT gate_cell.slowdown FROM gate_cell
    WHERE gate_cell.gate_run_id = gate_run.id AND gate_cell.case_id IS NULL) AS slowdown,
  (SELECT gate_cell.detectable FROM gate_cell
    WHERE gate_cell.gate_run_id = gate_run.id AND gate_cell.case_id IS NULL) AS detectable,
  gate_run.origin            AS origin
FROM gate_run
JOIN machine ON machine.id = gate_run.machine_id
JOIN build AS base_build ON base_build.id = gate_run.base_build_id
JOIN build AS head_build ON head_build.id = gate_run.head_build_id
LEFT JOIN commit_ AS base_commit ON base_commit.id = gate_run.base_commit_id
LEFT JOIN commit_ AS head_commit ON head_commit.id = gate_run.head_commit_id;

CREATE VIEW v_gate_cells AS
SELECT
  gate_run.uuid              AS gate_run,
  gate_run.started_utc       AS started_utc,
  gate_run.kind              AS kind,
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
  (SELECT count(*) FROM gate_pair WHERE gate_pair.gate_cell_id = gate_cell.id) AS pairs
FROM gate_cell
JOIN gate_run ON gate_run.id = gate_cell.gate_run_id
LEFT JOIN case_ ON case_.id = gate_cell.case_id;

CREATE VIEW v_gate_differences AS
SELECT
  gate_run.uuid         AS gate_run,
  gate_run.started_utc  AS started_utc,
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
JOIN case_ ON case_.id = gate_difference.case_id
JOIN instance ON instance.id = gate_difference.instance_id;

CREATE VIEW v_fuzz_runs AS
SELECT
  fuzz_run.id                AS id,
  fuzz_run.uuid              AS fuzz_run,
  fuzz_run.campaign          AS campaign,
  fuzz_run.target            AS target,
  fuzz_run.mode              AS mode,
  fuzz_run.started_utc       AS started_utc,
  fuzz_run.wall_time_ns / 1e9 AS wall_time_s,
  fuzz_run.cpu_time_ns / 1e9 AS cpu_time_s,
  fuzz_run.status            AS status,
  fuzz_run.seed              AS seed,
  fuzz_run.budget_executions AS budget_executions,
  fuzz_run.budget_s          AS budget_s,
  fuzz_run.workers           AS workers,
  fuzz_run.executions        AS executions,
  CASE WHEN fuzz_run.wall_time_ns > 0 THEN fuzz_run.executions * 1e9 / fuzz_run.wall_time_ns END
                             AS executions_per_s,
  CASE WHEN fuzz_run.cpu_time_ns > 0 THEN fuzz_run.executions * 1e9 / fuzz_run.cpu_time_ns END
                             AS executions_per_cpu_s,
  fuzz_run.edges             AS edges,
  fuzz_run.features          AS features,
  fuzz_run.corpus_files      AS corpus_files,
  fuzz_run.corpus_bytes      AS corpus_bytes,
  fuzz_run.peak_memory_bytes AS peak_memory_bytes,
  fuzz_run.slowest_input_s   AS slowest_input_s,
  fuzz_run.crashes           AS crashes,
  fuzz_run.timeouts          AS timeouts,
  fuzz_run.ooms              AS ooms,
  fuzz_run.leaks             AS leaks,
  fuzz_run.target_hash       AS target_hash,
  commit_.hash               AS commit_hash,
  commit_.subject            AS commit_subject,
  commit_.ancestor_count     AS ancestor_count,
  fuzz_run.branch            AS branch,
  build.dirty                AS dirty,
  machine.fingerprint        AS machine,
  machine.host               AS host,
  fuzz_run.origin            AS origin
FROM fuzz_run
JOIN machine ON machine.id = fuzz_run.machine_id
JOIN build ON build.id = fuzz_run.build_id
LEFT JOIN commit_ ON commit_.id = fuzz_run.commit_id;

CREATE VIEW v_fuzz_counts AS
SELECT
  fuzz_run.id          AS id,
  fuzz_run.uuid        AS fuzz_run,
  fuzz_run.target      AS target,
  fuzz_run.mode        AS mode,
  fuzz_run.started_utc AS started_utc,
  fuzz_count.kind      AS kind,
  fuzz_count.name      AS name,
  fuzz_count.count     AS count,
  CAST(fuzz_count.count AS REAL) / inputs.count AS per_input
FROM fuzz_count
JOIN fuzz_run ON fuzz_run.id = fuzz_count.fuzz_run_id
LEFT JOIN fuzz_count AS inputs
  ON inputs.fuzz_run_id = fuzz_run.id AND inputs.kind = 'event' AND inputs.name = 'inputs';

-- Lines that fuzzing alone reaches, by folder below planner/, one row for each campaign that measured.
CREATE VIEW v_fuzz_coverage AS
WITH measured AS (
  SELECT campaign, min(started_utc) AS started_utc, min(commit_id) AS commit_id FROM fuzz_run GROUP BY campaign
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

CREATE VIEW v_findings AS
SELECT
  finding.id          AS id,
  finding.target      AS target,
  finding.state       AS state,
  finding.kind        AS kind,
  finding.claim       AS claim,
  finding.frames      AS frames,
  finding.signature   AS signature,
  finding.message     AS message,
  finding.first_utc   AS first_utc,
  finding.last_utc    AS last_utc,
  first_commit.hash   AS first_commit,
  last_commit.hash    AS last_commit,
  fixed_commit.hash   AS fixed_commit,
  finding.times_found AS times_found,
  length(finding.input)   AS input_bytes,
  length(finding.minimal) AS minimal_bytes,
  finding.minimal     AS minimal,
  finding.robots      AS robots,
  finding.cells       AS cells,
  finding.origin      AS origin
FROM finding
LEFT JOIN commit_ AS first_commit ON first_commit.id = finding.first_commit_id
LEFT JOIN commit_ AS last_commit ON last_commit.id = finding.last_commit_id
LEFT JOIN commit_ AS fixed_commit ON fixed_commit.id = finding.fixed_commit_id;
