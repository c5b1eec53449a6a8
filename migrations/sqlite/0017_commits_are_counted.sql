-- Commits of this database. The daemon keeps the number of the last one that it acknowledged in a file of its own, so that
-- a database which lost some, as with its write-ahead log, is known for it.
CREATE TABLE commits (
  one    INTEGER PRIMARY KEY CHECK (one = 1),
  number INTEGER NOT NULL CHECK (number >= 0)
) STRICT;

INSERT INTO commits VALUES (1, 0);
