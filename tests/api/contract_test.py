"""The daemon against its contract: schemas and examples are sound, and every operation gives what it lists."""
from __future__ import annotations

import struct
import tempfile
import time
import unittest
from typing import Any

import jsonschema

import samples
from daemon import Answer
from suite import DaemonTest


def walk(node: Any, path: str = "#") -> Any:
    yield path, node
    children = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in children:
        yield from walk(value, f"{path}/{key}")


class Documents(DaemonTest):
    def test_every_schema_is_one_and_every_reference_leads_somewhere(self) -> None:
        for name, schema in self.contract.whole["$defs"].items():
            with self.subTest(name=name):
                jsonschema.Draft202012Validator.check_schema(schema)
        for path, node in walk(self.contract.whole):
            if isinstance(node, dict) and isinstance(node.get("$ref"), str):
                with self.subTest(path=path):
                    self.assertIsInstance(self.contract.resolved(node), dict)

    def test_every_example_matches_its_schema(self) -> None:
        checked = 0
        for name, schema in self.contract.whole["$defs"].items():
            for example in schema.get("examples", []):
                self.contract.match(example, {"$ref": f"#/$defs/{name}"})
                checked += 1
        for path, node in walk({key: self.contract.whole[key] for key in ("paths", "components")}):
            if isinstance(node, dict) and "schema" in node and "example" in node:
                with self.subTest(path=path):
                    self.contract.match(node["example"], node["schema"])
                checked += 1
        self.assertGreater(checked, 25)

    def test_every_operation_is_described(self) -> None:
        ids = []
        for path, operations in self.contract.paths.items():
            for method, operation in operations.items():
                with self.subTest(operation=f"{method} {path}"):
                    ids.append(operation["operationId"])
                    self.assertTrue(operation["summary"])
                    self.assertIn(operation["x-scope"], ("public", "read", "write", "run", "admin"))
                    refusals = {"401", "403"} if operation["x-scope"] != "public" else set()
                    self.assertLessEqual(refusals, set(operation["responses"]))
                    bound = [self.contract.resolved(p) for p in operation.get("parameters", [])]
                    self.assertTrue(all(parameter["description"] for parameter in bound))
                    in_path = {parameter["name"] for parameter in bound if parameter["in"] == "path"}
                    self.assertEqual(in_path, {part[1:-1] for part in path.split("/") if part.startswith("{")})
        self.assertEqual(len(ids), len(set(ids)))

    def test_examples_of_requests_are_taken(self) -> None:
        """What the contract shows as a body works as it stands, once the ids in it exist."""
        def example(path: str, method: str) -> Any:
            content = self.contract.paths[path][method]["requestBody"]["content"]
            return next(iter(content.values()))["example"]
        device = self.expect(201, self.daemon.post("/v1/devices", example("/v1/devices", "post")))
        self.expect(200, self.daemon.request("PATCH", device.headers["location"], example("/v1/devices/{id}", "patch"), {"If-Match": "*"}))
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=1), rate_hz=100, columns=samples.GYRO_Z))
        change = self.daemon.request("PATCH", recording.headers["location"], example("/v1/recordings/{id}", "patch"), {"If-Match": "*"})
        self.assertEqual(self.expect(200, change).json["metadata"]["condition"]["kind"], "constant_rate")
        job = example("/v1/jobs", "post")
        job["inputs"]["recordings"] = [recording.json["id"]]
        queued = self.expect(202, self.daemon.post("/v1/jobs", job))
        self.assertEqual(self.daemon.finished(queued.json["id"])["state"], "succeeded")


class Requests(DaemonTest):
    """What the schemas refuse, the daemon refuses; what they take, it takes."""

    def agree(self, schema: dict[str, Any], body: Any, answer: Answer) -> None:
        try:
            self.contract.match(body, schema, strict=False)
            taken = True
        except AssertionError:
            taken = False
        refused = answer.status == 400
        self.assertEqual(taken, not refused, f"schema {'takes' if taken else 'refuses'} {body}: {answer.describe()}")

    def test_metadata(self) -> None:
        good = {"device": "phone-07", "rate_hz": 100, "condition": {"kind": "static"},
                "columns": {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}}
        bad_conditions = [{}, {"kind": "asleep"}, {"kind": "static", "axis": "z"}, {"kind": "constant_rate"}, {"kind": "constant_rate", "axis": "z", "value": "9", "unit": "deg/s"},
                          {"kind": "constant_rate", "axis": "w", "value": 9, "unit": "deg/s"}, {"kind": "six_position", "axis": "x"},
                          {"kind": "six_position", "axis": "x", "direction": "sideways"}, {"kind": "profile", "value": 1}, "static", None, {"kind": "static", "x": 1}]
        good_conditions = [{"kind": "constant_rate", "axis": "z", "value": 9, "unit": "deg/s"}, {"kind": "drive"},
                           {"kind": "constant_angular_acceleration", "axis": "z", "value": 0.001, "unit": "rad/s^2"}]
        documents = [good, {**good, "rate_hz": 0}, {**good, "rate_hz": "100"}, {**good, "device": {"id": "a", "model": "b"}}, {**good, "device": {"model": "b"}},
                     {**good, "device": ""}, {**good, "device": {"id": "a", "colour": "b"}}, {**good, "trim": {"start_s": 1}}, {**good, "trim": {"start_s": -1}}, {**good, "trim": {"begin": 1}},
                     {**good, "columns": {"gz": {"axis": "z"}}}, {**good, "columns": {"gz": {"quantity": "spin"}}}, {**good, "columns": []}, {**good, "colums": {}},
                     {**good, "labels": {"firmware": "1.5.0"}, "session": "Monday", "recorded_at": "2026-11-22T10:00:00Z"}, {**good, "labels": []}, {**good, "labels": {"a=b": "c"}},
                     {**good, "labels": {"a": "b,c"}}, {**good, "labels": {"a": 1}}, {**good, "labels": {"": "c"}}, {**good, "labels": {"a": ""}}, {**good, "session": 3},
                     {**good, "columns": {"gz": {"quantity": "angular_rate", "axis": "z"}}}, {**good, "id": "x", "file": "y"}, {**good, "id": 7},
                     {k: v for k, v in good.items() if k != "condition"}, [], "x", 7,
                     *({**good, "condition": condition} for condition in bad_conditions + good_conditions)]
        import json
        for number, document in enumerate(documents):
            answer = self.daemon.upload_parts(("metadata", json.dumps(document).encode()), ("file", samples.gyro_csv(64, seed=number)))
            self.agree({"$ref": "#/$defs/recording.schema.json/$defs/upload_metadata"}, document, answer)

    def test_devices(self) -> None:
        schema = {"$ref": "#/components/schemas/NewDevice"}
        for body in ({"name": "a"}, {"name": ""}, {}, {"name": "dev_x"}, {"name": "a\0"}, {"name": "a\n"}, {"name": "\u0085"}, {"name": "\u00e9 \u4e16"}, {"name": "n" * 201}, {"name": "b", "labels": {"x": "y"}}, {"name": "c", "labels": {"x": 1}},
                     {"name": "d", "labels": []}, {"name": "e", "model": None}, {"name": "f", "modell": "g"}, {"name": "h", "imu": "i", "serial": "j"}, []):
            self.agree(schema, body, self.daemon.post("/v1/devices", body))

    def test_jobs(self) -> None:
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(64, seed=99), rate_hz=100)).json["id"]
        study = self.daemon.post("/v1/studies", {"device": {"id": "phone-07"}, "recordings": [{"recording": recording}]}).json["id"]
        files = zip(samples.drive_csvs(seed=2), (samples.DRIVE_IMU, samples.DRIVE_GNSS))
        ids = [self.daemon.upload(content, condition="drive", columns=samples.roles(roles)).json["id"] for content, roles in files]
        drive = self.expect(201, self.daemon.post("/v1/drives", samples.drive_document(*ids))).json["id"]
        good = {"kind": "characterise", "inputs": {"recordings": [recording]}, "parameters": {"models": ["WN"]}}
        for body in (good, {**good, "priority": 0}, {**good, "priority": 9}, {**good, "priority": -1}, {**good, "priority": 10}, {**good, "priority": 1.5}, {**good, "kind": "x"},
                     {**good, "inputs": {}}, {**good, "inputs": []}, {**good, "inputs": {"recordings": [recording] * 101}}, {**good, "parameters": {"seed": 0}},
                     {**good, "parameters": {"seed": -1}}, {**good, "parameters": {"seed": 0.5}}, {**good, "parameters": []}, {**good, "parameters": {"model": []}},
                     {**good, "colour": 1}, {"kind": "characterise"}, {"kind": "investigate", "inputs": {}}, {"kind": "investigate", "inputs": {"recordings": [recording]}},
                     {"kind": "investigate", "inputs": {"study": study}}, {"kind": "investigate", "inputs": {"study": study}, "parameters": {"models": []}},
                     {"kind": "investigate", "inputs": {"study": study}, "parameters": {"baseline": {"kind": "auto"}}},
                     {"kind": "drive_evaluation", "inputs": {}}, {"kind": "drive_evaluation", "inputs": {"drive": drive}},
                     *({"kind": "drive_evaluation", "inputs": {"drive": drive}, "parameters": parameters} for parameters in (
                         {"question": "simulate", "runs": 2}, {"question": "guess"}, {"seed": -1}, {"gate": -1}, {"colour": 1},
                         {"zero_velocity": 1}, {"question": "explain", "runs": 0}))):
            self.agree({"$ref": "#/$defs/job-request.schema.json"}, body, self.daemon.post("/v1/jobs", body))


class Operations(DaemonTest):
    @classmethod
    def setUpClass(cls) -> None:
        cls.arguments = ("--backups", cls.enterClassContext(tempfile.TemporaryDirectory()))
        super().setUpClass()

    def test_every_operation_gives_every_success_it_lists(self) -> None:
        daemon = self.daemon
        device = daemon.post("/v1/devices", {"name": "phone-07"})
        daemon.post("/v1/devices", {"name": "phone-07"})
        daemon.request("PATCH", device.headers["location"], {"serial": "1", "model": "one-line"}, {"If-Match": "*"})
        first, second = (daemon.upload(samples.gyro_csv(seed=seed), rate_hz=100, columns=samples.GYRO_Z) for seed in (1, 2))
        daemon.upload(samples.gyro_csv(seed=1), rate_hz=100, columns=samples.GYRO_Z)
        daemon.request("PATCH", second.headers["location"], {"condition": {"kind": "drive"}}, {"If-Match": "*"})
        job = daemon.characterise(first.json["id"])
        daemon.characterise(first.json["id"])
        daemon.finished(job.json["id"])
        daemon.post(f"/v1/jobs/{daemon.characterise(second.json['id']).json['id']}/cancel")
        fit = next(fit for fit in daemon.items("/v1/fits") if fit["model"] == "WN")  # no parameter of it is open
        daemon.finished(daemon.items("/v1/jobs")[-1]["id"])
        daemon.request("DELETE", second.headers["location"], headers={"If-Match": "*"})
        for media in ("application/json", "text/csv", "text/plain", "text/markdown", "text/x-latex"):
            for axis in ("z", "all"):
                self.expect(200, daemon.get(f"/v1/parameter-tables?device=phone-07&axis={axis}&reference=static", Accept=media))
        body = {"device": {"id": "phone-07"}, "recordings": [{"recording": first.json["id"]}]}
        study, _ = (daemon.post("/v1/studies", body) for _ in range(2))
        evaluation, _ = (daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 2}) for _ in range(2))
        daemon.finished(evaluation.json["id"])
        files = zip(samples.drive_csvs(), (samples.DRIVE_IMU, samples.DRIVE_GNSS))
        imu, gnss = (daemon.upload(content, condition="drive", columns=samples.roles(roles)).json["id"] for content, roles in files)
        drive, _ = (daemon.post("/v1/drives", samples.drive_document(imu, gnss)) for _ in range(2))
        driven, _ = (daemon.post("/v1/drive-evaluations", {"drive": drive.json["id"]}) for _ in range(2))
        daemon.finished(driven.json["id"])
        body = {"device": {"id": "phone-07"}, "calibration": {"gyroscope": {"apply": samples.CORRECTION}}}
        calibration, _ = (daemon.post("/v1/calibrations", body) for _ in range(2))
        asked = daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study.json["id"]}})
        daemon.finished(asked.json["id"])
        investigation = daemon.items("/v1/investigations")[0]["id"]
        daemon.get(f"/v1/investigations/{investigation}", Accept="text/markdown")
        third = daemon.upload(samples.gyro_csv(seed=3), rate_hz=100, columns=samples.GYRO_Z)
        daemon.finished(daemon.characterise(third.json["id"]).json["id"])
        arms = {name: {"recordings": [{"recording": made.json["id"]}]} for name, made in (("baseline", first), ("candidate", third))}
        regression = daemon.post("/v1/jobs", {"kind": "regress", "inputs": {"device": "phone-07", **arms}})
        daemon.finished(regression.json["id"])
        for media in ("text/plain", "text/markdown"):
            daemon.get(f"/v1/regressions/{regression.json['id']}", Accept=media)
        self.expect(200, daemon.request("PATCH", first.headers["location"], {"labels": {"firmware": "1.0"}}, {"If-Match": "*"}))
        daemon.post("/v1/regression-anchors", {"device": "phone-07", "label": "firmware=1.0", "reason": "the first"})
        body = {"name": "white", "processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}]}
        model, _ = (daemon.post("/v1/models", body) for _ in range(2))
        hook = daemon.post("/v1/webhooks", {"url": "https://ci.example.org/"}).headers["location"]
        daemon.request("PATCH", hook, {"description": "a"}, {"If-Match": "*"})
        daemon.post(hook + "/rotate")
        daemon.post(hook + "/test")
        self.expect(204, daemon.request("DELETE", daemon.post("/v1/webhooks", {"url": "https://ci.example.org/"}).headers["location"], headers={"If-Match": "*"}))
        # With the first token authentication is on: all further requests bring it.
        made = daemon.post("/v1/tokens", {"name": "first", "scope": "admin"})
        daemon.token = made.json["secret"]
        self.addCleanup(setattr, daemon, "token", None)
        other = daemon.post("/v1/tokens", {"name": "other", "scope": "read"}).json["id"]
        signed_in = self.expect(201, daemon.post("/v1/session", {"token": daemon.token}))
        cookie = signed_in.headers["set-cookie"].partition(";")[0]
        self.expect(204, daemon.request("DELETE", "/v1/session", headers={"Cookie": cookie, "Sec-Fetch-Site": "same-origin"}))
        daemon.post(f"/v1/tokens/{other}/rotate")
        daemon.post(f"/v1/tokens/{other}/revoke")
        values = {"/v1/tokens/{id}": other, "/v1/devices/{id}": device.json["id"], "/v1/recordings/{id}": first.json["id"], "/v1/fits/{id}": fit["id"], "/docs/{page}": "units",
                  "/v1/studies/{id}": study.json["id"], "/v1/calibrations/{id}": calibration.json["id"],
                  "/v1/outage-evaluations/{id}": evaluation.json["id"],
                  "/v1/drives/{id}": drive.json["id"], "/v1/drive-evaluations/{id}": driven.json["id"],
                  "/v1/investigations/{id}": investigation, "/v1/models/{id}": model.json["id"],
                  **{f"/v1/regressions/{{id}}{part}": regression.json["id"] for part in ("", "/junit", "/figure", "/badge")}, "/v1/exports/{target}": "kalibr",
                  "/problems/{slug}": "busy", "/schemas/{name}": "job.schema.json", "/v1/samples/{preset}": "iphone5s-z",
                  "/v1/devices/{id}/summary": device.json["id"], "/v1/recordings/{id}/characterisation": first.json["id"],
                  **{f"/v1/recordings/{{id}}/{look}": first.json["id"] for look in ("content", "trace", "spectrum", "histogram", "spectrogram")},
                  "/v1/fits/{id}/implied": fit["id"], "/v1/models/{id}/implied": model.json["id"]}
        tus = {"Tus-Resumable": "1.0.0"}
        content = samples.gyro_csv(seed=4)
        offered = [daemon.request("POST", "/v1/uploads", headers={**tus, "Upload-Length": str(len(content))}).headers["location"] for _ in range(4)]
        for upload in offered[:2]:
            daemon.request("PATCH", upload, content, {**tus, "Content-Type": "application/offset+octet-stream", "Upload-Offset": "0"})
            daemon.request("POST", upload + "/recording?device=phone-07&condition=static&rate_hz=100")
        daemon.request("DELETE", offered[2], headers=tus)
        self.expect(200, daemon.request("POST", "/v1/recordings/preview", content, {"Content-Type": "application/octet-stream"}))
        about = {"device": "phone-07", "condition": {"kind": "static"}, "columns": {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}}
        lives = [daemon.post("/v1/live-recordings", about) for _ in range(2)]
        token = {"Live-Token": lives[0].json["token"], "Content-Type": "application/octet-stream"}
        rows = b"".join(struct.pack("<df", i / 100, i % 7) for i in range(200))
        daemon.request("POST", lives[0].headers["location"] + "/samples?sequence=0", rows, token)
        daemon.request("POST", lives[0].headers["location"] + "/finish", headers=token)
        values["/v1/webhooks/{id}"] = values["/v1/webhooks/{id}/deliveries"] = hook.rpartition("/")[2]
        values["/v1/uploads/{id}"] = offered[3].rpartition("/")[2]
        values["/v1/live-recordings/{id}"] = values["/v1/live-recordings/{id}/events"] = lives[1].json["id"]
        self.expect(206, daemon.get(f"/v1/recordings/{first.json['id']}/content", Range="bytes=0-9"))
        while running := [one["id"] for one in daemon.items("/v1/jobs") if one["finished_at"] is None]:  # or answers change between two reads
            for one in running:
                daemon.finished(one)
        self.expect(202, daemon.post("/v1/backups"))
        while any(each["state"] == "running" for each in daemon.items("/v1/backups")):
            time.sleep(0.05)
        for path, operations in self.contract.paths.items():
            if "get" in operations:
                target = path.replace(path[path.find("{"):path.find("}") + 1], values.get(path, job.json["id"])) if "{" in path else path
                target += "?device=phone-07&axis=z" if path in ("/v1/parameter-tables", "/v1/trends") else ""
                target += "?q=phone" if path == "/v1/search" else ""
                target += f"?of={first.json['id']}:gz,{first.json['id']}:gz" if path == "/v1/structures" else ""
                target += "?model=one-line" if path == "/v1/populations" else ""
                target += "?device=phone-07" if path == "/v1/exports/{target}" else ""
                target += f"?recording={first.json['id']}&channel=gz" if path == "/v1/models/{id}/implied" else ""
                target += "?channel=gz" if path.endswith(("/trace", "/spectrum", "/histogram", "/spectrogram")) else ""
                if path in ("/v1/events", "/v1/live-recordings/{id}/events"):  # they do not end by themselves
                    self.expect(200, daemon.request("HEAD", target))
                    continue
                answer = self.expect(200, daemon.get(target))
                if "etag" in answer.headers:
                    self.expect(304, daemon.get(target, If_None_Match=answer.headers["etag"]))
        for target in (f"/v1/investigations/{investigation}", study.headers["location"], calibration.headers["location"], model.headers["location"],
                       drive.headers["location"]):
            self.expect(204, daemon.request("DELETE", target))
        spare = daemon.post("/v1/devices", {"name": "spare"}).headers["location"]
        self.expect(204, daemon.request("DELETE", spare, headers={"If-Match": "*"}))
        listed = {(operation["operationId"], int(status)) for operations in self.contract.paths.values() for operation in operations.values()
                  for status in operation["responses"] if int(status) < 400}
        self.assertEqual(listed - self.contract.seen, set())


if __name__ == "__main__":
    unittest.main()
