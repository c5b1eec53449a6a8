#!/usr/bin/env python3
"""Jobs an hour against workers on one PostgreSQL: real work until the cores run out, and work that waits until the queue does.

usage: jobs_per_hour.py [real|waiting]      (default both; DRIFTLABD is the daemon, DRIFTLAB_WAITING_SHIM what makes jobs wait)

Real: recordings of three gyroscope axes, a minute at 100 Hz, each of a device of its own, characterised by the nine models of the
default; each worker is a process that computes one job on one thread. Waiting: recordings of 256 samples and one model, whose columns
open only after 500 ms (tests/bench/waiting_shim.cpp), so that a job costs the processor next to nothing of a real one and all that the
queue costs; each worker is a process of eight jobs at once. The daemon that is asked has ended before the workers start. A rate is
that of the jobs between a tenth and nine tenths of what they did, by the times that the database gave their ends. The database's
commits reach the disk.
"""
from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import samples  # noqa: E402 - beside the tests
from daemon import Daemon  # noqa: E402
from queue_rates import Durable  # noqa: E402

AT_ONCE = 4
WAIT_MS = 500
REAL_WORKERS = (1, 2, 4, 8)
WAITING_WORKERS = (1, 2, 4, 8, 16)
JOBS_OF_A_PROCESS = 8
REAL_JOBS = 120
DEVICES = 64


class Lab:
    """A database, with a daemon on it while it is asked."""

    def __init__(self, server: Durable, folder: Path, environment: dict[str, str]) -> None:
        self.server, self.folder, self.environment = server, folder, environment
        self.together = ("--store", server.store_of(folder), "--blobs", str(folder / "shared"),
                         "--budget", "reserve_bytes=0", "--budget", "queued_jobs=1000000")

    def ask(self, work: Callable[[Daemon, int], str], count: int) -> list[str]:
        """What `work` returns of each number. The daemon works on one job meanwhile."""
        with Daemon(self.folder / "door", arguments=(*self.together, "--workers", "1", "--threads", "1"), environment=self.environment) as door:
            with ThreadPoolExecutor(AT_ONCE) as clients:
                told = list(clients.map(lambda i: work(door, i), range(count)))
            door.terminate()
        return told

    def rows(self, query: str) -> list[list[float]]:
        return self.server.rows(self.folder, query)

    def upload(self, count: int, rows: int, axes: str) -> list[str]:
        columns = ",".join(f"g{axis}=angular_rate:{axis}:deg/s" for axis in axes)
        content = samples.csv(samples.noise(rows, len(axes)), [f"g{axis}" for axis in axes])

        def one(door: Daemon, i: int) -> str:
            answer = door.upload(content + (",".join([f"{i / 1e6:.6f}"] * len(axes)) + "\n").encode(), device=f"unit-{i:04d}",
                                 rate_hz=100, columns=columns)
            assert answer.status == 201, answer.describe()
            return str(answer.json["id"])
        return self.ask(one, count)

    def rate(self, recordings: list[str], jobs: int, seed: int, workers: int, at_once: int, **parameters: Any) -> tuple[float, float]:
        """Jobs an hour, and the median of the time that one took [s]."""
        def one(door: Daemon, i: int) -> str:
            answer = door.characterise(recordings[i % len(recordings)], **parameters, seed=seed + i // len(recordings))
            assert answer.status in (201, 202), answer.describe()
            return str(answer.json["id"])
        asked = set(self.ask(one, jobs))
        self.server.sql(f"SET search_path = {self.server.schema_of(self.folder)}; ANALYZE")
        waiting = {job for [job] in self.rows("SELECT id FROM jobs WHERE finished_at IS NULL")} & asked
        with ExitStack() as stack:
            for i in range(workers):
                stack.enter_context(Daemon(self.folder / f"worker {i}", environment=self.environment,
                                           arguments=("worker", *self.together, "--workers", str(at_once), "--threads", str(at_once))))
            while self.rows("SELECT count(*) FROM jobs WHERE finished_at IS NULL")[0][0] > 0:
                time.sleep(0.5)
        found = [row for row in self.rows("SELECT id, finished_at, started_at FROM jobs WHERE state = 'succeeded' ORDER BY 2") if row[0] in waiting]
        assert len(found) == len(waiting), (len(found), len(waiting))
        ends = [end / 1e6 for _, end, _ in found]
        tenth = len(ends) // 10
        took = statistics.median((end - start) / 1e6 for _, end, start in found)
        return 3600.0 * (len(ends) - 1 - 2 * tenth) / (ends[-1 - tenth] - ends[tenth]), took


def measure(server: Durable, folder: Path, kind: str) -> None:
    print(f"| workers ({kind}) | jobs at once | jobs an hour | median of a job |\n|---|---|---|---|")
    if kind == "real":
        lab = Lab(server, folder, {})
        recordings = lab.upload(REAL_JOBS, 6000, "xyz")
        for turn, workers in enumerate(REAL_WORKERS):
            hourly, took = lab.rate(recordings, REAL_JOBS, 1 + turn, workers, 1)
            print(f"| {workers} | {workers} | {hourly:,.0f} | {took:.2f} s |", flush=True)
        return
    lab = Lab(server, folder, {"LD_PRELOAD": os.environ["DRIFTLAB_WAITING_SHIM"], "DRIFTLAB_WAIT_FOR": ".columns", "DRIFTLAB_WAIT_MS": str(WAIT_MS)})
    recordings = lab.upload(DEVICES, 256, "z")
    for turn, workers in enumerate(WAITING_WORKERS):
        at_once = workers * JOBS_OF_A_PROCESS
        hourly, took = lab.rate(recordings, min(20 * at_once, 1280), 1 + 100 * turn, workers, JOBS_OF_A_PROCESS, models=["WN"])
        print(f"| {workers} | {at_once} | {hourly:,.0f} | {took:.2f} s |", flush=True)


def main() -> None:
    server = Durable()
    for kind in sys.argv[1:] or ("real", "waiting"):
        with tempfile.TemporaryDirectory() as folder:
            measure(server, Path(folder), kind)
    server.remove()


if __name__ == "__main__":
    main()
