-- What recordings are sought by, beside their documents: 20,000 of them are read in some milliseconds.
CREATE INDEX recordings_sought ON recordings (name, file_name, condition, id);
