-- Programs of schema 20 and later may work beside it.
-- A long job is divided into parts that several workers take; what a part found is kept until the job has ended, so that
-- a worker that dies takes one part with it and not the whole job.
CREATE TABLE job_parts (
  job_id           TEXT COLLATE "C" NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  number           BIGINT NOT NULL CHECK (number >= 0),
  program          TEXT COLLATE "C" NOT NULL,
  state            TEXT COLLATE "C" NOT NULL CHECK (state IN ('open', 'running', 'finished')),
  claim            BIGINT NOT NULL,
  lease_expires_at BIGINT,
  result           TEXT NOT NULL DEFAULT '',
  PRIMARY KEY (job_id, number),
  CHECK ((lease_expires_at IS NOT NULL) = (state = 'running'))
);

CREATE INDEX job_parts_open ON job_parts (job_id, number) WHERE state = 'open';

CREATE FUNCTION end_parts_of_job() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  DELETE FROM job_parts WHERE job_id = NEW.id;
  RETURN NULL;
END
$body$;

CREATE TRIGGER parts_end_with_their_job AFTER UPDATE OF state ON jobs FOR EACH ROW
  WHEN (NEW.finished_at IS NOT NULL) EXECUTE FUNCTION end_parts_of_job();

CREATE FUNCTION tell_of_parts() RETURNS TRIGGER LANGUAGE plpgsql AS $body$
BEGIN
  PERFORM tell_others('job', NEW.job_id || ' parts');
  RETURN NULL;
END
$body$;

CREATE TRIGGER parts_are_told AFTER INSERT ON job_parts FOR EACH ROW
  WHEN (NEW.number = 0) EXECUTE FUNCTION tell_of_parts();
