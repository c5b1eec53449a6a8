-- Simulation models with their revisions, and the investigations that made them.

-- A model never changes: a changed one is a child, and its provenance says what changed and why.
CREATE TABLE models (
  id              TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  parent_id       TEXT COLLATE "C" REFERENCES models (id),
  device_id       TEXT COLLATE "C" REFERENCES devices (id),
  unique_key      TEXT COLLATE "C" NOT NULL UNIQUE CHECK (unique_key <> ''),
  name            TEXT COLLATE "C" NOT NULL,
  document_json   TEXT COLLATE "C" NOT NULL,
  provenance_json TEXT COLLATE "C" NOT NULL,
  created_at      BIGINT NOT NULL
);

CREATE INDEX models_by_device ON models (device_id, id);
CREATE INDEX models_by_parent ON models (parent_id, id);

-- The report itself is the result of the job; models outlive it.
CREATE TABLE investigations (
  id           TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  job_id       TEXT COLLATE "C" NOT NULL UNIQUE REFERENCES job_results (job_id) ON DELETE CASCADE,
  device_id    TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  study_id     TEXT COLLATE "C" NOT NULL REFERENCES studies (id),
  baseline_id  TEXT COLLATE "C" NOT NULL REFERENCES models (id),
  model_id     TEXT COLLATE "C" NOT NULL REFERENCES models (id),
  summary_json TEXT COLLATE "C" NOT NULL,
  page         TEXT COLLATE "C" NOT NULL,
  created_at   BIGINT NOT NULL
);

CREATE INDEX investigations_by_device ON investigations (device_id, id);
CREATE INDEX investigations_by_study ON investigations (study_id, id);
