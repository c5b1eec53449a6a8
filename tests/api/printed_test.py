"""`driftlab report` on paper: every page prints to A4 by Chromium with all that it says, nothing clipped and no row of a table broken."""
from __future__ import annotations

import html
import json
import os
import re
import shutil
import subprocess
import tempfile
import unicodedata
import unittest
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path

import samples

PROGRAM = os.environ["DRIFTLAB"]
A4 = (594.96, 841.92)  # points, as Chromium rounds 210 x 297 mm
MARGIN = 45.35  # points: 16 mm, as the pages state


class Said(HTMLParser):
    """What a reader sees of a page: its text without style and the descriptions of figures, and the tables that are aligned by blanks."""

    def __init__(self) -> None:
        super().__init__()
        self.hidden = 0
        self.aligned = False
        self.texts: list[str] = []
        self.rows: list[str] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.hidden += tag in ("style", "title", "desc")
        self.aligned = self.aligned or tag == "pre"

    def handle_endtag(self, tag: str) -> None:
        self.hidden -= tag in ("style", "title", "desc")
        self.aligned = self.aligned and tag != "pre"

    def handle_data(self, data: str) -> None:
        if self.hidden == 0:
            self.texts.append(data)
            if self.aligned:
                self.rows += [line for line in data.splitlines() if "  " in line.strip()]


def characters(text: str) -> Counter[str]:
    return Counter(c for c in unicodedata.normalize("NFKC", text) if not c.isspace())


class Printed(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-printed-")))
        conditions = {1: "static", 2: "static", 3: "constant_rate:z:9:deg/s", 4: "constant_rate:z:18:deg/s", 5: "constant_rate:z:36:deg/s", 6: "static"}
        for seed, condition in conditions.items():
            cls.said("simulate", "--out", f"{seed}.csv", "--seed", str(seed), "--duration-s", "120", "--condition", condition)
        samples.clip(cls.folder / "6.csv")
        role = {"gz [deg/s]": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}

        def recording(seed: int, size: float = 0) -> dict[str, object]:
            condition = {"kind": "constant_rate", "axis": "z", "value": size, "unit": "deg/s"} if size else {"kind": "static"}
            return {"id": f"run-{seed}", "file": f"{seed}.csv", "condition": condition, "rate_hz": 100, "columns": role}

        campaign = {"device": {"id": "imu of the long name, unit 7"}, "recordings": [recording(1), recording(2), recording(3, 9), recording(4, 18), recording(5, 36)]}
        (cls.folder / "device.json").write_text(json.dumps(campaign))
        (cls.folder / "study.json").write_text(json.dumps({"device": {"id": "d"}, "recordings": [recording(1), recording(6)], "baseline": {"kind": "auto"}}))

    @classmethod
    def said(cls, *arguments: str) -> str:
        done = subprocess.run([PROGRAM, *arguments], cwd=cls.folder, capture_output=True, text=True, timeout=600, check=False)
        assert done.returncode in (0, 1, 3), (arguments, done.stderr)
        return done.stdout

    def tool(self, *command: str) -> str:
        self.assertIsNotNone(shutil.which(command[0]), f"{command[0]} is in the set browser of deploy/packages.sh")
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=120, check=True).stdout

    def judge(self, name: str, pages: int, *arguments: str) -> None:
        self.said("report", *arguments, "--output", f"{name}.html")
        self.tool("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", f"--user-data-dir={self.folder / 'profile'}",
                  "--no-pdf-header-footer", f"--print-to-pdf={name}.pdf", (self.folder / f"{name}.html").as_uri())
        about = self.tool("pdfinfo", f"{name}.pdf")
        count = int(re.search(r"Pages:\s+(\d+)", about).group(1))  # type: ignore[union-attr]
        self.assertLessEqual(count, pages)
        size = re.search(r"Page size:\s+([0-9.]+) x ([0-9.]+)", about)
        assert size is not None
        self.assertAlmostEqual(float(size.group(1)), A4[0], delta=0.5)
        self.assertAlmostEqual(float(size.group(2)), A4[1], delta=0.5)
        page = Said()
        page.feed((self.folder / f"{name}.html").read_text("utf-8"))
        words = re.findall(r'<word xMin="([-0-9.]+)" yMin="([-0-9.]+)" xMax="([-0-9.]+)" yMax="([-0-9.]+)">(.*?)</word>', self.tool("pdftotext", "-bbox", f"{name}.pdf", "-"))
        printed = characters("".join(html.unescape(word[4]) for word in words))
        # Words with a halo are painted twice; what is clipped is painted by no page.
        self.assertEqual(characters("".join(page.texts)) - printed, Counter())
        for left, top, right, bottom, word in words:
            inside = float(left) > MARGIN - 2 and float(right) < A4[0] - MARGIN + 2 and float(top) > MARGIN - 6 and float(bottom) < A4[1] - MARGIN + 6
            self.assertTrue(inside, f"{word} at {left}, {top}, {right}, {bottom}")
        lines = [" ".join(line.split()) for line in self.tool("pdftotext", "-layout", f"{name}.pdf", "-").splitlines()]
        for row in page.rows:
            self.assertIn(unicodedata.normalize("NFKC", " ".join(row.split())), [unicodedata.normalize("NFKC", line) for line in lines], "a row of a table is one line")

    def test_of_a_recording(self) -> None:
        self.judge("recording", 2, "1.csv")

    def test_of_a_device(self) -> None:
        """The recordings of one device under four conditions, with the tables of its axis."""
        self.judge("device", 6, "device.json")

    def test_of_an_investigation(self) -> None:
        (self.folder / "i.json").write_text(self.said("investigate", "study.json", "--json"))
        self.judge("investigation", 4, "i.json")

    def test_of_a_regression_run(self) -> None:
        (self.folder / "r.json").write_text(self.said("regress", "--baseline", "1.csv", "2.csv", "--candidate", "6.csv", "--json"))
        self.judge("regression", 3, "r.json")


if __name__ == "__main__":
    unittest.main()
