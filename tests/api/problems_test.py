"""One error shape: every way to fail gives a whole problem document, and its type is a page."""
from __future__ import annotations

import json
import re
import unittest

import samples
from daemon import Answer, parse_answer, read_answer
from suite import DaemonTest


class Problems(DaemonTest):
    def raw(self, text: bytes) -> Answer:
        answer = parse_answer(self.daemon.exchange(text))
        self.contract.check_problem(answer)
        return answer

    def failures(self) -> dict[str, Answer]:
        """Slug -> an answer that has it."""
        d, csv = self.daemon, samples.gyro_csv
        upload = d.upload
        big = b"x" * (1 << 20) + b"x"
        device = d.post("/v1/devices", {"name": "a"}).headers["location"]
        upload(csv(seed=1), rate_hz=100)
        answers = [
            upload(csv(), rate_hz=0), upload(csv(), rate_hz=100, columns="gz=angular_rate:z:furlong"), upload(csv(), rate_hz=100, columns="gz=spin:z:deg/s"),
            upload(csv(), rate_hz=100, condition="asleep"), upload(csv(), rate_hz=100, columns="gz=angular_rate:z:g"),
            upload(csv(), rate_hz=100, columns="nobody=angular_rate:z:deg/s"), upload(b"gz,gz\n1,2\n3,4\n", rate_hz=100), upload(b"", rate_hz=100),
            upload(b"gz\n", rate_hz=100), upload(b"gz\n1\n", rate_hz=100), upload(b"gz\n1\n2,3\n", rate_hz=100), upload(b"gz\n1\nx\n", rate_hz=100),
            upload(b"gz\n1\nnan\n", rate_hz=100), upload(b"gz\n1\n1e999\n", rate_hz=100), upload(b"t,gz\n1,1\n0,2\n2,3\n", columns="t=time::s,gz=angular_rate:z:deg/s"),
            upload(csv()), upload(samples.npy(samples.noise(99))[:-8], rate_hz=100), upload(samples.npy(samples.noise(99)) + b"01234567", rate_hz=100),
            upload(b"\x89PNG\r\n\x1a\n" + bytes(64), rate_hz=100), upload(samples.npy(samples.noise(9)).replace(b"<f8", b"<M8"), rate_hz=100),
            upload(samples.COMPRESSIONS["gzip"](csv())[:-8] + bytes(8), rate_hz=100), upload(b"gz\n" + b"1" * (2 << 20), rate_hz=100), d.post("/v1/jobs", b"{"),
            d.get("/v1/devices/nobody"), upload(csv(seed=1), rate_hz=50), d.get("/nix"), d.request("DELETE", "/v1/devices"),
            d.get("/v1/parameter-tables?device=a", Accept="image/png"), d.post("/v1/devices", big), d.get("/v1/devices?page=2"),
            d.request("PATCH", device, {}, {"If-Match": '"x"'}), d.request("PATCH", device, {}), d.post("/v1/devices", b"{}", {"Content-Type": "text/plain"}),
            d.post("/v1/devices", b"{}", {"Origin": "http://evil.example"}), upload(csv(seed=2), {"Repr-Digest": "sha-256=:AAAA:"}, rate_hz=100),
            self.raw(b"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), self.raw(b"nonsense\r\n\r\n"),
            self.raw(b"POST /v1/devices HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"),
            d.get(d.items("/v1/recordings")[0]["id"].join(("/v1/recordings/", "/content")), Range="bytes=99999999-"),
            self.raw(b"GET /" + b"a" * 9000 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n"),
            self.raw(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"a" * 17000 + b"\r\n\r\n"),
        ]
        d.post("/v1/devices", {"name": "k"}, {"Idempotency-Key": "k"})
        answers.append(d.post("/v1/devices", {"name": "l"}, {"Idempotency-Key": "k"}))
        with d.connect() as connection:
            connection.sendall(b"POST /v1/devices HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n{")
            connection.shutdown(1)
            answers.append(read_answer(connection))
            self.contract.check_problem(answers[-1])
        found: dict[str, Answer] = {}
        for answer in answers:
            self.assertGreaterEqual(answer.status, 400, answer.describe())
            self.contract.check_problem(answer)
            found.setdefault(answer.json["type"].removeprefix("/problems/"), answer)
        return found

    # What a sound daemon on a sound machine cannot be made to say here, and where it is shown instead.
    ELSEWHERE = {
        "decompression-limit": "bad_input_test.py", "disk-full": "bad_input_test.py", "busy": "protocol_test.py",
        "not-ready": "store_test.py", "pooling-pending": "studies_test.py", "io": "tests/crash/disk_test.py", "too-many-requests": "budgets_test.py", "internal": "a bug", "cancelled": "never leaves a job",
        "limit-exceeded": "bad_input_test.py", "checksum-mismatch": "resumable_test.py", "idempotency-in-flight": "tests/unit/api", "unauthorized": "authorisation_test.py", "forbidden": "authorisation_test.py", "parse-error": "tests/unit/json", "inconsistent-sampling": "bad_input_test.py",
    }

    def test_every_type_is_met_and_has_a_page(self) -> None:
        found = self.failures()
        listed = {problem["slug"]: problem["href"] for problem in self.daemon.get("/docs").json["problems"]}
        missing = set(listed) - set(found) - set(self.ELSEWHERE)
        self.assertEqual(missing, set(), "no request met these")
        for slug, href in listed.items():
            page = self.expect(200, self.daemon.get(href))
            self.assertTrue(page.headers["content-type"].startswith("text/markdown"))
            title, _, rest = page.text.partition("\n\n")
            self.assertTrue(title.startswith("# ") and len(rest) > 40, slug)
            if slug in found:
                self.assertEqual(title, "# " + found[slug].json["title"])
                self.assertIn(f"Status {found[slug].status}.", rest)
                self.assertEqual("Trying again may help." in rest, found[slug].json["retryable"])

    def test_request_id_is_echoed_where_it_is_plain(self) -> None:
        given = self.daemon.get("/v1/devices/nobody", X_Request_Id="my-request.1")
        self.assertEqual((given.headers["x-request-id"], given.json["request_id"]), ("my-request.1", "my-request.1"))
        self.assertEqual(self.daemon.logged(request_id="my-request.1")["status"], 404)
        for strange in ("a b", "x" * 65, "<script>"):
            made = self.daemon.get("/v1/devices/nobody", X_Request_Id=strange).headers["x-request-id"]
            self.assertTrue(re.fullmatch(r"req_[0-9A-Z]{26}", made), made)

    def test_instance_is_the_path_that_was_asked_for(self) -> None:
        self.assertEqual(self.daemon.get("/v1/devices/no%20body").json["instance"], "/v1/devices/no%20body")
        self.assertEqual(self.daemon.get("/v1/devices?page=2").json["instance"], "/v1/devices")

    def test_hostile_text_stays_text(self) -> None:
        hostile = '<script>"\\\u0000\u2028'
        answer = self.daemon.post("/v1/jobs", {"kind": hostile, "inputs": {}})
        self.assertIn(hostile, self.problem(400, "invalid_argument", answer)["detail"])
        self.assertEqual(answer.headers["x-content-type-options"], "nosniff")
        for body in (b'{"name": "\xff"}', b'{"name": "a", "name": "b"}', b"[" * 100 + b"]" * 100, b'{"name": "a"} x', b"", b"{'name': 1}", b'{"name": 1e999}'):
            problem = self.problem(400, "parse_error", self.daemon.post("/v1/devices", body))
            self.assertEqual(json.loads(json.dumps(problem)), problem)

    def test_unknown_parameters_and_repeats_are_refused_everywhere(self) -> None:
        for path, operations in self.contract.paths.items():
            target = re.sub(r"\{\w+\}", "x", path)
            for method in operations:
                answer = self.daemon.request(method.upper(), target + "?colour=red", b"" if method in ("post", "patch") else None)
                self.problem(400, "unknown_parameter", answer)
        self.problem(400, "unknown_parameter", self.daemon.get("/v1/devices?limit=1&limit=2"))


if __name__ == "__main__":
    unittest.main()
