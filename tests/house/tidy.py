#!/usr/bin/env python3
"""clang-tidy over every source of the project, warnings as errors; a source that was clean is not looked at again.

Usage: tidy.py BUILD [SOURCE...] [--jobs N] [--all]    BUILD holds compile_commands.json of the preset `tidy`.

What clang-tidy sees of a source is its preprocessed text, its flags and the .clang-tidy files above it. Their hash is kept in
BUILD/tidy-clean when the source was clean, so that a second run costs one preprocessing each. --all forgets those hashes.
Exit: 0 clean, 1 something to mend (the diagnostics are printed).
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIDY = "clang-tidy-19"
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


def fingerprint(source, entry, version):
    """Hash of everything clang-tidy's verdict depends on; None where the source does not even preprocess."""
    command = shlex.split(entry["command"])
    output = command.index("-o")
    del command[output:output + 2]
    command[command.index("-c")] = "-E"
    text = subprocess.run(command, cwd=entry["directory"], capture_output=True, check=False)
    if text.returncode:
        return None
    digest = hashlib.sha256(version + shlex.join(command).encode() + text.stdout)
    for settings in settings_above(source):
        digest.update(settings)
    return digest.hexdigest()


def look_at(source, entry, build, version):
    """Diagnostics of one source; empty when it is clean."""
    stamp = build / "tidy-clean" / str(source.relative_to(ROOT)).replace("/", "__")
    mark = fingerprint(source, entry, version)
    if mark and stamp.exists() and stamp.read_text() == mark:
        return ""
    run = subprocess.run([TIDY, "--quiet", "-p", str(build), str(source)], capture_output=True, text=True, check=False)
    if run.returncode == 0 and mark:
        stamp.write_text(mark)
        return ""
    return re.sub(r"^\d+ warnings.*\n", "", run.stdout, flags=re.M) or run.stderr or f"{source}: {TIDY} ended with {run.returncode}\n"


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
    version = subprocess.run([TIDY, "--version"], capture_output=True, check=True).stdout
    only = {source.resolve() for source in options.sources}
    chosen = sorted((e for e in entries(build) if not only or e[0] in only), key=lambda e: e[0])
    faulty = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        todo = {pool.submit(look_at, source, entry, build, version): source for source, entry in chosen}
        for done, future in enumerate(concurrent.futures.as_completed(todo), 1):
            diagnostics = future.result()
            if diagnostics:
                faulty += 1
                print(diagnostics, flush=True)
            if sys.stderr.isatty():
                print(f"\r{done}/{len(todo)}", end="", file=sys.stderr, flush=True)
    print(f"clang-tidy: {len(todo) - faulty} of {len(todo)} sources clean")
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main())
