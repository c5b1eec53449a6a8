"""Populations: /v1/populations and `driftlab population` over stored devices and over results, with one device that is not of the line."""
from __future__ import annotations

import csv
import io
import json
import os
import random
import subprocess
import tempfile
import unittest
from pathlib import Path

from daemon import PATIENCE_S
from suite import DaemonTest

PROGRAM = os.environ["DRIFTLAB"]
LEVELS = {"unit-1": 0.100, "unit-2": 0.104, "unit-3": 0.097, "unit-4": 0.101, "unit-5": 0.099, "unit-6": 0.250}  # deg/s a sample


def still_gyro(sigma: float, seed: int) -> bytes:
    source = random.Random(seed)
    return "\n".join(["gz [deg/s]", *(f"{source.gauss(0, sigma):.7g}" for _ in range(6000)), ""]).encode()


class Populations(DaemonTest):
    def driftlab(self, *arguments: str, folder: str | None = None) -> subprocess.CompletedProcess[str]:
        return subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)

    def test_the_device_that_is_not_of_the_line_is_flagged_by_both_ways(self) -> None:
        for seed, (name, sigma) in enumerate(LEVELS.items(), start=40):
            self.expect(201, self.daemon.post("/v1/devices", {"name": name, "model": "Probe 7"}))
            recording = self.expect(201, self.daemon.upload(still_gyro(sigma, seed), device=name, rate_hz=100)).json
            self.daemon.finished(self.expect(202, self.daemon.characterise(recording["id"])).json["id"])
        found = self.expect(200, self.daemon.get("/v1/populations?model=probe%207")).json
        self.assertEqual(sorted(found["devices"]), sorted(LEVELS))
        row = next(row for row in found["rows"] if row["parameter"] == "N")
        self.assertEqual((row["sensor"], row["axis"], row["label"]), ("gyroscope", "z", "static"))
        self.assertEqual([place["device"] for place in row["places"] if place["outlying"]], ["unit-6"])
        self.assertIn({"device": "unit-6", "sensor": "gyroscope", "axis": "z", "label": "static", "parameter": "N"}, found["outlying"])
        self.assertEqual(found["summary"]["verdict"], "One of 6 devices is not of the line: unit-6.")
        self.assertEqual(self.daemon.get("/v1/populations?model=Probe%207&sensor=accelerometer").json["rows"], [])
        # It is the newest result of that device, and wants a look; of the others the recordings are.
        latest = {name: self.daemon.get(f"/v1/devices/{name}/summary").json["latest"] for name in LEVELS}
        said = latest["unit-6"]
        self.assertEqual((said["kind"], said["id"], said["href"], said["level"]), ("population", "Probe 7", "/v1/populations?model=Probe%207", "look"))
        self.assertTrue(said["verdict"].startswith("unit-6 is not of the line of the 6 devices of Probe 7, by N of gyroscope z, static"), said)
        self.assertIsNone(said["recording"])
        self.assertEqual({each["kind"] for name, each in latest.items() if name != "unit-6"}, {"characterise"})
        [looked] = [each for each in self.daemon.items("/v1/attention?device=unit-6") if each["kind"] == "population"]
        self.assertEqual((looked["verdict"], looked["href"], looked["channel"]), (said["verdict"], said["href"], None))

        address = f"http://127.0.0.1:{self.daemon.port}"
        served = self.driftlab("population", "--model", "Probe 7", "--server", address)
        self.assertEqual(served.returncode, 0, served.stderr)
        self.assertIn("! unit-6: ", served.stdout)
        self.assertTrue(served.stdout.startswith(found["summary"]["verdict"] + "\n"), served.stdout)
        page = self.driftlab("population", "--model", "Probe 7", "--server", address, "--format", "markdown").stdout
        self.assertEqual(page, self.expect(200, self.daemon.get("/v1/populations?model=Probe%207", Accept="text/markdown")).text)
        self.assertTrue(page.startswith("**One of 6 devices is not of the line: unit-6.**\n"), page)
        [cells] = [line.strip("| ").split(" | ") for line in page.splitlines() if line.startswith("| gyroscope z | static | N |")]
        self.assertEqual((cells[7], cells[8]), ("6", "unit-6"))
        rows = list(csv.DictReader(io.StringIO(self.driftlab("population", "--model", "Probe 7", "--server", address, "--format", "csv").stdout)))
        self.assertEqual([line["device"] for line in rows if line["outlying"] == "yes" and line["parameter"] == "N"], ["unit-6"])
        with tempfile.TemporaryDirectory(prefix="driftlab-test-") as folder:
            files = []
            for seed, (name, sigma) in enumerate(LEVELS.items(), start=40):
                Path(folder, f"{name}.csv").write_bytes(still_gyro(sigma, seed))
                done = self.driftlab("characterise", f"{name}.csv", "--rate-hz", "100", "--json", folder=folder)
                Path(folder, f"{name}.json").write_text(done.stdout, "utf-8")
                files.append(f"{name}.json")
            local = json.loads(self.driftlab("population", *files, "--model", "Probe 7", "--format", "json", folder=folder).stdout)
            Path(folder, "copy.json").write_bytes(Path(folder, files[0]).read_bytes())
            for again, said in ((files[0], f"The file {files[0]} is named twice; each device counts once."),
                                (f"./{files[0]}", f"The files {files[0]} and ./{files[0]} hold the same samples; each device counts once."),
                                ("copy.json", f"The files {files[0]} and copy.json hold the same samples; each device counts once.")):
                done = self.driftlab("population", files[0], files[1], again, folder=folder)
                self.assertEqual((done.returncode, done.stdout, done.stderr), (2, "", f"driftlab: {said}\n"))
        self.assertEqual((local["rows"], local["summary"]), (found["rows"], found["summary"]))

    def test_bad_requests_are_answered_with_the_repair(self) -> None:
        self.problem(400, "invalid_argument", self.daemon.get("/v1/populations"))
        self.problem(404, "not_found", self.daemon.get("/v1/populations?model=nobody"))
        self.expect(406, self.daemon.get("/v1/populations?model=nobody", Accept="image/png"))
        none = self.driftlab("population")
        self.assertEqual(none.returncode, 2)
        self.assertIn("--model", none.stderr)
        with tempfile.TemporaryDirectory(prefix="driftlab-test-") as folder:
            Path(folder, "a.json").write_text("{}", "utf-8")
            wrong = self.driftlab("population", "a.json", folder=folder)
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("characterise --json", wrong.stderr)


if __name__ == "__main__":
    unittest.main()
