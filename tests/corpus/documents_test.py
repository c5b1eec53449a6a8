"""Every document of the corpus is what it was, to the bit.

`documents_test.py`                 compares with golden/ (the test corpus.documents; $DRIFTLAB and $DRIFTLABD name the programs)
`documents_test.py --write`         writes golden/ anew: only where a change of a figure is meant, and the commit says which and why
`documents_test.py --against DIR`   compares whole documents with those of the programs in DIR, two builds on one machine

A golden document keeps its structure; of a list of many numbers it keeps count, sum and SHA-256, of a long table head and SHA-256.
Bits depend on the C library's choice of instructions for exp, log, sin and pow. Where this machine's choice is not the one that
golden/ was written with (golden/machine.json), numbers are compared to 1e-6 of their size instead, and the test says so.
"""
from __future__ import annotations

import argparse
import difflib
import hashlib
import itertools
import json
import math
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "api"))

import corpus  # noqa: E402
import daemon  # noqa: E402

GOLDEN = Path(__file__).resolve().parent / "golden"
MANY = 12  # numbers in a list that is kept whole
HEAD = 6  # lines of a long table that are kept
TOLERANCE = 1e-6


def sha(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:24]


def machine() -> str:
    """A fingerprint of the C library's elementary functions on this processor."""
    points = [0.1 + 0.037 * i for i in range(4000)]
    values = [f(x) for x in points for f in (math.exp, math.log, math.sin, math.cos, math.tanh, math.expm1, math.log1p)] + \
             [x ** 0.37 for x in points]
    return sha(repr(values))


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def flat(value: Any) -> Iterator[float]:
    if isinstance(value, list):
        for entry in value:
            yield from flat(entry)
    else:
        yield float(value)


def only_numbers(value: Any) -> bool:
    return all(only_numbers(entry) for entry in value) if isinstance(value, list) else is_number(value)


def outline(value: Any) -> Any:
    """The document with its long lists of numbers replaced by count, sum and hash."""
    if isinstance(value, dict):
        return {key: outline(entry) for key, entry in value.items()}
    if isinstance(value, list):
        if only_numbers(value) and len(list(flat(value))) > MANY:
            return {"numbers": len(list(flat(value))), "sum": math.fsum(flat(value)), "sha256": sha(json.dumps(value))}
        return [outline(entry) for entry in value]
    return value


def digest(name: str, text: str) -> str:
    if name.endswith(".json"):
        return json.dumps(outline(json.loads(text)), indent=1) + "\n"
    lines = text.splitlines(keepends=True)
    if name.startswith("simulate") and len(lines) > 4 * HEAD:
        return "".join(lines[:HEAD]) + f"... {len(lines)} lines, sha256 {sha(text)}\n"
    return text


def near(was: Any, now: Any) -> bool:
    """Equal but for the last digits; hashes of numbers are let be."""
    if isinstance(was, dict) and isinstance(now, dict):
        return list(was) == list(now) and all(near(was[k], now[k]) for k in was if not (k == "sha256" and "numbers" in was))
    if isinstance(was, list) and isinstance(now, list):
        return len(was) == len(now) and all(near(a, b) for a, b in zip(was, now))
    if is_number(was) and is_number(now):
        return math.isclose(was, now, rel_tol=TOLERANCE, abs_tol=1e-12)
    return bool(was == now)


def difference(name: str, was: str, now: str) -> str:
    lines = difflib.unified_diff(was.splitlines(), now.splitlines(), "golden/" + name, "now", lineterm="", n=2)
    return "\n".join(itertools.islice(lines, 40))


def documents(programs: Path | None = None) -> Iterator[tuple[str, str]]:
    driftlab = str(programs / "driftlab") if programs else os.environ["DRIFTLAB"]
    driftlabd = str(programs / "driftlabd") if programs else os.environ["DRIFTLABD"]
    return corpus.documents(driftlab, lambda: daemon.Daemon(arguments=("--workers", "1"), program=driftlabd))


def write() -> int:
    GOLDEN.mkdir(exist_ok=True)
    for old in GOLDEN.iterdir():
        old.unlink()
    (GOLDEN / "machine.json").write_text(json.dumps({"elementary_functions": machine()}) + "\n")
    for name, text in documents():
        (GOLDEN / name).write_bytes(digest(name, text).encode())
    return 0


def compare(pairs: Iterator[tuple[str, str, str]], exact: bool) -> int:
    changed = count = 0
    for name, was, now in pairs:
        count += 1
        same = was == now
        if not same and not exact and name.endswith(".json"):
            same = near(json.loads(was), json.loads(now))
        if not same:
            changed += 1
            print(difference(name, was, now))
    print(f"{count - changed} of {count} documents are what they were" + ("" if exact else f", to {TOLERANCE:g}"))
    return 1 if changed or not count else 0


def against_golden() -> int:
    known = json.loads((GOLDEN / "machine.json").read_text())["elementary_functions"]
    exact = known == machine()
    if not exact:
        print("THIS MACHINE computes elementary functions with other instructions than golden/ was written with: to 1e-6, not to the bit")
    names = {path.name for path in GOLDEN.iterdir()} - {"machine.json"}

    def pairs() -> Iterator[tuple[str, str, str]]:
        for name, text in documents():
            names.discard(name)
            golden = GOLDEN / name
            yield name, golden.read_bytes().decode() if golden.exists() else "", digest(name, text)

    result = compare(pairs(), exact)
    for name in sorted(names):
        print(f"golden/{name} is no longer made")
    return 1 if names else result


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--against", type=Path, metavar="DIR")
    wanted = parser.parse_args()
    if wanted.write:
        return write()
    if wanted.against:
        before = dict(documents(wanted.against))
        return compare(((name, before.get(name, ""), text) for name, text in documents()), exact=True)
    return against_golden()


if __name__ == "__main__":
    sys.exit(main())
