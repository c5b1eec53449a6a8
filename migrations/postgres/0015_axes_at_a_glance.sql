-- A list of devices shows each axis by one of its results. Which one, and what it says at a glance, is kept with the
-- results, so that a page of the list reads these rows alone. A daemon fills in those of before when it starts.
ALTER TABLE channel_results ADD COLUMN glance_json TEXT COLLATE "C" NOT NULL DEFAULT '';
ALTER TABLE channel_results ADD COLUMN glance_level BIGINT NOT NULL DEFAULT 0;
ALTER TABLE channel_results ADD COLUMN shown BIGINT NOT NULL DEFAULT 0 CHECK (shown IN (0, 1));

CREATE INDEX channel_results_shown ON channel_results (device_id) WHERE shown = 1;
CREATE INDEX channel_results_unseen ON channel_results (sequence) WHERE glance_json = '';
CREATE INDEX channel_results_by_axis ON channel_results (device_id, quantity, axis);
DROP INDEX channel_results_by_device;
CREATE INDEX channel_results_newest ON channel_results (device_id, sequence);
CREATE INDEX recordings_by_condition ON recordings (device_id, condition);
