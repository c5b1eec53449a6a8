"""Finding by a few letters: names, models and conditions, beginnings of ids, and what is no question."""
from __future__ import annotations

import unittest

import samples
from suite import DaemonTest


class Search(DaemonTest):
    def found(self, query: str) -> list[str]:
        return [hit["title"] for hit in self.expect(200, self.daemon.get(f"/v1/search?q={query}")).json["items"]]

    def test_names_that_begin_so_come_first_and_case_does_not_matter(self) -> None:
        for name in ("bench-adis", "ADIS16405-1", "adis16405-2", "phone"):
            self.expect(201, self.daemon.post("/v1/devices", {"name": name}))
        self.assertEqual(self.found("Adis"), ["ADIS16405-1", "adis16405-2", "bench-adis"])
        self.assertEqual(self.found("adis&limit=1"), ["ADIS16405-1"])
        self.assertEqual(self.found("nothing"), [])

    def test_a_name_is_found_among_a_thousand(self) -> None:
        """The find field must not know the newest devices alone."""
        for number in range(600):
            self.daemon.post("/v1/devices", {"name": f"row-{number:04d}"})
        self.assertEqual(self.found("row-0003"), ["row-0003"])
        self.assertEqual(self.found("row-0599"), ["row-0599"])

    def test_an_id_is_what_it_names(self) -> None:
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=3), rate_hz=100, columns=samples.GYRO_Z)).json
        job = self.daemon.characterise(recording["id"]).json
        for id, kind in ((recording["id"], "recording"), (job["id"], "job"), (recording["device"], "device")):
            hits = self.expect(200, self.daemon.get(f"/v1/search?q={id}")).json["items"]
            self.assertEqual([(hit["kind"], hit["id"]) for hit in hits], [(kind, id)])
            self.expect(200, self.daemon.get(hits[0]["href"]))

    def test_recordings_are_found_by_name_file_and_condition_as_people_say_it(self) -> None:
        self.expect(201, self.daemon.upload(samples.gyro_csv(seed=5), device="table", id="quiet night", rate_hz=100, columns=samples.GYRO_Z))
        self.expect(201, self.daemon.upload(samples.gyro_csv(seed=6), device="table", id="slow turn", condition="constant_rate:z:9:deg/s",
                                            file_name="turn-b.csv", rate_hz=100, columns=samples.GYRO_Z))
        self.expect(201, self.daemon.upload(samples.gyro_csv(seed=7), device="table", id="a quiet day", rate_hz=100, columns=samples.GYRO_Z))
        self.assertEqual(self.found("quiet"), ["quiet night", "a quiet day"], "what begins so comes first")
        self.assertEqual(self.found("TURN-B"), ["slow turn"])
        self.assertEqual(self.found("9%20deg/s"), ["slow turn"])
        self.assertEqual(self.found("constant_rate"), ["slow turn"])
        [hit] = self.expect(200, self.daemon.get("/v1/search?q=slow")).json["items"]
        self.assertEqual((hit["kind"], hit["subtitle"]), ("recording", "recording of table, 9 deg/s about z"))
        self.expect(200, self.daemon.get(hit["href"]))

    def test_devices_are_found_by_model_and_unit_and_leave_room_for_recordings(self) -> None:
        for number in range(12):
            self.expect(201, self.daemon.post("/v1/devices", {"name": f"unit {number}", "model": "Zephyr", "imu": "ICM-20948", "serial": f"LOT{number}"}))
        self.expect(201, self.daemon.upload(samples.gyro_csv(seed=8), device="unit 3", id="zephyr at rest", rate_hz=100, columns=samples.GYRO_Z))
        hits = self.expect(200, self.daemon.get("/v1/search?q=zephyr&limit=10")).json["items"]
        self.assertEqual([hit["kind"] for hit in hits], ["device"] * 9 + ["recording"])
        self.assertEqual(self.found("icm-20948&limit=3"), ["unit 0", "unit 1", "unit 2"])
        # An id, which is sought as well, never holds an L or an O.
        listed = self.expect(200, self.daemon.get("/v1/devices?q=lot11")).json["items"]
        self.assertEqual([device["name"] for device in listed], ["unit 11"])
        self.assertEqual(self.expect(200, self.daemon.get("/v1/devices?q=nothing")).json["items"], [])
        self.problem(400, "invalid_argument", self.daemon.get("/v1/devices?q="), parameter="q")

    def test_the_beginning_of_an_id_finds_in_any_case(self) -> None:
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=9), rate_hz=100, columns=samples.GYRO_Z)).json
        job = self.daemon.characterise(recording["id"]).json
        for id, kind in ((recording["id"], "recording"), (job["id"], "job"), (recording["device"], "device")):
            for beginning in (id[:27], id[:27].lower()):
                hits = self.expect(200, self.daemon.get(f"/v1/search?q={beginning}")).json["items"]
                self.assertIn((kind, id), [(hit["kind"], hit["id"]) for hit in hits])
        model = self.expect(201, self.daemon.post("/v1/models", {"name": "Lab baseline", "processes": [
            {"process": "white_noise", "params": {"N": {"value": 1.0, "unit": "deg/sqrt(h)"}}}]})).json
        self.assertEqual(self.found("baseline"), ["Lab baseline"])
        self.assertEqual(self.found(model["id"][:29]), ["Lab baseline"])

    def test_what_is_no_question_is_refused(self) -> None:
        self.problem(400, "invalid_argument", self.daemon.get("/v1/search"), parameter="q")
        self.problem(400, "invalid_argument", self.daemon.get("/v1/search?q=" + "x" * 201), parameter="q")
        for limit in ("0", "51", "x"):
            self.problem(400, "invalid_argument", self.daemon.get(f"/v1/search?q=a&limit={limit}"), parameter="limit")


if __name__ == "__main__":
    unittest.main()
