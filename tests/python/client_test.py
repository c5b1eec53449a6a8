"""The Python client against the real daemon: every operation once, results as objects, problems as exceptions."""
from __future__ import annotations

import contextlib
import hashlib
import io
import json
import math
import struct
import tempfile
import unittest
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

import numpy

import samples
from daemon import Daemon
from driftlab import Calibration, Client, Conflict, InvalidInput, JobCancelled, NotFound, Problem, Retry, Unavailable
from driftlab.contract import OPERATIONS, Drive
from driftlab.transport import Answer, Body, Query, Transport

SCENARIO: Any = {
    "name": "one turn", "duration_s": 60, "imu_rate_hz": 50,
    "trajectory": {"start": {"speed_m_s": 15}, "segments_by_start_time": [{"t_s": 30, "kind": "turn", "rate_deg_s": 9, "duration_s": 10}]},
    "outages": [{"start_s": 30, "duration_s": 10}],
    "truth": {"gyro": {"processes": [{"process": "white_noise", "params": {"N": {"value": 1.03, "unit": "deg/sqrt(h)"}}}],
                       "constant_bias_sd_deg_s": 0.05},
              "accelerometer": {"white_noise_mg_per_sqrt_hz": 2, "constant_bias_sd_mg": 10}},
    "filters": [{"name": "matched"}]}


class ClientTest(unittest.TestCase):
    daemon: Daemon
    client: Client

    @classmethod
    def setUpClass(cls) -> None:
        cls.daemon = cls.enterClassContext(Daemon())
        cls.client = Client(f"http://127.0.0.1:{cls.daemon.port}")

    def recording(self, device: str, seed: int = 1, **more: Any) -> str:
        return self.client.upload(samples.gyro_csv(seed=seed), device=device, rate_hz=100, columns=samples.GYRO_Z, **more)["id"]


class Uploads(ClientTest):
    def test_a_file_is_uploaded_with_progress_and_is_there_once(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "long.csv")
            path.write_bytes(samples.gyro_csv(60000))
            size = path.stat().st_size
            seen: list[tuple[int, int]] = []
            made = self.client.upload(path, device="progress", rate_hz=100, columns=samples.GYRO_Z,
                                      progress=lambda sent, total: seen.append((sent, total)))
        self.assertEqual(made["file"].get("bytes"), size)
        self.assertGreater(len(seen), 1)
        self.assertEqual(seen[-1], (size, size))
        self.assertEqual(sorted(seen), seen)
        stream = io.BytesIO(b"not of it" + samples.gyro_csv(60000))
        stream.seek(9)
        again = self.client.upload(stream, device="progress", rate_hz=100, columns=samples.GYRO_Z)
        self.assertEqual(again["id"], made["id"])

    def test_an_array_is_uploaded_as_it_is(self) -> None:
        noise = numpy.random.default_rng(1).normal(size=(2000, 2))
        made = self.client.upload(noise, device="array", rate_hz=50,
                                  condition={"kind": "constant_rate", "axis": "x", "value": 9, "unit": "deg/s"},
                                  columns={"0": {"quantity": "angular_rate", "axis": "x", "unit": "deg/s"},
                                           "1": {"quantity": "temperature", "unit": "degC"}})
        self.assertEqual(made["file"].get("rows"), 2000)
        self.assertEqual(made["metadata"]["condition"], {"kind": "constant_rate", "axis": "x", "value": 9.0, "unit": "deg/s"})
        self.assertEqual(made["metadata"]["columns"]["1"], {"quantity": "temperature", "unit": "degC"})

    def test_an_answer_that_comes_before_the_body_is_whole_counts(self) -> None:
        """The daemon refuses an upload by its head, answers and closes; the broken pipe is not what the user is told."""
        with self.assertRaises(InvalidInput) as caught:
            self.client.upload(bytes(1 << 26), device="x" * 300)
        self.assertEqual((caught.exception.status, caught.exception.code), (400, "invalid_argument"))

    def test_columns_that_the_query_cannot_name_are_refused_with_the_way_out(self) -> None:
        with self.assertRaisesRegex(ValueError, "by its number"):
            self.client.upload(b"a,b\n1\n", device="x", columns={"a,b": {"quantity": "angular_rate"}})


class Problems(ClientTest):
    def test_a_refused_file_is_an_exception_with_every_member(self) -> None:
        with self.assertRaises(InvalidInput) as caught:
            self.client.upload(b"gz\n1\nx\n", device="faulty", rate_hz=100)
        problem = caught.exception
        self.assertEqual((problem.status, problem.code, problem.where["row"], problem.retryable), (422, "not_a_number", 3, False))
        self.assertEqual(problem.type, "/problems/not-a-number")
        self.assertIn("Row 3", str(problem))
        self.daemon.logged(request_id=problem.request_id)
        self.assertIn("decimal number", self.client.problem_type("not-a-number"))

    def test_each_fault_of_a_body_is_named(self) -> None:
        request: Any = {"kind": "characterise", "inputs": {"recordings": ["x"]}, "priority": 99}
        with self.assertRaises(InvalidInput) as caught:
            self.client.create_job(request)
        self.assertEqual([fault["pointer"] for fault in caught.exception.errors], ["/priority"])
        self.assertIn("0 (first) to 9", str(caught.exception))

    def test_status_decides_the_class(self) -> None:
        with self.assertRaises(NotFound):
            self.client.job("job_" + "0" * 26)
        recording = self.recording("conflicts")
        with self.assertRaises(Conflict):
            self.client.upload(samples.gyro_csv(), device="conflicts", rate_hz=50, columns=samples.GYRO_Z)
        etag = self.client.recording_etag(recording)
        self.client.change_recording(recording, {"condition": {"kind": "drive"}}, if_match=etag)
        with self.assertRaises(Conflict) as caught:
            self.client.change_recording(recording, {"condition": {"kind": "static"}}, if_match=etag)
        self.assertEqual(caught.exception.status, 412)

    def test_an_address_without_a_daemon_is_unavailable(self) -> None:
        with self.assertRaises(Unavailable) as caught:
            Client("http://127.0.0.1:1", retry=Retry(attempts=2, sleep=lambda s: None)).health()
        self.assertEqual((caught.exception.status, caught.exception.code), (0, "not_connected"))
        self.assertIn("http://127.0.0.1:1", str(caught.exception))
        for address in ("127.0.0.1:8477", "ftp://x", "http://"):
            with self.assertRaisesRegex(ValueError, "no address of a daemon"):
                Client(address)

    def test_a_job_that_fails_raises_its_own_problem(self) -> None:
        recording = self.client.upload(b"gz\n1\n2\n3\n", device="short", rate_hz=100, columns=samples.GYRO_Z)["id"]
        with self.assertRaises(Problem) as caught:
            self.client.characterise(recording)
        self.assertEqual(caught.exception.code, "too_few_samples")

    def test_waiting_ends_at_the_time_given_and_a_cancelled_job_says_so(self) -> None:
        queued = self.client.create_outage_evaluation({"scenario": "paper", "runs": 20000})
        with self.assertRaises(TimeoutError):
            self.client.wait(queued["id"], timeout_s=0.2)
        self.client.cancel_job(queued["id"])
        with self.assertRaises(JobCancelled):
            self.client.wait(queued["id"])


class Results(ClientTest):
    def test_a_characterisation_is_arrays_and_rows(self) -> None:
        first, second = self.recording("results", 1), self.recording("results", 2, condition="constant_rate:z:9:deg/s")
        stages: list[str] = []
        found = self.client.characterise(first, second, models=["WN", "WN+GM"], progress=lambda f, stage: stages.append(stage))
        self.assertTrue(stages)
        with self.assertRaisesRegex(KeyError, "2 channels"):
            found.channel("gz")
        channel = found.channel("gz", recording=first)
        curve = channel.allan
        self.assertTrue(numpy.all(curve.low <= curve.deviation) and numpy.all(curve.deviation <= curve.high))
        # White noise of standard deviation 1: the first octave is 1 within four standard errors, 4/sqrt(2*512).
        self.assertAlmostEqual(curve.deviation[0], 1.0, delta=0.13)
        numpy.testing.assert_allclose(channel.haar.deviation * numpy.sqrt(2.0), curve.deviation, rtol=1e-9)
        numpy.testing.assert_allclose(channel.haar.tau_s, curve.tau_s)
        best = channel.best
        assert best is not None
        row = next(row for row in channel.rows() if row["parameter"] == "white_noise.N")
        self.assertEqual(row["value"], best["processes"][0]["params"]["N"]["value"])  # type: ignore[index]
        self.assertEqual(row["value.unit"], "deg/sqrt(h)")
        table = self.client.parameter_table("results", axis="z", model="WN")
        self.assertEqual([row["condition"] for row in table.rows()], ["static", "9 deg/s about z"])
        self.assertIsInstance(table.value("static", "white_noise.N"), float)
        self.assertIn("<table>", table._repr_html_())
        self.assertIn("white_noise.N", self.client.parameter_table_text("results", media="text/csv", axis="z", model="WN"))

    def test_lists_go_on_to_the_last_page(self) -> None:
        names = [f"many-{number}" for number in range(7)]
        for name in names:
            self.client.create_device(name)
        found = [device["name"] for device in self.client.devices(page_size=2) if device["name"].startswith("many-")]
        self.assertEqual(found, names)
        listed = [device["name"] for device in self.client.devices(page_size=2, sort="name")]
        self.assertEqual([name for name in listed if name.startswith("many-")], sorted(names))

    def test_a_calibration_corrects_readings(self) -> None:
        correction = [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 1.0]]
        self.client.create_device("corrected")
        stored = self.client.create_calibration("corrected", calibration={
            "gyroscope": {"apply": {"reading_unit": "rad/s", "bias": [1.0, 0.0, 0.0], "correction": correction}}})
        calibration = Calibration(stored["calibration"], stored["id"])
        numpy.testing.assert_allclose(calibration.correct("gyroscope", numpy.array([[2.0, 4.0, 6.0]])), [[2.0, 4.0, 8.0]])


class Recorder:
    """Notes which operations a client asks for."""

    def __init__(self, client: Client) -> None:
        self.seen: set[str] = set()
        transport = client._transport
        call, lines = transport.call, transport.lines

        def noted_call(operation: str, path: dict[str, str] | None = None, query: Query | None = None, body: Body | None = None,
                       **more: Any) -> Answer:
            self.seen.add(operation)
            return call(operation, path, query, body, **more)

        def noted_lines(operation: str, *more: Any) -> Iterator[str]:
            self.seen.add(operation)
            return lines(operation, *more)

        transport.call = noted_call  # type: ignore[assignment]
        transport.lines = noted_lines  # type: ignore[assignment]
        assert isinstance(transport, Transport)


class Everything(ClientTest):
    def test_every_operation_works_once(self) -> None:
        client = self.client
        recorder = Recorder(client)
        self.assertIn("<html", client.front_page())
        self.assertEqual(client.health()["status"], "alive")
        self.assertEqual(client.readiness()["status"], "ready")
        self.assertIn("/v1/jobs", client.contract()["paths"])
        self.assertEqual(client.schema("device.schema.json")["title"], "Device")
        self.assertTrue(client.documentation()["pages"])
        self.assertIn("# Units", client.documentation_page("units"))
        self.assertTrue(client.problem_type("not-found"))

        device = client.create_device("all-07", model="Galaxy S4", labels={"firmware": "1"})
        self.assertEqual(client.change_device("all-07", {"serial": "RF8"}, if_match=client.device_etag("all-07"))["revision"], 2)
        self.assertEqual(client.device("all-07")["serial"], "RF8")
        self.assertIn(device["id"], [each["id"] for each in client.devices()])

        first, second = self.recording("all-07", 1), self.recording("all-07", 2)
        self.assertEqual({r["id"] for r in client.recordings(device="all-07")}, {first, second})
        self.assertEqual(client.recording(first)["revision"], 1)
        self.assertEqual(client.change_recording(second, {"trim": {"start_s": 0.1}})["revision"], 2)

        job = client.wait(client.create_job({"kind": "characterise", "inputs": {"recordings": [first]}}))
        self.assertIn(job["id"], [each["id"] for each in client.jobs(kind="characterise", state="succeeded")])
        self.assertEqual(client.job(job["id"])["state"], "succeeded")
        events = list(client.job_events(job["id"]))
        self.assertEqual(events[-1][1]["state"], "succeeded")
        self.assertEqual(list(client.job_events(job["id"], last_event_id=events[-2][0])), events[-1:])
        self.assertIn("recordings", client.job_result(job["id"]))
        self.assertEqual(client.cancel_job(job["id"])["state"], "succeeded")

        fit = next(client.fits(device="all-07", best=True))
        self.assertEqual(client.fit(fit["id"]), fit)
        self.assertTrue(client.parameter_table("all-07", axis="z").rows())
        self.assertIsInstance(client.trends("all-07", axis="z").rows(), list)
        self.assertIn("recording", client.structure(first, (first, "gz"))["statement"])
        self.assertIn("two conditions", client.trends_text("all-07", axis="z"))

        self.assertIn("verdict", client.characterisation(first)["channels"][0]["summary"])
        self.assertEqual(len(client.trace(first, client.recording(first)["file"]["columns"][0], points=10)["mean"]), 10)
        self.assertGreater(client.counts()["recordings"], 0)
        self.assertGreater(client.workers()["workers"], 0)
        self.assertGreater(client.counts(since="2020-01-01T00:00:00Z")["jobs"]["succeeded_since"]["count"], 0)
        self.assertEqual(client.counts(include="attention")["attention"], list(client.attention())[:8])
        self.assertTrue(all(item["level"] in ("look", "wrong") for item in client.attention(device="all-07", since="2020-01-01T00:00:00Z")))
        found = {one["id"] for one in client.recordings(device="all-07", sort="name", q="static", has_result=True)}
        self.assertTrue(found)
        self.assertLessEqual(found, {first, second})
        self.assertIn(job["id"], {one["id"] for one in client.jobs(device="all-07", sort="-created_at")})
        self.assertEqual([table.document["axis"] for table in client.parameter_tables("all-07", reference="static")], ["z"])
        self.assertIn("\\toprule", client.parameter_table_text("all-07", axis="z", media="text/x-latex"))
        self.assertGreater(client.device_summary("all-07")["recordings"], 0)
        with contextlib.suppress(NotFound):  # a fit may leave a parameter open
            self.assertIn("allan", client.implied(next(client.fits(best=True))["id"])["implied"])
        model = client.create_model(
            {"name": "white", "processes": [{"process": "white_noise", "params": {"N": {"value": 1.0, "unit": "deg/sqrt(h)"}}}]})
        self.assertEqual(client.model_implied(model["id"], first, client.recording(first)["file"]["columns"][0])["left_out"], [])
        self.assertTrue(client.sample(seed=2).startswith("gz"))
        self.assertEqual(client.preview(client.sample(seed=2).encode())["format"], "csv")
        column = client.recording(first)["file"]["columns"][0]
        self.assertGreater(len(client.spectrum(first, column, scale="linear")["density"]), 50)
        self.assertEqual(len(client.histogram(first, column, bins=16)["counts"]), 16)
        self.assertEqual(client.spectrogram(first, column, times=4)["expected"], "median")
        self.assertEqual(next(iter(client.events(topics="jobs")))[1], "ready")
        self.assertEqual(client.search("ALL-0", limit=1)[0]["title"], "all-07")
        self.pieces(client)
        self.live(client)

        study = client.create_study("all-07", [first, {"recording": second}])
        self.assertEqual(client.study(study["id"])["id"], study["id"])
        self.assertEqual([each["id"] for each in client.studies(device="all-07")], [study["id"]])
        report = client.investigate(study["id"])
        listed = next(client.investigations(device="all-07", study=study["id"]))
        self.assertEqual(client.investigation(listed["id"]).findings, report.findings)
        self.assertIn("# ", client.investigation_markdown(listed["id"]))

        client.characterise(second)
        compared = client.wait(client.create_job({"kind": "regress", "inputs": {
            "device": "all-07", "baseline": {"recordings": [{"recording": first}]}, "candidate": {"recordings": [{"recording": second}]}}}))
        self.assertEqual([run["id"] for run in client.regressions()], [compared["id"]])
        self.assertIn(client.regression(compared["id"])["verdict"], ("pass", "inconclusive"))
        self.assertIn("testsuite", client.regression_junit(compared["id"], inconclusive="pass"))
        self.assertIn("**", client.regression_text(compared["id"], media="text/markdown"))
        self.assertIn("<svg", client.regression_badge(compared["id"]))
        self.assertIn("<svg", client.regression_figure(compared["id"]))
        client.change_recording(first, {"labels": {"firmware": "1.0"}, "session": "Monday"})
        self.assertEqual([each["id"] for each in client.recordings(labels={"firmware": "1.0"})], [first])
        anchor = client.move_regression_anchor("all-07", "firmware=1.0", "the first release")
        self.assertEqual(list(client.regression_anchors(device="all-07")), [anchor])

        model = client.create_model({"name": "sheet", "processes": [
            {"process": "white_noise", "params": {"N": {"value": 0.3, "unit": "deg/sqrt(h)"}}}]})
        self.assertEqual(client.model(model["id"]), model)
        self.assertIn(model["id"], [each["id"] for each in client.models()])

        done = client.outages(SCENARIO, runs=2, seed=3)
        self.assertEqual([row["filter"] for row in done.rows()], ["matched"])
        listed_evaluation = next(client.outage_evaluations(state="succeeded"))
        evaluation = client.outage_evaluation(listed_evaluation["id"], wait_s=5)
        self.assertEqual(json.dumps(evaluation["evaluation"]), json.dumps(done.document))

        imu, gnss = (client.upload(content, device="car-07", condition="drive", columns=samples.roles(roles))["id"]
                     for content, roles in zip(samples.drive_csvs(), (samples.DRIVE_IMU, samples.DRIVE_GNSS)))
        drive = client.create_drive(cast(Drive, samples.drive_document(imu, gnss)))
        self.assertEqual(client.drive(drive["id"]), drive)
        self.assertEqual([each["id"] for each in client.drives(device="car-07")], [drive["id"]])
        driven = client.create_drive_evaluation({"drive": drive["id"]})
        client.wait(driven["id"])
        self.assertEqual([each["id"] for each in client.drive_evaluations(state="succeeded")], [driven["id"]])
        measured = client.drive_evaluation(driven["id"])["evaluation"]
        assert measured is not None
        self.assertIn("After 10 s", measured["summary"])
        client.delete_drive(drive["id"])
        with self.assertRaises(NotFound):
            client.drive(drive["id"])

        made = client.create_calibration("all-07", calibration={"gyroscope": {"apply": {
            "reading_unit": "rad/s", "bias": [0.0] * 3, "correction": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}}})
        self.assertEqual(client.calibration(made["id"]), made)
        self.assertEqual([each["id"] for each in client.calibrations(device="all-07")], [made["id"]])

        self.assertIn("driftlab_ready 1", client.metrics())
        self.assertIn("kalibr", [each["target"] for each in client.export_targets()])
        self.assertIn("gyroscope_noise_density", client.export("kalibr", "all-07")["text"])
        self.assertEqual([each["name"] for each in client.data_sheets("MPU6050")], ["MPU-6050"])
        with self.assertRaises(NotFound):
            client.population("a model that no device has")
        self.assertEqual(client.population("Galaxy S4")["devices"], ["all-07"])
        self.assertIn("No device of 1 stands out", client.population_text("Galaxy S4", media="text/markdown"))

        whole = client.content(first)
        self.assertEqual(hashlib.sha256(whole).hexdigest(), client.recording(first)["file"]["sha256"])
        self.assertEqual(client.content(first, first=3, last=9), whole[3:10])
        with tempfile.TemporaryDirectory() as folder:
            client.download(first, Path(folder, "first.csv"))
            self.assertEqual(Path(folder, "first.csv").read_bytes(), whole)

        self.deletes(client, study["id"], listed["id"], model["id"], made["id"], first, second)
        self.assertEqual(recorder.seen | self.access(), set(OPERATIONS))

    def deletes(self, client: Client, study: str, investigation: str, model: str, calibration: str, first: str, second: str) -> None:
        with self.assertRaises(Conflict) as caught:
            client.delete_study(study)
        self.assertIn(investigation, str(caught.exception))
        client.delete_investigation(investigation)
        client.delete_study(study)
        client.delete_model(model)
        client.delete_calibration(calibration)
        with self.assertRaises(Conflict) as caught:
            client.delete_device("all-07")
        self.assertIn(first, str(caught.exception))
        client.delete_recording(second)
        with self.assertRaises(NotFound):
            client.recording(second)
        client.create_device("spare")
        client.delete_device("spare")
        with self.assertRaises(NotFound):
            client.device("spare")

    def access(self) -> set[str]:
        """Everything about tokens, on a daemon of its own: the first one switches authentication on for good."""
        with tempfile.TemporaryDirectory() as folder, Daemon(arguments=("--backups", folder)) as daemon:
            client = Client(f"http://127.0.0.1:{daemon.port}")
            first = client.create_token("lab", "admin")
            client = Client(f"http://127.0.0.1:{daemon.port}", first["secret"])
            recorder = Recorder(client)
            self.assertEqual(client.session()["scope"], "admin")
            cookie = client.open_session(first["secret"]).partition(";")[0]
            client.close_session(cookie)
            other = client.create_token("rig", "read")
            self.assertEqual({each["id"] for each in client.tokens()}, {first["id"], other["id"]})
            self.assertEqual(client.token(other["id"])["name"], "rig")
            self.assertNotEqual(client.rotate_token(other["id"])["secret"], other["secret"])
            self.assertTrue(client.revoke_token(other["id"])["revoked_at"])
            hook = client.create_webhook("https://ci.example.org/", events=["regression.ended"])
            self.assertTrue(hook["secret"].startswith("whsec_"))
            self.assertEqual([each["id"] for each in client.webhooks()], [hook["id"]])
            self.assertEqual(client.webhook(hook["id"])["events"], ["regression.ended"])
            self.assertNotEqual(client.rotate_webhook(hook["id"])["secret"], hook["secret"])
            self.assertFalse(client.change_webhook(hook["id"], enabled=False)["enabled"])
            self.assertTrue(client.change_webhook(hook["id"], enabled=True)["enabled"])
            queued = client.test_webhook(hook["id"])
            self.assertEqual([each["id"] for each in client.deliveries(hook["id"])], [queued["id"]])
            client.delete_webhook(hook["id"])
            self.assertTrue(list(client.audit()))
            self.assertTrue(client.verify_audit()["sound"])
            made = client.create_backup()
            self.assertIn(made["name"], [each["name"] for each in client.backups()])
            return recorder.seen

    def pieces(self, client: Client) -> None:
        """A file that is large enough goes piece by piece, and is the recording that one request makes."""
        content = samples.gyro_csv(seed=40)
        whole = client.upload(content, device="all-07", rate_hz=100, columns=samples.GYRO_Z)
        told: list[int] = []
        client.resumable_from = 1000
        try:
            again = client.upload(content, device="all-07", rate_hz=100, columns=samples.GYRO_Z,
                                  progress=lambda sent, size: told.append(sent))
        finally:
            del client.resumable_from
        self.assertEqual((again["id"], told[-1]), (whole["id"], len(content)))
        upload = client.create_upload(10, file_name="ten.csv")
        self.assertEqual(client.append_to_upload(upload["id"], 0, b"gz"), 2)
        self.assertEqual(client.upload_state(upload["id"])["offset"], 2)
        client.delete_upload(upload["id"])

    def live(self, client: Client) -> None:
        made = client.create_live_recording({"device": "all-07", "condition": {"kind": "static"}, "columns": {
            "gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}})
        rows = b"".join(struct.pack("<df", i / 100, math.sin(i)) for i in range(400))
        client.add_live_samples(made["id"], made["token"], 0, rows)
        self.assertEqual(client.live_recording(made["id"])["samples"], 400)
        self.assertEqual(next(iter(client.live_growth(made["id"])))["samples"], 400)
        self.assertEqual(client.finish_live_recording(made["id"], made["token"])["recording"]["quality"]["samples"], 400)


if __name__ == "__main__":
    unittest.main()
