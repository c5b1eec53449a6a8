"""HTTP itself, byte by byte: what the guard refuses, limits, slow clients, connections, and the graceful stop."""
from __future__ import annotations

import http.client
import json
import os
import re
import signal
import socket
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

import samples
from daemon import Answer, Daemon, events, parse_answer, read_all, read_answer
from suite import DaemonTest

OK = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"


class Guard(DaemonTest):
    def raw(self, text: bytes) -> Answer:
        answer = parse_answer(self.daemon.exchange(text))
        if answer.status >= 400:
            self.contract.check_problem(answer)
        return answer

    def get(self, *headers: str, line: str = "GET /healthz HTTP/1.1") -> Answer:
        return self.raw("\r\n".join([line, *headers, "Connection: close", "", ""]).encode())

    def test_host_must_be_one_of_ours(self) -> None:
        for host in ("localhost", "LOCALHOST:80", f"127.0.0.1:{self.daemon.port}", "[::1]", "[::1]:8477"):
            self.expect(200, self.get(f"Host: {host}"))
        for host in ("evil.example", "localhost.evil.example", "127.0.0.2", "", "[::1", "[::2]:80", "localhost@evil.example"):
            self.problem(400, "host_not_allowed", self.get(f"Host: {host}"))
        self.problem(400, "host_not_allowed", self.get())
        self.problem(400, "host_not_allowed", self.get("Host: localhost", "Host: localhost"))

    def test_allow_host_adds_names(self) -> None:
        with Daemon(arguments=("--allow-host", "Lab-Server")) as daemon:
            self.assertEqual(daemon.get("/healthz", Host="lab-server:8477").status, 200)
            self.assertEqual(daemon.get("/healthz", Host="other").status, 400)

    def test_transfer_encoding_is_refused_and_nothing_behind_it_is_read(self) -> None:
        """What other servers would take as the body, or as the next request, is neither."""
        smuggled = b"POST /v1/devices HTTP/1.1\r\nHost: localhost\r\nContent-Length: 14\r\n\r\n{\"name\":\"in\"}\n"
        for coding in ("chunked", "gzip", "chunked, gzip", "identity", "xchunked", "Chunked "):
            for more in ("", "Content-Length: 5\r\n"):
                raw = self.daemon.exchange(f"POST /v1/devices HTTP/1.1\r\nHost: localhost\r\n{more}Transfer-Encoding: {coding}\r\n\r\n0\r\n\r\n".encode() + smuggled)
                self.assertEqual(raw.count(b"HTTP/1.1 "), 1, raw)
                self.assertIn(parse_answer(raw).status, (400, 411), raw)
        self.assertNotIn("in", [device["name"] for device in self.daemon.items("/v1/devices")])

    def test_repeated_and_contradicting_headers_are_refused(self) -> None:
        body = b'{"name":"in"}'
        for headers in ("Content-Length: 13\r\nContent-Length: 13", "Content-Length: 13\r\nContent-Length: 14", "Content-Length: 13, 13", "Content-Length: +13",
                        "Content-Length: 13\r\nContent-Type: a\r\nContent-Type: b", "Content-Length: 13\r\nAuthorization: a\r\nAuthorization: b",
                        "Content-Length: 13\r\nExpect: the-unexpected", "Content-Length: 13\r\nOrigin: null"):
            raw = self.daemon.exchange(f"POST /v1/devices HTTP/1.1\r\nHost: localhost\r\n{headers}\r\n\r\n".encode() + body)
            self.assertEqual(raw.count(b"HTTP/1.1 "), 1, raw)
            answer = parse_answer(raw)
            self.contract.check_problem(answer)
            self.assertIn(answer.status, (400, 403), headers)
        self.assertNotIn("in", [device["name"] for device in self.daemon.items("/v1/devices")])

    def test_a_document_names_its_type(self) -> None:
        """A page of another origin may send a body without a type, or as a form, and no browser asks before."""
        for header in ("", "Content-Type: application/x-www-form-urlencoded\r\n", "Content-Type: text/plain\r\n"):
            raw = self.daemon.exchange(f"POST /v1/devices HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n{header}Content-Length: 12\r\n\r\n".encode()
                                       + b'{"name":"a"}')
            self.assertTrue(raw.startswith(b"HTTP/1.1 415 "), raw[:200])

    def test_pages_of_other_origins_change_nothing_and_may_read_nothing(self) -> None:
        for origin in ("http://evil.example", "null", "http://localhost.evil.example", "localhost"):
            self.problem(403, "origin_not_allowed", self.daemon.upload(samples.gyro_csv(), {"Origin": origin}, rate_hz=100))
        self.assertEqual(self.daemon.items("/v1/recordings"), [])
        self.assertNotIn("access-control-allow-origin", self.daemon.get("/v1/devices", Origin="http://evil.example").headers)
        own = self.daemon.post("/v1/devices", {"name": "own-page"}, {"Origin": f"http://127.0.0.1:{self.daemon.port}"})
        self.expect(201, own)
        self.expect(200, self.daemon.get("/v1/devices/own-page"))

    def test_targets(self) -> None:
        for target in ("/v1/devices/%00", "/v1/devices/%zz", "*", "http://localhost/healthz", "/v1/devices?x=%z"):
            self.assertEqual(self.get("Host: localhost", line=f"GET {target} HTTP/1.1").status, 400, target)
        for target in ("/v1/../healthz", "/healthz/", "//healthz", "/docs/..%2f..%2fetc%2fpasswd", "/schemas/openapi.json", "/docs/../openapi", "/v1/devices/"):
            self.assertEqual(self.get("Host: localhost", line=f"GET {target} HTTP/1.1").status, 404, target)
        self.problem(400, "target_too_long", self.get("Host: localhost", line="GET /" + "a" * 8192 + " HTTP/1.1"))
        self.problem(431, "header_too_large", self.get("Host: localhost", "X-Long: " + "a" * 16400))

    def test_nonsense_is_answered_and_the_connection_closes(self) -> None:
        for text in (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(200) + b"\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/2.0\r\n\r\n", b"GET / HTTP/1.1\r\nHost localhost\r\n\r\n",
                     b"GET / HTTP/1.1\r\nHost : localhost\r\n\r\n", b"GET / HTTP/1.1\r\n Host: localhost\r\n\r\n", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"):
            answer = self.raw(text)
            self.assertEqual(answer.status, 400, text)
            self.assertEqual(answer.headers["connection"], "close")

    def test_methods(self) -> None:
        for method, target, allowed in (("PUT", "/v1/devices", "GET, HEAD, POST"), ("POST", "/healthz", "GET, HEAD"), ("OPTIONS", "/v1/devices", "GET, HEAD, POST"),
                                        ("GET", "/v1/jobs/x/cancel", "POST"), ("BREW", "/v1/devices", "GET, HEAD, POST")):
            answer = self.daemon.request(method, target)
            self.problem(405, "method_not_allowed", answer)
            self.assertEqual(answer.headers["allow"], allowed)

    def test_http_1_0_reads_but_sends_no_body(self) -> None:
        self.expect(200, self.raw(b"GET /healthz HTTP/1.0\r\nHost: localhost\r\n\r\n"))
        self.expect(400, self.raw(b"POST /v1/devices HTTP/1.0\r\nHost: localhost\r\nContent-Length: 12\r\n\r\n{\"name\":\"x\"}"))

    def test_security_headers(self) -> None:
        answer = self.daemon.get("/")
        self.assertEqual(answer.headers["x-content-type-options"], "nosniff")
        self.assertEqual(answer.headers["referrer-policy"], "no-referrer")
        self.assertIn("frame-ancestors 'none'", answer.headers["content-security-policy"])
        self.assertNotIn("<script", answer.text)


class Chunked(DaemonTest):
    def chunked(self, body: bytes, target: str = "/v1/recordings?device=chunked&condition=static&rate_hz=100") -> bytes:
        head = f"POST {target} HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
        return self.daemon.exchange(head.encode() + body)

    def test_a_chunked_upload_ends_where_it_says_and_hides_no_request(self) -> None:
        content = samples.gyro_csv(64, seed=77)
        size = f"{len(content):x}".encode()
        last = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
        raw = self.chunked(size + b";note=\"a\"\r\n" + content + b"\r\n0\r\n\r\n" + last)
        self.assertEqual(re.findall(rb"HTTP/1\.1 (\d+)", raw), [b"201", b"200"], "the next request is read as one")
        for body in (size + b"\r\n" + content + b"\r\n0\r\nAuthorization: Bearer x\r\n\r\n", size + b"\n" + content + b"\r\n0\r\n\r\n",
                     b"5\r\n" + content + b"\r\n0\r\n\r\n", b"+5\r\nabcde\r\n0\r\n\r\n", b"5;" + b"x" * 300 + b"\r\nabcde\r\n0\r\n\r\n", b"\r\n"):
            raw = self.chunked(body + last)
            self.assertEqual(raw.count(b"HTTP/1.1 "), 1, raw)
            self.contract.check_problem(parse_answer(raw))
            self.assertEqual(parse_answer(raw).status, 400, body[:40])
        self.assertEqual(len(self.daemon.items("/v1/recordings?device=chunked")), 1)
        self.assertEqual(self.daemon.files("incoming"), [])

    def test_a_chunked_upload_that_breaks_off_leaves_nothing(self) -> None:
        with self.daemon.connect() as connection:
            connection.sendall(b"POST /v1/recordings?device=cut&condition=static&rate_hz=100 HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
                               b"8\r\ngz\n1\n2\n")
            connection.shutdown(socket.SHUT_WR)
            answer = read_answer(connection)
        self.problem(400, "incomplete_body", answer)
        self.assertIn("last chunk", answer.json["detail"])
        self.assertEqual(self.daemon.files("incoming"), [])


class Connections(DaemonTest):
    def test_a_connection_serves_a_hundred_requests_and_says_when_it_closes(self) -> None:
        with self.daemon.connect() as connection:
            stream = self.enterContext(connection.makefile("rb"))
            for number in range(1, 101):
                connection.sendall(OK)
                head = b""
                while not head.endswith(b"\r\n\r\n"):
                    line = stream.readline()
                    self.assertTrue(line, f"closed after {number - 1} requests")
                    head += line
                stream.read(int(parse_answer(head + b"x").headers["content-length"]))
                self.assertEqual(b"connection: close" in head.lower(), number == 100, head)
            self.assertEqual(stream.read(), b"")

    def test_pipelined_requests_are_answered_in_order(self) -> None:
        text = OK + b"GET /v1/devices HTTP/1.1\r\nHost: localhost\r\n\r\n" + b"GET /nix HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
        raw = self.daemon.exchange(text)
        self.assertEqual(re.findall(rb"HTTP/1\.1 (\d+)", raw), [b"200", b"200", b"404"])

    def test_sixteen_uploads_at_once(self) -> None:
        target = "/v1/recordings?device=slow&condition=static&rate_hz=100"
        content = samples.gyro_csv()
        head = f"POST {target} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {len(content)}\r\n\r\n".encode()
        held = [self.daemon.connect() for _ in range(16)]
        try:
            for connection in held:
                connection.sendall(head + content[:100])
            until = time.monotonic() + 20
            while len(self.daemon.files("incoming")) < 16 and time.monotonic() < until:
                time.sleep(0.01)
            with ThreadPoolExecutor(1) as pool:
                seventeenth = pool.submit(self.daemon.upload, content, device="slow", rate_hz=100)
                time.sleep(0.2)
                self.expect(200, self.daemon.get("/healthz"))  # reading goes on beside
                self.assertFalse(seventeenth.done(), "it waits for a place")
                for connection in held:
                    connection.sendall(content[100:])
                answers = [read_answer(connection).status for connection in held] + [seventeenth.result().status]
            self.assertEqual(sorted(answers), [200] * 16 + [201])
        finally:
            for connection in held:
                connection.close()

    def test_a_body_that_trickles_does_not_hold_up_others(self) -> None:
        content = samples.gyro_csv(64, seed=5)
        head = f"POST /v1/recordings?device=trickle&condition=static&rate_hz=100 HTTP/1.1\r\nHost: localhost\r\nContent-Length: {len(content)}\r\n\r\n"
        with self.daemon.connect() as connection:
            connection.sendall(head.encode())
            for byte in range(0, len(content), 16):
                connection.sendall(content[byte:byte + 16])
                self.expect(200, self.daemon.get("/healthz"))
            self.assertEqual(read_answer(connection).status, 201)

    def test_a_header_must_come_within_ten_seconds(self) -> None:
        """The deadline is absolute: a byte now and then does not extend it."""
        with self.daemon.connect() as connection:
            connection.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX: ")
            started = time.monotonic()
            connection.settimeout(0.5)
            closed = False
            while not closed and time.monotonic() - started < 30:
                try:
                    connection.sendall(b"y")
                    closed = connection.recv(4096) == b""
                except socket.timeout:
                    continue
                except OSError:
                    closed = True
            took = time.monotonic() - started
        self.assertTrue(closed)
        self.assertGreater(took, 8)
        self.assertLess(took, 20)


class Stop(unittest.TestCase):
    def test_sigterm_finishes_requests_closes_streams_and_exits_with_0(self) -> None:
        with Daemon(arguments=("--workers", "1")) as daemon:
            content = samples.gyro_csv(4096)
            long_columns = [column * 64 for column in samples.noise(1 << 12, 6)]
            roles = ",".join(f"{i}={'angular_rate' if i < 3 else 'specific_force'}:{'xyz'[i % 3]}" for i in range(6))
            long = daemon.upload(samples.npy(long_columns), device="long", rate_hz=100, columns=roles).json["id"]
            job = daemon.characterise(long).json["id"]
            stream = events(daemon, job)
            while next(stream).type != "progress":
                pass
            waiting = self.enterContext(daemon.connect())
            waiting.sendall(f"GET /v1/jobs/{job} HTTP/1.1\r\nHost: localhost\r\nPrefer: wait=60\r\n\r\n".encode())
            idle = self.enterContext(daemon.connect())
            idle.sendall(OK)
            self.assertEqual(read_answer(idle).status, 200)
            upload = self.enterContext(daemon.connect())
            head = f"POST /v1/recordings?device=last&condition=static&rate_hz=100 HTTP/1.1\r\nHost: localhost\r\nContent-Length: {len(content)}\r\n\r\n".encode()
            upload.sendall(head + content[:1000])
            until = time.monotonic() + 20
            while not daemon.files("incoming") and time.monotonic() < until:
                time.sleep(0.005)

            daemon.process.send_signal(signal.SIGTERM)
            for _ in stream:
                pass  # ends, for the daemon closes it
            self.assertEqual(read_all(idle), b"")
            while True:  # no longer accepted
                try:
                    daemon.connect().close()
                    time.sleep(0.01)
                except OSError:
                    break
            self.assertIsNone(daemon.process.poll(), "it waits for the upload")
            upload.sendall(content[1000:])
            answer = parse_answer(read_all(upload))
            self.assertEqual((answer.status, answer.headers["connection"]), (201, "close"), answer.describe())
            self.assertEqual(daemon.wait(), 0)
            told = parse_answer(read_all(waiting))
            self.assertEqual((told.status, told.json["finished_at"]), (200, None), "told what is, before its time was over")
            said = [entry.get("event") for entry in daemon.log]
            self.assertIn("stopping", said)
            self.assertEqual(said[-1], "stopped")

            # The job was handed back: the next daemon runs it, once, and has the last upload.
            with Daemon(daemon.data) as next_daemon:
                document = next_daemon.finished(job)
                self.assertEqual(document["state"], "succeeded")
                self.assertEqual(document["failed_attempts"], [], "a stop is no failure")
                self.assertEqual(len(next_daemon.items("/v1/recordings?device=last")), 1)
                self.assertEqual(next_daemon.terminate(), 0)

    def test_idle_daemon_stops_at_once(self) -> None:
        with Daemon() as daemon:
            started = time.monotonic()
            self.assertEqual(daemon.terminate(), 0)
            self.assertLess(time.monotonic() - started, 5)

    def test_second_signal_ends_it_and_the_next_start_is_clean(self) -> None:
        # It ends in the middle of its work: nobody waits for its threads any more, which is no leak of them.
        unwatched = {"TSAN_OPTIONS": os.environ.get("TSAN_OPTIONS", "") + ":report_thread_leaks=0"}
        with Daemon(environment=unwatched) as daemon:
            head = b"POST /v1/recordings?device=a&condition=static&rate_hz=100 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\ngz\n"
            with daemon.connect() as connection:
                connection.sendall(head)
                until = time.monotonic() + 20
                while not daemon.files("incoming") and time.monotonic() < until:
                    time.sleep(0.005)
                daemon.process.send_signal(signal.SIGTERM)
                daemon.logged(event="stopping")
                daemon.process.send_signal(signal.SIGTERM)
                self.assertEqual(daemon.wait(), 128 + signal.SIGTERM)
            with Daemon(daemon.data) as again:
                self.assertEqual(again.traces(), {"devices": [], "recordings": [], "blobs": [], "columns": [], "incoming": []})

    def test_data_of_a_running_daemon_are_taken_by_no_other(self) -> None:
        with Daemon() as daemon:
            with self.assertRaises(AssertionError) as refused:
                Daemon(daemon.data)
            self.assertIn("cannot start", str(refused.exception))
            self.assertEqual(daemon.get("/readyz").status, 200)


class Start(unittest.TestCase):
    def test_logs_are_one_json_object_a_line(self) -> None:
        with Daemon() as daemon:
            daemon.get("/healthz")
            daemon.terminate()
            for entry in daemon.log:
                self.assertNotIn("raw", entry)
                self.assertTrue({"time", "level", "event"} <= set(entry), entry)
            [request] = [entry for entry in daemon.log if entry["event"] == "request"]
            self.assertEqual((request["method"], request["route"], request["status"]), ("GET", "/healthz", 200))
            json.dumps(request)


if __name__ == "__main__":
    unittest.main()
