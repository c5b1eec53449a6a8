-- What recordings are called, the anchors of regression runs, and what a run shows beside its document.

-- {"labels": {...}, "session": "...", "recorded_at": "..."}. No result depends on it, so that it changes without a revision
-- of the recording; the ETag counts its changes apart.
ALTER TABLE recordings ADD COLUMN tags_json TEXT COLLATE "C" NOT NULL DEFAULT '{}';
ALTER TABLE recordings ADD COLUMN tags_revision BIGINT NOT NULL DEFAULT 0;

-- The label that a device is compared with until somebody moves it; the last one holds, those before are its history.
CREATE TABLE anchors (
  id         TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  device_id  TEXT COLLATE "C" NOT NULL REFERENCES devices (id) ON DELETE CASCADE,
  label      TEXT COLLATE "C" NOT NULL CHECK (label <> ''),
  reason     TEXT COLLATE "C" NOT NULL CHECK (reason <> ''),
  created_at BIGINT NOT NULL
);

CREATE INDEX anchors_by_device ON anchors (device_id, id);

-- Texts and figures that a job made of its result for people and pipelines.
CREATE TABLE artefacts (
  job_id  TEXT COLLATE "C" NOT NULL REFERENCES job_results (job_id) ON DELETE CASCADE,
  name    TEXT COLLATE "C" NOT NULL CHECK (name <> ''),
  content TEXT COLLATE "C" NOT NULL,
  PRIMARY KEY (job_id, name)
);
