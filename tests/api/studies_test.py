"""Studies over uploaded recordings: replicates fitted jointly, trends, and tables that read only what is stored."""
from __future__ import annotations

import unittest
from typing import Any

import samples
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

        table = self.expect(200, self.daemon.get(TABLE + "campaign")).json
        self.assertEqual([row["pooling"] for row in table["rows"]], ["joint"] * 3)
        for i, row in enumerate(table["rows"]):
            stored = pooled["conditions"][i]["fits"][0]["processes"][0]["params"]["N"]
            self.assertEqual(row["values"]["white_noise.N"]["value"], stored["value"])
            self.assertEqual(row["agreement"], pooled["conditions"][i]["agreement"])
            # two recordings of 4000 samples give N = 6 deg/sqrt(h) times 1.5^i to 0.8 %
            self.assertAlmostEqual(stored["value"] / (6.0 * 1.5 ** i), 1.0, delta=0.04)
        trends = self.expect(200, self.daemon.get(TRENDS + "campaign")).json
        [trend] = [t for t in trends["trends"] if t["parameter"] == "white_noise.N"]
        self.assertEqual(trend["monotone"]["direction"], "up")
        self.assertEqual([point["at"] for point in trend["points"]], [0, 9, 40])
        self.assertIn("↑ against |rate|", self.expect(200, self.daemon.get(TRENDS + "campaign", Accept="text/plain")).text)
        markdown = self.expect(200, self.daemon.get(TABLE + "campaign", Accept="text/markdown"))
        self.assertIn("| static | 6", markdown.text.replace("5.9", "6"))

    def test_recordings_characterised_one_by_one_come_together(self) -> None:
        for id_ in self.campaign("one-by-one"):
            self.finished(recordings=[id_])
        table = self.expect(200, self.daemon.get(TABLE + "one-by-one")).json
        self.assertEqual([row["pooling"] for row in table["rows"]], ["joint"] * 3)

    def test_a_table_forgets_what_a_removed_recording_said(self) -> None:
        first, second, third = (self.recording("removing", seed) for seed in (71, 72, 73))
        self.finished(recordings=[first, second, third])
        self.expect(204, self.daemon.request("DELETE", f"/v1/recordings/{third}", headers={"If-Match": "*"}))
        [row] = self.expect(200, self.daemon.get(TABLE + "removing")).json["rows"]
        self.assertEqual((row["pooling"], set(row["recordings"])), ("average", {first, second}))
        self.finished(recordings=[first, second])
        [row] = self.expect(200, self.daemon.get(TABLE + "removing")).json["rows"]
        self.assertEqual(row["pooling"], "joint")

    def test_replicates_that_disagree_are_flagged(self) -> None:
        self.finished(recordings=[self.recording("torn", 81), self.recording("torn", 82, scale=1.3)])
        [row] = self.expect(200, self.daemon.get(TABLE + "torn")).json["rows"]
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
        self.problem(404, "not_found", self.daemon.get("/v1/studies/stu_" + "0" * 26))
        self.problem(404, "not_found", self.daemon.post("/v1/jobs", {"kind": "characterise", "inputs": {"study": "stu_" + "0" * 26}}))
        self.expect(400, self.daemon.post("/v1/jobs", {"kind": "characterise", "inputs": {"study": "stu_" + "0" * 26, "recordings": [mine]}}))
        self.expect(400, self.daemon.post("/v1/jobs", {"kind": "characterise", "inputs": {}}))


if __name__ == "__main__":
    unittest.main()
