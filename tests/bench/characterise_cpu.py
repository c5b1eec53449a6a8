#!/usr/bin/env python3
"""Processor time of `driftlab characterise` on six recorded axes, of one program or of two in turns.

usage: characterise_cpu.py [--repeats R] [--file NAME] [--core C] PROGRAM [AFTER] [-- OPTION...]

PROGRAM and AFTER are programs `driftlab`, before a change and after it; options behind `--` go to both, e.g. `-- --stepwise`.
The recording is $DRIFTLAB_SHARED/data/NAME.npy.xz (default adis_16405_imu1: six axes of an ADIS16405, 10^6 samples each); columns and
units are those of the description beside it. R repeats (default 5) follow one of each program that is not counted. Two programs run in turns,
each first every other time, so that whatever else the machine does meets both. Prints the median and the spread of user and system time
in seconds, for two programs their ratio as well, which is the median of the ratios of neighbours. On one core (--core, default the first), for
threads that share the units of a core count each other's waiting.
"""
from __future__ import annotations

import argparse
import hashlib
import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

SHARED = Path(os.environ.get("DRIFTLAB_SHARED", Path(__file__).resolve().parents[2].parent / "shared"))


def columns(described: dict[str, list[str]]) -> str:
    """`gyro_x` in deg/s is `0=angular_rate:x:deg/s`, where it is the first column."""
    def role(name: str, unit: str) -> str:
        sensor, _, axis = name.partition("_")
        return f"{'angular_rate' if sensor.startswith('gyro') else 'specific_force'}:{axis}:{unit}"
    pairs = zip(described["columns"], described["units"])
    return ",".join(f"{i}={role(name, unit)}" for i, (name, unit) in enumerate(pairs))


def run(program: str, arguments: list[str], core: int) -> tuple[float, str]:
    """User and system time [s], and a digest of what it printed without the name of the program's version."""
    with subprocess.Popen([program, "characterise", *arguments, "--json"], stdout=subprocess.PIPE, text=True,
                          preexec_fn=lambda: os.sched_setaffinity(0, {core})) as process:
        assert process.stdout is not None
        printed = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{program} ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime, hashlib.sha256(printed.encode()).hexdigest()[:12]


def main() -> int:
    given = sys.argv[1:]
    options = given[given.index("--") + 1:] if "--" in given else []
    own = given[:given.index("--")] if "--" in given else given
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--file", default="adis_16405_imu1")
    parser.add_argument("--core", type=int, default=min(os.sched_getaffinity(0)))
    parser.add_argument("programs", nargs="+", metavar="PROGRAM")
    arguments = parser.parse_args(own)
    description = SHARED / "data" / f"{arguments.file}.json"
    if not description.exists():
        sys.exit(f"no {description.name} under DRIFTLAB_SHARED/data")
    described = json.loads(description.read_text(encoding="utf-8"))
    asked = [str(description.with_name(described["file"])), "--rate-hz", str(described["rate_hz"]), "--columns", columns(described), *options]
    count = len(arguments.programs)
    seconds: list[list[float]] = [[] for _ in range(count)]
    digests = [""] * count
    for repeat in range(arguments.repeats + 1):
        for i in range(count) if repeat % 2 == 0 else reversed(range(count)):
            taken, digests[i] = run(arguments.programs[i], asked, arguments.core)
            if repeat > 0:
                seconds[i].append(taken)
    names = ["before", "after"] if count == 2 else [Path(program).name for program in arguments.programs]
    print(f"{arguments.file} {' '.join(options)}: processor time of {arguments.repeats} runs")
    for name, times, digest in zip(names, seconds, digests):
        print(f"{name:8}{statistics.median(times):8.3f} s  ({min(times):.3f} to {max(times):.3f})  document {digest}")
    if count == 2:
        ratios = [after / before for before, after in zip(*seconds)]
        print(f"ratio   {statistics.median(ratios):8.3f}    ({min(ratios):.3f} to {max(ratios):.3f})")
    return 0


if __name__ == "__main__":
    sys.exit(main())
