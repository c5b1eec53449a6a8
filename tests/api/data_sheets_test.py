"""Data sheets: `driftlab datasheet`, /v1/data-sheets, measured against stated in the table, and units that cannot be."""
from __future__ import annotations

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
N = 0.005 / 2 ** 0.5  # of an MPU-6050, two-sided [deg/s/sqrt(Hz)]


def still_imu(rate_unit: str, force_unit: str, rate_factor: float = 1.0, gravity: float = 1.0) -> bytes:
    """60 s of an MPU-6050 at rest at 100 Hz: one sample of white noise is N/sqrt(dt)."""
    source = random.Random(20)
    head = ",".join([f"g{axis} [{rate_unit}]" for axis in "xyz"] + [f"a{axis} [{force_unit}]" for axis in "xyz"])
    rows = [",".join([f"{source.gauss(0.2, N * 10) * rate_factor:.7g}" for _ in range(3)] +
                     [f"{source.gauss(level, 0.003) * gravity:.7g}" for level in (0.6, 0.0, -0.8)]) for _ in range(6000)]
    return "\n".join([head, *rows, ""]).encode()


class DataSheets(DaemonTest):
    def driftlab(self, *arguments: str, folder: str | None = None) -> subprocess.CompletedProcess[str]:
        return subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)

    def test_command_and_daemon_give_the_same_sheet(self) -> None:
        listed = self.expect(200, self.daemon.get("/v1/data-sheets")).json["items"]
        document = json.loads(self.driftlab("datasheet", "--json").stdout)
        self.assertEqual(document["items"], listed)
        for sheet in listed:
            self.assertEqual(json.loads(self.driftlab("datasheet", sheet["name"], "--json").stdout), sheet)
        self.assertEqual([sheet["name"] for sheet in self.daemon.get("/v1/data-sheets?model=mpu%206050%20board").json["items"]], ["MPU-6050"])
        self.assertEqual(self.daemon.get("/v1/data-sheets?model=nothing").json["items"], [])
        text = self.driftlab("datasheet", "gy-521 with MPU6050").stdout
        for part in ("PS-MPU-6000A-00, revision 3.4", "0.00500 deg/s/sqrt(Hz)", "section 6.1", "N compares with"):
            self.assertIn(part, text)
        unknown = self.driftlab("datasheet", "HG1700")
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("Known are MPU-6050", unknown.stderr)

    def test_table_says_measured_against_stated(self) -> None:
        self.expect(201, self.daemon.post("/v1/devices", {"name": "bench-1", "imu": "MPU-6050"}))
        recording = self.expect(201, self.daemon.upload(still_imu("deg/s", "g"), device="bench-1", rate_hz=100)).json
        self.assertEqual([note for note in recording["quality"]["notes"] if "look" in note], [])
        self.daemon.finished(self.expect(202, self.daemon.characterise(recording["id"])).json["id"])
        table = self.expect(200, self.daemon.get("/v1/parameter-tables?device=bench-1&axis=z")).json
        sheet = table["data_sheet"]
        self.assertEqual(sheet["sensor"], "MPU-6050")
        self.assertEqual(sheet["figures"][0]["verdict"], "agrees")
        self.assertLess(abs(sheet["figures"][0]["ratio"] - 1), 0.1)  # the noise was simulated so
        self.assertTrue(any("of its data sheet" in detail for detail in table["summary"]["details"]))
        address = "/v1/parameter-tables?device=bench-1&axis=z"
        for media in ("text/plain", "text/markdown", "text/csv"):
            self.assertIn("data sheet", self.daemon.get(address, Accept=media).body.decode())
        with tempfile.TemporaryDirectory(prefix="driftlab-test-") as folder:
            Path(folder, "bench.csv").write_bytes(still_imu("deg/s", "g"))
            flags = ("bench.csv", "--rate-hz", "100", "--device", "bench MPU-6050")
            text = self.driftlab("characterise", *flags, folder=folder).stdout
            self.assertIn("times the 0.212 deg/sqrt(h) of its data sheet", text)
            self.assertIn("data sheet", self.driftlab("report", *flags, folder=folder).stdout)

    def test_units_that_cannot_be_are_told_at_upload_and_by_the_command(self) -> None:
        self.expect(201, self.daemon.post("/v1/devices", {"name": "bench-2", "imu": "InvenSense MPU6050"}))
        data = still_imu("rad/s", "g", gravity=9.81)  # deg/s and m/s^2 in truth
        recording = self.expect(201, self.daemon.upload(data, device="bench-2", rate_hz=100)).json
        notes = " ".join(recording["quality"]["notes"])
        for part in ("column 'gz", "looks like deg/s, not rad/s", "MPU-6050", "these columns look like m/s^2"):
            self.assertIn(part, notes)
        right = {axis: {"quantity": "angular_rate", "axis": axis[1], "unit": "deg/s"} for axis in ("gx", "gy", "gz")}
        names = {f"{column} [rad/s]": role for column, role in right.items()}
        answer = self.daemon.request("PATCH", f"/v1/recordings/{recording['id']}", json.dumps({"columns": names}).encode(),
                                     {"Content-Type": "application/json", "If-Match": self.daemon.get(f"/v1/recordings/{recording['id']}").headers["etag"]})
        self.assertNotIn("looks like", " ".join(self.expect(200, answer).json["quality"]["notes"]))
        with tempfile.TemporaryDirectory(prefix="driftlab-test-") as folder:
            Path(folder, "bench.csv").write_bytes(data)
            text = self.driftlab("characterise", "bench.csv", "--rate-hz", "100", "--device", "MPU-6050", folder=folder).stdout
            self.assertIn("looks like deg/s, not rad/s", text)


if __name__ == "__main__":
    unittest.main()
