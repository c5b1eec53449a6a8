"""driftlab regress and ci as a pipeline runs them: verdicts, exit codes, artefacts, anchor and looks."""
from __future__ import annotations

import json
import math
import os
import random
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import jsonschema
from contract import bundle, closed
from daemon import Daemon
from firmware import gyroscope

PROGRAM = os.environ["DRIFTLAB"]
ROOT = Path(__file__).resolve().parents[2]
SCHEMAS = {path.name: json.loads(path.read_text()) for path in (ROOT / "schema").glob("*.schema.json")}
VALIDATOR = jsonschema.Draft202012Validator(closed(bundle({"$ref": "regression.schema.json"}, SCHEMAS)))
PATIENCE_S = 300


class Regress(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-regress-")))
        for arm, seed, white, scale in (("baseline", 1, 0.1, 1.0), ("candidate", 1, 0.1, 1.01), ("worse", 21, 0.17, 1.0)):
            (cls.folder / arm).mkdir()
            for session in range(3):
                (cls.folder / arm / f"{session}.csv").write_text(gyroscope(seed + session, white, scale))

    def files(self, arm: str) -> list[str]:
        return [f"{arm}/{session}.csv" for session in range(3)]

    def driftlab(self, *arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        return subprocess.run([PROGRAM, *arguments], cwd=cwd or self.folder, capture_output=True, text=True, timeout=PATIENCE_S,
                              check=False, stdin=subprocess.DEVNULL)

    def regress(self, exit_code: int, *arguments: str) -> str:
        done = self.driftlab("regress", "--models", "WN,WN+GM", *arguments)
        self.assertEqual(done.returncode, exit_code, done.stdout + done.stderr)
        return done.stdout if exit_code in (0, 1, 3) else done.stderr

    def document(self, exit_code: int, *arguments: str) -> dict[str, Any]:
        document: dict[str, Any] = json.loads(self.regress(exit_code, "--json", *arguments))
        self.assertEqual([], [fault.message for fault in VALIDATOR.iter_errors(document)])
        return document

    def test_unchanged_noise_passes_and_says_how_far(self) -> None:
        document = self.document(0, "--baseline", *self.files("baseline"), "--candidate", *self.files("candidate"))
        self.assertEqual(document["verdict"], "pass")
        self.assertRegex(document["summary"]["verdict"], r"^No worse than 10 % \(gyro\) to .*, 1 axis, 3 sessions against 3\.$")
        self.assertEqual(document["between"]["contrasts"], 4)

    def test_a_white_density_that_grew_by_seventy_per_cent_fails_with_its_size(self) -> None:
        document = self.document(1, "--baseline", *self.files("baseline"), "--candidate", *self.files("worse"))
        self.assertRegex(document["summary"]["verdict"], r"^gyro z is worse: \+\d+ % \[\+\d+, \+\d+\]")
        white = [test for test in document["units"][0]["tests"] if test.get("name") == "white_noise.N"]
        for test in white:
            self.assertLess(abs(math.log(test["ratio"] / 1.7)), 0.1)
        first = document["units"][0]["tests"][0]
        self.assertLess(abs(math.log(first["ratio"] / 1.7)), 0.1)
        self.assertEqual((first["verdict"], first["gated"]), ("beyond", True))

    def test_an_undecided_run_exits_3_unless_told_otherwise(self) -> None:
        arms = ("--baseline", "baseline/0.csv", "--candidate", "candidate/0.csv")
        text = self.regress(3, *arms)
        self.assertTrue(text.startswith("INCONCLUSIVE: Undecided"), text)
        self.assertIn("sessions an arm decide", text)
        self.assertIn("the scatter between sessions is assumed (2.0 % gyro), not measured", text)
        self.regress(0, *arms, "--inconclusive", "pass")
        self.regress(1, *arms, "--inconclusive", "fail")

    def test_stored_results_give_the_same_run_as_their_files(self) -> None:
        from_files = self.document(0, "--baseline", *self.files("baseline"), "--candidate", *self.files("candidate"))
        stored = []
        for arm in ("baseline", "candidate"):
            for name in self.files(arm):
                done = self.driftlab("characterise", name, "--models", "WN,WN+GM", "--json")
                document = json.loads(done.stdout)
                document["recordings"][0]["id"] = name
                stored.append(name.replace(".csv", ".json"))
                (self.folder / stored[-1]).write_text(json.dumps(document))
        from_results = self.document(0, "--baseline", *stored[:3], "--candidate", *stored[3:])
        self.assertEqual(from_files["units"], from_results["units"])

    def test_a_state_keeps_anchor_and_looks(self) -> None:
        state = ("--state", str(self.folder / "gate.json"))
        first = self.document(0, *state, "--baseline", *self.files("baseline"), "--baseline-label", "firmware=1.0",
                              "--candidate", "candidate/0.csv", "candidate/1.csv", "--candidate-label", "firmware=1.1",
                              "--inconclusive", "pass")
        self.assertEqual((first["look"]["number"], first["look"]["counted"]), (1, True))
        again = self.document(0, *state, "--candidate", "candidate/0.csv", "candidate/1.csv", "--candidate-label", "firmware=1.1",
                              "--inconclusive", "pass")
        self.assertEqual(again["look"]["number"], 1, "the same recordings are the same look")
        self.assertEqual(again["units"], first["units"])
        second = self.document(0, *state, "--candidate", "candidate/2.csv", "--candidate-label", "firmware=1.1", "--inconclusive", "pass")
        self.assertEqual((second["look"]["number"], len(second["arms"]["candidate"]["sessions"])), (2, 3))
        self.document(0, *state, "--candidate", *self.files("worse")[:1], "--candidate-label", "firmware=1.1", "--inconclusive", "pass")
        refused = self.regress(2, *state, "--candidate", *self.files("worse")[1:2], "--candidate-label", "firmware=1.1")
        self.assertIn("start a new label", refused)
        self.regress(2, *state, "--accept", "firmware=9", "--reason", "none")
        self.regress(2, *state, "--accept", "firmware=1.1")
        self.assertIn("firmware=1.1", self.regress(0, *state, "--accept", "firmware=1.1", "--reason", "meant so"))

    def test_settings_stay_with_the_anchor(self) -> None:
        (self.folder / "wide.json").write_text(json.dumps({"margin": {"gyroscope": [20, 25, 50]}}))
        state = ("--state", str(self.folder / "kept.json"), "--inconclusive", "pass")
        arms = ("--candidate", "candidate/0.csv", "--candidate-label")
        first = self.document(0, *state, "--settings", "wide.json", "--baseline", "baseline/0.csv", "--baseline-label", "firmware=1.0",
                              *arms, "firmware=1.1")
        self.assertEqual((first["settings"]["origin"]["margin"], first["kept"]["changed"]), ("asked", []))
        later = self.document(0, *state, *arms, "firmware=1.2")
        self.assertEqual((later["settings"]["margin"]["gyroscope"], later["settings"]["origin"]["margin"]), ([20, 25, 50], "anchor"))
        self.assertEqual(later["settings"]["origin"]["looks"], "default")
        (self.folder / "narrow.json").write_text(json.dumps({"margin": {"gyroscope": [5, 25, 50]}, "alpha": 0.1}))
        other = self.document(0, *state, "--settings", "narrow.json", *arms, "firmware=1.3")
        self.assertEqual([change["setting"] for change in other["kept"]["changed"]], ["alpha", "margin.gyroscope"])
        self.assertIn("margin.gyroscope 5, 25, 50 % (kept: 20, 25, 50 %)", " ".join(other["summary"]["details"]))
        self.regress(0, *state, "--settings", "narrow.json", "--accept", "firmware=1.3", "--reason", "a better sensor")
        moved = self.document(0, *state, "--candidate", "candidate/1.csv", "--candidate-label", "firmware=1.4")
        self.assertEqual((moved["settings"]["margin"]["gyroscope"][0], moved["settings"]["alpha"], moved["kept"]["changed"]), (5, 0.1, []))

    def test_lines_are_left_out_as_in_characterise(self) -> None:
        """A banner in front and comments of another kind between the rows: with the two flags the run is that of the bare table."""
        banner: dict[str, list[str]] = {"baseline": [], "worse": []}
        for arm, names in banner.items():
            for session in range(2):
                rows = (self.folder / f"{arm}/{session}.csv").read_text().splitlines()
                names.append(f"banner_{arm}_{session}.csv")
                told = [row + ("\n; tick" if number % 1000 == 1 else "") for number, row in enumerate(rows)]
                (self.folder / names[-1]).write_text("\n".join(["ready 42", "wait", *told]) + "\n")
        flags = ("--skip-lines", "2", "--comment", ";")
        left_out = self.document(1, *flags, "--baseline", *banner["baseline"], "--candidate", *banner["worse"])
        bare = self.document(1, "--baseline", *self.files("baseline")[:2], "--candidate", *self.files("worse")[:2])
        self.assertEqual(left_out["units"], bare["units"])

    def test_readings_are_corrected_first(self) -> None:
        """A candidate whose readings are twice too large fails; with the calibration that says so it is the baseline's equal.
        (The step of its readings is finer, for a step is compared as it was written.)"""
        finer = random.Random(7)
        for session in range(3):
            rows = [line.split(",") for line in (self.folder / f"candidate/{session}.csv").read_text().splitlines()[1:]]
            (self.folder / f"twice_{session}.csv").write_text("\n".join(["t [s],gz [deg/s]", *(f"{time},{2 * float(value) + finer.uniform(-1e-6, 1e-6):.9f}" for time, value in rows)]) + "\n")
        half = {"apply": {"reading_unit": "deg/s", "bias": [0, 0, 0], "correction": [[math.pi / 180, 0, 0], [0, math.pi / 180, 0], [0, 0, math.pi / 360]]}}
        (self.folder / "half.json").write_text(json.dumps({"gyroscope": half}))
        twice = [{"file": f"twice_{session}.csv"} for session in range(3)]
        run: dict[str, Any] = {"baseline": {"recordings": [{"file": name} for name in self.files("baseline")]}, "candidate": {"recordings": twice}}
        (self.folder / "twice.json").write_text(json.dumps(run))
        self.document(1, "twice.json")
        for one in twice:
            one["calibration"] = "half.json"
        (self.folder / "twice.json").write_text(json.dumps(run))
        self.assertEqual(self.document(0, "twice.json")["verdict"], "pass")
        self.assertIn("absent.json", self.regress(2, "--baseline", "baseline/0.csv", "--candidate", "candidate/0.csv", "--calibration", "absent.json"))

    def test_a_daemon_runs_it_and_remembers(self) -> None:
        with Daemon() as daemon:
            server = ("--server", f"http://127.0.0.1:{daemon.port}", "--device", "imu-07")
            old = ("--baseline", *self.files("baseline"), "--baseline-label", "firmware=1.0")
            there = self.document(0, *server, *old, "--candidate", *self.files("candidate"), "--candidate-label", "firmware=1.1")
            here = self.document(0, *old, "--candidate", *self.files("candidate"), "--candidate-label", "firmware=1.1")
            self.assertEqual(there["look"]["counted"], True)
            self.assertEqual([test["verdict"] for test in there["units"][0]["tests"]], [test["verdict"] for test in here["units"][0]["tests"]])
            worse = (*server, "--candidate", *self.files("worse"), "--candidate-label", "firmware=1.2")
            text = self.regress(1, *worse)
            self.assertTrue(text.startswith("FAIL: gyro z is worse"), text)
            out = self.folder / "there"
            self.assertEqual(self.regress(1, *worse, "--out", str(out)), text)
            self.assertEqual(sorted(path.name for path in out.iterdir()), ["badge.svg", "junit.xml", "ratio.svg", "regression.json", "summary.md"])
            document = json.loads((out / "regression.json").read_text())
            self.assertEqual(([arm["label"] for arm in document["arms"]["history"]], document["look"]["number"]), (["firmware=1.1"], 1))
            self.assertIn("](ratio.svg)", (out / "summary.md").read_text())
            self.regress(1, *worse, "--markdown", str(self.folder / "page.md"))
            self.assertNotIn("![", (self.folder / "page.md").read_text())
            ElementTree.parse(out / "junit.xml")
            self.assertIn("--reason", self.regress(2, *server, "--accept", "firmware=1.1"))
            self.assertIn("firmware=9", self.regress(2, *server, "--accept", "firmware=9", "--reason", "none"))
            self.assertIn("firmware=1.1", self.regress(0, *server, "--accept", "firmware=1.1", "--reason", "meant so"))
            moved = self.document(1, *server, "--candidate-label", "firmware=1.2")
            self.assertEqual(moved["arms"]["baseline"]["label"], "firmware=1.1")
            for words, *arguments in (("--device", "--server", server[1], "--candidate", "candidate/0.csv"), ("--state", *worse, "--state", "gate.json"),
                                      ("--candidate", *server), ("has the label firmware=7", *server, "--candidate-label", "firmware=7")):
                self.assertIn(words, self.regress(2, *arguments))

    def test_a_drift_over_releases_is_told(self) -> None:
        """Five releases, each 6 % noisier than the one before, listed oldest first: the trend says so, and by how much since the baseline."""
        releases = []
        for release in range(5):
            name = f"drift_{release}.csv"
            (self.folder / name).write_text(gyroscope(60 + release, 0.1, 1.06 ** release))
            releases.append({"labels": {"firmware": f"1.{release}"}, "recordings": [{"file": name}]})
        run = {"device": {"id": "imu-07"}, "baseline": releases[3], "candidate": releases[4], "history": releases[:3]}
        (self.folder / "drift.json").write_text(json.dumps(run))
        document = self.document(0, "drift.json", "--inconclusive", "pass")
        [scales, *others] = [trend for trend in document["trend"] if trend["of"] == "scales"]
        self.assertEqual((scales["unit"], scales["releases"], others), ("gyroscope z", 5, []))
        self.assertAlmostEqual(scales["per_release"], 1.06, delta=0.02)
        self.assertTrue(scales["warning"])
        self.assertIn("drifts over 5 releases", " ".join(document["summary"]["details"]))
        del run["history"]
        (self.folder / "pair.json").write_text(json.dumps(run))
        self.assertEqual(self.document(0, "pair.json", "--inconclusive", "pass")["trend"], [])

    def test_run_json_names_sessions_exclusions_and_settings(self) -> None:
        run: dict[str, Any] = {"device": {"id": "imu-07"},
               "baseline": {"labels": {"firmware": "1.0"}, "recordings": [{"id": f"b{i}", "file": f"baseline/{i}.csv"} for i in range(3)]},
               "candidate": {"labels": {"firmware": "1.1"},
                             "recordings": [{"id": f"c{i}", "file": f"candidate/{i}.csv", "session": "Monday"} for i in range(3)]},
               "excluded": [{"recording": "b2", "reason": "cable touched"}], "settings": {"looks": 1}}
        (self.folder / "run.json").write_text(json.dumps(run))
        done = self.driftlab("regress", "run.json", "--models", "WN,WN+GM", "--json")
        document = json.loads(done.stdout)
        self.assertEqual(len(document["arms"]["candidate"]["sessions"]), 1)
        self.assertEqual(len(document["arms"]["baseline"]["sessions"]), 2)
        self.assertEqual(document["arms"]["excluded"], run["excluded"])
        self.assertEqual(document["look"]["share"], 1)
        for i, recording_ in enumerate(run["candidate"]["recordings"]):
            del recording_["session"]
            recording_["recorded_at"] = f"2026-11-22T1{i}:00:00+01:00"  # ten minutes long, an hour apart
        (self.folder / "timed.json").write_text(json.dumps(run))
        timed = json.loads(self.driftlab("regress", "timed.json", "--models", "WN,WN+GM", "--json").stdout)
        self.assertEqual(len(timed["arms"]["candidate"]["sessions"]), 3)
        for fault, words in (({**run, "candidates": {}}, "candidates"), ({**run, "settings": {"margins": 3}}, "margins"),
                             ({**run, "excluded": [{"recording": "b2"}]}, "reason"), ({"baseline": run["baseline"]}, "candidate")):
            (self.folder / "bad.json").write_text(json.dumps(fault))
            bad = self.driftlab("regress", "bad.json")
            self.assertEqual((bad.returncode, bad.stdout), (2, ""))
            self.assertIn(words, bad.stderr)
            self.assertEqual(len(bad.stderr.strip().splitlines()), 1)

    def test_the_temperature_column_keeps_a_warm_candidate_from_being_judged(self) -> None:
        """A temperature column was not used: noise that had grown with 15 K failed the firmware."""
        def warmed(name: str, seed: int, white: float, degc: float) -> str:
            head, *rows = gyroscope(seed, white).splitlines()
            lines = [head + ",temp"] + [f"{row},{round((degc + 0.5 * math.sin(i / 900) - 36.53) * 340)}" for i, row in enumerate(rows)]
            (self.folder / name).write_text("\n".join(lines) + "\n")
            return name

        cold = [warmed(f"cold_{i}.csv", 41 + i, 0.1, 25) for i in range(3)]
        warm = [warmed(f"warm_{i}.csv", 51 + i, 0.17, 40) for i in range(3)]
        near = [warmed(f"near_{i}.csv", 51 + i, 0.17, 28) for i in range(3)]
        columns = ("--columns", "t [s]=time:s,gz [deg/s]=angular_rate:z:deg/s,temp=temperature:degC/340+36.53")

        def apart(document: dict[str, Any]) -> list[tuple[str, str]]:
            return [(item["item"], item["sentence"]) for item in document["comparability"] if not item["comparable"]]

        self.assertEqual(apart(self.document(3, "--baseline", *cold, "--candidate", *warm, *columns)),
                         [("temperature", "The candidate was 15.0 K warmer than the baseline; at most 5 K apart can be compared.")])
        self.assertEqual(apart(self.document(1, "--baseline", *cold, "--candidate", *near, *columns)), [])
        # Counts without a unit say nothing of a temperature, and what somebody states stands above the column.
        self.assertEqual(apart(self.document(1, "--baseline", *cold, "--candidate", *warm)), [])
        roles = {"t [s]": {"quantity": "time", "unit": "s"}, "gz [deg/s]": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"},
                 "temp": {"quantity": "temperature", "unit": "degC/340+36.53"}}
        arms = {arm: {"labels": {"firmware": arm}, "recordings": [{"file": name, "columns": roles, **more} for name in names]}
                for arm, names, more in (("baseline", cold, {}), ("candidate", warm, {"temperature_degc": 27}))}
        (self.folder / "stated.json").write_text(json.dumps({"device": {"id": "imu-07"}, **arms}))
        self.assertEqual(apart(self.document(1, "stated.json")), [])

    def test_bad_input_is_one_sentence(self) -> None:
        self.assertIn("in both arms", self.regress(2, "--baseline", "baseline/0.csv", "--candidate", "baseline/0.csv"))
        (self.folder / "copy.csv").write_text((self.folder / "baseline/0.csv").read_text())
        self.assertIn("same samples", self.regress(2, "--baseline", "baseline/0.csv", "--candidate", "copy.csv"))
        self.assertIn("--candidate", self.regress(2, "--baseline", "baseline/0.csv"))
        self.assertIn("--baseline", self.regress(2, "--candidate", "candidate/0.csv"))
        self.regress(2, "--baseline", "absent.csv", "--candidate", "candidate/0.csv")
        for text in ("[]", "{", '{"format": "driftlab-regress-state/1", "labels": [3], "runs": []}', '{"recordings": [7]}', '{"recordings": [{"id": "a"}]}'):
            (self.folder / "odd.json").write_text(text)
            self.regress(2, "--state", "odd.json", "--candidate", "candidate/0.csv", "--candidate-label", "a=b")
            self.regress(2, "--baseline", "odd.json", "--candidate", "candidate/0.csv")

    def test_the_artefacts_of_ci_lie_in_one_folder_and_say_the_same(self) -> None:
        done = self.driftlab("ci", "--models", "WN,WN+GM", "--baseline", *self.files("baseline"), "--candidate",
                             *self.files("worse"), "--candidate-label", 'firmware=<1.1>&"')
        self.assertEqual(done.returncode, 1, done.stderr)
        report = self.folder / "driftlab-report"
        self.assertEqual(sorted(path.name for path in report.iterdir()), ["badge.svg", "junit.xml", "ratio.svg", "regression.json", "summary.md"])
        document = json.loads((report / "regression.json").read_text())
        summary = (report / "summary.md").read_text().splitlines()
        self.assertEqual(summary[0], "**FAIL**: " + document["summary"]["verdict"].replace("[", "\\[").replace("]", "\\]"))
        self.assertEqual(summary[1], "<!-- driftlab-regression -->")
        self.assertLess(len(summary), 60)
        self.assertIn("](ratio.svg)", "\n".join(summary))
        suites = ElementTree.parse(report / "junit.xml").getroot()
        cases = {case.get("name"): case for case in suites.iter("testcase")}
        self.assertIsNotNone(cases["verdict"].find("failure"))
        self.assertEqual(int(suites.get("failures", "")), len(suites.findall(".//failure")))
        self.assertEqual(int(suites.get("tests", "")), len(cases))
        self.assertEqual([name for name in cases if name and name.startswith("comparable: ")],
                         [f"comparable: {item['item']}" for item in document["comparability"]], "passed ones too")
        [suite] = suites.iter("testsuite")
        self.assertEqual(suite.get("name"), 'sensor noise of device, static,  to firmware=<1.1>&"')
        badge = ElementTree.parse(report / "badge.svg").getroot()
        self.assertEqual(badge.get("height"), "20")
        self.assertIn("worse: gyro z +", "".join(badge.itertext()))
        self.assertIn("svg", ElementTree.parse(report / "ratio.svg").getroot().tag)

    def test_a_run_without_a_verdict_leaves_none_of_an_earlier_one(self) -> None:
        """What a pipeline publishes must be of its run: an error of the input, of the daemon, of the words on the line."""
        folder = self.folder / "stale"
        folder.mkdir()
        report = folder / "driftlab-report"
        absent = ("--server", "http://127.0.0.1:1", "--device", "imu-07")
        for code, words, *arguments in ((2, "empty.csv", "--baseline", "b.csv", "--candidate", "c.csv", "empty.csv"),
                                        (2, "--state", *absent, "--state", "s.json"),
                                        (4, "cannot be reached", *absent, "--candidate", "c.csv", "--candidate-label", "a=<b>")):
            with self.subTest(words):
                for name, arm in (("b.csv", "baseline"), ("c.csv", "candidate")):
                    (folder / name).write_text((self.folder / arm / "0.csv").read_text())
                (folder / "empty.csv").write_text("t [s],gz [deg/s]\n")
                begun = self.driftlab("ci", "--baseline", "b.csv", "--candidate", "c.csv", "--inconclusive", "pass", "--models", "WN", cwd=folder)
                self.assertEqual(begun.returncode, 0, begun.stderr)
                (report / "mine.txt").write_text("kept")
                done = self.driftlab("ci", *arguments, cwd=folder)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(words, done.stderr)
                self.assertEqual(sorted(path.name for path in report.iterdir()), ["junit.xml", "mine.txt", "summary.md"], "not another's file")
                summary = (report / "summary.md").read_text().splitlines()
                self.assertTrue(summary[0].startswith("**ERROR**: "), summary)
                self.assertIn(words, summary[0])
                self.assertEqual(summary[1], "<!-- driftlab-regression -->")
                suites = ElementTree.parse(report / "junit.xml").getroot()
                self.assertEqual([suites.get(count) for count in ("tests", "errors", "failures")], ["1", "1", "0"])
                [error] = suites.iter("error")
                self.assertEqual("driftlab: " + error.get("message", ""), done.stderr.strip().splitlines()[-1])
        pages = {name: self.folder / f"stale_{name}" for name in ("markdown", "junit", "badge")}
        for page in pages.values():
            page.write_text("PASS")
        named = [word for name, page in pages.items() for word in (f"--{name}", str(page))]
        self.regress(2, "--baseline", "absent.csv", "--candidate", "candidate/0.csv", *named)
        self.assertTrue(pages["markdown"].read_text().startswith("**ERROR**: "))
        self.assertIn("absent.csv", pages["junit"].read_text())
        self.assertFalse(pages["badge"].exists())


if __name__ == "__main__":
    unittest.main()
