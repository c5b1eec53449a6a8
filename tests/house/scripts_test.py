#!/usr/bin/env python3
"""The two commands of the README, with their tools replaced by recorders: what they install, and how they end.

A copy of the scripts runs in a temporary tree with a PATH of its own, so nothing is installed or built.
"""
from __future__ import annotations

import os
import shutil
import socket
import subprocess
import tempfile
import unittest
from pathlib import Path

from quickstart_test import free_port

REPOSITORY = Path(__file__).resolve().parents[2]
REAL_TOOLS = ("bash", "env", "dirname", "basename", "cat", "tail", "head", "grep", "sort", "mkdir", "nproc", "mv", "sleep", "rm")

# cmake configures and builds by doing nothing, ctest says what ctest says at its end.
STUBS = {
    "cmake": 'case "$*" in *"${FAIL_BUILD:-none}"*) echo "error: planted"; exit 1;; esac',
    "ninja": "",
    "ctest": 'if [ -n "${FAIL_TEST:-}" ]; then echo "50% tests passed, 1 tests failed out of 2"; exit 8; fi\n'
             'echo "100% tests passed, 0 tests failed out of 2"',
    "git": "",
    "id": 'echo "${AS_USER:-0}"',
    "dpkg-query": 'for last; do :; done; case " ${ABSENT:-} " in *" $last "*) exit 1;; esac; printf installed',
    "apt-get": '[ -z "${FAIL_APT:-}" ] || { echo "E: planted"; exit 100; }',
}


class Scripts(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name) / "tree"
        for script in ("deploy/packages.sh", "deploy/quickstart.sh", "tests/run.sh", ".ci/run"):
            (self.root / script).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(REPOSITORY / script, self.root / script)
        self.tools = self.root / "tools"
        self.tools.mkdir()
        for tool in REAL_TOOLS:
            where = shutil.which(tool)
            assert where is not None, tool
            (self.tools / tool).symlink_to(where)
        for tool, body in STUBS.items():
            self.stub(tool, body)

    def stub(self, tool: str, body: str) -> None:
        path = self.tools / tool
        path.write_text(f'#!/bin/bash\necho "{tool} $*" >>"{self.root}/calls"\n{body}\n')
        path.chmod(0o755)

    def run_script(self, script: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        (self.root / "calls").write_text("")
        if script == "deploy/quickstart.sh" and "--port" not in arguments:
            arguments = (*arguments, "--port", str(free_port()))
        return subprocess.run([str(self.root / script), *arguments], capture_output=True, text=True, timeout=60, check=False,
                              env={"PATH": str(self.tools), "HOME": str(self.root), **environment})

    def calls(self, tool: str) -> list[str]:
        return [line for line in (self.root / "calls").read_text().split("\n") if line.startswith(tool + " ")]

    def test_run_passes_where_every_suite_passes(self) -> None:
        ran = self.run_script("tests/run.sh")
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        self.assertIn("100% tests passed, 0 tests failed out of 2", ran.stdout)
        trees = (self.root / "build/all/CTestTestfile.cmake").read_text()
        self.assertIn("/build/release", trees)
        self.assertIn("/build/fuzz", trees)
        self.assertIn("-DDRIFTLAB_FUZZ_SECONDS=5", "\n".join(self.calls("cmake")))
        self.assertIn("--label-exclude long", self.calls("ctest")[0])

    def test_run_says_in_one_line_that_there_are_no_recordings(self) -> None:
        missing = self.root / "elsewhere"
        said = [line for line in self.run_script("tests/run.sh", DRIFTLAB_SHARED=str(missing)).stdout.split("\n") if line.startswith("SKIPPED")]
        self.assertEqual(len(set(said)), 1, said)
        self.assertIn(f"{missing}/data", said[0])
        (missing / "data").mkdir(parents=True)
        self.assertNotIn("SKIPPED", self.run_script("tests/run.sh", DRIFTLAB_SHARED=str(missing)).stdout)

    def test_a_failing_suite_is_a_failing_run(self) -> None:
        ran = self.run_script("tests/run.sh", FAIL_TEST="1")
        self.assertEqual(ran.returncode, 1)
        self.assertIn("1 tests failed out of 2", ran.stdout)

    def test_a_failing_build_is_a_failing_run_and_shows_why(self) -> None:
        for part in ("--build --preset release", "--build --preset fuzz", "--preset release"):
            ran = self.run_script("tests/run.sh", FAIL_BUILD=part)
            self.assertEqual(ran.returncode, 1, part)
            self.assertIn("error: planted", ran.stdout, part)

    def test_continuous_integration_runs_the_same(self) -> None:
        self.assertEqual(self.run_script(".ci/run", FAIL_TEST="1").returncode, 1)
        self.assertEqual(self.run_script(".ci/run").returncode, 0)

    def test_flags_reach_what_they_name(self) -> None:
        self.run_script("tests/run.sh", "--sanitize", "--long", "--fuzz", "7", "--only", "Allan.*Slope")
        built = "\n".join(self.calls("cmake"))
        for part in ("asan-ubsan", "tsan", "--target long_suites", "-DDRIFTLAB_FUZZ_SECONDS=7"):
            self.assertIn(part, built)
        self.assertTrue(all("--tests-regex Allan.*Slope" in call for call in self.calls("ctest")), self.calls("ctest"))
        self.assertEqual(len(self.calls("ctest")), 3)
        self.assertNotIn("--label-exclude", self.calls("ctest")[-1])

    def test_misuse_ends_with_2_and_one_sentence(self) -> None:
        for script, arguments in (("tests/run.sh", ["--nonsense"]), ("tests/run.sh", ["--only"]),
                                  ("deploy/quickstart.sh", ["--nonsense"]), ("deploy/quickstart.sh", ["--once", "--port"]),
                                  ("deploy/quickstart.sh", ["--port", "99999"]),
                                  ("deploy/quickstart.sh", ["--recording", "absent.csv"]),
                                  ("deploy/quickstart.sh", ["--rate-hz", "100"])):
            ran = self.run_script(script, *arguments)
            self.assertEqual(ran.returncode, 2, (script, arguments, ran.stderr))
            self.assertEqual(len(ran.stderr.strip().split("\n")), 1, ran.stderr)
            self.assertEqual(self.calls("apt-get") + self.calls("cmake"), [])

    def test_apt_is_left_alone_when_nothing_is_missing(self) -> None:
        self.run_script("tests/run.sh")
        self.assertEqual(self.calls("apt-get"), [])

    def test_root_installs_exactly_what_is_missing(self) -> None:
        ran = self.run_script("tests/run.sh", ABSENT="curl libgtest-dev")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        install = self.calls("apt-get")[1]
        self.assertTrue(install.endswith("--no-install-recommends curl libgtest-dev"), install)

    def test_quickstart_asks_for_no_test_packages(self) -> None:
        self.run_script("deploy/quickstart.sh", "--once", ABSENT="libgtest-dev clang-19")
        self.assertEqual(self.calls("apt-get"), [])

    def test_a_taken_port_is_noticed_before_anything_is_installed_or_built(self) -> None:
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            ran = self.run_script("deploy/quickstart.sh", "--port", str(port), ABSENT="curl")
        self.assertEqual(ran.returncode, 1)
        self.assertIn(f"port {port} is taken", ran.stderr)
        self.assertEqual(self.calls("apt-get") + self.calls("cmake"), [])

    def test_without_root_and_sudo_the_command_is_named(self) -> None:
        for script in ("tests/run.sh", "deploy/quickstart.sh"):
            ran = self.run_script(script, AS_USER="1000", ABSENT="curl")
            self.assertEqual(ran.returncode, 1)
            self.assertIn("apt-get install --no-install-recommends curl", ran.stderr)
            self.assertEqual(self.calls("apt-get"), [])

    def test_sudo_is_used_where_it_is_there(self) -> None:
        self.stub("sudo", '"$@"')
        self.run_script("tests/run.sh", AS_USER="1000", ABSENT="curl")
        self.assertEqual([call.split()[1] for call in self.calls("sudo")], ["apt-get", "env"])
        self.assertEqual(len(self.calls("apt-get")), 2)

    def test_a_failing_apt_ends_the_run_and_shows_why(self) -> None:
        ran = self.run_script("tests/run.sh", ABSENT="curl", FAIL_APT="1")
        self.assertEqual(ran.returncode, 1)
        self.assertIn("E: planted", ran.stderr)
        self.assertEqual(self.calls("ctest"), [])

    def test_boost_1_74_is_announced_before_apt_replaces_it(self) -> None:
        ran = self.run_script("tests/run.sh", ABSENT="libboost1.81-dev")
        self.assertIn("libboost1.74-dev is installed", ran.stdout)
        ran = self.run_script("tests/run.sh", ABSENT="libboost1.81-dev libboost1.74-dev")
        self.assertNotIn("libboost1.74-dev is installed", ran.stdout)


if __name__ == "__main__":
    os.umask(0o022)
    unittest.main()
