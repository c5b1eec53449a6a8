#!/usr/bin/env python3
"""CPU time of the daemon for a recording, from the first byte of its upload to its stored fits.

usage: recording_cpu.py [--minutes M] [--repeats R] [--cores C]     (default 15, 5, 1; DRIFTLABD is the daemon)

Six axes at 100 Hz as CSV: white noise, a fast Gauss-Markov process and a random walk at the scale of a phone. The job has the
default settings: Allan and wavelet variances, robust ones, the contamination test, nine models, every channel. Each repeat is another
recording of another device, for replicates of one condition are fitted together as well, which costs about as much again; the
first warms up and is not counted. Prints the median and the spread. On one core: threads that share the units of a core count each
other's waiting as CPU, and two of them take a third more.
"""
from __future__ import annotations

import argparse
import math
import os
import random
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
from daemon import Daemon  # noqa: E402 - beside the tests

RATE_HZ = 100.0
AXES = ("gx", "gy", "gz", "fx", "fy", "fz")
COLUMNS = ",".join(f"{name}={'angular_rate' if name[0] == 'g' else 'specific_force'}:{name[1]}:{'deg/s' if name[0] == 'g' else 'm/s^2'}" for name in AXES)


def axis(samples: int, generator: random.Random) -> list[float]:
    """N 0.0172, sigma 0.0442 with beta 1.71/s, K 0.0024, as the benchmarks of the fits have it."""
    step = 1.0 / RATE_HZ
    white, correlation = 0.0172 / math.sqrt(step), math.exp(-1.71 * step)
    drive, walk = 0.0442 * math.sqrt(1.0 - correlation * correlation), 0.0024 * math.sqrt(step)
    slow, markov, values = 0.0, generator.gauss(0.0, 0.0442), []
    for _ in range(samples):
        values.append(markov + slow + generator.gauss(0.0, white))
        markov = correlation * markov + generator.gauss(0.0, drive)
        slow += generator.gauss(0.0, walk)
    return values


def recording(samples: int, seed: int) -> bytes:
    generator = random.Random(seed)
    columns = [axis(samples, generator) for _ in AXES]
    return (",".join(AXES) + "\n" + "\n".join(",".join(f"{value:.6f}" for value in row) for row in zip(*columns)) + "\n").encode()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--minutes", type=float, default=15.0)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--cores", type=int, default=1)
    arguments = parser.parse_args()
    samples = int(arguments.minutes * 60.0 * RATE_HZ)
    seconds = []
    cores = sorted(os.sched_getaffinity(0))[:arguments.cores]
    with Daemon(before_exec=lambda: os.sched_setaffinity(0, cores)) as daemon:
        for repeat in range(arguments.repeats + 1):
            content = recording(samples, repeat)
            before = daemon.processor_s()
            uploaded = daemon.upload(content, device=f"bench-{repeat}", condition="static", rate_hz=RATE_HZ, columns=COLUMNS)
            assert uploaded.status == 201, uploaded.describe()
            job = daemon.post("/v1/jobs", {"kind": "characterise", "inputs": {"recordings": [uploaded.json["id"]]}, "parameters": {}})
            finished = daemon.finished(job.json["id"])
            assert finished["state"] == "succeeded", finished
            if repeat > 0:
                seconds.append(daemon.processor_s() - before)
    print(f"{samples} x {len(AXES)} samples: {statistics.median(seconds):.2f} s of CPU from upload to stored fits "
          f"(median of {len(seconds)}, {min(seconds):.2f} to {max(seconds):.2f})")
    return 0


if __name__ == "__main__":
    sys.exit(main())
