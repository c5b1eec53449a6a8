"""One job, many workers: a campaign, a long recording and a Monte Carlo run divided among processes on one PostgreSQL.

The result is compared with that of one daemon of one thread that has its store alone, to the last digit; workers are killed while they
work on parts, the job's own one among them.
"""
from __future__ import annotations

import functools
import random
import re
import tempfile
import time
import unittest
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import postgres
import samples
from daemon import PATIENCE_S, Daemon

ROWS = 240_000  # of a recording of three axes: three of them are worth sharing
RUNS = 80  # four batches
SEED = 20261129
ALONE = ("--workers", "1", "--threads", "1", "--budget", "reserve_bytes=0")

if postgres.programs() is None:
    print("JOBS IN PARTS NOT TESTED: there is no PostgreSQL.")
    raise SystemExit(77)

CONTENTS = {f"day {i}": samples.csv(samples.noise(ROWS, 3, seed=10 + i), ["gx", "gy", "gz"]) for i in range(3)}
COLUMNS = ",".join(f"g{axis}=angular_rate:{axis}:deg/s" for axis in "xyz")


def campaign(daemon: Daemon) -> str:
    recordings = []
    for content in CONTENTS.values():
        answer = daemon.upload(content, device="unit-1", rate_hz=100, columns=COLUMNS)
        assert answer.status in (200, 201), answer.describe()
        recordings.append(answer.json["id"])
    return str(daemon.characterise(*recordings).json["id"])


def monte_carlo(daemon: Daemon) -> str:
    asked = {"kind": "outage_evaluation", "inputs": {"scenario": "paper"}, "parameters": {"runs": RUNS, "seed": SEED}}
    return str(daemon.post("/v1/jobs", asked).json["id"])


def told(daemon: Daemon, job: str) -> str:
    """The result without the names that ids and times give it."""
    answer = daemon.get(f"/v1/jobs/{job}/result")
    assert answer.status == 200, answer.describe()
    return re.sub(r"\b(rec|chr|fit|dev|job)_[0-9A-Z]{26}", r"\1", answer.text)


@functools.cache
def alone(ask: Callable[[Daemon], str]) -> str:
    with tempfile.TemporaryDirectory() as folder, Daemon(Path(folder), arguments=ALONE) as daemon:
        job = ask(daemon)
        assert daemon.finished(job)["state"] == "succeeded"
        return told(daemon, job)


def ended(job: str) -> str:
    return f"(SELECT finished_at IS NOT NULL FROM jobs WHERE id = '{job}')"


class Workers:
    """Processes of one thread each on one database, and the daemon that is asked."""

    def __init__(self, folder: Path, count: int) -> None:
        self.folder, self.server = folder, postgres.cluster()
        self.together = ("--store", self.server.store_of(folder), "--blobs", "database", *ALONE)
        self.stack = ExitStack()
        self.door = self.stack.enter_context(Daemon(folder / "door", arguments=self.together))
        self.names = [f"worker {i}" for i in range(count)]
        self.running = {name: self.start(name) for name in self.names}

    def start(self, name: str) -> Daemon:
        return self.stack.enter_context(Daemon(self.folder / name, arguments=("worker", *self.together)))

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, *unused: object) -> None:
        self.stack.close()

    def rows(self, query: str) -> list[list[Any]]:
        return self.server.rows(self.folder, query)

    def wait_for(self, query: str) -> None:
        until = time.monotonic() + PATIENCE_S
        while not self.rows(query)[0][0]:
            assert time.monotonic() < until, query
            time.sleep(0.02)

    def wait_for_finished_parts(self, job: str, count: int) -> bool:
        """Until so many parts of a job are finished; False where the job has ended before, which takes its parts away."""
        self.wait_for(f"SELECT count(*) >= {count} OR {ended(job)} FROM job_parts WHERE job_id = '{job}' AND state = 'finished'")
        return not self.rows(f"SELECT {ended(job)}")[0][0]


class JobsInParts(unittest.TestCase):
    def check(self, ask: Callable[[Daemon], str]) -> None:
        expected = alone(ask)
        with tempfile.TemporaryDirectory() as folder, Workers(Path(folder), 2) as workers:
            job = ask(workers.door)
            workers.wait_for(f"SELECT count(*) >= 2 FROM job_parts WHERE job_id = '{job}' AND state = 'running'")
            self.assertEqual(workers.door.finished(job)["state"], "succeeded")
            self.assertEqual(told(workers.door, job), expected)
            self.assertEqual(workers.rows("SELECT count(*) FROM job_parts"), [[0]], "parts end with their job")
            self.assertEqual(workers.door.get(f"/v1/jobs/{job}").json["attempt"], 1)
            pages = "\n".join(daemon.get("/metrics").text for daemon in (workers.door, *workers.running.values()))
            helped = re.findall(r"^driftlab_job_parts_helped_total\{.*\} (\d+)$", pages, re.MULTILINE)
            self.assertGreaterEqual(sum(map(int, helped)), 1, "two were at work at once")

    def test_a_campaign_is_the_same_on_three_workers(self) -> None:
        self.check(campaign)

    def test_a_monte_carlo_run_is_the_same_on_three_workers(self) -> None:
        self.check(monte_carlo)

    def test_whoever_is_killed_the_result_is_the_same(self) -> None:
        expected = alone(monte_carlo)
        chance = random.Random(SEED)
        with tempfile.TemporaryDirectory() as folder, Workers(Path(folder), 3) as workers:
            job = monte_carlo(workers.door)
            killed = 0
            for turn in range(3):
                if not workers.wait_for_finished_parts(job, turn + 1):
                    break  # the others were quick
                name = chance.choice(workers.names)
                workers.running[name].kill()
                killed += 1
                workers.running[name] = workers.start(name)
            self.assertEqual(workers.door.finished(job)["state"], "succeeded")
            self.assertEqual(told(workers.door, job), expected)
            self.assertEqual(workers.rows("SELECT count(*) FROM job_attempts"), [[0]], "a killed worker is no failure")
            self.assertGreaterEqual(killed, 1)

    def test_the_jobs_own_worker_is_killed_and_what_was_found_stays(self) -> None:
        expected = alone(monte_carlo)
        with tempfile.TemporaryDirectory() as folder, Workers(Path(folder), 1) as workers:
            job = monte_carlo(workers.door)
            self.assertTrue(workers.wait_for_finished_parts(job, 2))
            workers.door.kill()  # it claimed the job, or helped: whichever, one process is left
            kept = f"SELECT number, md5(result) FROM job_parts WHERE job_id = '{job}' AND state = 'finished' ORDER BY 1"
            found = workers.rows(kept)
            workers.wait_for_finished_parts(job, len(found) + 1)
            later = workers.rows(kept)
            if not workers.rows(f"SELECT {ended(job)}")[0][0]:
                self.assertEqual([part for part in found if part not in later], [], "what was found stays")
            with Daemon(workers.folder / "another door", arguments=workers.together) as door:
                self.assertEqual(door.finished(job)["state"], "succeeded")
                self.assertEqual(told(door, job), expected)
            self.assertGreaterEqual(len(found), 2)

    def test_a_cancelled_job_frees_its_helpers(self) -> None:
        with tempfile.TemporaryDirectory() as folder, Workers(Path(folder), 2) as workers:
            job = monte_carlo(workers.door)
            workers.wait_for(f"SELECT count(*) >= 2 FROM job_parts WHERE job_id = '{job}' AND state = 'running'")
            workers.door.post(f"/v1/jobs/{job}/cancel")
            self.assertEqual(workers.door.finished(job)["state"], "cancelled")
            self.assertEqual(workers.rows("SELECT count(*) FROM job_parts"), [[0]])
            another = str(workers.door.post("/v1/jobs", {"kind": "outage_evaluation", "inputs": {"scenario": "paper"},
                                                         "parameters": {"runs": 4}}).json["id"])
            self.assertEqual(workers.door.finished(another)["state"], "succeeded")


if __name__ == "__main__":
    unittest.main(verbosity=2)
