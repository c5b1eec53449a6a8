-- Programs of schema 21 and later may work beside it.
-- How many devices and recordings there are, how many recordings a device and a token have, and how many bytes those are as uploaded, is kept by
-- triggers, for to count them reads all their rows, at every upload. kept_by: devices, recordings, blobs, device/ID or token/ID.
CREATE TABLE stored_amounts (
  kept_by TEXT NOT NULL PRIMARY KEY,
  number INTEGER NOT NULL,
  bytes INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

INSERT INTO stored_amounts (kept_by, number, bytes)
SELECT 'devices', count(*), 0 FROM devices
UNION ALL SELECT 'blobs', count(*), coalesce(sum(bytes), 0) FROM blobs
UNION ALL SELECT 'recordings', count(*), coalesce(sum(bytes), 0) FROM recordings JOIN blobs ON sha256 = blob_sha256
UNION ALL SELECT 'device/' || device_id, count(*), sum(bytes) FROM recordings JOIN blobs ON sha256 = blob_sha256 GROUP BY device_id
UNION ALL SELECT 'token/' || token_id, count(*), sum(bytes) FROM owners JOIN recordings ON id = object_id JOIN blobs ON sha256 = blob_sha256
GROUP BY token_id;

CREATE TRIGGER device_is_counted AFTER INSERT ON devices BEGIN
  UPDATE stored_amounts SET number = number + 1 WHERE kept_by = 'devices';
END;
CREATE TRIGGER device_counts_no_more AFTER DELETE ON devices BEGIN
  UPDATE stored_amounts SET number = number - 1 WHERE kept_by = 'devices';
  DELETE FROM stored_amounts WHERE kept_by = 'device/' || OLD.id;
END;

CREATE TRIGGER blob_is_counted AFTER INSERT ON blobs BEGIN
  UPDATE stored_amounts SET number = number + 1, bytes = bytes + NEW.bytes WHERE kept_by = 'blobs';
END;
CREATE TRIGGER blob_counts_no_more AFTER DELETE ON blobs BEGIN
  UPDATE stored_amounts SET number = number - 1, bytes = bytes - OLD.bytes WHERE kept_by = 'blobs';
END;

-- A recording that is removed goes before its owners, and behind them where a lab is moved: whichever goes first takes it off.
CREATE TRIGGER recording_is_counted AFTER INSERT ON recordings BEGIN
  INSERT INTO stored_amounts (kept_by, number, bytes)
  SELECT keeper, 1, coalesce((SELECT bytes FROM blobs WHERE sha256 = NEW.blob_sha256), 0)
  FROM (SELECT 'recordings' AS keeper UNION ALL SELECT 'device/' || NEW.device_id
        UNION ALL SELECT 'token/' || token_id FROM owners WHERE object_id = NEW.id) AS keepers
  WHERE TRUE
  ON CONFLICT (kept_by) DO UPDATE SET number = number + 1, bytes = bytes + excluded.bytes;
END;
CREATE TRIGGER recording_counts_no_more AFTER DELETE ON recordings BEGIN
  UPDATE stored_amounts SET number = number - 1, bytes = bytes - coalesce((SELECT bytes FROM blobs WHERE sha256 = OLD.blob_sha256), 0)
  WHERE kept_by IN (SELECT 'recordings' UNION ALL SELECT 'device/' || OLD.device_id
                    UNION ALL SELECT 'token/' || token_id FROM owners WHERE object_id = OLD.id);
END;

CREATE TRIGGER owned_recording_is_counted AFTER INSERT ON owners
WHEN EXISTS (SELECT 1 FROM recordings WHERE id = NEW.object_id) BEGIN
  INSERT INTO stored_amounts (kept_by, number, bytes)
  SELECT 'token/' || NEW.token_id, 1, bytes FROM recordings JOIN blobs ON sha256 = blob_sha256 WHERE id = NEW.object_id
  ON CONFLICT (kept_by) DO UPDATE SET number = number + 1, bytes = bytes + excluded.bytes;
END;
CREATE TRIGGER owned_recording_counts_no_more AFTER DELETE ON owners
WHEN EXISTS (SELECT 1 FROM recordings WHERE id = OLD.object_id) BEGIN
  UPDATE stored_amounts SET number = number - 1,
    bytes = bytes - coalesce((SELECT bytes FROM recordings JOIN blobs ON sha256 = blob_sha256 WHERE id = OLD.object_id), 0)
  WHERE kept_by = 'token/' || OLD.token_id;
END;
