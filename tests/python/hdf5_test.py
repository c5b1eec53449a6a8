"""HDF5 and MATLAB 7.3 files, written by h5py: read as the same numbers in CSV are, and by a process that a bad file breaks alone."""
from __future__ import annotations

import io
import json
import os
import subprocess
import tempfile
import time
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py  # type: ignore[import]
import numpy as np

import samples
from suite import DaemonTest

PROGRAM = os.environ["DRIFTLAB"]
ROWS = 2000


def written(fill: Callable[[Any], object], **options: object) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "made.h5"
        with h5py.File(path, "w", **options) as file:
            fill(file)
        return path.read_bytes()


def matlab(fill: Callable[[Any], object]) -> bytes:
    content = bytearray(written(fill, userblock_size=512))
    header = b"MATLAB 7.3 MAT-file, Platform: none".ljust(124) + b"\0\2IM"
    content[:len(header)] = header
    return bytes(content)


def noise(seed: int, columns: int = 3) -> Any:
    return np.random.default_rng(seed).normal(size=(ROWS, columns))


def as_csv(names: list[str], columns: Any) -> bytes:
    out = io.StringIO()
    out.write(",".join(names) + "\n")
    for row in columns:
        out.write(",".join(repr(float(v)) for v in row) + "\n")
    return out.getvalue().encode()


class Hdf5(DaemonTest):
    def figures(self, content: bytes, name: str) -> list[object]:
        """What driftlab says of a file's columns."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.write_bytes(content)
            columns = ",".join(f"gyr_{axis}=angular_rate:{axis}:deg/s" for axis in "xyz")
            ran = subprocess.run([PROGRAM, "characterise", path, "--rate-hz", "100", "--columns", columns, "--models", "WN", "--json"],
                                 capture_output=True, text=True, check=False)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            [recording] = json.loads(ran.stdout)["recordings"]
            return [channel["allan"] if "allan" in channel else channel for channel in recording["channels"]]

    def test_the_same_numbers_are_the_same_recording_in_every_form(self) -> None:
        gyr = noise(1)
        expected = self.figures(as_csv(["gyr_x", "gyr_y", "gyr_z"], gyr), "made.csv")
        forms = {"plain": written(lambda f: f.create_dataset("gyr", data=gyr)),
                 "compressed": written(lambda f: f.create_dataset("gyr", data=gyr, chunks=True, compression="gzip", shuffle=True,
                                                                  fletcher32=True)),
                 "big endian": written(lambda f: f.create_dataset("gyr", data=gyr.astype(">f8"))),
                 "across": written(lambda f: f.create_dataset("gyr", data=gyr.T)),
                 "newest": written(lambda f: f.create_dataset("gyr", data=gyr), libver="latest")}

        def of_matlab(file: Any) -> None:
            file.create_dataset("gyr", data=gyr.T).attrs["MATLAB_class"] = np.bytes_("double")
        forms["MATLAB"] = matlab(of_matlab)
        for name, content in forms.items():
            with self.subTest(form=name):
                self.assertEqual(self.figures(content, "made.h5"), expected)

    def test_groups_tables_and_what_is_no_number(self) -> None:
        def fill(file: Any) -> None:
            imu = file.create_group("imu")
            imu["acc"] = noise(2).astype("f4")
            imu["moving"] = np.arange(ROWS) % 2 == 0
            imu["image"] = np.zeros((4, 4, 4))
            imu["text"] = np.array([b"a", b"b"])
            table = np.zeros(ROWS, dtype=[("stamp", "f8"), ("gx", "f4"), ("name", "S4")])
            table["stamp"], table["gx"] = np.arange(ROWS) / 100, noise(3)[:, 0]
            file["log"] = table
            file["again"] = h5py.SoftLink("/imu/acc")
            file["elsewhere"] = h5py.ExternalLink("/etc/passwd", "/x")
        stored = self.expect(201, self.daemon.upload(written(fill), device="h5", rate_hz=100, columns="imu.acc_x=specific_force:x:m/s^2"))
        self.assertEqual(set(stored.json["file"]["columns"]), {"imu.acc_x", "imu.acc_y", "imu.acc_z", "imu.moving", "log.stamp", "log.gx"})
        notes = json.dumps(stored.json)
        self.assertEqual(stored.json["file"]["format"], "hdf5")
        for left_out in ("imu.image", "imu.text", "again", "elsewhere"):
            self.assertIn(left_out, notes)

    def test_a_file_that_breaks_the_reader_breaks_nothing_else(self) -> None:
        sound = written(lambda f: f.create_dataset("gyr", data=noise(4), chunks=True, compression="gzip"))
        bomb = written(lambda f: f.create_dataset("gyr", shape=(1 << 36,), chunks=(1 << 20,), dtype="f8", compression="gzip"))
        many = written(lambda f: f.create_dataset("gyr", shape=(60_000_000,), dtype="f8", chunks=(1 << 16,), compression="gzip"))
        cases = (("cut", sound[:len(sound) // 2], {"shape-mismatch"}), ("bomb", bomb, {"limit-exceeded"}),
                 ("many", many, {"limit-exceeded"}), ("empty", written(lambda f: None), {"no-samples"}),
                 ("scribbled", sound[:900] + bytes(range(256)) * 4 + sound[1924:], {"shape-mismatch", "no-samples", "limit-exceeded"}))
        for name, content, slugs in cases:
            with self.subTest(file=name):
                begun = time.monotonic()
                answer = self.daemon.upload(content, device="broken", rate_hz=100)
                self.assertIn(answer.status, (413, 422), answer.describe())
                self.assertIn(answer.json["type"].removeprefix("/problems/"), slugs, answer.describe())
                self.assertTrue(answer.json["detail"].endswith("."))
                self.assertLess(time.monotonic() - begun, 30.0)
        self.expect(201, self.daemon.upload(sound, device="whole", rate_hz=100, columns="gyr_x=angular_rate:x:deg/s"))
        self.expect(201, self.daemon.upload(samples.gyro_csv(seed=9), device="whole", rate_hz=100, columns=samples.GYRO_Z))


if __name__ == "__main__":
    unittest.main()
