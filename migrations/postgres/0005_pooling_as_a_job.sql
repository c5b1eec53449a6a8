-- Pooling is a job of its own, keyed by the channel results that it pools.

-- One row for each named sensor axis with two latest results or more. The key is that of the job that pools exactly these;
-- whatever changes the set changes the row in the same transaction. What is pooled is the result of that job.
CREATE TABLE pools (
  device_id  TEXT COLLATE "C" NOT NULL REFERENCES devices (id),
  quantity   TEXT COLLATE "C" NOT NULL,
  axis       TEXT COLLATE "C" NOT NULL CHECK (axis <> ''),
  unique_key TEXT COLLATE "C" NOT NULL CHECK (unique_key <> ''),
  PRIMARY KEY (device_id, quantity, axis)
);

-- Also of jobs that failed: a table says why its pooling did.
CREATE INDEX jobs_by_key ON jobs (unique_key);
CREATE INDEX channel_results_by_job ON channel_results (job_id);
