"""Drives over HTTP: documents checked when they are stored, and answers that are those of the command line to the bit."""
from __future__ import annotations

import copy
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

import drive_documents
import samples
from suite import DaemonTest

PROGRAM = os.environ["DRIFTLAB"]
SHARED = Path(os.environ.get("DRIFTLAB_SHARED") or Path(__file__).resolve().parents[3] / "shared") / "data" / "drives"


class Asked(DaemonTest):
    def program(self, folder: Path, *arguments: str, exit_code: int = 0) -> str:
        done = subprocess.run([PROGRAM, "drive", *arguments], cwd=folder, capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(done.returncode, exit_code, done.stderr + done.stdout)
        return done.stderr if exit_code else done.stdout

    def here_and_there(self, folder: Path, *arguments: str) -> dict[str, Any]:
        here = self.program(folder, *arguments, "--json")
        there = self.program(folder, *arguments, "--server", f"http://127.0.0.1:{self.daemon.port}")
        self.assertEqual(there, here)
        return dict(json.loads(here))


class Drives(Asked):
    arguments = ("--workers", "1")

    def uploaded(self, device: str = "car", seed: int = 5) -> dict[str, Any]:
        readings, fixes = samples.drive_csvs(seed=seed)
        ids = [self.expect(201, self.daemon.upload(content, device=device, condition="drive", columns=samples.roles(columns))).json["id"]
               for content, columns in ((readings, samples.DRIVE_IMU), (fixes, samples.DRIVE_GNSS))]
        return samples.drive_document(*ids)

    def test_a_drive_is_kept_once_and_asked(self) -> None:
        document = self.uploaded()
        made = self.expect(201, self.daemon.post("/v1/drives", document))
        self.assertEqual((made.json["name"], made.json["vehicle"]), ("north", "road"))
        self.assertEqual(self.expect(200, self.daemon.post("/v1/drives", document)).json["id"], made.json["id"])
        self.assertEqual(self.expect(200, self.daemon.get(made.headers["location"])).json, made.json)
        self.assertEqual([each["id"] for each in self.daemon.items("/v1/drives?device=car")], [made.json["id"]])
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            local = copy.deepcopy(document)
            for source, content in zip(("imu", "gnss"), samples.drive_csvs()):
                (folder / f"{source}.csv").write_bytes(content)
                del local[source]["recording"]
                local[source]["file"] = f"{source}.csv"
            (folder / "drive.json").write_text(json.dumps(local))
            for question, arguments, body in (("run", ["--zupt", "--gate", "25"], {"zero_velocity": True, "gate": 25}),
                                              ("simulate", ["--runs", "2", "--nhc"], {"runs": 2, "velocity_constraint": True}),
                                              ("compare", ["--model", "document-white", "--model", "M_dyn(GMWM)", "--fit-noise"],
                                               {"models": [{"name": "document-white"}, {"name": "M_dyn(GMWM)"}], "fit_noise": True}),
                                              ("explain", ["--runs", "1", "--seed", "3"], {"runs": 1, "seed": 3})):
                with self.subTest(question=question):
                    asked = self.expect(202, self.daemon.post("/v1/drive-evaluations", {"drive": made.json["id"], "question": question, **body}))
                    self.assertEqual(self.daemon.finished(asked.json["id"])["state"], "succeeded")
                    found = self.expect(200, self.daemon.get(asked.headers["location"])).json
                    self.assertEqual((found["drive"], found["name"], found["question"]), (made.json["id"], "north", question))
                    here = self.program(folder, question, "drive.json", *arguments, "--json")
                    self.assertEqual(json.dumps(found["evaluation"]), json.dumps(json.loads(here)))
            there = self.program(folder, "run", "drive.json", "--server", f"http://127.0.0.1:{self.daemon.port}", "--device", "own")
            self.assertEqual(there, self.program(folder, "run", "drive.json", "--json"))
        again = {"drive": made.json["id"], "seed": 3, "runs": 1, "question": "explain"}
        self.expect(200, self.daemon.post("/v1/drive-evaluations", again))
        listed = self.daemon.items("/v1/drive-evaluations?state=succeeded")
        self.assertGreaterEqual(len(listed), 4)

    def test_model_and_outages_take_the_documents_place_and_name_what_is_stored(self) -> None:
        drive = self.expect(201, self.daemon.post("/v1/drives", self.uploaded("other", seed=6))).json["id"]
        white = {"process": "white_noise", "params": {"N": {"value": 1.5, "unit": "deg/sqrt(h)"}}}
        bias = {"cause": "bias_step", "channels": ["gz"], "params": {"step": {"value": 1, "unit": "deg/s"}, "t0_s": {"value": 60, "unit": "s"}}}
        model = self.expect(201, self.daemon.post("/v1/models", {"name": "white", "processes": [white], "effects": [bias]})).json["id"]
        believed = {"gyroscope": {"simulation_model": model, "constant_bias_sd_deg_s": 0.1}, "accelerometer": {"white_noise_mg_per_sqrt_hz": 0.3, "constant_bias_sd_mg": 5}}
        asked = self.expect(202, self.daemon.post("/v1/drive-evaluations", {
            "drive": drive, "model": believed, "outages": {"duration_s": [20], "every_s": [60], "phases": 1, "settle_s": 20}}))
        self.daemon.finished(asked.json["id"])
        result = self.expect(200, self.daemon.get(asked.headers["location"])).json["evaluation"]
        self.assertEqual([d["duration_s"] for d in result["durations"]], [20])
        self.assertEqual(result["left_out"], [{"where": "/model/gyroscope", "simulation_model": model, "what": ["bias_step"]}])
        for body, status, pointer in (({"drive": "drv_nobody"}, 404, "/drive"), ({"drive": drive, "question": "why"}, 400, "/question"),
                                      ({"drive": drive, "gate": -1}, 400, "/gate"), ({"drive": drive, "runs": 2}, 400, "/runs"),
                                      ({"drive": drive, "question": "explain", "odometer": True}, 400, "/odometer"),
                                      ({"drive": drive, "question": "explain", "estimate": True}, 400, "/estimate"),
                                      ({"drive": drive, "models": [{"name": "document"}, {"name": "document-white"}]}, 400, "/models"),
                                      ({"drive": drive, "question": "compare"}, 400, "/models"),
                                      ({"drive": drive, "question": "compare", "models": [{"name": "document"}, {"name": "mine"}]}, 400, "/models/1/name"),
                                      ({"drive": drive, "outages": {"phases": 0}}, 400, ""), ({"drive": drive, "colour": 1}, 400, "/colour"),
                                      ({"drive": drive, "model": {**believed, "gyroscope": {"fit": "fit_nobody"}}}, 404, "/model/gyroscope/fit")):
            with self.subTest(pointer=pointer):
                answer = self.expect(status, self.daemon.post("/v1/drive-evaluations", body))
                self.assertEqual([e["pointer"] for e in answer.json["errors"]], [pointer], answer.describe())

    def test_a_document_is_checked_before_it_is_kept(self) -> None:
        document = self.uploaded("third", seed=7)
        foreign = self.uploaded("fourth", seed=8)["gnss"]["recording"]

        def changed(path: str, value: Any) -> dict[str, Any]:
            copied = copy.deepcopy(document)
            node = copied
            *way, last = path.split("/")
            for step in way:
                node = node[step]
            node[last] = value
            return copied
        cases = [("gnss/recording", "rec_01M7YQ3DCXWFAG31PB3STSGKWY", "/gnss/recording", "no recording"), ("gnss/recording", foreign, "/gnss/recording", "another device"),
                 ("gnss/file", "gnss.csv", "/gnss/file", "file"), ("imu/time/tag", "imu.tag", "/imu/time/tag", "dates"), ("imu/time/column", "clock", "/imu/time/column", "clock"),
                 ("imu/columns/gx/unit", "furlong", "/imu/columns/gx/unit", "furlong"), ("gnss/columns/speed", {"quantity": "gnss_speed"}, "/gnss/columns", "speed"),
                 ("gnss/lever_arm_m", [300, 0, 0], "", "metres"), ("imu/time/dates", {"first_s": 2, "last_s": 1}, "/imu/time/dates", "time tag")]
        for path, value, pointer, said in cases:
            with self.subTest(path=path, value=value):
                answer = self.daemon.post("/v1/drives", changed(path, value))
                self.assertIn(answer.status, (400, 404, 422), answer.describe())
                self.assertEqual([e["pointer"] for e in answer.json["errors"]], [pointer], answer.describe())
                self.assertIn(said, answer.json["errors"][0]["detail"])
        self.problem(404, "not_found", self.daemon.get("/v1/drives/drv_nobody"))
        # A file of fixes says nothing to characterise, and is kept for drives alone.
        fixes = self.expect(200, self.daemon.get("/v1/recordings/" + document["gnss"]["recording"])).json
        self.assertEqual(fixes["quality"]["channels"], [])
        self.assertIn("for drives", fixes["quality"]["notes"][0])
        self.problem(422, "unknown_column", self.daemon.upload(samples.csv([[0.01 * i for i in range(50)]], ["t"]), columns="t=time::s"))

    def test_what_it_comes_to_is_the_newest_result_of_its_device(self) -> None:
        drive = self.expect(201, self.daemon.post("/v1/drives", self.uploaded("newest", seed=11))).json["id"]
        asked = self.expect(202, self.daemon.post("/v1/drive-evaluations", {"drive": drive, "question": "simulate", "runs": 1}))
        self.daemon.finished(asked.json["id"])
        told = self.expect(200, self.daemon.get(asked.headers["location"])).json["evaluation"]
        latest = self.expect(200, self.daemon.get("/v1/devices/newest/summary")).json["latest"]
        self.assertEqual((latest["kind"], latest["id"], latest["href"]), ("drive_evaluation", asked.json["id"], asked.headers["location"]))
        self.assertTrue(told["summary"].startswith(latest["verdict"]) and latest["verdict"].endswith("."), latest)
        trusted = all(each["coverage95"]["value"] >= 0.9 for each in told["durations"])
        self.assertEqual(latest["level"], "fine" if trusted else "look")
        looked = [each["job"] for each in self.daemon.items("/v1/attention?device=newest")]
        self.assertEqual(looked, [] if trusted else [asked.json["id"]])

    def test_a_recording_revised_since_is_not_mixed_in(self) -> None:
        document = self.uploaded("revised", seed=10)
        drive = self.expect(201, self.daemon.post("/v1/drives", document)).json["id"]
        first = self.expect(202, self.daemon.post("/v1/drive-evaluations", {"drive": drive})).json["id"]
        self.daemon.finished(first)
        change = {"trim": {"start_s": 0, "end_s": 1}}
        self.expect(200, self.daemon.request("PATCH", "/v1/recordings/" + document["imu"]["recording"], change, {"If-Match": "*"}))
        second = self.expect(202, self.daemon.post("/v1/drive-evaluations", {"drive": drive})).json["id"]
        self.assertNotEqual(second, first)


@unittest.skipUnless(SHARED.exists(), f"SKIPPED: the shared drives, for they are not in {SHARED} (set DRIFTLAB_SHARED)")
class Shared(Asked):
    def test_recorded_drives_are_the_same_here_and_there(self) -> None:
        for name, document, arguments in (("rtk-car-0708", drive_documents.car(), ["--nhc"]), ("phone-motorway-1104", drive_documents.phone(), []),
                                          ("umn-thor-flight75", drive_documents.aircraft(), [])):
            with self.subTest(drive=name), tempfile.TemporaryDirectory() as folder:
                drive_documents.link(Path(folder), SHARED / name)
                document["outages"] = {"duration_s": [10], "every_s": [40], "phases": 2, "settle_s": 60}
                (Path(folder) / "drive.json").write_text(json.dumps(document))
                self.assertGreater(self.here_and_there(Path(folder), "run", "drive.json", *arguments)["durations"][0]["n"], 5)


if __name__ == "__main__":
    unittest.main()
