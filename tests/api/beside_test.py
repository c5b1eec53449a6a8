"""The pages beside AllanTools, MATLAB and R: their figures are those of the peers' files and of driftlab today.

Recordings are not shipped: where the shared folder is not there, those tables are compared with the peers alone."""
from __future__ import annotations

import json
import math
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

PROGRAM = os.environ.get("DRIFTLAB", "")
REPOSITORY = Path(__file__).resolve().parents[2]
REFERENCE = REPOSITORY / "tests/data/reference"
SHARED = Path(os.environ.get("DRIFTLAB_SHARED", REPOSITORY / "../shared")) / "data"
CLEAN = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}


def peer(name: str) -> Any:
    return json.loads((REFERENCE / name).read_text())


def table(page: str, head: str) -> list[list[str]]:
    """The rows of the table whose head begins so."""
    text = (REPOSITORY / "schema/docs" / page).read_text()
    found = re.search(rf"^\| {re.escape(head)}[^\n]*\n\|[-|]+\|\n((?:\|[^\n]*\n)+)", text, re.MULTILINE)
    assert found, f"{page} has no table {head}"
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in found.group(1).splitlines()]


def channel(file: Path, rate: float, columns: str, models: str) -> dict[str, Any]:
    words = [PROGRAM, "characterise", str(file), "--rate-hz", str(rate), "--columns", columns, "--models", models, "--json"]
    ran = subprocess.run(words, capture_output=True, text=True, check=True, timeout=280, env=CLEAN)
    return dict(json.loads(ran.stdout)["recordings"][0]["channels"][0])


def written(value: float) -> str:
    return f"{value:.6g}"


def interval(ends: list[float]) -> str:
    return f"{written(ends[0])} to {written(ends[1])}"


class Pages(unittest.TestCase):
    def recording(self, name: str) -> Path:
        path = SHARED / f"{name}.npy.xz"
        if not path.exists():
            self.skipTest(f"SKIPPED: the recording {name} is not here")
        return path

    def test_allantools_on_the_numbers_of_nist(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "nist.csv"
            value, lines = 1234567890, ["y"]
            for _ in range(1000):
                lines.append(repr(value / 2147483647))
                value = 16807 * value % 2147483647
            file.write_text("\n".join(lines) + "\n")
            own = channel(file, 1, "y=angular_rate:z:rad/s", "WN")["allan"]
        of_peer = peer("nist_1000_points.json")["computed"]["oadev"]
        rows = [[str(m), written(a), written(b), interval(ci)]
                for m, a, b, ci in zip(of_peer["m"], of_peer["deviation"], own["deviation"], own["ci95"])]
        self.assertEqual(table("allantools.md", "m | AllanTools"), rows)
        for a, b in zip(of_peer["deviation"], own["deviation"]):
            self.assertAlmostEqual(b / a, 1.0, delta=1e-12)

    def test_allan_deviations_of_a_recording(self) -> None:
        whole = peer("cont.imu1.oadev.json")
        of_peer = whole["axes"]["gyro_x"]
        by_tau = {f"{m / 100:g}": (written(a), written(a / math.sqrt(whole["n"] - 2 * m + 1)))  # its error, by its own formula
                  for m, a in zip(of_peer["m"], of_peer["oadev"])}
        matlab, python = table("matlab.md", "tau [s] |"), table("allantools.md", "tau [s] |")
        self.assertEqual([row[:2] for row in matlab], [[tau, a] for tau, (a, _) in by_tau.items()])
        self.assertEqual([row[1:3] for row in python], [list(by_tau[row[0]]) for row in python])
        own = channel(self.recording("cont.imu1"), 100, "0=angular_rate:x:rad/s", "WN")["allan"]
        figures = {f"{tau:g}": [written(b), interval(ci)] for tau, b, ci in zip(own["tau_s"], own["deviation"], own["ci95"])}
        self.assertEqual([row[2:] for row in matlab], [figures[row[0]] for row in matlab])
        self.assertEqual([row[3:] for row in python], [figures[row[0]] for row in python])

    def test_wavelet_variances_and_fits_of_r(self) -> None:
        of_peer = peer("adis_16405_imu1.smac.json")["axes"]["gyro_x"]
        variance = of_peer["wv_haar_modwt"]
        by_scale = {str(n): [written(v), interval([low, high])] for n, v, low, high in
                    zip(variance["scales"], variance["variance"], variance["ci_low"], variance["ci_high"])}
        rows, fits = table("r.md", "scale | wv"), table("r.md", "parameter | simts")
        self.assertEqual([row[1:3] for row in rows], [by_scale[row[0]] for row in rows])
        _, *processes = of_peer["gmwm"]["WN+2AR1"]["estimate"]
        converted = []
        for phi, innovation in (processes[:2], processes[2:]):
            converted += [3600 * math.sqrt(innovation / (1 - phi * phi)), -100 * math.log(phi)]
        self.assertEqual([row[1] for row in fits], [written(value) for value in converted])
        own = channel(self.recording("adis_16405_imu1"), 100, "0=angular_rate:x:deg/s", "WN,WN+GM,WN+RW,WN+2GM")
        figures = {str(n): [written(v), interval(ci)] for n, v, ci in zip(own["haar"]["scale"], own["haar"]["variance"], own["haar"]["ci95"])}
        self.assertEqual([row[3:] for row in rows], [figures[row[0]] for row in rows])
        fit = next(fit for fit in own["fits"] if fit["model"] == "WN+2GM")["processes"]
        found = [process["params"][name] for process in fit[1:] for name in ("sigma", "beta")]
        self.assertEqual([row[2:] for row in fits], [[written(q["value"]), interval(q["ci95"])] for q in found])


if __name__ == "__main__":
    unittest.main()
