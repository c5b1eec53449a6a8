-- The studies that name recordings. What recordings of one axis say together came later (0005).

CREATE TABLE studies (
  id            TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  device_id     TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  unique_key    TEXT COLLATE "C" NOT NULL UNIQUE CHECK (unique_key <> ''),
  document_json TEXT COLLATE "C" NOT NULL,
  created_at    BIGINT NOT NULL
);

CREATE INDEX studies_by_device ON studies (device_id, id);
