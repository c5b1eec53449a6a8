"""A log of several inertial units: one upload holds them all, and the recording's `stream` says which of them is meant."""
from __future__ import annotations

import functools
import json
import os
import random
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

from daemon import PATIENCE_S
from suite import DaemonTest

ROWS = 6000
SIGMA = {0: 0.002, 1: 0.01, 2: 0.05}  # of a sample [rad/s], with which N goes


@functools.cache
def dataflash() -> bytes:
    """A log of ArduPilot with three units at 100 Hz, each with noise of its own."""
    def declared(number: int, name: str, letters: str, labels: str) -> bytes:
        size = 3 + sum({"Q": 8, "B": 1, "f": 4}[letter] for letter in letters)
        return b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", number, size, name.encode(), letters.encode(), labels.encode())
    log = b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", 0x80, 89, b"FMT", b"BBnNZ", b"Type,Length,Name,Format,Columns")
    log += declared(0x90, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ")
    made = random.Random(20)
    for i in range(ROWS):
        for unit, sigma in SIGMA.items():
            log += b"\xa3\x95\x90" + struct.pack("<QB6f", 1_000_000 + 10_000 * i + 7 * unit, unit, *(made.gauss(0, sigma) for _ in range(3)),
                                                 *(made.gauss(0, 10 * sigma) for _ in range(3)))
    return log


class Streams(DaemonTest):
    def density(self, recording: str) -> float:
        """N of gyroscope x."""
        job = self.expect(202, self.daemon.characterise(recording, models=["WN"])).json
        self.assertEqual(self.daemon.finished(job["id"])["state"], "succeeded")
        rows = self.expect(200, self.daemon.get(f"/v1/recordings/{recording}/characterisation")).json["channels"]
        [channel] = [each["result"] for each in rows if (each["result"]["quantity"], each["result"]["axis"]) == ("angular_rate", "x")]
        return float(channel["equivalents"]["N"][0]["value"])

    def test_each_unit_of_an_upload_is_characterised_by_its_stream(self) -> None:
        log = dataflash()
        first = self.expect(201, self.daemon.upload(log, device="unit-1")).json
        self.assertIn("imu2_gyro_x (rad/s)", [column["name"] for column in first["columns"]])
        self.assertTrue(any("State another one as `stream`" in note for note in first["file"]["notes"]), first["file"]["notes"])
        third = self.expect(201, self.daemon.upload(log, device="unit-3", stream="imu3")).json
        self.assertEqual(third["metadata"]["stream"], "imu3")
        one, three = self.density(first["id"]), self.density(third["id"])
        self.assertAlmostEqual(three / one, SIGMA[2] / SIGMA[0], delta=0.05 * SIGMA[2] / SIGMA[0])
        second = self.expect(200, self.daemon.request("PATCH", f"/v1/recordings/{first['id']}", {"stream": "imu2"}, {"If-Match": "*"})).json
        self.assertEqual(second["metadata"]["stream"], "imu2")
        self.assertAlmostEqual(self.density(first["id"]) / one, SIGMA[1] / SIGMA[0], delta=0.05 * SIGMA[1] / SIGMA[0])

    def test_a_stream_that_is_not_there_is_refused_and_nothing_kept(self) -> None:
        log = dataflash()
        problem = self.problem(422, "unknown_column", self.daemon.upload(log, device="unit-9", stream="imu9"))
        self.assertIn("'imu9'", str(problem["detail"]))
        self.problem(400, "invalid_argument", self.daemon.upload(log, device="unit-9", stream="imu2", columns="gyro_x (rad/s)=angular_rate:x:rad/s"))
        self.problem(404, "not_found", self.daemon.get("/v1/devices/unit-9"))

    def test_the_command_line_reads_the_same_unit_here_and_there(self) -> None:
        with tempfile.TemporaryDirectory(prefix="driftlab-test-") as folder:
            Path(folder, "flight.bin").write_bytes(dataflash())

            def result(*further: str) -> dict[str, Any]:
                done = subprocess.run([os.environ["DRIFTLAB"], "characterise", "flight.bin", "--stream", "imu2", "--models", "WN", "--json", *further],
                                      cwd=folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                return dict(json.loads(done.stdout))
            here = result()
            there = result("--server", f"http://127.0.0.1:{self.daemon.port}", "--device", "flight")
            self.assertEqual(here["recordings"][0]["channels"], there["recordings"][0]["channels"])


if __name__ == "__main__":
    unittest.main()
