#!/usr/bin/env python3
"""Puts sections written by the long suites into a page, tests/ACCURACY.md unless another is named.

Usage: page.py FOLDER [PAGE]

Each FOLDER/<name>.md is one or more sections, a `## ` heading each. A section takes the place of the one with the same
heading in the page; a new one goes to the end. Everything else on the page stays. Exit: 0 done, 1 no section found,
2 bad usage.
"""
import pathlib
import re
import sys

PAGE = pathlib.Path(__file__).resolve().parent.parent / "ACCURACY.md"


def sections(text: str) -> list[str]:
    """The text cut before each heading of the second level; the first piece is what stands before them all."""
    return re.split(r"(?m)^(?=## )", text)


def heading(section: str) -> str:
    return section.split("\n", 1)[0].strip()


def main(arguments: list[str]) -> int:
    if len(arguments) not in (1, 2) or not pathlib.Path(arguments[0]).is_dir():
        print(__doc__, file=sys.stderr)
        return 2
    target = pathlib.Path(arguments[1]) if len(arguments) == 2 else PAGE
    preamble, *old = sections(target.read_text(encoding="utf-8"))
    page = {heading(section): section for section in old}
    fresh = []
    for path in sorted(pathlib.Path(arguments[0]).glob("*.md")):
        for section in sections(path.read_text(encoding="utf-8"))[1:]:
            page[heading(section)] = section
            fresh.append(heading(section))
    if not fresh:
        print(f"page.py: no section in {arguments[0]}", file=sys.stderr)
        return 1
    body = [preamble.rstrip()] + [section.strip() for section in page.values()]
    target.write_text("\n\n".join(body) + "\n", encoding="utf-8")
    print("\n".join(fresh))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
