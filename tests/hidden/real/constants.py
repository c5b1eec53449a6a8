#!/usr/bin/env python3
"""Measures the constants of core/investigate/study/measured_constants.hpp again, on the recordings of tests/hidden/REAL.md.

usage: constants.py STUDIES      (as studies.py wrote them)

NumPy alone, none of driftlab's code. Prints each constant as it is kept beside what the recordings give now.
"""
from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
HEADER = Path(__file__).resolve().parents[3] / "core/investigate/study/measured_constants.hpp"
ORDER = 24  # of the autoregression that whitens, as in core/investigate/fullrate/full_rate.cpp


def kept() -> dict[str, float]:
    return {name: float(value) for name, value in re.findall(r"constexpr double (k\w+) = ([0-9.e+-]+);", HEADER.read_text())}


def recordings(root: Path) -> Iterator[tuple[str, dict[str, Any], dict[tuple[str, str], Array]]]:
    """Study, recording and its columns by quantity and axis, rates in deg/s."""
    for study in sorted(root.iterdir()):
        for recording in json.loads((study / "study.json").read_text())["recordings"]:
            table = np.asarray(np.load(study / recording["file"]), dtype=float)  # type: ignore[no-untyped-call]
            columns = {}
            for number, role in recording["columns"].items():
                factor = 180.0 / np.pi if role["unit"] == "rad/s" else 1.0
                columns[role["quantity"], role.get("axis", "")] = factor * table[:, int(number)]
            yield study.name, recording, columns


def rate_of(recording: dict[str, Any], columns: dict[tuple[str, str], Array]) -> float:
    if ("time", "") in columns:
        time = columns["time", ""]
        return float((len(time) - 1) / (time[-1] - time[0]))
    return float(recording["rate_hz"])


def second_means(x: Array, rate: float) -> Array:
    block = max(1, round(rate))
    return np.asarray(x[: len(x) // block * block].reshape(-1, block).mean(axis=1))


def references(root: Path) -> Iterator[tuple[str, Array, Array, float]]:
    """Every angular rate that has a reference: name, rate, reference, samples a second."""
    for study, recording, columns in recordings(root):
        rate = rate_of(recording, columns)
        for axis in "xyz":
            x = columns.get(("angular_rate", axis))
            reference = columns.get(("reference_angular_rate", axis))
            if ("reference_angle", axis) in columns:
                reference = np.gradient(np.unwrap(columns["reference_angle", axis], period=360.0), 1.0 / rate)
            if x is not None and reference is not None:
                sound = np.isfinite(x) & np.isfinite(reference)
                yield f"{study} {axis}", x[sound], reference[sound], rate


def whitening(pieces: list[Array]) -> Array:
    """The filter that takes off what one autoregression of all pieces foresees."""
    pieces = [piece - piece.mean() for piece in pieces]
    covariance = sum(np.array([np.dot(x[lag:], x[: len(x) - lag]) for lag in range(ORDER + 1)]) for x in pieces)
    toeplitz = np.asarray(covariance)[np.abs(np.subtract.outer(np.arange(ORDER), np.arange(ORDER)))]
    return np.concatenate([[1.0], -np.linalg.solve(toeplitz, np.asarray(covariance)[1:])])


def levels(pieces: list[Array]) -> tuple[Array, float]:
    """Deviation of what one autoregression of all pieces cannot foresee in each, and the relative scatter of sampling."""
    weights = whitening(pieces)
    pieces = [piece - piece.mean() for piece in pieces]
    found, variances = [], []
    for x in pieces:
        e = np.convolve(x, weights)[ORDER: len(x)]
        found.append(float(e.std()))
        kurtosis = float(np.mean(e ** 4) / np.mean(e ** 2) ** 2)
        variances.append((kurtosis - 1.0) / 4.0 / len(e))
    return np.array(found), float(np.sqrt(np.mean(variances)))


def repeats(root: Path, constants: dict[str, float]) -> None:
    print(f"kLevelRepeats = {constants['kLevelRepeats']}: scatter of the noise level over pieces of one recording, sampling taken off")
    by_axis: dict[str, list[Array]] = {}
    for study, _, columns in recordings(root):
        if study.startswith("adis"):
            for axis in "xyz":
                by_axis.setdefault(f"{study} {axis}", []).append(columns["angular_rate", axis])
    for what, first in (("all four pieces of 600 s", 0), ("without the first, in which the unit warms up", 1)):
        beyond = []
        for name, pieces in by_axis.items():
            found, sampling = levels(pieces[first:])
            relative = found / found.mean() - 1.0
            beyond.append(relative.var(ddof=1) - sampling ** 2)
            if first == 0:
                print(f"  {name}: {', '.join(f'{100.0 * r:+.2f}' for r in relative)} %, of which sampling {100.0 * sampling:.2f} %")
        roots = 100.0 * np.sqrt(np.maximum(beyond, 0.0))
        print(f"  {what}: root mean square {100.0 * max(0.0, float(np.mean(beyond))) ** 0.5:.2f} %, median {np.median(roots):.2f} %, "
              f"from {roots.min():.2f} to {roots.max():.2f} % by axis")


def follow(root: Path, constants: dict[str, float]) -> None:
    print(f"kLeastCorrelation = {constants['kLeastCorrelation']}: correlation of means over a second with the reference")
    print(f"kLargestPart = {constants['kLargestPart']}: slope of these means against the reference, minus 1, where it follows")
    follows, strays, slopes = [], [], []
    for name, x, reference, rate in references(root):
        means, truth = second_means(x, rate), second_means(reference, rate)
        correlation = float(np.corrcoef(means, truth)[0, 1])
        slope = float(np.polyfit(truth, means, 1)[0])
        print(f"  {name}: correlation {correlation:.3f}, slope {slope - 1.0:+.3f}")
        if correlation >= constants["kLeastCorrelation"]:
            follows.append(correlation)
            slopes.append(abs(slope - 1.0))
        else:
            strays.append(correlation)
    print(f"  the lowest that follows {min(follows):.3f}, the highest that does not {max(strays):.3f}; the largest part of the rate {max(slopes):.3f}")


def stamps(root: Path, constants: dict[str, float]) -> None:
    print(f"kLooseStamps = {constants['kLooseStamps']}: scatter of the time stamps about an even grid, in samples")
    for study, recording, columns in recordings(root):
        if ("time", "") in columns:
            time = columns["time", ""]
            place = np.arange(len(time), dtype=float)
            scatter = float(np.std(time - np.polyval(np.polyfit(place, time, 1), place))) * rate_of(recording, columns)
            print(f"  {study} {recording['id']}: {scatter:.1f}")


def stop_band(root: Path, constants: dict[str, float]) -> None:
    print(f"kFilled = {constants['kFilled']}: density at 45 to 50 Hz over that at 2 to 10 Hz, of a sensor without a low-pass there")
    window = np.hanning(1024)
    shares = []
    by_axis: dict[str, list[Array]] = {}
    for study, _, columns in recordings(root):
        if study.startswith("adis"):
            for axis in "xyz":
                by_axis.setdefault(f"{study} {axis}", []).append(columns["angular_rate", axis])
    for name, pieces in by_axis.items():
        parts = [np.abs(np.fft.rfft(window * (x[k:k + 1024] - x.mean()))) ** 2 for x in pieces for k in range(0, len(x) - 1024, 1024)]
        f, p = np.fft.rfftfreq(1024, 0.01), np.mean(parts, axis=0)
        shares.append(float(p[(f >= 45.0) & (f < 50.0)].mean() / p[(f >= 2.0) & (f < 10.0)].mean()))
        print(f"  {name}: {shares[-1]:.2f}")
    behind = np.linspace(45.0, 49.9, 50)
    low_pass = 1.0 / (1.0 + (np.tan(np.pi * behind * 0.01) / np.tan(np.pi * 26.0 * 0.01)) ** 4)
    print(f"  the lowest {min(shares):.2f}; behind the low-pass of 26 Hz that was once named there: {float(low_pass.mean()):.3f}")


class Kinds:
    """Two kinds of frames, the louder in runs, as core/investigate/causes/two_kinds.hpp has them: x over its scale is F(2 m, 2 others)."""

    def __init__(self, runs: list[Array], m: int, others: int, length: float) -> None:
        self.runs, self.m, self.others, self.length = runs, m, others, length
        self.scale, self.ratio, self.fraction = float(np.median(np.concatenate(runs))), 4.0, 0.1
        for _ in range(40):
            self.step()

    def density(self, x: Array, scale: float) -> Array:
        return np.asarray(-self.m * np.log(scale) - (self.m + self.others) * np.log1p(self.m / self.others * x / scale))

    def loud(self, x: Array) -> tuple[Array, float]:
        """Chance of each frame to be loud, all frames seen, and the log likelihood."""
        leave = 1.0 / self.length
        enter = min(0.9, self.fraction / (1.0 - self.fraction) * leave)
        rest = self.density(x, self.scale)
        relative = np.exp(np.minimum(600.0, self.density(x, self.scale * self.ratio) - rest))
        chance, before, total = np.empty(len(x)), self.fraction, float(rest.sum())
        for f, r in enumerate(relative):
            evidence = 1.0 - before + before * r
            chance[f] = before * r / evidence
            total += np.log(evidence)
            before = chance[f] * (1.0 - leave) + (1.0 - chance[f]) * enter
        smoothed, after = chance.copy(), 1.0
        for f in range(len(x) - 1, -1, -1):
            smoothed[f] = chance[f] * after / (chance[f] * after + 1.0 - chance[f])
            said = relative[f] * after
            after = ((1.0 - leave) * said + leave) / (enter * said + 1.0 - enter)
        return smoothed, total

    def step(self) -> None:
        x = np.concatenate(self.runs)
        loud = np.concatenate([self.loud(run)[0] for run in self.runs])
        correction = (self.m + self.others) / self.others
        scale = correction * float(np.sum((1.0 - loud) * x / (1.0 + self.m / self.others * x / self.scale))) / float(np.sum(1.0 - loud))
        louder = correction * float(np.sum(loud * x / (1.0 + self.m / self.others * x / (self.scale * self.ratio)))) / max(1e-9, float(loud.sum()))
        self.scale, self.ratio, self.fraction = scale, max(1.2, louder / scale), float(np.clip(loud.mean(), 1e-4, 0.5))

    def likelihood(self) -> float:
        return sum(self.loud(run)[1] for run in self.runs)


def frames(pieces: list[Array], rate: float) -> list[Array]:
    """Periodograms of whitened frames of a second, each ordinate in units of its mean over its piece."""
    size = round(rate)
    found = []
    for x in pieces:
        e = np.convolve(x - x.mean(), whitening(pieces))[ORDER: len(x)]
        power = np.abs(np.fft.rfft(e[: len(e) // size * size].reshape(-1, size))[:, : size // 2]) ** 2
        found.append(power / power.mean(axis=0))
    return found


def unsteady(root: Path, constants: dict[str, float]) -> None:
    print(f"kMostOften = {constants['kMostOften']}: share of the seconds in which the band of 3 Hz that is least steady is the louder")
    by_axis: dict[str, list[Array]] = {}
    for study, recording, columns in recordings(root):
        if study.startswith("adis"):
            for axis in "xyz":
                by_axis.setdefault(f"{study} {axis}", []).append(columns["angular_rate", axis])
    for name, pieces in by_axis.items():
        power = frames(pieces, 100.0)
        bands = []
        for first in np.arange(2, 47, 1.5).round().astype(int):
            inside = [p[:, first:first + 3].mean(axis=1) for p in power]
            outside = [np.delete(p[:, 2:], np.s_[first - 2:first + 1], axis=1).mean(axis=1) for p in power]
            ratios = [i / o for i, o in zip(inside, outside)]
            sums = np.concatenate([np.convolve(x, np.ones(4), "valid") for x in ratios])
            bands.append((float(np.mean(sums ** 2) / np.mean(sums) ** 2), int(first), ratios))
        _, first, ratios = max(bands, key=lambda band: band[0])
        kinds = max((Kinds(ratios, 3, power[0].shape[1] - 5, length) for length in (2.0, 6.0, 18.0)), key=lambda kinds: kinds.likelihood())
        print(f"  {name}: at {first} to {first + 2} Hz, {100.0 * kinds.fraction:.0f} % of the seconds {kinds.ratio:.2f} times as loud")


if __name__ == "__main__":
    stored = kept()
    for measure in (repeats, follow, stamps, stop_band, unsteady):
        measure(Path(sys.argv[1]), stored)
