#!/usr/bin/env python3
"""Measures the constants of core/campaign/regression/measured_constants.hpp again, on recorded sessions of one kind of sensor.

usage: session_scatter.py SHARED      (the folder that holds data/; default $DRIFTLAB_SHARED or ../shared)

NumPy alone, none of driftlab's code. Each recording of the ADIS16405 is a session. Prints what a session adds to the logarithm of
an Allan deviation, by its three parts (device, axis, scale), and how far neighbouring octaves move together.
"""
from __future__ import annotations

import io
import lzma
import os
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
RATE_HZ = 100.0
OCTAVES = 7  # tau of 0.01 to 0.64 s: every margin up to 1 s
SENSORS = (("gyroscope", slice(0, 3)), ("accelerometer", slice(3, 6)))


def ln_deviations(x: Array) -> Array:
    """ln of the Allan deviation at tau = 2^j dt."""
    found = []
    total = np.concatenate([[0.0], np.cumsum(x - x.mean())])
    for octave in range(OCTAVES):
        m = 2 ** octave
        d = (total[2 * m:] - 2.0 * total[m:-m] + total[:-2 * m]) / m
        found.append(0.5 * np.log(0.5 * float(np.mean(d * d))))
    return np.array(found)


def main(shared: Path) -> None:
    files = sorted((shared / "data").glob("adis_16405_imu*.npy.xz"))
    tables = [np.load(io.BytesIO(lzma.open(file).read())) for file in files]
    print(f"{len(files)} sessions of {min(len(t) for t in tables) / RATE_HZ / 3600.0:.1f} h and more, tau of 0.01 to {0.01 * 2 ** (OCTAVES - 1):g} s")
    for sensor, columns in SENSORS:
        curves = np.array([[ln_deviations(np.asarray(t[:, axis], dtype=float)) for axis in range(*columns.indices(6))] for t in tables])
        moved = curves - curves.mean(axis=0)  # session x axis x octave
        free = (len(files) - 1) / len(files)
        device = moved.mean(axis=(1, 2))
        axis = moved.mean(axis=2) - device[:, None]
        scale = moved - moved.mean(axis=2, keepdims=True)
        parts = [float(np.sqrt(np.mean(p ** 2) / free)) for p in (device, axis, scale)]
        print(f"{sensor}: device {100.0 * parts[0]:.2f} %, axis {100.0 * parts[1]:.2f} %, scale {100.0 * parts[2]:.2f} %; "
              f"together {100.0 * float(np.sqrt(np.mean(moved ** 2) / free)):.2f} % of a deviation")
        by_distance = [float(np.mean(scale[:, :, k:] * scale[:, :, : OCTAVES - k]) / np.mean(scale ** 2)) for k in range(1, 4)]
        print("  correlation of the scale's part with that 1, 2, 3 octaves on: " + ", ".join(f"{r:+.2f}" for r in by_distance))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else os.environ.get("DRIFTLAB_SHARED", "../shared")))
