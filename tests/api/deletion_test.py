"""What is deleted, what refuses to be, and that the refusal names what depends on it."""
from __future__ import annotations

import unittest
from typing import Any

import samples
from daemon import Answer, Daemon
from suite import DaemonTest


class Deletion(DaemonTest):
    def delete(self, target: str, etag: str | None = None) -> Answer:
        return self.daemon.request("DELETE", target, headers={"If-Match": etag} if etag else {})

    def made(self, target: str, body: Any) -> Answer:
        return self.expect(201, self.daemon.post(target, body))

    def recording(self, device: str, seed: int = 1, **query: Any) -> Answer:
        answer = self.daemon.upload(samples.gyro_csv(2000, seed=seed), device=device, rate_hz=100, columns=samples.GYRO_Z, **query)
        return self.expect(201, answer)

    def test_a_device_goes_last(self) -> None:
        recording = self.recording("whole")
        self.daemon.finished(self.daemon.characterise(recording.json["id"], models=["WN"]).json["id"])
        calibration = self.made("/v1/calibrations", {"device": {"id": "whole"}, "calibration": {"gyroscope": {"apply": samples.CORRECTION}}})
        study = self.made("/v1/studies", {"device": {"id": "whole"}, "recordings": [{"recording": recording.json["id"]}]})
        model = self.made("/v1/models", {"name": "white", "device": "whole", "processes": [samples.WHITE_NOISE]})
        self.problem(428, "precondition_required", self.delete("/v1/devices/whole"))
        self.problem(412, "precondition_failed", self.delete("/v1/devices/whole", '"other"'))
        refused = self.problem(409, "conflict", self.delete("/v1/devices/whole", "*"), recordings=recording.json["id"], studies=study.json["id"],
                               calibrations=calibration.json["id"], models=model.json["id"])
        self.assertIn("must go first: 1 recording (" + recording.json["id"], str(refused["detail"]))
        self.assertFalse(refused["retryable"])
        for each in (study, calibration, model):
            self.expect(204, self.delete(each.headers["location"]))
            self.problem(404, "not_found", self.delete(each.headers["location"]))
            self.problem(404, "not_found", self.daemon.get(each.headers["location"]))
        self.expect(204, self.delete(recording.headers["location"], "*"))
        self.daemon.finished(self.daemon.items("/v1/jobs")[-1]["id"])
        self.expect(204, self.delete("/v1/devices/whole", self.daemon.get("/v1/devices/whole").headers["etag"]))
        self.problem(404, "not_found", self.daemon.get("/v1/devices/whole"))
        self.assertEqual([job for job in self.daemon.items("/v1/jobs") if recording.json["id"] in str(job)], [], "its jobs go with it")
        self.recording("whole")  # and it may come again

    def test_a_device_with_a_drive_goes_after_it_and_its_recordings(self) -> None:
        files = zip(samples.drive_csvs(seed=5), (samples.DRIVE_IMU, samples.DRIVE_GNSS))
        recordings = [self.expect(201, self.daemon.upload(content, device="driven", condition="drive", columns=samples.roles(roles)))
                      for content, roles in files]
        drive = self.made("/v1/drives", samples.drive_document(*(recording.json["id"] for recording in recordings)))
        driven = self.daemon.finished(self.expect(202, self.daemon.post("/v1/drive-evaluations", {"drive": drive.json["id"]})).json["id"])
        for recording in recordings:
            self.problem(409, "conflict", self.delete(recording.headers["location"], "*"), drives=drive.json["id"])
        self.problem(409, "conflict", self.delete("/v1/devices/driven", "*"), drives=drive.json["id"])
        self.problem(412, "precondition_failed", self.delete(drive.headers["location"], '"other"'))
        self.expect(204, self.delete(drive.headers["location"], drive.headers["etag"] if "etag" in drive.headers else None))
        self.problem(404, "not_found", self.delete(drive.headers["location"]))
        self.assertEqual(self.daemon.get(f"/v1/jobs/{driven['id']}").json["state"], driven["state"], "what was found of it stays")
        for recording in recordings:
            self.expect(204, self.delete(recording.headers["location"], "*"))
        self.expect(204, self.delete("/v1/devices/driven", "*"))

    def test_many_dependents_are_counted(self) -> None:
        ids = [self.recording("crowded", seed).json["id"] for seed in range(7)]
        refused = self.problem(409, "conflict", self.delete("/v1/devices/crowded", "*"), recordings=", ".join(ids[:5]) + " and 2 more")
        self.assertIn("7 recordings", str(refused["detail"]))

    def test_a_study_and_its_models_stay_while_there_is_an_investigation(self) -> None:
        recording = self.recording("asked", 2).json["id"]
        study = self.made("/v1/studies", {"device": {"id": "asked"}, "recordings": [{"recording": recording}]})
        job = self.daemon.finished(self.daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study.json["id"]}}).json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        [investigation] = self.daemon.items("/v1/investigations?device=asked")
        target = f"/v1/investigations/{investigation['id']}"
        self.problem(409, "conflict", self.delete(study.headers["location"]), investigations=investigation["id"])
        self.problem(409, "conflict", self.delete(f"/v1/models/{investigation['model']}"), investigations=investigation["id"])
        self.problem(412, "precondition_failed", self.delete(target, '"other"'))
        self.expect(204, self.delete(target, self.daemon.get(target).headers["etag"]))
        self.problem(404, "not_found", self.daemon.get(f"/v1/jobs/{job['id']}"))
        again = self.expect(202, self.daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study.json["id"]}}))
        self.daemon.finished(again.json["id"])
        [second] = self.daemon.items("/v1/investigations?device=asked")
        self.expect(204, self.delete(f"/v1/investigations/{second['id']}"))
        self.expect(204, self.delete(study.headers["location"]))

    def test_a_calibration_stays_while_a_recording_is_corrected_by_it(self) -> None:
        calibration = self.made("/v1/calibrations", {"device": {"id": "corrected"}, "calibration": {"gyroscope": {"apply": samples.CORRECTION}}})
        columns = ",".join(f"g{axis}=angular_rate:{axis}:rad/s" for axis in "xyz")
        content = samples.csv(samples.noise(2000, 3, 3), ["gx", "gy", "gz"])
        recording = self.expect(201, self.daemon.upload(content, device="corrected", rate_hz=100, columns=columns, calibration=calibration.json["id"]))
        self.problem(409, "conflict", self.delete(calibration.headers["location"]), recordings=recording.json["id"])
        change = self.daemon.request("PATCH", recording.headers["location"], {"calibration": None}, {"If-Match": "*"})
        self.expect(200, change)
        self.expect(204, self.delete(calibration.headers["location"]))

    def test_a_model_stays_while_it_has_revisions(self) -> None:
        parent = self.made("/v1/models", {"name": "parent", "processes": [samples.WHITE_NOISE]})
        child = self.made("/v1/models", {"name": "child", "parent": parent.json["id"], "processes": [samples.WHITE_NOISE]})
        self.problem(409, "conflict", self.delete(parent.headers["location"]), models=child.json["id"])
        self.expect(204, self.delete(child.headers["location"]))
        self.expect(204, self.delete(parent.headers["location"]))


class Strangers(unittest.TestCase):
    def test_tokens_delete_what_they_see_and_may_write(self) -> None:
        with Daemon() as daemon:
            for name in ("own", "foreign"):
                daemon.post("/v1/devices", {"name": name})
            daemon.token = daemon.post("/v1/tokens", {"name": "first", "scope": "admin"}).json["secret"]
            tokens = {scope: daemon.post("/v1/tokens", {"name": scope, "scope": scope, "devices": ["own"]}).json["secret"] for scope in ("read", "write")}

            def delete(scope: str, device: str) -> int:
                return daemon.request("DELETE", f"/v1/devices/{device}", headers={"If-Match": "*", "Authorization": f"Bearer {tokens[scope]}"}).status
            self.assertEqual(delete("read", "own"), 403)
            self.assertEqual(delete("write", "foreign"), 404)
            self.assertEqual(delete("write", "own"), 204)
            self.assertEqual([device["name"] for device in daemon.items("/v1/devices")], ["foreign"])
            self.assertIn("device.delete", [row["action"] for row in daemon.items("/v1/audit")])


class LastLines(DaemonTest):
    def test_text_and_json_end_with_a_newline(self) -> None:
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(2000, seed=4), device="lines", rate_hz=100, columns=samples.GYRO_Z))
        self.daemon.finished(self.daemon.characterise(recording.json["id"], models=["WN"]).json["id"])
        table = "?device=lines&sensor=gyroscope&axis=z"
        for target, media in (("/v1/devices", "*/*"), ("/v1/recordings", "*/*"), ("/v1/recordings?limit=0", "*/*"), ("/v1/jobs", "*/*"), ("/v1/nix", "*/*"), ("/openapi.json", "*/*"), ("/docs", "*/*"),
                              ("/docs/http", "*/*"), ("/problems/busy", "*/*"), ("/schemas/job.schema.json", "*/*"), ("/", "application/json"), ("/healthz", "*/*"),
                              ("/metrics", "*/*"), *((path + table, media) for path in ("/v1/parameter-tables", "/v1/trends")
                                                     for media in ("application/json", "text/csv", "text/plain", "text/markdown"))):
            answer = self.daemon.get(target, Accept=media)
            self.assertTrue(answer.body.endswith(b"\n") and not answer.body.endswith(b"\n\n"), answer.describe())


if __name__ == "__main__":
    unittest.main()
