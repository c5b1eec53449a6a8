#!/usr/bin/env python3
"""Writes the studies of tests/hidden/REAL.md: real recordings with their references, as `driftlab investigate` takes them.

usage: studies.py SHARED OUTPUT      (SHARED holds the recordings; OUTPUT is made anew and never belongs in the repository)

NumPy alone; h5py for the one HDF5 recording, which is left out loudly without it.
"""
from __future__ import annotations

import json
import lzma
import struct
import sys
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
KINDS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}


def elements(content: bytes) -> Iterator[tuple[int, bytes]]:
    """The data elements of a MATLAB 5 file or of one of its matrices."""
    at = 0
    while at + 8 <= len(content):
        kind, size = struct.unpack_from("<II", content, at)
        if kind >> 16:  # a small element: size and kind share a word
            yield kind & 0xFFFF, content[at + 4:at + 4 + (kind >> 16)]
            at += 8
            continue
        yield kind, content[at + 8:at + 8 + size]
        at += 8 + size + (-size % 8 if kind != 15 else 0)


def matlab(path: Path) -> dict[str, Array]:
    """The real numeric arrays of a MATLAB 5 file by name; anything else is passed over."""
    arrays: dict[str, Array] = {}
    for kind, content in elements(path.read_bytes()[128:]):
        if kind == 15:
            kind, content = next(elements(zlib.decompress(content)))
        parts = list(elements(content)) if kind == 14 else []
        if len(parts) < 4 or not 6 <= parts[0][1][0] <= 15 or parts[3][0] not in KINDS:
            continue
        shape = np.frombuffer(parts[1][1], "<i4")
        values = np.frombuffer(parts[3][1], "<" + KINDS[parts[3][0]]).astype(float)
        if values.size == np.prod(shape):
            arrays[parts[2][1].decode()] = values.reshape(shape, order="F")
    return arrays


def body_rates(quaternion: Array, dt: float, smooth: int) -> Array:
    """Angular rate in deg/s (N x 3) of the rotation w, x, y, z, by differences over `smooth` samples either side."""
    q = quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)
    earlier = q[np.maximum(np.arange(len(q)) - smooth, 0)]
    later = q[np.minimum(np.arange(len(q)) + smooth, len(q) - 1)]
    w0, v0, w1, v1 = earlier[:, :1], earlier[:, 1:], later[:, :1], later[:, 1:]
    scalar = (w0 * w1 + np.sum(v0 * v1, axis=1, keepdims=True))
    vector = w0 * v1 - w1 * v0 - np.cross(v0, v1)
    vector *= np.where(scalar < 0.0, -1.0, 1.0)
    return np.degrees(2.0 * vector / (2.0 * smooth * dt))


class Studies:
    def __init__(self, output: Path) -> None:
        self.output = output

    def write(self, name: str, imu: str, recordings: list[dict[str, Any]]) -> None:
        folder = self.output / name
        folder.mkdir(parents=True)
        listed = []
        for recording in recordings:
            columns: dict[str, tuple[Array, str, str, str]] = recording.pop("data")
            table = np.column_stack([values for values, *_ in columns.values()])
            np.save(folder / f"{recording['id']}.npy", table)
            roles = {}
            for number, (_, quantity, axis, unit) in enumerate(columns.values()):
                roles[str(number)] = {"quantity": quantity, "unit": unit, **({"axis": axis} if axis else {})}
            listed.append({**recording, "file": f"{recording['id']}.npy", "columns": roles})
        study = {"device": {"id": name, "imu": imu}, "recordings": listed, "baseline": {"kind": "auto"}}
        (folder / "study.json").write_text(json.dumps(study, indent=1))
        print(folder / "study.json")


def gyro(values: Array, unit: str = "deg/s") -> dict[str, tuple[Array, str, str, str]]:
    return {f"g{a}": (values[:, k], "angular_rate", a, unit) for k, a in enumerate("xyz")}


def adis(shared: Path, out: Studies) -> None:
    for number in (1, 2, 3):
        with lzma.open(shared / f"adis_16405_imu{number}.npy.xz") as file:
            table = np.load(file)  # type: ignore[no-untyped-call]
        pieces = [{"id": f"at-{start // 100}s", "rate_hz": 100.0, "condition": {"kind": "static"},
                   "data": gyro(table[start:start + 60000, :3])} for start in (0, 300000, 600000, 900000)]
        out.write(f"adis-imu{number}", "ADIS16405", pieces)


def turntable(shared: Path, out: Studies) -> None:
    for name, axis, sign in (("roll_slow", "x", 1.0), ("yaw_medium", "z", -1.0)):
        m = {key: value.ravel() for key, value in matlab(shared / f"mpu6050-turntable-encoder/raw_{name}.mat").items()}
        start = int(m["data_line"][0])
        time = {"t": (m["all_time"][start:] - m["all_time"][start], "time", "", "s")}
        moving = {f"g{axis}": (m[f"all_gyro_2_{axis}"][start:], "angular_rate", axis, "deg/s"),
                  f"e{axis}": (sign * m["all_encoder"][start:], "reference_angle", axis, "deg")}
        base = gyro(np.column_stack([m[f"all_gyro_1_{a}"][start:] for a in "xyz"]))
        out.write(f"turntable-{name}", "MPU-6050", [{"id": "shaft", "condition": {"kind": "profile"}, "data": {**time, **moving}}])
        out.write(f"turntable-{name}-base", "MPU-6050", [{"id": "base", "condition": {"kind": "static"}, "data": {**time, **base}}])


def warm(shared: Path, out: Studies) -> None:
    try:
        import h5py
    except ImportError:
        print("LEFT OUT: mpu6050-static-10min-temp is HDF5, and h5py is not there", file=sys.stderr)
        return

    def read(name: str) -> Array:
        folder = shared / "mpu6050-static-10min-temp/set-2__unmoved-with-x-pointing-forward-10min"
        with h5py.File(folder / f"mpu6050_{name}.mat") as file:
            found: list[Array] = []
            file.visititems(lambda _, item: found.append(np.array(item)) if isinstance(item, h5py.Dataset) and item.size > 1000 else None)
            table = found[0]
            return table.T if table.shape[0] < table.shape[1] else table
    rates, heat = read("gyroscope"), read("temperature")
    host = rates[:, 0] - rates[0, 0]
    data = {**gyro(rates[:, 1:4]), "temp": (np.interp(rates[:, 0], heat[:, 0], heat[:, 1]), "temperature", "", "degC")}
    rate = (len(host) - 1) / host[-1]
    out.write("static-warm", "MPU-6050", [{"id": "even", "rate_hz": rate, "condition": {"kind": "static"}, "data": data}])
    out.write("static-warm-stamps", "MPU-6050", [{"id": "stamped", "condition": {"kind": "static"}, "data": {"t": (host, "time", "", "s"), **data}}])


def robot(shared: Path, out: Studies) -> None:
    for name, file in (("mpu6500", "V_300_Sequencia3_MPU6500RM3100"), ("mpu9150", "V1000_Sequencia1_MPU9150")):
        m = matlab(shared / f"robot-arm-abb/{file}.mat")
        sound = np.isfinite(m["SENSgyro"]).all(axis=0)
        rates = m["SENSgyro"][:, sound].T
        time = m["MATLABtime"].ravel()[sound]
        quaternion = m["ABBquaternion"][:, sound].T
        dt = (time[-1] - time[0]) / (len(time) - 1)
        reference = -body_rates(quaternion, dt, 8)  # the robot states the rotation from the tool to its base
        data = {**gyro(rates), **{f"r{a}": (reference[:, k], "reference_angular_rate", a, "deg/s") for k, a in enumerate("xyz")}}
        out.write(f"robot-{name}", name, [{"id": "arm", "rate_hz": 1.0 / dt, "condition": {"kind": "profile"}, "data": data}])


def headings(shared: Path, out: Studies) -> None:
    recordings = []
    for heading in ("000", "090", "180", "270"):
        words = (shared / f"cxd5602pwbimu-8heading/log_imu_{heading}deg.txt").read_text().split()
        rows = [[int(word, 16) for word in row.split(",")[:8]] for row in words if row.count(",") >= 7]
        table = np.array(rows, dtype=np.uint32)
        values = np.ascontiguousarray(table[:, 1:]).view(np.float32).astype(float)
        ticks = np.cumsum(np.diff(table[:, 0].astype(np.int64), prepend=int(table[0, 0])) % 2**32) / 19.2e6
        longest = np.split(np.arange(len(ticks)), np.flatnonzero(np.diff(ticks) > 0.25) + 1)
        keep = max(longest, key=len)
        rate = (len(keep) - 1) / (ticks[keep[-1]] - ticks[keep[0]])
        data = {**gyro(values[keep, 1:4], "rad/s"), "temp": (values[keep, 0], "temperature", "", "degC")}
        condition = {"kind": "static", "heading_deg": float(heading)}
        recordings.append({"id": f"heading-{heading}", "rate_hz": rate, "condition": condition, "data": data})
    common = float(np.mean([r["rate_hz"] for r in recordings]))
    out.write("headings", "CXD5602PWBIMU", [{**r, "rate_hz": common} for r in recordings])


def broad(shared: Path, out: Studies) -> None:
    for name, file in (("slow", "02_undisturbed_slow_rotation_B"), ("phone", "26_disturbed_phone_vibration_A")):
        m = matlab(shared / f"broad-optical-reference/{file}.mat")
        rate = float(m["sampling_rate"].ravel()[0])
        quaternion = m["opt_quat"]
        seen = np.isfinite(quaternion).all(axis=1)
        index = np.arange(len(quaternion))
        for k in range(4):
            quaternion[:, k] = np.interp(index, index[seen], quaternion[seen, k])
        reference = body_rates(quaternion, 1.0 / rate, 3)
        data = {**gyro(m["imu_gyr"], "rad/s"), **{f"r{a}": (reference[:, k], "reference_angular_rate", a, "deg/s") for k, a in enumerate("xyz")}}
        out.write(f"broad-{name}", "BROAD", [{"id": "hand", "rate_hz": rate, "condition": {"kind": "profile"}, "data": data}])


if __name__ == "__main__":
    source, target = Path(sys.argv[1]), Studies(Path(sys.argv[2]))
    for make in (adis, turntable, warm, robot, headings, broad):
        make(source, target)
