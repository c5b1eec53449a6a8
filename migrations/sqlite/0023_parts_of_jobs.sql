-- Programs of schema 20 and later may work beside it.
-- A long job is divided into parts that several workers take; what a part found is kept until the job has ended, so that
-- a worker that dies takes one part with it and not the whole job.
CREATE TABLE job_parts (
  job_id           TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  number           INTEGER NOT NULL CHECK (number >= 0),
  program          TEXT NOT NULL,
  state            TEXT NOT NULL CHECK (state IN ('open', 'running', 'finished')),
  claim            INTEGER NOT NULL,
  lease_expires_at INTEGER,
  result           TEXT NOT NULL DEFAULT '',
  PRIMARY KEY (job_id, number),
  CHECK ((lease_expires_at IS NOT NULL) = (state = 'running'))
);

CREATE INDEX job_parts_open ON job_parts (job_id, number) WHERE state = 'open';

CREATE TRIGGER parts_end_with_their_job AFTER UPDATE OF state ON jobs WHEN NEW.finished_at IS NOT NULL
BEGIN
  DELETE FROM job_parts WHERE job_id = NEW.id;
END;
