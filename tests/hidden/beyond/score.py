#!/usr/bin/env python3
"""Scores `driftlab investigate` on studies whose effects are in no registry, or in none when they were made.

    score.py --driftlab PATH [--shared DIR | --cases DIR --answers FILE] [--reports DIR] [--jobs N] [--again] [--list] [--table]

Without --cases the studies are those of challenge/beyond under DRIFTLAB_SHARED (default ../shared). Reports are kept in --reports and
made again only with --again. Standard library only.

A study with an effect is
  named     the first finding is identified and is the cause (or is one of those that the answer allows),
  hedged    the first finding is ambiguous and the cause is among its names,
  shown     something else is said: an ambiguous finding, or an entry of `unexplained`, and no other cause is identified first,
  wrong     another cause is identified first: confident, and false,
  missed    nothing is said.
`further` counts studies that are named and in which another cause is claimed besides. A study without effect raises a false alarm by
any finding that is no fact its answer allows; `doubted` counts those in which only `unexplained` says something.
"""
from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def names(finding: dict) -> list[str]:
    return [finding["cause"], *finding["alternatives"]]


def truths(answer: dict) -> list[str]:
    if answer.get("cause"):
        return [answer["cause"]]
    return [truth["cause"] for truth in answer.get("truth", [])]


def verdict(answer: dict, report: dict | None) -> tuple[str, str]:
    """The verdict, and the first thing that the report says."""
    if report is None:
        return "failed", "no report"
    allowed = set(answer.get("allowed", [])) | set(answer.get("also_true", []))
    inputs = set(answer.get("input_channels", []))
    wanted = truths(answer)
    findings = [f for f in report["findings"] if f["cause"] not in allowed or f["cause"] in wanted]
    findings = [f for f in findings if not (inputs and f["channels"] and set(f["channels"]) <= inputs)]
    doubted = bool(report["unexplained"])
    said = "; ".join("+".join(names(f)) + ("" if f["status"] == "identified" else "?") for f in findings)
    said += " [unexplained]" if doubted else ""
    if not wanted:
        return ("alarm" if findings else "doubted" if doubted else "quiet"), said
    if not findings:
        return ("shown" if doubted else "missed"), said
    first = findings[0]
    open_to = set(wanted) | set(answer.get("ambiguous_ok", []))
    if first["status"] == "identified":
        if first["cause"] not in wanted:
            return "wrong", said
        return ("further" if any(f["cause"] not in open_to for f in findings[1:]) else "named"), said
    if set(names(first)) & set(wanted):
        return "hedged", said
    return "shown", said


def investigate(binary: str, study: Path, out: Path, again: bool) -> float | None:
    if out.exists() and not again:
        return None
    start = time.monotonic()
    log = out.with_suffix(".log")
    with log.open("w") as stream:
        done = subprocess.run([binary, "investigate", str(study), "--out", str(out)], stdout=stream, stderr=stream, timeout=600, check=False)
    if done.returncode != 0:
        out.unlink(missing_ok=True)
    return time.monotonic() - start


def main() -> int:
    parser = argparse.ArgumentParser(description="Scores investigations of studies beyond the registry.")
    parser.add_argument("--driftlab", required=True)
    parser.add_argument("--shared", default=os.environ.get("DRIFTLAB_SHARED", "../shared"))
    parser.add_argument("--cases")
    parser.add_argument("--answers")
    parser.add_argument("--reports", default="beyond_reports")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    folder = Path(given.shared) / "challenge" / "beyond"
    cases = Path(given.cases) if given.cases else folder / "cases"
    answers_file = Path(given.answers) if given.answers else folder / "answers.json"
    if not answers_file.exists():
        print(f"{answers_file} is not there: set DRIFTLAB_SHARED, or give --cases and --answers. Nothing was scored.", file=sys.stderr)
        return 2
    answers = json.loads(answers_file.read_text())["cases"]
    if given.only:
        answers = {k: a for k, a in answers.items() if given.only in (k, a.get("kind"), a.get("group"), a.get("cause"))}
    reports = Path(given.reports)
    reports.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(given.jobs) as pool:
        spent = list(pool.map(lambda k: investigate(given.driftlab, cases / k / "study.json", reports / f"{k}.json", given.again), answers))
    rows: dict[tuple[str, str], list[tuple[str, str, str]]] = defaultdict(list)
    for key, answer in answers.items():
        path = reports / f"{key}.json"
        result, said = verdict(answer, json.loads(path.read_text()) if path.exists() else None)
        label = answer.get("kind") or "+".join(truths(answer))
        rows[(answer["group"].split(":")[0], label)].append((key, result, said))
    columns = ["named", "further", "hedged", "shown", "wrong", "missed", "quiet", "doubted", "alarm", "failed"]
    print("| group | studies | " + " | ".join(columns) + " | said instead |")
    print("|---|" + "---:|" * (len(columns) + 1) + "---|")

    def line(title: str, entries: list[tuple[str, str, str]], tell: bool) -> None:
        counts = [sum(e[1] == c for e in entries) for c in columns]
        odd = [e[2] for e in entries if e[1] in ("wrong", "alarm", "further", "shown", "hedged")] if tell else []
        said = "; ".join(sorted(set(odd)))[:160]
        print(f"| {title} | {len(entries)} | " + " | ".join(str(c) if c else "" for c in counts) + f" | {said} |")

    for group, label in sorted(rows):
        line(f"{group}: {label}", rows[(group, label)], True)
    for group in sorted({g for g, _ in rows}):
        line(f"**{group}**", [e for (g, _), entries in rows.items() if g == group for e in entries], False)
    if given.list:
        for (group, label), entries in sorted(rows.items()):
            for key, result, said in entries:
                print(f"  {key} {group} {label}: {result} | {said}")
    times = sorted(t for t in spent if t is not None)
    if times:
        print(f"\nseconds a study: median {times[len(times) // 2]:.1f}, longest {times[-1]:.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
