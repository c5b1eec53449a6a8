"""Two daemons and two workers on one PostgreSQL database; kill -9 of any of them, and of the database, by a seeded schedule.

What clients were told is a history that is checked at the end: nothing acknowledged is lost, no result is written twice, and
a result that was read stays as it is. The server keeps `fsync` off: processes die here, the machine does not.
"""
from __future__ import annotations

import hashlib
import os
import random
import tempfile
import threading
import time
import unittest
from collections import Counter
from pathlib import Path
from typing import Any

import postgres
import samples
from crash_test import LOST
from daemon import PATIENCE_S, Daemon, events

ROUNDS = int(os.environ.get("DRIFTLAB_CLUSTER_ROUNDS", "5"))
SEED = int(os.environ.get("DRIFTLAB_CLUSTER_SEED", "20261124"))
MODELS = ["WN", "WN+GM"]
DAEMONS = ("a", "b")
WORKERS = ("worker 1", "worker 2")
FAULTS = 3  # in a round
UPLOADS = 6

if postgres.programs() is None:
    print("SEVERAL DAEMONS NOT TESTED: there is no PostgreSQL.")
    raise SystemExit(77)


class Cluster:
    """The processes of one database, each of which may be dead."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.database = postgres.cluster()
        self.store = self.database.store_of(folder)
        self.running: dict[str, Daemon] = {}

    def start(self, name: str) -> None:
        together = ("--store", self.store, "--blobs", str(self.folder / "shared"), "--budget", "reserve_bytes=0", "--workers", "1")
        self.running[name] = Daemon(self.folder / name, arguments=(*(("worker",) if name in WORKERS else ()), *together))

    def kill(self, name: str) -> None:
        if name == "database":
            self.database.stop()
            self.database.start()
        else:
            self.running.pop(name).kill()
            self.start(name)

    def end(self) -> None:
        for daemon in self.running.values():
            daemon.kill()


class History:
    """What clients were told, in the order of the answers."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.recordings: dict[str, bytes] = {}
        self.jobs: dict[str, str] = {}
        self.results: dict[str, set[str]] = {}

    def note_result(self, job: str, body: bytes) -> None:
        with self.lock:
            self.results.setdefault(job, set()).add(hashlib.sha256(body).hexdigest())


class Client(threading.Thread):
    """Uploads, asks and reads at whichever daemon answers, and asks again where one is lost; never reports what it was not told."""

    def __init__(self, cluster: Cluster, history: History, seed: int) -> None:
        super().__init__()
        self.cluster, self.history, self.random = cluster, history, random.Random(seed)
        self.failure = ""

    def any_daemon(self) -> Daemon:
        while True:
            daemon = self.cluster.running.get(self.random.choice(DAEMONS))
            if daemon is not None:
                return daemon
            time.sleep(0.05)

    def run(self) -> None:
        until = time.monotonic() + 2 * PATIENCE_S
        for _ in range(UPLOADS):
            content = samples.gyro_csv(2048, seed=self.random.randrange(1 << 30))
            while not self.one(content):
                if time.monotonic() > until:
                    self.failure = "no daemon served a client in time"
                    return
                time.sleep(0.1)

    def one(self, content: bytes) -> bool:
        try:
            uploaded = self.any_daemon().upload(content, rate_hz=100, columns=samples.GYRO_Z)
            if uploaded.status not in (200, 201):
                return False
            recording = uploaded.json["id"]
            with self.history.lock:
                self.history.recordings[recording] = content
            asked = self.any_daemon().characterise(recording, models=MODELS)
            if asked.status not in (200, 202):
                return False
            with self.history.lock:
                self.history.jobs[asked.json["id"]] = recording
            read = self.any_daemon().get(f"/v1/jobs/{asked.json['id']}/result")
            if read.status == 200:
                self.history.note_result(asked.json["id"], read.body)
            return True
        except LOST:
            return False


class Killed(unittest.TestCase):
    def test_nothing_is_lost_or_done_twice_whatever_dies(self) -> None:
        for number in range(ROUNDS):
            with self.subTest(round=number, seed=SEED + number):
                self.round(SEED + number)

    def round(self, seed: int) -> None:
        schedule = random.Random(seed)
        with tempfile.TemporaryDirectory() as folder:
            cluster, history = Cluster(Path(folder)), History()
            try:
                for name in (*DAEMONS, *WORKERS):
                    cluster.start(name)
                clients = [Client(cluster, history, schedule.randrange(1 << 30)) for _ in range(2)]
                for client in clients:
                    client.start()
                for _ in range(FAULTS):
                    time.sleep(schedule.uniform(0.2, 2.0))
                    cluster.kill(schedule.choice((*DAEMONS, *WORKERS, *DAEMONS, *WORKERS, "database")))
                for client in clients:
                    client.join()
                    self.assertEqual(client.failure, "")
                self.check(cluster, history)
            finally:
                cluster.end()

    def finished(self, daemon: Daemon, job: str) -> dict[str, Any]:
        """The job's document once it has ended; 503 while a daemon has not found its database again is no loss."""
        until = time.monotonic() + PATIENCE_S
        while True:
            answer = daemon.get(f"/v1/jobs/{job}")
            self.assertIn(answer.status, (200, 503), answer.describe())
            if answer.status == 200 and answer.json["finished_at"] is not None:
                return dict(answer.json)
            self.assertLess(time.monotonic(), until, answer.describe())
            time.sleep(0.05)

    def found_again(self, daemon: Daemon) -> None:
        """Waits while the daemon answers 503, for it has not found its database again."""
        until = time.monotonic() + PATIENCE_S
        while (answer := daemon.get("/v1/recordings?limit=1")).status == 503:
            self.assertLess(time.monotonic(), until, answer.describe())
            time.sleep(0.05)
        self.assertEqual(answer.status, 200, answer.describe())

    def check(self, cluster: Cluster, history: History) -> None:
        a, b = (cluster.running[name] for name in DAEMONS)
        begun = time.monotonic()
        for job in history.jobs:
            document = self.finished(a, job)
            self.assertEqual(document["state"], "succeeded", document)
        self.assertLess(time.monotonic() - begun, PATIENCE_S, "the queue is worked off")
        self.found_again(b)
        listed = {recording["id"]: recording for recording in b.items("/v1/recordings")}
        self.assertLessEqual(set(history.recordings), set(listed), "an acknowledged recording is lost")
        for identity, content in history.recordings.items():
            self.assertEqual(b.get(f"/v1/recordings/{identity}/content").body, content)
        hashes = Counter(recording["file"]["sha256"] for recording in listed.values())
        self.assertEqual(set(hashes.values()), {1}, "a recording is there twice")
        for job in history.jobs:
            for daemon in (a, b):
                history.note_result(job, daemon.get(f"/v1/jobs/{job}/result").body)
            self.assertEqual(len(history.results[job]), 1, "a result has changed")
            self.assertEqual(sorted(fit["model"] for fit in b.items(f"/v1/fits?job={job}")), sorted(MODELS), "results are written once")
            states = [event.data["state"] for event in events(b, job) if event.type == "state"]
            self.assertEqual((states.count("succeeded"), states[-1]), (1, "succeeded"), states)
        rows = cluster.database.rows(cluster.folder, "SELECT unique_key FROM jobs WHERE state IN ('queued', 'running', 'succeeded')")
        self.assertEqual(len(rows), len({key for [key] in rows}), "one request is one job")


if __name__ == "__main__":
    unittest.main()
