"""kill -9 at every named point of upload, claim, work and finish, and at random; then a restart.

Afterwards: nothing acknowledged is lost, no half recording is listed, no result appears twice, the same upload and the
same job succeed, and the database is whole.
"""
from __future__ import annotations

import hashlib
import os
import random
import signal
import sqlite3
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import samples
from daemon import PATIENCE_S, PROGRAM, Daemon, events
from history import LOST, MODELS, Client, History, Judge, at_work

LIVES = int(os.environ.get("DRIFTLAB_CRASH_LIVES", "30"))
SEED = int(os.environ.get("DRIFTLAB_CRASH_SEED", "20261121"))
LIVES_OF_A_DIRECTORY = 50  # the last look reads every recording that there is


def crash_points() -> list[str]:
    return subprocess.run([PROGRAM, "crash-points"], capture_output=True, text=True, check=True).stdout.split()


class Acknowledged:
    """What clients were told, and what must therefore be there after any crash."""

    def __init__(self) -> None:
        self.recordings: dict[str, bytes] = {}  # id -> content
        self.jobs: dict[str, str] = {}  # id -> the recording it is about
        self.succeeded: dict[str, str] = {}  # id -> digest of the result that was read

    def upload(self, daemon: Daemon, content: bytes) -> str:
        answer = daemon.upload(content, rate_hz=100, columns=samples.GYRO_Z)
        assert answer.status in (200, 201), answer.describe()
        self.recordings[answer.json["id"]] = content
        return str(answer.json["id"])

    def queue(self, daemon: Daemon, recording: str) -> str:
        answer = daemon.characterise(recording, models=MODELS)
        assert answer.status in (200, 202), answer.describe()
        self.jobs[answer.json["id"]] = recording
        return str(answer.json["id"])

    def finish(self, daemon: Daemon, job: str) -> None:
        document = daemon.finished(job)
        assert document["state"] == "succeeded", document
        result = daemon.get(document["result"]["href"])
        assert result.status == 200, result.describe()
        self.succeeded[job] = hashlib.sha256(result.body).hexdigest()


class CrashTest(unittest.TestCase):
    def check(self, daemon: Daemon, told: Acknowledged) -> None:
        """The invariants, on a daemon that was started after the crash."""
        self.assertEqual(daemon.files("incoming"), [])
        listed = {recording["id"]: recording for recording in daemon.items("/v1/recordings?limit=2")}
        self.assertLessEqual(set(told.recordings), set(listed), "an acknowledged recording is lost")
        pairs = [(recording["device"], recording["file"]["sha256"]) for recording in listed.values()]
        self.assertEqual(len(pairs), len(set(pairs)), "a recording is there twice")
        for identity, recording in listed.items():
            sha256 = recording["file"]["sha256"]
            content = (daemon.data / "blobs" / sha256[:2] / sha256).read_bytes()
            self.assertEqual(hashlib.sha256(content).hexdigest(), sha256, "a blob is damaged")
            self.assertIn(f"{sha256[:2]}/{sha256}.columns", daemon.files("columns"))
            if identity in told.recordings:
                self.assertEqual(content, told.recordings[identity])
        jobs = {job["id"]: job for job in daemon.items("/v1/jobs?limit=2&kind=characterise")}
        self.assertLessEqual(set(told.jobs), set(jobs), "an acknowledged job is lost")
        for job in jobs:  # queued again, or taken up where it was
            told.jobs.setdefault(job, jobs[job]["request"]["inputs"]["recordings"][0]["id"])
            before = told.succeeded.get(job)
            told.finish(daemon, job)
            self.assertIn(before, (None, told.succeeded[job]), "a result that was read has changed")
        for recording in listed:  # every listed recording can be characterised, and one result is one job
            told.finish(daemon, told.queue(daemon, recording))
        for identity, content in list(told.recordings.items()):
            self.assertEqual(told.upload(daemon, content), identity, "the same bytes are another recording")
        for job in told.succeeded:
            self.check_job(daemon, job)

    def check_job(self, daemon: Daemon, job: str) -> None:
        fits = daemon.items(f"/v1/fits?job={job}")
        self.assertEqual(sorted(fit["model"] for fit in fits), sorted(MODELS), "results are written once")
        states = [event.data["state"] for event in events(daemon, job) if event.type == "state"]
        self.assertEqual(states.count("succeeded"), 1, states)
        self.assertEqual(states[-1], "succeeded", states)

    def check_at_rest(self, daemon: Daemon) -> None:
        """Stops the daemon; then the database is whole and every row has one set of results."""
        self.assertEqual(daemon.terminate(), 0)
        database = sqlite3.connect(daemon.data / "driftlab.db")
        try:
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
            self.assertEqual(database.execute("PRAGMA foreign_key_check").fetchall(), [])
            [succeeded] = database.execute("SELECT count(*) FROM jobs WHERE state = 'succeeded' AND kind = 'characterise'").fetchone()
            of_kind = "SELECT count(*) FROM job_results JOIN jobs ON jobs.id = job_id WHERE kind = ?"
            self.assertEqual(database.execute(of_kind, ("characterise",)).fetchone(), (succeeded,))
            self.assertEqual(database.execute("SELECT count(*) FROM fits").fetchone(), (len(MODELS) * succeeded,))
            # One axis: its latest results are pooled by one job, and nothing of the sets before is left.
            self.assertLessEqual(database.execute(of_kind, ("pool",)).fetchone()[0], 1)
            live = "SELECT count(*) FROM pools JOIN jobs USING (unique_key) WHERE state IN ('queued', 'running', 'succeeded')"
            self.assertEqual(database.execute(live).fetchone(), database.execute("SELECT count(*) FROM pools").fetchone())
        finally:
            database.close()


class NamedPoints(CrashTest):
    def test_there_are_points_of_everything_that_must_not_end_half_way(self) -> None:
        points = crash_points()
        self.assertGreaterEqual(len(points), 18)
        self.assertEqual({point.partition(".")[0] for point in points}, {"upload", "job", "migrate", "backup"})
        self.assertNotEqual(subprocess.run([PROGRAM, "--data", "/nonexistent"], env={"DRIFTLAB_CRASH_AT": "nowhere"}, capture_output=True, check=False).returncode, 0)

    def crash_at(self, point: str) -> None:
        content = samples.gyro_csv(40_000, seed=7)  # more than one piece of 256 KiB
        with tempfile.TemporaryDirectory(prefix="driftlab-crash-") as folder:
            data = Path(folder) / "data"
            told = Acknowledged()
            with Daemon(data) as daemon:  # an earlier, undisturbed life
                told.finish(daemon, told.queue(daemon, told.upload(daemon, samples.gyro_csv(seed=1))))
                self.assertEqual(daemon.terminate(), 0)
            with Daemon(data, environment={"DRIFTLAB_CRASH_AT": point}) as daemon:
                try:
                    told.finish(daemon, told.queue(daemon, told.upload(daemon, content)))
                except LOST:
                    pass
                self.assertEqual(daemon.wait(), -signal.SIGKILL, f"{point} was not reached")
            self.assertEqual(len(told.recordings), 1 if point.startswith("upload.") else 2)
            with Daemon(data) as daemon:
                self.check(daemon, told)
                recording = told.upload(daemon, content)  # acknowledged or not, it works now
                self.assertEqual(daemon.get(f"/v1/recordings/{recording}").json["file"]["sha256"], hashlib.sha256(content).hexdigest())
                told.finish(daemon, told.queue(daemon, recording))
                self.assertEqual(len(daemon.items("/v1/recordings")), 2)
                self.assertEqual(len(daemon.items("/v1/jobs?kind=characterise")), 2, "the same job is one job, whatever crashed")
                self.check(daemon, told)
                self.check_at_rest(daemon)

    def test_every_point(self) -> None:
        for point in crash_points():
            if point.startswith(("upload.", "job.")):  # upgrade_test.py has the others
                with self.subTest(point=point):
                    self.crash_at(point)


class RandomMoments(Judge):
    """Clients upload, go on with uploads, change, remove and queue all the time; the daemon is killed after a random while, life after life."""

    def test_many_lives(self) -> None:
        generator = random.Random(SEED)
        for first in range(0, LIVES, LIVES_OF_A_DIRECTORY):
            with self.subTest(first=first), tempfile.TemporaryDirectory(prefix="driftlab-crash-") as folder:
                self.live_and_die(Path(folder), min(LIVES_OF_A_DIRECTORY, LIVES - first), generator)

    def live_and_die(self, folder: Path, lives: int, generator: random.Random) -> None:
        history = History()
        clients = [Client(history, generator.randrange(1 << 30)) for _ in range(2)]
        failures: list[str] = []
        whole_backups = 0
        for life in range(lives):
            with Daemon(folder / "data") as daemon:
                self.assertEqual(daemon.files("incoming"), [])
                self.judge(daemon, history)
                before = history.snapshot()
                backup = self.begin_backup(folder, life) if life % 4 == 3 else None
                threads = at_work(clients, daemon, failures)
                time.sleep(generator.uniform(0.02, 0.5))
                if backup is not None and generator.random() < 0.3:
                    backup.kill()
                daemon.kill()
                for thread in threads:
                    thread.join()
            if backup is not None:
                backup.wait(PATIENCE_S)
                whole_backups += self.judge_backup(folder, life, before, history)
        self.assertEqual(failures, [])
        self.assertGreater(len(history.recordings), lives // 3, "the clients did too little")
        self.assertTrue(whole_backups or lives < 20, "no backup was made to its end")
        with Daemon(folder / "data") as daemon:
            self.judge(daemon, history, whole=True)
            self.assertEqual(daemon.terminate(), 0)
        self.judge_at_rest(folder / "data")

    @staticmethod
    def begin_backup(folder: Path, life: int) -> subprocess.Popen[bytes]:
        return subprocess.Popen([PROGRAM, "backup", "--data", str(folder / "data"), "--to", str(folder / f"copy-{life}")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def judge_backup(self, folder: Path, life: int, before: History, after: History) -> bool:
        """A backup that has its name is whole, and holds what was acknowledged before it began."""
        if not (folder / f"copy-{life}").exists():
            return False
        again = folder / f"again-{life}"
        restored = subprocess.run([PROGRAM, "restore", "--from", str(folder / f"copy-{life}"), "--data", str(again)], capture_output=True, text=True, check=False)
        self.assertEqual(restored.returncode, 0, restored.stderr)
        with Daemon(again) as daemon:
            self.judge(daemon, before, live=after)
        return True

    def judge_at_rest(self, data: Path) -> None:
        database = sqlite3.connect(data / "driftlab.db")
        try:
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
            self.assertEqual(database.execute("PRAGMA foreign_key_check").fetchall(), [])
            counts = {count for [count] in database.execute("SELECT count(*) FROM fits GROUP BY job_id, recording_id")}
            self.assertLessEqual(counts, {len(MODELS)}, "results are written once, and as a whole")
            live = "SELECT count(*) FROM pools JOIN jobs USING (unique_key) WHERE state IN ('queued', 'running', 'succeeded')"
            self.assertEqual(database.execute(live).fetchone(), database.execute("SELECT count(*) FROM pools").fetchone())
        finally:
            database.close()


if __name__ == "__main__":
    unittest.main()
