#!/usr/bin/env python3
"""Fails where warnings stop being errors: the options that every target links name -Wall, -Wextra and -Werror, and
nothing in the build files takes -Werror back.
"""
from __future__ import annotations

import re
from pathlib import Path

import tree

WANTED = ("-Wall", "-Wextra", "-Werror")
COMMENT = re.compile(r"#.*")
OPTIONS = re.compile(r"target_compile_options\(driftlab_options INTERFACE\s([^)]*)\)")
TAKEN_BACK = re.compile(r"-Wno-error\b|(?<=\s)-w(?=[\s)\"])")


def check(root: Path) -> list[str]:
    main = root / "CMakeLists.txt"
    if not main.is_file():
        return ["CMakeLists.txt: is missing"]
    options = " ".join(OPTIONS.findall(COMMENT.sub("", main.read_text())))
    faults = [f"CMakeLists.txt: driftlab_options has no {flag}" for flag in WANTED if flag not in options.split()]
    for path in tree.files(root):
        if path.name not in {"CMakeLists.txt", "CMakePresets.json"} and path.suffix != ".cmake":
            continue
        for number, line in enumerate(path.read_text().split("\n"), 1):
            if TAKEN_BACK.search(COMMENT.sub("", line)):
                faults.append(f"{path.relative_to(root).as_posix()}:{number}: takes warnings as errors back")
    return faults


if __name__ == "__main__":
    tree.main(check)
