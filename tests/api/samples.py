"""Recordings made up for the tests: seeded white noise in every container the daemon reads. Standard library only."""
from __future__ import annotations

import array
import gzip
import json
import lzma
import math
import random
import struct
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

CORRECTION = {"reading_unit": "rad/s", "bias": [0.01, 0, 0], "correction": [[1.01, 0, 0], [0, 1, 0], [0, 0, 1]]}  # of a calibration
WHITE_NOISE = {"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}  # of a model


def noise(samples: int, columns: int = 1, seed: int = 1) -> list[list[float]]:
    """Columns of white noise whose values a decimal of six digits holds exactly."""
    generator = random.Random(seed)
    return [[round(generator.gauss(0.0, 1.0), 6) for _ in range(samples)] for _ in range(columns)]


def csv(columns: Sequence[Sequence[float]], names: Sequence[str] | None = None) -> bytes:
    """A header and rows; repr gives a double back bit for bit."""
    lines = [",".join(names or [f"c{i}" for i in range(len(columns))])]
    lines += [",".join(repr(value) for value in row) for row in zip(*columns)]
    return ("\n".join(lines) + "\n").encode()


def stamped_csv(rows: int, column: str = "gz [deg/s]") -> bytes:
    """A column of time at 100 Hz and one of numbers that repeat after 101 rows: large at little cost."""
    return (f"t [s],{column}\n" + "".join(f"{i / 100:.2f},{(i * 7919) % 101 / 100:.2f}\n" for i in range(rows))).encode()


def npy(columns: Sequence[Sequence[float]], *, shape: str | None = None, kind: str = "<f8", flat: bool = False) -> bytes:
    """Version 1.0 of the format, rows by columns in C order; `shape` lets the header lie."""
    rows = len(columns[0])
    honest = f"({rows},)" if flat else f"({rows}, {len(columns)})"
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape or honest}, }}".encode()
    header += b" " * (63 - (10 + len(header)) % 64) + b"\n"
    values = array.array("f" if kind == "<f4" else "d", columns[0] if len(columns) == 1 else (value for row in zip(*columns) for value in row))
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + values.tobytes()


def zstd(content: bytes) -> bytes:
    return subprocess.run(["zstd", "-q", "-c"], input=content, capture_output=True, check=True).stdout


COMPRESSIONS: dict[str, Callable[[bytes], bytes]] = {
    "none": lambda content: content,
    "gzip": lambda content: gzip.compress(content, 6, mtime=0),
    "xz": lzma.compress,
    "zstd": zstd,
}

GYRO_Z = "gz=angular_rate:z:deg/s"


def gyro_csv(samples: int = 512, seed: int = 1) -> bytes:
    """One gyroscope channel called gz."""
    return csv(noise(samples, 1, seed), ["gz"])


DRIVE_IMU = {"t": {"quantity": "time", "unit": "s"},
             **{f"g{axis}": {"quantity": "angular_rate", "axis": axis, "unit": "rad/s"} for axis in "xyz"},
             **{f"a{axis}": {"quantity": "specific_force", "axis": axis, "unit": "m/s^2"} for axis in "xyz"}}
DRIVE_GNSS = {"t": {"quantity": "time", "unit": "s"}, "lat": {"quantity": "gnss_position", "axis": "lat", "unit": "deg"},
              "lon": {"quantity": "gnss_position", "axis": "lon", "unit": "deg"}, "height": {"quantity": "gnss_position", "axis": "height", "unit": "m"},
              **{f"v{axis[0]}": {"quantity": "gnss_velocity", "axis": axis, "unit": "m/s"} for axis in ("north", "east", "down")}}


def roles(columns: dict[str, Any]) -> str:
    """Columns as the query of an upload names them."""
    return ",".join(f"{name}={role['quantity']}:{role.get('axis', '')}:{role['unit']}" for name, role in columns.items())


def drive_csvs(seconds: int = 200, seed: int = 5) -> tuple[bytes, bytes]:
    """A car that drives north, faster and slower, from rest: readings at 20 Hz and fixes at 1 Hz."""
    random_ = random.Random(seed)
    readings, fixes = [], []
    speed = north = 0.0
    step = 0.05
    for i in range(seconds * 20):
        time = step * (i + 1)
        acceleration = 0.0 if time < 10 else 1.0 if time < 20 else 0.6 * math.sin(0.2 * (time - 20))
        speed += step * acceleration
        north += step * speed
        noise = [random_.gauss(0, 1) for _ in range(6)]
        readings.append([time, *(1e-3 * n for n in noise[:3]), acceleration + 0.01 * noise[3], 0.01 * noise[4], -9.81 + 0.01 * noise[5]])
        if (i + 1) % 20 == 0:
            blur = [random_.gauss(0, 1) for _ in range(3)]
            fixes.append([time, 48.0 + math.degrees((north + blur[0]) / 6366000.0), 9.0 + math.degrees(blur[1] / 4260000.0), 300.0,
                          speed + 0.05 * blur[2], 0.05 * random_.gauss(0, 1), 0.05 * random_.gauss(0, 1)])
    return csv(list(zip(*readings)), list(DRIVE_IMU)), csv(list(zip(*fixes)), list(DRIVE_GNSS))


def drive_document(imu: str, gnss: str) -> dict[str, Any]:
    """The drive of `drive_csvs`, stored as two recordings."""
    def columns(of: dict[str, Any]) -> dict[str, Any]:
        return {name: role for name, role in of.items() if name != "t"}
    time = {"column": "t", "unit": "s", "scale": "gps"}
    white = {"gyroscope": {"processes": [{"process": "white_noise", "params": {"N": {"value": 1.0, "unit": "deg/sqrt(h)"}}}], "constant_bias_sd_deg_s": 0.1},
             "accelerometer": {"processes": [{"process": "white_noise", "params": {"N": {"value": 0.2, "unit": "m/s/sqrt(h)"}}}], "constant_bias_sd_mg": 5}}
    return {"id": "north", "vehicle": "road", "imu": {"recording": imu, "columns": columns(DRIVE_IMU), "time": time},
            "gnss": {"recording": gnss, "columns": columns(DRIVE_GNSS), "time": dict(time), "position_sd_m": [1, 1, 2], "velocity_sd_m_s": [0.05, 0.05, 0.05]},
            "model": white, "outages": {"duration_s": [10], "every_s": [40], "phases": 2, "settle_s": 20}}


def clip(path: Path) -> None:
    """Values of a simulated file beyond 0.2 become 0.2: a sensor at full scale."""
    lines = path.read_text().splitlines()
    clipped = [line if "#" in line or "[" in line else f"{max(-0.2, min(0.2, float(line))):.6f}" for line in lines]
    path.write_text("\n".join(clipped) + "\n")


def clipped_study(folder: Path) -> None:
    """`study.json` in `folder` of its simulated 1.csv and 6.csv (gz [deg/s], 100 Hz); the second is clipped first."""
    clip(folder / "6.csv")
    role = {"gz [deg/s]": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}
    recordings = [{"id": f"static-{seed}", "file": f"{seed}.csv", "condition": {"kind": "static"}, "rate_hz": 100, "columns": role} for seed in (1, 6)]
    (folder / "study.json").write_text(json.dumps({"device": {"id": "d"}, "recordings": recordings, "baseline": {"kind": "auto"}}))
