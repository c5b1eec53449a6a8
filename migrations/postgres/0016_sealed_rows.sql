-- Every row that results are made of has the SHA-256 of what it says (server/store/sql/seals.hpp), so that a bit that
-- changes is noticed. Rows of before have none; a daemon fills them in when it starts.
ALTER TABLE devices ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE blobs ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE recordings ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE job_results ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE channel_results ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE fits ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE studies ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE drives ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE calibrations ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE models ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE investigations ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE verdicts ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE anchors ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE artefacts ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE idempotent_replies ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';

CREATE INDEX devices_unsealed ON devices (id) WHERE seal = '';
CREATE INDEX blobs_unsealed ON blobs (sha256) WHERE seal = '';
CREATE INDEX recordings_unsealed ON recordings (id) WHERE seal = '';
CREATE INDEX jobs_unsealed ON jobs (id) WHERE seal = '';
CREATE INDEX job_results_unsealed ON job_results (job_id) WHERE seal = '';
CREATE INDEX channel_results_unsealed ON channel_results (id) WHERE seal = '';
CREATE INDEX fits_unsealed ON fits (id) WHERE seal = '';
CREATE INDEX studies_unsealed ON studies (id) WHERE seal = '';
CREATE INDEX drives_unsealed ON drives (id) WHERE seal = '';
CREATE INDEX calibrations_unsealed ON calibrations (id) WHERE seal = '';
CREATE INDEX models_unsealed ON models (id) WHERE seal = '';
CREATE INDEX investigations_unsealed ON investigations (id) WHERE seal = '';
CREATE INDEX verdicts_unsealed ON verdicts (id) WHERE seal = '';
CREATE INDEX anchors_unsealed ON anchors (id) WHERE seal = '';
CREATE INDEX artefacts_unsealed ON artefacts (job_id) WHERE seal = '';
CREATE INDEX idempotent_replies_unsealed ON idempotent_replies (key) WHERE seal = '';
