#!/usr/bin/env python3
"""How long the end of a job with its results and the move of a store take at some distance from PostgreSQL.

usage: finish_times.py [REPETITIONS [BENCHMARK ...]]      (default 5 build/release/bin/finish_bench)

Runs tests/bench/finish_bench.cpp through a relay that holds back what it is given in either direction by half of a round trip. Prints a
table of medians, as tests/SCALE.md holds it, one line for each benchmark program.
"""
from __future__ import annotations

import asyncio
import contextlib
import json
import os
import statistics
import subprocess
import sys
import threading
from collections import defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import postgres  # noqa: E402 - beside the tests

ROUND_TRIPS_MS = (5.0, 20.0)
PART_BYTES = 1 << 18


class Durable(postgres.Cluster):
    """What it has committed is on the disk."""

    settings = ("fsync=on",)


async def carry(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, delay_s: float) -> None:
    """Hands on what comes, each part so much later; the order stays."""
    clock = asyncio.get_running_loop().time
    parts: asyncio.Queue[tuple[float, bytes]] = asyncio.Queue()

    async def hand_on() -> None:
        while True:
            due, part = await parts.get()
            await asyncio.sleep(max(0.0, due - clock()))
            if not part:
                writer.close()
                return
            writer.write(part)
            await writer.drain()

    handing = asyncio.create_task(hand_on())
    part = b"begin"
    while part:
        try:
            part = await reader.read(PART_BYTES)
        except ConnectionError:
            part = b""
        parts.put_nowait((clock() + delay_s, part))
    with contextlib.suppress(ConnectionError):
        await handing


def relay(socket: Path, round_trip_ms: float) -> int:
    """A port of this machine that leads to a socket of PostgreSQL, so far away, as long as this program runs."""
    loop = asyncio.new_event_loop()
    delay_s = round_trip_ms / 2000.0

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        to_server = await asyncio.open_unix_connection(str(socket))
        await asyncio.gather(carry(reader, to_server[1], delay_s), carry(to_server[0], writer, delay_s))

    server = loop.run_until_complete(asyncio.start_server(serve, "127.0.0.1", 0))
    threading.Thread(target=loop.run_forever, daemon=True).start()
    return int(server.sockets[0].getsockname()[1])


def times(program: str, store: str, repetitions: int, only: str) -> dict[str, float]:
    """Milliseconds by what is done, the medians. `only`: a filter of the benchmark's."""
    done = subprocess.run([program, "--benchmark_format=json", f"--benchmark_repetitions={repetitions}", f"--benchmark_filter={only}"],
                          env=dict(os.environ, DRIFTLAB_BENCH_STORE=store), stdout=subprocess.PIPE, check=True)
    found: dict[str, list[float]] = defaultdict(list)
    rows: dict[str, float] = {}
    for run in json.loads(done.stdout)["benchmarks"]:
        if run["run_type"] == "iteration":
            name = run["run_name"].split("/iterations")[0]
            found[name].append(run["real_time"])
            rows[name] = run.get("rows", 0.0)
    return {f"{name} of {rows[name]:,.0f} rows" if rows[name] else name: statistics.median(values) for name, values in found.items()}


def main() -> None:
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    programs = sys.argv[2:] or ["build/release/bin/finish_bench"]
    cluster = Durable()
    store = cluster.store_of(Path("finish"))
    ways = {"socket": store}
    for round_trip_ms in ROUND_TRIPS_MS:
        port = relay(cluster.folder / f".s.PGSQL.{cluster.port}", round_trip_ms)
        ways[f"{round_trip_ms:g} ms"] = store.replace(f"host={cluster.folder}", f"host=127.0.0.1&port={port}&sslmode=disable")
    # The larger store is moved on the socket alone: what the distance adds shows in the smaller.
    found = {(program, way): times(program, uri, repetitions, ".*" if way == "socket" else "-jobs:500") for way, uri in ways.items()
             for program in programs}
    cluster.remove()
    print("| milliseconds | " + " | ".join(ways) + " |")
    print("|---" * (1 + len(ways)) + "|")
    for work in found[programs[0], "socket"]:
        for program in programs:
            print(f"| {work}, {program} | " + " | ".join(f"{found[program, way][work]:,.1f}" if work in found[program, way] else "" for way in ways) + " |")


if __name__ == "__main__":
    main()
