"""`driftlab export` and /v1/exports: one text by both ways, files that other programs' readers take, every real recording or a sentence.

The recordings of $DRIFTLAB_SHARED (default ../shared beside the repository) may not be committed; without them their part is skipped.
"""
from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import yaml
from daemon import PATIENCE_S
from real_exports import export_all
from suite import DaemonTest

PROGRAM = os.environ["DRIFTLAB"]


class Exports(DaemonTest):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-test-")))
        import random
        source = random.Random(11)
        walk = [0.0] * 6
        lines = ["gx [deg/s],gy [deg/s],gz [deg/s],fx [m/s^2],fy [m/s^2],fz [m/s^2]"]
        for _ in range(6000):
            walk = [value + source.gauss(0, 0.003) for value in walk]
            lines.append(",".join(f"{value + source.gauss(0, 0.1):.6f}" for value in walk))
        (cls.folder / "six.csv").write_text("\n".join(lines) + "\n", "utf-8")

    @property
    def server(self) -> str:
        return f"http://127.0.0.1:{self.daemon.port}"

    def driftlab(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)

    def test_recording_document_and_daemon_give_one_text_that_readers_take(self) -> None:
        done = self.driftlab("characterise", "six.csv", "--rate-hz", "100", "--device", "six", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        (self.folder / "six.json").write_text(done.stdout, "utf-8")
        recording = self.expect(201, self.daemon.upload((self.folder / "six.csv").read_bytes(), device="six", rate_hz=100)).json
        self.daemon.finished(self.expect(202, self.daemon.characterise(recording["id"])).json["id"])
        direct = self.driftlab("export", "--target", "kalibr", "six.csv", "--rate-hz", "100", "--device", "six")
        self.assertEqual(direct.returncode, 0, direct.stderr)
        served = self.driftlab("export", "--target", "kalibr", "--server", self.server, "--device", "six")
        self.assertEqual(served.returncode, 0, served.stderr)
        self.assertEqual(direct.stdout.replace("recording six,", "recording,"), re.sub(r"recording rec_\w+,", "recording,", served.stdout))
        targets = self.expect(200, self.daemon.get("/v1/exports")).json["items"]
        self.assertEqual(len(targets), 14)
        for target in (item["target"] for item in targets):
            with self.subTest(target=target):
                done = self.driftlab("export", "--target", target, "six.json", "--device", "six")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.read(target, done.stdout)
                answer = self.expect(200, self.daemon.get(f"/v1/exports/{target}?device=six", Accept="application/json")).json
                self.assertEqual((answer["gaps"], answer["recordings"]), ([], [recording["id"]]))

    def read(self, target: str, text: str) -> None:
        """As the program's own reader would."""
        if target in ("kalibr", "openvins", "orb-slam3", "vins-fusion", "kf-gins", "robot-localization", "imu-tools"):
            document = yaml.safe_load(text.replace("%YAML:1.0\n", ""))
            numbers = [value for value in json.dumps(document).replace("[", " ").replace("]", " ").replace("}", " ").replace(",", " ").split() if value[0].isdigit()]
            self.assertGreaterEqual(len(numbers), 2, text)
            self.assertNotRegex(json.dumps(document), r'"\d[\d.e-]*"', "a number read as a word")
        elif target == "gazebo":
            imu = ElementTree.fromstring(re.sub(r"^<!--.*-->\n", "", text, flags=re.MULTILINE))
            self.assertEqual(len(list(imu.iter("stddev"))), 6)
        elif target in ("gnss-ins-sim", "isaac"):
            ast.parse(text)
        elif target == "px4":
            rows = [line.split("\t") for line in text.splitlines() if line and not line.startswith("#")]
            self.assertEqual([len(row) for row in rows], [5] * 4)
        elif target == "ardupilot":
            rows = [line.split(",") for line in text.splitlines() if line and not line.startswith("#")]
            self.assertEqual([len(row) for row in rows], [2] * 4)
        else:
            self.assertIn(target, ("gtsam", "navego"))
            self.assertEqual(text.count("="), {"gtsam": 4, "navego": 9}[target])

    def test_a_low_pass_of_the_readings_is_no_bias_by_either_way(self) -> None:
        """A reading keeps a fifth of the one before: a correlation time of 0.62 samples, which stood as the bias beside all of the noise."""
        import random
        source = random.Random(5)
        value, lines = 0.0, ["gz [deg/s]"]
        for _ in range(8000):
            value = 0.2 * value + source.gauss(0, 0.1)
            lines.append(f"{value:.6f}")
        (self.folder / "coloured.csv").write_text("\n".join(lines) + "\n", "utf-8")
        recording = self.expect(201, self.daemon.upload((self.folder / "coloured.csv").read_bytes(), device="coloured", rate_hz=100)).json
        self.daemon.finished(self.expect(202, self.daemon.characterise(recording["id"])).json["id"])
        for target, names in (("kf-gins", ("imunoise/gbstd", "imunoise/corrtime")), ("navego", ("imu.gb_dyn", "imu.gb_corr", "imu.gb_psd")),
                              ("gnss-ins-sim", ("gyro_b_stability", "gyro_b_corr")), ("gazebo", ()), ("isaac", ("GYROSCOPE_BIAS_STD",))):
            with self.subTest(target=target):
                direct = self.driftlab("export", "--target", target, "coloured.csv", "--rate-hz", "100")
                self.assertEqual(direct.returncode, 0, direct.stderr)
                answer = self.expect(200, self.daemon.get(f"/v1/exports/{target}?device=coloured", Accept="application/json")).json
                served = self.driftlab("export", "--target", target, "--server", self.server, "--device", "coloured").stdout
                self.assertEqual(re.sub(r"recording rec_\w+,", "recording coloured,", served), direct.stdout)
                left_out = [gap for gap in answer["gaps"] if "so fast it is noise of the readings" in gap]
                self.assertLessEqual(set(names), {gap.partition(" ")[0] for gap in left_out}, answer["gaps"])
                self.assertEqual(len(left_out), 6 if target == "gazebo" else len(names), "each axis of a figure in SDF")
                self.assertIn("The density at low frequencies holds what it adds.", left_out[0])

    def test_says_in_a_sentence_what_cannot_be_exported(self) -> None:
        for arguments, words in ((("--target", "kaliber", "six.csv"), "There is no export target 'kaliber'"), (("--target", "kalibr"), "Name a recording"),
                                 (("--target", "kalibr", "absent.csv", "--rate-hz", "100"), "absent.csv"), (("--target", "px4", "--server", self.server), "--device")):
            done = self.driftlab("export", *arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertIn(words, done.stderr)
        self.problem(404, "not_found", self.daemon.get("/v1/exports/kaliber?device=six"))
        self.problem(400, "invalid_argument", self.daemon.get("/v1/exports/kalibr"))
        self.problem(404, "not_found", self.daemon.get("/v1/exports/kalibr?device=nobody"))
        self.expect(406, self.daemon.get("/v1/exports/kalibr?device=six", Accept="image/png"))

    def test_what_is_wrong_with_a_recording_is_said_beside_its_export(self) -> None:
        header, *rows = (self.folder / "six.csv").read_text("utf-8").splitlines()
        raised = [line.rpartition(",")[0] + f",{float(line.rpartition(',')[2]) + 9.81:.6f}" for line in rows]
        (self.folder / "wrong_unit.csv").write_text("\n".join([header.replace("m/s^2", "g"), *raised]) + "\n", "utf-8")
        written = self.driftlab("export", "--target", "kalibr", "wrong_unit.csv", "--rate-hz", "100")
        self.assertEqual(written.returncode, 0, written.stderr)
        self.assertIn("wrong_unit", written.stderr)
        self.assertIn("m/s^2", written.stderr)
        self.assertNotIn("look like", written.stdout)

    def test_every_small_recording_gives_a_kalibr_file_or_a_sentence(self) -> None:
        """Of the recordings up to 1.5 MB: long_exports_test.py exports the larger ones."""
        self.assertGreater(export_all(self, lambda size: size <= 1_500_000), 20)


if __name__ == "__main__":
    unittest.main()
