-- What recordings are called, the anchors of regression runs, and what a run shows beside its document.

-- {"labels": {...}, "session": "...", "recorded_at": "..."}. No result depends on it, so that it changes without a revision
-- of the recording; the ETag counts its changes apart.
ALTER TABLE recordings ADD COLUMN tags_json TEXT NOT NULL DEFAULT '{}';
ALTER TABLE recordings ADD COLUMN tags_revision INTEGER NOT NULL DEFAULT 0;

-- The label that a device is compared with until somebody moves it; the last one holds, those before are its history.
CREATE TABLE anchors (
  id         TEXT NOT NULL PRIMARY KEY,
  device_id  TEXT NOT NULL REFERENCES devices (id) ON DELETE CASCADE,
  label      TEXT NOT NULL CHECK (label <> ''),
  reason     TEXT NOT NULL CHECK (reason <> ''),
  created_at INTEGER NOT NULL
) STRICT;

CREATE INDEX anchors_by_device ON anchors (device_id, id);

-- Texts and figures that a job made of its result for people and pipelines.
CREATE TABLE artefacts (
  job_id  TEXT NOT NULL REFERENCES job_results (job_id) ON DELETE CASCADE,
  name    TEXT NOT NULL CHECK (name <> ''),
  content TEXT NOT NULL,
  PRIMARY KEY (job_id, name)
) STRICT, WITHOUT ROWID;
