#!/usr/bin/env python3
"""Measures on recorded sessions what the constants of core/campaign/regression/measured_constants.hpp stand for.

usage: session_scatter.py SHARED      (the folder that holds data/; default $DRIFTLAB_SHARED or ../shared)

NumPy alone, none of driftlab's code. Each recording of the ADIS16405 is a session. Prints what a session adds to the logarithm of
an Allan deviation, by its three parts (device, axis, scale), each beside the value that is kept; the factors kL and kS by which a
run would have to learn this scatter from the kept one; and how far neighbouring octaves move together.
"""
from __future__ import annotations

import io
import lzma
import os
import re
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
HEADER = Path(__file__).resolve().parents[2] / "core/campaign/regression/measured_constants.hpp"
RATE_HZ = 100.0
OCTAVES = 7  # tau of 0.01 to 0.64 s: every margin up to 1 s
SENSORS = (("gyroscope", "kGyroscopeTau0", slice(0, 3)), ("accelerometer", "kAccelerometerTau0", slice(3, 6)))


def ln_deviations(x: Array) -> Array:
    """ln of the Allan deviation at tau = 2^j dt."""
    found = []
    total = np.concatenate([[0.0], np.cumsum(x - x.mean())])
    for octave in range(OCTAVES):
        m = 2 ** octave
        d = (total[2 * m:] - 2.0 * total[m:-m] + total[:-2 * m]) / m
        found.append(0.5 * np.log(0.5 * float(np.mean(d * d))))
    return np.array(found)


def kept(constant: str) -> Array:
    """Device, axis and scale as they are kept [%]."""
    found = re.search(rf"{constant}{{(.*?)}}", HEADER.read_text())
    assert found, f"{HEADER.name} keeps no {constant}"
    return 100.0 * np.array([float(value) for value in found.group(1).split(",")])


def main(shared: Path) -> None:
    files = sorted((shared / "data").glob("adis_16405_imu*.npy.xz"))
    tables = [np.load(io.BytesIO(lzma.open(file).read())) for file in files]
    print(f"{len(files)} sessions of {min(len(t) for t in tables) / RATE_HZ / 3600.0:.1f} h and more, tau of 0.01 to {0.01 * 2 ** (OCTAVES - 1):g} s; "
          "per cent of a deviation (kept)")
    octaves = re.search(r"kOctavesOfCorrelation = ([0-9.]+);", HEADER.read_text())
    assert octaves, f"{HEADER.name} keeps no kOctavesOfCorrelation"
    neighbours = [float(np.exp(-k / float(octaves.group(1)))) for k in range(1, 4)]
    for sensor, constant, columns in SENSORS:
        curves = np.array([[ln_deviations(np.asarray(t[:, axis], dtype=float)) for axis in range(*columns.indices(6))] for t in tables])
        moved = curves - curves.mean(axis=0)  # session x axis x octave
        free = (len(files) - 1) / len(files)
        device = moved.mean(axis=(1, 2))
        axis = moved.mean(axis=2) - device[:, None]
        scale = moved - moved.mean(axis=2, keepdims=True)
        parts = 100.0 * np.array([float(np.sqrt(np.mean(p ** 2) / free)) for p in (device, axis, scale)])
        together = 100.0 * float(np.sqrt(np.mean(moved ** 2) / free))
        prior = kept(constant)
        print(f"{sensor}: device {parts[0]:.2f} ({prior[0]:.2f}), axis {parts[1]:.2f} ({prior[1]:.2f}), scale {parts[2]:.2f} ({prior[2]:.2f}), "
              f"together {together:.2f} ({np.linalg.norm(prior):.2f}): "
              f"kL {np.linalg.norm(parts[:2]) / np.linalg.norm(prior[:2]):.2f}, kS {parts[2] / prior[2]:.2f}")
        by_distance = [float(np.mean(scale[:, :, k:] * scale[:, :, : OCTAVES - k]) / np.mean(scale ** 2)) for k in range(1, 4)]
        print("  correlation of the scale's part with that 1, 2, 3 octaves on: "
              + ", ".join(f"{r:+.2f} ({stays:.2f})" for r, stays in zip(by_distance, neighbours)))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else os.environ.get("DRIFTLAB_SHARED", "../shared")))
