"""Local mode: the program gives the same objects as the daemon, and its sentences as exceptions."""
from __future__ import annotations

import json
import math
import os
import tempfile
import unittest
import warnings
from pathlib import Path
from typing import Any
from unittest import mock

import numpy

import samples
from daemon import Daemon
from driftlab import Client, InvalidInput, ServerProblem, local

GRAVITY = 9.80665
MODELS = ["WN", "WN+GM"]


class Local(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)

    def test_a_file_gives_what_a_daemon_gives(self) -> None:
        Path("rest.csv").write_bytes(samples.gyro_csv(2000))
        here = local.characterise("rest.csv", rate_hz=100, columns=samples.GYRO_Z, models=["WN", "WN+GM"])
        with Daemon() as daemon:
            client = Client(f"http://127.0.0.1:{daemon.port}")
            stored = client.upload("rest.csv", device="phone-07", rate_hz=100, columns=samples.GYRO_Z)
            there = client.characterise(stored["id"], models=["WN", "WN+GM"])
        self.assertEqual(json.dumps(here.channel().document), json.dumps(there.channel().document))

    def test_an_array_is_characterised(self) -> None:
        noise = numpy.random.default_rng(1).normal(0.0, 0.1, (4096, 2))
        found = local.characterise(noise, rate_hz=100, columns="0=angular_rate:x:rad/s,1=angular_rate:y:rad/s")
        self.assertEqual([channel.axis for channel in found.channels], ["x", "y"])
        # Four standard errors of the first octave of 4096 samples.
        self.assertAlmostEqual(found.channel("x").allan.deviation[0], 0.1, delta=0.1 * 4.0 / math.sqrt(2 * 4096))

    def test_what_is_simulated_has_the_parameters_it_was_made_from(self) -> None:
        made = local.simulate("sample.csv", duration_s=600, seed=4)
        self.assertEqual((made.columns, made.samples.shape), (["gz [deg/s]"], (60000, 1)))
        self.assertIs(made["gz"].base, made.samples)
        with self.assertRaisesRegex(KeyError, "gz"):
            made["gx"]
        rows = local.characterise("sample.csv", rate_hz=100).rows()
        noise = next(row for row in rows if row["parameter"] == "white_noise.N")
        self.assertEqual(noise["value.unit"], "deg/sqrt(h)")
        self.assertAlmostEqual(float(noise["value"] or 0), 1.03, delta=0.06)  # Radi et al. (2017), Table 4

    def test_a_drive_is_simulated_with_fixes_and_truth(self) -> None:
        made = local.simulate(scenario="paper", gnss="fixes.csv", truth="truth.csv")
        self.assertEqual(len(made.columns), 7)
        self.assertTrue(Path("fixes.csv").exists() and Path("truth.csv").exists())

    def test_what_the_program_says_beside_its_result_is_a_warning(self) -> None:
        model = {"processes": [{"process": "white_noise", "params": {"N": {"value": 0.01, "unit": "deg/sqrt(s)"}}}],
                 "effects": [{"cause": "temperature_bias", "params": {"coefficient": {"value": 1, "unit": "deg/s/degC"},
                                                                      "lag_s": {"value": 0, "unit": "s"}}}]}
        with self.assertWarnsRegex(local.DriftlabWarning, "temperature_bias"):
            local.simulate(model={"extended_model": model}, duration_s=100)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            local.simulate(duration_s=100)

    def test_a_study_is_a_file_or_a_document(self) -> None:
        local.simulate("rest.csv", duration_s=200)
        rest = {"id": "a", "file": "rest.csv", "rate_hz": 100, "condition": {"kind": "static"}}
        study: Any = {"device": {"id": "p"}, "recordings": [rest]}
        Path("study.json").write_text(json.dumps(study))
        by_file, by_document = local.investigate("study.json"), local.investigate(study)
        self.assertEqual(by_file.document["checks"], by_document.document["checks"])
        self.assertIsInstance(by_file.rows(), list)
        unnamed: Any = {"device": {"id": "p"}, "recordings": [{"id": "a", "rate_hz": 100, "condition": {"kind": "static"}}]}
        with self.assertRaises(InvalidInput):
            local.characterise(unnamed)
        os.chdir("/")
        self.assertEqual(len(local.characterise(study, folder=self.folder, models=["WN"]).channels), 1)

    def test_outages_are_compared(self) -> None:
        found = local.outages(runs=2, seed=3)
        self.assertEqual((found.document["runs"], found.document["seed"]), (2, 3))
        self.assertEqual(found.rows()[0]["mean_error.unit"], "m")

    def test_a_triad_is_calibrated(self) -> None:
        recordings: list[Any] = []
        for i, axis in enumerate("xyz"):
            for direction in ("up", "down"):
                columns = samples.noise(400, 3, 10 * i + len(direction))
                for j, column in enumerate(columns):
                    truth = (GRAVITY if direction == "up" else -GRAVITY) if i == j else 0.0
                    columns[j] = [0.01 * value + 0.1 * (j + 1) + truth for value in column]
                name = f"{axis}-{direction}"
                Path(name + ".csv").write_bytes(samples.csv(columns, ["fx", "fy", "fz"]))
                recordings.append({"id": name, "file": name + ".csv", "rate_hz": 100,
                                   "columns": {f"f{a}": {"quantity": "specific_force", "axis": a, "unit": "m/s^2"} for a in "xyz"},
                                   "condition": {"kind": "six_position", "axis": axis, "direction": direction}})
        found = local.calibrate({"device": {"id": "p"}, "recordings": recordings})
        biases = {row["axis"]: row["value"] for row in found.rows() if row["what"] == "bias"}
        for j, axis in enumerate("xyz"):
            self.assertAlmostEqual(float(biases[axis] or 0), 0.1 * (j + 1), delta=0.002)  # means of 400 samples: 0.0005 m/s^2
        reading = numpy.array([[GRAVITY + 0.1, 0.2, 0.3]])
        numpy.testing.assert_allclose(found.correct("accelerometer", reading), [[GRAVITY, 0.0, 0.0]], atol=0.005)

    def sessions(self, name: str, seed: int, white: float = 1.0, count: int = 3) -> list[str]:
        """Files of ten minutes of white noise at 20 Hz, one a session."""
        names = [f"{name}-{number}.csv" for number in range(count)]
        for number, file in enumerate(names):
            [column] = samples.noise(12000, 1, seed + number)
            Path(file).write_bytes(samples.csv([[white * value for value in column]], ["gz"]))
        return names

    def test_a_regression_run_is_that_of_a_daemon_and_a_fail_is_a_result(self) -> None:
        arms = {"old": self.sessions("old", 1), "same": self.sessions("same", 1, 1.01), "worse": self.sessions("worse", 21, 1.7)}
        about: Any = {"rate_hz": 20, "columns": samples.GYRO_Z, "device": "imu-07", "models": MODELS}
        with Daemon() as daemon:
            client = Client(f"http://127.0.0.1:{daemon.port}")
            stored = {arm: [client.upload(name, device="imu-07", rate_hz=20, columns=samples.GYRO_Z)["id"] for name in names]
                      for arm, names in arms.items()}
            client.characterise(*(id for ids in stored.values() for id in ids), models=MODELS)
            for arm, verdict in (("same", "pass"), ("worse", "fail")):
                here = local.regress(baseline=arms["old"], candidate=arms[arm], **about)
                there = client.regression(client.wait(client.create_job({"kind": "regress", "inputs": {
                    "device": "imu-07", "baseline": {"recordings": [{"recording": id} for id in stored["old"]]},
                    "candidate": {"recordings": [{"recording": id} for id in stored[arm]]}}}))["id"])
                self.assertEqual((here["verdict"], there["verdict"]), (verdict, verdict))
                self.assertEqual(here["summary"], there["summary"])
                self.assertEqual([unit["tests"] for unit in here["units"]], [unit["tests"] for unit in there["units"]])
                self.assertEqual([session["recordings"] for session in here["arms"]["candidate"]["sessions"]],
                                 [[name] for name in arms[arm]], "recordings go by the names that they are given")
        page = local.report(here)
        for part in ("<title>imu-07</title>", "gyro z is worse"):
            self.assertTrue(part in page, f"the page lacks {part}")

    def test_an_undecided_regression_run_is_no_exception(self) -> None:
        old, new = self.sessions("old", 1, count=1), self.sessions("new", 31, count=1)
        found = local.regress(baseline=old[0], candidate=new[0], rate_hz=20, columns=samples.GYRO_Z, models=MODELS)
        self.assertEqual(found["verdict"], "inconclusive")
        self.assertIn("sessions an arm decide", str(found["needs"]["sentence"]))
        self.assertIsNone(found["arms"]["baseline"]["label"])

    def test_a_regression_run_takes_arrays_results_and_a_run_document(self) -> None:
        old, same = self.sessions("old", 1), self.sessions("same", 1, 1.01)
        by_name = local.regress(baseline=old, candidate=same, rate_hz=20, columns=samples.GYRO_Z, models=MODELS, out="gate")
        self.assertEqual(by_name["verdict"], "pass")
        self.assertEqual(json.loads(Path("gate/regression.json").read_text()), by_name)
        self.assertTrue(Path("gate/summary.md").read_text().startswith("**PASS**"))

        def column(name: str) -> Any:
            return numpy.loadtxt(name, skiprows=1, ndmin=2)
        arrays = local.regress(baseline=[column(name) for name in old], candidate=[column(name) for name in same], rate_hz=20,
                               columns={"0": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}, models=MODELS)
        self.assertEqual([unit["tests"] for unit in arrays["units"]], [unit["tests"] for unit in by_name["units"]])
        self.assertEqual([session["recordings"] for session in arrays["arms"]["candidate"]["sessions"]],
                         [["candidate-1.npy"], ["candidate-2.npy"], ["candidate-3.npy"]])
        results = [local.characterise(name, rate_hz=20, columns=samples.GYRO_Z, models=MODELS) for name in old]
        stored = local.regress(baseline=results, candidate=same, rate_hz=20, columns=samples.GYRO_Z, models=MODELS)
        self.assertEqual([unit["tests"] for unit in stored["units"]], [unit["tests"] for unit in by_name["units"]])

        role = {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}
        asked: Any = {"device": {"id": "imu-07"}, "settings": {"looks": 1}, "excluded": [{"recording": "old-2.csv", "reason": "touched"}],
                      **{arm: {"labels": {"firmware": arm},
                               "recordings": [{"file": name, "rate_hz": 20, "columns": role, "session": session} for name in names]}
                         for arm, names, session in (("baseline", old, ""), ("candidate", same, "Monday"))}}
        os.chdir("/")
        by_document = local.regress(asked, folder=self.folder, models=MODELS)
        self.assertEqual([len(arm["sessions"]) for arm in (by_document["arms"]["baseline"], by_document["arms"]["candidate"])], [2, 1])
        self.assertEqual(by_document["arms"]["excluded"], asked["excluded"])
        self.assertEqual(by_document["settings"]["looks"], 1)
        (self.folder / "run.json").write_text(json.dumps(asked))
        self.assertEqual(local.regress(self.folder / "run.json", models=MODELS)["units"], by_document["units"])

    def test_a_state_keeps_anchor_and_looks_of_files_alone(self) -> None:
        old, new = self.sessions("old", 1), self.sessions("new", 1, 1.01)
        about: Any = {"rate_hz": 20, "columns": samples.GYRO_Z, "models": ["WN"], "state": "gate.json"}
        first = local.regress(baseline=old, baseline_label="firmware=1.0", candidate=new[:2], candidate_label="firmware=1.1",
                              settings={"margin": {"gyroscope": [20, 25, 50]}}, **about)
        self.assertEqual((first["look"]["counted"], first["look"]["number"]), (True, 1))
        second = local.regress(candidate=new[2:], candidate_label="firmware=1.1", **about)
        self.assertEqual((second["look"]["number"], second["arms"]["baseline"]["label"]), (2, "firmware=1.0"))
        self.assertEqual((second["settings"].get("margin", {})["gyroscope"][0], second["settings"]["origin"]["margin"]), (20, "anchor"))
        with self.assertRaisesRegex(ValueError, "A state knows recordings by the names of their files"):
            local.regress(candidate=numpy.zeros((100, 1)), candidate_label="firmware=1.1", **about)

    def test_a_regression_run_over_bad_input_is_refused(self) -> None:
        [old] = self.sessions("old", 1, count=1)
        about: Any = {"rate_hz": 20, "columns": samples.GYRO_Z, "models": ["WN"]}
        with self.assertRaisesRegex(InvalidInput, "absent.csv"):
            local.regress(baseline=old, candidate="absent.csv", **about)
        with self.assertRaisesRegex(InvalidInput, "needs a candidate"):
            local.regress(baseline=old, **about)
        with self.assertRaisesRegex(InvalidInput, "margins"):
            local.regress(baseline=old, candidate=old, settings={"margins": 3}, **about)
        with self.assertRaisesRegex(InvalidInput, "candidates"):
            local.regress({"baseline": {"recordings": [{"file": old}]}, "candidate": {"recordings": [{"file": old}]}, "candidates": {}})
        program = self.folder / "dies"  # with the exit code of a fail, and no document
        program.write_text("#!/bin/sh\necho 'driftlab: out of memory' >&2\nexit 1\n")
        program.chmod(0o755)
        with self.assertRaisesRegex(ServerProblem, "out of memory"):
            local.regress(baseline=old, candidate=old, program=program)

    def test_an_export_holds_the_noise_density_of_what_was_simulated(self) -> None:
        made = local.simulate("rest.csv", duration_s=600, seed=4)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that the file begins with comment lines
            found = local.export("kalibr", "rest.csv", rate_hz=100, device="phone-07", out="imu.yaml")
        [density] = [float(line.partition(": ")[2]) for line in found["text"].splitlines() if line.startswith("gyroscope_noise_density: ")]
        # 1.03 deg/sqrt(h), as above; of white noise to be seen at low frequencies 10 min hold a tenth.
        self.assertAlmostEqual(density, math.radians(1.03) / 60.0, delta=0.1 * math.radians(1.03) / 60.0)
        self.assertIn("of device phone-07", found["text"])
        self.assertEqual(Path("imu.yaml").read_text(), found["text"])
        self.assertEqual(found["target"], "kalibr")
        self.assertIn("accelerometer_noise_density is not given. No column is known to be an accelerometer.", found["gaps"])

        columns: Any = {"0": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # what a file lacks is in `gaps`, and no warning
            of_array = local.export("kalibr", made.samples, rate_hz=100, columns=columns, device="phone-07")
            of_result = local.export("kalibr", local.characterise(made.samples, rate_hz=100, columns=columns), device="phone-07")
        self.assertEqual(of_array, of_result)
        self.assertIn(f"gyroscope_noise_density: {density:.6g}", of_array["text"])
        study: Any = {"device": {"id": "phone-08"}, "recordings": [{"id": "a", "file": "rest.csv", "rate_hz": 100,
                                                                    "condition": {"kind": "static"}}]}
        with self.assertWarnsRegex(local.DriftlabWarning, "comment line"):
            self.assertIn("of device phone-08", local.export("gazebo", study)["text"])
        with self.assertRaisesRegex(InvalidInput, "There is no export target 'kaliber'"):
            local.export("kaliber", "rest.csv", rate_hz=100)
        with self.assertRaisesRegex(InvalidInput, "absent.csv"):
            local.export("kalibr", "absent.csv", rate_hz=100)

    def test_an_export_is_that_of_a_daemon(self) -> None:
        Path("rest.csv").write_bytes(samples.gyro_csv(6000))
        with Daemon() as daemon:
            client = Client(f"http://127.0.0.1:{daemon.port}")
            stored = client.upload("rest.csv", device="phone-07", rate_hz=100, columns=samples.GYRO_Z)
            client.characterise(stored["id"])
            there = client.export("kalibr", "phone-07")
        here = local.export("kalibr", "rest.csv", rate_hz=100, columns=samples.GYRO_Z, device="phone-07")
        self.assertEqual(here["text"], there["text"].replace(f"recording {stored['id']},", "recording rest,"))
        self.assertEqual(here["gaps"], there["gaps"])

    def test_a_report_is_a_page_with_the_device_in_it(self) -> None:
        made = local.simulate("rest.csv", duration_s=200)
        columns: Any = {"0": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}
        study: Any = {"device": {"id": "phone-08"}, "recordings": [{"id": "a", "file": "rest.csv", "rate_hz": 100,
                                                                    "condition": {"kind": "static"}}]}
        page = local.report("rest.csv", "page.html", rate_hz=100, device="phone-07")
        self.assertEqual(Path("page.html").read_text("utf-8"), page)
        pages = {"file": ("phone-07", page),
                 "array": ("phone-07", local.report(made.samples, rate_hz=100, columns=columns, device="phone-07")),
                 "study": ("phone-08", local.report(study)),
                 "characterisation": ("phone-07", local.report(local.characterise("rest.csv", rate_hz=100), device="phone-07")),
                 "investigation": ("phone-09", local.report(local.investigate(study), device="phone-09"))}
        for name, (device, text) in pages.items():
            for part in ("<!doctype html>", f"<h1>{device}</h1>", "<svg", "</html>"):
                self.assertTrue(part in text, f"the page of the {name} lacks {part}")
        self.assertTrue("<svg" in local.report(local.outages(runs=2)))
        with self.assertRaisesRegex(InvalidInput, "absent.csv"):
            local.report("absent.csv")
        with self.assertRaises(InvalidInput):
            local.report({"a": 1})
        of_result: Any = {"recordings": [{"id": "a", "channels": [], "calibration": "cal_1"}]}
        with local.as_files(of_result, "/elsewhere") as [name]:
            self.assertEqual(json.loads(Path(name).read_text()), of_result, "a result names no files to look for")

    def test_a_refusal_is_invalid_input_with_the_sentence(self) -> None:
        Path("broken.csv").write_text("t [s],gz [deg/s]\n0,1\n0.01,x\n")
        with self.assertRaises(InvalidInput) as caught:
            local.characterise("broken.csv")
        self.assertIn("Row 3", caught.exception.detail)
        self.assertFalse(str(caught.exception).startswith("driftlab:"))
        with self.assertRaisesRegex(InvalidInput, "absent.csv"):
            local.characterise("absent.csv", rate_hz=100)
        with self.assertRaises(InvalidInput):
            local.characterise("--help", rate_hz=100)  # a file of that name, which is not there; never an option
        with self.assertRaises(InvalidInput):
            local.outages("no-such-scenario")

    def test_the_program_is_that_of_the_argument_the_environment_or_the_path(self) -> None:
        real = os.environ["DRIFTLAB"]
        with mock.patch.dict(os.environ, {"DRIFTLAB": "/nowhere/driftlab"}):
            with self.assertRaisesRegex(FileNotFoundError, "There is no program '/nowhere/driftlab'"):
                local.simulate(duration_s=10)
            self.assertEqual(len(local.simulate(duration_s=10, program=real).samples), 1000)
        with mock.patch.dict(os.environ, {"PATH": str(Path(real).parent)}):
            del os.environ["DRIFTLAB"]
            self.assertEqual(len(local.simulate(duration_s=10).samples), 1000)

    def test_a_program_that_dies_is_a_server_problem(self) -> None:
        program = self.folder / "dies"
        program.write_text("#!/bin/sh\necho 'driftlab: out of memory' >&2\nexit 1\n")
        program.chmod(0o755)
        with self.assertRaisesRegex(ServerProblem, "out of memory"):
            local.outages(program=program)


if __name__ == "__main__":
    unittest.main()
