"""driftlab as a user runs it: every command in its process and through a daemon, the same result, sentences and exit codes."""
from __future__ import annotations

import gzip
import json
import math
import os
import random
import subprocess
import tempfile
import time
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import samples
from daemon import PATIENCE_S
from suite import DaemonTest

PROGRAM = os.environ["DRIFTLAB"]

SCENARIO: dict[str, Any] = {
    "name": "one turn", "duration_s": 45, "imu_rate_hz": 20,
    "trajectory": {"start": {"speed_m_s": 15}, "segments_by_start_time": [{"t_s": 30, "kind": "turn", "rate_deg_s": 9, "duration_s": 10}]},
    "outages": [{"start_s": 30, "duration_s": 10}],
    "truth": {"gyro": {"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}]},
              "accelerometer": {"white_noise_mg_per_sqrt_hz": 2, "constant_bias_sd_mg": 10}},
    "filters": [{"name": "matched"}],
}


class CommandLine(DaemonTest):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-test-")))
        for condition, name in (("static", "rest.csv"), ("constant_rate:z:9:deg/s", "turning.csv")):
            made = cls.driftlab("simulate", "--preset", "iphone5s-z", "--condition", condition, "--duration-s", "60", "--seed", "4", "--out", name)
            if made.returncode != 0:
                raise AssertionError(made.stderr)

    @classmethod
    def driftlab(cls, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([PROGRAM, *arguments], cwd=cls.folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)

    def said(self, *arguments: str) -> str:
        """What a command that must succeed prints."""
        done = self.driftlab(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def refused(self, exit_code: int, *arguments: str) -> str:
        """The one sentence of a command that must fail."""
        done = self.driftlab(*arguments)
        self.assertEqual((done.returncode, done.stdout), (exit_code, ""), done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertNotIn("\r", done.stderr, "a progress bar belongs on a terminal")
        return done.stderr

    @property
    def server(self) -> tuple[str, str]:
        return ("--server", f"http://127.0.0.1:{self.daemon.port}")

    def test_characterise_prints_a_table_of_the_condition(self) -> None:
        table = self.said("characterise", "rest.csv", "--rate-hz", "100")
        self.assertIn("static", table)
        self.assertIn("deg/sqrt(h)", table)

    def own_file(self, name: str, values: list[float], stamps: list[float] | None = None) -> None:
        """A file with a quaternion beside its gyroscope, in milli-degrees a second."""
        lines = ["t (s),q_w,gz [mdps]"]
        for i, value in enumerate(values):
            lines.append(f"{stamps[i] if stamps else 0.01 * i:.6f},{0.5 + 0.1 * math.sin(i):.4f},{1000 * value:.6g}")
        (self.folder / name).write_text("\n".join(lines) + "\n", encoding="utf-8")

    def test_what_is_wrong_with_a_recording_stands_under_its_table(self) -> None:
        # A sensor frozen for most of a file was tabled unmarked: its notes were in --json alone.
        noise = random.Random(5)
        values = [noise.gauss(0, 0.1) for _ in range(6000)]
        self.own_file("frozen.csv", values[:2000] + [values[1999]] * 3000 + values[2000:])
        table = self.said("characterise", "frozen.csv", "--models", "WN")
        self.assertIn("! frozen: Column 'gz [mdps]': the sensor is frozen for 300", table)
        self.assertIn("\nstatic *  ", table, "the row is marked")
        self.assertIn("! static: The sensor is frozen for 3001 samples, which are not analysed.", table)
        self.assertEqual(self.said("characterise", "frozen.csv", "--models", "WN", *self.server, "--device", "frozen"), table)
        stored = self.said("table", *self.server, "--device", "frozen", "--sensor", "gyroscope", "--axis", "z")
        self.assertIn("\nstatic *  ", stored)
        self.assertIn("frozen for 3001 samples", stored)
        self.assertIn("skipped: 'q_w'", table)
        self.assertNotIn("sensor q_w", table)

    def test_a_clock_that_starts_again_is_said_with_the_part_that_is_analysed(self) -> None:
        # A logger that restarts begins at 0 again: half a file was left out unmentioned.
        noise = random.Random(8)
        values = [noise.gauss(0, 0.1) for _ in range(12000)]
        self.own_file("restart.csv", values, [0.01 * (i if i < 5000 else i - 5000) for i in range(12000)])
        self.own_file("second.csv", values[5000:])
        text = self.said("characterise", "restart.csv", "--models", "WN")
        self.assertIn("! restart: The time column steps back once, by 49.99 s, before sample 5001; the recording is split there and its longest "
                      "part analysed, samples 5001 to 12000; the other 5000 are left out.\n", text)
        self.assertNotIn("Too much is missing", text)
        whole, part = (json.loads(self.said("characterise", name, "--models", "WN", "--json"))["recordings"][0] for name in ("restart.csv", "second.csv"))
        self.assertEqual(whole["quality"]["backward_steps"], 1)
        for mine, other in zip(whole["channels"][0]["allan"]["deviation"], part["channels"][0]["allan"]["deviation"], strict=True):
            self.assertAlmostEqual(mine / other, 1, delta=1e-9)
        self.assertEqual(self.said("characterise", "restart.csv", "--models", "WN", *self.server, "--device", "restarted").splitlines()[-2:], text.splitlines()[-2:])

    def test_counts_are_read_by_their_scale_and_offset_at_every_door(self) -> None:
        """A thermometer of raw/340+36.53 and a gyroscope of 131 LSB/(deg/s) could not be said where the header does not say them."""
        noise = random.Random(9)
        counts = [round(131 * noise.gauss(9, 0.1)) for _ in range(4000)]
        heat = [-3000 + i // 100 for i in range(4000)]
        (self.folder / "counts.csv").write_text("gz,temp\n" + "".join(f"{c},{h}\n" for c, h in zip(counts, heat)))
        (self.folder / "plain.csv").write_text("gz,temp\n" + "".join(f"{c / 131!r},{h / 340 + 36.53!r}\n" for c, h in zip(counts, heat)))
        turning = ("--rate-hz", "100", "--condition", "constant_rate:z:9:deg/s", "--models", "WN")
        stated = "gz=angular_rate:z:deg/s/131,temp=temperature::raw/340+36.53 degC"

        def noise_of(*arguments: str) -> float:
            [recording] = json.loads(self.said("characterise", *arguments, "--json"))["recordings"]
            return float(recording["channels"][0]["allan_parameters"]["N"]["value"])

        plain = noise_of("plain.csv", *turning, "--columns", "gz=angular_rate:z:deg/s,temp=temperature::degC")
        self.assertAlmostEqual(noise_of("counts.csv", *turning, "--columns", stated) / plain, 1, delta=1e-9)
        self.assertAlmostEqual(noise_of("counts.csv", *turning, "--columns", stated, *self.server, "--device", "counts") / plain, 1, delta=1e-9)
        [recording] = self.daemon.items("/v1/recordings?device=counts")
        self.assertEqual({name: role["unit"] for name, role in recording["metadata"]["columns"].items()}, {"gz": "deg/s/131", "temp": "raw/340+36.53 degC"})
        columns = {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "131 LSB/(deg/s)"}, "temp": {"quantity": "temperature", "unit": "degC/340+36.53"}}
        study: dict[str, Any] = {"device": {"id": "counted"}, "recordings": [
            {"file": "counts.csv", "rate_hz": 100, "columns": columns, "condition": {"kind": "constant_rate", "axis": "z", "value": 9, "unit": "deg/s"}}]}
        (self.folder / "counted.json").write_text(json.dumps(study))
        self.assertAlmostEqual(noise_of("counted.json", "--models", "WN") / plain, 1, delta=1e-9)
        columns["temp"]["unit"] = "degC/0+36.53"
        (self.folder / "counted.json").write_text(json.dumps(study))
        for wrong in (("counted.json",), ("counts.csv", "--rate-hz", "100", "--columns", "temp=temperature::degC/0+36.53")):
            self.assertIn("The scale in the unit 'degC/0+36.53' must be a positive number; write ", self.refused(2, "characterise", *wrong))

    def test_noise_that_is_not_one_noise_is_said_to_be_several(self) -> None:
        # One jump of 50 standard deviations was fitted as WN+GM with a J-test of p = 0.97, and nothing said.
        noise = random.Random(6)
        self.own_file("jump.csv", [noise.gauss(0, 0.1) + (5 if i >= 4000 else 0) for i in range(10000)])
        self.assertIn("gz [mdps]: Not one noise: the level jumps ", self.said("characterise", "jump.csv", "--models", "WN,WN+GM"))
        channel = json.loads(self.said("characterise", "jump.csv", "--models", "WN", "--json", "--dynamic=8"))["recordings"][0]["channels"][0]
        [change] = channel["stationarity"]["changes"]
        self.assertEqual((change["kind"], change["unit"]), ("jump", "mdeg/s"))
        self.assertAlmostEqual(change["time_s"], 40, delta=0.05)
        self.assertAlmostEqual(change["size"], 5000, delta=150)
        self.assertEqual([round(bound) for bound in channel["stationarity"]["segment_s"]], [40, 100])
        self.assertEqual(len(channel["dynamic_allan"]["deviation"]), 8)

    def test_a_file_that_lost_a_fifth_of_its_rows_has_the_noise_of_its_sensor(self) -> None:
        # Above 2 % lost at random the stamps were read as bursts, time was stretched, and N was 41 % off at half lost.
        noise = random.Random(7)
        kept = [i for i in range(20000) if noise.random() > 0.2]
        self.own_file("lost.csv", [noise.gauss(0, 0.1) for _ in kept], [0.01 * i for i in kept])
        [recording] = json.loads(self.said("characterise", "lost.csv", "--models", "WN", "--json"))["recordings"]
        self.assertAlmostEqual(recording["rate_hz"], 100, places=6)
        self.assertEqual(recording["quality"]["missing"], kept[-1] - kept[0] + 1 - len(kept))
        deviation = recording["channels"][0]["allan"]["deviation"][0]  # 0.1 deg/s; 2 % is four standard errors
        self.assertAlmostEqual(deviation, 100, delta=2)

    def test_a_bare_file_takes_rate_columns_and_condition(self) -> None:
        rows = [row for row in (self.folder / "rest.csv").read_text().splitlines() if not row.startswith("#")]
        (self.folder / "bare.csv").write_text("v\n" + "\n".join(rows[1:]) + "\n")
        bare = ("bare.csv", "--rate-hz", "100", "--columns", "v=angular_rate:z:deg/s", "--condition", "static")
        found = json.loads(self.said("characterise", *bare, "--json"))
        channels = found["recordings"][0]["channels"]
        self.assertEqual([(c["quantity"], c["axis"]) for c in channels], [("angular_rate", "z")])
        self.assertIn("stated rate", self.refused(2, "characterise", "bare.csv", "--columns", "v=angular_rate:z:deg/s"))

    def test_through_a_daemon_it_finds_the_same(self) -> None:
        here = json.loads(self.said("characterise", "rest.csv", "turning.csv", "--rate-hz", "100", "--json"))
        there = json.loads(self.said("characterise", "rest.csv", "turning.csv", "--rate-hz", "100", "--json",
                                     *self.server, "--device", "same"))
        for mine, theirs in zip(here["recordings"], there["recordings"], strict=True):
            for channel, other in zip(mine["channels"], theirs["channels"], strict=True):
                self.assertEqual(channel["fits"], other["fits"])
                self.assertEqual(channel["allan"], other["allan"])
        table = self.said("table", *self.server, "--device", "same", "--sensor", "gyroscope", "--axis", "z")
        self.assertIn("static", table)

    def test_a_study_through_a_daemon_prints_the_same_text(self) -> None:
        """The daemon's names of results were not those of the recordings here, so that replicates were averaged instead of fitted jointly."""
        recordings = []
        for number, condition in enumerate(({"kind": "static"}, {"kind": "static"}, {"kind": "constant_rate", "axis": "z", "value": 9, "unit": "deg/s"})):
            [column] = samples.noise(20000, 1, 70 + number)
            walk, lines = 0.0, ["gz"]
            for value in column:
                walk = 0.999 * walk + 0.02 * value
                lines.append(f"{value + walk:.6f}")
            (self.folder / f"part {number}.csv").write_text("\n".join(lines) + "\n")
            recordings.append({"id": f"run {3 - number}", "file": f"part {number}.csv", "rate_hz": 50, "condition": condition,
                               "columns": {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}})
        (self.folder / "printed.json").write_text(json.dumps({"device": {"id": "printed"}, "recordings": recordings}))
        here = self.said("characterise", "printed.json", "--models", "WN,WN+GM")
        self.assertIn("run 3", here)
        self.assertEqual(self.said("characterise", "printed.json", "--models", "WN,WN+GM", *self.server), here)

    def test_a_rate_that_exact_stamps_confirm_is_believed_where_half_is_lost(self) -> None:
        [column] = samples.noise(60000, 1, 80)
        draw = random.Random(80)
        kept = [row for row in range(60000) if row % 2 == 0 or draw.random() < 0.05]  # the median step is two samples
        (self.folder / "lossy.csv").write_text("t [s],gz [deg/s]\n" + "".join(f"{row / 100:.2f},{column[row]:.6f}\n" for row in kept))
        text = self.said("characterise", "lossy.csv", "--rate-hz", "100", "--models", "WN")
        self.assertIn("nothing is put in their place", text)
        self.assertRegex(text, r"white noise of (5\.[89]|6\.[012])\d* deg/sqrt\(h\)")
        refusal = self.refused(2, "characterise", "lossy.csv", "--rate-hz", "90")
        self.assertIn("Leave the rate out to go by the time column.", refusal)

    def test_outages_through_a_daemon_are_the_same_to_the_bit(self) -> None:
        (self.folder / "turn.json").write_text(json.dumps(SCENARIO))
        run = ("outages", "--scenario", "turn.json", "--runs", "8", "--seed", "3", "--json")
        here, there = json.loads(self.said(*run)), json.loads(self.said(*run, *self.server))
        self.assertEqual(here["filters"], there["filters"])

    def test_an_investigation_of_a_study_is_a_page(self) -> None:
        study = {"device": {"id": "paged"}, "recordings": [
            {"id": "rest", "file": "rest.csv", "rate_hz": 100, "condition": {"kind": "static"}},
            {"id": "again", "file": "rest.csv", "rate_hz": 100, "condition": {"kind": "static"}}]}
        (self.folder / "study.json").write_text(json.dumps(study))
        page = self.said("investigate", "study.json")
        self.assertTrue(page.startswith("#"))
        self.assertIn("position error", page)
        self.said("investigate", "study.json", "--out", "report.json", "--markdown", "report.md")
        self.assertEqual((self.folder / "report.md").read_text(), page)
        report = json.loads((self.folder / "report.json").read_text())
        self.assertGreater(report["gain"]["outage_error_m"]["baseline"], 0)

    def test_a_model_with_effects_is_simulated_as_it_says(self) -> None:
        model = {"processes": [{"process": "white_noise", "params": {"N": {"value": 0.01, "unit": "deg/sqrt(s)"}}}],
                 "effects": [{"cause": "missing_samples", "params": {"fraction": {"value": 0.1, "unit": "1"}}},
                             {"cause": "output_resolution", "params": {"step": {"value": 0.5, "unit": "deg/s"}}},
                             {"cause": "temperature_bias", "params": {"coefficient": {"value": 1, "unit": "deg/s/degC"},
                                                                 "lag_s": {"value": 0, "unit": "s"}}}]}
        (self.folder / "model.json").write_text(json.dumps({"extended_model": model}))
        made = self.driftlab("simulate", "--model", "model.json", "--duration-s", "100", "--out", "effects.csv")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("temperature_bias", made.stderr, "an effect that cannot act is named")
        rows = [row.split(",") for row in (self.folder / "effects.csv").read_text().splitlines() if row[0].isdigit()]
        self.assertTrue(8700 < len(rows) < 9300, len(rows))
        self.assertTrue(all(abs(float(value) / 0.5 - round(float(value) / 0.5)) < 1e-6 for _, value in rows))
        model["channels"] = {"gz": {"processes": model["processes"]}}
        (self.folder / "model.json").write_text(json.dumps(model))
        self.assertIn("'gq'", self.refused(2, "simulate", "--model", "model.json", "--channel", "gq", "--out", "none.csv"))
        self.assertFalse((self.folder / "none.csv").exists())

    def test_what_is_simulated_is_read_back_and_an_array_says_with_what(self) -> None:
        self.assertIn("deg/sqrt(h)", self.said("characterise", "rest.csv"))
        made = self.driftlab("simulate", "--duration-s", "60", "--seed", "4", "--out", "rest.npy")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("--rate-hz 100", made.stderr)
        self.assertIn("0 is gz [deg/s]", made.stderr)
        self.assertIn("gyroscope z", self.said("characterise", "rest.npy", "--rate-hz", "100", "--columns", "0=angular_rate:z:deg/s"))

    def test_what_is_simulated_is_packed_as_its_name_says(self) -> None:
        for name in ("plain.csv", "packed.csv.gz", "plain.npy", "packed.npy.gz"):
            self.said("simulate", "--duration-s", "60", "--seed", "4", "--out", name)
        for packed, plain in (("packed.csv.gz", "plain.csv"), ("packed.npy.gz", "plain.npy")):
            self.assertEqual(gzip.decompress((self.folder / packed).read_bytes()), (self.folder / plain).read_bytes())
        self.assertIn("gyroscope z", self.said("characterise", "packed.csv.gz"))
        self.assertIn("gyroscope z", self.said("characterise", "packed.npy.gz", "--rate-hz", "100", "--columns", "0=angular_rate:z:deg/s"))
        self.assertIn("as .gz alone", self.refused(2, "simulate", "--duration-s", "60", "--out", "packed.csv.xz"))
        self.assertFalse((self.folder / "packed.csv.xz").exists())
        self.assertIn("cannot be written", self.refused(2, "simulate", "--duration-s", "60", "--out", "absent/rest.csv.gz"))
        if Path("/dev/full").exists():
            self.assertIn("cannot be written", self.refused(2, "simulate", "--duration-s", "60", "--out", "/dev/full"))

    def test_a_first_column_of_time_may_be_named_with_its_unit_at_once(self) -> None:
        rows = "\n".join(f"{i / 100:.2f}\t{(i * 7919) % 101 / 100:.2f}" for i in range(3000))
        (self.folder / "bare.txt").write_text(rows + "\n")
        text = self.said("characterise", "bare.txt", "--columns", "0=time:s,1=angular_rate:z:deg/s")
        self.assertEqual(text, self.said("characterise", "bare.txt", "--columns", "0=time::s,1=angular_rate:z:deg/s"))
        self.assertIn("gyroscope z", text)

    def test_what_cannot_be_is_one_sentence_and_an_exit_code(self) -> None:
        self.assertIn("absent.csv", self.refused(2, "characterise", "absent.csv"))
        (self.folder / "broken.csv").write_text("t [s],gz [deg/s]\n0,1\n0.01,x\n")
        self.assertIn("Row 3", self.refused(2, "characterise", "broken.csv"))
        self.refused(4, "characterise", "rest.csv", "--rate-hz", "100", "--server", "http://127.0.0.1:1")
        self.refused(4, "outages", "--runs", "2", "--server", "http://127.0.0.1:1")
        self.assertEqual(self.driftlab("no-such-command").returncode, 2)

    def test_flags_that_describe_recordings_are_refused_beside_a_study(self) -> None:
        """They changed nothing there, and nothing was said."""
        still = {"file": "rest.csv", "rate_hz": 100, "condition": {"kind": "static"}}
        (self.folder / "beside.json").write_text(json.dumps({"device": {"id": "imu-07"}, "recordings": [still]}))
        self.said("characterise", "beside.json", "--device", "imu-08", "--models", "WN")
        for flag, value in (("--rate-hz", "50"), ("--columns", "gz=angular_rate:z:deg/s"), ("--stream", "imu2"),
                            ("--condition", "constant_rate:z:9:deg/s"),
                            ("--calibration", "half.json"), ("--skip-lines", "2"), ("--comment", ";")):
            with self.subTest(flag):
                self.assertIn(f"{flag} cannot stand beside it", self.refused(2, "characterise", "beside.json", flag, value))

    def test_lines_above_a_table_are_left_out_where_a_triad_is_calibrated(self) -> None:
        draw = random.Random(3)

        def attitude() -> list[float]:
            along = [draw.gauss(0.0, 1.0) for _ in range(3)]
            return [9.80665 * value / math.hypot(*along) for value in along]
        rows = []
        for _ in range(14):
            rests = attitude()
            rows += [[value + draw.gauss(0.0, 0.01) for value in rests] for _ in range(500)]
            rows += [[value + draw.gauss(0.0, 3.0) for value in attitude()] for _ in range(100)]
        lines = ["; by hand", "12"] + [",".join(f"{value:.5f}" for value in row) for row in rows]
        (self.folder / "turned.csv").write_text("\n".join(lines))
        told = ("--rate-hz", "100", "--columns", "0=specific_force:x,1=specific_force:y,2=specific_force:z")
        self.assertIn("the first row has 1", self.refused(2, "calibrate", "turned.csv", *told))
        self.assertIn("from 14 positions", self.said("calibrate", "turned.csv", "--skip-lines", "2", "--comment", ";", *told))


class BehindALongJob(DaemonTest):
    """One worker, which a long evaluation keeps from pooling what commands ask for."""

    arguments = ("--workers", "1")
    # A command asks again where 20 s did not suffice (clients/cli/http_client.cpp): it is held a little longer.
    HELD_S = 21.0

    def keep_busy(self, seed: int) -> str:
        answer = self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 100_000, "seed": seed})
        return str(self.expect(202, answer).json["id"])

    def release(self, job: str) -> None:
        self.daemon.post(f"/v1/jobs/{job}/cancel")
        self.daemon.finished(job)

    def table(self, device: str) -> dict[str, Any]:
        target = f"/v1/parameter-tables?device={device}&sensor=gyroscope&axis=z&method=gmwm"
        return dict(self.expect(200, self.daemon.get(target)).json)

    def until(self, reached: Callable[[], bool]) -> None:
        end = time.monotonic() + PATIENCE_S
        while not reached():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def start(self, *arguments: str) -> subprocess.Popen[str]:
        command = [PROGRAM, *arguments, "--server", f"http://127.0.0.1:{self.daemon.port}"]
        started = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(started.kill)
        return started

    def printed(self, command: subprocess.Popen[str]) -> str:
        out, error = command.communicate(timeout=PATIENCE_S)
        self.assertEqual(command.returncode, 0, error)
        return out

    def test_what_they_print_is_what_was_pooled(self) -> None:
        # A table that is asked for while its recordings wait to be fitted jointly has averages, which the next one replaces: both
        # commands wait, and without that only a race would show it.
        with tempfile.TemporaryDirectory(prefix="driftlab-test-") as folder:
            files = []
            for seed in (1, 2):
                files.append(f"{folder}/rest {seed}.csv")
                Path(files[-1]).write_bytes(samples.gyro_csv(20_000, seed=seed))
            before = self.keep_busy(seed=1)
            characterise = self.start("characterise", *files, "--rate-hz", "100", "--columns", samples.GYRO_Z, "--models", "WN,WN+RW", "--device", "held")
            self.until(lambda: bool(self.daemon.items("/v1/jobs?kind=characterise")))
            behind = self.keep_busy(seed=2)  # queued after the characterisation, and before its pooling
            self.release(before)
            [job] = self.daemon.items("/v1/jobs?kind=characterise")
            self.assertEqual(self.daemon.finished(job["id"])["state"], "succeeded")
            self.assertEqual(self.table("held")["pooling"]["state"], "pending")
            self.assertEqual([row["pooling"] for row in self.table("held")["rows"]], ["average"])
            table = self.start("table", "--device", "held", "--sensor", "gyroscope", "--axis", "z", "--method", "gmwm", "--format", "json")
            text = self.start("table", "--device", "held", "--sensor", "gyroscope", "--axis", "z", "--method", "gmwm")
            time.sleep(self.HELD_S)
            self.assertEqual(self.table("held")["pooling"]["state"], "pending", "the worker was to be busy all the while")
            self.assertEqual([command.poll() for command in (characterise, table, text)], [None] * 3, "all wait")
            self.release(behind)
            document = json.loads(self.printed(table))
            self.assertEqual((document["pooling"]["state"], [row["pooling"] for row in document["rows"]]), ("done", ["joint"]))
            self.assertNotIn("pending", self.printed(text))
            self.printed(characterise)
            self.assertEqual(document, self.table("held"))


if __name__ == "__main__":
    unittest.main()
