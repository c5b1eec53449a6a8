#!/usr/bin/env python3
"""Runs every fuzz target for as much processor time, in turns, and prints how many inputs each has executed.

usage: soak.py BUILD LOG [--seconds S] [--slice S] [--only TARGET,…] [--jobs N]      (default 3600 s a target, 300 s at a time, one at once)

BUILD is a build tree of the preset `fuzz` with the target `fuzz_targets`. Processor time is counted, not the clock's, so that a soak may
run beside other work at the lowest priority. Corpora grow in the build tree, as ctest's do. LOG gets a line of JSON for each slice; a soak
that was interrupted goes on from there. Ends with 1 after the first input that a target does not survive: it lies in BUILD/crashes.
"""
from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from pathlib import Path

COMMITTED = Path(__file__).resolve().parent / "corpus"


def run(build: Path, program: Path, seconds: int, seed: int) -> dict[str, object]:
    subject = program.name.removesuffix("_fuzz")
    corpora = [folder for folder in (build / "corpus" / subject, COMMITTED / subject) if folder.is_dir()]
    with tempfile.TemporaryFile() as said:
        # A slow machine is no hang: the clock's limits are far off.
        started = subprocess.Popen(
            [program, f"-max_total_time={seconds}", "-timeout=1200", "-rss_limit_mb=2048", "-print_final_stats=1", "-verbosity=0", f"-seed={seed}",
             f"-artifact_prefix={build / 'crashes' / subject}-", *corpora], stdout=subprocess.DEVNULL, stderr=said)
        # The processor time of this child alone, whatever runs beside it.
        _, status, used = os.wait4(started.pid, 0)
        started.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = said.read().decode("utf-8", "replace")
    count = re.search(r"stat::number_of_executed_units: (\d+)", text)
    return {"target": subject, "processor_s": round(used.ru_utime + used.ru_stime, 1), "executions": int(count[1]) if count else 0,
            "seed": seed, "exit": started.returncode, **({"said": text[-2000:]} if started.returncode else {})}


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
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    only = [part for part in arguments.only.split(",") if part] or [""]
    programs = sorted(path for path in (arguments.build / "bin").glob("*_fuzz") if any(part in path.name for part in only))
    if not programs:
        parser.error(f"no fuzz targets in {arguments.build / 'bin'}")
    arguments.log.touch()
    log = [json.loads(line) for line in arguments.log.read_text(encoding="utf-8").splitlines()]
    done: dict[Path, float] = {program: sum(one["processor_s"] for one in log if f"{one['target']}_fuzz" == program.name) for program in programs}
    seed = len(log)
    survived = True
    running: dict[Future[dict[str, object]], Path] = {}
    with ThreadPoolExecutor(arguments.jobs) as pool:
        while True:
            free = [program for program in programs if program not in running.values() and done[program] < arguments.seconds]
            if survived and free and len(running) < arguments.jobs:
                seed += 1
                least = min(free, key=lambda program: done[program])
                running[pool.submit(run, arguments.build, least, arguments.slice, seed)] = least
                continue
            if not running:
                break
            ended, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in ended:
                one = future.result()
                done[running.pop(future)] += float(str(one["processor_s"]))
                with arguments.log.open("a", encoding="utf-8") as written:
                    written.write(json.dumps(one) + "\n")
                survived = survived and one["exit"] == 0
    table(arguments.log)
    return 0 if survived else 1


if __name__ == "__main__":
    sys.exit(main())
