-- Hints for other daemons and workers on this database (LISTEN, NOTIFY), and stored files in parts.

-- `KIND ORIGIN REST`: who changed it (driftlab.origin of its connection) need not be told.
CREATE FUNCTION tell_others(kind TEXT, rest TEXT) RETURNS VOID LANGUAGE plpgsql AS $body$
BEGIN
  PERFORM pg_notify('driftlab_' || md5(current_schema()),
                    kind || ' ' || coalesce(nullif(current_setting('driftlab.origin', true), ''), '-') || ' ' || rest);
END
$body$;

CREATE FUNCTION tell_of_job_event() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  PERFORM tell_others('job', NEW.job_id || ' ' || CASE NEW.type WHEN 'state' THEN NEW.state ELSE NEW.type END);
  RETURN NULL;
END
$body$;

CREATE FUNCTION tell_of_cancel() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  PERFORM tell_others('job', NEW.id || ' cancel');
  RETURN NULL;
END
$body$;

CREATE FUNCTION tell_of_access() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  PERFORM tell_others('access', '');
  RETURN NULL;
END
$body$;

CREATE TRIGGER job_events_are_told AFTER INSERT ON job_events FOR EACH ROW EXECUTE FUNCTION tell_of_job_event();
CREATE TRIGGER cancel_is_told AFTER UPDATE OF cancel_requested ON jobs FOR EACH ROW
  WHEN (NEW.cancel_requested = 1 AND OLD.cancel_requested = 0 AND NEW.state = 'running') EXECUTE FUNCTION tell_of_cancel();
CREATE TRIGGER tokens_are_told AFTER INSERT OR DELETE OR UPDATE OF secret_sha256, revoked_at, expires_at ON tokens
  FOR EACH STATEMENT EXECUTE FUNCTION tell_of_access();
CREATE TRIGGER sessions_are_told AFTER INSERT OR DELETE ON sessions FOR EACH STATEMENT EXECUTE FUNCTION tell_of_access();

-- A file that belongs to a blob, in parts of at most 1 MiB. It is there once `kind` is set: parts are written before.
CREATE TABLE stored_files (
  id         BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  blob       TEXT COLLATE "C" NOT NULL CHECK (length(blob) = 64),
  kind       TEXT COLLATE "C" CHECK (kind IN ('bytes', 'columns', 'columns.sha256', 'pyramid', 'pyramid.sha256')),
  bytes      BIGINT NOT NULL DEFAULT 0 CHECK (bytes >= 0),
  sha256     TEXT COLLATE "C" NOT NULL DEFAULT '',
  written_at BIGINT NOT NULL,
  UNIQUE (blob, kind)
);

CREATE INDEX stored_files_by_age ON stored_files (written_at);

CREATE TABLE stored_file_parts (
  file_id BIGINT NOT NULL REFERENCES stored_files (id) ON DELETE CASCADE,
  number  BIGINT NOT NULL CHECK (number >= 0),
  content BYTEA NOT NULL,
  PRIMARY KEY (file_id, number)
);
ALTER TABLE stored_file_parts ALTER COLUMN content SET STORAGE EXTERNAL;
