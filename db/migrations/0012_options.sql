-- Each option of the planner is a column of its case. Schema 9 kept most of them in the name of the planner,
-- 'aa-sipp+weight:1.05+turns+complete+improve:300i,flowtime', which is taken apart here for the last time.
-- From now on `planner` says what differs from the defaults; it is for reading alone.

ALTER TABLE case_ ADD COLUMN weight REAL NOT NULL DEFAULT 1;
ALTER TABLE case_ ADD COLUMN turns INTEGER NOT NULL DEFAULT 0 CHECK (turns IN (0, 1));
ALTER TABLE case_ ADD COLUMN wait_before_move_s REAL NOT NULL DEFAULT 0;
ALTER TABLE case_ ADD COLUMN inflate_distance_cells REAL NOT NULL DEFAULT 0;
ALTER TABLE case_ ADD COLUMN inflate_time_s REAL NOT NULL DEFAULT 0;
ALTER TABLE case_ ADD COLUMN method TEXT NOT NULL DEFAULT 'prioritized';
ALTER TABLE case_ ADD COLUMN fallback TEXT NOT NULL DEFAULT 'none';
ALTER TABLE case_ ADD COLUMN best INTEGER NOT NULL DEFAULT 0 CHECK (best IN (0, 1));
ALTER TABLE case_ ADD COLUMN improve TEXT NOT NULL DEFAULT 'none';
ALTER TABLE case_ ADD COLUMN objective TEXT NOT NULL DEFAULT 'flowtime';

-- The parts of each name by place, those of other programs apart: 'weight:1.05', 'best:300i,1:20'.
CREATE TABLE part AS
WITH RECURSIVE split(case_id, place, text, rest) AS (
  SELECT id, -1, '', planner || '+' FROM case_ WHERE planner NOT GLOB 'cmd:*'
  UNION ALL
  SELECT case_id, place + 1, substr(rest, 1, instr(rest, '+') - 1), substr(rest, instr(rest, '+') + 1)
    FROM split WHERE rest <> '')
SELECT case_id, place, text,
       substr(text, 1, instr(text || ':', ':') - 1) AS word,
       substr(text, instr(text || ':', ':') + 1) AS value,
       substr(text, 1, instr(text || ',', ',') - 1) AS step,
       substr(text, instr(text || ',', ',') + 1) AS objective
  FROM split WHERE place >= 0;

UPDATE case_ SET weight = CAST(value AS REAL) FROM part WHERE case_id = id AND word = 'weight';
UPDATE case_ SET turns = 1 FROM part WHERE case_id = id AND word = 'turns';
UPDATE case_ SET wait_before_move_s = CAST(value AS REAL) FROM part WHERE case_id = id AND word = 'wait';
UPDATE case_ SET inflate_distance_cells = CAST(value AS REAL) FROM part WHERE case_id = id AND word = 'distance';
UPDATE case_ SET inflate_time_s = CAST(value AS REAL) FROM part WHERE case_id = id AND word = 'time';
UPDATE case_ SET method = 'complete' FROM part WHERE case_id = id AND place = 0 AND text = 'complete';
UPDATE case_ SET fallback = 'complete' FROM part WHERE case_id = id AND place > 0 AND text = 'complete';
UPDATE case_ SET best = step GLOB 'best*', objective = part.objective,
                 improve = iif(instr(step, ':') > 0, substr(step, instr(step, ':') + 1), 'none')
  FROM part WHERE case_id = id AND (step GLOB 'best*' OR step GLOB 'improve:*');

UPDATE case_ SET planner = 'sipplab' || iif(any_angle, '', ' any-angle:no') ||
    iif(connectedness = 2, '', ' connectedness:' || connectedness) ||
    ifnull((SELECT group_concat(text, '') FROM
      (SELECT CASE WHEN word = 'weight' THEN ' weight:' || value
                   WHEN word = 'turns' THEN ' turns:yes'
                   WHEN word = 'wait' THEN ' wait-before-move:' || value
                   WHEN word = 'distance' THEN ' inflate-distance:' || value
                   WHEN word = 'time' THEN ' inflate-time:' || value
                   WHEN text = 'complete' THEN iif(place = 0, ' method:complete', ' fallback:complete')
                   WHEN step GLOB 'best*' OR step GLOB 'improve:*' THEN
                     iif(step GLOB 'best*', ' best:yes', '') ||
                     iif(case_.improve = 'none', '', ' improve:' || case_.improve) ||
                     iif(case_.objective = 'flowtime', '', ' objective:' || case_.objective)
              END AS text
         FROM part WHERE case_id = case_.id ORDER BY place)), '')
  WHERE planner NOT GLOB 'cmd:*';

DROP TABLE part;

-- A column of case_ that a later schema adds is here by itself.
CREATE VIEW v_cases AS SELECT id AS case_id, * FROM case_;
