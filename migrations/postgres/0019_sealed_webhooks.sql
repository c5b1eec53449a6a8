-- A webhook whose row is not what was written is told nothing (server/store/sql/seals.hpp).
ALTER TABLE webhooks ADD COLUMN seal TEXT COLLATE "C" NOT NULL DEFAULT '';

CREATE INDEX webhooks_unsealed ON webhooks (id) WHERE seal = '';
