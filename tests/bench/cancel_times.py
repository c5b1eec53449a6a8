#!/usr/bin/env python3
"""How long every kind of job takes to end once it is cancelled, at moments spread over all that it does.

usage: cancel_times.py [MOMENTS] [--only NAME,NAME] [--seed N] [--busy N]    (default 20 moments; DRIFTLABD is the daemon's program)

Each job is asked for, left to run for a time drawn evenly from [0, LONGEST], a minute for a day's recording, and cancelled; a job that ended before is left
out, and the next drawn times are kept below its length. Prints, for each kind, the median and the longest time from the request
to the state `cancelled`, and the stage that the slowest was in. --busy keeps N processes computing beside the daemon, as a loaded
machine would. The table of tests/RELIABILITY.md is its output.
"""
from __future__ import annotations

import argparse
import contextlib
import io
import json
import os
import random
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(REPOSITORY / "tests/api"), str(REPOSITORY / "clients/python")]
os.environ.setdefault("DRIFTLABD", str(REPOSITORY / "build/release/bin/driftlabd"))

import samples  # noqa: E402
from daemon import Daemon  # noqa: E402

LONGEST_S = 12.0
DAY = "investigate, a day of three axes"  # takes minutes, in parts of which each may be long
RATE_HZ = 100.0
CHANNELS = {str(k): {"quantity": "angular_rate", "axis": "xyz"[k], "unit": "deg/s"} for k in range(3)}
REFERENCES = {str(k + 3): {"quantity": "reference_angular_rate", "axis": "xyz"[k], "unit": "deg/s"} for k in range(3)}
FORCES = {str(k + 3): {"quantity": "specific_force", "axis": "xyz"[k], "unit": "m/s^2"} for k in range(3)}


def npy(values: np.ndarray[Any, Any]) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, values)
    return buffer.getvalue()


def walk(rows: int, columns: int, seed: int) -> np.ndarray[Any, Any]:
    """White noise, a slow process, a line and a step: every part of a search has something to do."""
    generator = np.random.default_rng(seed)
    values = 0.1 * generator.standard_normal((rows, columns))
    values += np.cumsum(1e-5 * np.sqrt(100.0 / RATE_HZ) * generator.standard_normal((rows, columns)), axis=0)
    at = np.arange(rows) / RATE_HZ
    values[:, 0] += 0.03 * np.sin(2 * np.pi * 7.3 * at) + 0.05 * (at > 0.6 * at[-1])
    return values


def beside_a_reference(rows: int, seed: int) -> np.ndarray[Any, Any]:
    """Three axes that turn to and fro, and what a table says of the motion; the scale factors are 1.001."""
    at = np.arange(rows)[:, None] / RATE_HZ
    motion = np.array([30.0, 20.0, 10.0]) * np.sin(2 * np.pi * np.array([0.05, 0.07, 0.11]) * at)
    return np.hstack([walk(rows, 3, seed) + 1.001 * motion, motion])


def upload(daemon: Daemon, values: np.ndarray[Any, Any], device: str, others: dict[str, dict[str, str]] | None = None, condition: str = "static") -> str:
    answer = daemon.upload(npy(values), device=device, condition=condition, rate_hz=RATE_HZ,
                           columns=samples.roles({**CHANNELS, **(others or {})}))
    assert answer.status == 201, answer.describe()
    return str(answer.json["id"])


def study(daemon: Daemon, recordings: list[str], device: str, moment: int) -> str:
    """One of its own for every moment: what was examined once is not examined again."""
    document = {"device": {"id": device}, "recordings": [{"id": f"{moment}-{i}", "recording": recording}
                                                         for i, recording in enumerate(recordings)]}
    answer = daemon.post("/v1/studies", document)
    assert answer.status == 201, answer.describe()
    return str(answer.json["id"])


def jobs(daemon: Daemon) -> dict[str, Callable[[int], dict[str, Any]]]:
    """Name -> the request of a moment."""
    long = [upload(daemon, walk(1_200_000, 6, 1), "long", FORCES)]
    several = [upload(daemon, walk(180_000, 3, 2 + i), "several") for i in range(5)]
    whole_day = [upload(daemon, walk(8_640_000, 3, 8), "day")]
    turned = [upload(daemon, beside_a_reference(1_200_000, 7), "turned", REFERENCES, "profile")]
    drive_files = [daemon.upload(content, device="car", condition="drive", columns=samples.roles(columns)).json["id"]
                   for content, columns in zip(samples.drive_csvs(900), (samples.DRIVE_IMU, samples.DRIVE_GNSS))]
    drive = daemon.post("/v1/drives", samples.drive_document(*drive_files))
    assert drive.status == 201, drive.describe()
    day = json.loads((REPOSITORY / "tests/api/long_drive.json").read_text())

    def asked(kind: str, inputs: dict[str, Any], **parameters: Any) -> Callable[[int], dict[str, Any]]:
        return lambda moment: {"kind": kind, "inputs": inputs, "parameters": {**parameters, "seed": moment + 1}}

    def investigated(recordings: list[str], device: str) -> Callable[[int], dict[str, Any]]:
        return lambda moment: {"kind": "investigate", "inputs": {"study": study(daemon, recordings, device, moment)}}

    found = {
        "characterise, 1.2 million rows of six axes": asked("characterise", {"recordings": long}),
        "the same with all that is made on request": asked("characterise", {"recordings": long}, also=["total", "theo1", "psd"], taus=200, dynamic=50),
        "investigate, five recordings of three axes": investigated(several, "several"),
        "investigate, 1.2 million rows of six axes": investigated(long, "long"),
        "investigate, 1.2 million rows of three axes that turn": investigated(turned, "turned"),
        DAY: investigated(whole_day, "day"),
        "outage evaluation, the paper's, 20,000 runs": asked("outage_evaluation", {"scenario": "paper"}, runs=20000),
        "outage evaluation, a day at 100 Hz": asked("outage_evaluation", {"scenario": day}),
    }
    questions: tuple[tuple[str, dict[str, Any]], ...] = (("run", {}), ("simulate", {"runs": 200}), ("explain", {}))
    found |= {f"drive evaluation, {question} of 15 min": asked("drive_evaluation", {"drive": drive.json["id"]}, question=question, **more)
              for question, more in questions}
    return found


def cancelled_in(daemon: Daemon, request: dict[str, Any], wait_s: float) -> tuple[float, str] | float:
    """Seconds from the request to the end and the stage in which it came; or how long the job took, which had ended before."""
    queued = daemon.post("/v1/jobs", request)
    assert queued.status in {200, 202}, queued.describe()
    job = f"/v1/jobs/{queued.json['id']}"
    begun = time.monotonic()
    while (state := daemon.get(job).json)["state"] == "queued":
        time.sleep(0.002)
        begun = time.monotonic()
    while time.monotonic() - begun < wait_s:
        state = daemon.get(job).json
        if state["state"] != "running":
            return time.monotonic() - begun
        time.sleep(0.01)
    asked = time.monotonic()
    daemon.post(job + "/cancel")
    while (now := daemon.get(job).json)["state"] == "running":
        time.sleep(0.002)
    if now["state"] == "succeeded":
        return asked - begun
    assert now["state"] == "cancelled", now
    return time.monotonic() - asked, str(state.get("stage") or "")


@contextlib.contextmanager
def busy(processes: int) -> Iterator[None]:
    running = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(processes)]
    try:
        yield
    finally:
        for process in running:
            process.kill()
            process.wait()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("moments", nargs="?", type=int, default=20)
    parser.add_argument("--only", default="")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--busy", type=int, default=0)
    flags = parser.parse_args()
    print("| job | cancelled | median | longest | in the stage |\n|---|---|---|---|---|")
    with busy(flags.busy), Daemon(arguments=("--workers", "1")) as daemon:
        for name, request in jobs(daemon).items():
            if flags.only and not any(word in name for word in flags.only.split(",")):
                continue
            draw, longest = random.Random(flags.seed), 60.0 if name == DAY else LONGEST_S
            found: list[tuple[float, str]] = []
            for moment in range(flags.moments):
                ended = cancelled_in(daemon, request(moment), draw.uniform(0.0, longest))
                if isinstance(ended, float):
                    longest = min(longest, ended)
                else:
                    found.append(ended)
            if not found:
                print(f"| {name} | 0 of {flags.moments} | | | |", flush=True)
                continue
            worst, stage = max(found)
            print(f"| {name} | {len(found)} of {flags.moments} | {statistics.median(s for s, _ in found):.2f} s | {worst:.2f} s | {stage} |", flush=True)


if __name__ == "__main__":
    main()
