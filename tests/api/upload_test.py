"""Every way a recording goes in, and what the same bytes get the second time."""
from __future__ import annotations

import base64
import hashlib
import http.client
import json
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path
from typing import Any

import samples
from daemon import PATIENCE_S, Answer, multipart, parse_answer, read_answer
from suite import DaemonTest

METADATA = {"device": "phone-07", "rate_hz": 100,
            "columns": {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}, "condition": {"kind": "static"}}


def as_json(document: object) -> bytes:
    return json.dumps(document).encode()


class Containers(DaemonTest):
    """csv and npy, each plain and compressed three ways, give the same recording content."""

    def content(self, device: str) -> dict[str, object]:
        [recording] = self.daemon.items(f"/v1/recordings?device={device}")
        job = self.daemon.finished(self.expect(202, self.daemon.characterise(recording["id"], models=["WN"])).json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        [found] = self.daemon.get(job["result"]["href"]).json["recordings"]
        return {channel["quantity"] + channel["axis"]: {k: channel[k] for k in ("samples", "mean", "allan", "haar", "fits")}
                for channel in found["channels"]}

    def test_every_container_gives_the_same_numbers(self) -> None:
        columns = samples.noise(600, 2, seed=3)
        roles = {"csv": "gx=angular_rate:x:deg/s,fz=specific_force:z:m/s^2", "npy": "0=angular_rate:x:deg/s,1=specific_force:z:m/s^2"}
        contents = {"csv": samples.csv(columns, ["gx", "fz"]), "npy": samples.npy(columns)}
        results = {}
        for form, content in contents.items():
            for compression, compress in samples.COMPRESSIONS.items():
                device = f"{form}-{compression}"
                packed = compress(content)
                answer = self.expect(201, self.daemon.upload(packed, device=device, rate_hz=50, columns=roles[form]))
                file = answer.json["file"]
                self.assertEqual((file["format"], file["compression"], file["rows"], file["bytes"]), (form, compression, 600, len(packed)))
                self.assertEqual(file["sha256"], hashlib.sha256(packed).hexdigest())
                self.assertEqual((self.daemon.data / "blobs" / file["sha256"][:2] / file["sha256"]).read_bytes(), packed)
                results[device] = self.content(device)
        first = results["csv-none"]
        self.assertEqual(set(first), {"angular_ratex", "specific_forcez"})
        self.assertEqual(first["angular_ratex"]["samples"], 600)
        self.assertAlmostEqual(first["angular_ratex"]["mean"], sum(columns[0]) / 600, delta=1e-12)
        for device, result in results.items():
            self.assertEqual(result, first, device)

    def test_npy_of_one_dimension_and_of_single_precision(self) -> None:
        column = [float(round(value * 64)) / 64 for value in samples.noise(300)[0]]  # exact in float32
        for name, content in (("flat", samples.npy([column], flat=True)), ("single", samples.npy([column], kind="<f4"))):
            answer = self.daemon.upload(content, device=name, rate_hz=50, columns="0=angular_rate:x:deg/s")
            self.expect(201, answer)
        self.assertEqual(self.content("flat"), self.content("single"))


class Metadata(DaemonTest):
    def test_query_and_parts_mean_the_same(self) -> None:
        content = samples.gyro_csv(seed=11)
        by_query = self.expect(201, self.daemon.upload(content, rate_hz=100, columns=samples.GYRO_Z))
        for parts in ([("metadata", as_json(METADATA)), ("file", content)], [("file", content), ("metadata", as_json(METADATA))]):
            again = self.expect(200, self.daemon.upload_parts(*parts))
            self.assertEqual(again.json, by_query.json)
            self.assertEqual(again.headers["location"], by_query.headers["location"])

    def test_condition_in_one_word_or_in_parts(self) -> None:
        content = samples.gyro_csv(seed=12)
        rate = dict(rate_hz=100, columns=samples.GYRO_Z)
        first = self.expect(201, self.daemon.upload(content, condition="constant_rate:z:9:deg/s", **rate))
        self.expect(200, self.daemon.upload(content, condition="constant_rate", axis="z", value=9, unit="deg/s", **rate))
        self.assertEqual(first.json["metadata"]["condition"], {"kind": "constant_rate", "axis": "z", "value": 9.0, "unit": "deg/s"})
        up = self.expect(201, self.daemon.upload(samples.csv(samples.noise(64, seed=13), ["fx"]), condition="six_position", axis="x",
                                                 direction="up", rate_hz=100, columns="fx=specific_force:x:g"))
        self.assertEqual(up.json["metadata"]["condition"], {"kind": "six_position", "axis": "x", "direction": "up"})

    def test_device_may_be_an_object_or_stand_in_the_query(self) -> None:
        device = {"id": "phone-08", "model": "Galaxy S4", "imu": "MPU-6500", "serial": "RF8D"}
        self.expect(201, self.daemon.upload_parts(("metadata", as_json({**METADATA, "device": device})), ("file", samples.gyro_csv(seed=14))))
        stored = self.daemon.get("/v1/devices/phone-08").json
        self.assertEqual((stored["model"], stored["imu"], stored["serial"]), ("Galaxy S4", "MPU-6500", "RF8D"))
        nameless = {k: v for k, v in METADATA.items() if k != "device"}
        self.expect(201, self.daemon.upload_parts(("metadata", as_json(nameless)), ("file", samples.gyro_csv(seed=15)),
                                                  target="/v1/recordings?device=phone-09"))
        self.assertEqual(len(self.daemon.items("/v1/recordings?device=phone-09")), 1)

    def test_device_may_be_named_by_its_id(self) -> None:
        device = self.expect(201, self.daemon.post("/v1/devices", {"name": "known by its id"})).json["id"]
        rate = dict(rate_hz=100, columns=samples.GYRO_Z)
        first = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=21), device=device, **rate)).json
        metadata = as_json({**METADATA, "device": {"id": device}})
        second = self.expect(201, self.daemon.upload_parts(("metadata", metadata), ("file", samples.gyro_csv(seed=22)))).json
        self.assertEqual((first["device"], second["device"]), (device, device))
        self.assertFalse([d for d in self.daemon.items("/v1/devices") if d["name"].startswith("dev_")])

    def test_trims_and_own_name_are_kept(self) -> None:
        answer = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=16), rate_hz=100, columns=samples.GYRO_Z, id="run-1",
                                                     trim_start_s=1, trim_end_s=0.5))
        self.assertEqual(answer.json["metadata"]["id"], "run-1")
        self.assertEqual(answer.json["metadata"]["trim"], {"start_s": 1.0, "end_s": 0.5})
        self.assertEqual(answer.json["quality"]["samples"] - answer.json["quality"]["analysed"], 150)

    def test_multipart_boundaries_may_fall_anywhere(self) -> None:
        """The body arrives in pieces that cut every boundary once; the file holds what looks like one."""
        content = samples.csv(samples.noise(40, seed=17), ["gz"])
        body, content_type = multipart(("metadata", as_json(METADATA)), ("file", content), boundary="--b")
        head = (f"POST /v1/recordings HTTP/1.1\r\nHost: localhost\r\nContent-Type: {content_type}\r\nContent-Length: {len(body)}\r\n\r\n").encode()
        with self.daemon.connect() as connection:
            connection.sendall(head)
            for start in range(0, len(body), 7):
                connection.sendall(body[start:start + 7])
            answer = read_answer(connection)
        self.expect(201, answer)
        self.assertEqual(answer.json["file"]["sha256"], hashlib.sha256(content).hexdigest())


class SameBytes(DaemonTest):
    def test_same_bytes_are_the_same_recording_without_a_second_copy(self) -> None:
        content = samples.gyro_csv(seed=21)
        first = self.expect(201, self.daemon.upload(content, device="a", rate_hz=100, columns=samples.GYRO_Z))
        before = self.daemon.traces()
        again = self.expect(200, self.daemon.upload(content, device="a", rate_hz=100, columns=samples.GYRO_Z))
        self.assertEqual(again.json, first.json)
        self.assertEqual(self.daemon.traces(), before)
        other = self.expect(201, self.daemon.upload(content, device="b", rate_hz=100, columns=samples.GYRO_Z))
        self.assertNotEqual(other.json["id"], first.json["id"])
        self.assertEqual(self.daemon.files("blobs"), before["blobs"])

    def test_other_metadata_for_the_same_bytes_are_a_conflict_that_names_patch(self) -> None:
        content = samples.gyro_csv(seed=22)
        first = self.expect(201, self.daemon.upload(content, rate_hz=100, columns=samples.GYRO_Z))
        before = self.daemon.traces()
        problem = self.problem(409, "conflict", self.daemon.upload(content, rate_hz=200, columns=samples.GYRO_Z),
                               recording_id=first.json["id"])
        self.assertIn(f"PATCH /v1/recordings/{first.json['id']}", str(problem["detail"]))
        self.assertEqual(self.daemon.traces(), before)

    def test_digest_stated_is_checked(self) -> None:
        content = samples.gyro_csv(seed=23)
        right = base64.b64encode(hashlib.sha256(content).digest()).decode()
        wrong = base64.b64encode(hashlib.sha256(b"other").digest()).decode()
        query = dict(rate_hz=100, columns=samples.GYRO_Z)
        before = self.daemon.traces()
        self.problem(400, "digest_mismatch", self.daemon.upload(content, {"Repr-Digest": f"sha-256=:{wrong}:"}, **query))
        self.problem(400, "digest_mismatch", self.daemon.upload(content, {"Repr-Digest": "sha-256=:nonsense:"}, **query))
        self.assertEqual(self.daemon.traces(), before)
        self.expect(201, self.daemon.upload(content, {"Repr-Digest": f"sha-256=:{right}:"}, **query))

    def test_equal_uploads_at_once_are_one_recording(self) -> None:
        content = samples.gyro_csv(4000, seed=24)
        answers: list[Answer] = []
        threads = [threading.Thread(target=lambda: answers.append(self.daemon.upload(content, device="race", rate_hz=100, columns=samples.GYRO_Z)))
                   for _ in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(sorted(answer.status for answer in answers), [200] * 5 + [201], [a.describe() for a in answers])
        self.assertEqual(len({answer.json["id"] for answer in answers}), 1)
        self.assertEqual(self.daemon.files("incoming"), [])


class IdempotencyKey(DaemonTest):
    def test_upload_is_replayed_and_its_key_is_bound_to_it(self) -> None:
        content, key = samples.gyro_csv(seed=31), {"Idempotency-Key": "upload-1"}
        query = dict(rate_hz=100, columns=samples.GYRO_Z)
        first = self.expect(201, self.daemon.upload(content, key, **query))
        again = self.expect(201, self.daemon.upload(content, key, **query))
        self.assertEqual(again.body, first.body)
        self.assertEqual(again.headers["idempotency-replayed"], "true")
        self.assertEqual(again.headers["location"], first.headers["location"])
        self.assertNotIn("idempotency-replayed", first.headers)
        before = self.daemon.traces()
        self.problem(422, "idempotency_key_reused", self.daemon.upload(samples.gyro_csv(seed=32), key, **query))
        self.problem(422, "idempotency_key_reused", self.daemon.upload(content, key, device="other", **query))
        self.assertEqual(self.daemon.traces(), before)

    def test_metadata_part_belongs_to_the_body(self) -> None:
        content, key = samples.gyro_csv(seed=33), {"Idempotency-Key": "upload-2"}
        self.expect(201, self.daemon.upload_parts(("metadata", as_json(METADATA)), ("file", content), headers=key))
        changed = as_json({**METADATA, "rate_hz": 50})
        self.problem(422, "idempotency_key_reused", self.daemon.upload_parts(("metadata", changed), ("file", content), headers=key))

    def test_failure_is_not_remembered(self) -> None:
        key = {"Idempotency-Key": "upload-3"}
        self.problem(422, "no_samples", self.daemon.upload(b"gz\n", key, rate_hz=100))
        self.expect(201, self.daemon.upload(samples.gyro_csv(seed=34), key, rate_hz=100))

    def test_malformed_key_is_refused(self) -> None:
        self.problem(400, "invalid_argument", self.daemon.upload(samples.gyro_csv(seed=35), {"Idempotency-Key": "a b"}, rate_hz=100),
                     parameter="Idempotency-Key")


class Curl(DaemonTest):
    """The commands of the manual, run by curl itself."""

    def curl(self, *arguments: str, stdin: Any = subprocess.DEVNULL) -> Answer:
        with tempfile.TemporaryDirectory() as folder:
            shown = subprocess.run(["curl", "--silent", "--show-error", "--noproxy", "*", "--max-time", str(int(PATIENCE_S)), "--dump-header",
                                    f"{folder}/head", *arguments], stdin=stdin, capture_output=True, check=True)
            blocks = [block for block in Path(f"{folder}/head").read_bytes().split(b"\r\n\r\n") if block]
        self.interim = [block.split(b"\r\n")[0] for block in blocks[:-1]]
        answer = parse_answer(blocks[-1] + b"\r\n\r\n" + shown.stdout)
        return answer

    def url(self, rest: str) -> str:
        return f"http://127.0.0.1:{self.daemon.port}{rest}"

    def test_data_binary_form_and_expect(self) -> None:
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            file.write(samples.gyro_csv(100_000, seed=41))  # above the megabyte from which curl asks before it sends
            file.flush()
            target = self.url("/v1/recordings?device=phone-07&condition=constant_rate:z:9:deg/s&rate_hz=100&columns=gz=angular_rate:z:deg/s")
            first = self.expect(201, self.curl("--data-binary", f"@{file.name}", target))
            self.expect(200, self.curl("--header", "Expect: 100-continue", "--data-binary", f"@{file.name}", target))
            self.assertEqual(self.interim, [b"HTTP/1.1 100 Continue"])
            metadata = {**METADATA, "condition": first.json["metadata"]["condition"]}
            self.expect(200, self.curl("--form", f"metadata={json.dumps(metadata)};type=application/json", "--form", f"file=@{file.name}",
                                       self.url("/v1/recordings")))
            refused = self.curl("--header", "Expect: 100-continue", "--data-binary", f"@{file.name}", self.url("/v1/recordings?condition=static"))
            self.expect(400, refused)
            self.assertEqual(self.interim, [], "a refused upload is not asked for")

    def test_chunked_from_a_pipe_and_from_a_file(self) -> None:
        """curl sends what it reads from standard input in chunks, and asks before it does."""
        content = samples.gyro_csv(100_000, seed=43)
        target = self.url("/v1/recordings?device=piped&condition=static&rate_hz=100")
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            file.write(content)
            file.flush()
            with open(file.name, "rb") as pipe:
                first = self.expect(201, self.curl("--request", "POST", "--upload-file", "-", target, stdin=pipe))
            self.assertEqual(self.interim, [b"HTTP/1.1 100 Continue"])
            self.assertEqual(first.json["file"]["sha256"], hashlib.sha256(content).hexdigest())
            self.expect(200, self.curl("--request", "POST", "--upload-file", file.name, target))
            self.expect(200, self.curl("--header", "Transfer-Encoding: chunked", "--data-binary", f"@{file.name}", target))
            form = self.url("/v1/recordings")
            self.expect(200, self.curl("--header", "Transfer-Encoding: chunked", "--form", f"file=@{file.name}", "--form", "device=piped",
                                       "--form", "condition=static", "--form", "rate_hz=100", form))
        created = self.curl("--request", "POST", "--header", "Tus-Resumable: 1.0.0", "--header", "Upload-Length: 4", self.url("/v1/uploads"))
        piece = ("--request", "PATCH", "--header", "Tus-Resumable: 1.0.0", "--header", "Content-Type: application/offset+octet-stream", "--header",
                 "Transfer-Encoding: chunked", self.url(created.headers["location"]))
        self.problem(400, "invalid_argument", self.curl("--header", "Upload-Offset: 0", "--data-binary", "12345", *piece), parameter="Upload-Length")
        self.expect(204, self.curl("--header", "Upload-Offset: 0", "--data-binary", "1234", *piece))

    def test_a_form_needs_no_metadata_part(self) -> None:
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            file.write(samples.gyro_csv(seed=44))
            file.flush()
            whole = ("device=formed", "condition=constant_rate:z:9:deg/s", "rate_hz=100", "columns=gz=angular_rate:z:deg/s")
            first = self.expect(201, self.curl("--form", f"file=@{file.name}", self.url("/v1/recordings?" + "&".join(whole))))
            self.assertEqual(first.json["metadata"]["condition"]["value"], 9)
            fields = [word for field in whole for word in ("--form", field)]
            self.expect(200, self.curl("--form", f"file=@{file.name}", *fields, self.url("/v1/recordings")))
            self.expect(200, self.curl(*fields, "--form", f"file=@{file.name}", self.url("/v1/recordings")))
            nameless = self.problem(400, "invalid_argument", self.curl("--form", f"file=@{file.name}", self.url("/v1/recordings")), parameter="device")
            self.assertIn("device", str(nameless["detail"]))
            self.problem(400, "invalid_argument", self.curl("--form", f"file=@{file.name}", "--form", "colour=red", self.url("/v1/recordings")), part="colour")
            self.problem(400, "invalid_argument", self.curl(*fields, "--form", f"file=@{file.name}", self.url("/v1/recordings?device=formed")), part="device")
            both = ("--form", f"metadata={json.dumps(METADATA)}", "--form", f"file=@{file.name}")
            self.problem(400, "invalid_argument", self.curl(*both, self.url("/v1/recordings?rate_hz=50")), parameter="rate_hz")
            self.problem(400, "invalid_argument", self.curl("--form", "device=formed", self.url("/v1/recordings")), part="file")

    def test_form_fields_belong_to_the_body(self) -> None:
        content, key = samples.gyro_csv(seed=45), {"Idempotency-Key": "form-1"}
        fields = [("device", b"keyed"), ("condition", b"static"), ("rate_hz", b"100")]
        self.expect(201, self.daemon.upload_parts(*fields, ("file", content), headers=key))
        self.expect(201, self.daemon.upload_parts(*fields, ("file", content), headers=key))
        self.problem(422, "idempotency_key_reused", self.daemon.upload_parts(*fields[:2], ("rate_hz", b"50"), ("file", content), headers=key))

    def test_job_and_cancel_without_a_body(self) -> None:
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=42), rate_hz=100)).json["id"]
        job = self.expect(202, self.curl("--json", json.dumps({"kind": "characterise", "inputs": {"recordings": [recording]}}), self.url("/v1/jobs")))
        self.assertEqual(self.daemon.finished(job.json["id"])["state"], "succeeded")
        answer = self.curl("--request", "POST", self.url(f"/v1/jobs/{job.json['id']}/cancel"))
        self.assertIn(answer.status, (202, 409), answer.describe())


class Connections(DaemonTest):
    def test_two_uploads_on_one_connection(self) -> None:
        connection = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=PATIENCE_S)
        for seed in (51, 52):
            connection.request("POST", "/v1/recordings?device=keep&condition=static&rate_hz=100", body=samples.gyro_csv(seed=seed))
            response = connection.getresponse()
            self.assertEqual(response.status, 201, response.read())
            response.read()
        connection.close()

    def test_upload_pipelined_before_a_request_is_not_surplus(self) -> None:
        content = samples.gyro_csv(seed=53)
        head = f"POST /v1/recordings?device=pipe&condition=static&rate_hz=100 HTTP/1.1\r\nHost: localhost\r\nContent-Length: {len(content)}\r\n\r\n"
        raw = self.daemon.exchange(head.encode() + content + b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        self.assertEqual(raw.count(b"HTTP/1.1 201 Created"), 1, raw)
        self.assertEqual(raw.count(b"HTTP/1.1 200 OK"), 1, raw)


if __name__ == "__main__":
    unittest.main()
