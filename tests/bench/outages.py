#!/usr/bin/env python3
"""Rewrites the tables of tests/bench/outages.md from the program: ./tests/bench/outages.py [--runs 400] [--seed 1]

Each stands between `<!-- SCENARIO -->` and `<!-- end -->`. The program is $DRIFTLAB_BIN/driftlab (default build/release/bin)."""
from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE = REPOSITORY / "tests/bench/outages.md"


def evaluated(scenario: str, runs: int, seed: int) -> dict[str, Any]:
    program = Path(os.environ.get("DRIFTLAB_BIN") or REPOSITORY / "build/release/bin") / "driftlab"
    words = [str(program), "outages", "--scenario", scenario, "--runs", str(runs), "--seed", str(seed), "--json"]
    started = time.monotonic()
    printed = subprocess.run(words, stdout=subprocess.PIPE, check=True).stdout
    print(f"{scenario}: {runs} runs in {time.monotonic() - started:.0f} s", file=sys.stderr)
    return dict(json.loads(printed))


def table(result: dict[str, Any]) -> str:
    lines = [f"{result['runs']} runs, seed {result['seed']}.", "",
             "| filter | states | mean error [m] | outages 1 to 4 [m] | NEES | in 50 % | in 95 % | heading [deg] | tilt [deg] |",
             "|---|---|---|---|---|---|---|---|---|"]
    for each in result["filters"]:
        mean = each["mean_error_m"]
        outages = ", ".join(f"{outage['error_m']['value']:.2f}" for outage in each["outages"])
        lines.append(f"| {each['name']} | {each['states']} | {mean['value']:.2f} [{mean['ci95'][0]:.2f}, {mean['ci95'][1]:.2f}] | {outages} "
                     f"| {each['nees']:.2f} | {each['coverage50']:.2f} | {each['coverage95']:.2f} "
                     f"| {each['heading_rms_deg']:.2f} | {each['tilt_rms_deg']:.2f} |")
    lines.append("")
    for claim in result["claims"]:
        lines.append(f"- {'Supported' if claim['supported'] else 'Not supported'}: {claim['claim']} *{claim['because']}*")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    flags = parser.parse_args()
    page = PAGE.read_text(encoding="utf-8")
    for scenario in re.findall(r"<!-- ([a-z-]+) -->", page):
        if scenario != "end":
            shown = table(evaluated(scenario, flags.runs, flags.seed))
            page = re.sub(rf"<!-- {scenario} -->\n.*?<!-- end -->",
                          lambda _, text=shown, name=scenario: f"<!-- {name} -->\n{text}\n<!-- end -->", page, count=1, flags=re.DOTALL)
            PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
