"""How a daemon stops, cancels and reloads: in time whatever runs, and with nothing of its log where data belong."""
from __future__ import annotations

import http.client
import json
import os
import resource
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import samples
from daemon import PATIENCE_S, PROGRAM, Daemon
from operating import csv, free_port

SOURCE = Path(__file__).resolve().parents[2]
SLOW = 10 if os.environ.get("DRIFTLAB_SANITIZE") else 1


class Stops(unittest.TestCase):
    def test_not_ready_is_said_before_the_door_closes(self) -> None:
        with Daemon(arguments=("--budget", "drain_milliseconds=1500")) as daemon:
            self.assertEqual(daemon.get("/readyz").status, 200)
            daemon.process.send_signal(signal.SIGTERM)
            daemon.logged(event="stopping")
            answer = daemon.get("/readyz")
            self.assertEqual(answer.status, 503)
            self.assertIn("stopping", answer.json["detail"])
            self.assertEqual(daemon.get("/healthz").status, 200)
            begun = time.monotonic()
            self.assertEqual(daemon.wait(), 0)
            self.assertLess(time.monotonic() - begun, 10)

    def test_it_stops_in_time_though_nobody_reads_its_log(self) -> None:
        read, write = os.pipe()
        port = free_port()
        with tempfile.TemporaryDirectory() as folder:
            process = subprocess.Popen([PROGRAM, "--data", folder, "--listen", f"127.0.0.1:{port}", "--log-level", "debug",
                                        "--budget", "stop_seconds=5"], stderr=write, stdin=subprocess.DEVNULL)
            os.close(write)
            for _ in range(200):
                try:
                    http.client.HTTPConnection("127.0.0.1", port, timeout=5).request("GET", "/healthz")
                    break
                except OSError:
                    time.sleep(0.05)
            for _ in range(600):  # more lines than a pipe holds, and nobody takes them
                connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
                connection.request("GET", "/healthz?" + "x" * 300)
                connection.getresponse().read()
                connection.close()
            begun = time.monotonic()
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(30), 0)
            self.assertLess(time.monotonic() - begun, 6.5)
        os.close(read)

    def test_cancel_takes_a_second_and_stopping_ten_whatever_runs(self) -> None:
        with Daemon(arguments=("--workers", "2")) as daemon:
            recordings = [daemon.upload(csv(400_000, seed), device="d").json["id"] for seed in range(2)]
            study = daemon.post("/v1/studies", {"device": {"id": "d"}, "recordings": [{"id": f"r{i}", "recording": r} for i, r in enumerate(recordings)]}).json["id"]
            scenario = json.loads((SOURCE / "tests/api/long_drive.json").read_text())
            # Of a long recording the search of lines and what it held out ran on for seconds (tests/bench/cancel_times.py has every kind).
            rows = samples.npy([column * 60 for column in samples.noise(20_000, 3)])
            long = daemon.upload(rows, device="long", rate_hz=100, columns=",".join(f"{i}=angular_rate:{'xyz'[i]}:deg/s" for i in range(3)))
            self.assertEqual(long.status, 201, long.describe())
            long_study = daemon.post("/v1/studies", {"device": {"id": "long"}, "recordings": [{"id": "r", "recording": long.json["id"]}]}).json["id"]
            kinds = {"characterise": {"recordings": recordings}, "investigate": {"study": study}, "outage_evaluation": {"scenario": scenario}}
            slowest = {}
            for name, kind, inputs in (*((kind, kind, inputs) for kind, inputs in kinds.items()), ("investigate 1.2 million rows", "investigate", {"study": long_study})):
                worst = 0.0
                for wait in (0.05, 0.5, 2.0):
                    queued = daemon.post("/v1/jobs", {"kind": kind, "inputs": inputs})
                    self.assertIn(queued.status, {200, 202}, queued.describe())
                    job = queued.json["id"]
                    until = time.monotonic() + PATIENCE_S
                    while daemon.get(f"/v1/jobs/{job}").json["state"] == "queued" and time.monotonic() < until:
                        time.sleep(0.01)
                    time.sleep(wait)
                    begun = time.monotonic()
                    daemon.post(f"/v1/jobs/{job}/cancel")
                    ended = daemon.finished(job)
                    worst = max(worst, time.monotonic() - begun)
                    if ended["state"] == "succeeded":
                        break
                slowest[name] = worst
            print("longest cancel:", {kind: f"{seconds:.2f} s" for kind, seconds in slowest.items()})
            self.assertTrue(all(seconds < 1.0 * SLOW + 0.5 for seconds in slowest.values()), slowest)
            for kind in ("investigate", "outage_evaluation"):
                daemon.post("/v1/jobs", {"kind": kind, "inputs": kinds[kind]})
            time.sleep(1.0)
            begun = time.monotonic()
            self.assertEqual(daemon.terminate(), 0)
            self.assertLess(time.monotonic() - begun, 10)

    def test_a_closed_standard_error_keeps_log_lines_out_of_data(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            port = free_port()
            process = subprocess.Popen(["sh", "-c", f'exec "{PROGRAM}" --data {folder} --listen 127.0.0.1:{port} --log-level debug 2>&-'], stdin=subprocess.DEVNULL)
            for _ in range(200):
                try:
                    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
                    connection.request("GET", "/v1/devices")
                    connection.getresponse().read()
                    break
                except OSError:
                    time.sleep(0.05)
            opened = {os.readlink(f"/proc/{process.pid}/fd/{n}") for n in (0, 1, 2)}
            process.terminate()
            self.assertEqual(process.wait(30), 0)
            self.assertIn("/dev/null", opened)
            self.assertFalse(any(folder in name for name in opened), opened)
            for file in Path(folder).rglob("*"):
                if file.is_file():
                    self.assertNotIn(b'"event":', file.read_bytes(), file)

    def test_a_limit_of_file_size_is_an_answer_not_the_end(self) -> None:
        def small_files() -> None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (20_000_000, 20_000_000))
        with Daemon(arguments=("--budget", "reserve_bytes=0"), before_exec=small_files) as daemon:
            answer = daemon.upload(b"0.5,0.25\n" * 3_000_000)
            self.assertEqual(answer.status, 507, answer.describe())
            self.assertEqual(daemon.upload(csv(200)).status, 201)

    def test_the_log_file_is_opened_again_at_sighup(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "driftlab.log"
            port = free_port()
            process = subprocess.Popen([PROGRAM, "--data", f"{folder}/data", "--listen", f"127.0.0.1:{port}", "--log-file", str(log)])
            def wait_for(text: str) -> None:
                until = time.monotonic() + PATIENCE_S
                while time.monotonic() < until and not (log.exists() and text in log.read_text()):
                    time.sleep(0.02)
                self.assertIn(text, log.read_text())
            wait_for('"listening"')
            log.rename(Path(folder) / "driftlab.log.1")
            process.send_signal(signal.SIGHUP)
            wait_for('"reloaded"')
            self.assertIn('"listening"', (Path(folder) / "driftlab.log.1").read_text())
            process.terminate()
            self.assertEqual(process.wait(30), 0)
            self.assertIn('"stopped"', log.read_text())


if __name__ == "__main__":
    unittest.main()
