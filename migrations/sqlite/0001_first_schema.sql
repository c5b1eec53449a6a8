-- Devices, blobs, recordings, jobs with their history, results, replies.
-- Times are microseconds since 1970 UTC. Members ending in _json are text that the database does not read.

CREATE TABLE devices (
  id          TEXT NOT NULL PRIMARY KEY,
  name        TEXT NOT NULL UNIQUE CHECK (name <> ''),
  model       TEXT NOT NULL,
  imu         TEXT NOT NULL,
  serial      TEXT NOT NULL,
  labels_json TEXT NOT NULL,
  revision    INTEGER NOT NULL CHECK (revision >= 1),
  created_at  INTEGER NOT NULL,
  updated_at  INTEGER NOT NULL
) STRICT;

CREATE TABLE blobs (
  sha256       TEXT NOT NULL PRIMARY KEY CHECK (length(sha256) = 64 AND sha256 NOT GLOB '*[^0-9a-f]*'),
  bytes        INTEGER NOT NULL CHECK (bytes >= 0),
  format       TEXT NOT NULL,
  compression  TEXT NOT NULL,
  row_count    INTEGER NOT NULL CHECK (row_count >= 0),
  columns_json TEXT NOT NULL,
  notes_json   TEXT NOT NULL,
  created_at   INTEGER NOT NULL
) STRICT;

CREATE TABLE recordings (
  id            TEXT NOT NULL PRIMARY KEY,
  device_id     TEXT NOT NULL REFERENCES devices (id),
  blob_sha256   TEXT NOT NULL REFERENCES blobs (sha256),
  revision      INTEGER NOT NULL CHECK (revision >= 1),
  metadata_json TEXT NOT NULL,
  condition     TEXT NOT NULL,
  quality_json  TEXT NOT NULL,
  created_at    INTEGER NOT NULL,
  updated_at    INTEGER NOT NULL,
  UNIQUE (device_id, blob_sha256)
) STRICT;

CREATE INDEX recordings_by_blob ON recordings (blob_sha256);

-- The state machine of server/jobs/README.md.
CREATE TABLE jobs (
  id               TEXT NOT NULL PRIMARY KEY,
  kind             TEXT NOT NULL CHECK (kind <> ''),
  state            TEXT NOT NULL CHECK (state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled', 'dead')),
  stage            TEXT NOT NULL DEFAULT '',
  progress         REAL NOT NULL DEFAULT 0 CHECK (progress BETWEEN 0 AND 1),
  priority         INTEGER NOT NULL CHECK (priority BETWEEN 0 AND 9),
  attempt          INTEGER NOT NULL DEFAULT 0 CHECK (attempt >= 0),
  failures         INTEGER NOT NULL DEFAULT 0 CHECK (failures BETWEEN 0 AND max_failures),
  faults           INTEGER NOT NULL DEFAULT 0 CHECK (faults BETWEEN 0 AND 2),
  max_failures     INTEGER NOT NULL CHECK (max_failures >= 1),
  unique_key       TEXT NOT NULL CHECK (unique_key <> ''),
  request_json     TEXT NOT NULL,
  cancel_requested INTEGER NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
  run_at           INTEGER NOT NULL,
  lease_expires_at INTEGER,
  created_at       INTEGER NOT NULL,
  started_at       INTEGER,
  finished_at      INTEGER,
  problem_json     TEXT NOT NULL DEFAULT '',
  CHECK ((finished_at IS NOT NULL) = (state IN ('succeeded', 'failed', 'cancelled', 'dead'))),
  CHECK ((lease_expires_at IS NOT NULL) = (state = 'running')),
  CHECK (state <> 'running' OR (attempt >= 1 AND started_at IS NOT NULL)),
  CHECK (state <> 'queued' OR cancel_requested = 0)
) STRICT;

-- An equal job is one job while it lives and once it has succeeded; a failed one may be asked for again.
CREATE UNIQUE INDEX jobs_unique ON jobs (unique_key) WHERE state IN ('queued', 'running', 'succeeded');
CREATE INDEX jobs_queued ON jobs (run_at) WHERE state = 'queued';
CREATE INDEX jobs_running ON jobs (lease_expires_at) WHERE state = 'running';

-- The sequence is never used again, so that it can be the id of a server-sent event.
CREATE TABLE job_events (
  sequence INTEGER PRIMARY KEY AUTOINCREMENT,
  job_id   TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  type     TEXT NOT NULL CHECK (type IN ('state', 'progress')),
  state    TEXT NOT NULL CHECK (state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled', 'dead')),
  stage    TEXT NOT NULL,
  progress REAL NOT NULL CHECK (progress BETWEEN 0 AND 1),
  attempt  INTEGER NOT NULL,
  at       INTEGER NOT NULL
) STRICT;

CREATE INDEX job_events_by_job ON job_events (job_id, sequence);

-- Every attempt that failed, with its problem.
CREATE TABLE job_attempts (
  job_id       TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  attempt      INTEGER NOT NULL CHECK (attempt >= 1),
  started_at   INTEGER NOT NULL,
  failed_at    INTEGER NOT NULL,
  fault_signal INTEGER NOT NULL CHECK (fault_signal IN (0, 1)),
  problem_json TEXT NOT NULL,
  PRIMARY KEY (job_id, attempt)
) STRICT;

CREATE TABLE job_results (
  job_id        TEXT NOT NULL PRIMARY KEY REFERENCES jobs (id) ON DELETE CASCADE,
  document_json TEXT NOT NULL,
  created_at    INTEGER NOT NULL
) STRICT;

-- The sequence says which result is the latest, whatever the clock did.
CREATE TABLE channel_results (
  sequence           INTEGER PRIMARY KEY AUTOINCREMENT,
  id                 TEXT NOT NULL UNIQUE,
  job_id             TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  device_id          TEXT NOT NULL REFERENCES devices (id),
  recording_id       TEXT NOT NULL REFERENCES recordings (id) ON DELETE CASCADE,
  recording_revision INTEGER NOT NULL CHECK (recording_revision >= 1),
  channel            TEXT NOT NULL,
  quantity           TEXT NOT NULL,
  axis               TEXT NOT NULL,
  condition          TEXT NOT NULL,
  document_json      TEXT NOT NULL,
  settings_json      TEXT NOT NULL,
  created_at         INTEGER NOT NULL,
  UNIQUE (job_id, recording_id, channel)
) STRICT;

CREATE INDEX channel_results_latest ON channel_results (recording_id, channel, sequence);
CREATE INDEX channel_results_by_device ON channel_results (device_id);

CREATE TABLE fits (
  id                 TEXT NOT NULL PRIMARY KEY,
  channel_result_id  TEXT NOT NULL REFERENCES channel_results (id) ON DELETE CASCADE,
  job_id             TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  device_id          TEXT NOT NULL REFERENCES devices (id),
  recording_id       TEXT NOT NULL REFERENCES recordings (id) ON DELETE CASCADE,
  recording_revision INTEGER NOT NULL CHECK (recording_revision >= 1),
  channel            TEXT NOT NULL,
  quantity           TEXT NOT NULL,
  axis               TEXT NOT NULL,
  condition          TEXT NOT NULL,
  model              TEXT NOT NULL,
  rank               INTEGER NOT NULL CHECK (rank >= 0),
  document_json      TEXT NOT NULL,
  created_at         INTEGER NOT NULL,
  UNIQUE (channel_result_id, rank)
) STRICT;

CREATE INDEX fits_by_job ON fits (job_id, id);
CREATE INDEX fits_by_device ON fits (device_id, id);
CREATE INDEX fits_by_recording ON fits (recording_id, id);

CREATE TABLE idempotent_replies (
  key          TEXT NOT NULL PRIMARY KEY CHECK (key <> ''),
  method       TEXT NOT NULL,
  target       TEXT NOT NULL,
  body_sha256  TEXT NOT NULL,
  status       INTEGER NOT NULL,
  headers_json TEXT NOT NULL,
  body         TEXT NOT NULL,
  created_at   INTEGER NOT NULL
) STRICT;

CREATE INDEX idempotent_replies_by_age ON idempotent_replies (created_at);
