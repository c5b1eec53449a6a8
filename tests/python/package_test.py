"""The package: a wheel that installs into a fresh environment and works there, and sources that the tools find clean."""
from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PACKAGE = REPOSITORY / "clients/python"
TESTS = REPOSITORY / "tests/python"
TRY = """
import sys
from driftlab import Client, local
import driftlab
assert "site-packages" in driftlab.__file__, driftlab.__file__
found = local.simulate(duration_s=20)
print(len(found.samples), local.characterise(found.samples, rate_hz=100, columns="0=angular_rate:z:deg/s").channel().unit)
"""


def run(*words: str, folder: Path = PACKAGE, **environment: str) -> subprocess.CompletedProcess[str]:
    outside = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONDONTWRITEBYTECODE")}
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False, env={**outside, **environment})


class Package(unittest.TestCase):
    def passes(self, ran: subprocess.CompletedProcess[str]) -> str:
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        return ran.stdout

    def test_a_wheel_is_built_and_works_in_a_fresh_environment(self) -> None:
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        source = folder / "source"  # setuptools builds beside its sources
        shutil.copytree(PACKAGE, source, ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info", ".mypy_cache"))
        self.passes(run(sys.executable, "-m", "venv", "--system-site-packages", str(folder / "env")))
        python = str(folder / "env/bin/python")
        offline = ("--no-build-isolation", "--no-index")
        self.passes(run(python, "-m", "pip", "wheel", *offline, "--no-deps", "--wheel-dir", str(folder), str(source)))
        [wheel] = folder.glob("driftlab-*.whl")
        with zipfile.ZipFile(wheel) as archive:
            names = set(archive.namelist())
        expected = {path.relative_to(PACKAGE).as_posix() for path in (PACKAGE / "driftlab").rglob("*") if path.suffix in (".py", ".typed")}
        self.assertEqual({name for name in names if name.startswith("driftlab/")}, expected)
        self.passes(run(python, "-m", "pip", "install", *offline, str(wheel)))
        self.assertEqual(self.passes(run(python, "-c", TRY, folder=folder)), "2000 deg/s\n")

    def test_flake8_finds_nothing(self) -> None:
        for folder in (PACKAGE, TESTS):
            self.passes(run(sys.executable, "-m", "flake8", "--config", str(PACKAGE / ".flake8"), ".", folder=folder))

    def test_mypy_finds_nothing(self) -> None:
        cache = self.enterContext(tempfile.TemporaryDirectory())
        self.passes(run(sys.executable, "-m", "mypy", "--cache-dir", cache))
        tests = sorted(str(path) for path in TESTS.glob("*_test.py"))
        path = f"{REPOSITORY / 'tests/api'}:{PACKAGE}"
        self.passes(run(sys.executable, "-m", "mypy", "--cache-dir", cache, "--follow-imports=silent", *tests, MYPYPATH=path))

    def test_nothing_that_a_build_makes_is_kept(self) -> None:
        listed = run("git", "-c", "safe.directory=*", "ls-files", "--cached", "--others", "--exclude-standard", ".")
        if listed.returncode != 0:
            self.skipTest("this is no work tree of git")
        for name in listed.stdout.splitlines():
            self.assertNotRegex(name, r"(^|/)(build|dist|__pycache__|\.mypy_cache|[^/]*\.egg-info)/")


if __name__ == "__main__":
    unittest.main()
