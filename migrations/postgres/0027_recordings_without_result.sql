-- Programs of schema 21 and later may work beside it.
-- Recordings that may have no result are found where nearly all have one. Triggers put them on the list; a sweep takes those off it that have one by
-- now, so that whoever ends a job has nothing more to write.
CREATE TABLE recordings_without_result (
  recording_id TEXT COLLATE "C" NOT NULL PRIMARY KEY
);

-- Before anybody is held up: the locks of what follows last until the end.
INSERT INTO recordings_without_result (recording_id)
SELECT id FROM recordings WHERE NOT EXISTS (SELECT 1 FROM channel_results WHERE recording_id = recordings.id);

CREATE FUNCTION note_recording_without_result() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  INSERT INTO recordings_without_result (recording_id) VALUES (NEW.id);
  RETURN NULL;
END
$body$;

CREATE FUNCTION note_recording_without_result_again() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  INSERT INTO recordings_without_result (recording_id) SELECT id FROM recordings WHERE id = OLD.recording_id
  ON CONFLICT DO NOTHING;
  RETURN NULL;
END
$body$;

CREATE TRIGGER recording_has_no_result AFTER INSERT ON recordings
FOR EACH ROW EXECUTE FUNCTION note_recording_without_result();
CREATE TRIGGER recording_has_no_result_again AFTER DELETE ON channel_results
FOR EACH ROW EXECUTE FUNCTION note_recording_without_result_again();

-- What came meanwhile is among the newest.
INSERT INTO recordings_without_result (recording_id)
SELECT id FROM (SELECT id FROM recordings ORDER BY id DESC LIMIT 10000) AS newest
WHERE NOT EXISTS (SELECT 1 FROM channel_results WHERE recording_id = newest.id)
ON CONFLICT DO NOTHING;
DELETE FROM recordings_without_result WHERE NOT EXISTS (SELECT 1 FROM recordings WHERE id = recording_id);
ALTER TABLE recordings_without_result ADD FOREIGN KEY (recording_id) REFERENCES recordings (id) ON DELETE CASCADE;
