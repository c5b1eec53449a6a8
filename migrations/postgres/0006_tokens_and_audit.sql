-- Who may do what, and who did what.

-- A token is kept for ever, so that the audit log's ids always lead somewhere; a secret only as its SHA-256.
CREATE TABLE tokens (
  id            TEXT COLLATE "C" NOT NULL PRIMARY KEY CHECK (length(id) = 8),
  name          TEXT COLLATE "C" NOT NULL CHECK (name <> ''),
  scope         TEXT COLLATE "C" NOT NULL CHECK (scope IN ('read', 'write', 'run', 'admin')),
  devices_json  TEXT COLLATE "C" CHECK (devices_json IS NULL OR scope <> 'admin'),
  secret_sha256 TEXT COLLATE "C" NOT NULL UNIQUE CHECK (length(secret_sha256) = 64),
  created_at    BIGINT NOT NULL,
  expires_at    BIGINT,
  revoked_at    BIGINT,
  rotated_at    BIGINT,
  last_used_at  BIGINT
);

CREATE TABLE sessions (
  secret_sha256 TEXT COLLATE "C" NOT NULL PRIMARY KEY CHECK (length(secret_sha256) = 64),
  token_id      TEXT COLLATE "C" NOT NULL REFERENCES tokens (id),
  created_at    BIGINT NOT NULL,
  expires_at    BIGINT NOT NULL
);

CREATE INDEX sessions_by_token ON sessions (token_id, created_at);

-- A chain (server/store/audit.hpp): rows are added and never changed.
CREATE TABLE audit (
  sequence   BIGINT PRIMARY KEY,
  at         BIGINT NOT NULL,
  actor      TEXT COLLATE "C" NOT NULL CHECK (actor <> ''),
  action     TEXT COLLATE "C" NOT NULL CHECK (action <> ''),
  object     TEXT COLLATE "C" NOT NULL,
  request_id TEXT COLLATE "C" NOT NULL,
  address    TEXT COLLATE "C" NOT NULL,
  detail     TEXT COLLATE "C" NOT NULL,
  previous   TEXT COLLATE "C" NOT NULL CHECK (length(previous) = 64),
  digest     TEXT COLLATE "C" NOT NULL CHECK (length(digest) = 64)
);

CREATE FUNCTION refuse_to_change_the_audit_log() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  RAISE EXCEPTION 'the audit log is only added to';
END
$body$;

CREATE TRIGGER audit_is_not_changed BEFORE UPDATE OR DELETE OR TRUNCATE ON audit
  FOR EACH STATEMENT EXECUTE FUNCTION refuse_to_change_the_audit_log();

-- Who asked for an object. One that names no device is seen, of all tokens that are limited to devices, by these alone.
CREATE TABLE owners (
  object_id TEXT COLLATE "C" NOT NULL,
  token_id  TEXT COLLATE "C" NOT NULL REFERENCES tokens (id),
  PRIMARY KEY (object_id, token_id)
);

-- The devices that a job's request names, itself or by a recording, a study, ... of theirs.
CREATE TABLE job_devices (
  job_id    TEXT COLLATE "C" NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  device_id TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  PRIMARY KEY (job_id, device_id)
);
