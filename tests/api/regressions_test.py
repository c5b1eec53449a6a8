"""Regression runs over HTTP: stored results of two sets of recordings in, one verdict out; looks counted by label."""
from __future__ import annotations

import unittest
from typing import Any

import samples
from daemon import Answer
from suite import DaemonTest


class Regressions(DaemonTest):
    def recordings(self, first_seed: int, count: int = 3, white: float = 1.0) -> list[str]:
        """White noise at 20 Hz for ten minutes, characterised."""
        ids = []
        for seed in range(first_seed, first_seed + count):
            [column] = samples.noise(12000, 1, seed)
            content = samples.csv([[white * value for value in column]], ["gz"])
            ids.append(str(self.daemon.upload(content, device="imu-07", rate_hz=20, columns=samples.GYRO_Z).json["id"]))
        self.daemon.finished(self.daemon.characterise(*ids, models=["WN", "WN+GM"]).json["id"])
        return ids

    def ask(self, baseline: list[str], candidate: list[str], label: str, **parameters: Any) -> Answer:
        def arm(ids: list[str], release: str) -> dict[str, Any]:
            return {"labels": {"firmware": release}, "recordings": [{"recording": id_} for id_ in ids]}
        inputs = {"device": "imu-07", "baseline": arm(baseline, "1.0"), "candidate": arm(candidate, label)}
        return self.daemon.post("/v1/jobs", {"kind": "regress", "inputs": inputs, "parameters": parameters})

    def run_of(self, asked: Answer) -> dict[str, Any]:
        job = self.daemon.finished(self.expect(202, asked).json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        return dict(self.expect(200, self.daemon.get(f"/v1/regressions/{job['id']}")).json)

    def test_runs_pass_fail_and_count_their_looks(self) -> None:
        before, same, worse = self.recordings(1), self.recordings(1, white=1.01), self.recordings(21, white=1.7)  # the same noise a hundredth larger
        first = self.run_of(self.ask(before, same, "1.1"))
        self.assertEqual((first["verdict"], first["look"]["number"], first["look"]["counted"]), ("pass", 1, True))
        self.expect(200, self.ask(before, same, "1.1"))  # the same recordings are the same look, and the same job
        failed = self.run_of(self.ask(before, worse, "1.2"))
        self.assertEqual(failed["verdict"], "fail")
        self.assertEqual(failed["arms"]["candidate"]["label"], "firmware=1.2")
        self.assertEqual(self.run_of(self.ask(before, same[:2], "1.1"))["look"]["number"], 2)
        self.assertEqual(self.run_of(self.ask(before, same[:1], "1.1"))["look"]["number"], 3)
        refused = self.ask(before, same[1:], "1.1")
        self.assertEqual(refused.status, 409, refused.text)
        self.assertIn("start a new label", refused.json["detail"])
        listed = self.daemon.items("/v1/regressions")
        self.assertEqual([(run["candidate"], run["verdict"]) for run in listed[:2]], [("firmware=1.1", "pass"), ("firmware=1.2", "fail")])
        self.assertEqual(listed[1]["summary"], failed["summary"])

    def test_what_cannot_be_compared_is_refused_with_a_pointer(self) -> None:
        before = self.recordings(31, count=1)
        untold = str(self.daemon.upload(samples.gyro_csv(seed=41), device="imu-07", rate_hz=20, columns=samples.GYRO_Z).json["id"])
        refused = self.ask(before, [untold], "2.0")
        self.assertEqual(refused.status, 404, refused.text)
        self.assertIn("has no results yet", refused.json["detail"])
        self.assertEqual(self.ask(before, [], "2.0").status, 400)
        self.assertEqual(self.ask(before, before, "2.0", margins=3).status, 400)


if __name__ == "__main__":
    unittest.main()
