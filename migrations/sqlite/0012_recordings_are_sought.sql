-- What recordings are sought by, in the order of their names: a search reads this and not the rows, which hold whole documents.
DROP INDEX recordings_by_name;
CREATE INDEX recordings_sought ON recordings (name, id, file_name, condition);
