-- Programs of schema 21 and later may work beside it.
-- How many devices and recordings there are, how many recordings a device and a token have, and how many bytes those are as uploaded, is kept by
-- triggers, for to count them reads all their rows, at every upload. kept_by: devices, recordings, blobs, device/ID or token/ID. An amount is the sum of
-- its rows: each change adds one, so that nobody waits for another's amounts, and a sweep makes one of them.
CREATE TABLE stored_amounts (
  kept_by TEXT COLLATE "C" NOT NULL,
  number BIGINT NOT NULL,
  bytes BIGINT NOT NULL,
  settled BOOLEAN NOT NULL DEFAULT FALSE
);
CREATE INDEX stored_amounts_by_keeper ON stored_amounts (kept_by) INCLUDE (number, bytes);
CREATE INDEX stored_amounts_not_settled ON stored_amounts (kept_by) WHERE NOT settled;

CREATE FUNCTION keep_amount_of_devices() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
DECLARE
  sign BIGINT := CASE TG_OP WHEN 'INSERT' THEN 1 ELSE -1 END;
BEGIN
  INSERT INTO stored_amounts (kept_by, number, bytes) SELECT 'devices', sign * count(*), 0 FROM changed HAVING count(*) > 0;
  RETURN NULL;
END
$body$;

CREATE FUNCTION keep_amount_of_blobs() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
DECLARE
  sign BIGINT := CASE TG_OP WHEN 'INSERT' THEN 1 ELSE -1 END;
BEGIN
  INSERT INTO stored_amounts (kept_by, number, bytes) SELECT 'blobs', sign * count(*), sign * sum(bytes) FROM changed HAVING count(*) > 0;
  RETURN NULL;
END
$body$;

-- A recording that is removed goes before its owners, and behind them where a lab is moved: whichever goes first takes it off.
CREATE FUNCTION keep_amount_of_recordings() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
DECLARE
  sign BIGINT := CASE TG_OP WHEN 'INSERT' THEN 1 ELSE -1 END;
BEGIN
  INSERT INTO stored_amounts (kept_by, number, bytes)
  SELECT keeper, sign * count(*), sign * sum(blobs.bytes)
  FROM (SELECT 'recordings' AS keeper, blob_sha256 FROM changed
        UNION ALL SELECT 'device/' || device_id, blob_sha256 FROM changed
        UNION ALL SELECT 'token/' || token_id, blob_sha256 FROM changed JOIN owners ON object_id = changed.id) AS kept
  JOIN blobs ON sha256 = blob_sha256 GROUP BY keeper;
  RETURN NULL;
END
$body$;

CREATE FUNCTION keep_amount_of_tokens() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
DECLARE
  sign BIGINT := CASE TG_OP WHEN 'INSERT' THEN 1 ELSE -1 END;
BEGIN
  INSERT INTO stored_amounts (kept_by, number, bytes)
  SELECT 'token/' || token_id, sign * count(*), sign * sum(blobs.bytes)
  FROM changed JOIN recordings ON recordings.id = object_id JOIN blobs ON sha256 = blob_sha256 GROUP BY token_id;
  RETURN NULL;
END
$body$;

CREATE TRIGGER device_is_counted AFTER INSERT ON devices REFERENCING NEW TABLE AS changed
FOR EACH STATEMENT EXECUTE FUNCTION keep_amount_of_devices();
CREATE TRIGGER device_counts_no_more AFTER DELETE ON devices REFERENCING OLD TABLE AS changed
FOR EACH STATEMENT EXECUTE FUNCTION keep_amount_of_devices();
CREATE TRIGGER blob_is_counted AFTER INSERT ON blobs REFERENCING NEW TABLE AS changed
FOR EACH STATEMENT EXECUTE FUNCTION keep_amount_of_blobs();
CREATE TRIGGER blob_counts_no_more AFTER DELETE ON blobs REFERENCING OLD TABLE AS changed
FOR EACH STATEMENT EXECUTE FUNCTION keep_amount_of_blobs();
CREATE TRIGGER recording_is_counted AFTER INSERT ON recordings REFERENCING NEW TABLE AS changed
FOR EACH STATEMENT EXECUTE FUNCTION keep_amount_of_recordings();
CREATE TRIGGER recording_counts_no_more AFTER DELETE ON recordings REFERENCING OLD TABLE AS changed
FOR EACH STATEMENT EXECUTE FUNCTION keep_amount_of_recordings();
CREATE TRIGGER owned_recording_is_counted AFTER INSERT ON owners REFERENCING NEW TABLE AS changed
FOR EACH STATEMENT EXECUTE FUNCTION keep_amount_of_tokens();
CREATE TRIGGER owned_recording_counts_no_more AFTER DELETE ON owners REFERENCING OLD TABLE AS changed
FOR EACH STATEMENT EXECUTE FUNCTION keep_amount_of_tokens();

-- The triggers hold up whoever would write until the end, so that all is counted once.
WITH of_devices AS (SELECT device_id, count(*) AS number, sum(bytes) AS bytes FROM recordings JOIN blobs ON sha256 = blob_sha256 GROUP BY device_id)
INSERT INTO stored_amounts (kept_by, number, bytes, settled)
SELECT 'devices', count(*), 0, TRUE FROM devices
UNION ALL SELECT 'blobs', count(*), coalesce(sum(bytes), 0), TRUE FROM blobs
UNION ALL SELECT 'recordings', coalesce(sum(number), 0), coalesce(sum(bytes), 0), TRUE FROM of_devices
UNION ALL SELECT 'device/' || device_id, number, bytes, TRUE FROM of_devices
UNION ALL SELECT 'token/' || token_id, count(*), sum(bytes), TRUE FROM owners JOIN recordings ON id = object_id
JOIN blobs ON sha256 = blob_sha256 GROUP BY token_id;
