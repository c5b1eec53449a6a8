#!/usr/bin/env python3
"""Fails where code knows a cause of an investigation or of a drive by name.

A cause is one file of core/investigate/causes/, or of core/navigate/drive/causes/ for one that a drive shows, and one line of
the registry there: the search, the report, documents, server and clients work from what it declares. Its name may stand in its
own file, among the `rivals` of another cause, in the registry, in tests and in documentation. A name that is also a registered
process's (core/process) may stand where processes are spoken of, but not where a cause is compared, looked up or written down. So
may the check of a regression run of that name, which compares facts of files and knows no causes: in core/campaign/regression, and
in the Python client's types, which are made from the contract (ELSEWHERE).
"""
from __future__ import annotations

import re
from pathlib import Path

import tree

FOLDERS = ("core/investigate/causes", "core/navigate/drive/causes")
ELSEWHERE = ("core/campaign/regression/", "clients/python/driftlab/contract.py")
LITERAL = re.compile(r'"((?:\\.|[^"\\\n])*)"')
# TypeScript and Python have other quotes too; a character of C++ holds no name.
ANY_LITERAL = re.compile(r"""(?P<quote>["'`])((?:\\.|(?!(?P=quote))[^\\\n])*)(?P=quote)""")
COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
RIVALS = re.compile(r"\.rivals\s*=\s*\{[^}]*\}")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[^\n]*', re.MULTILINE)
WORD = re.compile(r"\b(\w+)\b(?=(\.?)([\w${]?))")
LINE = re.compile(r"\bCAUSE\((\w+)\)")
NAME = re.compile(r'\.name\s*=\s*"(\w+)"')
PROCESS = re.compile(r'\bkName\s*=\s*"(\w+)"')
SUFFIXES = {".cpp", ".hpp", ".h", ".ts", ".tsx", ".js", ".py"}
TOPS = {"core", "schema", "server", "clients"}


def without_comments(text: str) -> str:
    """The text with comments blanked out, literals and line breaks kept."""
    return COMMENT.sub(lambda m: m.group(0) if m.group(0)[0] == '"' else re.sub(r"[^\n]", " ", m.group(0)), text)


def blank(pattern: re.Pattern[str], text: str) -> str:
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)


def speaks_of_causes(text: str, start: int, end: int) -> bool:
    """The literal text[start:end] is a cause's name: its own statement, as far as it reaches, says so."""
    before = re.split(r"[;{}]\s*\n", text[:start])[-1]
    after = re.split(r"[;\n]", text[end:], maxsplit=1)[0]
    return re.search(r"cause", before[-160:] + after, re.IGNORECASE) is not None


def said_in(literal: str, causes: dict[str, str]) -> set[str]:
    """The causes a literal is the name of, or holds: "bias_step" in "bias_step.t0_s". A name of one word is a word of sentences too:
    there it is the cause's where a member follows its dot, as in "resonance.f_hz", or will be joined to it, as in "resonance."."""
    return {name for name, dot, member in WORD.findall(literal)
            if name in causes and ("_" in name or member or literal == name + dot)}


def check(root: Path) -> list[str]:
    paths = [path for path in tree.files(root) if path.suffix in SUFFIXES]
    texts = {path.relative_to(root).as_posix(): path.read_text() for path in paths}
    causes: dict[str, str] = {}
    for name, text in texts.items():
        if name.startswith(tuple(f"{folder}/" for folder in FOLDERS)):
            causes.update({cause: name for cause in NAME.findall(without_comments(text))})
    empty = [folder for folder in FOLDERS if not any(name.startswith(f"{folder}/") for name in causes.values())]
    if empty:
        return [f"no causes under {root / folder}" for folder in empty]
    processes = {p for name, text in texts.items() if name.startswith("core/process/") for p in PROCESS.findall(text)}
    faults: list[str] = []
    for cause, name in causes.items():
        folder = Path(name).parent.as_posix()
        registry = f"{folder}/registry.cpp"
        listed = LINE.findall(texts.get(registry, "")).count(cause)
        if Path(name).stem != cause:
            faults.append(f"{name}: the cause {cause} belongs in a file of its own, {folder}/{cause}.cpp")
        if listed != 1:
            faults.append(f"{registry}: the cause {cause} has {listed} lines; it needs one")
    for name, text in texts.items():
        if name.split("/")[0] not in TOPS:
            continue
        code = without_comments(text)
        if name.startswith(tuple(f"{folder}/" for folder in FOLDERS)):
            code = blank(RIVALS, code)
        code = blank(INCLUDE, code)
        literal = LITERAL if name.endswith((".cpp", ".hpp", ".h")) else ANY_LITERAL
        for match in literal.finditer(code):
            for said in sorted(said_in(match.group(match.lastindex or 0), causes)):
                if causes[said] == name:
                    continue
                if (said in processes or name.startswith(ELSEWHERE)) and not speaks_of_causes(code, *match.span()):
                    continue
                line = code.count("\n", 0, match.start()) + 1
                faults.append(f'{name}:{line}: knows the cause "{said}" by name; let {causes[said]} declare what is special about it')
    return faults


if __name__ == "__main__":
    tree.main(check)
