#!/usr/bin/env python3
"""Memory and time of one investigation of long recordings, of one of six axes at 100 Hz where nothing else is asked for.

usage: investigation_memory.py [HOURS] [--axes 6] [--examined 3] [--recordings 1] [--rate-hz 100] [--keep DIR]
(default 24 h; DRIFTLAB is the command line program; eight quarters of an hour of three axes: 0.25 --axes 3 --recordings 8 --rate-hz 50)

`driftlab simulate` makes the axes of a sensor at rest, which become the columns of a .npy file. The examined ones are gyroscopes; the
others are accelerometers beside them, which are inputs of the search. More than three examined have no axis. --keep names the folder in which the study stays, and
where it is taken from if it is there already.

Prints the largest RssAnon of the process, which is what it allocated, read every 20 ms; its largest resident memory
(ru_maxrss), which counts pages of the mapped recording as far as the system keeps them; wall and processor time.
"""
from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np


def program() -> str:
    return os.environ.get("DRIFTLAB", "build/release/bin/driftlab")


def make_recording(data: Path, given: argparse.Namespace, first_seed: int) -> None:
    rows = round(3600 * given.hours * given.rate_hz)
    table = np.lib.format.open_memmap(data, mode="w+", dtype="<f8", shape=(rows, given.axes))
    for axis in range(given.axes):
        one = data.with_name("axis.npy")
        subprocess.run([program(), "simulate", "--rate-hz", str(given.rate_hz), "--duration-s", str(rows / given.rate_hz),
                        "--seed", str(first_seed + axis), "--out", str(one)], check=True, capture_output=True)
        values = np.load(one).reshape(-1)[:rows]
        table[:, axis] = values if axis < given.examined else 2e-3 * values / values.std()  # accelerometers: 2 mg
        one.unlink()
    table.flush()


def make_study(folder: Path, given: argparse.Namespace) -> Path:
    """A study of static recordings; what is in the folder already is used again."""
    named = given.examined <= 3
    columns: dict[str, dict[str, str]] = {}
    for k in range(given.axes):
        examined = k < given.examined
        columns[str(k)] = {"quantity": "angular_rate", "unit": "deg/s"} if examined else {"quantity": "specific_force", "unit": "g"}
        if named:
            columns[str(k)]["axis"] = "xyz"[k % 3]
    recordings = []
    for r in range(given.recordings):
        data = folder / f"unit-{given.hours:g}-{given.rate_hz:g}-{given.axes}-{given.examined}-{r}.npy"
        if not data.exists():
            make_recording(data, given, 1 + r * given.axes)
        recordings.append({"id": f"rest-{r + 1}", "file": data.name, "rate_hz": given.rate_hz, "columns": columns, "condition": {"kind": "static"}})
    path = folder / f"study-{given.hours:g}-{given.rate_hz:g}-{given.axes}-{given.examined}-{given.recordings}.json"
    path.write_text(json.dumps({"device": {"id": "long"}, "baseline": {"kind": "auto"}, "recordings": recordings}))
    return path


def largest_anonymous_kib(process: subprocess.Popen[bytes]) -> int:
    largest = 0
    while process.poll() is None:
        try:
            for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
                if line.startswith("RssAnon"):
                    largest = max(largest, int(line.split()[1]))
        except OSError:
            break
        time.sleep(0.02)
    return largest


def measure(study: Path) -> dict[str, float]:
    before = os.times()
    begun = time.monotonic()
    process = subprocess.Popen([program(), "investigate", str(study), "--out", str(study.with_suffix(".report"))], stderr=subprocess.DEVNULL)
    anonymous = largest_anonymous_kib(process)
    if process.wait() != 0:
        raise SystemExit(f"investigate ended with {process.returncode}")
    after = os.times()
    return {"RssAnon [MiB]": anonymous / 1024, "ru_maxrss [MiB]": resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024,
            "wall [s]": time.monotonic() - begun,
            "processor [s]": after.children_user + after.children_system - before.children_user - before.children_system}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hours", nargs="?", type=float, default=24.0)
    parser.add_argument("--axes", type=int, default=6)
    parser.add_argument("--examined", type=int, default=3)
    parser.add_argument("--recordings", type=int, default=1)
    parser.add_argument("--rate-hz", type=float, default=100.0)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = given.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        study = make_study(folder, given)
        figures = measure(study)
    rows = round(3600 * given.hours * given.rate_hz) * given.recordings
    print(f"{given.recordings} x {given.hours:g} h at {given.rate_hz:g} Hz, {rows} rows of {given.axes} axes, {given.examined} examined: "
          + ", ".join(f"{name} {value:.0f}" if value >= 100 else f"{name} {value:.1f}" for name, value in figures.items())
          + f"; {figures['RssAnon [MiB]'] * 2**20 / rows / given.axes:.0f} bytes a sample of every column")


if __name__ == "__main__":
    main()
