"""Lists in every order, what they can be narrowed to, and what must be read first."""
from __future__ import annotations

import datetime
import itertools
import unittest
import urllib.parse
from typing import Any

import samples
from daemon import Answer, multipart
from suite import DaemonTest


def now() -> str:
    return datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def wandering(seed: int) -> bytes:
    """White noise for 20 s, then with a random walk that white noise does not describe."""
    white, steps = samples.noise(4096, 2, seed=seed)
    walk = [0.0] * 2000 + list(itertools.accumulate(steps[2000:]))
    return samples.csv([[value + drift for value, drift in zip(white, walk)]], ["gz"])


class Lists(DaemonTest):
    def recorded(self, seed: int, **query: str | float) -> dict[str, Any]:
        answer = self.daemon.upload(samples.gyro_csv(seed=seed), rate_hz=100, columns=samples.GYRO_Z, **query)
        return dict(self.expect(201, answer).json)

    def names(self, target: str) -> list[str]:
        return [item["name"] for item in self.daemon.items(target)]

    def test_devices_and_models_come_in_the_order_of_their_names_page_by_page(self) -> None:
        made = [f"list-{letter}" for letter in "dbaec"] + ["list-α/β", "list %25"]
        for name in made:
            self.expect(201, self.daemon.post("/v1/devices", {"name": name}))
        for limit in (1, 2, 50):
            found = [name for name in self.names(f"/v1/devices?sort=name&limit={limit}") if name.startswith("list")]
            self.assertEqual(found, sorted(made, key=lambda name: name.encode()))
        white = {"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}]}
        for name, size in (("same", 1), ("same", 2), ("same", 3), ("first", 1)):
            white["processes"][0]["params"]["N"]["value"] = size
            self.expect(201, self.daemon.post("/v1/models", {"name": name, **white}))
        listed = self.daemon.items("/v1/models?sort=name&limit=1")
        self.assertEqual([one["name"] for one in listed], ["first", "same", "same", "same"])
        self.assertEqual(len({one["id"] for one in listed}), 4)

    def test_a_cursor_belongs_to_its_order(self) -> None:
        for name in ("cursor-a", "cursor-b"):
            self.daemon.post("/v1/devices", {"name": name})
        page = self.expect(200, self.daemon.get("/v1/devices?sort=name&limit=1"))
        by_name = page.json["next_cursor"]
        self.assertIn(f"cursor={by_name}>", page.headers["link"])
        by_age = self.expect(200, self.daemon.get("/v1/devices?limit=1")).json["next_cursor"]
        for query in (f"cursor={by_name}", f"sort=name&cursor={by_age}", f"sort=name&cursor={by_age}.zz", f"sort=name&cursor={by_age}.ff"):
            self.problem(400, "invalid_argument", self.daemon.get(f"/v1/devices?{query}"), parameter="cursor")
        for target in ("/v1/jobs?sort=name", "/v1/devices?sort=serial", "/v1/studies?sort=name"):
            self.problem(400, "invalid_argument", self.daemon.get(target), parameter="sort")

    def test_recordings_are_sought(self) -> None:
        self.recorded(1, device="sought", id="turntable 9", condition="constant_rate:z:9:deg/s")
        since = now()
        still = self.recorded(2, device="sought", file_name="C:\\data\\STILL_1.csv", condition="static")

        def found(**query: str) -> list[str]:
            target = "/v1/recordings?device=sought&" + urllib.parse.urlencode(query)
            return [one["metadata"].get("id") or one["file"]["name"] for one in self.daemon.items(target)]
        self.assertEqual(still["file"]["name"], "STILL_1.csv")
        self.assertEqual(found(sort="name"), ["STILL_1.csv", "turntable 9"])
        self.assertEqual(found(q="TURN"), ["turntable 9"])
        self.assertEqual(found(q="still"), ["STILL_1.csv"])
        self.assertEqual(found(q="constant_rate"), ["turntable 9"])
        self.assertEqual(found(q="100%"), [])
        self.assertEqual(found(since=since), ["STILL_1.csv"])
        self.assertEqual(found(has_result="true"), [])
        self.daemon.finished(self.daemon.characterise(still["id"], models=["WN"]).json["id"])
        self.assertEqual(found(has_result="true"), ["STILL_1.csv"])
        self.assertEqual(found(has_result="false"), ["turntable 9"])
        for parameter, value in (("q", ""), ("q", "x" * 201), ("q", "%00"), ("q", "%ff"), ("since", "yesterday"), ("since", "2026-11-23"), ("has_result", "yes")):
            self.problem(400, "invalid_argument", self.daemon.get(f"/v1/recordings?{parameter}={value}"), parameter=parameter)

    def test_a_recording_says_what_it_is_and_names_its_newest_job(self) -> None:
        text = b"time (s),gyro_z [deg/s],note\n" + b"".join(b"%.2f,%.4f,7\n" % (i / 50, i % 7 / 10) for i in range(300))
        made = self.expect(201, self.daemon.upload(text, file_name="a;b.csv", id="", condition="static"))
        self.assertAlmostEqual(made.json["rate_hz"], 50.0, places=9)  # 299 steps of a stamp in hundredths
        self.assertAlmostEqual(made.json["duration_s"], 6.0, places=9)
        self.assertIsNone(made.json["latest_job"])
        self.assertEqual([(c["name"], c["quantity"], c["axis"], c["unit"]) for c in made.json["columns"]][:2],
                         [("time (s)", "time", None, "s"), ("gyro_z [deg/s]", "angular_rate", "z", "deg/s")])
        target = made.headers["location"]
        before = self.expect(200, self.daemon.get(target))
        job = self.daemon.characterise(made.json["id"], models=["WN"]).json["id"]
        after = self.expect(200, self.daemon.get(target, If_None_Match=before.headers["etag"]))
        self.assertEqual(after.json["latest_job"], job)
        # The job is no change of the recording: whoever read it before the job may change it still.
        self.daemon.finished(job)
        changed = self.daemon.request("PATCH", target, {"labels": {"a": "b"}}, {"If-Match": before.headers["etag"]})
        self.expect(200, changed)
        self.problem(412, "precondition_failed", self.daemon.request("PATCH", target, {"labels": {}}, {"If-Match": after.headers["etag"]}))
        self.expect(200, self.daemon.request("PATCH", target, {"labels": {}}, {"If-Match": changed.headers["etag"]}))
        listed = next(one for one in self.daemon.items("/v1/recordings") if one["id"] == made.json["id"])
        self.assertEqual(listed["file"], {"sha256": made.json["file"]["sha256"], "name": "a;b.csv"})
        self.assertEqual((listed["duration_s"], listed["latest_job"]), (made.json["duration_s"], job))

    def test_a_form_and_an_upload_in_pieces_name_their_file(self) -> None:
        body, kind = multipart(("device", b"formed"), ("condition", b"static"), ("rate_hz", b"100"), ("file", samples.gyro_csv(seed=31)))
        body = body.replace(b'filename="data"', b'filename="../form \xc3\xa9.csv"', 1)
        made = self.expect(201, self.daemon.request("POST", "/v1/recordings", body, {"Content-Type": kind}))
        self.assertEqual(made.json["file"]["name"], "form é.csv")
        content = samples.gyro_csv(seed=32)
        tus = {"Tus-Resumable": "1.0.0"}
        offered = self.daemon.request("POST", "/v1/uploads", headers={**tus, "Upload-Length": str(len(content)), "Upload-Metadata": "filename YS5jc3Y="})
        self.daemon.request("PATCH", offered.headers["location"], content, {**tus, "Content-Type": "application/offset+octet-stream", "Upload-Offset": "0"})
        made = self.expect(201, self.daemon.request("POST", offered.headers["location"] + "/recording?device=formed&condition=static&rate_hz=100"))
        self.assertEqual(made.json["file"]["name"], "a.csv")

    def test_jobs_of_a_device_and_evaluations_by_scenario(self) -> None:
        mine = self.recorded(41, device="jobs-mine")
        other = self.recorded(42, device="jobs-other")
        job = self.daemon.characterise(mine["id"], models=["WN"]).json["id"]
        self.daemon.characterise(other["id"], models=["WN"])
        self.assertEqual([one["id"] for one in self.daemon.items("/v1/jobs?device=jobs-mine&kind=characterise")], [job])
        self.problem(404, "not_found", self.daemon.get("/v1/jobs?device=nobody"))
        since = now()
        evaluation = self.expect(202, self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 2})).json["id"]
        for query, found in (("q=PAP", [evaluation]), ("q=tunnel", []), (f"since={since}", [evaluation]), ("since=2999-01-01T00:00:00Z", [])):
            self.assertEqual([one["id"] for one in self.daemon.items(f"/v1/outage-evaluations?{query}")], found, query)
        self.daemon.finished(evaluation)


class Attention(DaemonTest):
    def items(self, query: str = "") -> list[dict[str, Any]]:
        return self.daemon.items("/v1/attention" + query)

    def characterised(self, content: bytes, device: str) -> tuple[Answer, str]:
        made = self.expect(201, self.daemon.upload(content, device=device, rate_hz=100, columns=samples.GYRO_Z))
        job = self.daemon.characterise(made.json["id"], models=["WN"]).json["id"]
        self.assertEqual(self.daemon.finished(job)["state"], "succeeded")
        return made, job

    def latest(self, device: str) -> Any:
        return self.expect(200, self.daemon.get(f"/v1/devices/{device}/summary")).json["latest"]

    def test_the_summary_of_a_device_says_its_newest_result_whatever_it_comes_to(self) -> None:
        bare = self.expect(201, self.daemon.upload(samples.gyro_csv(4096, seed=9), device="summed", rate_hz=100, columns=samples.GYRO_Z))
        self.assertIsNone(self.latest("summed"))
        wanders, first_job = self.characterised(wandering(11), "summed")
        first = self.latest("summed")
        said = self.expect(200, self.daemon.get(first["href"])).json["channels"][0]["summary"]
        self.assertEqual((first["kind"], first["id"], first["recording"], first["job"]), ("characterise", wanders.json["id"], wanders.json["id"], first_job))
        self.assertEqual((first["level"], first["verdict"]), ("look", said["verdict"]))
        self.daemon.finished(self.daemon.characterise(bare.json["id"], models=["WN"]).json["id"])
        fine = self.latest("summed")
        self.assertEqual((fine["id"], fine["level"]), (bare.json["id"], "fine"), "a result that is fine is a result")
        self.assertTrue(fine["verdict"])
        self.assertNotIn(bare.json["id"], [item["recording"] for item in self.items("?device=summed")])
        beside = {one["name"]: one for one in self.daemon.items("/v1/devices?include=summary")}
        self.assertEqual(beside["summed"]["summary"]["latest"], fine)
        self.expect(204, self.daemon.request("DELETE", bare.headers["location"], headers={"If-Match": "*"}))
        self.assertEqual(self.latest("summed"), first, "with what was deleted its results go")
        self.expect(204, self.daemon.request("DELETE", wanders.headers["location"], headers={"If-Match": "*"}))
        self.assertIsNone(self.latest("summed"))

    def test_what_does_not_fit_is_listed_until_it_is_gone_and_what_fits_is_not(self) -> None:
        since = now()
        first, job = self.characterised(wandering(1), "attention")
        fine, _ = self.characterised(samples.gyro_csv(4096, seed=2), "attention")
        second, _ = self.characterised(wandering(3), "attention-other")
        found = self.items()
        self.assertEqual([item["recording"] for item in found], [second.json["id"], first.json["id"]], "newest first")
        oldest = found[-1]
        self.assertEqual((oldest["job"], oldest["kind"], oldest["channel"], oldest["device"], oldest["device_name"]),
                         (job, "characterise", "gz", first.json["device"], "attention"))
        said = self.expect(200, self.daemon.get(oldest["href"])).json["channels"][0]["summary"]
        self.assertEqual((oldest["verdict"], oldest["level"]), (said["verdict"], said["level"]))
        self.assertEqual(self.items("?limit=1"), found)
        self.assertEqual(self.items("?sort=created_at"), found[::-1])
        self.assertEqual(self.items("?device=attention"), found[1:])
        self.assertEqual(self.items("?since=" + urllib.parse.quote(since)), found)
        self.assertEqual(self.items("?since=2999-01-01T00:00:00Z"), [])
        self.problem(400, "invalid_argument", self.daemon.get("/v1/attention?since=x"), parameter="since")
        self.problem(404, "not_found", self.daemon.get("/v1/attention?device=nobody"))
        beside = self.expect(200, self.daemon.get("/v1/counts?include=attention&since=2999-01-01T00:00:00Z")).json
        self.assertEqual(beside["attention"], self.daemon.get("/v1/attention?limit=8").json["items"])
        self.assertNotIn("attention", self.daemon.get("/v1/counts").json)
        self.problem(400, "invalid_argument", self.daemon.get("/v1/counts?include=devices"), parameter="include")
        self.expect(204, self.daemon.request("DELETE", second.headers["location"], headers={"If-Match": "*"}))
        self.assertEqual(self.items(), found[1:])
        # Trimmed to where it does not wander, the recording fits, and its newest result is what counts.
        self.expect(200, self.daemon.request("PATCH", first.headers["location"], {"trim": {"end_s": 21}}, {"If-Match": "*"}))
        self.daemon.finished(self.daemon.characterise(first.json["id"], models=["WN"]).json["id"])
        self.assertEqual(self.items(), [])
        counts = self.expect(200, self.daemon.get("/v1/counts?since=" + urllib.parse.quote(since))).json["jobs"]
        self.assertEqual((counts["succeeded_since"]["count"], counts["failed_since"]["count"]), (4, 0))
        self.assertEqual(counts["failed_since"]["at"], since)
        self.assertNotIn("failed_since", self.daemon.get("/v1/counts").json["jobs"])
        self.problem(400, "invalid_argument", self.daemon.get("/v1/counts?since=now"), parameter="since")

    def test_a_job_that_fails_is_counted(self) -> None:
        since = now()
        short = samples.gyro_csv(5, seed=9)  # enough to be a recording, too few for the analysis
        made = self.expect(201, self.daemon.upload(short, device="failing", rate_hz=100, columns=samples.GYRO_Z))
        self.assertEqual(self.daemon.finished(self.daemon.characterise(made.json["id"]).json["id"])["state"], "failed")
        counts = self.expect(200, self.daemon.get("/v1/counts?since=" + urllib.parse.quote(since))).json["jobs"]
        self.assertEqual((counts["succeeded_since"]["count"], counts["failed_since"]["count"]), (0, 1))


if __name__ == "__main__":
    unittest.main()
