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
