"""`driftlab plot` and `driftlab report` of every document that --json writes: a figure and a page that stand alone."""
from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import samples
from daemon import Daemon

SYMBOLS = json.loads((Path(__file__).parents[2] / "schema/names.json").read_text())["parameters"]
PROGRAM = os.environ.get("DRIFTLAB", "")


class Pages(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-report-")))
        for seed in range(1, 7):
            cls.said("simulate", "--out", f"{seed}.csv", "--seed", str(seed), "--duration-s", "120")
        samples.clipped_study(cls.folder)

    @classmethod
    def said(cls, *arguments: str) -> str:
        done = subprocess.run([PROGRAM, *arguments], cwd=cls.folder, capture_output=True, text=True, timeout=600, check=False)
        assert done.returncode in (0, 1, 3), (arguments, done.stderr)
        return done.stdout

    def page(self, name: str, *arguments: str) -> str:
        """The page of a document, of which the figures stand alone too."""
        (self.folder / name).write_text(self.said(*arguments, "--json"))
        ElementTree.fromstring(self.said("plot", name, "--output", "figure.svg") or (self.folder / "figure.svg").read_text())
        page = self.said("report", name)
        self.assertTrue(page.startswith("<!doctype html>") and page.rstrip().endswith("</html>"), page[:200])
        for outside in ("src=", "href=\"http", "<script", "@import", "url(h"):
            self.assertNotIn(outside, page)
        return page

    def raw_names_are_not_in(self, page: str) -> None:
        self.assertEqual([name for name in ("gauss_markov", "white_noise", "sigma", "beta", "sqrt(", "_hz") if name in page], [])

    def test_of_a_characterisation(self) -> None:
        page = self.page("c.json", "characterise", "1.csv")
        self.assertIn('class="verdict"', page)
        self.assertEqual(page.count("<svg"), 1)
        # The names and units of the field, as the pages have them; the terminal keeps those that options take.
        self.assertRegex(page, "white noise N +Gauss-Markov σ +Gauss-Markov β")
        self.assertRegex(page, "deg/√h +deg/h +1/s")
        self.raw_names_are_not_in(page)
        self.assertIn("gauss_markov_1.beta", self.said("characterise", "1.csv"))

    def test_of_an_investigation(self) -> None:
        page = self.page("i.json", "investigate", "study.json")
        document = json.loads((self.folder / "i.json").read_text())
        self.assertIn(document["summary"]["verdict"].split(";")[0].replace("'", "&#39;")[:40], page)
        self.assertEqual(page.count("<svg"), 4 * len(document["figures"]))
        for finding in document["findings"]:
            self.assertIn(f'<p class="meta">{finding["cause"].replace("_", " ")}, ', page)
            self.assertTrue(finding["equation"])
            self.assertIn(f'<p class="equation">{finding["equation"]}</p>', page)
            for name in finding["parameters"]:
                spoken = re.sub("_(hz|s|deg)$", "", name).replace("_", " ")
                self.assertIn(f"<td>{SYMBOLS.get(name, spoken)}</td>", page)
                self.assertIn(f"{spoken} = ", finding["explanation"])
        for heading in ("Extended model", "Not examined"):
            self.assertIn(f"<h2>{heading}</h2>", page)
        self.raw_names_are_not_in(page)

    def test_a_document_of_another_hand_is_one_sentence(self) -> None:
        # A document whose recordings had no quality ended the program with SIGABRT.
        (self.folder / "other.json").write_text(json.dumps({"recordings": [{"id": "a", "condition": {"kind": "static"}, "channels": []}]}))
        done = subprocess.run([PROGRAM, "report", "other.json"], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertRegex(done.stderr, r"^driftlab: A characterisation cannot be read: .*'quality'.*\n$")

    def test_of_a_regression_run(self) -> None:
        page = self.page("r.json", "regress", "--baseline", "1.csv", "2.csv", "--candidate", "3.csv", "4.csv")
        document = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(page.count("<svg"), len(document["units"]))
        for heading in ("Tests", "Recordings compared", "Sessions"):
            self.assertIn(f"<h2>{heading}</h2>", page)
        self.assertIn("3.csv", page)
        self.assertIn("<td>white noise N</td>", page)
        self.raw_names_are_not_in(page)

    def test_of_an_outage_evaluation(self) -> None:
        page = self.page("o.json", "outages", "--runs", "2")
        self.assertEqual(page.count("<svg"), 1)
        self.assertRegex(page, r'<p class="verdict">[^<]*after 10 s without GNSS')
        for text in ("<h2>Filters</h2>", "<h2>What the paper claims</h2>", "2 runs, seed 1, algorithm "):
            self.assertIn(text, page)

    def test_of_what_a_daemon_has_stored(self) -> None:
        with Daemon() as daemon:
            server = ("--server", f"http://127.0.0.1:{daemon.port}")
            self.said("characterise", "1.csv", "2.csv", "--device", "imu-07", *server)
            self.said("regress", "--baseline", "3.csv", "--candidate", "4.csv", "--device", "imu-08", "--candidate-label", "firmware=2", *server)
            recording = daemon.items("/v1/recordings?device=imu-07")[-1]
            [run] = daemon.items("/v1/regressions")
            device = self.said("report", "--device", "imu-07", *server)
            one = self.said("report", recording["id"], *server)
            gate = self.said("report", run["id"], *server)
            self.assertIn("<h1>imu-07</h1>", device)
            self.assertIn('class="verdict"', device)
            self.assertIn("Allan deviation against averaging time", device)
            for table in ("gyroscope z, WN+GM", "gyroscope z, Allan variance"):
                self.assertIn(f"<h2>{table}</h2>", device)
            # One of the two recordings that one job has characterised, called by its name.
            self.assertIn("<h1>imu-07</h1>", one)
            self.assertIn(f"<h2>{recording['file']['name']}</h2>", one)
            self.assertEqual(one.count("<svg"), 1)
            self.assertIn("<h2>Sessions</h2>", gate)
            ElementTree.fromstring(self.said("plot", run["id"], "--output", "gate.svg", *server) or (self.folder / "gate.svg").read_text())
            for arguments, sentence in ((("report", "1.csv"), "is no such id"), (("report",), "name one thing"),
                                        (("report", recording["id"], "--device", "imu-07"), "name one thing"),
                                        (("report", "--device", "nobody"), "nobody"),
                                        (("report", "rec_01M7YQ3DCDDZGTYNAE70E6BCA5"), "no recording")):
                done = subprocess.run([PROGRAM, *arguments, *server], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
                self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
                self.assertIn(sentence, done.stderr)
        done = subprocess.run([PROGRAM, "report", "--device", "imu-07", *server], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 4, done.stderr)


if __name__ == "__main__":
    unittest.main()
