"""What tests of several daemons on one database share: clients that are told things, and what must be there for it at the end.

Nothing acknowledged is lost, no result is written twice, and a result that was read stays as it is.
"""
from __future__ import annotations

import hashlib
import random
import threading
import time
import unittest
from collections import Counter
from collections.abc import Callable
from typing import Any

import samples
from daemon import PATIENCE_S, Daemon, events
from history import LOST

MODELS = ["WN", "WN+GM"]
STREAMS = 12  # of so many jobs the stream of events is read too


class Told:
    """What clients were told, in the order of the answers."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.recordings: dict[str, bytes] = {}
        self.jobs: dict[str, str] = {}
        self.results: dict[str, set[str]] = {}
        self.read_at: list[float] = []  # when each result was read for the first time, time.monotonic()

    def note_result(self, job: str, body: bytes) -> None:
        with self.lock:
            if job not in self.results:
                self.read_at.append(time.monotonic())
            self.results.setdefault(job, set()).add(hashlib.sha256(body).hexdigest())


class Client(threading.Thread):
    """Uploads, asks and reads at whichever daemon answers, and asks again where one is lost; never reports what it was not told."""

    def __init__(self, daemons: Callable[[], list[Daemon]], told: Told, seed: int) -> None:
        super().__init__()
        self.daemons, self.told, self.random = daemons, told, random.Random(seed)
        self.failure = ""
        self.stop = threading.Event()

    def any_daemon(self) -> Daemon:
        """Waits for one, unless it is to stop."""
        while not (there := self.daemons()):
            if self.stop.wait(0.05):
                raise ConnectionError("nobody is there any more")
        return self.random.choice(there)

    def content(self) -> bytes:
        return samples.gyro_csv(2048, seed=self.random.randrange(1 << 30))

    def ask(self, content: bytes, device: str = "phone-07") -> str | None:
        """Uploads it and asks for its results; the job, or nothing where one of both was not acknowledged."""
        try:
            uploaded = self.any_daemon().upload(content, device=device, rate_hz=100, columns=samples.GYRO_Z)
            if uploaded.status not in (200, 201):
                return None
            recording = str(uploaded.json["id"])
            with self.told.lock:
                self.told.recordings[recording] = content
            asked = self.any_daemon().characterise(recording, models=MODELS)
            if asked.status not in (200, 202):
                return None
            with self.told.lock:
                self.told.jobs[asked.json["id"]] = recording
            return str(asked.json["id"])
        except LOST:
            return None

    def read(self, job: str) -> bool:
        """Whether there is a result by now."""
        try:
            read = self.any_daemon().get(f"/v1/jobs/{job}/result")
        except LOST:
            return False
        if read.status == 200:
            self.told.note_result(job, read.body)
        return read.status == 200


class Judge(unittest.TestCase):
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

    def judge(self, a: Daemon, b: Daemon, told: Told, rows: Callable[[str], list[list[Any]]]) -> None:
        """`rows`: of a query to the database."""
        begun = time.monotonic()
        for job in told.jobs:
            document = self.finished(a, job)
            self.assertEqual(document["state"], "succeeded", document)
        self.assertLess(time.monotonic() - begun, PATIENCE_S, "the queue is worked off")
        self.found_again(b)
        listed = {recording["id"]: recording for recording in b.items("/v1/recordings")}
        self.assertLessEqual(set(told.recordings), set(listed), "an acknowledged recording is lost")
        for identity, content in told.recordings.items():
            self.assertEqual(b.get(f"/v1/recordings/{identity}/content").body, content)
        hashes = Counter(recording["file"]["sha256"] for recording in listed.values())
        self.assertEqual(set(hashes.values()), {1}, "a recording is there twice")
        for job in told.jobs:
            for daemon in (a, b):
                told.note_result(job, daemon.get(f"/v1/jobs/{job}/result").body)
            self.assertEqual(len(told.results[job]), 1, "a result has changed")
            self.assertEqual(sorted(fit["model"] for fit in b.items(f"/v1/fits?job={job}")), sorted(MODELS), "results are written once")
        for job in list(told.jobs)[:STREAMS]:
            states = [event.data["state"] for event in events(b, job) if event.type == "state"]
            self.assertEqual((states.count("succeeded"), states[-1]), (1, "succeeded"), states)
        ends = rows("SELECT job_id, count(*) FROM job_events WHERE type = 'state' AND state = 'succeeded' GROUP BY job_id")
        self.assertLessEqual(set(told.jobs), {job for job, _ in ends})
        self.assertEqual({count for _, count in ends}, {1}, "a job has ended once")
        keys = rows("SELECT unique_key FROM jobs WHERE state IN ('queued', 'running', 'succeeded')")
        self.assertEqual(len(keys), len({key for [key] in keys}), "one request is one job")
