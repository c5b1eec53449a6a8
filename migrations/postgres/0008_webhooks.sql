-- Whom the daemon tells when a job ends, and what is still to be told.

-- Secrets are here as they are: signing needs them. `previous_secret` signs beside the new one until `previous_until`.
CREATE TABLE webhooks (
  id              TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  url             TEXT COLLATE "C" NOT NULL CHECK (url <> ''),
  description     TEXT COLLATE "C" NOT NULL,
  events_json     TEXT COLLATE "C" NOT NULL,
  secret          TEXT COLLATE "C" NOT NULL CHECK (secret <> ''),
  previous_secret TEXT COLLATE "C" NOT NULL DEFAULT '',
  previous_until  BIGINT,
  given_up        BIGINT NOT NULL DEFAULT 0,
  revision        BIGINT NOT NULL DEFAULT 1,
  created_at      BIGINT NOT NULL,
  updated_at      BIGINT NOT NULL,
  disabled_at     BIGINT,
  disabled_why    TEXT COLLATE "C" NOT NULL DEFAULT '',
  CHECK ((disabled_at IS NULL) = (disabled_why = ''))
);

-- An outbox: rows are written in the transaction that ends the job, and answered by whoever takes them.
CREATE TABLE webhook_deliveries (
  id          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
  webhook_id  TEXT COLLATE "C" NOT NULL REFERENCES webhooks (id) ON DELETE CASCADE,
  event       TEXT COLLATE "C" NOT NULL CHECK (event <> ''),
  job_id      TEXT COLLATE "C" NOT NULL,
  body        TEXT COLLATE "C" NOT NULL,
  state       TEXT COLLATE "C" NOT NULL CHECK (state IN ('waiting', 'delivered', 'given_up')),
  attempts    BIGINT NOT NULL DEFAULT 0,
  next_at     BIGINT NOT NULL,
  created_at  BIGINT NOT NULL,
  ended_at    BIGINT,
  last_status BIGINT,
  last_error  TEXT COLLATE "C" NOT NULL DEFAULT '',
  CHECK ((state = 'waiting') = (ended_at IS NULL))
);

CREATE INDEX webhook_deliveries_due ON webhook_deliveries (next_at, id) WHERE state = 'waiting';
CREATE INDEX webhook_deliveries_by_webhook ON webhook_deliveries (webhook_id, id);
CREATE INDEX webhook_deliveries_ended ON webhook_deliveries (ended_at) WHERE state <> 'waiting';
