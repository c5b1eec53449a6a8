-- Drive documents over stored recordings of one device. A document never changes: another one is another drive.
CREATE TABLE drives (
  id            TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  device_id     TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  unique_key    TEXT COLLATE "C" NOT NULL UNIQUE CHECK (unique_key <> ''),
  document_json TEXT COLLATE "C" NOT NULL,
  created_at    BIGINT NOT NULL
);

CREATE INDEX drives_by_device ON drives (device_id, id);
