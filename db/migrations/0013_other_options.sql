-- Schema 13: options of the planner that have no column of their own. A new option needs no migration.

ALTER TABLE case_ ADD COLUMN options TEXT NOT NULL DEFAULT '{}' CHECK (json_valid(options));
