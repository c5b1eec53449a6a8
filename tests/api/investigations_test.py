"""Investigations over HTTP: a study in, a report and a revision of its simulation model out."""
from __future__ import annotations

import unittest
from typing import Any

import samples
from daemon import Answer, events
from suite import DaemonTest

NOISE = {"process": "white_noise", "params": {"N": {"value": 1.0 / 20.0 ** 0.5, "unit": "deg/s/sqrt(Hz)"}}}


class Investigations(DaemonTest):
    arguments = ("--workers", "1")

    def recording(self, device: str, seed: int, step: float = 0.0, count: int = 4000, **query: Any) -> str:
        """White noise of 1 deg/s at 20 Hz; the second half may be higher by `step`."""
        [column] = samples.noise(count, 1, seed)
        column = [value + (step if i >= count // 2 else 0.0) for i, value in enumerate(column)]
        answer = self.daemon.upload(samples.csv([column], ["gz"]), device=device, rate_hz=20, columns=samples.GYRO_Z, **query)
        return str(self.expect(201, answer).json["id"])

    def study(self, device: str, recordings: list[str], **more: Any) -> str:
        body = {"device": {"id": device}, "recordings": [{"recording": id_} for id_ in recordings], **more}
        return str(self.expect(201, self.daemon.post("/v1/studies", body)).json["id"])

    def ask(self, study: str, **parameters: Any) -> Answer:
        return self.daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study}, "parameters": parameters})

    def investigated(self, study: str, **parameters: Any) -> dict[str, Any]:
        queued = self.expect(202, self.ask(study, **parameters))
        job = self.daemon.finished(queued.json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        return dict(self.expect(200, self.daemon.get(job["result"]["href"])).json)

    def test_a_step_is_named_and_the_extended_model_is_a_revision(self) -> None:
        study = self.study("stepping", [self.recording("stepping", 1), self.recording("stepping", 2, step=1.0)])
        result = self.investigated(study)
        self.assertEqual([f["cause"] for f in result["findings"]], ["bias_step"])
        self.assertEqual(result["study"], study)

        report = self.expect(200, self.daemon.get(f"/v1/investigations/{result['id']}"))
        self.assertEqual(report.json["findings"], result["findings"])
        page = self.expect(200, self.daemon.get(f"/v1/investigations/{result['id']}", Accept="text/markdown"))
        self.assertIn("**bias_step**", page.text)
        equation = report.json["findings"][0]["equation"]
        self.assertIn("step", equation)
        self.assertIn(f"): {equation}.", page.text)
        self.assertIn("t0 = ", report.json["findings"][0]["explanation"])
        self.expect(406, self.daemon.get(f"/v1/investigations/{result['id']}", Accept="image/png"))
        [listed] = self.daemon.items("/v1/investigations?device=stepping")
        self.assertEqual((listed["id"], listed["model"]), (result["id"], result["model"]))
        self.assertEqual(self.daemon.items(f"/v1/investigations?study={study}&job={listed['job']}"), [listed])

        latest = self.expect(200, self.daemon.get("/v1/devices/stepping/summary")).json["latest"]
        self.assertEqual({key: latest[key] for key in ("kind", "id", "href", "recording", "level", "verdict")},
                         {"kind": "investigate", "id": result["id"], "href": f"/v1/investigations/{result['id']}", "recording": None,
                          "level": result["summary"]["level"], "verdict": result["summary"]["verdict"]})

        child = self.expect(200, self.daemon.get(f"/v1/models/{result['model']}")).json
        self.assertEqual(child["parent"], result["baseline_model"])
        [effect] = child["effects"]
        self.assertEqual(effect["cause"], "bias_step")
        self.assertAlmostEqual(effect["params"]["step"]["value"], 1.0, delta=0.15)  # sd 2/sqrt(4000) = 0.032
        [change] = child["provenance"]["changes"]
        self.assertEqual((change["change"], change["cause"]), ("added", "bias_step"))
        self.assertTrue(change["why"])
        self.assertEqual([m["id"] for m in self.daemon.items(f"/v1/models?parent={child['parent']}")], [child["id"]])
        self.assertIsNone(self.expect(200, self.daemon.get(f"/v1/models/{child['parent']}")).json["parent"])

        # The revision as the next baseline: it says all there is to say about these recordings.
        again = self.investigated(study, baseline={"kind": "model", "id": child["id"]})
        self.assertEqual(again["findings"], [])
        self.assertEqual((again["baseline_model"], again["model"]), (child["id"], child["id"]))

    def test_the_same_question_is_one_job(self) -> None:
        study = self.study("asked-twice", [self.recording("asked-twice", 5)])
        first = self.expect(202, self.ask(study))
        self.daemon.finished(first.json["id"])
        self.assertEqual(self.expect(200, self.ask(study)).json["id"], first.json["id"])

    def test_baselines_may_be_stored_models_and_fits(self) -> None:
        recordings = [self.recording("stored", 11), self.recording("stored", 12)]
        body = {"name": "white", "device": "stored", "why": "data sheet", "processes": [NOISE]}
        model = self.expect(201, self.daemon.post("/v1/models", body))
        self.assertEqual(self.expect(200, self.daemon.post("/v1/models", body)).json["id"], model.json["id"])
        self.assertEqual(self.expect(200, self.daemon.get(model.headers["location"])).json, model.json)
        self.assertEqual(model.json["provenance"], {"made_by": "hand", "why": "data sheet"})
        study = self.study("stored", recordings, baseline={"kind": "model", "id": model.json["id"]})
        result = self.investigated(study)
        self.assertEqual((result["findings"], result["baseline_model"]), ([], model.json["id"]))

        job = self.expect(202, self.daemon.characterise(recordings[0], models=["WN"]))
        self.daemon.finished(job.json["id"])
        [fit] = self.daemon.items(f"/v1/fits?job={job.json['id']}")
        result = self.investigated(study, baseline={"kind": "fit", "id": fit["id"]})
        self.assertEqual(result["findings"], [])
        stored = self.expect(200, self.daemon.get(f"/v1/models/{result['model']}")).json
        self.assertEqual(stored["provenance"]["baseline"], {"kind": "fit", "id": fit["id"]})

    def test_faults_are_located(self) -> None:
        study = self.study("faulty", [self.recording("faulty", 21)])
        nobody = "0" * 26
        self.problem(404, "not_found", self.ask("stu_" + nobody))
        self.problem(404, "not_found", self.ask(study, baseline={"kind": "model", "id": "mod_" + nobody}))
        self.expect(400, self.ask(study, baseline={"kind": "model", "processes": []}))
        self.expect(400, self.ask(study, baseline={"kind": "guess"}))
        self.expect(400, self.ask(study, colour="red"))
        self.problem(404, "not_found", self.daemon.get("/v1/investigations/inv_" + nobody))
        self.problem(404, "not_found", self.daemon.get("/v1/models/mod_" + nobody))
        self.problem(404, "not_found", self.daemon.get("/v1/models?device=nobody"))

        def post(**members: Any) -> Answer:
            return self.daemon.post("/v1/models", {"name": "bad", "processes": [NOISE], **members})
        self.problem(404, "not_found", post(parent="mod_" + nobody))
        self.expect(400, post(processes=[]))
        self.expect(400, post(processes=[{"process": "magic", "params": {}}]))
        self.expect(400, post(effects=[{"cause": "magic", "params": {}}]))
        self.expect(400, post(effects=[{"cause": "bias_step", "params": {"step": {"value": 1, "unit": "s"}}}]))
        self.expect(400, post(colour="red"))

    def test_recordings_too_short_are_no_failure_of_the_daemon(self) -> None:
        study = self.study("short", [self.recording("short", 31, count=100)])
        result = self.investigated(study)
        self.assertEqual(result["findings"], [])
        self.assertIn("fewer than 500 samples", " ".join(result["notes"]))

    def test_a_recording_stays_while_a_study_names_it(self) -> None:
        keeps, goes = self.recording("removing", 41), self.recording("removing", 42)
        study = self.study("removing", [keeps, goes])
        result = self.investigated(study)
        refused = self.problem(409, "conflict", self.daemon.request("DELETE", f"/v1/recordings/{goes}", headers={"If-Match": "*"}), studies=study)
        self.assertEqual(refused["detail"], f"What depends on the recording must go first: 1 study ({study}).")
        for target in (f"/v1/investigations/{result['id']}", f"/v1/studies/{study}", f"/v1/recordings/{goes}"):
            self.expect(204, self.daemon.request("DELETE", target, headers={"If-Match": "*"} if "recordings" in target else {}))
        self.expect(200, self.daemon.get(f"/v1/models/{result['model']}"))

    def test_progress_is_reported_and_a_running_job_cancelled(self) -> None:
        columns = [samples.noise(1 << 12, 1, 90 + i)[0] * 64 for i in range(3)]
        roles = ",".join(f"{i}=angular_rate:{'xyz'[i]}:deg/s" for i in range(3))
        recording = self.expect(201, self.daemon.upload(samples.npy(columns), device="long", rate_hz=100, columns=roles)).json["id"]
        job = self.expect(202, self.ask(self.study("long", [recording]))).json["id"]
        following = events(self.daemon, job)
        for event in following:
            if event.type == "progress" and event.data["progress"] > 0.1:
                self.assertTrue(event.data["stage"])
                break
        self.expect(202, self.daemon.post(f"/v1/jobs/{job}/cancel"))
        document = self.daemon.finished(job)
        self.assertEqual((document["state"], document["result"]), ("cancelled", None))
        self.assertEqual(self.daemon.items("/v1/investigations?device=long"), [])


if __name__ == "__main__":
    unittest.main()
