"""The table of an axis that its pooling keeps: the same bytes as from the results, and never one of other results or of another device."""
from __future__ import annotations

import tempfile
import time
import unittest
from pathlib import Path
from typing import Any

import samples
from daemon import PATIENCE_S, Answer, Daemon

AXIS = "/v1/parameter-tables?device=kept&sensor=gyroscope&axis=z"
ALL = "/v1/parameter-tables?device=kept&sensor=gyroscope&axis=all"
TRENDS = "/v1/trends?device=kept&sensor=gyroscope&axis=z"


class KeptTables(unittest.TestCase):
    def setUp(self) -> None:
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.daemon = self.enterContext(Daemon(folder / "data"))
        self.written = 0
        self.add("static", "static", "constant_rate:z:10:deg/s")

    def add(self, *conditions: str) -> None:
        recordings = []
        for condition in conditions:
            self.written += 1
            answer = self.daemon.upload(samples.csv(samples.noise(4000, 1, seed=self.written), ["gz"]), device="kept", condition=condition,
                                        rate_hz=100, columns=samples.GYRO_Z)
            self.assertEqual(answer.status, 201, answer.describe())
            recordings.append(answer.json["id"])
        self.assertEqual(self.daemon.finished(self.daemon.characterise(*recordings).json["id"])["state"], "succeeded")

    def pooled(self, target: str = AXIS) -> Answer:
        until = time.monotonic() + PATIENCE_S
        while True:
            answer = self.daemon.get(target)
            self.assertEqual(answer.status, 200, answer.describe())
            tables: list[dict[str, Any]] = answer.json.get("tables", [answer.json])
            if all(table["pooling"]["state"] == "done" and table["pooling"]["job"] for table in tables):
                return answer
            self.assertLess(time.monotonic(), until)
            time.sleep(0.05)

    def another_write(self) -> None:
        """So that no answer of before is given again."""
        self.written += 1
        self.assertEqual(self.daemon.upload(samples.csv(samples.noise(100, 1, seed=self.written), ["gz"]), device="other", rate_hz=100,
                                            columns=samples.GYRO_Z).status, 201)

    def kept(self) -> int:
        return int(self.daemon.rows("SELECT count(*) FROM artefacts WHERE name = 'table'")[0][0])

    def forget(self) -> None:
        self.daemon.change("DELETE FROM artefacts WHERE name = 'table'")
        self.another_write()

    def test_it_is_what_the_results_give(self) -> None:
        answers = [self.pooled(target) for target in (AXIS, ALL, TRENDS)]
        self.assertEqual(self.kept(), 1)
        self.forget()
        self.assertEqual([self.daemon.get(target).body for target in (AXIS, ALL, TRENDS)], [answer.body for answer in answers])
        self.assertEqual([row["pooling"] for row in answers[0].json["rows"]], ["joint", "single"])

    def test_it_is_read_instead_of_the_results_and_they_instead_of_a_damaged_one(self) -> None:
        before = self.pooled()
        self.daemon.change("UPDATE artefacts SET content = replace(content, 'deg', 'rad') WHERE name = 'table'")
        self.another_write()
        self.assertEqual(self.daemon.get(AXIS).body, before.body, "made from the results")
        self.daemon.change("UPDATE artefacts SET content = replace(content, 'rad', 'deg') WHERE name = 'table'")
        self.daemon.change("UPDATE channel_results SET document_json = replace(document_json, '1', '2')")
        self.another_write()
        self.assertEqual(self.daemon.get(AXIS).body, before.body, "no result was read")
        self.forget()
        self.assertEqual(self.daemon.get(AXIS).status, 500)

    def test_other_questions_have_other_answers(self) -> None:
        before = self.pooled()
        for more in ("&method=av", "&model=WN%2BGM", "&reference=constant_rate:z:10:deg/s"):
            self.assertNotEqual(self.daemon.get(AXIS + more).body, before.body, more)
        self.assertEqual(self.daemon.get(AXIS + "&model=nothing").status, 400)
        self.assertEqual(self.daemon.get(AXIS.replace("axis=z", "axis=x")).status, 404)
        self.assertEqual(self.daemon.get(AXIS.replace("gyroscope", "barometer")).status, 400)

    def test_new_results_and_a_device_that_says_more_of_itself_have_tables_of_their_own(self) -> None:
        self.assertNotIn("data_sheet", self.pooled().json)
        device = self.daemon.get("/v1/devices/kept")
        patched = self.daemon.request("PATCH", "/v1/devices/kept", b'{"imu": "MPU-6050"}',
                                      {"Content-Type": "application/merge-patch+json", "If-Match": device.headers["etag"]})
        self.assertEqual(patched.status, 200, patched.describe())
        self.assertEqual(self.pooled().json["data_sheet"]["sensor"], "MPU-6050")
        self.add("static")
        table = self.pooled()
        self.assertEqual(len(table.json["rows"][0]["recordings"]), 3)
        self.assertEqual(table.json["data_sheet"]["sensor"], "MPU-6050")
        self.assertEqual(self.kept(), 1, "that of the results of before is gone")
        self.forget()
        self.assertEqual(self.daemon.get(AXIS).body, table.body)


if __name__ == "__main__":
    unittest.main(verbosity=2)
