-- Drive documents over stored recordings of one device. A document never changes: another one is another drive.
CREATE TABLE drives (
  id            TEXT NOT NULL PRIMARY KEY,
  device_id     TEXT NOT NULL REFERENCES devices (id),
  unique_key    TEXT NOT NULL UNIQUE CHECK (unique_key <> ''),
  document_json TEXT NOT NULL,
  created_at    INTEGER NOT NULL
) STRICT;

CREATE INDEX drives_by_device ON drives (device_id, id);
