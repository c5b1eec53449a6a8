-- PostgreSQL verifies its own write-ahead log: nothing to do here but to be a statement.
DO $nothing$ BEGIN NULL; END $nothing$;
