"""The table of tests/SCALE.md from the lines that hosts_test.py wrote: `python3 tests/crash/hosts_table.py LOG`."""
from __future__ import annotations

import json
import statistics
import sys
from collections import defaultdict
from pathlib import Path


def main(log: Path) -> None:
    told = [json.loads(line) for line in log.read_text().splitlines()]
    judged = [line for line in told if "judged" in line]
    ended = {seed for line in judged for seed in range(line["judged"], line["judged"] + line["rounds"])}
    events: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for line in told:
        if "fault" in line and line["seed"] in ended:
            events[line["fault"]].append((line["recovered_s"], line["rate_before"]))
    print("| fault | events | recovery, median | longest | results a second before |\n|---|---|---|---|---|")
    for fault, seen in sorted(events.items()):
        recovered, before = [first for first, _ in seen], [second for _, second in seen]
        print(f"| {fault} | {len(seen)} | {statistics.median(recovered):.1f} s | {max(recovered):.1f} s | {min(before)} to {max(before)} |")
    count = {name: sum(line[name] for line in judged) for name in ("rounds", "recordings", "jobs")}
    print(f"\n{count['rounds']} rounds were judged: {count['recordings']} recordings and {count['jobs']} jobs that were acknowledged.")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
