#!/usr/bin/env python3
"""The `runtime` packages of deploy/packages.sh are exactly those of the libraries that the built programs name.

What these libraries need themselves comes with their packages."""
from __future__ import annotations

import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PROGRAMS = Path(os.environ.get("DRIFTLAB_BIN") or REPOSITORY / "build/release/bin").resolve()
ALWAYS_THERE = {"libc6", "libgcc-s1"}


def output_of(*words: str) -> str:
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def owner_of(library: str) -> str:
    """The package of a library; its file may be registered under /usr/lib or under /lib."""
    resolved = Path(library).resolve()
    names = {str(resolved), str(resolved).removeprefix("/usr"), library, library.removeprefix("/usr")}
    for name in sorted(names):
        found = subprocess.run(["dpkg-query", "--search", name], capture_output=True, text=True, check=False)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    raise AssertionError(f"{library} belongs to no package")


class Runtime(unittest.TestCase):
    @unittest.skipUnless(shutil.which("dpkg-query"), "SKIPPED: package names are those of Debian, and this is not Debian")
    def test_the_runtime_set_is_what_the_programs_link(self) -> None:
        needed = set()
        for program in ("driftlab", "driftlabd", "driftlab-decode"):
            named = set(re.findall(r"\(NEEDED\).*\[(.*)\]", output_of("readelf", "-d", str(PROGRAMS / program))))
            for name, library in re.findall(r"(\S+) => (/\S+)", output_of("ldd", str(PROGRAMS / program))):
                if name in named:
                    needed.add(owner_of(library))
        declared = set(output_of(str(REPOSITORY / "deploy/packages.sh"), "runtime").split())
        self.assertEqual(needed - declared - ALWAYS_THERE, set(), "missing in the runtime set")
        self.assertEqual(declared - needed - {"ca-certificates", "libstdc++6"}, set(), "not needed in the runtime set")


if __name__ == "__main__":
    unittest.main()
