#!/usr/bin/env python3
"""Fails where the documentation speaks of something that is not there.

- A script named in a command block of README.md, CONTRIBUTING.md or schema/docs exists and is executable.
- A --flag given to a script or a driftlab program in such a block stands in its --help. The programs are asked where
  their folder is given in $DRIFTLAB_BIN.
- Every flag of driftlabd and of its subcommands stands in schema/docs/operations.md or security.md, those of driftlab in cli.md.
- A path in `backticks` that begins with a top-level folder exists; <name> and * stand for anything.
- A link between the pages leads somewhere.
- The page of jobs offers the kinds that the server has, and the server knows for each where its results are read.
"""
from __future__ import annotations

import os
import re
import shlex
import subprocess
from functools import cache
from pathlib import Path

import tree

BLOCK = re.compile(r"^```(?:sh|bash|console)\n(.*?)^```", re.MULTILINE | re.DOTALL)
TOPS = ("core", "schema", "server", "clients", "migrations", "tests", "deploy", ".ci")
KINDS = "server/jobs/job_kinds.cpp"
KIND = re.compile(r"^ +KIND\(make_(\w+)_kind\)", re.MULTILINE)
# Who lists the kinds of job besides the registry: the file, its list, and a name within it.
LISTS_OF_KINDS = (("clients/dashboard/src/pages/Jobs.tsx", re.compile(r"^const KINDS = \[(.*?)\];", re.MULTILINE | re.DOTALL), re.compile(r"'(\w+)'")),
                  ("server/api/documents.cpp", re.compile(r"\bkResultPlaces = .*?\(\{\n(.*?)\n\}\);", re.DOTALL), re.compile(r'^ +\{"(\w+)"', re.MULTILINE)))
LINK = re.compile(r"\]\((?!https?:|#|mailto:)([^)#\s]+)")


def pages(root: Path) -> list[Path]:
    named = [root / "README.md", root / "CONTRIBUTING.md"]
    return [p for p in named if p.is_file()] + sorted((root / "schema/docs").rglob("*.md"))


def commands_of(text: str) -> list[list[str]]:
    """Every simple command of the command blocks, as words; comments, prompts and continuation lines resolved."""
    commands: list[list[str]] = []
    for block in BLOCK.findall(text):
        for line in block.replace("\\\n", " ").split("\n"):
            try:
                words = shlex.split(line.removeprefix("$ "), comments=True)
            except ValueError:
                continue  # a line of a here-document or of JSON
            for part in " ".join(w if w in {"|", "&&", ";"} else shlex.quote(w) for w in words).replace("&&", "|").split("|"):
                command = [w for w in shlex.split(part) if w != ";"]
                while command and re.fullmatch(r"\w+=.*", command[0]):
                    command.pop(0)
                if command:
                    commands.append(command)
    return commands


@cache
def help_of(program: Path, *subcommands: str) -> str:
    words = [str(program), *subcommands, "--help"]
    shown = subprocess.run(words, capture_output=True, text=True, timeout=30, check=False)
    return shown.stdout + shown.stderr


def command_faults(root: Path, page: str, command: list[str], programs: Path | None) -> list[str]:
    name = command[0]
    if name in {"driftlab", "driftlabd"} or name.endswith(("/bin/driftlab", "/bin/driftlabd")):
        if programs is None:
            return []
        program = programs / Path(name).name
    elif name.startswith(("./", "deploy/", "tests/", ".ci/")):
        program = root / name
        if not program.is_file():
            return [f"{page}: the command {name} does not exist"]
        if not os.access(program, os.X_OK):
            return [f"{page}: the command {name} is not executable"]
    else:
        return []
    flags = {word.split("=")[0] for word in command[1:] if re.match(r"--[a-z]", word)}
    shown = help_of_command(program, command[1:]) if flags else ""
    return [f"{page}: {' '.join(command[:2])} has no {flag} in its --help" for flag in sorted(flags)
            if not re.search(re.escape(flag) + r"(?![\w-])", shown)]


def help_of_command(program: Path, words: list[str]) -> str:
    """The help of the program and of each subcommand that the words go down to; a script has none."""
    shown = help_of(program)
    path: list[str] = []
    while words and words[0] in subcommands_of(program, *path):
        path.append(words.pop(0))
        shown += help_of(program, *path)
    return shown


def path_faults(root: Path, page: Path, text: str) -> list[str]:
    name = page.relative_to(root).as_posix()
    prose = BLOCK.sub("", text)
    faults = []
    for quoted in re.findall(r"`([^`\s]+)`", prose):
        path = quoted.rstrip("/.,")
        if path.split("/")[0] not in TOPS or "/" not in path:
            continue
        pattern = re.sub(r"<[^>]+>|NNNN", "*", path)
        if not list(root.glob(pattern)):
            faults.append(f"{name}: `{quoted}` does not exist")
    for target in LINK.findall(prose):
        where = root / target.lstrip("/") if target.startswith("/") else page.parent / target
        if not where.exists():
            faults.append(f"{name}: the link to {target} leads nowhere")
    return faults


def subcommands_of(program: Path, *path: str) -> list[str]:
    listed = help_of(program, *path).split("Subcommands:")
    return re.findall(r"^  ([a-z][\w-]*)", listed[1], re.MULTILINE) if len(listed) == 2 else []


def undocumented(root: Path, programs: Path) -> list[str]:
    faults = []
    for program, pages_of in (("driftlabd", ("operations.md", "security.md")), ("driftlab", ("cli.md",))):
        page = pages_of[0]
        text = "".join((root / "schema/docs" / name).read_text() for name in pages_of if (root / "schema/docs" / name).is_file())
        commands: list[tuple[str, ...]] = [()]
        for path in commands:  # grows while it is walked
            commands += [(*path, name) for name in subcommands_of(programs / program, *path)]
        for path in commands:
            subcommand = " ".join(path)
            shown = help_of(programs / program, *path)
            for flag in sorted(set(re.findall(r"(?<![\w-])--[a-z][\w-]+", shown)) - {"--help", "--version"}):
                if not re.search(re.escape(flag) + r"(?![\w-])", text):
                    faults.append(f"schema/docs/{page}: does not tell of {flag} ({program} {subcommand})".replace(" )", ")"))
            if subcommand and subcommand not in text:
                faults.append(f"schema/docs/{page}: does not tell of {program} {subcommand}")
    return faults


def job_kind_faults(root: Path) -> list[str]:
    """Other lists of the kinds of job that are not the registry's. A tree without the registry has none."""
    if not (root / KINDS).is_file():
        return []
    kinds = set(KIND.findall((root / KINDS).read_text()))
    if not kinds:
        return [f"{KINDS}: no line of the registry is understood"]
    faults = []
    for name, listing, item in LISTS_OF_KINDS:
        found = listing.search((root / name).read_text())
        said = set(item.findall(found.group(1))) if found else set()
        faults += [f"{name}: does not know the job kind {kind} of {KINDS}" for kind in sorted(kinds - said)]
        faults += [f"{name}: knows a job kind {kind}, which {KINDS} does not have" for kind in sorted(said - kinds)]
    return faults


def check(root: Path) -> list[str]:
    given = os.environ.get("DRIFTLAB_BIN")
    programs = Path(given).resolve() if given else None
    if programs is None:
        print("SKIPPED: flags of driftlab and driftlabd, for DRIFTLAB_BIN does not say where they are")
    faults: list[str] = undocumented(root, programs) if programs and (root / "schema/docs").is_dir() else []
    faults += job_kind_faults(root)
    readme = root / "README.md"
    if not readme.is_file():
        faults.append("README.md: is missing")
    else:
        first = [c[0] for c in commands_of(readme.read_text())][:2]
        if first != ["./deploy/quickstart.sh", "./tests/run.sh"]:
            faults.append("README.md: does not open with the two commands")
    for page in pages(root):
        text = page.read_text()
        for command in commands_of(text):
            faults += command_faults(root, page.relative_to(root).as_posix(), command, programs)
        faults += path_faults(root, page, text)
    return faults


if __name__ == "__main__":
    tree.main(check)
