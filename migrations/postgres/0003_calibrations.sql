-- Calibrations of a device's sensors. One never changes; recordings name it in their metadata.

CREATE TABLE calibrations (
  id            TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  device_id     TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  unique_key    TEXT COLLATE "C" NOT NULL UNIQUE CHECK (unique_key <> ''),
  document_json TEXT COLLATE "C" NOT NULL,
  created_at    BIGINT NOT NULL
);

CREATE INDEX calibrations_by_device ON calibrations (device_id, id);
