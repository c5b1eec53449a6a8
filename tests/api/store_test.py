"""A daemon whose rows are in PostgreSQL: what it says at start and in /readyz, and what it refuses to do wrongly."""
from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import daemon as daemons
import postgres
import samples
from daemon import Answer, Daemon
from suite import SKIPPED

if postgres.programs() is None:
    print("POSTGRESQL NOT TESTED: there is no PostgreSQL 15 in /usr/lib/postgresql.")
    raise SystemExit(SKIPPED)


def start(data: Path, store: str, *more: str, environment: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """Runs a daemon that must not start, or a command."""
    settings = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}
    named = ("--store", store) if store else ()
    return subprocess.run([daemons.PROGRAM, "--data", str(data), "--listen", "127.0.0.1:0", *named, *more], capture_output=True, text=True,
                          timeout=daemons.PATIENCE_S, env={**settings, **(environment or {})})


def upload(daemon: Daemon) -> Answer:
    return daemon.upload(samples.gyro_csv(2048), rate_hz=100, columns=samples.GYRO_Z)


if "built without PostgreSQL" in start(Path("/nonexistent"), "postgresql://127.0.0.1:1/x").stderr:
    print("POSTGRESQL NOT TESTED: this driftlabd was built without it.")
    raise SystemExit(SKIPPED)


class OnPostgres(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.data = self.folder / "data"
        self.cluster = postgres.cluster()
        self.store = self.cluster.store_of(self.data)

    def daemon(self, *arguments: str) -> Daemon:
        return self.enterContext(Daemon(self.data, arguments=("--store", self.store, *arguments)))

    def refused(self, store: str, *said: str, data: Path | None = None) -> None:
        """It ends with one sentence on its last line."""
        ran = start(data or self.data, store)
        self.assertIn(ran.returncode, (1, 2), ran.stderr)
        last = ran.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith("driftlabd: ") and last.endswith("."), last)
        for words in said:
            self.assertIn(words, last)

    def readiness(self, daemon: Daemon, status: int) -> str:
        """What /readyz says once it answers with that status."""
        until = time.monotonic() + 30
        while (answer := daemon.get("/readyz")).status != status and time.monotonic() < until:
            time.sleep(0.1)
        self.assertEqual(answer.status, status, answer.describe())
        return answer.text

    def test_rows_survive_the_daemon_and_a_crash_of_the_server(self) -> None:
        daemon = self.daemon()
        recording = upload(daemon).json["id"]
        job = daemon.finished(daemon.characterise(recording, models=["WN"]).json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        fits = daemon.items(f"/v1/fits?job={job['id']}")
        self.cluster.stop()
        self.assertIn("The store does not answer: The database", self.readiness(daemon, 503))
        for _ in range(10):  # as it finds out and while it rests between two attempts
            told = daemon.get("/v1/fits")
            self.assertEqual((told.status, told.json["type"], told.headers["retry-after"]), (503, "/problems/not-ready", "1"), told.describe())
            self.assertIn("does not answer", told.json["detail"])
        self.cluster.start()
        self.readiness(daemon, 200)
        self.assertEqual(daemon.items(f"/v1/fits?job={job['id']}"), fits)
        self.assertEqual(upload(daemon).status, 200, "the same bytes are the same recording")
        daemon.kill()
        again = self.daemon()
        self.assertEqual(again.items(f"/v1/fits?job={job['id']}"), fits)
        self.assertFalse(list(self.data.glob("driftlab.db*")))

    def test_a_read_only_database_is_said(self) -> None:
        daemon = self.daemon()
        self.cluster.sql("ALTER DATABASE postgres SET default_transaction_read_only = on")
        try:
            self.cluster.sql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'driftlabd'")
            self.assertIn("is read-only", self.readiness(daemon, 503))
            self.assertEqual(daemon.get("/v1/devices").status, 200)
        finally:
            self.cluster.sql("ALTER DATABASE postgres RESET default_transaction_read_only")
            self.cluster.sql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'driftlabd'")
        self.readiness(daemon, 200)

    def test_rights_that_are_missing_are_said(self) -> None:
        schema = self.cluster.schema_of(self.data)
        self.cluster.sql("CREATE ROLE lab LOGIN; CREATE ROLE guest LOGIN")
        guest = self.store.replace("user=driftlab", "user=guest")
        self.refused(guest, "no schema that its user may use")  # it said that another daemon works with the database
        self.cluster.sql(f"GRANT USAGE ON SCHEMA {schema} TO guest")
        self.refused(guest, "permission denied")
        self.cluster.sql(f"GRANT USAGE, CREATE ON SCHEMA {schema} TO lab")
        daemon = self.enterContext(Daemon(self.data, arguments=("--store", self.store.replace("user=driftlab", "user=lab"))))
        self.assertEqual(upload(daemon).status, 201)
        self.cluster.sql(f"REVOKE INSERT, UPDATE ON ALL TABLES IN SCHEMA {schema} FROM lab")
        self.assertIn("permission denied", self.readiness(daemon, 503))
        self.assertEqual(len(daemon.items("/v1/recordings")), 1, "what is there can be read")
        self.cluster.sql(f"GRANT INSERT, UPDATE ON ALL TABLES IN SCHEMA {schema} TO lab")
        self.readiness(daemon, 200)

    @unittest.skipUnless(os.geteuid() == 0, "SKIPPED: mounting a small disk needs root")
    def test_a_full_database_is_said_and_loses_nothing(self) -> None:
        disk = self.cluster.folder / "small"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=3m", "tmpfs", str(disk)], check=False, capture_output=True).returncode != 0:
            self.skipTest("SKIPPED: no tmpfs can be mounted")
        self.addCleanup(subprocess.run, ["umount", "--lazy", str(disk)], check=False)
        shutil.chown(disk, "postgres", "postgres")
        self.cluster.sql(f"CREATE TABLESPACE small LOCATION '{disk}'")
        self.cluster.sql("ALTER ROLE driftlab SET default_tablespace = small")
        # Before the disk goes: a server that misses a tablespace does not recover from a crash.
        self.addCleanup(self.cluster.sql, "DROP TABLESPACE small")
        self.addCleanup(self.cluster.sql, f"DROP SCHEMA {self.cluster.schema_of(self.data)} CASCADE")
        self.addCleanup(self.cluster.sql, "ALTER ROLE driftlab RESET default_tablespace")
        daemon = self.daemon("--workers", "0")
        acknowledged, refused = [], None
        for seed in range(5000):
            answer = daemon.upload(samples.gyro_csv(8, seed=seed), rate_hz=100, columns=samples.GYRO_Z, labels=",".join(f"l{i}=" + os.urandom(125).hex() for i in range(16)))
            if answer.status != 201:
                refused = answer
                break
            acknowledged.append(answer.json["id"])
        assert refused is not None
        self.assertEqual((refused.status, refused.json["code"]), (507, "disk_full"), refused.describe()[-600:])
        self.assertIn("full", refused.json["detail"])
        self.assertEqual([each["id"] for each in daemon.items("/v1/recordings?limit=500")], acknowledged)
        self.assertEqual(subprocess.run(["mount", "-o", "remount,size=64m", str(disk)], check=False).returncode, 0)
        self.assertEqual(daemon.upload(samples.gyro_csv(8, seed=9999), rate_hz=100, columns=samples.GYRO_Z).status, 201)
        self.readiness(daemon, 200)

    def test_another_schema_is_said(self) -> None:
        daemon = self.daemon()
        table = f"{self.cluster.schema_of(self.data)}.schema_migrations"
        self.cluster.sql(f"INSERT INTO {table} VALUES (999, 'later', 'x', 0)")
        self.assertIn("has schema 999 by now", self.readiness(daemon, 503))
        daemon.kill()
        self.refused(self.store, "schema 999")

    def test_a_second_daemon_is_refused(self) -> None:
        self.daemon()
        self.refused(self.store, "uses the directory", data=self.data)
        self.refused(self.store, "Another daemon works with the database", data=self.folder / "other")

    def test_rows_and_recordings_stay_together(self) -> None:
        daemon = self.daemon()
        self.assertEqual(upload(daemon).status, 201)
        daemon.kill()
        self.refused(self.store, "are not in", data=self.folder / "other")
        self.refused("", "keeps the recordings of a PostgreSQL database")
        self.refused(self.cluster.store_of(self.folder / "third"), "of another database")
        with Daemon(self.folder / "sqlite"):
            pass
        self.refused(self.cluster.store_of(self.folder / "fourth"), "of an SQLite store", data=self.folder / "sqlite")

    def test_what_cannot_be_reached_is_one_sentence_without_the_password(self) -> None:
        self.refused("postgresql://driftlab:secret@127.0.0.1:1/driftlab", "The database \"driftlab\" on 127.0.0.1:1 does not answer")
        self.refused("postgresql://x/?password=secret&nosuch=1", "postgresql://USER@HOST")
        self.refused("mysql://x/y", "The setting store must be postgresql://")
        self.refused(self.store.replace("user=driftlab", "user=nobody"), "nobody")

    def test_a_password_is_never_shown(self) -> None:
        for uri in ("postgresql://me:s3cret@db/x", "postgresql://me:s3c/r@et@db/x?sslmode=require", "postgresql:///x?password=s3cret&user=me"):
            for ran in (start(self.data, uri, "config"), start(self.data, "", "config", environment={"DRIFTLAB_STORE": uri})):
                self.assertEqual(ran.returncode, 0, ran.stderr)
                self.assertIn("***", ran.stdout)
                self.assertNotIn("s3c", ran.stdout)

    def test_commands_that_know_sqlite_alone_say_so(self) -> None:
        for command in (("check",), ("backup", "--to", str(self.folder / "copy")), ("restore", "--from", str(self.folder))):
            ran = start(self.data, self.store, *command)
            self.assertEqual(ran.returncode, 2)
            self.assertIn("are for an SQLite store", ran.stderr)

    def test_tokens_are_made_by_the_command_line(self) -> None:
        made = start(self.data, self.store, "token", "create", "--name", "first", "--scope", "admin")
        self.assertEqual(made.returncode, 0, made.stderr)
        daemon = self.daemon()
        self.assertEqual(daemon.get("/v1/devices").status, 401)
        self.assertEqual(daemon.get("/v1/devices", Authorization=f"Bearer {made.stdout.strip()}").status, 200)
        daemon.kill()
        verified = start(self.data, self.store, "audit", "verify")
        self.assertEqual(verified.returncode, 0, verified.stderr)


if __name__ == "__main__":
    unittest.main()
