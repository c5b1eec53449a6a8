#!/usr/bin/env python3
"""Memory and time of one investigation of a long recording of six axes at 100 Hz.

usage: investigation_memory.py [HOURS] [--examined 3|6] [--keep DIR]    (default 24, 3; DRIFTLAB is the command line program)

`driftlab simulate` makes six axes of one sensor at rest, which become one .npy file of six columns. With 3 examined they
are an inertial unit: three gyroscopes, and three accelerometers beside them, which are inputs of the search. With 6
examined they are six gyroscope columns, and every one is searched. --keep names the folder in which the study stays, and
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

RATE_HZ = 100
AXES = 6


def program() -> str:
    return os.environ.get("DRIFTLAB", "build/release/bin/driftlab")


def make_study(folder: Path, hours: float, examined: int) -> Path:
    """A study of one static recording; what is in the folder already is used again."""
    data = folder / f"unit-{hours:g}-{examined}.npy"
    if not data.exists():
        rows = round(3600 * hours * RATE_HZ)
        table = np.lib.format.open_memmap(data, mode="w+", dtype="<f8", shape=(rows, AXES))
        for axis in range(AXES):
            one = folder / "axis.npy"
            subprocess.run([program(), "simulate", "--rate-hz", str(RATE_HZ), "--duration-s", str(rows / RATE_HZ), "--seed", str(axis + 1),
                            "--out", str(one)], check=True, stdout=subprocess.DEVNULL)
            values = np.load(one).reshape(-1)[:rows]
            table[:, axis] = values if axis < AXES // 2 or examined == AXES else 2e-3 * values / values.std()  # accelerometers: 2 mg
            one.unlink()
        table.flush()
    gyro = {"quantity": "angular_rate", "unit": "deg/s"}
    columns = {str(k): {**gyro, "axis": "xyz"[k]} for k in range(3)}
    columns |= {str(k + 3): {"quantity": "specific_force", "axis": "xyz"[k], "unit": "g"} for k in range(3)}
    if examined == AXES:
        columns = {str(k): dict(gyro) for k in range(AXES)}
    study = {"device": {"id": "long"}, "baseline": {"kind": "auto"},
             "recordings": [{"id": "rest", "file": data.name, "rate_hz": RATE_HZ, "columns": columns, "condition": {"kind": "static"}}]}
    path = folder / f"study-{hours:g}-{examined}.json"
    path.write_text(json.dumps(study))
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
    parser.add_argument("--examined", type=int, choices=(3, AXES), default=3)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = given.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        study = make_study(folder, given.hours, given.examined)
        figures = measure(study)
    rows = round(3600 * given.hours * RATE_HZ)
    print(f"{given.hours:g} h, {rows} rows of {AXES} axes, {given.examined} examined: "
          + ", ".join(f"{name} {value:.0f}" for name, value in figures.items())
          + f"; {figures['RssAnon [MiB]'] * 2**20 / rows / AXES:.0f} bytes a sample of every column")


if __name__ == "__main__":
    main()
