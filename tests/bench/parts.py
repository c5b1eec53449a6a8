#!/usr/bin/env python3
"""How long one job takes against the workers that share it, on one PostgreSQL: real work until the cores run out, then work that waits.

usage: parts.py [real|waiting]      (default both; DRIFTLABD is the daemon, DRIFTLAB_WAITING_SHIM what makes recordings wait)

Real: the paper's scenario, 200 runs of its six filters. Waiting: a campaign of 32 recordings of 100,000 samples, whose columns open only
after half a second, each of twice (tests/bench/waiting_shim.cpp): a part costs the processor next to nothing of what it takes, and all that sharing costs.
Every worker is a process of one thread, the daemon that is asked one of them; they wait before the job is asked for. Medians of three; the
database's commits reach the disk.
"""
from __future__ import annotations

import os
import statistics
import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import samples  # noqa: E402 - beside the tests
from daemon import Daemon  # noqa: E402
from queue_rates import Durable  # noqa: E402

REAL_WORKERS = (1, 2)
WAITING_WORKERS = (1, 2, 4, 8, 16)
RECORDINGS = 32
RUNS = 200
TURNS = 3
WAIT_MS = 500


def outages(seed: int, runs: int) -> dict[str, Any]:
    return {"kind": "outage_evaluation", "inputs": {"scenario": "paper"}, "parameters": {"runs": runs, "seed": seed}}


class Lab:
    def __init__(self, server: Durable, folder: Path, environment: dict[str, str]) -> None:
        self.server, self.folder, self.environment = server, folder, environment
        self.together = ("--store", server.store_of(folder), "--blobs", "database", "--budget", "reserve_bytes=0",
                         "--workers", "1", "--threads", "1")

    def upload(self) -> list[str]:
        recordings = []
        with Daemon(self.folder / "door", arguments=self.together) as door:
            for i in range(RECORDINGS):
                answer = door.upload(samples.csv(samples.noise(100_000, 1, seed=1 + i), ["gz"]), device="unit", rate_hz=100,
                                     columns="gz=angular_rate:z:deg/s")
                assert answer.status == 201, answer.describe()
                recordings.append(str(answer.json["id"]))
        return recordings

    def took_s(self, asked: dict[str, Any], workers: int) -> float:
        """By the times that the database gave its claim and its end."""
        with ExitStack() as stack:
            for i in range(1, workers):
                stack.enter_context(Daemon(self.folder / f"worker {i}", environment=self.environment, arguments=("worker", *self.together)))
            door = stack.enter_context(Daemon(self.folder / "door", environment=self.environment, arguments=self.together))
            answer = door.post("/v1/jobs", asked)
            assert answer.status in (201, 202), answer.describe()
            job = str(answer.json["id"])
            assert door.finished(job)["state"] == "succeeded"
            [[took]] = self.server.rows(self.folder, f"SELECT (finished_at - started_at) / 1e6 FROM jobs WHERE id = '{job}'")
            return float(took)


def measure(server: Durable, folder: Path, kind: str) -> None:
    print(f"| workers ({kind}) | time of the job | of one worker's |\n|---|---|---|")
    if kind == "real":
        lab = Lab(server, folder, {})
        asks: list[dict[str, Any]] = [outages(1 + turn, RUNS) for turn in range(TURNS * len(REAL_WORKERS))]
        counts = REAL_WORKERS
    else:
        lab = Lab(server, folder, {"LD_PRELOAD": os.environ["DRIFTLAB_WAITING_SHIM"], "DRIFTLAB_WAIT_FOR": ".columns", "DRIFTLAB_WAIT_MS": str(WAIT_MS)})
        recordings = lab.upload()
        asks = [{"kind": "characterise", "inputs": {"recordings": recordings}, "parameters": {"models": ["WN"], "seed": 1 + turn}}
                for turn in range(TURNS * len(WAITING_WORKERS))]
        counts = WAITING_WORKERS
    alone = 0.0
    for count in counts:
        took = statistics.median(lab.took_s(asks.pop(), count) for _ in range(TURNS))
        alone = alone or took
        print(f"| {count} | {took:.1f} s | {took / alone:.3f} |", flush=True)


def main() -> None:
    server = Durable()
    for kind in sys.argv[1:] or ("real", "waiting"):
        with tempfile.TemporaryDirectory() as folder:
            measure(server, Path(folder), kind)
    server.remove()


if __name__ == "__main__":
    main()
