"""`driftlab watch`: a job to its end, and everything that a daemon does."""
from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import samples
from daemon import Daemon
from suite import DaemonTest

PROGRAM = os.environ.get("DRIFTLAB", "")
CLEAN = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}


def watch(daemon: Daemon, *words: str) -> subprocess.CompletedProcess[str]:
    server = f"http://127.0.0.1:{daemon.port}"
    return subprocess.run([PROGRAM, "watch", *words, "--server", server], capture_output=True, text=True, check=False, timeout=120, env=CLEAN)


class Watch(DaemonTest):
    def recording(self, seed: int) -> str:
        return str(self.daemon.upload(samples.gyro_csv(seed=seed), rate_hz=100, columns=samples.GYRO_Z).json["id"])

    def test_a_job_is_followed_to_its_end(self) -> None:
        job = self.daemon.characterise(self.recording(1)).json["id"]
        ran = watch(self.daemon, job)
        self.assertEqual((ran.returncode, ran.stderr), (0, ""))
        lines = ran.stdout.splitlines()
        self.assertIn(" queued ", lines[0])
        self.assertRegex(lines[-1], rf"^20\S+Z  {job}  succeeded +100 %$")
        again = watch(self.daemon, job, "--json")  # it has ended: its history, and the same exit code
        self.assertEqual(again.returncode, 0)
        self.assertEqual(json.loads(again.stdout.splitlines()[-1])["state"], "succeeded")

    def test_a_job_that_ends_otherwise_says_so(self) -> None:
        job = self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000}).json["id"]
        self.daemon.post(f"/v1/jobs/{job}/cancel")
        ran = watch(self.daemon, job)
        self.assertEqual(ran.returncode, 4, ran.stdout)
        self.assertIn(f"The job {job} ended cancelled.", ran.stderr)

    def test_what_cannot_be_watched_is_one_sentence(self) -> None:
        for words, code in ((("job_00000000000000000000000000",), 2), ((), 2), (("job_1", "--all"), 2)):
            ran = watch(self.daemon, *words)
            self.assertEqual((ran.returncode, len(ran.stderr.splitlines())), (code, 1), ran.stderr)
        gone = subprocess.run([PROGRAM, "watch", "--all", "--server", "http://127.0.0.1:1"], capture_output=True, text=True, check=False, timeout=60, env=CLEAN)
        self.assertEqual(gone.returncode, 4, gone.stderr)

    def test_all_of_them_until_interrupted_and_across_a_restart(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            data = Path(folder) / "data"
            with Daemon(data) as daemon:
                port = daemon.port
                words = [PROGRAM, "watch", "--all", "--server", f"http://127.0.0.1:{port}"]
                with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=CLEAN) as watching:
                    assert watching.stdout is not None
                    time.sleep(0.5)  # what happened before it listens is not told

                    def run(daemon: Daemon, seed: int) -> str:
                        recording = daemon.upload(samples.gyro_csv(seed=seed), rate_hz=100, columns=samples.GYRO_Z).json["id"]
                        return str(daemon.finished(daemon.characterise(recording, models=["WN"]).json["id"])["id"])

                    def told(job: str) -> str:
                        for line in watching.stdout:  # type: ignore[union-attr]
                            if line.startswith(job):
                                return line
                        raise AssertionError(watching.stderr.read())  # type: ignore[union-attr]

                    first = run(daemon, 1)
                    self.assertIn(f"/v1/jobs/{first}/result", told(first))
                    daemon.kill()
                    with Daemon(data, listen=f"127.0.0.1:{port}") as again:
                        time.sleep(2.5)  # it asks again after a second
                        second = run(again, 2)
                        self.assertIn(f"/v1/jobs/{second}/result", told(second))
                        watching.send_signal(signal.SIGINT)
                        self.assertEqual(watching.wait(10), 130)


if __name__ == "__main__":
    unittest.main()
