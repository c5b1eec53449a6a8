"""A channel as a person looks at it: spectrum, histogram, spectrogram; and what they refuse."""
from __future__ import annotations

import math
import unittest

import samples
from daemon import Daemon
from suite import DaemonTest

RATE = 100.0


class Looks(DaemonTest):
    def upload(self, values: list[float]) -> str:
        return str(self.expect(201, self.daemon.upload(samples.csv([values], ["gz"]), rate_hz=RATE, columns=samples.GYRO_Z)).json["id"])

    def test_white_noise_has_its_density_and_a_line_stands_out(self) -> None:
        """Unit variance at 100 Hz is 0.01 per hertz, two-sided; a sinusoid of 10 Hz shows in the greatest ordinate of its bin."""
        (noise,) = samples.noise(20000, seed=5)
        id = self.upload([value + 0.3 * math.sin(2 * math.pi * 10 * t / RATE) for t, value in enumerate(noise)])
        for scale in ("log", "linear"):
            found = self.expect(200, self.daemon.get(f"/v1/recordings/{id}/spectrum?channel=gz&scale={scale}&points=50")).json
            middle = sorted(found["density"])[len(found["density"]) // 2]
            self.assertAlmostEqual(middle, 0.01, delta=0.002)
            at = max(range(len(found["max"])), key=lambda i: float(found["max"][i]))
            self.assertAlmostEqual(found["f_hz"][at], 10, delta=1.5)
            self.assertGreater(found["max"][at], 20 * 0.01)
            self.assertEqual((found["unit"], found["segments"]), ("deg/s", 1))

    def test_the_histogram_stands_against_gaussian_noise_of_its_core(self) -> None:
        (noise,) = samples.noise(10000, seed=6)
        id = self.upload([value + (40 if t % 500 == 0 else 0) for t, value in enumerate(noise)])
        found = self.expect(200, self.daemon.get(f"/v1/recordings/{id}/histogram?channel=gz&bins=32")).json
        self.assertAlmostEqual(found["sigma"], 1, delta=0.05)
        self.assertEqual(found["above"], 20)
        self.assertEqual(sum(found["counts"]) + found["above"] + found["below"], 10000)
        for count, expected in zip(found["counts"], found["gaussian"]):
            self.assertLess(abs(count - expected), 5 * math.sqrt(expected) + 5)

    def test_values_apart_from_the_rest_have_their_places(self) -> None:
        """Three values within a second are one place; what was trimmed counts in the time and is not looked at; a jump and a drift are none."""
        (noise,) = samples.noise(10000, seed=16)
        noise = [value + 3e-3 * t + (25.0 if t >= 5010 else 0.0) for t, value in enumerate(noise)]
        for t in (50, 3000, 3020, 3050, 7000):
            noise[t] += 40.0
        id = self.upload(noise)
        self.expect(200, self.daemon.request("PATCH", f"/v1/recordings/{id}", {"trim": {"start_s": 2.0}}, {"If-Match": "*"}))
        found = self.expect(200, self.daemon.get(f"/v1/recordings/{id}/histogram?channel=gz")).json
        self.assertEqual([place["samples"] for place in found["apart"]], [3, 1])
        for place, (t0, t1) in zip(found["apart"], ((30.0, 30.51), (70.0, 70.01))):
            self.assertAlmostEqual(place["t0"], t0, places=6)
            self.assertAlmostEqual(place["t1"], t1, places=6)
            self.assertTrue(30 < place["deviations"] < 50, place)
        (crowded,) = samples.noise(60000, seed=17)
        for t in range(0, 60000, 200):  # three hundred, each two seconds from the next
            crowded[t] += 40.0 + (60.0 if t % 1000 == 0 else 0.0)
        found = self.expect(200, self.daemon.get(f"/v1/recordings/{self.upload(crowded)}/histogram?channel=gz")).json
        self.assertEqual((found["above"], len(found["apart"])), (300, 200))
        far = [place for place in found["apart"] if place["deviations"] > 75]
        self.assertEqual([place["t0"] for place in far], [10.0 * k for k in range(60)], "the farthest of three hundred, by time")
        self.assertEqual(found["apart"], sorted(found["apart"], key=lambda place: place["t0"]))

    def test_the_spectrogram_says_when(self) -> None:
        """Noise three times as strong in the second half: against the model of all of it the ratio steps up by a decade."""
        (noise,) = samples.noise(20000, seed=7)
        id = self.upload([value * (1 if t < 10000 else 3) for t, value in enumerate(noise)])
        self.daemon.finished(self.daemon.characterise(id).json["id"])
        fit = next(fit["id"] for fit in self.daemon.items(f"/v1/fits?recording={id}&model=WN"))
        for query, expected in (("", "median"), (f"&fit={fit}", "model")):
            found = self.expect(200, self.daemon.get(f"/v1/recordings/{id}/spectrogram?channel=gz&times=20&bands=10{query}")).json
            self.assertEqual(found["expected"], expected)
            rows = [row[-1] for row in found["log10_ratio"]]
            self.assertAlmostEqual(sum(rows[10:]) / 10 - sum(rows[:10]) / 10, math.log10(9), delta=0.1)

    def test_nothing_prompt_waits_behind_looks_that_take_long(self) -> None:
        """Four spectra of 4 million samples had every thread of the handlers: /readyz answered after 17 s."""
        values = samples.npy(samples.noise(2_000_000))
        recording = self.expect(201, self.daemon.upload(values, rate_hz=100, columns="0=angular_rate:z:deg/s")).json["id"]
        self.is_prompt_beside([lambda: self.daemon.get(f"/v1/recordings/{recording}/spectrum?channel=0")] * 5, 200)

    def test_a_look_takes_no_more_memory_than_its_budget(self) -> None:
        with Daemon(arguments=("--budget", "look_bytes=12000")) as daemon:
            for rows, status in ((500, 200), (501, 413)):
                recording = daemon.upload(samples.gyro_csv(rows), rate_hz=100, columns=samples.GYRO_Z).json["id"]
                for look in ("spectrum", "histogram", "spectrogram"):
                    answer = daemon.get(f"/v1/recordings/{recording}/{look}?channel=gz")
                    self.assertEqual(answer.status, status, answer.describe())
                    self.assertEqual("budget look_bytes = 12000" in answer.text, status == 413)

    def test_what_cannot_be_looked_at_is_refused_with_the_parameter(self) -> None:
        id = self.upload(samples.noise(70, seed=8)[0])
        base = f"/v1/recordings/{id}"
        self.problem(400, "invalid_argument", self.daemon.get(f"{base}/spectrum"), parameter="channel")
        self.problem(422, "unknown_column", self.daemon.get(f"{base}/spectrum?channel=gx"), parameter="channel")
        self.problem(400, "invalid_argument", self.daemon.get(f"{base}/spectrum?channel=gz&scale=root"), parameter="scale")
        for look, name in (("spectrum", "points"), ("histogram", "bins"), ("spectrogram", "times"), ("spectrogram", "bands")):
            for value in ("0", "9999", "x"):
                self.problem(400, "invalid_argument", self.daemon.get(f"{base}/{look}?channel=gz&{name}={value}"), parameter=name)
        self.problem(404, "not_found", self.daemon.get(f"{base}/spectrogram?channel=gz&fit=fit_nobody"))
        self.problem(404, "not_found", self.daemon.get("/v1/recordings/rec_nobody/histogram?channel=gz"))
        even = self.upload([1.0] * 60 + [2.0] * 40)
        found = self.expect(200, self.daemon.get(f"/v1/recordings/{even}/histogram?channel=gz")).json
        self.assertIsNone(found["sigma"])
        self.assertIn("equal", found["reason"])


if __name__ == "__main__":
    unittest.main()
