-- Programs of schema 20 and later may work beside it.
-- The next job is found at the heads of a few lines and not by sorting all that wait: one line for those whom a job was
-- asked for by, and priority.
ALTER TABLE jobs ADD COLUMN asked_by TEXT NOT NULL DEFAULT '';

CREATE TRIGGER who_asked_is_noted AFTER INSERT ON owners
BEGIN
  UPDATE jobs SET asked_by = (SELECT group_concat(token_id, ' ') FROM (SELECT token_id FROM owners WHERE object_id = NEW.object_id ORDER BY token_id))
  WHERE id = NEW.object_id AND finished_at IS NULL;
END;

UPDATE jobs SET asked_by = (SELECT group_concat(token_id, ' ') FROM (SELECT token_id FROM owners WHERE object_id = jobs.id ORDER BY token_id))
WHERE finished_at IS NULL AND EXISTS (SELECT 1 FROM owners WHERE object_id = jobs.id);

DROP INDEX jobs_queued;
CREATE INDEX jobs_waiting ON jobs (asked_by, priority, run_at, id) WHERE state = 'queued';
