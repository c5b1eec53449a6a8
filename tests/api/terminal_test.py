"""driftlab on a terminal: the progress bar, Ctrl-C, and a job that fails in the daemon."""
from __future__ import annotations

import os
import pty
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from daemon import PATIENCE_S
from suite import DaemonTest

PROGRAM = os.environ["DRIFTLAB"]
CLEAR = "\r\x1b[K"  # what the bar is drawn behind, and what is left of it
LONG = ("--rate-hz", "100", "--bootstrap", "2000")  # minutes of work, were it let go on


class OnATerminal:
    """driftlab with its standard error on a terminal and its standard output in a pipe."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        self._terminal, inner = pty.openpty()
        self.process = subprocess.Popen([PROGRAM, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=inner)
        os.close(inner)
        self.seen = ""

    def read(self) -> bool:
        """One more piece of what the terminal shows; False at the end."""
        try:
            piece = os.read(self._terminal, 65536)
        except OSError:  # the other side is closed
            piece = b""
        self.seen += piece.decode(errors="replace")
        return bool(piece)

    def read_until(self, *wanted: str) -> None:
        until = time.monotonic() + PATIENCE_S
        while not any(text in self.seen for text in wanted):
            if not self.read() or time.monotonic() > until:
                raise AssertionError(f"none of {wanted} in {self.seen!r}")

    def finish(self) -> tuple[int, str]:
        """The exit code and what stands on standard output."""
        while self.read():
            pass
        os.close(self._terminal)
        out, _ = self.process.communicate(timeout=PATIENCE_S)
        return self.process.returncode, out.decode()


class Terminal(DaemonTest):
    arguments = ("--workers", "1")
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-test-")))
        for name, duration_s in (("short.csv", "60"), ("long.csv", "1200")):
            subprocess.run([PROGRAM, "simulate", "--preset", "iphone5s-z", "--duration-s", duration_s, "--seed", "4", "--out", name],
                           cwd=cls.folder, check=True, timeout=PATIENCE_S, capture_output=True)

    @property
    def server(self) -> tuple[str, str]:
        return ("--server", f"http://127.0.0.1:{self.daemon.port}")

    def test_a_bar_is_drawn_and_wiped_away(self) -> None:
        for where in ((), self.server):
            with self.subTest(where=where):
                run = OnATerminal(self.folder, "characterise", "short.csv", "--rate-hz", "100", "--models", "WN", *where)
                code, out = run.finish()
                self.assertEqual(code, 0, run.seen)
                self.assertRegex(run.seen, r"\r\x1b\[K[█░]{30} +\d+ %  \S")
                self.assertTrue(run.seen.endswith(CLEAR), run.seen[-80:])
                self.assertIn("deg/sqrt(h)", out)
                self.assertNotIn("\r", out)

    def interrupted(self, run: OnATerminal) -> str:
        run.process.send_signal(signal.SIGINT)
        code, out = run.finish()
        self.assertEqual((code, out), (130, ""), run.seen)
        said = run.seen.rpartition(CLEAR)[2].strip()
        self.assertEqual(len(said.splitlines()), 1, said)
        return said

    def test_ctrl_c_ends_the_work_here_with_130(self) -> None:
        run = OnATerminal(self.folder, "characterise", "long.csv", *LONG)
        run.read_until("%")
        self.interrupted(run)

    def test_ctrl_c_ends_the_waiting_for_a_daemon_with_130(self) -> None:
        run = OnATerminal(self.folder, "characterise", "long.csv", *LONG, "--device", "interrupted", *self.server)
        until = time.monotonic() + PATIENCE_S
        while not self.daemon.items("/v1/jobs?state=running"):
            self.assertLess(time.monotonic(), until)
            time.sleep(0.01)
        self.assertIn("goes on in the daemon", self.interrupted(run))
        [job] = self.daemon.items("/v1/jobs?state=running")
        self.expect(202, self.daemon.post(f"/v1/jobs/{job['id']}/cancel"))
        self.daemon.finished(job["id"])

    def test_a_job_that_fails_is_exit_code_4(self) -> None:
        (self.folder / "five.csv").write_text("gz [deg/s]\n1\n2\n1\n3\n2\n")  # enough to be a recording, too few for the analysis
        run = OnATerminal(self.folder, "characterise", "five.csv", "--rate-hz", "100", *self.server)
        code, out = run.finish()
        self.assertEqual((code, out), (4, ""), run.seen)
        self.assertRegex(run.seen, r"The job job_\w+ ended failed: \S")


if __name__ == "__main__":
    unittest.main()
