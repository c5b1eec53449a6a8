-- Programs of schema 22 and later may work beside it.
-- Failed attempts have a seal, and jobs a second one of what they say once they have ended (server/store/sql/seals.hpp).
ALTER TABLE job_attempts ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN end_seal TEXT COLLATE "C" NOT NULL DEFAULT '';

CREATE INDEX job_attempts_unsealed ON job_attempts (job_id) WHERE seal = '';
CREATE INDEX jobs_unsealed_ends ON jobs (id) WHERE end_seal = '' AND finished_at IS NOT NULL;
