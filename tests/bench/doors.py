#!/usr/bin/env python3
"""How many answers a second one core gives: /healthz, a parameter table, and a table that the client has already.

usage: doors.py [SECONDS]     (each figure is the median of runs of one second; default 25; DRIFTLABD is the daemon)

The daemon runs on one core, wrk (Debian package `wrk`) on another, 16 connections with keep-alive. The table is one of
three recorded axes of two recordings. Each is measured with the cache of answers and without; the bytes of both
must be the same. One line is that of one connection, for the latency of a request that waits for nobody. The runs of all lines
take turns of a second, for a virtual machine is faster in one minute than in the next, and a ratio is the median of the ratios
within a turn. Answers are also counted by the second of processor time that the daemon took for them.
"""
from __future__ import annotations

import contextlib
import os
import re
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
from daemon import Daemon  # noqa: E402 - beside the tests

CONNECTIONS = 16


def recording(seed: int) -> bytes:
    generator = np.random.default_rng(seed)
    rates = generator.normal(0.0, 1e-3, (20_000, 3)) + np.cumsum(generator.normal(0.0, 1e-6, (20_000, 3)), axis=0)
    return b"gx,gy,gz\n" + "\n".join(",".join(f"{v:.9g}" for v in row) for row in rates).encode() + b"\n"


def fill(daemon: Daemon) -> str:
    """Two recordings of a device and their results; the target of its table."""
    ids = []
    for seed in (1, 2):
        answer = daemon.upload(recording(seed), device="bench", rate_hz=100)
        assert answer.status == 201, answer.describe()
        ids.append(answer.json["id"])
    job = daemon.characterise(*ids)
    assert job.status in (201, 202), job.describe()
    assert daemon.finished(job.json["id"])["state"] == "succeeded"
    target = "/v1/parameter-tables?device=bench&sensor=gyroscope&axis=x"
    table = daemon.get(target, Prefer="wait=60")
    assert table.status == 200 and table.json["pooling"]["state"] != "pending", table.describe()
    return target


@contextlib.contextmanager
def on_one_core(data: Path, *arguments: str) -> Iterator[tuple[str, int]]:
    """The daemon on core 0 with its log in a file, for whoever reads it from a pipe takes a part of the core; address and process."""
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        port = found.getsockname()[1]
    process = subprocess.Popen([os.environ["DRIFTLABD"], "--data", str(data), "--listen", f"127.0.0.1:{port}", "--log-file", str(data.parent / "log"), *arguments],
                               stderr=subprocess.DEVNULL, preexec_fn=lambda: os.sched_setaffinity(0, {0}))
    address = f"http://127.0.0.1:{port}"
    try:
        for _ in range(200):
            try:
                fetch(address + "/healthz")
                break
            except OSError:
                time.sleep(0.05)
        yield address, process.pid
    finally:
        process.terminate()
        process.wait()


def fetch(url: str) -> tuple[bytes, str]:
    """Body and tag."""
    with urllib.request.urlopen(url, timeout=30) as answer:
        return answer.read(), answer.headers["ETag"]


def processor_time(process: int) -> float:
    """Seconds that its threads have run."""
    times = (task.read_text().split()[0] for task in Path(f"/proc/{process}/task").glob("*/schedstat"))
    return sum(map(int, times)) / 1e9


class Case:
    """A line of the table."""

    def __init__(self, name: str, url: str, *, connections: int = CONNECTIONS, header: str = "") -> None:
        self.name, self.url, self.connections, self.header = name, url, connections, header
        self.runs: list[tuple[float, float, float]] = []

    def run(self, process: int) -> None:
        """Answers a second, answers a second of the daemon's processor time, and the 99th percentile of the latency in ms."""
        command = ["taskset", "-c", "1", "wrk", "-t1", f"-c{self.connections}", "-d1s", "--latency", self.url]
        if self.header:
            command[-1:-1] = ["-H", self.header]
        before = processor_time(process)
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        took = processor_time(process) - before
        assert "Non-2xx or 3xx" not in text and "Socket errors" not in text, text
        rate = float(re.search(r"Requests/sec:\s+([\d.]+)", text)[1])
        answers = int(re.search(r"(\d+) requests in", text)[1])
        value, unit = re.search(r"99%\s+([\d.]+)(us|ms|s)", text).groups()
        self.runs.append((rate, answers / took, float(value) * {"us": 1e-3, "ms": 1.0, "s": 1e3}[unit]))

    def figure(self, which: int) -> float:
        return statistics.median(run[which] for run in self.runs)

    def ratio(self, other: Case, which: int) -> float:
        return statistics.median(mine[which] / its[which] for mine, its in zip(self.runs, other.runs, strict=True))


def measure(cases: list[Case], turns: int, process: int) -> None:
    for _ in range(turns):
        for case in cases:
            case.run(process)
    for case in cases:
        print(f"| {case.name} | {case.figure(0):,.0f} | {case.figure(1):,.0f} | {case.figure(2):.2f} |", flush=True)


def main() -> int:
    turns = int(sys.argv[1]) if len(sys.argv) > 1 else 25
    if shutil.which("wrk") is None:
        print("doors.py: wrk is missing: apt-get install wrk", file=sys.stderr)
        return 2
    if (os.cpu_count() or 1) < 2:
        print("doors.py: needs two cores, one for the daemon and one for wrk", file=sys.stderr)
        return 2
    keep_alive = ("--budget", "requests_per_connection=1000000")
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "data"
        with Daemon(data) as daemon:
            target = fill(daemon)
        print("| what | answers a second | and of processor time | p99 ms |\n|---|---|---|---|")
        with on_one_core(data, *keep_alive) as (base, process):
            kept = [fetch(base + target) for _ in range(2)]
            alive, table = Case("/healthz", base + "/healthz"), Case("parameter table", base + target)
            known = Case("parameter table, If-None-Match", base + target, header=f"If-None-Match: {kept[0][1]}")
            alone = Case("parameter table, one connection", base + target, connections=1)
            measure([alive, table, known, alone], turns, process)
        with on_one_core(data, *keep_alive, "--budget", "answer_cache_bytes=0") as (base, process):
            made = fetch(base + target)
            measure([Case("parameter table, cache off", base + target)], turns, process)
    for which, what in ((0, "a second"), (1, "a second of processor time")):
        print(f"\nratios to /healthz, answers {what}: table {table.ratio(alive, which):.2f}, "
              f"revalidation {known.ratio(alive, which):.2f}", end="")
    print(f"; bytes with the cache off are the same: {'yes' if made == kept[0] == kept[1] else 'NO'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
