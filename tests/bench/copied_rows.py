"""Copies of one device with everything that is stored about it, as many as are wanted, by SQL alone: what tests/bench/large_store.py fills with.

The copy of a row has ids, hashes, times and seals of its own. An id keeps its kind and the end of its random part; its time says which
campaign and which copy it is of, so that copies of one campaign stand together, as they do where many devices are recorded at a time.
"""
from __future__ import annotations

import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import postgres

AT_ONCE = 2
COPIES_AT_ONCE = 5000
SEALS = Path(__file__).resolve().parents[2] / "server/store/sql/seals.cpp"
# Parents first.
TABLES = ("devices", "blobs", "recordings", "jobs", "job_devices", "job_recordings", "job_events", "job_results", "artefacts", "channel_results", "fits", "verdicts", "pools")
OF_A_JOB = "job_id"
# What triggers keep (migration 0028), which the copies went by.
AMOUNTS = """
DELETE FROM stored_amounts;
INSERT INTO stored_amounts (kept_by, number, bytes, settled)
SELECT 'devices', count(*), 0, TRUE FROM devices
UNION ALL SELECT 'blobs', count(*), sum(bytes), TRUE FROM blobs
UNION ALL SELECT 'recordings', count(*), sum(bytes), TRUE FROM recordings JOIN blobs ON sha256 = blob_sha256
UNION ALL SELECT 'device/' || device_id, count(*), sum(bytes), TRUE FROM recordings JOIN blobs ON sha256 = blob_sha256 GROUP BY device_id;
"""
# The campaign of every id: of a recording its number, and of what was made of it the same; 0 of the device.
CAMPAIGNS = """
CREATE TABLE campaigns AS
SELECT id, (row_number() OVER (ORDER BY id) - 1)::INT AS campaign FROM recordings;
INSERT INTO campaigns SELECT id, 0 FROM devices;
INSERT INTO campaigns SELECT id, coalesce((SELECT max(campaign) FROM job_recordings JOIN campaigns ON campaigns.id = recording_id WHERE job_id = jobs.id),
                                           (SELECT max(campaign) FROM campaigns)) FROM jobs;
INSERT INTO campaigns SELECT channel_results.id, campaign FROM channel_results JOIN campaigns ON campaigns.id = recording_id;
INSERT INTO campaigns SELECT fits.id, campaign FROM fits JOIN campaigns ON campaigns.id = recording_id;
INSERT INTO campaigns SELECT verdicts.id, campaign FROM verdicts JOIN campaigns ON campaigns.id = job_id;
CREATE FUNCTION copied(id TEXT, campaign INT, copy INT, copies INT) RETURNS TEXT LANGUAGE sql IMMUTABLE AS
  $body$ SELECT substr(id, 1, 4) || '01M7' || upper(lpad(to_hex(campaign * copies + copy), 6, '0')) || substr(id, 15) $body$;
CREATE FUNCTION copied_hash(hash TEXT, copy INT) RETURNS TEXT LANGUAGE sql IMMUTABLE AS
  $body$ SELECT encode(sha256(convert_to(hash || copy, 'UTF8')), 'hex') $body$;
CREATE FUNCTION copied_ids(document TEXT, copy INT, copies INT) RETURNS TEXT LANGUAGE plpgsql AS $body$
DECLARE named RECORD;
BEGIN
  FOR named IN SELECT campaigns.id, campaign FROM campaigns
               WHERE campaigns.id IN (SELECT hit[1] FROM regexp_matches(document, '"((?:dev|rec|job|chr)_[0-9A-Z]{26})"', 'g') AS hit) LOOP
    document := replace(document, named.id, copied(named.id, named.campaign, copy, copies));
  END LOOP;
  RETURN document;
END $body$;
"""


def seals_of() -> dict[str, dict[str, str]]:
    """The columns that have seals, by table, and how each is made of the others, as the store's source lists them."""
    found = re.findall(r'\{"(\w+)",\s*"[^"]*",\s*\{[^}]*\},\s*((?:"[^"]*"\s*)+)(?:,\s*"(\w+)",\s*"([^"]*)")?\}', SEALS.read_text("utf-8"))
    seals: dict[str, dict[str, str]] = {}
    for table, columns, column, rows in found:
        sealed = "".join(re.findall(r'"([^"]*)"', columns)).replace(" ", "").split(",")
        seals.setdefault(table, {})[column or "seal"] = f"CASE WHEN {rows or 'true'} THEN {seal(sealed)} ELSE '' END"
    return seals


def seal(columns: list[str]) -> str:
    parts = ", ".join(f"octet_length(coalesce({column}::TEXT, '')), ':', {column}::TEXT" for column in columns)
    return f"encode(sha256(convert_to(concat({parts}), 'UTF8')), 'hex')"


def is_id(column: str) -> bool:
    return column == "id" or column.endswith("_id")


def known_of(table: str, columns: list[str]) -> str:
    """What is found out once of every row that is copied."""
    known = [f"(SELECT campaign FROM campaigns WHERE campaigns.id = {table}.{column}) AS campaign_of_{column}" for column in columns if is_id(column)]
    if "unique_key" in columns:  # that of a pooling is the hash of what it pools
        known.append("(SELECT request_json FROM jobs AS pool WHERE pool.unique_key = %s.unique_key AND pool.kind = 'pool') AS request" % table)
    if table == "job_results":
        known.append("(SELECT min(recording_id) FROM job_recordings WHERE job_recordings.job_id = job_results.job_id) AS recording")
    return ", ".join(["*", *known])


def copy_of(table: str, column: str) -> str:
    """The value of a column in the copy `copy` of `copies`."""
    if is_id(column):
        return f"copied({column}, campaign_of_{column}, copy, copies)"
    if column in ("sha256", "blob_sha256"):
        return f"copied_hash({column}, copy)"
    if column == "unique_key":
        return "CASE WHEN request IS NOT NULL THEN encode(sha256(convert_to(copied_ids(request, copy, copies), 'UTF8')), 'hex') ELSE copied_hash(unique_key, copy) END"
    if column == "name" and table in ("devices", "recordings"):
        return "replace(name, '0000000', lpad(copy::TEXT, 7, '0'))"
    if column == "content":
        return "replace(copied_ids(content, copy, copies), '0000000', lpad(copy::TEXT, 7, '0'))"
    if column == "metadata_json":
        return "replace(metadata_json, ' 0000000', ' ' || lpad(copy::TEXT, 7, '0'))"
    if column == "request_json":
        return "copied_ids(request_json, copy, copies)"
    if table == "job_results" and column == "document_json":
        return "coalesce(replace(document_json, recording, copied(recording, campaign_of_job_id, copy, copies)), document_json)"
    return column


def copy_device(server: postgres.Cluster, schema: str, copies: int) -> None:
    """Copies 1 to `copies` - 1 of the only device of the store; it is copy 0 itself."""
    setting = f"SET search_path = {schema}; SET session_replication_role = replica; SET synchronous_commit = off; "
    server.sql(setting + CAMPAIGNS)
    # What is copied is read from tables that do not grow meanwhile.
    server.sql(setting + f"CREATE SCHEMA {schema}_originals; " +
               "; ".join(f"CREATE TABLE {schema}_originals.{table} AS SELECT * FROM {table}" for table in TABLES))
    from_originals = setting.replace(schema, f"{schema}_originals, {schema}", 1)
    seals = seals_of()
    last = int(server.sql(setting + "SELECT max(campaign) FROM campaigns"))
    for campaign in range(last + 1):
        for table in TABLES:
            described = server.sql(f"SELECT column_name FROM information_schema.columns WHERE table_schema = '{schema}' AND table_name = '{table}' "
                                   "AND column_name NOT IN ('sequence', 'seal', 'end_seal') ORDER BY ordinal_position").split("\n")
            key = {"blobs": "(SELECT min(id) FROM recordings WHERE blob_sha256 = sha256 AND recordings.id IN (SELECT id FROM campaigns))",
                   "pools": "(SELECT id FROM jobs AS pool WHERE pool.unique_key = pools.unique_key AND pool.id IN (SELECT id FROM campaigns))"}.get(
                       table, "id" if "id" in described else OF_A_JOB)
            values = ", ".join(f"{copy_of(table, column)} AS {column}" for column in described)
            selected = (f"SELECT {values} FROM (SELECT {known_of(table, described)} FROM {table} WHERE {key} IN (SELECT id FROM campaigns WHERE campaign = {campaign}) "
                        "OFFSET 0) AS original "
                        "CROSS JOIN (SELECT generate_series(%d, %d) AS copy, %d AS copies) AS series")
            names = ", ".join(described)
            made = seals.get(table, {})
            target, result = ", ".join([names, *made]), ", ".join([names, *made.values()])
            insert = f"INSERT INTO {schema}.{table} ({target}) SELECT {result} FROM ({selected}) AS made"
            ranges = [(first, min(first + COPIES_AT_ONCE, copies) - 1) for first in range(1, copies, COPIES_AT_ONCE)]
            with ThreadPoolExecutor(AT_ONCE) as clients:
                list(clients.map(lambda bounds: server.sql(from_originals + insert % (*bounds, copies)), ranges))
    if server.sql(setting + "SELECT to_regclass('stored_amounts')"):
        server.sql(setting + AMOUNTS)
    server.sql(setting + f"DROP SCHEMA {schema}_originals CASCADE; DROP TABLE campaigns; DROP FUNCTION copied, copied_hash, copied_ids")
