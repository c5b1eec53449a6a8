-- Simulation models with their revisions, and the investigations that made them.

-- A model never changes: a changed one is a child, and its provenance says what changed and why.
CREATE TABLE models (
  id              TEXT NOT NULL PRIMARY KEY,
  parent_id       TEXT REFERENCES models (id),
  device_id       TEXT REFERENCES devices (id),
  unique_key      TEXT NOT NULL UNIQUE CHECK (unique_key <> ''),
  name            TEXT NOT NULL,
  document_json   TEXT NOT NULL,
  provenance_json TEXT NOT NULL,
  created_at      INTEGER NOT NULL
) STRICT;

CREATE INDEX models_by_device ON models (device_id, id);
CREATE INDEX models_by_parent ON models (parent_id, id);

-- The report itself is the result of the job; models outlive it.
CREATE TABLE investigations (
  id           TEXT NOT NULL PRIMARY KEY,
  job_id       TEXT NOT NULL UNIQUE REFERENCES job_results (job_id) ON DELETE CASCADE,
  device_id    TEXT NOT NULL REFERENCES devices (id),
  study_id     TEXT NOT NULL REFERENCES studies (id),
  baseline_id  TEXT NOT NULL REFERENCES models (id),
  model_id     TEXT NOT NULL REFERENCES models (id),
  summary_json TEXT NOT NULL,
  page         TEXT NOT NULL,
  created_at   INTEGER NOT NULL
) STRICT;

CREATE INDEX investigations_by_device ON investigations (device_id, id);
CREATE INDEX investigations_by_study ON investigations (study_id, id);
