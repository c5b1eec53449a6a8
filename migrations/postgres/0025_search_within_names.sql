-- Programs of schema 21 and later may work beside it.
-- A part of a name is found by its trigrams and not by reading every name. The extension comes with PostgreSQL; where it
-- is not installed, or may not be created, searches read every name as before.
DO $body$
DECLARE home TEXT;
BEGIN
  BEGIN
    CREATE EXTENSION IF NOT EXISTS pg_trgm WITH SCHEMA public;
  EXCEPTION WHEN OTHERS THEN
    RAISE NOTICE 'searches will read every name: %', SQLERRM;
  END;
  SELECT nspname INTO home FROM pg_extension JOIN pg_namespace ON pg_namespace.oid = extnamespace WHERE extname = 'pg_trgm';
  IF home IS NOT NULL THEN
    EXECUTE format('CREATE INDEX recordings_sought_within ON recordings USING gin '
                   '(lower(name || '' '' || file_name || '' '' || condition || '' '' || id) %I.gin_trgm_ops)', home);
    EXECUTE format('CREATE INDEX devices_sought_within ON devices USING gin '
                   '(lower(name || '' '' || model || '' '' || imu || '' '' || serial || '' '' || id) %I.gin_trgm_ops)', home);
  END IF;
END
$body$;
