#!/usr/bin/env python3
"""A second look at the recordings of tests/hidden/REAL.md with NumPy alone: none of driftlab's code, none of its models.

usage: look.py STUDIES      (as studies.py wrote them)
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PIECES = ("at-0s", "at-3000s", "at-6000s", "at-9000s")
root = Path(sys.argv[1])


def load(study: str, recording: str) -> Array:
    return np.asarray(np.load(root / study / f"{recording}.npy"), dtype=float)  # type: ignore[no-untyped-call]


def density(x: Array, rate: float, length: int = 1024) -> tuple[Array, Array]:
    """Mean periodogram of Hann-windowed stretches."""
    window = np.hanning(length)
    parts = [np.abs(np.fft.rfft(window * (x[k:k + length] - x.mean()))) ** 2 for k in range(0, len(x) - length, length)]
    return np.fft.rfftfreq(length, 1.0 / rate), np.mean(parts, axis=0) / (window ** 2).sum() / rate


def delay(x: Array, reference: Array, rate: float, most: int = 10) -> float:
    """Seconds by which x is late, from the peak of the cross correlation and its neighbours."""
    lags = np.arange(-most, most + 1)
    inner = slice(5 * most, -5 * most)
    c = [float(np.dot(reference[inner] - reference.mean(), np.roll(x, -k)[inner] - x.mean())) for k in lags]
    k = int(np.argmax(c))
    if k in (0, len(c) - 1):
        return float("nan")
    return float(lags[k] + 0.5 * (c[k - 1] - c[k + 1]) / (c[k - 1] - 2.0 * c[k] + c[k + 1])) / rate


def roughness(x: Array) -> float:
    """Deviation of the sample-to-sample noise: second differences, cut at six robust deviations."""
    d = np.diff(x, 2)
    cut = 6.0 * float(np.median(np.abs(d))) / 0.6745
    return float(np.sqrt(np.mean(np.clip(d, -cut, cut) ** 2) / 6.0))


def change(what: str, t: Array, x: Array, t0: float) -> None:
    print(f"    {what}: deviation before {t0} s {roughness(x[t < t0]):.4f}, after {roughness(x[t >= t0]):.4f}")


def line(x: Array, rate: float, f_hz: float) -> float:
    """Largest ordinate of the periodogram at f over the mean of those around it."""
    power = np.abs(np.fft.rfft(x - x.mean())) ** 2
    k = round(f_hz * len(x) / rate)
    around = np.concatenate([power[k - 400:k - 20], power[k + 20:k + 400]])
    return float(power[k - 3:k + 4].max() / around.mean())


def adis() -> None:
    bands = ((10, 15), (15, 20), (20, 25), (25, 30), (30, 40), (40, 50))
    print("ADIS16405: step, step over noise, density by band (Hz) relative to 2-10 Hz")
    for number in (1, 2, 3):
        table = np.concatenate([load(f"adis-imu{number}", piece) for piece in PIECES])
        for axis in range(3):
            x = table[:, axis]
            step = float(np.diff(np.unique(np.round(x, 6))).min())
            f, p = density(x, 100.0)
            level = p[(f >= 2) & (f < 10)].mean()
            shares = [f"{lo}-{hi}: {p[(f >= lo) & (f < hi)].mean() / level:.2f}" for lo, hi in bands]
            print(f"  imu{number} {'xyz'[axis]}: {step:.4f} deg/s, {step / (np.diff(x).std() / 2 ** 0.5):.2f};", ", ".join(shares))
    x = load("adis-imu1", "at-0s")
    print("  imu1 x at 0 s, means of 20 s:", np.round(x[:12000, 0].reshape(-1, 2000).mean(axis=1), 3), "standard error of each", round(float(x[:, 0].std()) / 2000 ** 0.5, 4))
    print("  imu1 y at 0 s, deviation by 4 s:", np.round(x[:4000, 1].reshape(-1, 400).std(axis=1), 3), "of the rest", round(float(x[4000:, 1].std()), 3))
    z = load("adis-imu2", "at-3000s")[:, 2]
    length = len(z) // 12
    print("  imu2 z at 3000 s, means of twelfths:", np.round(z[:12 * length].reshape(12, length).mean(axis=1), 4), "standard error of each", round(float(z.std()) / length ** 0.5, 4))


def turntable() -> None:
    print("Turntable: encoder against gyroscope, and the IMU on the base")
    for study in ("turntable-roll_slow", "turntable-yaw_medium"):
        t, x, e = load(study, "shaft").T
        rate = (len(t) - 1) / (t[-1] - t[0])
        reference = np.gradient(np.convolve(e, np.ones(9) / 9.0, "same"), 1.0 / rate)
        inner = slice(200, -200)
        slope, bias = np.linalg.lstsq(np.column_stack([reference[inner], np.ones(len(t[inner]))]), x[inner], rcond=None)[0]
        print(f"  {study}: slope {slope:.4f}, bias {bias:.3f} deg/s, gyroscope late by {delay(x, reference, rate):.4f} s, repeated stamps {(np.diff(t) == 0).sum()}")
        base = load(study + "-base", "base")
        for axis in range(3):
            last = int(np.flatnonzero(np.diff(base[:, axis + 1]))[-1]) + 1
            print(f"    base {'xyz'[axis]}: last change at {base[last, 0]:.2f} s of {base[-1, 0]:.2f} s")
        awake = base[: int(np.flatnonzero(np.diff(base[:, 1]))[-1]) + 1]
        times = {"turntable-roll_slow": (101.5, 81.6, 147.2), "turntable-yaw_medium": (1298.6, 1077.5, 269.4)}[study]
        for axis, t0 in enumerate(times):
            change(f"base {'xyz'[axis]}", awake[:, 0] - base[0, 0], awake[:, axis + 1], t0)
        since = awake[:, 0] - base[0, 0]
        means = [awake[(since >= low) & (since < low + 10.0), 1].mean() for low in (0.0, 10.0, 20.0, 30.0, 40.0, 50.0)]
        print("    base x, means of the first tens of seconds:", np.round(means, 4))


def static() -> None:
    print("Static MPU-6050: stamps and spectrum")
    try:
        x = load("static-warm-stamps", "stamped")
    except FileNotFoundError:
        print("  LEFT OUT: the study is not there")
        return
    step = np.diff(x[:, 0])
    print(f"  step of the stamps: median {np.median(step):.4f} s, 99 % {np.quantile(step, 0.99):.4f} s, longest {step.max():.3f} s, below 3 ms {np.mean(step < 0.003):.2f}, mean rate {1 / step.mean():.2f} Hz")
    even = np.arange(len(x)) * step.mean()
    print(f"  standard deviation of the stamps about an even grid: {np.std(x[:, 0] - np.polyval(np.polyfit(even, x[:, 0], 1), even)):.4f} s")
    for axis in range(3):
        f, p = density(x[:, axis + 1], 99.32)
        middle = p[(f > 5) & (f < 15)].mean()
        print(f"  {'xyz'[axis]} density relative to 5-15 Hz:", ", ".join(f"{lo}-{lo + 5}: {p[(f >= lo) & (f < lo + 5)].mean() / middle:.2f}" for lo in range(15, 50, 5)))


def robot() -> None:
    print("Robot arm: gyroscope against the rate of the robot's own attitude")
    for study in ("robot-mpu6500", "robot-mpu9150"):
        table = load(study, "arm")
        for axis in range(3):
            x, reference = table[:, axis], table[:, axis + 3]
            if study == "robot-mpu9150":
                change(f"{study} {'xyz'[axis]}", np.arange(len(x)) / 95.33, x - reference, (3.75, 3.14, 4.02)[axis])
            print(f"  {study} {'xyz'[axis]}: correlation {np.corrcoef(x, reference)[0, 1]:.3f}, slope {np.polyfit(reference, x, 1)[0]:.3f}, largest {np.abs(x).max():.0f} deg/s")


def headings() -> None:
    print("Four headings: means [deg/s] and strongest ordinates of the mean periodogram (1 = white)")
    names = ("000", "090", "180", "270")
    tables = [np.degrees(load("headings", f"heading-{name}")[:, :3]) for name in names]
    for name, table in zip(names, tables):
        print(f"  {name}: {np.round(table.mean(axis=0), 4)}")
    rate = 157.807
    for axis in range(3):
        power = np.mean([np.abs(np.fft.rfft(t[:, axis] - t[:, axis].mean(), 8192)) ** 2 / len(t) / t[:, axis].var() for t in tables], axis=0)
        f = np.fft.rfftfreq(8192, 1.0 / rate)
        seen: list[int] = []
        for k in np.argsort(power[20:])[::-1] + 20:
            if all(abs(f[k] - f[j]) > 1.0 for j in seen):
                seen.append(int(k))
            if len(seen) == 5:
                break
        print(f"  {'xyz'[axis]}:", ", ".join(f"{f[k]:.2f} Hz {power[k]:.0f}" for k in seen))


def broad() -> None:
    print("BROAD: gyroscope against optical attitude")
    for study in ("broad-slow", "broad-phone"):
        table = load(study, "hand")
        for axis in range(3):
            x, reference = np.degrees(table[:, axis]), table[:, axis + 3]
            e = x - reference
            robust = 1.4826 * float(np.median(np.abs(e - np.median(e))))
            print(f"  {study} {'xyz'[axis]}: late by {delay(x, reference, 285.714):.4f} s, slope {np.dot(x, reference) / np.dot(reference, reference):.4f}, beyond 5 robust deviations {np.mean(np.abs(e - np.median(e)) > 5.0 * robust):.3f}; at 99.97 Hz {line(x, 285.714, 99.97):.0f} of its neighbours, reference {line(reference, 285.714, 99.97):.0f}")


if __name__ == "__main__":
    for look in (adis, turntable, static, robot, headings, broad):
        look()
