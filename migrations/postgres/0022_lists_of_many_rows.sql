-- Programs of schema 21 and later may work beside it.
-- Filters that find few rows among many read no more of them than they find.
CREATE INDEX recordings_under_condition ON recordings (condition, id);
CREATE INDEX recordings_tagged ON recordings (id) WHERE tags_json <> '{}';
CREATE INDEX jobs_without_result ON jobs (state, id) WHERE state IN ('failed', 'cancelled', 'dead');
CREATE INDEX fits_by_model ON fits (model, id);
