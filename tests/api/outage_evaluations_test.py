"""Outage evaluations over HTTP: queued, followed, read; scenarios by name and as documents; faults by place."""
from __future__ import annotations

import copy
import unittest
from typing import Any

import samples
from daemon import events
from suite import DaemonTest

SCENARIO: dict[str, Any] = {
    "name": "one turn", "duration_s": 45, "imu_rate_hz": 20,
    "trajectory": {"start": {"speed_m_s": 15}, "segments_by_start_time": [{"t_s": 30, "kind": "turn", "rate_deg_s": 9, "duration_s": 10}]},
    "outages": [{"start_s": 30, "duration_s": 10}],
    "truth": {"gyro": {"processes": [{"process": "white_noise", "params": {"N": {"value": 1.03, "unit": "deg/sqrt(h)"}}},
                                     {"process": "gauss_markov", "params": {"sigma": {"value": 62, "unit": "deg/h"}, "beta": {"value": 0.01, "unit": "1/s"}}}],
                       "constant_bias_sd_deg_s": 0.05},
              "accelerometer": {"white_noise_mg_per_sqrt_hz": 2, "constant_bias_sd_mg": 10}},
    "filters": [{"name": "matched"},
                {"name": "too quiet", "gyro": {"processes": [{"process": "white_noise", "params": {"N": {"value": 0.1, "unit": "deg/sqrt(h)"}}}],
                                               "constant_bias_sd_deg_s": 0.001}}],
}


class OutageEvaluations(DaemonTest):
    arguments = ("--workers", "1")

    def evaluated(self, **body: Any) -> dict[str, Any]:
        queued = self.expect(202, self.daemon.post("/v1/outage-evaluations", body))
        self.assertEqual(queued.headers["location"], "/v1/outage-evaluations/" + queued.json["id"])
        self.assertEqual(self.daemon.finished(queued.json["id"])["state"], "succeeded")
        return dict(self.expect(200, self.daemon.get(queued.headers["location"])).json)

    def test_an_evaluation_holds_what_a_dashboard_draws(self) -> None:
        found = self.evaluated(scenario=SCENARIO, runs=30, seed=5)
        self.assertEqual((found["scenario_name"], found["runs"], found["seed"], found["progress"]), ("one turn", 30, 5, 1))
        result = found["evaluation"]
        self.assertEqual([f["name"] for f in result["filters"]], ["matched", "too quiet"])
        matched, quiet = result["filters"]
        self.assertGreater(quiet["nees"], 2 * matched["nees"], "a filter that believes in a perfect gyro is too sure of itself")
        self.assertEqual(len(matched["outages"][0]["errors"]["north_m"]), 30)
        self.assertEqual(len(matched["trajectory"]["time_s"]), 46)
        self.assertEqual(len(result["trajectory"]["north_m"]), 46)
        # Ten points a second from 10 s before the outage to the end of the drive, 5 s after it, on the path of the whole drive.
        [truth], track = result["tracks"], matched["outages"][0]["track"]
        for drawn, path in ((truth, result["trajectory"]), (track, matched["trajectory"])):
            self.assertEqual((drawn["start_s"], drawn["rate_hz"], len(drawn["north_m"]), len(drawn["east_m"])), (20, 10, 251, 251))
            for second in range(20, 46):
                self.assertAlmostEqual(drawn["north_m"][10 * (second - 20)], path["north_m"][second], delta=0.006)
        ellipse50, ellipse95 = matched["outages"][0]["predicted"]["ellipses"]
        self.assertLess(ellipse50["semi_major_m"], ellipse95["semi_major_m"])
        pair = next(p for p in result["paired"] if p["filter"] == "too quiet")
        mean = quiet["mean_error_m"]["value"] - matched["mean_error_m"]["value"]
        self.assertAlmostEqual(pair["difference_m"]["value"], mean, places=9)
        self.assertIsNone(result["attribution"])
        summary = result["summary"]
        self.assertTrue(summary["verdict"].startswith("matched "), summary)
        self.assertIn("after 10 s without GNSS", summary["verdict"])
        for fact in summary["facts"]:
            at: Any = result
            for key in fact["pointer"].split("/")[1:]:
                at = at[int(key)] if isinstance(at, list) else at[key]
            self.assertEqual(at, fact["value"], "a fact is what its pointer leads to: " + fact["pointer"])

    def test_the_papers_scenario_by_name_is_judged_in_words(self) -> None:
        result = self.evaluated(scenario="paper", runs=2, seed=9)["evaluation"]
        self.assertEqual(len(result["filters"]), 6)
        parts = result["attribution"]
        total = sum(parts[name]["difference_m"]["value"] for name in ("low_frequency_noise", "gauss_markov_states", "switching"))
        self.assertAlmostEqual(total, parts["total"]["difference_m"]["value"], places=9)
        self.assertTrue(all(claim["because"] for claim in result["claims"]))

    def test_the_same_request_is_the_same_evaluation(self) -> None:
        first = self.expect(202, self.daemon.post("/v1/outage-evaluations", {"scenario": SCENARIO, "runs": 4}))
        same = self.expect(200, self.daemon.post("/v1/outage-evaluations", {"runs": 4, "scenario": SCENARIO}))
        self.assertEqual(same.json["id"], first.json["id"])
        as_job = {"kind": "outage_evaluation", "inputs": {"scenario": SCENARIO}, "parameters": {"runs": 4}}
        self.assertEqual(self.expect(200, self.daemon.post("/v1/jobs", as_job)).json["id"], first.json["id"])
        self.daemon.finished(first.json["id"])
        whole = self.expect(200, self.daemon.get(f"/v1/outage-evaluations/{first.json['id']}")).json["evaluation"]
        self.assertEqual(self.expect(200, self.daemon.get(f"/v1/jobs/{first.json['id']}/result")).json, whole)
        listed = self.daemon.items("/v1/outage-evaluations?state=succeeded")
        self.assertIn(first.json["id"], [item["id"] for item in listed])

    def test_a_stored_fit_is_a_truth(self) -> None:
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(4096, seed=3), rate_hz=100, columns=samples.GYRO_Z)).json["id"]
        self.daemon.finished(self.daemon.characterise(recording, models=["WN"]).json["id"])
        [fit] = self.daemon.items(f"/v1/fits?model=WN&recording={recording}")
        scenario = copy.deepcopy(SCENARIO)
        scenario["truth"]["gyro"] = {"fit": fit["id"], "constant_bias_sd_deg_s": 0.05}
        result = self.evaluated(scenario=scenario, runs=2)["evaluation"]
        [process] = result["scenario"]["truth"]["gyro"]["x"]["processes"]
        self.assertAlmostEqual(process["params"]["N"]["value"], fit["processes"][0]["params"]["N"]["value"], places=9)
        scenario["truth"]["gyro"] = {"fit": "fit_nobody"}
        answer = self.expect(404, self.daemon.post("/v1/outage-evaluations", {"scenario": scenario}))
        self.assertEqual([e["pointer"] for e in answer.json["errors"]], ["/scenario/truth/gyro/fit"])

    def test_a_parameter_table_is_a_schedule_by_rate(self) -> None:
        recordings = [self.expect(201, self.daemon.upload(samples.gyro_csv(4096, seed=seed), device="table", condition=condition,
                                                          rate_hz=100, columns=samples.GYRO_Z)).json["id"]
                      for seed, condition in ((31, "static"), (32, "constant_rate:z:20:deg/s"))]
        self.daemon.finished(self.daemon.characterise(*recordings, models=["WN"]).json["id"])
        table = self.expect(200, self.daemon.get("/v1/parameter-tables?device=table&axis=z", Prefer="wait=60")).json
        scenario = copy.deepcopy(SCENARIO)
        flat = {"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}], "constant_bias_sd_deg_s": 0.05}
        for schedule, bands in (("switched", 2), ("continuous", 21)):
            by_table = {"table": {"device": "table", "axis": "z", "schedule": schedule}, "constant_bias_sd_deg_s": 0.05}
            scenario["filters"] = [{"name": schedule, "gyro": {"x": flat, "y": flat, "z": by_table}}]
            result = self.evaluated(scenario=scenario, runs=2)["evaluation"]
            by_rate = result["scenario"]["filters"][0]["gyro"]["z"]["by_rate"]
            self.assertEqual(len(by_rate["processes"]), bands)
            if schedule == "switched":
                self.assertAlmostEqual(by_rate["bounds_deg_s"][0], 10, places=9)
                for row, model in zip(table["rows"], by_rate["processes"]):
                    self.assertAlmostEqual(model[0]["params"]["N"]["value"], row["values"]["white_noise.N"]["value"], places=9)
        for member, value, pointer in (("device", "nobody", "/scenario/filters/0/gyro/table"), ("schedule", "now and then", "/scenario/filters/0/gyro/table/schedule"),
                                       ("colour", 1, "/scenario/filters/0/gyro/table/colour")):
            scenario["filters"] = [{"name": "a", "gyro": {"table": {"device": "table", "axis": "z", member: value}}}]
            answer = self.daemon.post("/v1/outage-evaluations", {"scenario": scenario})
            self.assertIn(answer.status, (400, 404), answer.describe())
            self.assertEqual([e["pointer"] for e in answer.json["errors"]], [pointer], answer.describe())

    def test_a_stored_simulation_model_is_truth_and_filter(self) -> None:
        def level(value: float, unit: str) -> dict[str, Any]:
            return {"value": value, "unit": unit}

        def white(value: float) -> dict[str, Any]:
            return {"process": "white_noise", "params": {"N": level(value, "deg/sqrt(h)")}}
        model = self.expect(201, self.daemon.post("/v1/models", {
            "name": "by channel", "processes": [white(1.5)],
            "channels": {"gx": {"processes": [white(1.5)]}, "gy": {"processes": [white(2.5)]}, "gz": {"processes": [white(3.5)]}},
            "deterministic": {"gz": {"bias": level(0.7, "deg/s"), "drift": level(0.001, "deg/s/s")}},
            "effects": [{"cause": "bias_step", "channels": ["gz"], "params": {"step": level(1, "deg/s"), "t0_s": level(60, "s")}},
                        {"cause": "scale_factor_error", "channels": ["gw"], "params": {"S": level(250, "ppm")}}]})).json["id"]
        scenario = copy.deepcopy(SCENARIO)
        scenario["truth"]["gyro"] = {"simulation_model": model, "constant_bias_sd_deg_s": 0.05}
        flat = {"processes": [white(1)], "constant_bias_sd_deg_s": 0.05}
        scenario["filters"] = [{"name": "matched"},
                               {"name": "one channel", "gyro": {"x": flat, "y": flat, "z": {"simulation_model": model, "channel": "gz"}}}]
        result = self.evaluated(scenario=scenario, runs=2)["evaluation"]
        truth = result["scenario"]["truth"]
        for axis, expected in (("x", 1.5), ("y", 2.5), ("z", 3.5)):
            processes = truth["gyro"][axis]["processes"]
            self.assertAlmostEqual(processes[0]["params"]["N"]["value"], expected, places=9)
            self.assertEqual([p["process"] for p in processes], ["white_noise"] + (["linear_drift"] if axis == "z" else []))
            self.assertAlmostEqual(truth["gyro"][axis]["constant_bias_sd_deg_s"], 0.05, places=9)
        for found, expected in zip(truth["gyro_errors"]["bias"], (0, 0, 0.7)):
            self.assertAlmostEqual(found, expected, places=9)
        believed = result["scenario"]["filters"][1]["gyro"]
        self.assertAlmostEqual(believed["z"]["processes"][0]["params"]["N"]["value"], 3.5, places=9)
        self.assertAlmostEqual(believed["x"]["processes"][0]["params"]["N"]["value"], 1, places=9)
        self.assertEqual(result["left_out"], [
            {"where": "/truth/gyro", "simulation_model": model, "what": ["bias_step"]},
            {"where": "/filters/1/gyro/z", "simulation_model": model, "what": ["bias_step", "bias"]}])

        for sensor, status, pointer in (({"simulation_model": "mod_nobody"}, 404, "/scenario/truth/gyro/simulation_model"),
                                        ({"simulation_model": model, "channel": "gq"}, 404, "/scenario/truth/gyro/channel"),
                                        ({"simulation_model": model, "colour": 1}, 400, "/scenario/truth/gyro/colour")):
            answer = self.expect(status, self.daemon.post("/v1/outage-evaluations", {
                "scenario": {**scenario, "truth": {**scenario["truth"], "gyro": sensor}}}))
            self.assertEqual([e["pointer"] for e in answer.json["errors"]], [pointer], answer.describe())
        force = {"process": "white_noise", "params": {"N": level(80, "ug/sqrt(Hz)")}}
        accelerometer = self.expect(201, self.daemon.post("/v1/models", {"name": "force", "processes": [force]})).json["id"]
        answer = self.expect(400, self.daemon.post("/v1/outage-evaluations", {
            "scenario": {**scenario, "truth": {**scenario["truth"], "gyro": {"simulation_model": accelerometer}}}}))
        self.assertEqual({(e["pointer"], e["code"]) for e in answer.json["errors"]}, {("/scenario/truth/gyro", "unit_mismatch")}, answer.describe())
        answer = self.expect(400, self.daemon.post("/v1/models", {"name": "mixed", "processes": [force],
                                                                 "deterministic": {"fx": {"bias": level(0.7, "deg/s")}}}))
        self.assertEqual([e["pointer"] for e in answer.json["errors"]], ["/deterministic/fx/bias/unit"], answer.describe())
        twice = {**scenario["truth"], "gyro_errors": {"bias": 1}}
        answer = self.expect(400, self.daemon.post("/v1/outage-evaluations", {"scenario": {**scenario, "truth": twice}}))
        self.assertEqual([e["pointer"] for e in answer.json["errors"]], ["/scenario/truth/gyro_errors/bias"])

    def test_a_truth_that_is_no_object_is_named_beside_a_stored_model(self) -> None:
        # It was answered with 500: the bias of the stored model was written into it.
        level = {"value": 1, "unit": "deg/sqrt(h)"}
        model = self.expect(201, self.daemon.post("/v1/models", {
            "name": "biased", "processes": [{"process": "white_noise", "params": {"N": level}}],
            "deterministic": {"gz": {"bias": {"value": 0.7, "unit": "deg/s"}}}})).json["id"]
        stored = {**SCENARIO["truth"], "gyro": {"simulation_model": model, "constant_bias_sd_deg_s": 0.05}}
        for truth in ([{"gyro": stored["gyro"]}], "paper", 5, None):
            nested = {**SCENARIO, "truth": truth, "filters": [{"name": "a", "truth": stored}]}
            answer = self.expect(400, self.daemon.post("/v1/outage-evaluations", {"scenario": nested}))
            self.assertIn("/scenario/truth", [e["pointer"] for e in answer.json["errors"]], answer.describe())
        answer = self.expect(400, self.daemon.post("/v1/outage-evaluations", {"scenario": [{"truth": stored}]}))
        self.assertIn("/scenario", [e["pointer"] for e in answer.json["errors"]], answer.describe())

    def test_a_running_evaluation_is_cancelled(self) -> None:
        job = self.expect(202, self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000})).json["id"]
        for event in events(self.daemon, job):
            if event.type == "progress" and event.data["progress"] > 0:
                self.assertTrue(event.data["stage"].startswith("outages"), event.data)
                break
        self.assertEqual(self.expect(200, self.daemon.get(f"/v1/jobs/{job}")).json["state"], "running")
        self.expect(202, self.daemon.post(f"/v1/jobs/{job}/cancel"))
        self.assertEqual(self.daemon.finished(job)["state"], "cancelled")
        self.assertIsNone(self.expect(200, self.daemon.get(f"/v1/outage-evaluations/{job}")).json["evaluation"])

    def test_a_running_evaluation_tells_what_it_knows(self) -> None:
        """The intervals so far, in the events of the job and in the resource; none before the first batch of runs, none in the end."""
        job = self.expect(202, self.daemon.post("/v1/outage-evaluations", {"scenario": SCENARIO, "runs": 8000})).json["id"]
        partial = next(event.data["partial"] for event in events(self.daemon, job) if "partial" in event.data)
        self.assertEqual([each["name"] for each in partial["filters"]], ["matched", "too quiet"])
        self.assertTrue(0 < partial["runs"] < 8000, partial)
        for each in partial["filters"]:
            low, high = each["error_m"]["ci95"]
            self.assertTrue(low < each["error_m"]["value"] < high and each["error_m"]["unit"] == "m", each)
        found = self.expect(200, self.daemon.get(f"/v1/outage-evaluations/{job}")).json
        self.assertEqual((found["state"], [each["name"] for each in found["partial"]["filters"]]), ("running", ["matched", "too quiet"]))
        self.expect(202, self.daemon.post(f"/v1/jobs/{job}/cancel"))
        self.daemon.finished(job)
        self.assertNotIn("partial", self.expect(200, self.daemon.get(f"/v1/outage-evaluations/{job}")).json)

    def test_faults_are_named_by_their_place(self) -> None:
        def changed(**members: Any) -> dict[str, Any]:
            return {**copy.deepcopy(SCENARIO), **members}
        bad_unit = copy.deepcopy(SCENARIO)
        bad_unit["truth"]["gyro"]["processes"][0]["params"]["N"]["unit"] = "deg/h"
        cases: list[tuple[Any, set[str]]] = [
            ({}, {"/scenario"}),
            ({"scenario": "nowhere"}, {"/scenario"}),
            ({"scenario": SCENARIO, "runs": 1}, {"/runs"}),
            ({"scenario": SCENARIO, "seed": -1}, {"/seed"}),
            ({"scenario": SCENARIO, "relative_precision": 2}, {"/relative_precision"}),
            ({"scenario": SCENARIO, "colour": 1}, {"/colour"}),
            ({"scenario": changed(colour=1)}, {"/scenario/colour"}),
            ({"scenario": changed(outages=[])}, {"/scenario/outages"}),
            ({"scenario": changed(filters=[{"name": "a"}, {"name": "a"}])}, {"/scenario/filters"}),
            ({"scenario": changed(gnss_velocity="unused")}, {"/scenario/gnss_velocity"}),
            ({"scenario": changed(gnss={"white": False})}, {"/scenario/gnss/white"}),
            ({"scenario": changed(filters=[{"name": "a", "covariance_samples": 101}])}, {"/scenario/filters/0"}),
            ({"scenario": changed(trajectory={"segments_by_start_time": [{"t_s": 30, "kind": "turn", "rate_deg_s": 9}]})},
             {"/scenario/trajectory/segments_by_start_time/0"}),
            ({"scenario": changed(trajectory={"segments_by_start_time": [{"t_s": 1, "kind": "accelerate", "m_s2": 1, "until_speed_m_s": 20},
                                                                         {"t_s": 3, "kind": "stop", "m_s2": 10}]})},
             {"/scenario/trajectory/segments_by_start_time/1"}),
            ({"scenario": bad_unit}, {"/scenario/truth/gyro/processes/0/params/N/unit"}),
        ]
        for body, pointers in cases:
            with self.subTest(pointers=pointers):
                answer = self.daemon.post("/v1/outage-evaluations", body)
                self.assertIn(answer.status, (400, 404), answer.describe())
                self.assertEqual({error["pointer"] for error in answer.json["errors"]}, pointers, answer.describe())
        self.problem(404, "not_found", self.daemon.get("/v1/outage-evaluations/job_nobody"))
        self.problem(400, "invalid_argument", self.daemon.get("/v1/outage-evaluations?state=asleep"), parameter="state")
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(64, seed=77), rate_hz=100)).json["id"]
        other = self.daemon.characterise(recording, models=["WN"]).json["id"]
        self.problem(404, "not_found", self.daemon.get(f"/v1/outage-evaluations/{other}"))


if __name__ == "__main__":
    unittest.main()
