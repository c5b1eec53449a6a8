-- Whom the daemon tells when a job ends, and what is still to be told.

-- Secrets are here as they are: signing needs them. `previous_secret` signs beside the new one until `previous_until`.
CREATE TABLE webhooks (
  id              TEXT NOT NULL PRIMARY KEY,
  url             TEXT NOT NULL CHECK (url <> ''),
  description     TEXT NOT NULL,
  events_json     TEXT NOT NULL,
  secret          TEXT NOT NULL CHECK (secret <> ''),
  previous_secret TEXT NOT NULL DEFAULT '',
  previous_until  INTEGER,
  given_up        INTEGER NOT NULL DEFAULT 0,
  revision        INTEGER NOT NULL DEFAULT 1,
  created_at      INTEGER NOT NULL,
  updated_at      INTEGER NOT NULL,
  disabled_at     INTEGER,
  disabled_why    TEXT NOT NULL DEFAULT '',
  CHECK ((disabled_at IS NULL) = (disabled_why = ''))
) STRICT;

-- An outbox: rows are written in the transaction that ends the job, and answered by whoever takes them.
CREATE TABLE webhook_deliveries (
  id          TEXT NOT NULL PRIMARY KEY,
  webhook_id  TEXT NOT NULL REFERENCES webhooks (id) ON DELETE CASCADE,
  event       TEXT NOT NULL CHECK (event <> ''),
  job_id      TEXT NOT NULL,
  body        TEXT NOT NULL,
  state       TEXT NOT NULL CHECK (state IN ('waiting', 'delivered', 'given_up')),
  attempts    INTEGER NOT NULL DEFAULT 0,
  next_at     INTEGER NOT NULL,
  created_at  INTEGER NOT NULL,
  ended_at    INTEGER,
  last_status INTEGER,
  last_error  TEXT NOT NULL DEFAULT '',
  CHECK ((state = 'waiting') = (ended_at IS NULL))
) STRICT;

CREATE INDEX webhook_deliveries_due ON webhook_deliveries (next_at, id) WHERE state = 'waiting';
CREATE INDEX webhook_deliveries_by_webhook ON webhook_deliveries (webhook_id, id);
CREATE INDEX webhook_deliveries_ended ON webhook_deliveries (ended_at) WHERE state <> 'waiting';
