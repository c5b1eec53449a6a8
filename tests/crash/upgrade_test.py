"""Migrations and backups that die half-way, and a database of the first release that comes up to date with its rows.

The old database is made from what this release stores: the first migration's tables, filled with the columns that they have.
"""
from __future__ import annotations

import hashlib
import signal
import sqlite3
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

import samples
from daemon import PATIENCE_S, PROGRAM, Daemon
from history import MODELS

SOURCE = Path(__file__).resolve().parents[2]
MIGRATIONS = sorted((SOURCE / "migrations/sqlite").glob("*.sql"))


def crash_points(of: str) -> list[str]:
    listed = subprocess.run([PROGRAM, "crash-points"], capture_output=True, text=True, check=True).stdout.split()
    return [point for point in listed if point.startswith(of)]


def schema_of(data: Path) -> int:
    database = sqlite3.connect(data / "driftlab.db")
    try:
        return int(database.execute("PRAGMA user_version").fetchone()[0])
    finally:
        database.close()


class Lab(unittest.TestCase):
    """Two recordings of one device with their results."""

    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="driftlab-upgrade-")))
        self.data = self.folder / "data"
        self.content: dict[str, bytes] = {}
        self.results: dict[str, bytes] = {}
        with Daemon(self.data) as daemon:
            for seed in (1, 2):
                content = samples.gyro_csv(600, seed=seed)
                recording = daemon.upload(content, rate_hz=100, columns=samples.GYRO_Z).json["id"]
                job = daemon.finished(daemon.characterise(recording, models=MODELS).json["id"])
                self.content[recording] = content
                self.results[job["id"]] = daemon.get(job["result"]["href"]).body
            self.assertEqual(daemon.terminate(), 0)

    def judge(self, daemon: Daemon, *, new: bool = True) -> None:
        self.assertEqual({recording["id"] for recording in daemon.items("/v1/recordings")}, set(self.content))
        for recording, content in self.content.items():
            self.assertEqual(daemon.get(f"/v1/recordings/{recording}/content").body, content)
        for job, result in self.results.items():
            self.assertEqual(daemon.get(f"/v1/jobs/{job}/result").body, result)
            self.assertEqual(sorted(fit["model"] for fit in daemon.items(f"/v1/fits?job={job}")), sorted(MODELS))
        table = daemon.get("/v1/parameter-tables?device=phone-07&axis=z", Prefer="wait=60")
        self.assertEqual(table.status, 200, table.describe())
        self.assertEqual(len(table.json["rows"][0]["recordings"]), 2)
        if new:
            job = daemon.characterise(next(iter(self.content)), models=MODELS, seed=5).json["id"]
            self.assertEqual(daemon.finished(job)["state"], "succeeded")


class Upgrade(Lab):
    def setUp(self) -> None:
        super().setUp()
        new, old = self.data / "driftlab.db", self.folder / "old.db"
        database = sqlite3.connect(old)
        database.executescript(MIGRATIONS[0].read_text())
        database.execute("CREATE TABLE schema_migrations (number INTEGER NOT NULL PRIMARY KEY, name TEXT NOT NULL, sha256 TEXT NOT NULL, applied_at INTEGER NOT NULL) STRICT")
        tables = [name for [name] in database.execute("SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%'")]
        database.execute("ATTACH ? AS new", (str(new),))
        kept = {"schema_migrations": "number = 1", "jobs": "kind = 'characterise'", "job_events": "job_id IN (SELECT id FROM jobs)", "job_results": "job_id IN (SELECT id FROM jobs)"}
        for table in tables:
            columns = [row[1] for row in database.execute(f"SELECT cid, name FROM pragma_table_info('{table}', 'main')")]
            both = ",".join(name for name in columns if name in {row[1] for row in database.execute(f"SELECT cid, name FROM pragma_table_info('{table}', 'new')")})
            database.execute(f"INSERT INTO main.{table} ({both}) SELECT {both} FROM new.{table} WHERE {kept.get(table, '1')}")
        self.filled = {table: database.execute(f"SELECT count(*) FROM main.{table}").fetchone()[0] for table in tables}
        [sha256] = database.execute("SELECT sha256 FROM main.schema_migrations").fetchone()
        self.assertEqual(sha256, hashlib.sha256(MIGRATIONS[0].read_bytes()).hexdigest())
        database.commit()
        database.execute("DETACH new")
        database.execute(f"PRAGMA application_id = {0x64726674}")
        database.execute("PRAGMA user_version = 1")
        database.close()
        for file in self.data.glob("driftlab.db*"):
            file.unlink()
        old.rename(new)

    def test_the_first_release_comes_up_to_date_with_its_rows(self) -> None:
        for table in ("devices", "blobs", "recordings", "jobs", "job_results", "channel_results", "fits"):
            self.assertGreater(self.filled[table], 0, table)
        with Daemon(self.data) as daemon:
            self.judge(daemon)
            self.assertEqual(daemon.terminate(), 0)
        self.assertEqual(schema_of(self.data), len(MIGRATIONS))
        [backup] = list((self.data / "backups").glob("schema-1-*.db"))
        copy = sqlite3.connect(backup)
        self.assertEqual(copy.execute("SELECT count(*) FROM recordings").fetchone(), (2,), "the copy from before is whole")
        copy.close()

    def test_a_migration_killed_at_each_step_goes_on(self) -> None:
        """Killed after every single migration, and within the transaction of one: the schema is never between two numbers."""
        deaths = 0
        for number in range(2, len(MIGRATIONS) + 1):
            for point in ("migrate.in_step", "migrate.stepped") if number % 3 == 2 else ("migrate.stepped",):
                self.die(point)
                self.assertEqual(schema_of(self.data), number - 1 if point == "migrate.in_step" else number)
                deaths += 1
        self.assertGreaterEqual(deaths, len(MIGRATIONS) - 1)
        with Daemon(self.data) as daemon:
            self.judge(daemon)

    def test_every_point_of_a_migration(self) -> None:
        points = crash_points("migrate.")
        self.assertEqual(len(points), 3)
        for point in points:
            self.die(point)
        with Daemon(self.data) as daemon:
            self.judge(daemon)

    def die(self, point: str) -> None:
        process = subprocess.run([PROGRAM, "--data", str(self.data), "--listen", "127.0.0.1:0"], env={"DRIFTLAB_CRASH_AT": point}, capture_output=True, check=False, timeout=PATIENCE_S)
        self.assertEqual(process.returncode, -signal.SIGKILL, f"{point} was not reached: {process.stderr!r}")


class Backup(Lab):
    def run_backup(self, to: Path, point: str = "") -> subprocess.CompletedProcess[bytes]:
        environment: dict[str, Any] = {"DRIFTLAB_CRASH_AT": point} if point else {}
        return subprocess.run([PROGRAM, "backup", "--data", str(self.data), "--to", str(to)], env=environment, capture_output=True, check=False, timeout=PATIENCE_S)

    def test_a_backup_that_dies_is_whole_or_not_there(self) -> None:
        points = crash_points("backup.")
        self.assertEqual(len(points), 4)
        with Daemon(self.data) as daemon:
            for point in points:
                with self.subTest(point=point):
                    to = self.folder / point
                    self.assertEqual(self.run_backup(to, point).returncode, -signal.SIGKILL)
                    self.assertEqual(to.exists(), point == "backup.named", "it has its name when it is whole")
                    if not to.exists():
                        again = self.run_backup(to)
                        self.assertEqual(again.returncode, 0, again.stderr)
                    restored = self.folder / f"restored {point}"
                    back = subprocess.run([PROGRAM, "restore", "--from", str(to), "--data", str(restored)], capture_output=True, check=False, timeout=PATIENCE_S)
                    self.assertEqual(back.returncode, 0, back.stderr)
                    with Daemon(restored) as other:
                        self.judge(other, new=False)
            self.judge(daemon)


if __name__ == "__main__":
    unittest.main()
