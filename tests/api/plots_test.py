"""`--plot` of every command that has it, and every kind of figure: as SVG with the values of its document, as PNG, and in a terminal."""
from __future__ import annotations

import json
import math
import os
import re
import struct
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path
from typing import Any

from daemon import PATIENCE_S
import samples
from suite import DaemonTest

PRINTED = {"white_noise.N": "white noise N", "gauss_markov_1.sigma": "Gauss-Markov σ", "gauss_markov_1.beta": "Gauss-Markov β"}

PROGRAM = os.environ["DRIFTLAB"]
SVG = "{http://www.w3.org/2000/svg}"
COLUMNS = 80


class Drawn:
    """A figure as SVG: its words, and where its marks lie between the ticks of its first pair of axes."""

    def __init__(self, text: str) -> None:
        self.root = ElementTree.fromstring(text)
        self.words = [(node.text or "", float(node.get("x", "0")), float(node.get("y", "0"))) for node in self.root.iter(SVG + "text")]
        self.texts = [word for word, _, _ in self.words]

    @property
    def size(self) -> tuple[float, float]:
        return float(self.root.get("width", "0")), float(self.root.get("height", "0"))

    def count(self, role: str) -> int:
        return sum(node.get("class") == role for node in self.root.iter())

    def marks(self) -> list[tuple[float, float]]:
        """Middles of the round marks of the first plot, in order of x; the key has none inside a clip."""
        [*clipped] = (group for group in self.root.iter(SVG + "g") if group.get("clip-path"))
        found = [node for group in clipped[:1] for node in group.iter(SVG + "circle") if node.get("class") == "mark"]
        return sorted((float(node.get("cx", "0")), float(node.get("cy", "0"))) for node in found)

    def height_of(self, value: float) -> float:
        """Pixel of a value on the first logarithmic y axis, from its ticks: the numbers in one column at the left."""
        area = next(node for node in self.root.iter(SVG + "clipPath"))[0]
        top, bottom = float(area.get("y", "0")), float(area.get("y", "0")) + float(area.get("height", "0"))
        ticks = [(float(word), x, y) for word, x, y in self.words if re.fullmatch(r"[0-9.]+", word) and top <= y <= bottom + 4]
        column = min(x for _, x, _ in ticks)
        y_of = {number: y for number, x, y in ticks if abs(x - column) < 1}
        low, high = min(y_of), max(y_of)
        share = math.log(value / low) / math.log(high / low)
        # A tick's word stands a little below its line: the same for all.
        return y_of[low] + share * (y_of[high] - y_of[low])


class Plots(DaemonTest):
    folder: Path
    server: tuple[str, str]

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-plots-")))
        for seed, condition in ((1, "static"), (2, "static"), (3, "constant_rate:z:9:deg/s"), (4, "constant_rate:z:18:deg/s"), (6, "static")):
            cls.said("simulate", "--out", f"{seed}.csv", "--seed", str(seed), "--duration-s", "120", "--condition", condition)
        samples.clipped_study(cls.folder)
        cls.server = ("--server", f"http://127.0.0.1:{cls.daemon.port}")
        for name, condition in (("1.csv", "static"), ("3.csv", "constant_rate:z:9:deg/s"), ("4.csv", "constant_rate:z:18:deg/s")):
            cls.said("characterise", name, *cls.server, "--device", "plotted", "--models", "WN,WN+GM", "--condition", condition)

    @classmethod
    def said(cls, *arguments: str) -> str:
        done = subprocess.run([PROGRAM, *arguments], cwd=cls.folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
        assert done.returncode in (0, 1, 3), (arguments, done.stderr)
        return done.stdout

    def drawn(self, name: str) -> Drawn:
        return Drawn((self.folder / name).read_text("utf-8"))

    def test_flags_that_describe_recordings_are_refused_of_what_a_daemon_has_stored(self) -> None:
        for command in ("plot", "report"):
            for flag, value in (("--rate-hz", "50"), ("--skip-lines", "2"), ("--comment", ";")):
                with self.subTest(command=command, flag=flag):
                    told = [PROGRAM, command, *self.server, "--device", "plotted", flag, value]
                    done = subprocess.run(told, cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
                    self.assertEqual((done.returncode, done.stdout), (2, ""))
                    self.assertIn(f"{flag} cannot stand beside --server.", done.stderr)

    def judge_png(self, name: str, svg: Drawn) -> None:
        """The magic, the size of the SVG times one scale, chunks with their checksums, and more than one colour."""
        content = (self.folder / name).read_bytes()
        self.assertEqual(content[:8], b"\x89PNG\r\n\x1a\n")
        place, chunks = 8, []
        while place < len(content):
            [length] = struct.unpack(">I", content[place:place + 4])
            kind, body = content[place + 4:place + 8], content[place + 8:place + 8 + length]
            self.assertEqual(zlib.crc32(kind + body), struct.unpack(">I", content[place + 8 + length:place + 12 + length])[0])
            chunks.append((kind, body))
            place += 12 + length
        self.assertEqual((chunks[0][0], chunks[-1][0]), (b"IHDR", b"IEND"))
        width, height, depth, colour = struct.unpack(">IIBB", chunks[0][1][:10])
        scale = round(width / svg.size[0])
        self.assertGreaterEqual(scale, 1)
        self.assertAlmostEqual(width, scale * svg.size[0], delta=scale)
        self.assertAlmostEqual(height, scale * svg.size[1], delta=scale)
        pixels = zlib.decompress(b"".join(body for kind, body in chunks if kind == b"IDAT"))
        bytes_a_pixel = {2: 3, 6: 4}[colour] * depth // 8
        self.assertEqual(len(pixels), height * (1 + width * bytes_a_pixel))
        # What is drawn: a row of the middle is not all of one colour once the filter's differences are not all zero.
        inked = sum(any(pixels[row * (1 + width * bytes_a_pixel) + 1 + bytes_a_pixel:(row + 1) * (1 + width * bytes_a_pixel)]) for row in range(height))
        self.assertGreater(inked, height // 4)

    def judge_terminal(self, text: str, *names: str) -> None:
        """No more than 80 columns, dots that are set, and the names of the axes and curves."""
        start = next(i for i, line in enumerate(text.splitlines()) if re.search("[⠀-⣿]", line))
        figure = [line for line in text.splitlines()[max(0, start - 2):] if line]
        rows = [line for line in figure if re.search("[⠀-⣿]", line) and ("│" in line or "┤" in line)]
        self.assertTrue(all(len(line) <= COLUMNS for line in rows), max(map(len, rows)))
        self.assertGreater(sum(character not in "⠀" and "⠀" < character <= "⣿" for row in rows for character in row), 10)
        for name in names:
            line = next((line for line in text.splitlines() if name in line), None)
            self.assertIsNotNone(line, name)
            self.assertLessEqual(len(line or ""), COLUMNS)

    def every_form(self, command: tuple[str, ...], name: str, ending: str = "", terminal: tuple[str, ...] = ()) -> Drawn:
        """One command drawn three times; `ending`: of the first figure where there are several."""
        self.said(*command, "--plot", f"{name}.svg")
        self.said(*command, "--plot", f"{name}.png")
        svg = self.drawn(f"{name}{ending}.svg")
        self.judge_png(f"{name}{ending}.png", svg)
        self.judge_terminal(self.said(*command, "--plot", "-"), *terminal)
        return svg

    def judge_heights(self, svg: Drawn, values: list[float]) -> None:
        """Marks at the heights of these values by the axis's own ticks, and one for each."""
        marks = svg.marks()
        self.assertEqual(len(marks), len(values))
        off = [mark - svg.height_of(value) for (_, mark), value in zip(marks, values)]
        self.assertLess(max(off) - min(off), 1.0, off)  # pixels; a word stands below its tick by the same everywhere
        self.assertLess(abs(off[0]), 8.0)

    def test_of_characterise(self) -> None:
        svg = self.every_form(("characterise", "1.csv", "--models", "WN,WN+GM"), "allan",
                              terminal=("Allan deviation, deg/h", "averaging time τ, s", "classical, 95 % interval", "WN+GM, fitted"))
        for label in ("Allan deviation, deg/h", "averaging time τ, s", "measured ÷ model", "classical", "95 % interval", "WN+GM", "white noise", "Gauss-Markov"):
            self.assertIn(label, svg.texts)
        self.assertRegex(" ".join(svg.texts), "N = 1.0[0-9]+ deg/√h")
        document = json.loads(self.said("characterise", "1.csv", "--models", "WN,WN+GM", "--json"))
        deviation = document["recordings"][0]["channels"][0]["allan"]["deviation"]
        self.judge_heights(svg, [3600 * value for value in deviation])
        self.assertEqual(svg.count("interval"), 2 * len(deviation), "above, and around what remains")
        self.assertEqual(svg.count("curve"), 4, "measured, model and its two processes")

    def test_of_table(self) -> None:
        command = ("table", *self.server, "--device", "plotted", "--sensor", "gyroscope", "--axis", "z")
        document = json.loads(self.said(*command, "--format", "json"))
        self.every_form(command, "table", "-" + self.word(document["columns"][0]["key"]), terminal=("|constant rate|, deg/s",))
        for column in document["columns"]:
            svg = self.drawn(f"table-{self.word(column['key'])}.svg")
            self.assertTrue(any(text.startswith(PRINTED[column["key"]] + ", ") for text in svg.texts), svg.texts)
            self.assertIn("|constant rate|, deg/s", svg.texts)
            cells = [row["values"][column["key"]] for row in document["rows"]]
            self.assertEqual(len(svg.marks()), sum(cell is not None for cell in cells))
            self.assertEqual(svg.count("interval"), sum(cell is not None for cell in cells))
            heights = [mark for _, mark in svg.marks()]
            known = [cell["value"] for cell in cells if cell]
            self.assertEqual(sorted(range(len(known)), key=lambda i: known[i]), sorted(range(len(known)), key=lambda i: -heights[i]), column["key"])

    @staticmethod
    def word(name: str) -> str:
        return re.sub(r"[^A-Za-z0-9_.]+", "-", name).strip("-")

    def test_of_outages(self) -> None:
        svg = self.every_form(("outages", "--runs", "2"), "outages", terminal=("mean horizontal error at its end, m", "M_dyn(GMWM), "))
        document = json.loads(self.said("outages", "--runs", "2", "--json"))
        for name in (*(each["name"] for each in document["filters"]), "outage", "mean horizontal error at its end, m"):
            self.assertIn(name, svg.texts)
        points = sum(len(each["outages"]) for each in document["filters"])
        self.assertEqual((svg.count("mark"), svg.count("interval")), (points, points))

    def test_of_investigate(self) -> None:
        self.every_form(("investigate", "study.json"), "look", "-gz-deg-s-allan", terminal=("Allan deviation, deg/s", "measured", "extended"))
        document = json.loads(self.said("investigate", "study.json", "--json"))
        self.assertEqual(len(document["figures"]), 1)
        expected: dict[str, tuple[str, ...]] = {
            "allan": ("Allan deviation, deg/s", "averaging time τ, s", "measured", "extended", "baseline"),
            "spectrum": ("before: measured ÷ baseline", "after: remaining ÷ baseline", "frequency, Hz", "mean", "highest of each bin", "chance, 1 in 20"),
            "wavelet": ("before: deviation ÷ simulated", "after: remaining ÷ simulated", "scale, s", "simulated, 95 %", "measured"),
            "course": ("error, deg/s", "time, s", "found effect", "error")}
        for kind, labels in expected.items():
            svg = self.drawn(f"look-gz-deg-s-{kind}.svg")
            for label in labels:
                self.assertIn(label, svg.texts, kind)
            self.judge_png(f"look-gz-deg-s-{kind}.png", svg)
            self.assertGreater(svg.count("curve") + svg.count("mark"), 1, kind)
        measured = [value for value in document["figures"][0]["allan"]["measured"] if value]
        self.judge_heights(self.drawn("look-gz-deg-s-allan.svg"), measured)

    def test_of_a_drive(self) -> None:
        """How errors grow over the simulated band, and a map on which every outage, its error and its ellipse stand."""
        for name, table in zip(("imu.csv", "gnss.csv"), samples.drive_csvs(seconds=400)):
            (self.folder / name).write_bytes(table)
        document = samples.drive_document("imu.csv", "gnss.csv")
        for source in ("imu", "gnss"):
            document[source]["file"] = document[source].pop("recording")
        (self.folder / "drive.json").write_text(json.dumps(document))
        command = ("drive", "simulate", "drive.json", "--runs", "2")
        found: dict[str, Any] = json.loads(self.said(*command, "--json"))
        lengths = [f"{each['duration_s']:g}s" for each in found["durations"]]
        svg = self.every_form(command, "way", f"-error-{lengths[0]}", terminal=("horizontal error, m", "time without fixes, s", "simulated, rms"))
        for label in ("measured, rms", "median", "simulated, rms", "middle 90 %"):
            self.assertIn(label, svg.texts)
        self.assertEqual(svg.count("band"), 1)
        self.judge_heights(svg, [value for value in found["durations"][0]["growth"]["rms_m"] if value])
        for duration, length in zip(found["durations"], lengths):
            drawn = self.drawn(f"way-map-{length}.svg")
            self.assertEqual(len(drawn.marks()), duration["n"])
            self.assertEqual(drawn.count("curve"), 2 * duration["n"] + 1, "an error and an ellipse each, and the drive")
        (self.folder / "compared.json").write_text(self.said("drive", "compare", "drive.json", "--model", "document", "--model", "document-white", "--json"))
        self.said("plot", "compared.json", "--output", "compared.svg")
        self.assertIn("document-white", self.drawn(f"compared-error-{lengths[0]}.svg" if len(lengths) > 1 else "compared.svg").texts)

    def test_of_a_regression_run(self) -> None:
        """Drawn by `plot`, as every document is: `regress` has its figure in its Markdown."""
        (self.folder / "r.json").write_text(self.said("regress", "--baseline", "1.csv", "2.csv", "--candidate", "6.csv", "--json"))
        document: dict[str, Any] = json.loads((self.folder / "r.json").read_text())
        for ending in ("svg", "png"):
            self.said("plot", "r.json", "--output", f"gate.{ending}")
        svg = self.drawn("gate.svg")
        self.judge_png("gate.png", svg)
        self.judge_terminal(self.said("plot", "r.json"), "candidate ÷ baseline", "averaging time τ, s", "change")
        scales = [test for test in document["units"][0]["tests"] if test["kind"] == "scale"]
        for label in ("Allan deviation, deg/h", "baseline", "candidate", "candidate ÷ baseline", "change", "margin", "averaging time τ, s"):
            self.assertIn(label, svg.texts)
        self.judge_heights(svg, [test["ratio"] for test in scales])
        both = [group for group in svg.root.iter(SVG + "g") if group.get("clip-path")][1]
        self.assertEqual(sum(node.get("class") == "mark" for node in both.iter(SVG + "circle")), len(scales), "a point of the candidate for each")
        for test in scales:
            self.assertAlmostEqual(test["candidate"]["value"] / test["baseline"]["value"], test["ratio"], places=9)
            for arm in ("baseline", "candidate"):
                low, high = test[arm]["ci95"]
                self.assertTrue(low < test[arm]["value"] < high, test)

    def test_a_channel_is_named_with_its_unit_or_without_and_an_axis_with_its_sensor(self) -> None:
        (self.folder / "units.csv").write_text((self.folder / "1.csv").read_text("utf-8").replace("gz [deg/s]", "gz (deg/s)"), "utf-8")
        (self.folder / "units.json").write_text(self.said("characterise", "units.csv", "--rate-hz", "100", "--models", "WN", "--json"), "utf-8")
        whole = self.said("plot", "units.json")
        self.assertIn("gz (deg/s)", whole)
        for name in ("gz", "gz (deg/s)"):
            self.assertEqual(self.said("plot", "units.json", "--channel", name), whole)
        (self.folder / "axis.json").write_text(self.said("regress", "--baseline", "1.csv", "2.csv", "--candidate", "6.csv", "--json"), "utf-8")
        for name in ("z", "gyro z", "gyroscope z"):
            self.assertEqual(self.said("plot", "axis.json", "--channel", name), self.said("plot", "axis.json"))
        for document, known in (("units.json", "gz (deg/s)"), ("axis.json", "gyro z")):
            done = subprocess.run([PROGRAM, "plot", document, "--channel", "g"], cwd=self.folder, capture_output=True, text=True,
                                  timeout=PATIENCE_S, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(f"The document has no figure of 'g'; it has figures of {known}.", done.stderr)

    def test_another_ending_and_a_document_without_a_figure_are_one_sentence(self) -> None:
        for arguments, words in ((("characterise", "1.csv", "--models", "WN", "--plot", "a.jpg"), "--plot: Figures are written as .svg and .png"),
                                 (("plot", "study.json", "--channel", "gq"), "no figure of 'gq'")):
            done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn(words, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
