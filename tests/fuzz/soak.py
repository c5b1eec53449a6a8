#!/usr/bin/env python3
"""Runs every fuzz target for as much processor time, in turns, and prints how many inputs each has executed.

usage: soak.py BUILD LOG [--seconds S] [--slice S] [--only TARGET]      (default 3600 s a target, 300 s at a time)

BUILD is a build tree of the preset `fuzz` with the target `fuzz_targets`. Processor time is counted, not the clock's, so that a soak may
run beside other work at the lowest priority. Corpora grow in the build tree, as ctest's do. LOG gets a line of JSON for each slice; a soak
that was interrupted goes on from there. Ends with 1 after the first input that a target does not survive: it lies in BUILD/crashes.
"""
from __future__ import annotations

import argparse
import json
import re
import resource
import subprocess
import sys
from pathlib import Path

COMMITTED = Path(__file__).resolve().parent / "corpus"


def processor_s() -> float:
    """User and system time of all children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(build: Path, program: Path, seconds: int, seed: int) -> dict[str, object]:
    subject = program.name.removesuffix("_fuzz")
    corpora = [folder for folder in (build / "corpus" / subject, COMMITTED / subject) if folder.is_dir()]
    before = processor_s()
    # A slow machine is no hang: the clock's limits are far off.
    ended = subprocess.run(
        [program, f"-max_total_time={seconds}", "-timeout=1200", "-rss_limit_mb=2048", "-print_final_stats=1", "-verbosity=0", f"-seed={seed}",
         f"-artifact_prefix={build / 'crashes' / subject}-", *corpora], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    count = re.search(r"stat::number_of_executed_units: (\d+)", ended.stderr)
    return {"target": subject, "processor_s": round(processor_s() - before, 1), "executions": int(count[1]) if count else 0,
            "seed": seed, "exit": ended.returncode, **({"said": ended.stderr[-2000:]} if ended.returncode else {})}


def table(log: Path) -> None:
    slices = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
    print("| target | processor time | inputs executed | did not survive |\n|---|---|---|---|")
    for target in sorted({one["target"] for one in slices}):
        own = [one for one in slices if one["target"] == target]
        print(f"| {target} | {sum(one['processor_s'] for one in own) / 60:.0f} min | {sum(one['executions'] for one in own):,} "
              f"| {sum(1 for one in own if one['exit'])} |")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("log", type=Path)
    parser.add_argument("--seconds", type=float, default=3600.0)
    parser.add_argument("--slice", type=int, default=300)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    programs = sorted(path for path in (arguments.build / "bin").glob("*_fuzz") if arguments.only in path.name)
    if not programs:
        parser.error(f"no fuzz targets in {arguments.build / 'bin'}")
    arguments.log.touch()
    survived = True
    while survived:
        done = {program: 0.0 for program in programs}
        for line in arguments.log.read_text(encoding="utf-8").splitlines():
            one = json.loads(line)
            for program in programs:
                done[program] += one["processor_s"] if program.name == f"{one['target']}_fuzz" else 0.0
        least = min(programs, key=lambda program: done[program])
        if done[least] >= arguments.seconds:
            break
        seed = 1 + len(arguments.log.read_text(encoding="utf-8").splitlines())
        one = run(arguments.build, least, arguments.slice, seed)
        with arguments.log.open("a", encoding="utf-8") as log:
            log.write(json.dumps(one) + "\n")
        survived = one["exit"] == 0
    table(arguments.log)
    return 0 if survived else 1


if __name__ == "__main__":
    sys.exit(main())
