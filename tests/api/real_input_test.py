"""A real recording through the daemon: 10^6 x 6 samples of a static ADIS16405, held to an independent Allan deviation.

The recording may not be committed; it is looked for in $DRIFTLAB_SHARED (default ../shared beside the repository).
"""
from __future__ import annotations

import json
import os
import sys
import time
import unittest
from pathlib import Path

from suite import SKIPPED, DaemonTest

SHARED = Path(os.environ.get("DRIFTLAB_SHARED") or Path(__file__).resolve().parents[3] / "shared")
RECORDING = SHARED / "data/adis_16405_imu1.npy.xz"
REFERENCE = Path(__file__).resolve().parents[1] / "data/reference/adis_16405_imu1.oadev.json"
AXES = ("gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z")


class Adis16405(DaemonTest):
    def test_allan_deviation_equals_the_reference(self) -> None:
        columns = ",".join(f"{i}={'angular_rate' if name.startswith('gyro') else 'specific_force'}:{name[-1]}:{'deg/s' if name.startswith('gyro') else 'g'}"
                           for i, name in enumerate(AXES))
        recording = self.expect(201, self.daemon.upload(RECORDING.read_bytes(), device="adis16405", rate_hz=100, columns=columns)).json
        self.assertEqual((recording["file"]["rows"], recording["file"]["compression"]), (1_000_000, "xz"))
        started = time.monotonic()
        job = self.daemon.finished(self.expect(202, self.daemon.characterise(recording["id"])).json["id"])
        took = time.monotonic() - started
        print(f"the job took {took:.1f} s")
        self.assertEqual(job["state"], "succeeded", job)
        if not os.environ.get("DRIFTLAB_SANITIZE"):
            self.assertLess(took, 60.0, "a job of 10^6 x 6 samples takes seconds")
        [found] = self.daemon.get(job["result"]["href"]).json["recordings"]
        reference = json.loads(REFERENCE.read_text("utf-8"))["axes"]
        self.assertEqual([channel["channel"] for channel in found["channels"]], [str(i) for i in range(6)])
        worst = 0.0
        for name, channel in zip(AXES, found["channels"]):
            allan = dict(zip((round(tau * 100) for tau in channel["allan"]["tau_s"]), channel["allan"]["deviation"]))
            self.assertGreaterEqual(set(allan), set(reference[name]["m"]), name)
            for m, wanted in zip(reference[name]["m"], reference[name]["oadev"]):
                worst = max(worst, abs(allan[m] / wanted - 1))
        print(f"largest relative difference of {len(AXES)} channels: {worst:.2e}")
        self.assertLess(worst, 1e-9)
        for axis in "xyz":
            for sensor, method in (("gyroscope", "gmwm"), ("gyroscope", "av"), ("accelerometer", "gmwm")):
                table = self.expect(200, self.daemon.get(f"/v1/parameter-tables?device=adis16405&sensor={sensor}&axis={axis}&method={method}"))
                self.assertTrue(any(cell for cell in table.json["rows"][0]["values"].values()), table.text)


if __name__ == "__main__":
    if not RECORDING.is_file():
        print(f"SKIPPED: the real recording adis_16405_imu1, for it is not in {SHARED} (set DRIFTLAB_SHARED)")
        sys.exit(SKIPPED)
    unittest.main()
