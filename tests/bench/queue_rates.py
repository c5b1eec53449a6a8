#!/usr/bin/env python3
"""Jobs a second through the queue alone: asked for, and claimed and finished, at 1, 8 and 64 connections.

usage: queue_rates.py [BENCHMARK [REPETITIONS]]      (default build/release/bin/queue_bench 3)

Runs tests/bench/queue_bench.cpp on a PostgreSQL that it starts, whose commits reach the disk (fsync, synchronous_commit), and on
SQLite at one connection. Prints a table of medians, as tests/SCALE.md holds it.
"""
from __future__ import annotations

import json
import os
import re
import statistics
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import postgres  # noqa: E402 - beside the tests

CONNECTIONS = (1, 8, 64)


class Durable(postgres.Cluster):
    """What it has committed is on the disk."""

    settings = ("fsync=on", "max_connections=800")


def rates(program: str, repetitions: int, only: str, store: str | None) -> dict[tuple[str, int], float]:
    """Jobs a second by what is done and the connections; the median of the repetitions."""
    settings = {name: value for name, value in os.environ.items() if name != "DRIFTLAB_BENCH_STORE"}
    if store is not None:
        settings["DRIFTLAB_BENCH_STORE"] = store
    done = subprocess.run([program, "--benchmark_format=json", f"--benchmark_filter={only}", f"--benchmark_repetitions={repetitions}"],
                          env=settings, stdout=subprocess.PIPE, check=True)
    found: dict[tuple[str, int], list[float]] = defaultdict(list)
    for run in json.loads(done.stdout)["benchmarks"]:
        if run["run_type"] != "iteration":
            continue
        if run.get("error_occurred"):
            sys.exit(f"{run['name']}: {run['error_message']}")
        found[re.sub(r"/(iterations|real_time|threads).*", "", run["run_name"]), run["threads"]].append(run["items_per_second"])
    return {key: statistics.median(values) for key, values in found.items()}


def name_of(work: str) -> str:
    """`ClaimAndFinish/waiting:100/tokens:1` as a person says it."""
    if work == "Enqueue":
        return "asked for"
    parts = dict(part.split(":") for part in work.split("/")[1:])
    return f"claimed and finished, {int(parts['waiting']):,} more wait" + (", asked for by 8 tokens" if parts["tokens"] == "1" else "")


def main() -> None:
    program = sys.argv[1] if len(sys.argv) > 1 else "build/release/bin/queue_bench"
    repetitions = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    server = Durable()
    postgresql = rates(program, repetitions, ".", server.store_of(Path("queue")))
    server.remove()
    sqlite = rates(program, repetitions, "threads:1$", None)
    print("| jobs a second | SQLite, 1 | " + " | ".join(f"PostgreSQL, {n}" for n in CONNECTIONS) + " |")
    print("|---" * (2 + len(CONNECTIONS)) + "|")
    for work in dict.fromkeys(work for work, _ in postgresql):
        figures = [sqlite.get((work, 1), 0.0), *(postgresql[work, n] for n in CONNECTIONS)]
        print(f"| {name_of(work)} | " + " | ".join(f"{figure:,.0f}" if figure >= 10 else f"{figure:.1f}" for figure in figures) + " |")


if __name__ == "__main__":
    main()
