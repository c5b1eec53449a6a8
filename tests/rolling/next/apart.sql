-- No older program may work beside it.
ALTER TABLE devices ADD COLUMN owner TEXT;
