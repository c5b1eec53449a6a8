-- Who may do what, and who did what.

-- A token is kept for ever, so that the audit log's ids always lead somewhere; a secret only as its SHA-256.
CREATE TABLE tokens (
  id            TEXT NOT NULL PRIMARY KEY CHECK (length(id) = 8),
  name          TEXT NOT NULL CHECK (name <> ''),
  scope         TEXT NOT NULL CHECK (scope IN ('read', 'write', 'run', 'admin')),
  devices_json  TEXT CHECK (devices_json IS NULL OR scope <> 'admin'),
  secret_sha256 TEXT NOT NULL UNIQUE CHECK (length(secret_sha256) = 64),
  created_at    INTEGER NOT NULL,
  expires_at    INTEGER,
  revoked_at    INTEGER,
  rotated_at    INTEGER,
  last_used_at  INTEGER
) STRICT;

CREATE TABLE sessions (
  secret_sha256 TEXT NOT NULL PRIMARY KEY CHECK (length(secret_sha256) = 64),
  token_id      TEXT NOT NULL REFERENCES tokens (id),
  created_at    INTEGER NOT NULL,
  expires_at    INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

CREATE INDEX sessions_by_token ON sessions (token_id, created_at);

-- A chain (server/store/audit.hpp): rows are added and never changed.
CREATE TABLE audit (
  sequence   INTEGER PRIMARY KEY,
  at         INTEGER NOT NULL,
  actor      TEXT NOT NULL CHECK (actor <> ''),
  action     TEXT NOT NULL CHECK (action <> ''),
  object     TEXT NOT NULL,
  request_id TEXT NOT NULL,
  address    TEXT NOT NULL,
  detail     TEXT NOT NULL,
  previous   TEXT NOT NULL CHECK (length(previous) = 64),
  digest     TEXT NOT NULL CHECK (length(digest) = 64)
) STRICT;

CREATE TRIGGER audit_is_not_changed BEFORE UPDATE ON audit
BEGIN
  SELECT RAISE (ABORT, 'the audit log is only added to');
END;

CREATE TRIGGER audit_is_not_shortened BEFORE DELETE ON audit
BEGIN
  SELECT RAISE (ABORT, 'the audit log is only added to');
END;

-- Who asked for an object. One that names no device is seen, of all tokens that are limited to devices, by these alone.
CREATE TABLE owners (
  object_id TEXT NOT NULL,
  token_id  TEXT NOT NULL REFERENCES tokens (id),
  PRIMARY KEY (object_id, token_id)
) STRICT, WITHOUT ROWID;

-- The devices that a job's request names, itself or by a recording, a study, ... of theirs.
CREATE TABLE job_devices (
  job_id    TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  device_id TEXT NOT NULL REFERENCES devices (id),
  PRIMARY KEY (job_id, device_id)
) STRICT, WITHOUT ROWID;

WITH named (job_id, id) AS (
  SELECT DISTINCT jobs.id, leaf.atom FROM jobs, json_tree(CASE WHEN json_valid(jobs.request_json) THEN jobs.request_json ELSE 'null' END) AS leaf
  WHERE leaf.type = 'text'
)
INSERT INTO job_devices (job_id, device_id)
SELECT named.job_id, devices.id FROM named JOIN devices ON devices.id = named.id
UNION SELECT named.job_id, recordings.device_id FROM named JOIN recordings ON recordings.id = named.id
UNION SELECT named.job_id, studies.device_id FROM named JOIN studies ON studies.id = named.id
UNION SELECT named.job_id, calibrations.device_id FROM named JOIN calibrations ON calibrations.id = named.id
UNION SELECT named.job_id, models.device_id FROM named JOIN models ON models.id = named.id WHERE models.device_id IS NOT NULL
UNION SELECT named.job_id, fits.device_id FROM named JOIN fits ON fits.id = named.id
UNION SELECT named.job_id, channel_results.device_id FROM named JOIN channel_results ON channel_results.id = named.id;
