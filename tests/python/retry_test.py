"""What the client does when the network or the daemon fails: a server on loopback that fails as it is told, and no real waiting."""
from __future__ import annotations

import email.utils
import json
import random
import socket
import ssl
import subprocess
import tempfile
import threading
import time
import unittest
from collections.abc import Callable
from dataclasses import dataclass, field

from driftlab import Client, Conflict, Retry, ServerProblem, Unavailable

DEVICE = {"id": "dev_01M7YQ3DBC1DYRKH20H9BQB2PC", "name": "phone-07"}


@dataclass
class Request:
    method: str
    target: str
    headers: dict[str, str]
    body: bytes


Act = Callable[[socket.socket], None]


def answer(status: int, document: object, **headers: str) -> Act:
    def send(connection: socket.socket) -> None:
        body = json.dumps(document).encode() if not isinstance(document, bytes) else document
        kind = "application/problem+json" if status >= 400 else "application/json"
        lines = [f"HTTP/1.1 {status} X", f"Content-Type: {kind}", f"Content-Length: {len(body)}", "Connection: close"]
        lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
        connection.sendall("\r\n".join(lines).encode() + b"\r\n\r\n" + body)
    return send


def problem(status: int, *, retryable: bool = True, **headers: str) -> Act:
    return answer(status, {"detail": "Planted.", "status": status, "code": "planted", "retryable": retryable}, **headers)


def lost(connection: socket.socket) -> None:
    """Closes without an answer."""


def torn(connection: socket.socket) -> None:
    """Half an answer."""
    connection.sendall(b"HTTP/1.1 200 OK\r\nContent-Length: 100\r\n\r\n{")


@dataclass
class Flaky:
    """Answers each connection with the next act; the last one goes on."""

    acts: list[Act]
    tls: ssl.SSLContext | None = None
    requests: list[Request] = field(default_factory=list)

    def __enter__(self) -> Flaky:
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()
        return self

    def __exit__(self, *unused: object) -> None:
        self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        self.thread.join(10.0)

    def serve(self) -> None:
        for number in range(1000):
            try:
                connection, _ = self.listener.accept()
            except OSError:
                return
            if self.tls is not None:
                try:
                    connection = self.tls.wrap_socket(connection, server_side=True)
                except OSError:
                    continue  # the client does not believe the certificate
            with connection:
                raw = connection.makefile("rb")
                method, target, _ = raw.readline().decode().split(" ")
                headers = {}
                while line := raw.readline().decode().strip():
                    name, _, value = line.partition(": ")
                    headers[name.lower()] = value
                body = raw.read(int(headers.get("content-length", 0)))
                self.requests.append(Request(method, target, headers, body))
                self.acts[min(number, len(self.acts) - 1)](connection)
                raw.close()


class RetryTest(unittest.TestCase):
    def setUp(self) -> None:
        self.pauses: list[float] = []

    def client(self, server: Flaky, attempts: int = 6) -> Client:
        retry = Retry(attempts=attempts, sleep=self.pauses.append, generator=random.Random(1))
        return Client(f"http://127.0.0.1:{server.port}", token="a-token-of-the-tests", retry=retry)

    def test_lost_and_torn_answers_are_asked_for_again_under_one_key(self) -> None:
        with Flaky([lost, torn, problem(503, Retry_After="1"), answer(201, DEVICE)]) as server:
            made = self.client(server).create_device("phone-07")
        self.assertEqual(made["name"], "phone-07")
        self.assertEqual(len(server.requests), 4)
        self.assertEqual(len({request.headers["idempotency-key"] for request in server.requests}), 1)
        self.assertEqual({request.body for request in server.requests}, {b'{"name": "phone-07"}'})
        self.assertEqual({request.headers["authorization"] for request in server.requests}, {"Bearer a-token-of-the-tests"})

    def test_two_requests_have_two_keys(self) -> None:
        with Flaky([answer(201, DEVICE)]) as server:
            client = self.client(server)
            client.create_device("phone-07")
            client.create_device("phone-07")
            client.create_device("phone-07", idempotency_key="mine")
        keys = [request.headers["idempotency-key"] for request in server.requests]
        self.assertEqual(len(set(keys)), 3)
        self.assertEqual(keys[2], "mine")
        self.assertRegex(keys[0], "^[A-Za-z0-9._-]{1,64}$")

    def test_retry_after_is_waited_for_in_seconds_and_as_a_date(self) -> None:
        date = email.utils.formatdate(time.time() + 30, usegmt=True)
        with Flaky([problem(429, Retry_After="7"), problem(503, Retry_After=date), answer(200, DEVICE)]) as server:
            self.client(server).device("phone-07")
        self.assertEqual(len(self.pauses), 2)
        self.assertTrue(7.0 <= self.pauses[0] <= 7.25, self.pauses)
        self.assertTrue(28.0 <= self.pauses[1] <= 30.5, self.pauses)

    def test_a_daemon_that_asks_for_too_much_patience_is_not_waited_for(self) -> None:
        with Flaky([problem(503, Retry_After="3600")]) as server:
            with self.assertRaises(Unavailable) as caught:
                self.client(server).device("phone-07")
        self.assertEqual((caught.exception.retry_after, self.pauses), (3600.0, []))

    def test_pauses_grow_are_drawn_and_end(self) -> None:
        with Flaky([lost]) as server:
            with self.assertRaises(Unavailable) as caught:
                self.client(server, attempts=9).device("phone-07")
        self.assertEqual((len(server.requests), len(self.pauses)), (9, 8))
        for attempt, pause in enumerate(self.pauses):
            self.assertTrue(0.0 <= pause <= min(20.0, 0.25 * 2 ** attempt), self.pauses)
        self.assertGreater(max(self.pauses[4:]), max(self.pauses[:2]))
        self.assertEqual(len(set(self.pauses)), 8)
        self.assertEqual(caught.exception.code, "connection_lost")

    def test_what_is_at_fault_itself_is_sent_once(self) -> None:
        for status in (400, 404, 409, 412, 422, 500, 507):
            with self.subTest(status=status), Flaky([problem(status, retryable=False)]) as server:
                with self.assertRaisesRegex(Exception, "Planted"):
                    self.client(server).device("phone-07")
                self.assertEqual(len(server.requests), 1)

    def test_a_request_that_is_still_running_is_asked_for_again(self) -> None:
        with Flaky([lost, problem(409), answer(201, DEVICE)]) as server:
            self.client(server).create_device("phone-07")
        self.assertEqual(len(server.requests), 3)
        with Flaky([problem(409)]) as server, self.assertRaises(Conflict):
            self.client(server).create_device("phone-07")

    def test_a_change_whose_answer_was_lost_is_not_repeated(self) -> None:
        """DELETE and PATCH have no key: whether they were done is not known, and the caller is told so."""
        with Flaky([lost, answer(200, DEVICE)]) as server:
            client = self.client(server)
            with self.assertRaises(Unavailable):
                client.delete_recording("rec_x")
        self.assertEqual((len(server.requests), server.requests[0].headers["if-match"]), (1, "*"))
        with Flaky([problem(503, Retry_After="0"), answer(200, DEVICE)]) as server:
            self.client(server).change_device("phone-07", {"serial": "1"})
        self.assertEqual(len(server.requests), 2)

    def test_an_upload_is_sent_again_whole(self) -> None:
        content = bytes(range(256)) * 4096
        seen: list[int] = []
        with Flaky([lost, answer(201, DEVICE)]) as server:
            self.client(server).upload(content, device="phone-07", progress=lambda sent, total: seen.append(sent))
        self.assertEqual([request.body == content for request in server.requests], [True, True])
        self.assertEqual(len({request.headers["repr-digest"] for request in server.requests}), 1)
        self.assertEqual(seen[-1], len(content))
        self.assertEqual(seen.count(len(content)), 2)

    def test_an_address_of_something_else_is_said(self) -> None:
        with Flaky([answer(200, b"<html>hello</html>")]) as server:
            with self.assertRaisesRegex(ServerProblem, "is this the address of a driftlab daemon"):
                self.client(server).health()
        with Flaky([answer(502, b"<html>bad gateway</html>")]) as server:
            with self.assertRaises(ServerProblem) as caught:
                self.client(server).health()
        self.assertEqual((caught.exception.status, caught.exception.detail), (502, "The daemon answered 502."))

    def test_the_wish_to_wait_goes_where_the_contract_takes_it(self) -> None:
        with Flaky([answer(200, DEVICE)]) as server:
            self.client(server).job("job_x", wait_s=5.4)
            self.client(server).create_device("phone-07")
        self.assertEqual([request.headers.get("prefer") for request in server.requests], ["wait=5", None])

    def test_readiness_is_asked_once(self) -> None:
        with Flaky([problem(503, Retry_After="1")]) as server, self.assertRaises(Unavailable):
            self.client(server).readiness()
        self.assertEqual((len(server.requests), self.pauses), (1, []))


def certificate(folder: str) -> str:
    """A key and a certificate for 127.0.0.1, in one file, signed by itself."""
    path = f"{folder}/server.pem"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
                    "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", path + ".key", "-out", path + ".crt"],
                   check=True, capture_output=True)
    with open(path, "w") as file:
        for part in (".key", ".crt"):
            with open(path + part) as made:
                file.write(made.read())
    return path


class Tls(unittest.TestCase):
    def setUp(self) -> None:
        self.pauses: list[float] = []

    def test_a_certificate_is_believed_only_where_it_is_trusted(self) -> None:
        path = certificate(self.enterContext(tempfile.TemporaryDirectory()))
        serving = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        serving.load_cert_chain(path)
        with Flaky([answer(200, {"status": "alive", "version": "0"})], tls=serving) as server:
            address = f"https://127.0.0.1:{server.port}"
            retry = Retry(sleep=self.pauses.append)
            with self.assertRaisesRegex(Unavailable, "not trusted") as caught:
                Client(address, retry=retry).health()
            self.assertEqual((caught.exception.code, self.pauses, server.requests), ("untrusted", [], []))
            self.assertEqual(Client(address, tls=ssl.create_default_context(cafile=path), retry=retry).health()["status"], "alive")


if __name__ == "__main__":
    unittest.main()
