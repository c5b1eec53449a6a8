#!/usr/bin/env python3
"""What each kind of job takes of a daemon's memory, beside what the daemon expects of it when it decides whether the job fits.

usage: job_memory.py [--only WORDS]      (DRIFTLABD is the daemon; about eight minutes)

Each job runs by itself in a daemon that has begun anew on a folder with its recordings, with one worker. Measured is the largest
RssAnon of the daemon while the job runs, read every 5 ms, above that before it was asked for; the columns stay in their mapped file.
What is expected comes from the refusal of the same job by a daemon whose jobs may take next to nothing; for what is pooled it is that
of the last recording's own job. The time is that of the job, of what is pooled that of the job that pools.
"""
from __future__ import annotations

import argparse
import io
import re
import sys
import tempfile
import time
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
from daemon import Daemon  # noqa: E402 - beside the tests

RATE_HZ = 100
LEAST = "1000000"  # bytes that jobs may take where each is to be refused

Request = dict[str, Any]


def table(rows: int, columns: int, seed: int) -> bytes:
    """White noise and a random walk, in deg/s, as .npy."""
    draw = np.random.default_rng(seed)
    values = draw.normal(0.0, 0.05, (rows, columns)) + np.cumsum(draw.normal(0.0, 1e-5, (rows, columns)), axis=0)
    written = io.BytesIO()
    np.save(written, values)
    return written.getvalue()


def uploaded(daemon: Daemon, count: int, rows: int, columns: int) -> list[str]:
    names = ",".join(f"{k}=angular_rate:{axis}:deg/s" for k, axis in zip(range(columns), "xyz"))
    ids = []
    for k in range(count):
        answer = daemon.upload(table(rows, columns, 1 + k), device="measured", rate_hz=RATE_HZ, columns=names)
        assert answer.status == 201, answer.describe()
        ids.append(answer.json["id"])
    return ids


def characterised(daemon: Daemon, recordings: list[str]) -> list[str]:
    for recording in recordings:
        job = daemon.characterise(recording, models=["WN"])
        assert daemon.finished(job.json["id"])["state"] == "succeeded", job.describe()
    return recordings


def characterise(daemon: Daemon, columns: int) -> Request:
    return {"kind": "characterise", "inputs": {"recordings": uploaded(daemon, 1, 1_000_000, columns)}}


def investigate(daemon: Daemon, recordings: int, columns: int, rows: int = 1_000_000) -> Request:
    kept = [{"recording": each} for each in uploaded(daemon, recordings, rows, columns)]
    study = daemon.post("/v1/studies", {"device": {"id": "measured"}, "recordings": kept})
    assert study.status == 201, study.describe()
    return {"kind": "investigate", "inputs": {"study": study.json["id"]}}


def regress(daemon: Daemon, results: int) -> Request:
    ids = characterised(daemon, uploaded(daemon, results, 15_000, 1))
    arms = {name: {"labels": {"firmware": name}, "recordings": [{"recording": each} for each in part]}
            for name, part in (("baseline", ids[::2]), ("candidate", ids[1::2]))}
    return {"kind": "regress", "inputs": {"device": "measured", **arms}}


def pool(daemon: Daemon, results: int, rows: int = 15_000) -> Request:
    """The job that characterises the last of them has one follow that pools them all; there is no other way to ask for it once it was done."""
    *others, last = uploaded(daemon, results, rows, 1)
    jobs = [daemon.characterise(other).json["id"] for other in others]
    for job in jobs:
        assert daemon.finished(job)["state"] == "succeeded"
    return {"kind": "characterise", "inputs": {"recordings": [last]}}


def outages(daemon: Daemon, runs: int) -> Request:
    return {"kind": "outage_evaluation", "inputs": {"scenario": "paper"}, "parameters": {"runs": runs}}


JOBS: dict[str, Callable[[Daemon], Request]] = {
    "characterise, 1 recording of 1 channel": lambda daemon: characterise(daemon, 1),
    "characterise, 1 recording of 3 channels": lambda daemon: characterise(daemon, 3),
    "investigate, 1 recording of 1 channel": lambda daemon: investigate(daemon, 1, 1),
    "investigate, 2 recordings of 1 channel": lambda daemon: investigate(daemon, 2, 1),
    "investigate, 2 recordings of 3 channels": lambda daemon: investigate(daemon, 2, 3),
    "investigate, 8 recordings of 3 channels, 45,000 rows each": lambda daemon: investigate(daemon, 8, 3, 45_000),
    "regress, 12 results of 15,000 samples": lambda daemon: regress(daemon, 12),
    "regress, 240 results of 15,000 samples": lambda daemon: regress(daemon, 240),
    "pool, 12 results of 1,000,000 samples": lambda daemon: pool(daemon, 12, 1_000_000),
    "pool, 40 results of 15,000 samples": lambda daemon: pool(daemon, 40),
    "pool, 240 results of 15,000 samples": lambda daemon: pool(daemon, 240),
    "pool, 1,000 results of 15,000 samples": lambda daemon: pool(daemon, 1000),
    "outage evaluation, 100 runs of the paper's": lambda daemon: outages(daemon, 100),
}


def expected_mib(data: Path, request: Request) -> int:
    with Daemon(data, arguments=("--budget", f"job_memory_bytes={LEAST}")) as daemon:
        refused = daemon.post("/v1/jobs", request)
        found = re.search(r"would take about (\d+) MiB", refused.describe())
        assert refused.status == 413 and found, refused.describe()
        return int(found[1])


def lasted_s(job: Request) -> float:
    begun, ended = (datetime.fromisoformat(job[when].replace("Z", "+00:00")) for when in ("started_at", "finished_at"))
    return (ended - begun).total_seconds()


def measured(data: Path, request: Request) -> tuple[float, float, float]:
    """MiB above those before, seconds that the job took, or the one that pooled its result, and seconds of processor time of all."""
    with Daemon(data, arguments=("--workers", "1")) as daemon:
        time.sleep(1.0)  # what its start needed has been given back
        before = daemon.memory_kib("RssAnon")
        used = daemon.processor_s()
        asked = daemon.post("/v1/jobs", request)
        assert asked.status == 202, asked.describe()
        largest = 0
        while daemon.get(f"/v1/jobs/{asked.json['id']}").json["finished_at"] is None:
            for _ in range(10):
                largest = max(largest, daemon.memory_kib("RssAnon") - before)
                time.sleep(0.005)
        ended = daemon.finished(asked.json["id"])
        assert ended["state"] == "succeeded", ended
        while sum(daemon.get("/v1/counts").json["jobs"].values()) > 0:  # what follows from it
            largest = max(largest, daemon.memory_kib("RssAnon") - before)
            time.sleep(0.005)
        pools = [job for job in daemon.items("/v1/jobs?kind=pool") if job["state"] == "succeeded" and job["started_at"] > ended["finished_at"]]
        seconds = lasted_s(max(pools, key=lambda job: job["started_at"]) if pools else ended)
        return largest / 1024, seconds, daemon.processor_s() - used


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--only", default="", help="jobs whose line has these words")
    given = parser.parse_args()
    print("| job | MiB | expected, MiB | s | s of processor |\n|---|---|---|---|---|")
    for name, prepare in JOBS.items():
        if given.only not in name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            data = Path(folder) / "data"
            with Daemon(data) as daemon:
                request = prepare(daemon)
                daemon.terminate()
            expected = expected_mib(data, request)
            mib, seconds, processor = measured(data, request)
        print(f"| {name} | {mib:.0f} | {expected} | {seconds:.2f} | {processor:.1f} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
