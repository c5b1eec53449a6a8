-- What wants a look, what recordings are called, and what lists are sorted and sought by.

-- Results whose verdict a person must read: of a recording by its newest characterisation, of every other job as a whole.
CREATE TABLE attention (
  id           TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  job_id       TEXT COLLATE "C" NOT NULL REFERENCES job_results (job_id) ON DELETE CASCADE,
  device_id    TEXT COLLATE "C" REFERENCES devices (id) ON DELETE CASCADE,
  recording_id TEXT COLLATE "C" REFERENCES recordings (id) ON DELETE CASCADE,
  channel      TEXT COLLATE "C" NOT NULL,
  level        TEXT COLLATE "C" NOT NULL CHECK (level IN ('look', 'wrong')),
  verdict      TEXT COLLATE "C" NOT NULL CHECK (verdict <> ''),
  created_at   BIGINT NOT NULL
);

CREATE INDEX attention_by_job ON attention (job_id);
CREATE INDEX attention_by_device ON attention (device_id, id);
CREATE INDEX attention_by_recording ON attention (recording_id);

-- The recordings that a job's request names.
CREATE TABLE job_recordings (
  job_id       TEXT COLLATE "C" NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  recording_id TEXT COLLATE "C" NOT NULL REFERENCES recordings (id) ON DELETE CASCADE,
  PRIMARY KEY (job_id, recording_id)
);

INSERT INTO job_recordings (job_id, recording_id)
SELECT DISTINCT jobs.id, recordings.id
FROM jobs, LATERAL regexp_matches(jobs.request_json, '"(rec_[0-9A-Z]+)"', 'g') AS named, recordings
WHERE recordings.id = named[1];

CREATE INDEX job_recordings_by_recording ON job_recordings (recording_id, job_id);
CREATE INDEX job_devices_by_device ON job_devices (device_id, job_id);
CREATE INDEX jobs_by_kind ON jobs (kind, id);
CREATE INDEX jobs_finished ON jobs (finished_at, state, kind) WHERE finished_at IS NOT NULL;

-- What the file was called that was uploaded; empty where nobody said. Without a name of its own a recording has that one.
ALTER TABLE recordings ADD COLUMN file_name TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE recordings ADD COLUMN name TEXT COLLATE "C" NOT NULL DEFAULT '';
UPDATE recordings SET name = coalesce(json_extract(metadata_json, '$.id'), '');

CREATE INDEX recordings_by_name ON recordings (name, id);
CREATE INDEX recordings_by_device ON recordings (device_id, id);
CREATE INDEX models_by_name ON models (name, id);
