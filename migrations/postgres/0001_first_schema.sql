-- Devices, blobs, recordings, jobs with their history, results, replies.
-- Times are microseconds since 1970 UTC. Members ending in _json are text that the database does not read, but for the
-- functions below. Texts are in the order of their bytes, whatever the locale of the cluster.

-- What SQLite calls these, so that both engines read the texts of server/store/sql. A document that is none, or holds
-- the character U+0000, which no text of PostgreSQL can, has no members.
CREATE FUNCTION instr(whole TEXT, part TEXT) RETURNS BIGINT
  LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE AS 'SELECT strpos(whole, part)::BIGINT';

CREATE FUNCTION json_each(list TEXT) RETURNS TABLE (value TEXT)
  LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE AS 'SELECT json_array_elements_text(list::JSON)';

CREATE FUNCTION json_each(document TEXT, path TEXT) RETURNS TABLE (key TEXT, value TEXT)
  LANGUAGE plpgsql IMMUTABLE STRICT AS $body$
BEGIN
  RETURN QUERY SELECT member.key, member.value
    FROM json_each_text(document::JSON #> string_to_array(substr(path, 3), '.')) AS member;
EXCEPTION WHEN data_exception THEN
  RETURN;
END
$body$;

CREATE FUNCTION json_extract(document TEXT, path TEXT) RETURNS TEXT
  LANGUAGE plpgsql IMMUTABLE STRICT AS $body$
BEGIN
  RETURN document::JSON #>> string_to_array(substr(path, 3), '.');
EXCEPTION WHEN data_exception THEN
  RETURN NULL;
END
$body$;

-- Tells this database from every other: the directory that keeps its recordings holds the same word.
CREATE TABLE store_identity (
  word TEXT COLLATE "C" NOT NULL
);
INSERT INTO store_identity (word) VALUES (gen_random_uuid()::TEXT);

CREATE TABLE devices (
  id          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  name        TEXT COLLATE "C" NOT NULL UNIQUE CHECK (name <> ''),
  model       TEXT COLLATE "C" NOT NULL,
  imu         TEXT COLLATE "C" NOT NULL,
  serial      TEXT COLLATE "C" NOT NULL,
  labels_json TEXT COLLATE "C" NOT NULL,
  revision    BIGINT NOT NULL CHECK (revision >= 1),
  created_at  BIGINT NOT NULL,
  updated_at  BIGINT NOT NULL
);

CREATE TABLE blobs (
  sha256       TEXT COLLATE "C" NOT NULL PRIMARY KEY CHECK (length(sha256) = 64 AND sha256 ~ '^[0-9a-f]*$'),
  bytes        BIGINT NOT NULL CHECK (bytes >= 0),
  format       TEXT COLLATE "C" NOT NULL,
  compression  TEXT COLLATE "C" NOT NULL,
  row_count    BIGINT NOT NULL CHECK (row_count >= 0),
  columns_json TEXT COLLATE "C" NOT NULL,
  notes_json   TEXT COLLATE "C" NOT NULL,
  created_at   BIGINT NOT NULL
);

CREATE TABLE recordings (
  id            TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  device_id     TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  blob_sha256   TEXT COLLATE "C" NOT NULL REFERENCES blobs (sha256),
  revision      BIGINT NOT NULL CHECK (revision >= 1),
  metadata_json TEXT COLLATE "C" NOT NULL,
  condition     TEXT COLLATE "C" NOT NULL,
  quality_json  TEXT COLLATE "C" NOT NULL,
  created_at    BIGINT NOT NULL,
  updated_at    BIGINT NOT NULL,
  UNIQUE (device_id, blob_sha256)
);

CREATE INDEX recordings_by_blob ON recordings (blob_sha256);

-- The state machine of server/jobs/README.md.
CREATE TABLE jobs (
  id               TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  kind             TEXT COLLATE "C" NOT NULL CHECK (kind <> ''),
  state            TEXT COLLATE "C" NOT NULL CHECK (state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled', 'dead')),
  stage            TEXT COLLATE "C" NOT NULL DEFAULT '',
  progress         DOUBLE PRECISION NOT NULL DEFAULT 0 CHECK (progress BETWEEN 0 AND 1),
  priority         BIGINT NOT NULL CHECK (priority BETWEEN 0 AND 9),
  attempt          BIGINT NOT NULL DEFAULT 0 CHECK (attempt >= 0),
  failures         BIGINT NOT NULL DEFAULT 0 CHECK (failures BETWEEN 0 AND max_failures),
  faults           BIGINT NOT NULL DEFAULT 0 CHECK (faults BETWEEN 0 AND 2),
  max_failures     BIGINT NOT NULL CHECK (max_failures >= 1),
  unique_key       TEXT COLLATE "C" NOT NULL CHECK (unique_key <> ''),
  request_json     TEXT COLLATE "C" NOT NULL,
  cancel_requested BIGINT NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
  run_at           BIGINT NOT NULL,
  lease_expires_at BIGINT,
  created_at       BIGINT NOT NULL,
  started_at       BIGINT,
  finished_at      BIGINT,
  problem_json     TEXT COLLATE "C" NOT NULL DEFAULT '',
  CHECK ((finished_at IS NOT NULL) = (state IN ('succeeded', 'failed', 'cancelled', 'dead'))),
  CHECK ((lease_expires_at IS NOT NULL) = (state = 'running')),
  CHECK (state <> 'running' OR (attempt >= 1 AND started_at IS NOT NULL)),
  CHECK (state <> 'queued' OR cancel_requested = 0)
);

-- An equal job is one job while it lives and once it has succeeded; a failed one may be asked for again.
CREATE UNIQUE INDEX jobs_unique ON jobs (unique_key) WHERE state IN ('queued', 'running', 'succeeded');
CREATE INDEX jobs_queued ON jobs (run_at) WHERE state = 'queued';
CREATE INDEX jobs_running ON jobs (lease_expires_at) WHERE state = 'running';

-- The sequence is never used again, so that it can be the id of a server-sent event.
CREATE TABLE job_events (
  sequence BIGINT GENERATED BY DEFAULT AS IDENTITY PRIMARY KEY,
  job_id   TEXT COLLATE "C" NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  type     TEXT COLLATE "C" NOT NULL CHECK (type IN ('state', 'progress')),
  state    TEXT COLLATE "C" NOT NULL CHECK (state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled', 'dead')),
  stage    TEXT COLLATE "C" NOT NULL,
  progress DOUBLE PRECISION NOT NULL CHECK (progress BETWEEN 0 AND 1),
  attempt  BIGINT NOT NULL,
  at       BIGINT NOT NULL
);

CREATE INDEX job_events_by_job ON job_events (job_id, sequence);

-- Every attempt that failed, with its problem.
CREATE TABLE job_attempts (
  job_id       TEXT COLLATE "C" NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  attempt      BIGINT NOT NULL CHECK (attempt >= 1),
  started_at   BIGINT NOT NULL,
  failed_at    BIGINT NOT NULL,
  fault_signal BIGINT NOT NULL CHECK (fault_signal IN (0, 1)),
  problem_json TEXT COLLATE "C" NOT NULL,
  PRIMARY KEY (job_id, attempt)
);

CREATE TABLE job_results (
  job_id        TEXT COLLATE "C" NOT NULL PRIMARY KEY REFERENCES jobs (id) ON DELETE CASCADE,
  document_json TEXT COLLATE "C" NOT NULL,
  created_at    BIGINT NOT NULL
);

-- The sequence says which result is the latest, whatever the clock did.
CREATE TABLE channel_results (
  sequence           BIGINT GENERATED BY DEFAULT AS IDENTITY PRIMARY KEY,
  id                 TEXT COLLATE "C" NOT NULL UNIQUE,
  job_id             TEXT COLLATE "C" NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  device_id          TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  recording_id       TEXT COLLATE "C" NOT NULL REFERENCES recordings (id) ON DELETE CASCADE,
  recording_revision BIGINT NOT NULL CHECK (recording_revision >= 1),
  channel            TEXT COLLATE "C" NOT NULL,
  quantity           TEXT COLLATE "C" NOT NULL,
  axis               TEXT COLLATE "C" NOT NULL,
  condition          TEXT COLLATE "C" NOT NULL,
  document_json      TEXT COLLATE "C" NOT NULL,
  settings_json      TEXT COLLATE "C" NOT NULL,
  created_at         BIGINT NOT NULL,
  UNIQUE (job_id, recording_id, channel)
);

CREATE INDEX channel_results_latest ON channel_results (recording_id, channel, sequence);
CREATE INDEX channel_results_by_device ON channel_results (device_id);

CREATE TABLE fits (
  id                 TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  channel_result_id  TEXT COLLATE "C" NOT NULL REFERENCES channel_results (id) ON DELETE CASCADE,
  job_id             TEXT COLLATE "C" NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  device_id          TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  recording_id       TEXT COLLATE "C" NOT NULL REFERENCES recordings (id) ON DELETE CASCADE,
  recording_revision BIGINT NOT NULL CHECK (recording_revision >= 1),
  channel            TEXT COLLATE "C" NOT NULL,
  quantity           TEXT COLLATE "C" NOT NULL,
  axis               TEXT COLLATE "C" NOT NULL,
  condition          TEXT COLLATE "C" NOT NULL,
  model              TEXT COLLATE "C" NOT NULL,
  rank               BIGINT NOT NULL CHECK (rank >= 0),
  document_json      TEXT COLLATE "C" NOT NULL,
  created_at         BIGINT NOT NULL,
  UNIQUE (channel_result_id, rank)
);

CREATE INDEX fits_by_job ON fits (job_id, id);
CREATE INDEX fits_by_device ON fits (device_id, id);
CREATE INDEX fits_by_recording ON fits (recording_id, id);

CREATE TABLE idempotent_replies (
  key          TEXT COLLATE "C" NOT NULL PRIMARY KEY CHECK (key <> ''),
  method       TEXT COLLATE "C" NOT NULL,
  target       TEXT COLLATE "C" NOT NULL,
  body_sha256  TEXT COLLATE "C" NOT NULL,
  status       BIGINT NOT NULL,
  headers_json TEXT COLLATE "C" NOT NULL,
  body         TEXT COLLATE "C" NOT NULL,
  created_at   BIGINT NOT NULL
);

CREATE INDEX idempotent_replies_by_age ON idempotent_replies (created_at);
