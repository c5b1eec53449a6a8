-- What every result comes to, where only what must be read was kept: a device's newest result has its sentence too. Of a
-- recording by its newest characterisation, of every other job as a whole.
CREATE TABLE verdicts (
  id           TEXT NOT NULL PRIMARY KEY,
  job_id       TEXT NOT NULL REFERENCES job_results (job_id) ON DELETE CASCADE,
  device_id    TEXT REFERENCES devices (id) ON DELETE CASCADE,
  recording_id TEXT REFERENCES recordings (id) ON DELETE CASCADE,
  channel      TEXT NOT NULL,
  level        TEXT NOT NULL CHECK (level IN ('fine', 'look', 'wrong')),
  verdict      TEXT NOT NULL CHECK (verdict <> ''),
  created_at   INTEGER NOT NULL
) STRICT;

INSERT INTO verdicts SELECT id, job_id, device_id, recording_id, channel, level, verdict, created_at FROM attention;
DROP TABLE attention;

-- Results of whole jobs that are fine have it in their documents; of a recording it is known from the next
-- characterisation on.
INSERT INTO verdicts
SELECT 'att_' || substr(jobs.id, 5), jobs.id,
       (SELECT max(device_id) FROM job_devices WHERE job_devices.job_id = jobs.id HAVING count(*) = 1), NULL, '', 'fine',
       json_extract(document_json, '$.summary.verdict'), job_results.created_at
FROM jobs JOIN job_results ON job_results.job_id = jobs.id
WHERE kind IN ('investigate', 'outage_evaluation', 'regress')
  AND CASE WHEN json_valid(document_json) THEN json_extract(document_json, '$.summary.level') = 'fine'
                                           AND json_extract(document_json, '$.summary.verdict') <> '' ELSE 0 END;

CREATE INDEX verdicts_by_job ON verdicts (job_id);
CREATE INDEX verdicts_by_device ON verdicts (device_id, id);
CREATE INDEX verdicts_by_recording ON verdicts (recording_id);
CREATE INDEX verdicts_to_read ON verdicts (id) WHERE level <> 'fine';
