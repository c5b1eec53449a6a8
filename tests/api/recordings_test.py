"""Devices and recordings after the upload: reading, listing, changing, deleting."""
from __future__ import annotations

import unittest
import urllib.parse

import samples
from suite import DaemonTest


class Devices(DaemonTest):
    def test_made_known_once_and_changed_by_patch(self) -> None:
        body = {"name": "imu 1/α", "model": "ADIS16405", "labels": {"firmware": "1.4.2"}}
        made = self.expect(201, self.daemon.post("/v1/devices", body))
        self.expect(200, self.daemon.post("/v1/devices", body))
        conflict = self.problem(409, "conflict", self.daemon.post("/v1/devices", {**body, "model": "other"}), device_id=made.json["id"])
        self.assertIn("PATCH /v1/devices/" + made.json["id"], str(conflict["detail"]))
        target = made.headers["location"]
        self.problem(428, "precondition_required", self.daemon.request("PATCH", target, {"serial": "7"}))
        self.problem(412, "precondition_failed", self.daemon.request("PATCH", target, {"serial": "7"}, {"If-Match": '"stale"'}))
        changed = self.expect(200, self.daemon.request("PATCH", target, {"serial": "7"}, {"If-Match": made.headers["etag"]}))
        self.assertEqual((changed.json["serial"], changed.json["model"], changed.json["revision"]), ("7", "ADIS16405", 2))
        self.assertNotEqual(changed.headers["etag"], made.headers["etag"])
        self.problem(412, "precondition_failed", self.daemon.request("PATCH", target, {"serial": "8"}, {"If-Match": made.headers["etag"]}))
        by_name = self.daemon.get(target)
        self.assertEqual(by_name.json["serial"], "7")

    def test_every_fault_of_a_body_is_reported_at_once(self) -> None:
        answer = self.daemon.post("/v1/devices", {"name": 7, "modell": "x", "labels": {"a": 1}})
        problem = self.problem(400, "parse_error", answer)
        self.assertEqual({error["pointer"] for error in problem["errors"]}, {"/name", "/modell", "/labels"})

    def test_read_by_id_or_name(self) -> None:
        made = self.expect(201, self.daemon.post("/v1/devices", {"name": "phone 07"}))
        self.assertEqual(self.daemon.get("/v1/devices/phone%2007").json, self.daemon.get(f"/v1/devices/{made.json['id']}").json)
        self.problem(404, "not_found", self.daemon.get("/v1/devices/nobody"))

    def test_idempotency_key_replays_and_is_bound_to_its_request(self) -> None:
        key = {"Idempotency-Key": "device-1"}
        first = self.expect(201, self.daemon.post("/v1/devices", {"name": "keyed"}, key))
        again = self.expect(201, self.daemon.post("/v1/devices", {"name": "keyed"}, key))
        self.assertEqual((again.body, again.headers["idempotency-replayed"]), (first.body, "true"))
        self.assertEqual(again.headers["location"], first.headers["location"])
        self.problem(422, "idempotency_key_reused", self.daemon.post("/v1/devices", {"name": "keyed-2"}, key))
        self.problem(422, "idempotency_key_reused", self.daemon.post("/v1/jobs", {"name": "keyed"}, key))
        self.problem(400, "invalid_argument", self.daemon.post("/v1/devices", {"name": "keyed-3"}, {"Idempotency-Key": "x" * 65}))


class Recordings(DaemonTest):
    def uploaded(self, seed: int, **query: object) -> tuple[str, str]:
        answer = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=seed), rate_hz=100, columns=samples.GYRO_Z, **query))
        return answer.headers["location"], answer.headers["etag"]

    def test_patch_makes_a_revision(self) -> None:
        target, etag = self.uploaded(1)
        change = {"condition": {"kind": "constant_rate", "axis": "z", "value": 9, "unit": "deg/s"}}
        self.problem(428, "precondition_required", self.daemon.request("PATCH", target, change))
        self.problem(412, "precondition_failed", self.daemon.request("PATCH", target, change, {"If-Match": '"x"'}))
        changed = self.expect(200, self.daemon.request("PATCH", target, change, {"If-Match": etag}))
        self.assertEqual(changed.json["revision"], 2)
        self.assertEqual(changed.json["metadata"]["condition"], {**change["condition"], "value": 9.0})
        self.assertEqual(changed.json["metadata"]["rate_hz"], 100)
        self.problem(412, "precondition_failed", self.daemon.request("PATCH", target, change, {"If-Match": etag}))
        same = self.expect(200, self.daemon.request("PATCH", target, change, {"If-Match": changed.headers["etag"]}))
        self.assertEqual(same.json["revision"], 2, "no change, no revision")
        self.assertEqual(self.daemon.get(target).json, changed.json)

    def test_patch_removes_with_null_and_takes_merge_patch(self) -> None:
        target, etag = self.uploaded(2, trim_start_s=1)
        removed = self.daemon.request("PATCH", target, b'{"trim": null}', {"If-Match": etag, "Content-Type": "application/merge-patch+json"})
        self.assertNotIn("trim", self.expect(200, removed).json["metadata"])
        self.assertEqual(removed.json["quality"]["analysed"], 512)

    def test_patch_is_checked_against_the_samples(self) -> None:
        target, etag = self.uploaded(3)
        match = {"If-Match": etag}
        before = self.daemon.get(target).json
        columns = {"nobody": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}
        self.problem(422, "unknown_column", self.daemon.request("PATCH", target, {"columns": columns}, match))
        self.problem(400, "unknown_condition", self.daemon.request("PATCH", target, {"condition": {"kind": "asleep"}}, match))
        self.problem(422, "too_few_samples", self.daemon.request("PATCH", target, {"trim": {"start_s": 100}}, match))
        problem = self.problem(400, "invalid_argument", self.daemon.request("PATCH", target, {"rate": 3}, match))
        self.assertEqual([error["pointer"] for error in problem["errors"]], ["/rate"])
        self.assertIn("known are id, rate_hz, columns, stream, condition, trim, calibration, labels, session, recorded_at", str(problem["errors"]))
        self.assertEqual(self.daemon.get(target).json, before)

    def test_results_of_an_older_revision_leave_the_table(self) -> None:
        target, etag = self.uploaded(4, device="revised")
        recording = self.daemon.get(target).json["id"]
        job = self.daemon.finished(self.daemon.characterise(recording, models=["WN"]).json["id"])
        table = "/v1/parameter-tables?device=revised&axis=z"
        self.assertEqual(self.expect(200, self.daemon.get(table)).json["rows"][0]["recordings"], [recording])
        self.expect(200, self.daemon.request("PATCH", target, {"rate_hz": 50}, {"If-Match": etag}))
        self.problem(404, "not_found", self.daemon.get(table))
        again = self.expect(202, self.daemon.characterise(recording, models=["WN"]))
        self.assertNotEqual(again.json["id"], job["id"], "another revision is another job")
        self.daemon.finished(again.json["id"])
        self.expect(200, self.daemon.get(table))

    def test_headings_are_replicates_of_one_condition(self) -> None:
        ids = []
        for heading in ("0", "90", "-90"):
            made = self.expect(201, self.daemon.upload(samples.gyro_csv(2048, seed=70 + int(heading)), device="turned", rate_hz=100, columns=samples.GYRO_Z,
                                                       condition=f"static:{heading}"))
            ids.append(made.json["id"])
        self.assertEqual([self.daemon.get(f"/v1/recordings/{one}").json["metadata"]["condition"] for one in ids],
                         [{"kind": "static", "heading_deg": 0}, {"kind": "static", "heading_deg": 90}, {"kind": "static", "heading_deg": 270}])
        for one in ids:
            self.daemon.finished(self.expect(202, self.daemon.characterise(one, models=["WN"])).json["id"])
        table = self.expect(200, self.daemon.get("/v1/parameter-tables?device=turned&axis=z", Prefer="wait=60")).json
        [row] = table["rows"]
        self.assertEqual((row["condition"], sorted(row["recordings"])), ({"kind": "static"}, sorted(ids)))
        self.assertEqual(len(self.daemon.items("/v1/recordings?device=turned&condition=static")), 3)
        self.problem(400, "invalid_argument", self.daemon.upload(samples.gyro_csv(seed=9), device="turned", rate_hz=100, columns=samples.GYRO_Z, condition="profile:90"))

    def test_delete_keeps_the_bytes_that_another_recording_holds(self) -> None:
        """Bytes that no recording holds are swept later: an upload of them may be running."""
        content = samples.gyro_csv(seed=5)
        answers = [self.expect(201, self.daemon.upload(content, device=name, rate_hz=100)) for name in ("left", "right")]
        sha256 = answers[0].json["file"]["sha256"]
        self.problem(428, "precondition_required", self.daemon.request("DELETE", answers[0].headers["location"]))
        self.problem(412, "precondition_failed", self.daemon.request("DELETE", answers[0].headers["location"], headers={"If-Match": '"x"'}))
        for answer in answers:
            gone = self.expect(204, self.daemon.request("DELETE", answer.headers["location"], headers={"If-Match": answer.headers["etag"]}))
            self.assertEqual(gone.body, b"")
            self.problem(404, "not_found", self.daemon.get(answer.headers["location"]))
            if answer is answers[0]:
                self.assertIn(f"{sha256[:2]}/{sha256}", self.daemon.files("blobs"))
                job = self.daemon.finished(self.daemon.characterise(answers[1].json["id"], models=["WN"]).json["id"])
                self.assertEqual(job["state"], "succeeded", job)
        again = self.expect(201, self.daemon.upload(content, device="left", rate_hz=100))
        self.assertNotEqual(again.json["id"], answers[0].json["id"])

    def test_delete_takes_the_results(self) -> None:
        target, etag = self.uploaded(6, device="deleted")
        recording = self.daemon.get(target).json["id"]
        self.daemon.finished(self.daemon.characterise(recording, models=["WN"]).json["id"])
        self.assertEqual(len(self.daemon.items("/v1/fits?device=deleted")), 1)
        self.expect(204, self.daemon.request("DELETE", target, headers={"If-Match": etag}))
        self.assertEqual(self.daemon.items("/v1/fits?device=deleted"), [])
        self.problem(404, "not_found", self.daemon.get("/v1/parameter-tables?device=deleted&axis=z"))

    def test_etag_gives_304(self) -> None:
        target, etag = self.uploaded(7)
        for known in (etag, f'"other", {etag}', "*"):
            answer = self.expect(304, self.daemon.get(target, If_None_Match=known))
            self.assertEqual((answer.body, answer.headers["etag"]), (b"", etag))
        self.expect(200, self.daemon.get(target, If_None_Match='"other"'))
        listed = self.daemon.get("/v1/recordings")
        self.expect(304, self.daemon.get("/v1/recordings", If_None_Match=listed.headers["etag"]))

    def test_head_is_get_without_the_body(self) -> None:
        target, _ = self.uploaded(8)
        for path in (target, "/v1/recordings", "/healthz", "/", "/v1/recordings/rec_nobody"):
            head, get = self.daemon.request("HEAD", path), self.daemon.get(path)
            self.assertEqual((head.status, head.body), (get.status, b""), path)
            for name in ("content-length", "content-type", "etag"):
                if name != "content-length" or get.status == 200:  # a problem holds its request's id
                    self.assertEqual(head.headers.get(name), get.headers.get(name), f"{path} {name}")


class Pages(DaemonTest):
    def test_cursor_walks_every_item_once_in_order(self) -> None:
        names = [f"device & {i}" for i in range(7)]
        for name in names:
            self.expect(201, self.daemon.post("/v1/devices", {"name": name}))
        for i in range(5):
            self.expect(201, self.daemon.upload(samples.gyro_csv(16, seed=i), device=names[0], rate_hz=100))
        self.assertEqual([device["name"] for device in self.daemon.items("/v1/devices?limit=3")], names)
        self.assertEqual(self.daemon.items("/v1/devices?limit=7"), self.daemon.items("/v1/devices"))
        recordings = self.daemon.items("/v1/recordings?limit=2")
        self.assertEqual(len({recording["id"] for recording in recordings}), 5)
        self.assertEqual(recordings, self.daemon.items("/v1/recordings"))

    def test_link_leads_to_the_next_page_whatever_stands_in_the_query(self) -> None:
        name = "a&b=c#d>é\"%0D%0AX-Evil: 1"
        self.expect(201, self.daemon.post("/v1/devices", {"name": name}))
        for i in range(3):
            self.expect(201, self.daemon.upload(samples.gyro_csv(16, seed=20 + i), device=name, rate_hz=100))
        target = "/v1/recordings?limit=2&device=" + urllib.parse.quote(name, safe="")
        first = self.expect(200, self.daemon.get(target))
        self.assertNotIn("x-evil", first.headers)
        link = first.headers["link"]
        self.assertTrue(link.startswith("</v1/recordings?") and link.endswith('>; rel="next"'), link)
        second = self.expect(200, self.daemon.get(link[1:link.index(">")]))
        self.assertEqual(len(second.json["items"]), 1)
        self.assertNotIn("link", second.headers)
        self.assertIsNone(second.json["next_cursor"])

    def test_filters_and_their_faults(self) -> None:
        self.expect(201, self.daemon.upload(samples.gyro_csv(seed=31), device="f", rate_hz=100))
        self.expect(201, self.daemon.upload(samples.gyro_csv(seed=32), device="f", condition="constant_rate:z:9:deg/s", rate_hz=100))
        found = self.daemon.items("/v1/recordings?device=f&condition=constant_rate:z:9:deg/s")
        self.assertEqual([r["metadata"]["condition"]["kind"] for r in found], ["constant_rate"])
        self.problem(404, "not_found", self.daemon.get("/v1/recordings?device=nobody"))
        self.problem(400, "unknown_condition", self.daemon.get("/v1/recordings?condition=asleep"), parameter="condition")
        for query, parameter in (("limit=0", "limit"), ("limit=501", "limit"), ("limit=ten", "limit"), ("cursor=x", "cursor"), ("cursor=rec_", "cursor")):
            self.problem(400, "invalid_argument", self.daemon.get("/v1/recordings?" + query), parameter=parameter)


if __name__ == "__main__":
    unittest.main()
