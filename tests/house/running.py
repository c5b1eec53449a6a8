"""What runs an analysis, collected from the headers of core: a document tells results, it does not come by them.

Whoever runs one reads recordings, may be stopped while it works, or may fail to come to a result. A function that tells a result in
other words does none of these: it takes the result, and returns the words. One that checks what was asked returns a Status alone.
"""
from __future__ import annotations

import re
from pathlib import Path

import computing

# What only somebody who runs an analysis holds: recordings to read, and the control of a run.
HELD = re.compile(r"\b(RecordingSource|DriveSource|RecordingView|ColumnFile|RunControl|stop_token)\b")
ASKED = re.compile(r"\b\w+Request\b")  # a use case takes what was asked
MAY_FAIL = re.compile(r"Result<.*>")
# These run on values in memory, and do not fail.
SILENT = {"compare_devices", "check_drive"}
USE_CASE = re.compile(r"#pragma once\n/// The use case ")
TELLING = {"core/analysis/stored_channel.hpp"}  # a use case of documents: what a stored result says

# A function of its own at the start of a line, for clang-format indents members alone; with what it returns.
DECLARED = re.compile(r"^(?P<indent>  )?(?:\[\[nodiscard\]\]\s+|virtual\s+|static\s+|explicit\s+|constexpr\s+|inline\s+)*"
                      r"(?P<returned>(?!return\b|using\b|friend\b|struct\b|class\b)[A-Za-z][\w:<>,&* ]*?)\s*(?<=[\w>&*\s])(?P<name>[a-z]\w*)\(", re.MULTILINE)


def declared_in(header: str) -> list[tuple[str, str, str, bool]]:
    """Name, what is returned, what is taken, and whether it is a member, of each function that a header declares."""
    code = re.sub(r"^[ \t]*#.*$", "", computing.code_of(header), flags=re.MULTILINE)
    return [(match["name"], match["returned"].strip(), computing.right_of(code, match.end() - 1), bool(match["indent"]))
            for match in DECLARED.finditer(code) if match["returned"].strip()]


def runners(root: Path) -> tuple[set[str], set[str], list[str]]:
    """Functions that run an analysis, and members that do, by the headers of core; of a use case's header also what may fail. Then
    the headers that say of themselves to be a use case, of which none was found.
    """
    functions: set[str] = set()
    members: set[str] = set()
    empty: list[str] = []
    for path in sorted((root / "core").rglob("*.hpp")):
        of_use_case = path.parent.name == "analysis"
        text = path.read_text()
        before = len(functions)
        for name, returned, taken, member in declared_in(text):
            may_fail = bool(MAY_FAIL.fullmatch(returned))
            if not member and (HELD.search(taken) or name in SILENT or (of_use_case and (may_fail or ASKED.search(taken)))):
                functions.add(name)
            elif member and of_use_case and may_fail:
                members.add(name)
        if USE_CASE.match(text) and len(functions) == before and path.relative_to(root).as_posix() not in TELLING:
            empty.append(path.relative_to(root).as_posix())
    return functions, members, empty


def run_in(code: str, functions: set[str], members: set[str]) -> list[tuple[int, str]]:
    """Where code without comments runs an analysis, or holds what a run holds. A name that the file gives to its own is its own."""
    own = {match.group(2) for match in re.finditer(r"([\w>&*]+)\s+(\w+)\(", code) if match.group(1) not in ("return", "else", "co_return")}
    found = [(match.start(), match.group(0)) for match in HELD.finditer(code)]
    for match in re.finditer(r"(\.|->)?\b(\w+)\(", code):
        if match.group(2) in (members if match.group(1) else functions) - own:
            found.append((match.start(2), match.group(2)))
    return found
