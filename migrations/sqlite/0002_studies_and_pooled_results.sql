-- What recordings of one sensor axis say together, and the studies that name recordings.

-- The latest for each axis; it names the channel results it was made of, and counts only while these are the latest too.
CREATE TABLE pooled_results (
  device_id     TEXT NOT NULL REFERENCES devices (id),
  quantity      TEXT NOT NULL,
  axis          TEXT NOT NULL,
  job_id        TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  document_json TEXT NOT NULL,
  created_at    INTEGER NOT NULL,
  PRIMARY KEY (device_id, quantity, axis)
) STRICT, WITHOUT ROWID;

CREATE INDEX pooled_results_by_job ON pooled_results (job_id);

CREATE TABLE studies (
  id            TEXT NOT NULL PRIMARY KEY,
  device_id     TEXT NOT NULL REFERENCES devices (id),
  unique_key    TEXT NOT NULL UNIQUE CHECK (unique_key <> ''),
  document_json TEXT NOT NULL,
  created_at    INTEGER NOT NULL
) STRICT;

CREATE INDEX studies_by_device ON studies (device_id, id);
