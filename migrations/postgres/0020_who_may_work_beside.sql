-- No older program may work beside it.
-- From here on each migration is remembered with the oldest schema whose programs may work beside it; nothing: its own number.
ALTER TABLE schema_migrations ADD COLUMN oldest BIGINT;
