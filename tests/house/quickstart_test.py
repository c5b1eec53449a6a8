#!/usr/bin/env python3
"""./deploy/quickstart.sh end to end, on the programs in $DRIFTLAB_BIN: sample, own recording, Ctrl-C, a taken port."""
from __future__ import annotations

import os
import random
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PROGRAMS = Path(os.environ.get("DRIFTLAB_BIN") or REPOSITORY / "build/release/bin").resolve()


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Quickstart(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.port = free_port()
        self.command = [str(REPOSITORY / "deploy/quickstart.sh"), "--bin", str(PROGRAMS), "--port", str(self.port),
                        "--data", str(self.folder / "data")]

    def quickstart(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([*self.command, *arguments], capture_output=True, text=True, timeout=240, check=False)

    def assert_nobody_listens(self) -> None:
        with socket.socket() as probe:
            self.assertNotEqual(probe.connect_ex(("127.0.0.1", self.port)), 0, "a daemon was left behind")

    def recording(self, cell: str = "") -> Path:
        """4096 samples of white noise of 0.1 deg/s, the last of them `cell` where one is given."""
        draw = random.Random(20170401)
        values = [f"{draw.gauss(0.0, 0.1):.6f}" for _ in range(4096)]
        if cell:
            values[-1] = cell
        path = self.folder / "bench gyro.csv"
        path.write_text("gz\n" + "\n".join(values) + "\n")
        return path

    def test_the_sample_gives_a_table_of_two_conditions_twice(self) -> None:
        first = self.quickstart("--once")
        self.assertEqual(first.returncode, 0, first.stdout + first.stderr)
        self.assertIn("simulated by driftlab", first.stdout)
        self.assertIn("deg/sqrt(h)", first.stdout)
        self.assertRegex(first.stdout, r"(?m)^\W*static\b")
        self.assertRegex(first.stdout, r"(?m)^\W*9 deg/s about z\b")
        self.assertIn(f"http://127.0.0.1:{self.port}", first.stdout)
        self.assert_nobody_listens()
        second = self.quickstart("--once")
        self.assertEqual(second.returncode, 0, second.stdout + second.stderr)
        self.assertEqual(second.stdout, first.stdout, "the same sample and seed give the same table")

    def test_once_says_what_it_leaves_and_leaves_nothing_else(self) -> None:
        before = set(self.folder.rglob("*"))
        ran = self.quickstart("--once")
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        last = ran.stdout.rstrip().splitlines()[-1]
        said = re.fullmatch(r"Done: the daemon that served at (\S+) is stopped\. It leaves its data in (.+), logs in (.+) and the programs in (.+); "
                            r"nothing else runs or stays\.", last)
        assert said is not None, last
        data, logs = self.folder / "data", self.folder / "data/logs"
        self.assertEqual(said.groups(), (f"http://127.0.0.1:{self.port}", str(data), str(logs), str(PROGRAMS)))
        self.assertTrue((logs / "daemon.log").is_file())
        self.assertTrue(any(path.suffix == ".csv" for path in (data / "sample").iterdir()))
        outside = [path for path in set(self.folder.rglob("*")) - before if path != data and data not in path.parents]
        self.assertEqual(outside, [])
        running = []
        for process in Path("/proc").glob("[0-9]*/cmdline"):
            try:
                running.append(process.read_bytes())
            except OSError:
                continue  # it has ended meanwhile
        self.assertFalse(any(str(data).encode() in line for line in running), "a process of it still runs")

    def test_a_build_without_a_terminal_shows_how_far_it_is(self) -> None:
        """Half an hour of silence in a pipeline's log looks like a hang. The compiler is played by a script, and minutes are tenths of seconds."""
        repository, tools = self.folder / "repository", self.folder / "tools"
        (repository / "build/release/bin").mkdir(parents=True)
        (repository / "build/release/CMakeCache.txt").touch()
        (repository / "deploy").mkdir()
        shutil.copy(REPOSITORY / "deploy/quickstart.sh", repository / "deploy")
        (repository / "deploy/packages.sh").write_text("install_packages() { :; }\n")
        tools.mkdir()
        scripts = {"sleep": 'exec /bin/sleep 0.1',
                   "ninja": 'for step in 1 200 400 562; do echo "[$step/562] Building CXX object"; /bin/sleep 0.4; done\n'
                            f'ln -s {PROGRAMS}/driftlab {PROGRAMS}/driftlabd {repository}/build/release/bin/'}
        for name, script in scripts.items():
            (tools / name).write_text("#!/bin/sh\n" + script + "\n")
            (tools / name).chmod(0o755)
        ran = subprocess.run([str(repository / "deploy/quickstart.sh"), "--once", "--port", str(self.port), "--data", str(self.folder / "data")],
                             capture_output=True, text=True, timeout=240, check=False, env={**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"})
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        lines = ran.stdout.splitlines()
        built = lines.index("Characterising the sample: z gyroscope of an iPhone 5S, simulated by driftlab from Radi et al. (2017), Table 4")
        self.assertIn("Building driftlab (the first time takes some minutes)", lines[:built])
        shown = [line.strip() for line in lines[:built] if line.startswith("  [")]
        steps = ["[1/562]", "[200/562]", "[400/562]", "[562/562]"]
        seen = list(dict.fromkeys(shown))
        self.assertGreaterEqual(len(seen), 2, "one line is no progress")
        self.assertEqual(seen, [step for step in steps if step in seen], "in order, and nothing else")
        self.assertNotIn("\r", ran.stdout)
        self.assertEqual(ran.stderr, "")
        self.assertIn(f"and the build in {repository}/build/release with the Debian packages that it needs; nothing else runs or stays.", lines[-1])

    def test_an_own_recording_gives_its_figures(self) -> None:
        ran = self.quickstart("--once", "--recording", str(self.recording()), "--rate-hz", "100", "--columns",
                              "gz=angular_rate:z:deg/s", "--condition", "constant_rate:z:9:deg/s")
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        # White noise of 0.1 deg/s at 100 Hz: N = 0.1 sqrt(0.01 s) deg/s/sqrt(Hz) = 0.6 deg/sqrt(h); its standard error
        # from 4096 samples is 1.1 %, so five of them are 0.033.
        values = [float(text) for text in re.findall(r"(?<![\w.])0\.\d+", ran.stdout)]
        self.assertTrue(any(abs(value - 0.6) < 0.033 for value in values), ran.stdout)
        self.assert_nobody_listens()

    def test_a_bad_recording_ends_with_a_sentence_that_locates_it(self) -> None:
        ran = self.quickstart("--once", "--recording", str(self.recording("0.1O")), "--rate-hz", "100", "--columns",
                              "gz=angular_rate:z:deg/s")
        self.assertNotEqual(ran.returncode, 0)
        self.assertIn("4097", ran.stderr)
        self.assertIn("gz", ran.stderr)
        self.assert_nobody_listens()

    def test_it_serves_until_interrupted(self) -> None:
        running = subprocess.Popen([*self.command, "--recording", str(self.recording()), "--rate-hz", "100", "--columns",
                                    "gz=angular_rate:z:deg/s"], stdout=subprocess.PIPE, text=True, start_new_session=True)
        assert running.stdout is not None
        shown = ""
        for line in running.stdout:
            shown += line
            if "Ctrl-C" in line:
                break
        with socket.create_connection(("127.0.0.1", self.port), timeout=5) as probe:
            probe.sendall(f"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nConnection: close\r\n\r\n".encode())
            self.assertIn(b"200", probe.recv(64))
        started = time.monotonic()
        os.killpg(running.pid, signal.SIGINT)  # what a terminal sends
        shown += running.stdout.read()
        self.assertEqual(running.wait(timeout=60), 0, shown)
        running.stdout.close()
        self.assertLess(time.monotonic() - started, 30)
        self.assert_nobody_listens()

    def test_a_taken_port_is_said_in_one_sentence(self) -> None:
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", self.port))
            taken.listen()
            ran = self.quickstart("--once")
        self.assertEqual(ran.returncode, 1, ran.stdout)
        self.assertIn(str(self.port), ran.stderr)


if __name__ == "__main__":
    unittest.main()
