"""driftlab-decode as the programs start it: what it holds, what limits it, and what is said when a file breaks it or takes too much."""
from __future__ import annotations

import os
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np

from hdf5_test import written
from suite import DaemonTest

DECODE = Path(os.environ["DRIFTLAB"]).resolve().parent / "driftlab-decode"
SANITIZED = bool(os.environ.get("DRIFTLAB_SANITIZE"))
BREAKS = Path(__file__).resolve().parents[1] / "fuzz" / "corpus" / "decode_process" / "breaks_libhdf5_1.10.8.h5"
MIB = 1 << 20
NOTHING: dict[str, str] = {}  # the environment that it is given
SMALL = written(lambda f: f.create_dataset("gyr", data=np.zeros(100_000)))  # more than a pipe holds


def facts(process: int) -> dict[str, str]:
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    return dict(line.split(":\t", 1) for line in lines if ":\t" in line)


def limits(process: int) -> dict[str, tuple[str, str]]:
    """Soft and hard limit by name."""
    lines = Path(f"/proc/{process}/limits").read_text().splitlines()[1:]
    return {line[:26].strip(): (line[26:47].strip(), line[47:68].strip()) for line in lines}


def children(parent: int) -> list[int]:
    """Decoding processes of a program, of any of its threads."""
    found: list[int] = []
    for listed in Path(f"/proc/{parent}/task").glob("*/children"):
        try:
            found += [int(child) for child in listed.read_text().split() if facts(int(child))["Name"].startswith("driftlab-decod")]
        except (FileNotFoundError, ProcessLookupError):
            continue
    return found


class Held(unittest.TestCase):
    """The program itself, which stands still once nobody takes what it writes."""

    @unittest.skipIf(SANITIZED, "sanitizers take another limit of memory, and memory of their own")
    def test_it_is_behind_its_filter_and_its_limits_while_it_decodes(self) -> None:
        budget = 8 * MIB
        with tempfile.TemporaryFile() as recording:
            recording.write(SMALL)
            recording.flush()
            with subprocess.Popen([DECODE, "hdf5", str(budget)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, env=NOTHING, pass_fds=(3,),
                                  preexec_fn=lambda: os.dup2(recording.fileno(), 3) and None) as process:
                try:
                    said = process.stdout.read(1) if process.stdout else b""  # it has something to say, so it is behind the door
                    self.assertEqual(said, b"V")
                    status = facts(process.pid)
                    if "Seccomp" in status:
                        self.assertEqual(status["Seccomp"], "2")
                    self.assertEqual(status["NoNewPrivs"], "1")
                    self.assertEqual(status["Threads"], "1")
                    limited = limits(process.pid)
                    self.assertEqual(limited["Max cpu time"], ("120", "120"))
                    self.assertEqual(limited["Max file size"], ("0", "0"))
                    self.assertEqual(limited["Max core file size"], ("0", "0"))
                    most = str(256 * MIB + 2 * len(SMALL) + 4 * budget)
                    self.assertEqual(limited["Max address space"], (most, most))
                    held = {int(name) for name in os.listdir(f"/proc/{process.pid}/fd")}
                    self.assertEqual(held, {0, 1, 2, 3})
                finally:
                    process.kill()

    @unittest.skipIf(SANITIZED, "sanitizers take another limit of memory")
    def test_it_ends_without_an_end_of_its_words_where_the_library_wants_more_memory(self) -> None:
        """One chunk of 288 MiB holds the sixteen samples that are read: 260 MiB of addresses, all that a budget of 1 MiB gives, do not."""
        chunk = written(lambda f: f.create_dataset("gyr", shape=(16,), dtype="f8", maxshape=(None,), chunks=(36 * MIB,), compression="gzip",
                                                   compression_opts=1).write_direct(np.ones(16)))
        for budget, reads in ((1 * MIB, False), (256 * MIB, True)):
            with self.subTest(budget=budget), tempfile.TemporaryFile() as recording:
                recording.write(chunk)
                recording.flush()
                ran = subprocess.run([DECODE, "hdf5", str(budget)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, check=False,
                                     env=NOTHING, preexec_fn=lambda: os.dup2(recording.fileno(), 3) and None, pass_fds=(3,))
                self.assertEqual(ran.stdout.endswith(b"Z"), reads, (ran.returncode, ran.stdout[:200]))


class OfTheDaemon(DaemonTest):
    def refused(self, content: bytes, status: int, words: str) -> None:
        answer = self.daemon.upload(content, device="broken", rate_hz=100)
        self.assertEqual(answer.status, status, answer.describe())
        self.assertIn(words, answer.json["detail"])

    def test_a_file_that_kills_the_process_is_refused_and_the_next_is_read(self) -> None:
        """libhdf5 1.10.8 follows a null pointer over this one, later ones may find it damaged or empty."""
        answer = self.daemon.upload(BREAKS.read_bytes(), device="broken", rate_hz=100)
        self.assertEqual(answer.status, 422, answer.describe())
        self.expect(201, self.daemon.upload(SMALL, device="whole", rate_hz=100, columns="gyr=angular_rate:x:deg/s"))

    def test_what_takes_more_memory_than_a_decoding_may_is_refused_in_a_sentence(self) -> None:
        # 512 MiB of samples are said by the file's header, and refused before they are read: the limit is 256 MiB.
        many = written(lambda f: f.create_dataset("gyr", shape=(64 * MIB,), dtype="f8", chunks=(1 << 16,), compression="gzip"))
        self.refused(many, 413, "take more memory than one decoding may")
        self.expect(201, self.daemon.upload(SMALL, device="well", rate_hz=100, columns="gyr=angular_rate:x:deg/s"))

    def test_the_daemon_gives_it_the_recording_and_a_pipe_and_nothing_else(self) -> None:
        long = written(lambda f: f.create_dataset("gyr", data=np.zeros(12_000_000), chunks=(1 << 16,), compression="gzip"))
        seen: list[tuple[set[int], bytes, str]] = []
        worker = threading.Thread(target=lambda: self.daemon.upload(long, device="held", rate_hz=100, columns="gyr=angular_rate:x:deg/s"))
        worker.start()
        until = time.monotonic() + 60.0
        while not seen and worker.is_alive() and time.monotonic() < until:
            for child in children(self.daemon.process.pid):
                try:
                    if facts(child).get("Seccomp", "2") == "2":
                        seen.append(({int(name) for name in os.listdir(f"/proc/{child}/fd")}, Path(f"/proc/{child}/environ").read_bytes(),
                                     os.readlink(f"/proc/{child}/fd/3")))
                except (FileNotFoundError, ProcessLookupError, PermissionError):
                    continue
        worker.join()
        self.assertTrue(seen, "the decoding process was not seen at work")
        held, environment, recording = seen[0]
        self.assertEqual(held, {0, 1, 2, 3})
        self.assertEqual(environment, b"")
        self.assertIn("memfd:recording", recording)


if __name__ == "__main__":
    unittest.main()
