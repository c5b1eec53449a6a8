#!/usr/bin/env python3
"""From a file to fits: how long `driftlab characterise` takes with 15 minutes of six axes at 100 Hz as CSV, on all cores.

usage: short_file.py PROGRAM [AFTER] [--repeats R]

PROGRAM and AFTER are programs `driftlab`, run in turns, each first every other time; one round before is not counted. Prints the medians of the
time that passed and of the processor time.
"""
from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import samples  # noqa: E402 - beside the tests

ROWS = 90_000
NAMES = ["gx [deg/s]", "gy [deg/s]", "gz [deg/s]", "ax [m/s^2]", "ay [m/s^2]", "az [m/s^2]"]


def run(program: str, file: Path) -> tuple[float, float]:
    begun = time.monotonic()
    with subprocess.Popen([program, "characterise", str(file), "--rate-hz", "100"], stdout=subprocess.DEVNULL) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, process.returncode
    return time.monotonic() - begun, usage.ru_utime + usage.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("programs", nargs="+", metavar="PROGRAM")
    parser.add_argument("--repeats", type=int, default=15)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "quarter.csv"
        file.write_bytes(samples.csv(samples.noise(ROWS, 6), NAMES))
        taken: list[list[tuple[float, float]]] = [[] for _ in arguments.programs]
        for repeat in range(arguments.repeats + 1):
            for i in range(len(taken)) if repeat % 2 == 0 else reversed(range(len(taken))):
                one = run(arguments.programs[i], file)
                if repeat > 0:
                    taken[i].append(one)
    for program, times in zip(arguments.programs, taken):
        passed, processor = (statistics.median(column) for column in zip(*times))
        print(f"{Path(program).name}: {passed:.3f} s passed, {processor:.3f} s of processor time ({os.cpu_count()} cores)")


if __name__ == "__main__":
    main()
