"""Finding by a few letters: names from their beginning and further on, ids whole, and what is no question."""
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

    def test_what_is_no_question_is_refused(self) -> None:
        self.problem(400, "invalid_argument", self.daemon.get("/v1/search"), parameter="q")
        self.problem(400, "invalid_argument", self.daemon.get("/v1/search?q=" + "x" * 201), parameter="q")
        for limit in ("0", "51", "x"):
            self.problem(400, "invalid_argument", self.daemon.get(f"/v1/search?q=a&limit={limit}"), parameter="limit")


if __name__ == "__main__":
    unittest.main()
