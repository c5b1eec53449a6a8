#!/usr/bin/env python3
"""clang-tidy over every source of the project, warnings as errors; a source that was clean is not looked at again.

Usage: tidy.py BUILD [SOURCE...] [--jobs N] [--all]    BUILD holds compile_commands.json of the preset `tidy`.

What clang-tidy says of a source depends on its text and that of what it includes, on its flags, on the .clang-tidy files above it
and on the installed packages. Their hash is kept in BUILD/tidy-clean when the source was clean, so that a second run costs nothing
for it. --all forgets those hashes.

Nearly all of clang-tidy's time goes into the system headers of a source, so sources of the same flags are put together into one
text, a unit, and pay for them once. Sources that do not compile together (equal names in their unnamed namespaces) part ways.
Exit: 0 clean, 1 something to mend (the diagnostics are printed).
"""

import argparse
import bisect
import concurrent.futures
import functools
import hashlib
import itertools
import json
import pathlib
import queue
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIDY = "clang-tidy-19"
UNIT = 16  # sources of a unit: more would pay headers less often, and clash more often
SLICE = 4 * UNIT
# Steps that the static analyzer takes in one function, as in its shallow mode. Of its own 225,000 it takes 57 s for 12 sources of
# core/analysis, of these 23 s; every other check together takes 31 s.
NODES = ("-Xclang", "-analyzer-config", "-Xclang", "max-nodes=75000")
OURS = ("core", "schema", "server", "clients", "tests")


def entries(build):
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if source.suffix == ".cpp" and source.is_relative_to(ROOT) and source.relative_to(ROOT).parts[0] in OURS:
            yield source, entry


def settings_above(source):
    for folder in source.parents:
        if (folder / ".clang-tidy").exists():
            yield (folder / ".clang-tidy").read_bytes()
        if folder == ROOT:
            return


@functools.cache
def included(path, build):
    """Files of the project that a file includes, directly."""
    found = []
    for name in re.findall(r'^\s*#\s*include "([^"]+)"', path.read_text(errors="replace"), flags=re.M):
        for folder in (ROOT, build / "generated", path.parent):
            if (folder / name).is_file():
                found.append(folder / name)
                break
    return found


def fingerprint(source, entry, build, version):
    """Hash of everything clang-tidy's verdict depends on: the source, what it includes, its flags, settings, installed packages."""
    seen, todo = set(), [source]
    while todo:
        path = todo.pop()
        if path not in seen:
            seen.add(path)
            todo += included(path, build)
    digest = hashlib.sha256(version + " ".join(flags_of(entry)).encode())
    for path in sorted(seen):
        digest.update(path.read_bytes())
    for settings in settings_above(source):
        digest.update(settings)
    return digest.hexdigest()


def flags_of(entry):
    """Compiler and flags of an entry, without its source and output."""
    command = shlex.split(entry["command"])
    output = command.index("-o")
    del command[output:output + 2]
    command.remove("-c")
    return [word for word in command if word != entry["file"]]


class Unit:
    """Sources in one text: knows which source and line a line of it is."""

    def __init__(self, path, sources):
        self.path, self.sources, self.starts = path, sources, []
        lines = []
        for source in sources:
            self.starts.append(len(lines))
            lines += source.read_text().splitlines()
        path.write_text("\n".join(lines) + "\n")

    def place(self, line):
        index = bisect.bisect_right(self.starts, line - 1) - 1
        return self.sources[index], line - self.starts[index]

    def mapped(self, text):
        """Diagnostics with the unit's lines replaced by those of its sources."""
        def there(match):
            source, line = self.place(int(match[1]))
            return f"{source}:{line}:"
        return re.sub(re.escape(str(self.path)) + r":(\d+):", there, text)

    def at_fault(self, text):
        return {self.place(int(line))[0] for line in re.findall(re.escape(str(self.path)) + r":(\d+):\d+: error:", text)}


def compatible(sources, flags, folder):
    """Splits sources into units that compile."""
    folder.mkdir(parents=True, exist_ok=True)
    settings = next((f / ".clang-tidy" for f in sources[0].parents if (f / ".clang-tidy").exists()))
    (folder / ".clang-tidy").write_bytes(settings.read_bytes())
    rest = list(sources)
    for number in itertools.count():
        if not rest:
            return
        members, rest = rest[:UNIT], rest[UNIT:]
        while True:
            unit = Unit(folder / f"{number}.cpp", members)
            if len(members) == 1:
                break
            check = subprocess.run([*flags, "-fsyntax-only", "-Wno-everything", str(unit.path)], capture_output=True, text=True, check=False)
            if check.returncode == 0:
                break
            apart = unit.at_fault(check.stderr) - {members[0]} or set(members[1:])
            rest += [source for source in members if source in apart]
            members = [source for source in members if source not in apart]
        yield unit


def look_at(unit, flags):
    """Diagnostics of a unit; empty when all its sources are clean."""
    if len(unit.sources) == 1:
        unit = argparse.Namespace(path=unit.sources[0], sources=unit.sources, mapped=lambda text: text)
        allow = []
    else:
        allow = ["-Wno-shadow"]  # a local name of one source may be a constant of another
    run = subprocess.run([TIDY, "--quiet", str(unit.path), "--", *flags[1:], *NODES, *allow], capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return ""
    text = re.sub(r"^\d+ warnings.*\n", "", run.stdout, flags=re.M) or run.stderr or f"{unit.path}: {TIDY} ended with {run.returncode}\n"
    return unit.mapped(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("sources", nargs="*", type=pathlib.Path, help="look at these alone")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--all", action="store_true", help="look at every source again")
    options = parser.parse_args()
    build = options.build.resolve()
    stamps = build / "tidy-clean"
    stamps.mkdir(exist_ok=True)
    if options.all:
        for stamp in stamps.iterdir():
            stamp.unlink()
    version = b"".join(subprocess.run(command, capture_output=True, check=True).stdout
                       for command in ([TIDY, "--version"], ["dpkg-query", "-W"]))
    only = {source.resolve() for source in options.sources}
    chosen = sorted((e for e in entries(build) if not only or e[0] in only), key=lambda e: e[0])

    def stamp_of(source):
        return stamps / str(source.relative_to(ROOT)).replace("/", "__")

    def clean_marks(source):
        """Hashes of the source when it was last clean: of two suites' flags, two."""
        return stamp_of(source).read_text().split() if stamp_of(source).exists() else []

    groups, marks = {}, {}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for source, entry in chosen:
            mark = fingerprint(source, entry, build, version)
            if mark not in clean_marks(source):
                marks[source, tuple(flags_of(entry))] = mark
                groups.setdefault((tuple(flags_of(entry)), tuple(settings_above(source))), set()).add(source)

        def whole_group(number, flags, sources):
            for unit in compatible(sources, list(flags), build / "tidy-units" / str(number)):
                yield unit.sources, look_at(unit, list(flags))

        # A slice of a group is one task, so that the tasks are of a size and the jobs end together.
        # Shuffled, for sources of one folder name things alike. A set until then: one source may belong to two suites.
        for key, sources in groups.items():
            groups[key] = sorted(sources, key=lambda source: hashlib.sha256(source.name.encode()).digest())
        slices = [(flags, sources[i:i + SLICE]) for (flags, _), sources in groups.items() for i in range(0, len(sources), SLICE)]
        slices.sort(key=lambda s: -len(s[1]))
        results = queue.Queue()

        def work(number, flags, sources):
            try:
                for outcome in whole_group(number, flags, sources):
                    results.put((flags, *outcome))
            except Exception as error:  # a slice that could not be looked at is not clean
                results.put((flags, sources, f"{sources[0]} and its neighbours: {error!r}\n"))

        for number, (flags, sources) in enumerate(slices):
            pool.submit(work, number, flags, sources)
        pending, faulty = set(marks), 0
        while pending:
            flags, sources, diagnostics = results.get()
            pending.difference_update((source, flags) for source in sources)
            named = {pathlib.Path(path) for path in re.findall(r"^(/[^:]+):\d+:\d+: (?:error|warning):", diagnostics, flags=re.M)}
            if diagnostics:
                faulty += 1
                print(diagnostics, flush=True)
            if not diagnostics or named and named <= set(sources):  # a fault in a header is every source's
                for source in set(sources) - named:
                    stamp_of(source).write_text("\n".join([marks[source, flags], *clean_marks(source)[:1]]))
            if sys.stderr.isatty():
                print(f"\r{len(marks) - len(pending)}/{len(marks)}", end="", file=sys.stderr, flush=True)
    print(f"clang-tidy: {len(chosen)} sources, {len(marks)} looked at, {faulty} units with diagnostics")
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main())
