"""Recorded drives as a user runs them: documents, refusals with the repair, and the shared recordings."""
from __future__ import annotations

import copy
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from random import Random
from typing import Any

import drive_documents
import samples
from suite import DaemonTest

PROGRAM = os.environ["DRIFTLAB"]
SHARED = Path(os.environ.get("DRIFTLAB_SHARED") or Path(__file__).resolve().parents[3] / "shared") / "data" / "drives"


class Folder(DaemonTest):
    folder: Path

    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="driftlab-drive-")))

    def drive(self, exit_code: int, verb: str, document: dict[str, Any], *arguments: str) -> str:
        """What `driftlab drive VERB` says of a document."""
        (self.folder / "drive.json").write_text(json.dumps(document))
        done = subprocess.run([PROGRAM, "drive", verb, "drive.json", *arguments], cwd=self.folder, capture_output=True, text=True,
                              timeout=300, check=False)
        self.assertEqual(done.returncode, exit_code, done.stderr + done.stdout)
        return done.stderr if exit_code else done.stdout


class MadeUp(Folder):
    def document(self) -> dict[str, Any]:
        readings, fixes = samples.drive_csvs()
        (self.folder / "imu.csv").write_bytes(readings)
        (self.folder / "gnss.csv").write_bytes(fixes)
        document = samples.drive_document("imu.csv", "gnss.csv")
        for source in ("imu", "gnss"):
            document[source]["file"] = document[source].pop("recording")
        return document

    def test_facts_and_outages(self) -> None:
        document = self.document()
        facts = json.loads(self.drive(0, "check", document, "--json"))
        self.assertEqual(facts["facts"]["imu"]["rows"], 4000)
        self.assertEqual(facts["start"]["heading_from"], "course")
        self.assertAlmostEqual(facts["start"]["heading_deg"], 0.0, delta=3.0)
        found = json.loads(self.drive(0, "run", document, "--json"))
        [ten] = found["durations"]
        self.assertGreaterEqual(ten["n"], 7)
        self.assertLess(ten["rms_m"]["value"], ten["straight_line_rms_m"])
        self.assertEqual(self.drive(0, "run", document, "--threads", "1"), self.drive(0, "run", document, "--threads", "2"))
        self.assertIn("measured error is", self.drive(0, "simulate", document, "--runs", "2"))

    def test_models_are_compared_through_the_same_outages(self) -> None:
        document = self.document()
        (self.folder / "loud.json").write_text(json.dumps(drive_documents.model(0.5, 0.1)))
        found = json.loads(self.drive(0, "compare", document, "--model", "document", "--model", "loud.json", "--model", "M_stat(AV)", "--json"))
        self.assertEqual([each["name"] for each in found["filters"]], ["document", "loud", "M_stat(AV)"])
        self.assertEqual([(pair["filter"], pair["against"]) for pair in found["differences"]],
                         [("loud", "document"), ("M_stat(AV)", "document"), ("M_stat(AV)", "loud")])
        [first, loud, _] = (each["durations"][0]["mean_m"] for each in found["filters"])
        self.assertAlmostEqual(found["differences"][0]["relative"]["value"], loud / first - 1.0, delta=1e-6)
        [alone] = json.loads(self.drive(0, "run", document, "--json"))["durations"]
        self.assertEqual(found["filters"][0]["durations"][0]["rms_m"]["value"], alone["rms_m"]["value"])
        text = self.drive(0, "compare", document, "--model", "document", "--model", "M_dyn(GMWM)")
        self.assertIn("difference from document larger than", text)
        self.assertIn("M_dyn(AV)", self.drive(2, "compare", document, "--model", "document", "--model", "none.json"))
        self.assertIn("at least two models", self.drive(2, "compare", document, "--model", "document"))

    def test_an_arm_of_a_stated_uncertainty_is_estimated_where_asked(self) -> None:
        document = self.document()
        document["gnss"].update({"lever_arm_m": [0, 0, 0], "lever_arm_sd_m": 1.0})
        known = json.loads(self.drive(0, "run", document, "--json"))
        self.assertTrue(any("taken as stated" in note for note in known["facts"]["notes"]), known["facts"]["notes"])
        estimated = json.loads(self.drive(0, "run", document, "--estimate", "--json"))
        self.assertGreater(estimated["durations"][0]["promised_rms_m"], known["durations"][0]["promised_rms_m"])

    def test_the_smoothed_path_is_a_table_and_a_reference(self) -> None:
        document = self.document()
        self.drive(0, "smooth", document, "--out", "path.csv")
        lines = [line for line in (self.folder / "path.csv").read_text().splitlines() if not line.startswith("#")]
        names = lines[0].split(",")
        rows = [dict(zip(names, map(float, line.split(",")))) for line in lines[1:]]
        times = [row[names[0]] for row in rows]
        self.assertEqual(times, sorted(times))
        self.assertGreater(times[-1] - times[0], 150)
        self.assertGreater(len(rows), 500)  # a 20 Hz unit: between its fixes every third of a second
        sd = "sn [m]"
        middle = [row[sd] for row in rows if 60 < row[names[0]] < 150]
        self.assertLess(max(middle), 1.0, "no better than a fix")
        self.assertIn("--out", self.drive(2, "smooth", document))
        withheld = json.loads(self.drive(0, "run", document, "--json"))
        document["reference"] = "smoothed_fixes"
        smoothed = json.loads(self.drive(0, "run", document, "--json"))
        self.assertTrue(any("smoothed" in note for note in smoothed["facts"]["notes"]), smoothed["facts"]["notes"])
        [mine], [theirs] = smoothed["durations"], withheld["durations"]
        self.assertGreaterEqual(mine["n"], theirs["n"] - 2)
        # The withheld fixes err by 1 m north and east themselves.
        self.assertNotEqual(mine["rms_m"]["value"], theirs["rms_m"]["value"])
        self.assertAlmostEqual(mine["rms_m"]["value"], theirs["rms_m"]["value"], delta=1.0)

    def test_an_odometer_carries_the_filter_through_outages(self) -> None:
        document = self.document()
        rows = [list(map(float, line.split(","))) for line in (self.folder / "gnss.csv").read_text().splitlines()[1:]]
        random = Random(7)
        speeds = [(row[0], row[4] + 0.02 * random.gauss(0, 1)) for row in rows]
        (self.folder / "wheel.csv").write_text("t,speed\n" + "".join(f"{time},{speed}\n" for time, speed in speeds))
        self.assertIn("odometer", self.drive(2, "run", document, "--odometer"))
        document["odometer"] = {"file": "wheel.csv", "columns": {"speed": drive_documents.role("odometer_speed", None, "m/s")},
                                "time": {"column": "t", "unit": "s", "scale": "gps"}, "sd_m_s": 0.05}
        [without] = json.loads(self.drive(0, "run", document, "--json"))["durations"]
        found = json.loads(self.drive(0, "run", document, "--odometer", "--json"))
        [with_it] = found["durations"]
        self.assertEqual(with_it["n"], without["n"])
        self.assertLess(with_it["promised_rms_m"], without["promised_rms_m"])
        self.assertLess(with_it["along_rms_m"], without["along_rms_m"])  # across the way a wheel says nothing
        counts = {each["kind"]: each["n"] for each in found["innovations"]}
        self.assertGreater(counts["odometer"], 150)

    def test_what_cannot_be_is_refused_with_the_repair(self) -> None:
        document = self.document()

        def changed(path: str, value: Any) -> dict[str, Any]:
            copied = copy.deepcopy(document)
            node = copied
            *way, last = path.split("/")
            for step in way:
                node = node[step]
            node[last] = value
            return copied
        cases = [
            ("imu/columns/ax/unit", "g", "m/s^2"),
            ("gnss/columns/lat/axis", "height", "does not measure"),
            ("gnss/columns/vn/unit", "km/h", "velocity's unit"),
            ("gnss/lever_arm_m", [300, 0, 0], "metres"),
            ("gnss/time/offset_s", 1e6, "overlap"),
            ("gnss/time/scale", "boot", "clock"),
            ("gnss/columns/lat/unit", "rad", "latitude"),
            ("imu/columns/gx/unit", "furlong", "furlong"),
            ("imu/columns/gx/unit", "deg/s/131+0.2", "offset, which a drive does not take"),
            ("imu/mounting_deg", [180, 0, 0], "down"),
            ("outages", {"duration_s": [10], "every_s": [20]}, "20 s of fixes"),
            ("outages", {"duration_s": [900], "every_s": [1000]}, "fits the drive"),
            ("vehicle", "submarine", "road"),
            ("surprise", 1, "surprise"),
            ("imu/file", "none.csv", "none.csv"),
        ]
        for path, value, said in cases:
            with self.subTest(path=path, value=value):
                unit = changed(path, value)
                if path == "imu/columns/ax/unit":
                    for axis in "xyz":
                        unit["imu"]["columns"][f"a{axis}"]["unit"] = "g"
                sentence = self.drive(2, "run", unit)
                self.assertEqual(len(sentence.strip().splitlines()), 1, sentence)
                self.assertIn(said, sentence)
        self.assertIn("does not move along its nose", self.drive(2, "run", changed("vehicle", "boat"), "--nhc"))

    def test_a_drive_at_rest_is_told_so(self) -> None:
        document = self.document()
        lines = (self.folder / "gnss.csv").read_text().splitlines()
        still = [line.split(",")[:4] + ["0.0", "0.0", "0.0"] for line in lines[1:]]
        (self.folder / "gnss.csv").write_text("\n".join([lines[0], *(",".join(row) for row in still)]) + "\n")
        self.assertIn("heading cannot be observed", self.drive(0, "check", document))
        self.assertIn("heading is not observable", self.drive(2, "run", document))


@unittest.skipUnless(SHARED.exists(), f"SKIPPED: the shared drives, for they are not in {SHARED} (set DRIFTLAB_SHARED)")
class Shared(Folder):
    def of(self, name: str, document: dict[str, Any], verb: str, *arguments: str) -> dict[str, Any]:
        drive_documents.link(self.folder, SHARED / name)
        return dict(json.loads(self.drive(0, verb, document, "--json", *arguments)))

    @unittest.skipIf(os.environ.get("DRIFTLAB_SANITIZE"), "takes ten times as long; drive_resources_test.py explains a drive of its own")
    def test_the_car_says_why_and_what_mending_gains(self) -> None:
        found = self.of("rtk-car-0708", drive_documents.car(), "explain")
        self.assertGreater(found["before"]["simulated"][0]["measured_over_simulated"]["value"], 20)
        self.assertGreater(found["before"]["durations"][0]["nees"]["value"], 1000)
        values = {f"{finding['cause']} {finding['parameter']}": finding["value"] for finding in found["findings"]}
        self.assertAlmostEqual(values["sample_clock rate_hz"], 97.90, delta=0.01)
        self.assertTrue(0.10 <= values["gnss_velocity_latency delay_s"] <= 0.13, values)
        # Specified were 0.12 to 0.15 s in size and an arm of 0.59 m: tests/DRIVES.md says what contradicts them.
        self.assertTrue(-0.20 <= values["imu_time_offset delta_s"] <= -0.15, values)
        self.assertTrue(0.05 <= values.get("gnss_lever_arm x", 0.1) <= 0.20, values)
        self.assertTrue(any(name.startswith("noise_level") for name in values), values)
        ten, thirty, sixty = (duration["rms_m"]["value"] for duration in found["after"]["durations"])
        self.assertLess(ten, 1.1 * 3.57)
        self.assertLess(thirty, 1.1 * 39.6)
        self.assertLess(sixty, 1.1 * 254)
        held_out = next(rung for rung in reversed(found["rungs"]) if rung["kept"])["durations"]
        self.assertGreaterEqual(held_out[0]["held_out"]["coverage95"], 0.85)
        self.assertGreaterEqual(held_out[1]["held_out"]["coverage95"], 0.90)
        for duration in held_out[:2]:
            self.assertTrue(0.40 <= duration["held_out"]["coverage50"] <= 0.75, duration)
        self.assertIn("vibration_noise gyroscope", values)
        sentences = [found["summary"], *found["notes"], *(rung["name"] for rung in found["rungs"]), *(f["words"] for f in found["findings"])]
        self.assertEqual([text for text in sentences if re.search(r"[a-z]_[a-z]", text)], [], "names of documents are not for people")
        self.assertIn("late velocities of fixes", found["summary"])

    @unittest.skipIf(os.environ.get("DRIFTLAB_SANITIZE"), "takes ten times as long; drive_resources_test.py explains a drive of its own")
    def test_the_car_with_velocity_constraints_is_mended_as_asked(self) -> None:
        found = self.of("rtk-car-0708", drive_documents.car(), "explain", "--nhc")
        for duration, asked in zip(found["after"]["durations"], (1.91, 7.6, 13.1), strict=True):
            self.assertLessEqual(duration["rms_m"]["value"], 1.1 * asked, duration["duration_s"])
        values = {f"{finding['cause']} {finding['parameter']}": finding["value"] for finding in found["findings"]}
        self.assertTrue(-0.20 <= values["imu_time_offset delta_s"] <= -0.12, values)
        self.assertEqual([finding for finding in found["findings"] if finding["score"] < 5], [])
        self.assertNotIn("initial_heading", {finding["cause"] for finding in found["findings"]})

    def test_rest_is_used_where_asked(self) -> None:
        found = self.of("rtk-car-0708", drive_documents.car(), "run", "--zupt")
        counts = {each["kind"]: each["n"] for each in found["innovations"]}
        self.assertGreater(counts["zero_velocity"], 50)
        self.assertGreater(counts["zero_turn"], 25)

    def test_phone_and_aircraft_run(self) -> None:
        phone = self.of("phone-motorway-1104", drive_documents.phone(), "run", "--nhc")
        self.assertLess(phone["durations"][0]["rms_m"]["value"], 12.5)
        self.assertTrue(phone["facts"]["gnss"]["speed_accuracy_constant"])
        aircraft = self.of("umn-thor-flight75", drive_documents.aircraft(), "run")
        self.assertLess(aircraft["durations"][0]["rms_m"]["value"], 19.9)
        self.assertGreater(aircraft["facts"]["gnss"]["held"], 30000)


if __name__ == "__main__":
    unittest.main()
