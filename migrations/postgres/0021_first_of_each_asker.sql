-- Programs of schema 20 and later may work beside it.
-- The next job is found at the heads of a few lines and not by sorting all that wait: one line for those whom a job was
-- asked for by, and priority. A trigger keeps it, so that an older daemon beside this one does so too.
ALTER TABLE jobs ADD COLUMN asked_by TEXT COLLATE "C" NOT NULL DEFAULT '';

CREATE FUNCTION note_who_asked() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  UPDATE jobs SET asked_by = (SELECT string_agg(token_id, ' ' ORDER BY token_id) FROM owners WHERE object_id = NEW.object_id)
  WHERE id = NEW.object_id AND finished_at IS NULL;
  RETURN NULL;
END
$body$;

CREATE TRIGGER who_asked_is_noted AFTER INSERT ON owners FOR EACH ROW EXECUTE FUNCTION note_who_asked();

UPDATE jobs SET asked_by = (SELECT string_agg(token_id, ' ' ORDER BY token_id) FROM owners WHERE object_id = jobs.id)
WHERE finished_at IS NULL AND EXISTS (SELECT 1 FROM owners WHERE object_id = jobs.id);

DROP INDEX jobs_queued;
CREATE INDEX jobs_waiting ON jobs (asked_by, priority, run_at, id) WHERE state = 'queued';

-- A request names a few things: of a thousand, which the planner takes a function to return, it would read whole tables.
ALTER FUNCTION json_each(TEXT) ROWS 20;
