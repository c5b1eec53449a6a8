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
        listed = self.daemon.items("/v1/regressions?device=imu-07")
        self.assertEqual([(run["candidate"], run["verdict"]) for run in listed[:2]], [("firmware=1.1", "pass"), ("firmware=1.2", "fail")])
        self.assertEqual(listed[1]["summary"], failed["summary"])

    def turned(self, firmware: str, scale: float, seeds: range) -> list[str]:
        """Sessions of a recording at rest and one at 90 deg/s, with a scale factor error that differs by 1e-4 from session to session."""
        ids = []
        for seed in seeds:
            for condition, rate in (("static", 0.0), ("constant_rate:z:90:deg/s", 90.0)):
                [column] = samples.noise(6000, 1, 100 * seed + int(rate))
                values = [0.1 + rate * (1.0 + scale + 1e-4 * (seed % 3)) + 0.05 * value for value in column]
                about = dict(device="turned", condition=condition, labels=f"firmware={firmware}", session=f"{firmware}-{seed}")
                made = self.expect(201, self.daemon.upload(samples.csv([values], ["gz"]), rate_hz=20, columns=samples.GYRO_Z, **about))
                ids.append(str(made.json["id"]))
        self.daemon.finished(self.daemon.characterise(*ids, models=["WN"]).json["id"])
        return ids

    def test_a_scale_factor_that_moved_fails_beyond_its_margin(self) -> None:
        before = self.turned("1.0", 0.0, range(1, 4))
        same, other = self.turned("1.1", 1e-4, range(4, 7)), self.turned("1.2", 2e-3, range(7, 10))

        def arm(ids: list[str], release: str, more: dict[str, Any]) -> dict[str, Any]:
            return {"labels": {"firmware": release}, "recordings": [{"recording": id_, **more} for id_ in ids]}

        def run(candidate: list[str], release: str, margin: dict[str, Any], **arms: Any) -> dict[str, Any]:
            inputs = {"device": "turned", "baseline": arm(before, "1.0", arms.get("before", {})),
                      "candidate": arm(candidate, release, arms.get("after", {}))}
            return self.run_of(self.daemon.post("/v1/jobs", {"kind": "regress", "inputs": inputs, "parameters": {"margin": margin}}))

        def said(document: dict[str, Any]) -> tuple[str, str]:
            [check] = [finding for finding in document["findings"] if finding["check"] == "scale_factor"]
            return check["verdict"], check["sentence"]
        margin = {"scale_factor": {"gyroscope": 500}}
        kept = run(same, "1.1", margin)
        self.assertEqual(said(kept)[0], "ok", kept["findings"])
        failed = run(other, "1.2", margin)
        self.assertEqual((said(failed)[0], failed["verdict"]), ("fail", "fail"))
        self.assertRegex(said(failed)[1], r"^gyro z: the scale factor moved by \+20\d\d ppm, margin 500 ppm\.$")
        untested = run(other, "1.2", {})
        self.assertEqual(said(untested)[0], "ok")
        self.assertTrue(said(untested)[1].endswith("; no margin is set for it."), said(untested))
        # Ranges that are stated and differ are not compared: a changed full scale is another sensor.
        ranges = {"before": {"full_scale": {"gyroscope": 250}}, "after": {"full_scale": {"gyroscope": 500}}}
        changed = run(same, "1.1", margin, **ranges)
        self.assertEqual(changed["verdict"], "inconclusive", changed["summary"])
        self.assertIn("full scale", str([changed["summary"], changed.get("comparability")]).lower().replace("_", " "))
        equal = {"before": {"full_scale": {"gyroscope": 250}}, "after": {"full_scale": {"gyroscope": 250}}}
        self.assertEqual(run(same, "1.1", margin, **equal)["verdict"], kept["verdict"])

    def test_what_cannot_be_compared_is_refused_with_a_pointer(self) -> None:
        before = self.recordings(31, count=1)
        untold = str(self.daemon.upload(samples.gyro_csv(seed=41), device="imu-07", rate_hz=20, columns=samples.GYRO_Z).json["id"])
        refused = self.ask(before, [untold], "2.0")
        self.assertEqual(refused.status, 404, refused.text)
        self.assertIn("has no results yet", refused.json["detail"])
        self.assertEqual(self.ask(before, [], "2.0").status, 400)
        self.assertEqual(self.ask(before, before, "2.0", margins=3).status, 400)



class Labels(DaemonTest):
    """Arms by label: everything that has it, and what the daemon remembers of the runs before."""

    def recorded(self, seed: int, firmware: str, white: float = 1.0, session: str | None = None, device: str = "imu-08", **more: Any) -> str:
        [column] = samples.noise(12000, 1, seed)
        content = samples.csv([[white * value for value in column]], ["gz"])
        made = self.expect(201, self.daemon.upload(content, device=device, rate_hz=20, columns=samples.GYRO_Z, labels=f"firmware={firmware}",
                                                   session=session, **more)).json["id"]
        self.daemon.finished(self.daemon.characterise(made, models=["WN", "WN+GM"]).json["id"])
        return str(made)

    def ask(self, candidate: Any, baseline: Any = None, device: str = "imu-08", **more: Any) -> Answer:
        inputs = {"device": device, "candidate": candidate, **({} if baseline is None else {"baseline": baseline}), **more}
        return self.daemon.post("/v1/jobs", {"kind": "regress", "inputs": inputs})

    def run_of(self, asked: Answer) -> dict[str, Any]:
        job = self.daemon.finished(self.expect(202, asked).json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        return {"id": job["id"], **self.expect(200, self.daemon.get(f"/v1/regressions/{job['id']}")).json}

    @staticmethod
    def label(firmware: str) -> dict[str, Any]:
        return {"labels": {"firmware": firmware}}

    def test_recordings_that_were_warmer_by_their_own_column_are_not_compared(self) -> None:
        def warm(seed: int, firmware: str, degc: float) -> None:
            [column] = samples.noise(12000, 1, seed)
            content = samples.csv([column, [degc + 0.2 * value for value in column]], ["gz", "temp"])
            made = self.expect(201, self.daemon.upload(content, device="imu-11", rate_hz=20, columns=samples.GYRO_Z + ",temp=temperature::degC",
                                                       labels=f"firmware={firmware}")).json
            self.assertEqual(made["quality"]["temperature"]["column"], "temp")
            self.assertAlmostEqual(made["quality"]["temperature"]["median_degc"], degc, delta=0.02)
            self.assertAlmostEqual(made["quality"]["temperature"]["high_degc"], degc + 0.2 * 1.645, delta=0.05)
            self.daemon.finished(self.daemon.characterise(made["id"], models=["WN"]).json["id"])

        for seed in (1, 2, 3):
            warm(seed, "1.0", 25)
            warm(10 + seed, "1.1", 33)
        run = self.run_of(self.ask(self.label("1.1"), self.label("1.0"), device="imu-11"))
        self.assertEqual(run["verdict"], "inconclusive")
        [item] = (item for item in run["comparability"] if not item["comparable"])
        self.assertEqual(item["item"], "temperature")
        self.assertRegex(item["sentence"], "^The candidate was [78][0-9.]* K warmer than the baseline; at most 5 K apart")

    def test_labels_alone_mean_all_recordings_and_the_daemon_remembers(self) -> None:
        first = [self.recorded(seed, "1.0") for seed in (1, 2, 3)]
        for seed in (1, 2, 3):
            self.recorded(seed, "1.1", 1.01)
            self.recorded(20 + seed, "1.2", 1.7)
        listed = self.daemon.items("/v1/recordings?device=imu-08&labels=firmware=1.0")
        self.assertEqual([each["id"] for each in listed], first)
        self.assertEqual(listed[0]["metadata"]["labels"], {"firmware": "1.0"})
        unknown = self.ask(self.label("9"), self.label("1.0"))
        self.assertIn("No recording of imu-08 has the label firmware=9; labels of this device: firmware=1.0, firmware=1.1, firmware=1.2.",
                      str(self.problem(404, "not_found", unknown)["errors"]))
        self.assertIn("no anchor yet", str(self.problem(400, "invalid_argument", self.ask(self.label("1.1")))["errors"]))
        self.problem(400, "invalid_argument", self.ask(self.label("1.0"), self.label("1.0")))

        run = self.run_of(self.ask(self.label("1.1"), self.label("1.0")))
        self.assertEqual((run["verdict"], len(run["arms"]["candidate"]["sessions"]), run["arms"]["history"]), ("pass", 3, []))
        # Later runs need a candidate alone: the first baseline is the anchor, and the release between is history.
        second = self.run_of(self.ask(self.label("1.2")))
        self.assertEqual((second["verdict"], second["arms"]["baseline"]["label"]), ("fail", "firmware=1.0"))
        self.assertEqual([arm["label"] for arm in second["arms"]["history"]], ["firmware=1.1"])
        self.assertEqual(second["versus_previous"]["label"], "firmware=1.1")
        passed = self.run_of(self.ask(self.label("1.2"), "last_pass"))
        self.assertEqual(passed["arms"]["baseline"]["label"], "firmware=1.1")
        self.assertEqual(passed["look"]["number"], 1, "the same recordings are the same look")
        self.recorded(31, "1.2", 1.7)
        self.assertEqual(self.run_of(self.ask(self.label("1.2")))["look"]["number"], 2)

        moved = {"device": "imu-08", "label": "firmware=1.1", "reason": "filter widened"}
        self.problem(404, "not_found", self.daemon.post("/v1/regression-anchors", {**moved, "label": "firmware=9"}))
        self.problem(400, "invalid_argument", self.daemon.post("/v1/regression-anchors", {**moved, "label": "9"}))
        self.problem(400, "invalid_argument", self.daemon.post("/v1/regression-anchors", {**moved, "reason": ""}))
        self.expect(201, self.daemon.post("/v1/regression-anchors", moved))
        [anchor] = self.daemon.items("/v1/regression-anchors?device=imu-08")
        self.assertEqual((anchor["label"], anchor["reason"]), ("firmware=1.1", "filter widened"))
        self.assertEqual(self.run_of(self.ask(self.label("1.2")))["arms"]["baseline"]["label"], "firmware=1.1")

        runs = self.daemon.items("/v1/regressions?device=imu-08&label=firmware=1.2")
        self.assertEqual({run["candidate"] for run in runs}, {"firmware=1.2"})
        self.assertEqual((runs[0]["id"], runs[0]["verdict"]), (second["id"], "fail"))
        self.assertGreater(runs[0]["worst"]["ci"][0], runs[0]["worst"]["margin"])
        self.assertGreater(runs[0]["between"]["kL"]["value"], 0)
        self.assertEqual(runs[0]["device_name"], "imu-08")
        self.assertNotIn("parameters", runs[0], "tests are told of the parameter that is asked for")
        self.assertEqual(self.daemon.items("/v1/regressions?device=imu-08&parameter=flicker_noise.B")[0]["parameters"], [])
        self.problem(404, "not_found", self.daemon.get("/v1/regressions?device=nobody"))

    def test_settings_stay_with_the_anchor(self) -> None:
        for seed, firmware in ((71, "1.0"), (72, "1.1"), (73, "1.2"), (74, "1.3")):
            self.recorded(seed, firmware, device="kept")

        def run(candidate: str, baseline: Any = None, **parameters: Any) -> dict[str, Any]:
            inputs = {"device": "kept", "candidate": self.label(candidate), **({} if baseline is None else {"baseline": baseline})}
            return self.run_of(self.daemon.post("/v1/jobs", {"kind": "regress", "inputs": inputs, "parameters": parameters}))
        wide = {"margin": {"gyroscope": [20, 25, 50]}}
        first = run("1.1", self.label("1.0"), **wide)
        self.assertEqual((first["settings"]["origin"]["margin"], first["kept"]["changed"]), ("asked", []))
        later = run("1.2")
        self.assertEqual((later["settings"]["margin"]["gyroscope"][0], later["settings"]["origin"]["margin"]), (20, "anchor"))
        other = run("1.3", through_s=0.5)
        self.assertEqual(other["kept"]["changed"], [{"setting": "through_s", "kept": "1 s", "now": "0.5 s"}])
        moved = {"device": "kept", "label": "firmware=1.1", "reason": "filter widened", "settings": {"alpha": 0.1}}
        anchor = self.expect(201, self.daemon.post("/v1/regression-anchors", moved)).json
        self.assertEqual((anchor["settings"]["alpha"], anchor["settings"]["margin"]["gyroscope"][0]), (0.1, 20))
        self.problem(400, "parse_error", self.daemon.post("/v1/regression-anchors", {**moved, "settings": {"alpha": "much"}}))
        after = run("1.2")
        self.assertEqual((after["settings"]["alpha"], after["kept"]["changed"]), (0.1, []))

    def test_causes_that_investigations_identified_are_findings(self) -> None:
        def stepping(seed: int, firmware: str, step: float) -> str:
            [column] = samples.noise(4000, 1, seed)
            content = samples.csv([[value + (step if row >= 2000 else 0.0) for row, value in enumerate(column)]], ["gz"])
            made = self.expect(201, self.daemon.upload(content, device="stepping", rate_hz=20, columns=samples.GYRO_Z, labels=f"firmware={firmware}",
                                                       session=f"{firmware}-{seed}")).json["id"]
            self.daemon.finished(self.daemon.characterise(made, models=["WN"]).json["id"])
            return str(made)

        def investigate(*recordings: str) -> None:
            body = {"device": {"id": "stepping"}, "recordings": [{"recording": id_} for id_ in recordings]}
            study = self.expect(201, self.daemon.post("/v1/studies", body)).json["id"]
            job = self.daemon.finished(self.daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study}}).json["id"])
            self.assertEqual(job["state"], "succeeded", job)

        def said() -> dict[str, Any]:
            run = self.run_of(self.ask(self.label("1.1"), self.label("1.0"), device="stepping"))
            [finding] = [each for each in run["findings"] if each["check"] == "findings"]
            return dict(finding)
        before = [stepping(seed, "1.0", 0.0) for seed in (81, 82)]
        now = [stepping(seed, "1.1", 2.0) for seed in (83, 84)]
        self.assertEqual(said()["verdict"], "ok", "nobody looked")
        for id_ in now:
            investigate(id_)
        self.assertEqual(said()["verdict"], "note", "nobody looked at the baseline")
        investigate(*before)
        found = said()
        self.assertEqual((found["verdict"], found["sessions"]), ("fail", ["1.1-83", "1.1-84"]), found)
        self.assertIn("bias_step", found["sentence"])

    def test_a_run_is_shown_in_every_form(self) -> None:
        arms = {name: {"recordings": [{"recording": self.recorded(41, name, white, device="forms")}]} for name, white in (("baseline", 1.0), ("candidate", 1.09))}
        run = self.run_of(self.ask(arms["candidate"], arms["baseline"], device="forms"))
        target = f"/v1/regressions/{run['id']}"
        self.assertEqual(run["verdict"], "inconclusive", "9 % beside a margin of 10 %")
        self.assertTrue(self.expect(200, self.daemon.get(target, Accept="text/plain")).text.startswith("INCONCLUSIVE: "))
        page = self.expect(200, self.daemon.get(target, Accept="text/markdown")).text
        self.assertTrue(page.startswith("**INCONCLUSIVE**"))
        self.assertIn(f"({target}/figure)", page)
        self.assertIn("<error", self.expect(200, self.daemon.get(target + "/junit")).text)
        self.assertIn("<skipped", self.expect(200, self.daemon.get(target + "/junit?inconclusive=pass")).text)
        self.problem(400, "invalid_argument", self.daemon.get(target + "/junit?inconclusive=maybe"), parameter="inconclusive")
        for drawing in ("figure", "badge"):
            answer = self.expect(200, self.daemon.get(f"{target}/{drawing}"))
            self.assertTrue(answer.headers["content-type"].startswith("image/svg+xml"))
        self.problem(404, "not_found", self.daemon.get(f"/v1/regressions/{self.daemon.items('/v1/jobs?kind=characterise')[0]['id']}/badge"))

    def test_sessions_come_from_the_recordings(self) -> None:
        for seed in (51, 52):
            self.recorded(seed, "1.0", session="Monday", device="sessions")
        other = self.recorded(53, "1.0", device="sessions", recorded_at="2026-11-22T10:00:00Z")
        for seed in (54, 55):
            self.recorded(seed, "1.1", session=f"session {seed}", device="sessions")
        run = self.run_of(self.ask(self.label("1.1"), self.label("1.0"), device="sessions"))
        self.assertEqual(sorted(len(session["recordings"]) for session in run["arms"]["baseline"]["sessions"]), [1, 2])
        self.assertEqual(len(run["arms"]["candidate"]["sessions"]), 2)
        excluded = self.run_of(self.ask(self.label("1.1"), self.label("1.0"), device="sessions", excluded=[{"recording": other, "reason": "cable touched"}]))
        self.assertEqual(len(excluded["arms"]["baseline"]["sessions"]), 1)
        self.assertEqual(excluded["arms"]["excluded"], [{"recording": other, "reason": "cable touched"}])

    def test_labels_change_without_a_revision(self) -> None:
        recording = self.recorded(61, "1.0", device="relabelled")
        target = f"/v1/recordings/{recording}"
        before = self.daemon.get(target)
        change = self.expect(200, self.daemon.request("PATCH", target, {"labels": {"firmware": "1.1"}, "session": "Tuesday"}, {"If-Match": before.headers["etag"]}))
        self.assertEqual((change.json["revision"], change.json["metadata"]["session"]), (1, "Tuesday"))
        self.assertNotEqual(change.headers["etag"], before.headers["etag"])
        self.problem(412, "precondition_failed", self.daemon.request("PATCH", target, {"labels": None}, {"If-Match": before.headers["etag"]}))
        self.expect(200, self.daemon.get(f"{target}/characterisation"))
        self.assertEqual(self.daemon.items("/v1/recordings?labels=firmware=1.0&device=relabelled"), [])
        self.problem(400, "invalid_argument", self.daemon.request("PATCH", target, {"labels": {"a": "b,c"}}, {"If-Match": "*"}))
        self.problem(400, "invalid_argument", self.daemon.request("PATCH", target, {"recorded_at": "yesterday"}, {"If-Match": "*"}))
        self.problem(400, "invalid_argument", self.daemon.get("/v1/recordings?labels=firmware"), parameter="labels")
        gone = self.expect(200, self.daemon.request("PATCH", target, {"labels": None, "session": None}, {"If-Match": "*"}))
        self.assertNotIn("labels", gone.json["metadata"])
        [column] = samples.noise(12000, 1, 61)
        again = dict(device="relabelled", rate_hz=20, columns=samples.GYRO_Z)
        self.expect(200, self.daemon.upload(samples.csv([column], ["gz"]), **again))
        self.problem(409, "conflict", self.daemon.upload(samples.csv([column], ["gz"]), labels="firmware=2", **again), recording_id=recording, differs="labels")


if __name__ == "__main__":
    unittest.main()
