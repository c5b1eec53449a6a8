-- Calibrations of a device's sensors. One never changes; recordings name it in their metadata.

CREATE TABLE calibrations (
  id            TEXT NOT NULL PRIMARY KEY,
  device_id     TEXT NOT NULL REFERENCES devices (id),
  unique_key    TEXT NOT NULL UNIQUE CHECK (unique_key <> ''),
  document_json TEXT NOT NULL,
  created_at    INTEGER NOT NULL
) STRICT;

CREATE INDEX calibrations_by_device ON calibrations (device_id, id);
