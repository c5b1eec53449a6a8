"""What `driftlab simulate --scenario` writes: the inertial unit, the fixes and the truth of one run, as CSV and as NumPy files."""
from __future__ import annotations

import array
import ast
import csv
import json
import os
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

PROGRAM = os.environ["DRIFTLAB"]
PATIENCE_S = 120

SCENARIO: dict[str, Any] = {
    "name": "export", "duration_s": 45, "imu_rate_hz": 20, "gnss_rate_hz": 1,
    "trajectory": {"start": {"speed_m_s": 15, "heading_deg": 90, "latitude_deg": 45, "longitude_deg": 8, "height_m": 200},
                   "segments_by_start_time": [{"t_s": 30, "kind": "turn", "rate_deg_s": 9, "duration_s": 10}]},
    "outages": [{"start_s": 30, "duration_s": 10}],
    "truth": {"gyro": {"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}]},
              "accelerometer": {"white_noise_mg_per_sqrt_hz": 2, "constant_bias_sd_mg": 10}},
    "gnss": {"position_sd_m": [2, 3, 4], "velocity_sd_m_s": [0.1, 0.2, 0.3], "latency_s": 0.25},
    "filters": [{"name": "matched"}],
}
IMU = ["t [s]", "gx [deg/s]", "gy [deg/s]", "gz [deg/s]", "fx [m/s^2]", "fy [m/s^2]", "fz [m/s^2]"]
GNSS = ["t [s]", "validity [s]", "lat [deg]", "lon [deg]", "height [m]", "vn [m/s]", "ve [m/s]", "vd [m/s]",
        "sn [m]", "se [m]", "sd [m]", "svn [m/s]", "sve [m/s]", "svd [m/s]"]
TRUTH = ["t [s]", "lat [deg]", "lon [deg]", "height [m]", "vn [m/s]", "ve [m/s]", "vd [m/s]", "roll [deg]", "pitch [deg]", "yaw [deg]"]


def read_csv(path: Path) -> tuple[str, list[str], list[list[float]]]:
    """Comment, header, rows."""
    with path.open(encoding="utf-8", newline="") as file:
        comment = file.readline().rstrip("\n")
        rows = list(csv.reader(file))
    return comment, rows[0], [[float(cell) for cell in row] for row in rows[1:]]


def read_npy(path: Path) -> tuple[dict[str, Any], list[list[float]]]:
    """Header and rows of a NumPy file, by its specification."""
    content = path.read_bytes()
    if content[:8] != b"\x93NUMPY\x01\x00":
        raise AssertionError(f"{path.name} is no NumPy file of version 1.0")
    (length,) = struct.unpack("<H", content[8:10])
    header = ast.literal_eval(content[10:10 + length].decode("latin-1"))
    values = array.array("d", content[10 + length:])
    width = header["shape"][1]
    return header, [list(values[i:i + width]) for i in range(0, len(values), width)]


class Export(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-test-")))
        (cls.folder / "scenario.json").write_text(json.dumps(SCENARIO), encoding="utf-8")
        for kind in ("csv", "npy"):
            cls.simulate(kind, "7")

    @classmethod
    def simulate(cls, kind: str, seed: str, name: str = "") -> None:
        words = [PROGRAM, "simulate", "--scenario", "scenario.json", "--seed", seed, "--run", "2", "--out", f"{name}imu.{kind}",
                 "--gnss", f"{name}gnss.{kind}", "--truth", f"{name}truth.{kind}"]
        subprocess.run(words, cwd=cls.folder, check=True, timeout=PATIENCE_S)

    def both(self, name: str, columns: list[str], rows: int, decimals: list[int]) -> list[list[float]]:
        """The rows, equal in both files up to the decimals of the CSV."""
        comment, header, written = read_csv(self.folder / f"{name}.csv")
        self.assertTrue(comment.startswith("# Simulated by driftlab"), comment)
        self.assertIn("run 2, seed 7", comment)
        self.assertEqual(header, columns)
        shape, values = read_npy(self.folder / f"{name}.npy")
        self.assertEqual(shape, {"descr": "<f8", "fortran_order": False, "shape": (rows, len(columns))})
        self.assertEqual(len(written), rows)
        for text, exact in zip(written, values, strict=True):
            for column, places in enumerate(decimals):
                self.assertAlmostEqual(text[column], exact[column], delta=0.5000001 * 10 ** -places, msg=columns[column])
        return values

    def test_the_inertial_unit_has_a_row_for_every_sample(self) -> None:
        rows = self.both("imu", IMU, 900, [6] + 6 * [9])
        self.assertEqual(rows[0][0], 0.05, "the mean over the interval that ends then")
        self.assertAlmostEqual(rows[-1][0], 45, places=9)
        # Gravity at 45 deg is 9.806 m/s^2; white noise of 2 mg/sqrt(Hz) at 20 Hz and a bias of 10 mg: six standard deviations.
        self.assertAlmostEqual(rows[0][6], -9.806, delta=6 * (0.02 * 20 ** 0.5 / 2 ** 0.5 + 0.1))
        turning = [row[3] for row in rows if 32 < row[0] < 39]
        self.assertAlmostEqual(sum(turning) / len(turning), 9, delta=0.1)
        self.assertLess(abs(sum(row[3] for row in rows[:500]) / 500), 0.1)

    def test_fixes_say_when_they_arrive_what_they_describe_and_how_well(self) -> None:
        rows = self.both("gnss", GNSS, 34, [6, 6, 10, 10, 4, 5, 5, 5, 3, 3, 3, 4, 4, 4])
        self.assertAlmostEqual(rows[0][0] - rows[0][1], 0.25, places=9)
        self.assertEqual(rows[0][8:], [2, 3, 4, 0.1, 0.2, 0.3])
        self.assertFalse([row for row in rows if 30 <= row[0] < 40], "no fix arrives during the outage")
        # Eastwards at 15 m/s; five standard deviations.
        self.assertAlmostEqual(rows[0][6], 15, delta=1.0)
        self.assertAlmostEqual(rows[0][2], 45, delta=5 * 2 / 111e3)
        self.assertAlmostEqual(rows[0][4], 200, delta=5 * 4)

    def test_the_truth_has_the_start_and_every_sample(self) -> None:
        rows = self.both("truth", TRUTH, 901, [6, 11, 11, 5, 6, 6, 6, 7, 7, 7])
        for found, exact in zip(rows[0], [0, 45, 8, 200, 0, 15, 0, 0, 0, 90], strict=True):
            self.assertAlmostEqual(found, exact, places=6)
        self.assertAlmostEqual(abs(rows[-1][9]), 180, places=5, msg="a turn of 90 deg to the right")

    def test_the_same_seed_is_the_same_file_and_another_is_not(self) -> None:
        self.simulate("npy", "7", "again-")
        self.simulate("npy", "8", "other-")
        for name in ("imu", "gnss", "truth"):
            first, again, other = ((self.folder / f"{which}{name}.npy").read_bytes() for which in ("", "again-", "other-"))
            self.assertEqual(first, again)
            self.assertEqual(first == other, name == "truth", "the truth alone does not depend on the seed")


if __name__ == "__main__":
    unittest.main()
