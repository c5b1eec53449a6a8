#!/usr/bin/env python3
"""Fails where a constant taken from recordings has no program that measures it again.

Such constants stand in a header named measured_constants.hpp. It names its program with a command; the program names each of them,
by which a reader finds the measurement.
"""
from __future__ import annotations

import re
from pathlib import Path

import tree

NAME = "measured_constants.hpp"
CONSTANT = re.compile(r"^inline constexpr [\w:]+ (k\w+)", re.MULTILINE)
COMMAND = re.compile(r"^///\s+python3 (tests/\S+\.py)", re.MULTILINE)


def check(root: Path) -> list[str]:
    headers = [path for path in tree.files(root) if path.name == NAME]
    faults = [] if headers else [f"no {NAME} under {root}"]
    for header in headers:
        place = header.relative_to(root).as_posix()
        text = header.read_text()
        programs = {name: root / name for name in COMMAND.findall(text)}
        faults += [f"{place}: there is no {name}" for name, path in programs.items() if not path.is_file()]
        # One that prepares the recordings does not name the header.
        said = {name: path.read_text() for name, path in programs.items() if path.is_file() and place in path.read_text()}
        if not said:
            faults.append(f"{place}: no command in it runs a program that names it")
            continue
        constants = CONSTANT.findall(text)
        if not constants:
            faults.append(f"{place}: holds no constant")
        faults += [f"{place}: {', '.join(said)} does not measure {constant}" for constant in constants
                   if not any(re.search(rf"\b{constant}\b", program) for program in said.values())]
    return faults


if __name__ == "__main__":
    tree.main(check)
