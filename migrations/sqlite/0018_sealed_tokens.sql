-- A token whose row is not what was written lets nobody in (server/store/sql/seals.hpp).
ALTER TABLE tokens ADD COLUMN seal TEXT NOT NULL DEFAULT '';

CREATE INDEX tokens_unsealed ON tokens (id) WHERE seal = '';
