-- Programs of schema @BEFORE@ and later may work beside it.
-- What a later release may add while programs of this one work: columns that these do not write, and an index of one of them.
ALTER TABLE recordings ADD COLUMN shelf TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN bench TEXT;
CREATE INDEX recordings_by_shelf ON recordings (shelf, id) WHERE shelf <> '';
