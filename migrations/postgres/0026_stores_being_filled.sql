-- Programs of schema 21 and later may work beside it.
-- What another store is being moved from into this one, so that no daemon starts before that has ended; empty: nothing.
ALTER TABLE store_identity ADD COLUMN filled_from TEXT COLLATE "C" NOT NULL DEFAULT '';
