"""Every recording of $DRIFTLAB_SHARED (default ../shared beside the repository) through `driftlab export --target kalibr`.

The recordings may not be committed; without them their part is skipped.
"""
from __future__ import annotations

import os
import re
import subprocess
import unittest
from collections.abc import Callable, Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import NamedTuple

import yaml
from daemon import PATIENCE_S

SHARED = Path(os.environ.get("DRIFTLAB_SHARED") or Path(__file__).resolve().parents[3] / "shared")

TABLE = Path(__file__).resolve().parents[1] / "data/EXPORTS.md"


def six(gyroscope: str, accelerometer: str, rate_hz: float | None, gyroscope_unit: str, accelerometer_unit: str) -> tuple[str, ...]:
    """Flags for columns named by a pattern in which % is the axis, or by the first of three numbers."""
    def columns(pattern: str, quantity: str, unit: str) -> list[str]:
        names = [pattern.replace("%", axis) for axis in "xyz"] if "%" in pattern else [str(int(pattern) + i) for i in range(3)]
        return [f"{name}={quantity}:{axis}:{unit}" for name, axis in zip(names, "xyz")]
    named = columns(gyroscope, "angular_rate", gyroscope_unit) + columns(accelerometer, "specific_force", accelerometer_unit)
    return ("--columns", ",".join(named), *(("--rate-hz", str(rate_hz)) if rate_hz else ()))


# What the README beside a recording says of its columns, where the file itself does not.
DESCRIBED = {
    "adis_16405_imu*.npy.xz": six("0", "3", 100, "deg/s", "g"),
    "cont.imu1.npy.xz": ("--columns", "0=angular_rate:x:rad/s", "--rate-hz", "100"),
    "broad-optical-reference/*.mat": six("imu_gyr_%", "imu_acc_%", None, "rad/s", "m/s^2"),
    "drives/rtk-car-0708/imu_1934.csv.xz": six("3", "0", 98, "deg/s", "g"),
    "mpu6050-turntable-encoder/*.mat": six("all_gyro_1_%", "all_accel_1_%", 100, "deg/s", "g"),
    "mpu9150-multiposition/*.log.xz": six("3", "0", 100, "rad/s", "m/s^2"),
    "nav/navego_canada/imu_planetary.mat": six("imu_planetary.wb_%", "imu_planetary.fb_%", None, "rad/s", "m/s^2"),
    "nav/navego_synthetic/imu1.mat": six("imu1.wb_%", "imu1.fb_%", 200, "rad/s", "m/s^2"),
    "comma2k19-segment40/processed_log/IMU/gyro*/value.npy": ("--columns", "0=angular_rate:x:rad/s", "--rate-hz", "100"),
}


def exported(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([os.environ["DRIFTLAB"], "export", "--target", "kalibr", *arguments], capture_output=True, text=True, timeout=PATIENCE_S, check=False)


class Outcome(NamedTuple):
    """Of one recording: the densities of its file, or the sentence why there is none."""
    name: str
    described: bool
    code: int
    densities: tuple[float | None, float | None]
    sentence: str
    printed: str


def exports(wanted: Callable[[int], bool]) -> Iterator[Outcome]:
    """Those whose columns the README beside them describes are exported as described, all others as they come."""
    for path in sorted((SHARED / "data").rglob("*")):
        if not path.is_file() or not wanted(path.stat().st_size) or path.suffix in {".json", ".md"} or path.name == "LICENSE":
            continue
        name = path.relative_to(SHARED / "data").as_posix()
        described = next((flags for pattern, flags in DESCRIBED.items() if fnmatch(name, pattern)), ())
        done = exported(str(path), *described)
        if not described and done.returncode == 2 and ("no stated rate" in done.stderr or "no rate is stated" in done.stderr):
            done = exported(str(path), "--rate-hz", "100")
        densities: tuple[float | None, float | None] = (None, None)
        if done.returncode == 0:
            document = yaml.safe_load(done.stdout)
            densities = (document.get("gyroscope_noise_density"), document.get("accelerometer_noise_density"))
        yield Outcome(name, bool(described), done.returncode, densities, done.stderr.replace(f"{SHARED}/data/", ""), done.stdout)


def export_all(test: unittest.TestCase, wanted: Callable[[int], bool]) -> int:
    """How many of the recordings of a wanted size gave a file; the others must give a sentence. What each gives is in TABLE."""
    if not (SHARED / "data").is_dir():
        raise unittest.SkipTest(f"SKIPPED, NOT PASSED: there is no data in {SHARED}; set DRIFTLAB_SHARED")
    known = {name: cells for name, *cells in re.findall(r"^\| `([^`]+)` \| ([^|]*) \| ([^|]*) \| (.*) \|$", TABLE.read_text("utf-8"), re.MULTILINE)}
    written, refused = [], []
    for one in exports(wanted):
        with test.subTest(path=one.name):
            test.assertIn(one.code, (0, 2), one.sentence)
            if one.code == 0:
                test.assertTrue(any(isinstance(value, float) and 0 < value < 1e3 for value in one.densities), one.printed)
                written.append(one.name)
            else:
                test.assertRegex(one.sentence, r"\Adriftlab: [^\n]{20,}\.\n\Z", "one sentence")
                test.assertEqual(one.printed, "")
                if one.described:
                    test.assertIn("no axis has a noise density", one.sentence, "the columns are as the description says")
                refused.append(one.name)
            # A recording that came later has no row yet; one that has a row gives a file still, or still none.
            if one.name in known:
                test.assertEqual(one.code == 0, known[one.name][2] == "file", f"{TABLE.name} says otherwise")
    print(f"{len(written)} files written, {len(refused)} refused in a sentence: {', '.join(refused)}")
    return len(written)


def page() -> str:
    """TABLE as the recordings give it now."""
    def cell(value: float | None) -> str:
        return "–" if value is None else f"{value:.3g}"
    rows = []
    for one in exports(lambda _: True):
        sentence = one.sentence.strip().removeprefix("driftlab: ").removeprefix(f"{one.name}: ").replace("|", "/")
        rows.append(f"| `{one.name}` | {cell(one.densities[0])} | {cell(one.densities[1])} | {'file' if one.code == 0 else sentence} |")
    files = sum(row.endswith("| file |") for row in rows)
    return f"""# Kalibr files of real recordings

What `driftlab export --target kalibr` makes of every file in `$DRIFTLAB_SHARED/data`: a file with a finite noise density, or one sentence why
not. {files} of {len(rows)} give a file. Those whose columns a README describes are exported as it says, all others as they come, at 100 Hz where
they need a rate. The recordings may not be committed; `api.noise_exports` walks the small ones and, among the long suites, `api.long_exports` the
large ones, and hold this table. It is written anew by

    DRIFTLAB=build/release/bin/driftlab DRIFTLAB_SHARED=DIRECTORY PYTHONPATH=tests/api python3 -B tests/api/real_exports.py > tests/data/EXPORTS.md

| file | gyroscope, rad/s/sqrt(Hz) | accelerometer, m/s^2/sqrt(Hz) | outcome |
|---|---|---|---|
""" + "\n".join(rows) + "\n"


if __name__ == "__main__":
    print(page(), end="")
