"""Studies over uploaded recordings: replicates fitted jointly, trends, and tables that read only what is stored."""
from __future__ import annotations

import threading
import time
import unittest
from typing import Any

import samples
from outage_evaluations_test import SCENARIO
from suite import DaemonTest

TABLE = "/v1/parameter-tables?sensor=gyroscope&axis=z&method=gmwm&device="
TRENDS = "/v1/trends?sensor=gyroscope&axis=z&device="


class Studies(DaemonTest):
    def recording(self, device: str, seed: int, condition: str = "static", scale: float = 1.0, **query: Any) -> str:
        [column] = samples.noise(4000, 1, seed)
        content = samples.csv([[scale * value for value in column]], ["gz"])
        answer = self.daemon.upload(content, device=device, condition=condition, rate_hz=100, columns=samples.GYRO_Z, **query)
        return str(self.expect(201, answer).json["id"])

    def campaign(self, device: str) -> list[str]:
        """Two recordings at rest, two at each of two rates; the noise grows by half from one condition to the next."""
        conditions = ("static", "constant_rate:z:9:deg/s", "constant_rate:z:40:deg/s")
        return [self.recording(device, 10 * i + j, condition, 1.5 ** i) for i, condition in enumerate(conditions) for j in (1, 2)]

    def finished(self, **inputs: Any) -> dict[str, Any]:
        queued = self.daemon.post("/v1/jobs", {"kind": "characterise", "inputs": inputs, "parameters": {"models": ["WN", "WN+RW"]}})
        job = self.daemon.finished(self.expect(202, queued).json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        return dict(self.expect(200, self.daemon.get(job["result"]["href"])).json)

    def test_a_study_is_characterised_as_a_whole(self) -> None:
        ids = self.campaign("campaign")
        body = {"device": {"id": "campaign"}, "recordings": [{"recording": id_} for id_ in ids], "baseline": {"kind": "auto"}}
        study = self.expect(201, self.daemon.post("/v1/studies", body))
        self.assertEqual(self.expect(200, self.daemon.get(study.headers["location"])).json, study.json)
        self.assertEqual(self.expect(200, self.daemon.post("/v1/studies", body)).json["id"], study.json["id"])
        self.assertEqual([s["id"] for s in self.daemon.items("/v1/studies?device=campaign")], [study.json["id"]])

        document = self.finished(study=study.json["id"])
        self.assertEqual(document["study"], study.json["id"])
        [pooled] = document["replicates"]
        self.assertEqual(pooled["model"], "WN")
        self.assertEqual([len(c["recordings"]) for c in pooled["conditions"]], [2, 2, 2])
        self.assertIn(pooled["structure"]["verdict"], ("one_structure", "undecided"))
        self.assertEqual({t["method"] for t in document["trends"]}, {"av", "gmwm"})

        table = self.expect(200, self.daemon.get(TABLE + "campaign", Prefer="wait=60")).json
        self.assertEqual([row["pooling"] for row in table["rows"]], ["joint"] * 3)
        for i, row in enumerate(table["rows"]):
            stored = pooled["conditions"][i]["fits"][0]["processes"][0]["params"]["N"]
            # The job puts its recordings together in the order of its request, the table in one that does not depend on it.
            self.assertAlmostEqual(row["values"]["white_noise.N"]["value"] / stored["value"], 1.0, places=12)
            self.assertAlmostEqual(row["agreement"]["statistic"], pooled["conditions"][i]["agreement"]["statistic"], places=12)
            self.assertEqual(row["agreement"]["agree"], pooled["conditions"][i]["agreement"]["agree"])
            # two recordings of 4000 samples give N = 6 deg/sqrt(h) times 1.5^i to 0.8 %
            self.assertAlmostEqual(stored["value"] / (6.0 * 1.5 ** i), 1.0, delta=0.04)
        self.assertEqual(table["pooling"]["state"], "done")
        trends = self.expect(200, self.daemon.get(TRENDS + "campaign")).json
        listed = self.expect(200, self.daemon.get(TRENDS + "campaign", Accept="text/csv")).text.splitlines()
        self.assertEqual((listed[0].split(",")[:3], len(listed) - 1), (["parameter", "against", "direction"], len(trends["trends"])))
        piped = self.expect(200, self.daemon.get(TRENDS + "campaign", Accept="text/markdown")).text.splitlines()
        self.assertEqual((piped[1].count("---"), len(piped) - 2), (9, len(trends["trends"])))
        self.assertEqual(trends["pooling"], table["pooling"])
        [trend] = [t for t in trends["trends"] if t["parameter"] == "white_noise.N"]
        self.assertEqual(trend["monotone"]["direction"], "up")
        self.assertEqual([point["at"] for point in trend["points"]], [0, 9, 40])
        self.assertIn("↑ against |rate|", self.expect(200, self.daemon.get(TRENDS + "campaign", Accept="text/plain")).text)
        markdown = self.expect(200, self.daemon.get(TABLE + "campaign", Accept="text/markdown"))
        self.assertIn("| static | 6", markdown.text.replace("5.9", "6"))

    def test_recordings_characterised_one_by_one_come_together(self) -> None:
        for id_ in self.campaign("one-by-one"):
            self.finished(recordings=[id_])
        table = self.expect(200, self.daemon.get(TABLE + "one-by-one", Prefer="wait=60")).json
        self.assertEqual([row["pooling"] for row in table["rows"]], ["joint"] * 3)

    def test_a_table_forgets_what_a_removed_recording_said(self) -> None:
        first, second, third = (self.recording("removing", seed) for seed in (71, 72, 73))
        self.finished(recordings=[first, second, third])
        self.expect(204, self.daemon.request("DELETE", f"/v1/recordings/{third}", headers={"If-Match": "*"}))
        [row] = self.expect(200, self.daemon.get(TABLE + "removing", Prefer="wait=60")).json["rows"]
        self.assertEqual((row["pooling"], set(row["recordings"])), ("joint", {first, second}))
        self.expect(204, self.daemon.request("DELETE", f"/v1/recordings/{second}", headers={"If-Match": "*"}))
        table = self.expect(200, self.daemon.get(TABLE + "removing")).json
        self.assertEqual(table["pooling"], {"state": "done", "job": None, "reason": None})
        self.assertEqual([row["pooling"] for row in table["rows"]], ["single"])

    def test_replicates_that_disagree_are_flagged(self) -> None:
        self.finished(recordings=[self.recording("torn", 81), self.recording("torn", 82, scale=1.3)])
        [row] = self.expect(200, self.daemon.get(TABLE + "torn", Prefer="wait=60")).json["rows"]
        self.assertIs(row["agreement"]["agree"], False)
        self.assertIn("! static: its recordings disagree", self.expect(200, self.daemon.get(TABLE + "torn", Accept="text/plain")).text)

    def test_faults_are_located(self) -> None:
        mine, other = self.recording("faulty", 91), self.recording("another", 92)
        nobody = "rec_" + "0" * 26

        def post(recordings: Any, device: str = "faulty") -> Any:
            return self.daemon.post("/v1/studies", {"device": {"id": device}, "recordings": recordings})
        self.problem(404, "not_found", post([{"recording": mine}], "nobody"))
        self.problem(404, "not_found", post([{"recording": nobody}]))
        self.expect(400, post([{"recording": other}]))
        self.expect(400, post([{"recording": mine}, {"recording": mine}]))
        self.expect(400, post([]))
        self.problem(409, "conflict", post([{"recording": mine, "condition": {"kind": "drive"}}]))
        self.expect(201, post([{"recording": mine, "condition": {"kind": "static"}}]))
        # What nobody reads was stored, and the answer had more than the contract says.
        for beside, pointer in (({"name": "x"}, "/device/name"), ({"model": 7}, "/device/model")):
            answer = self.expect(400, self.daemon.post("/v1/studies", {"device": {"id": "faulty", **beside}, "recordings": [{"recording": mine}]}))
            self.assertEqual([each["pointer"] for each in answer.json["errors"]], [pointer], answer.describe())
        self.problem(404, "not_found", self.daemon.get("/v1/studies/stu_" + "0" * 26))
        self.problem(404, "not_found", self.daemon.post("/v1/jobs", {"kind": "characterise", "inputs": {"study": "stu_" + "0" * 26}}))
        self.expect(400, self.daemon.post("/v1/jobs", {"kind": "characterise", "inputs": {"study": "stu_" + "0" * 26, "recordings": [mine]}}))
        self.expect(400, self.daemon.post("/v1/jobs", {"kind": "characterise", "inputs": {}}))


class WhilePooling(DaemonTest):
    """One worker, kept from pooling by a long evaluation that was queued before."""

    arguments = ("--workers", "1")

    def test_a_table_says_that_it_waits_and_waits_if_asked(self) -> None:
        ids = [self.expect(201, self.daemon.upload(samples.gyro_csv(20_000, seed=seed), condition=condition, rate_hz=100, columns=samples.GYRO_Z)).json["id"]
               for seed, condition in ((1, "static"), (2, "static"), (3, "constant_rate:z:20:deg/s"))]
        first = self.expect(202, self.daemon.characterise(*ids, models=["WN", "WN+RW"])).json["id"]
        long = self.expect(202, self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 5000})).json["id"]
        self.assertEqual(self.daemon.finished(first)["state"], "succeeded")

        answer = self.expect(200, self.daemon.get(TABLE + "phone-07"))
        pooling = answer.json["pooling"]
        self.assertEqual((pooling["state"], pooling["reason"], answer.headers["retry-after"]), ("pending", None, "1"))
        self.assertNotIn("preference-applied", answer.headers)
        self.assertEqual([row["pooling"] for row in answer.json["rows"]], ["average", "single"])
        self.assertEqual(self.expect(200, self.daemon.get(pooling["job"])).json["kind"], "pool")
        self.assertEqual(self.expect(200, self.daemon.get(TRENDS + "phone-07")).json["pooling"], pooling)
        for target, media in ((TABLE, "text/plain"), (TABLE, "text/markdown"), (TRENDS, "text/plain")):
            text = self.expect(200, self.daemon.get(target + "phone-07", Accept=media)).text
            self.assertIn(f"pooling pending: replicates are averaged until {pooling['job']}", text)
        for target, media in ((TABLE, "text/csv"), (TRENDS, "text/csv"), (TABLE, "application/json")):
            waiting = self.expect(200, self.daemon.get(target + "phone-07", Accept=media))
            self.assertEqual(waiting.headers["link"], f'<{pooling["job"]}>; rel="monitor"', media)
        averages = self.expect(200, self.daemon.get(TABLE.replace("gmwm", "av") + "phone-07")).json
        self.assertEqual(averages["pooling"]["state"], "done", "method av takes nothing from joint fits")
        began = time.monotonic()
        waited = self.expect(200, self.daemon.get(TABLE + "phone-07", Prefer="wait=1"))
        self.assertGreaterEqual(time.monotonic() - began, 1.0)
        self.assertEqual((waited.json["pooling"], waited.headers["preference-applied"]), (pooling, "wait=1"))

        # An evaluation is kept for good, so it does not take the averages of a table that is about to change.
        flat = {"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}], "constant_bias_sd_deg_s": 0.05}
        by_table = {"table": {"device": "phone-07", "axis": "z"}, "constant_bias_sd_deg_s": 0.05}
        scenario = {**SCENARIO, "filters": [{"name": "by table", "gyro": {"x": flat, "y": flat, "z": by_table}}]}
        for target, body in (("/v1/outage-evaluations", {"scenario": scenario, "runs": 2}),
                             ("/v1/jobs", {"kind": "outage_evaluation", "inputs": {"scenario": scenario}, "parameters": {"runs": 2}})):
            refused = self.daemon.post(target, body, {"Prefer": "wait=0"})
            self.assertIn(pooling["job"].rpartition("/")[2], str(self.problem(409, "pooling_pending", refused)["detail"]))
            self.assertEqual(refused.headers["retry-after"], "1")

        self.daemon.post(pooling["job"] + "/cancel")
        failed = self.expect(200, self.daemon.get(TABLE + "phone-07")).json["pooling"]
        self.assertEqual(failed, {"state": "failed", "job": pooling["job"], "reason": "The job was cancelled."})
        self.assertIn("! pooling failed", self.expect(200, self.daemon.get(TABLE + "phone-07", Accept="text/plain")).text)
        asked = {"kind": "pool", "inputs": {"device": "phone-07", "sensor": "gyroscope", "axis": "z"}}
        again = self.expect(202, self.daemon.post("/v1/jobs", asked)).json
        self.assertEqual(self.expect(200, self.daemon.post("/v1/jobs", asked)).json["id"], again["id"])
        self.assertEqual(self.expect(200, self.daemon.get(TABLE + "phone-07")).json["pooling"]["state"], "pending")

        threading.Timer(0.5, lambda: self.daemon.post(f"/v1/jobs/{long}/cancel")).start()
        evaluation = self.expect(202, self.daemon.post("/v1/outage-evaluations", {"scenario": scenario, "runs": 2})).json
        done = self.expect(200, self.daemon.get(TABLE + "phone-07", Prefer="wait=60")).json
        self.assertEqual((done["pooling"]["state"], done["pooling"]["job"]), ("done", "/v1/jobs/" + again["id"]))
        self.assertNotIn("link", self.daemon.get(TABLE + "phone-07", Accept="text/csv").headers)
        self.assertEqual([row["pooling"] for row in done["rows"]], ["joint", "single"])
        used = self.daemon.get(f"/v1/jobs/{evaluation['id']}").json["request"]["inputs"]["scenario"]["filters"][0]["gyro"]["z"]
        self.assertAlmostEqual(used["by_rate"]["processes"][0][0]["params"]["N"]["value"], done["rows"][0]["values"]["white_noise.N"]["value"], places=9)
        pooled = self.expect(200, self.daemon.get(f"/v1/jobs/{again['id']}/result")).json
        self.assertEqual(len(pooled["conditions"][0]["members"]), 2)

    def test_what_cannot_be_pooled_is_refused(self) -> None:
        self.expect(201, self.daemon.upload(samples.gyro_csv(300, seed=9), device="lonely", rate_hz=100, columns=samples.GYRO_Z))
        for inputs, status, pointer in (({"device": "nobody", "axis": "z"}, 404, "/inputs/device"), ({"device": "lonely", "axis": "z"}, 404, "/inputs/axis"),
                                        ({"device": "lonely", "axis": "w"}, 400, "/inputs/axis"), ({"device": "lonely", "axis": "z", "sensor": "nose"}, 400, "/inputs/sensor"),
                                        ({"device": "lonely", "axis": "z", "members": []}, 400, "/inputs/members")):
            answer = self.daemon.post("/v1/jobs", {"kind": "pool", "inputs": inputs})
            self.assertEqual((answer.status, [error["pointer"] for error in answer.json["errors"]]), (status, [pointer]), answer.describe())


if __name__ == "__main__":
    unittest.main()
