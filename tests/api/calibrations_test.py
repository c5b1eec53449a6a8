"""Calibrations: made from uploaded recordings or elsewhere, stored, and applied to recordings that name them."""
from __future__ import annotations

import math
import unittest
from typing import Any

import samples
from suite import DaemonTest

ACCELEROMETERS = ",".join(f"f{a}=specific_force:{a}:m/s^2" for a in "xyz")
TABLE = "gz=angular_rate:z:deg/s,rz=reference_angular_rate:z:deg/s"
GRAVITY = 9.81
NOBODY = "cal_" + "0" * 26


def identity(reading_unit: str = "rad/s", z: float = 1.0) -> dict[str, Any]:
    return {"apply": {"reading_unit": reading_unit, "bias": [0, 0, 0], "correction": [[1, 0, 0], [0, 1, 0], [0, 0, z]]}}


class Calibrations(DaemonTest):
    def six_positions(self, device: str) -> list[str]:
        """Each axis up and down; biases of 0.1, 0.2, 0.3 m/s^2, scale factors of 1, 2, 3 per mille."""
        ids = []
        for i, axis in enumerate("xyz"):
            for direction in ("up", "down"):
                columns = samples.noise(400, 3, 10 * i + len(direction))
                for j, column in enumerate(columns):
                    truth = (GRAVITY if direction == "up" else -GRAVITY) if i == j else 0.0
                    columns[j] = [0.01 * value + 0.1 * (j + 1) + truth * (1 + 0.001 * (j + 1)) for value in column]
                answer = self.daemon.upload(samples.csv(columns, ["fx", "fy", "fz"]), device=device, rate_hz=100, columns=ACCELEROMETERS,
                                            condition=f"six_position:{axis}:{direction}")
                ids.append(str(self.expect(201, answer).json["id"]))
        return ids

    def on_a_table(self, device: str, **query: Any) -> Any:
        """A gyroscope that reads 3 per cent too much of a table that swings by 60 deg/s; noise of 0.1 deg/s."""
        [noise] = samples.noise(4000, 1, 5)
        table = [60.0 * math.sin(0.02 * i) for i in range(4000)]
        gyro = [1.03 * rate + 0.1 * value for rate, value in zip(table, noise)]
        return self.daemon.upload(samples.csv([gyro, table], ["gz", "rz"]), device=device, condition="profile", rate_hz=100, columns=TABLE, **query)

    def error_of(self, recording: str) -> dict[str, Any]:
        job = self.daemon.finished(self.daemon.characterise(recording).json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        return dict(self.expect(200, self.daemon.get(job["result"]["href"])).json["recordings"][0])

    def test_six_positions_give_bias_and_scale_factor(self) -> None:
        ids = self.six_positions("level")
        body = {"device": {"id": "level"}, "recordings": ids, "gravity_m_s2": GRAVITY}
        made = self.expect(201, self.daemon.post("/v1/calibrations", body))
        self.assertEqual(self.expect(200, self.daemon.post("/v1/calibrations", body)).json, made.json)
        self.assertEqual(self.expect(200, self.daemon.get(made.headers["location"])).json, made.json)
        self.assertEqual([c["id"] for c in self.daemon.items("/v1/calibrations?device=level")], [made.json["id"]])
        self.assertEqual([r["id"] for r in made.json["recordings"]], ids)
        accelerometer = made.json["calibration"]["accelerometer"]
        for j, axis in enumerate("xyz"):  # means of 400 samples: 0.0005 m/s^2
            self.assertAlmostEqual(accelerometer["bias"][axis]["value"], 0.1 * (j + 1), delta=0.002)
            self.assertAlmostEqual(accelerometer["scale_factor"][axis]["value"], 1000.0 * (j + 1), delta=200)
        self.assertLess(accelerometer["residual_rms"]["after"], 0.05 * accelerometer["residual_rms"]["before"])

    def test_a_recording_is_corrected_by_the_calibration_it_names(self) -> None:
        raw = self.expect(201, self.on_a_table("table"))
        before = self.error_of(raw.json["id"])
        made = self.expect(201, self.daemon.post("/v1/calibrations", {"device": {"id": "table"}, "calibration": {"gyroscope": identity(z=1 / 1.03)}}))
        change = {"calibration": made.json["id"]}
        revised = self.expect(200, self.daemon.request("PATCH", raw.headers["location"], change, {"If-Match": raw.headers["etag"]}))
        self.assertEqual(revised.json["metadata"]["calibration"], made.json["id"])
        after = self.error_of(raw.json["id"])
        self.assertNotIn("calibration", before)
        self.assertEqual(after["calibration"], made.json["id"])
        [left], [right] = before["channels"], after["channels"]
        # 1.8 deg/s of the table's motion stand in the error at rest of calibration; then white noise of 0.1/1.03 deg/s.
        scale = left["haar"]["scale"].index(256)
        self.assertGreater(left["haar"]["variance"][scale], 0.1)
        self.assertLess(right["haar"]["variance"][scale], 1e-4)
        self.assertEqual(right["reference"]["column"], "rz")
        self.assertAlmostEqual(right["reference"]["gain"], 1.0, delta=0.001)
        low, high = right["reference"]["delay"]["ci95"]
        self.assertLess(abs(low + high), 2.0 * (high - low))  # four standard errors

    def test_a_calibration_may_come_with_the_upload(self) -> None:
        made = self.expect(201, self.daemon.post("/v1/calibrations", {"device": {"id": "early"}, "calibration": {"gyroscope": identity()}}))
        answer = self.expect(201, self.on_a_table("early", calibration=made.json["id"]))
        self.assertEqual(answer.json["metadata"]["calibration"], made.json["id"])

    def test_faults_are_located(self) -> None:
        raw = self.expect(201, self.on_a_table("faulty-table"))
        post = lambda **members: self.daemon.post("/v1/calibrations", {"device": {"id": "faulty-table"}, **members})  # noqa: E731
        self.expect(400, post())
        self.expect(400, post(recordings=[]))
        self.expect(400, post(recordings=[raw.json["id"]], calibration={"gyroscope": identity()}))
        self.expect(400, post(calibration={}))
        self.expect(400, post(calibration={"gyroscope": {"apply": {"reading_unit": "rad/s"}}}))
        self.expect(400, post(recordings=[raw.json["id"]], gravity_m_s2=1.6))
        self.expect(400, post(recordings=[raw.json["id"]], colour=1))
        self.expect(404, post(recordings=["rec_" + "0" * 26]))
        answer = post(recordings=[raw.json["id"]])  # has no accelerometer to be held still
        self.assertIn(answer.status, (400, 422))
        self.assertIn("specific_force", answer.json["detail"])
        self.expect(404, self.daemon.get("/v1/calibrations/" + NOBODY))
        in_counts = self.expect(201, post(calibration={"gyroscope": identity("1")})).json["id"]
        other = self.expect(201, self.daemon.post("/v1/calibrations", {"device": {"id": "someone"}, "calibration": {"gyroscope": identity()}})).json["id"]
        for calibration in (NOBODY, other, in_counts):
            answer = self.daemon.request("PATCH", raw.headers["location"], {"calibration": calibration}, {"If-Match": "*"})
            self.assertIn(answer.status, (400, 422), calibration)
            self.assertIn(self.on_a_table("faulty-table-2", calibration=calibration).status, (400, 422))


if __name__ == "__main__":
    unittest.main()
