-- Programs of schema 21 and later may work beside it.
-- Recordings that may have no result are found where nearly all have one. Triggers put them on the list; a sweep takes those off it that have one by
-- now, so that whoever ends a job has nothing more to write.
CREATE TABLE recordings_without_result (
  recording_id TEXT NOT NULL PRIMARY KEY REFERENCES recordings (id) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

CREATE TRIGGER recording_has_no_result AFTER INSERT ON recordings BEGIN
  INSERT INTO recordings_without_result (recording_id) VALUES (NEW.id);
END;

CREATE TRIGGER recording_has_no_result_again AFTER DELETE ON channel_results BEGIN
  INSERT OR IGNORE INTO recordings_without_result (recording_id) SELECT id FROM recordings WHERE id = OLD.recording_id;
END;

INSERT INTO recordings_without_result (recording_id)
SELECT id FROM recordings WHERE NOT EXISTS (SELECT 1 FROM channel_results WHERE recording_id = recordings.id);
