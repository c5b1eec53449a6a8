"""TLS: HTTPS and nothing else, a certificate that is changed while the daemon runs, and where the daemon may listen."""
from __future__ import annotations

import http.client
import json
import os
import signal
import socket
import ssl
import subprocess
import tempfile
import time
import unittest
from pathlib import Path
from typing import Any

import samples
from daemon import Daemon, read_all
from suite import SKIPPED
from tokens_test import command

try:
    subprocess.run(["openssl", "version"], check=True, capture_output=True)
except (OSError, subprocess.CalledProcessError):
    print("SKIPPED: certificates of the test are made by the program openssl, which is not here")
    raise SystemExit(SKIPPED) from None


def certificate(folder: Path, name: str, *, passphrase: bool = False) -> tuple[str, str]:
    """A self-signed certificate for 127.0.0.1, and its key."""
    chain, key = folder / f"{name}.pem", folder / f"{name}.key"
    words = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-days", "2", "-subj", f"/CN={name}",
             "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", str(key), "-out", str(chain)]
    subprocess.run([*words, *(["-passout", "pass:secret"] if passphrase else ["-nodes"])], check=True, capture_output=True)
    return str(chain), str(key)


class Tls(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.chain, cls.key = certificate(cls.folder, "first")
        cls.other_chain, cls.other_key = certificate(cls.folder, "second")

    def daemon(self, *more: str) -> Daemon:
        return self.enterContext(Daemon(arguments=("--tls-certificate", self.chain, "--tls-key", self.key, *more)))

    def trusting(self, chain: str | None = None) -> ssl.SSLContext:
        return ssl.create_default_context(cafile=chain or self.chain)

    def ask(self, daemon: Daemon, method: str, target: str, body: bytes | None = None, headers: dict[str, str] | None = None,
            context: ssl.SSLContext | None = None) -> tuple[int, dict[str, str], bytes]:
        connection = http.client.HTTPSConnection("127.0.0.1", daemon.port, timeout=60, context=context or self.trusting())
        try:
            connection.request(method, target, body, headers or {})
            answer = connection.getresponse()
            return answer.status, {name.lower(): value for name, value in answer.getheaders()}, answer.read()
        finally:
            connection.close()

    def test_everything_works_as_without(self) -> None:
        daemon = self.daemon()
        kept = http.client.HTTPSConnection("127.0.0.1", daemon.port, timeout=60, context=self.trusting())
        for _ in range(3):  # one connection, several requests
            kept.request("GET", "/healthz")
            self.assertEqual(kept.getresponse().read()[:1], b"{")
        kept.close()
        content = samples.gyro_csv(200_000)
        status, _, body = self.ask(daemon, "POST", "/v1/recordings?device=a&condition=static&rate_hz=100", content,
                                   {"Content-Type": "application/octet-stream"})
        self.assertEqual(status, 201, body)
        self.assertEqual(json.loads(body)["file"]["bytes"], len(content))
        job = json.dumps({"kind": "characterise", "inputs": {"recordings": [json.loads(body)["id"]]}, "parameters": {"models": ["WN"]}}).encode()
        status, _, body = self.ask(daemon, "POST", "/v1/jobs", job, {"Content-Type": "application/json"})
        self.assertEqual(status, 202, body)
        status, headers, body = self.ask(daemon, "GET", f"/v1/jobs/{json.loads(body)['id']}/events")
        self.assertEqual((status, headers["content-type"]), (200, "text/event-stream"))
        self.assertIn(b'"state":"succeeded"', body)
        status, _, body = self.ask(daemon, "POST", "/v1/devices", b"{" * 2_000_000, {"Content-Type": "application/json"})
        self.assertEqual(status, 413)  # refused before it was read, and the client sees why
        origin = {"Content-Type": "application/json", "Origin": f"https://127.0.0.1:{daemon.port}"}
        self.assertEqual(self.ask(daemon, "POST", "/v1/devices", b'{"name": "b"}', origin)[0], 201)
        origin["Origin"] = origin["Origin"].replace("https", "http")
        self.assertEqual(self.ask(daemon, "POST", "/v1/devices", b'{"name": "c"}', origin)[0], 403)
        self.assertEqual(daemon.terminate(), 0)

    def test_neither_plain_http_nor_old_tls_nor_silence_is_answered(self) -> None:
        daemon = self.daemon()
        self.assertNotIn(b"HTTP/1.1 200", daemon.exchange(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"))
        old = self.trusting()
        old.minimum_version = ssl.TLSVersion.TLSv1
        old.maximum_version = ssl.TLSVersion.TLSv1_1
        with self.assertRaises((ssl.SSLError, OSError)):
            self.ask(daemon, "GET", "/healthz", context=old)
        with daemon.connect() as silent:  # a handshake that never comes is given up after 10 s
            start = time.monotonic()
            silent.settimeout(30)
            self.assertEqual(read_all(silent), b"")
            self.assertTrue(8 < time.monotonic() - start < 20)
        self.assertEqual(self.ask(daemon, "GET", "/healthz")[0], 200)

    def test_those_who_never_greet_make_place_like_any_idle_one(self) -> None:
        daemon = self.daemon("--budget", "connections=8")
        silent = [self.enterContext(socket.create_connection(("127.0.0.1", daemon.port))) for _ in range(8)]
        for _ in range(4):
            self.assertEqual(self.ask(daemon, "GET", "/healthz")[0], 200)
        silent[0].settimeout(5)  # well before its handshake is over time
        try:
            self.assertEqual(silent[0].recv(1), b"", "the one that was silent for longest made place")
        except ConnectionResetError:
            pass

    def test_an_end_can_be_told_from_a_cut(self) -> None:
        daemon = self.daemon()
        with socket.create_connection(("127.0.0.1", daemon.port), timeout=60) as raw, self.trusting().wrap_socket(raw, server_hostname="127.0.0.1") as tls:
            tls.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
            text = b""
            while piece := tls.recv(65536):  # an end without close_notify would raise SSLEOFError
                text += piece
            self.assertTrue(text.startswith(b"HTTP/1.1 200 "))

    def test_a_session_is_bound_to_host_and_tls(self) -> None:
        daemon = self.daemon("--require-tokens")
        secret = (daemon.data / "first-admin-token").read_text().strip()
        status, headers, body = self.ask(daemon, "POST", "/v1/session", json.dumps({"token": secret}).encode(), {"Content-Type": "application/json"})
        self.assertEqual(status, 201, body)
        cookie = headers["set-cookie"]
        self.assertTrue(cookie.startswith("__Host-driftlab="))
        self.assertLessEqual({"Secure", "HttpOnly", "SameSite=Strict", "Path=/"}, set(cookie.split("; ")))
        self.assertEqual(self.ask(daemon, "GET", "/v1/devices", headers={"Cookie": cookie.partition(";")[0]})[0], 200)

    def test_sighup_shows_the_new_certificate_and_keeps_the_old_one_where_the_new_is_none(self) -> None:
        chain, key = self.folder / "shown.pem", self.folder / "shown.key"
        chain.write_text(Path(self.chain).read_text())
        key.write_text(Path(self.key).read_text())
        daemon = self.enterContext(Daemon(arguments=("--tls-certificate", str(chain), "--tls-key", str(key))))
        kept = http.client.HTTPSConnection("127.0.0.1", daemon.port, timeout=60, context=self.trusting())
        kept.request("GET", "/healthz")
        kept.getresponse().read()
        chain.write_text("nonsense")
        daemon.process.send_signal(signal.SIGHUP)
        daemon.logged(event="the certificate was not reloaded; the old one stays")
        self.assertEqual(self.ask(daemon, "GET", "/healthz")[0], 200)
        chain.write_text(Path(self.other_chain).read_text())
        key.write_text(Path(self.other_key).read_text())
        daemon.process.send_signal(signal.SIGHUP)
        daemon.logged(event="certificate reloaded")
        with self.assertRaises(ssl.SSLCertVerificationError):
            self.ask(daemon, "GET", "/healthz")
        self.assertEqual(self.ask(daemon, "GET", "/healthz", context=self.trusting(self.other_chain))[0], 200)
        kept.request("GET", "/healthz")  # a connection that was open stays
        self.assertEqual(kept.getresponse().status, 200)
        kept.close()

    def test_what_does_not_fit_is_said_at_the_start(self) -> None:
        locked_chain, locked_key = certificate(self.folder, "locked", passphrase=True)
        data = self.folder / "nowhere"
        for words, part in ((("--tls-certificate", self.chain), "given together"), (("--tls-key", self.key), "given together"),
                            (("--tls-certificate", "absent.pem", "--tls-key", self.key), "absent.pem"),
                            (("--tls-certificate", self.key, "--tls-key", self.key), "holds no certificate"),
                            (("--tls-certificate", self.chain, "--tls-key", self.other_key), "key"),
                            (("--tls-certificate", locked_chain, "--tls-key", locked_key), "passphrase")):
            ran = command(*words, "--listen", "127.0.0.1:0", data=data)
            self.assertEqual(ran.returncode, 2, f"{words}: {ran.stderr}")
            self.assertIn(part, ran.stderr.splitlines()[-1])
            self.assertFalse(data.exists())

    def test_another_address_than_loopback_needs_tls_and_tokens(self) -> None:
        data = self.folder / "open"
        tls = ("--tls-certificate", self.chain, "--tls-key", self.key)
        for words in ((), ("--require-tokens",), tls):
            ran = command("--listen", "0.0.0.0:0", *words, data=data)
            self.assertEqual(ran.returncode, 2, words)
            [sentence] = [line for line in ran.stderr.splitlines() if line.startswith("driftlabd: ")]
            for word in ("--tls-certificate", "--require-tokens", "--insecure"):
                self.assertIn(word, sentence)
            self.assertFalse(data.exists())
        everywhere: dict[str, Any] = {"listen": "0.0.0.0:0"}
        with Daemon(arguments=("--insecure",), **everywhere) as daemon:
            self.assertEqual(daemon.get("/healthz").status, 200)
        with Daemon(data, arguments=("--require-tokens", *tls), **everywhere) as daemon:
            self.assertEqual(self.ask(daemon, "GET", "/v1/devices")[0], 401)
            daemon.terminate()
        with Daemon(data, arguments=tls, **everywhere) as daemon:  # there are tokens now
            self.assertEqual(self.ask(daemon, "GET", "/v1/devices")[0], 401)

    def test_the_clients_speak_it(self) -> None:
        try:
            from driftlab import Client
        except ModuleNotFoundError as missing:
            self.skipTest(f"SKIPPED, NOT PASSED: this interpreter has no {missing.name}, which the Python client needs")
        daemon = self.daemon("--require-tokens")
        address = f"https://127.0.0.1:{daemon.port}"
        client = Client(address, token_file=daemon.data / "first-admin-token", tls=self.trusting())
        self.assertEqual(client.session()["scope"], "admin")
        file = self.folder / "gyro.csv"
        file.write_bytes(samples.gyro_csv(2000))
        words = [os.environ["DRIFTLAB"], "characterise", str(file), "--rate-hz", "100", "--columns", samples.GYRO_Z, "--condition", "static",
                 "--models", "WN", "--server", address, "--device", "a", "--token-file", str(daemon.data / "first-admin-token")]
        environment = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}
        ran = subprocess.run(words, capture_output=True, text=True, check=False, env=environment)
        self.assertNotEqual(ran.returncode, 0)
        self.assertIn("certificate", ran.stderr)
        ran = subprocess.run([*words, "--ca-file", self.chain], capture_output=True, text=True, check=False, env=environment)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("WN", ran.stdout)


if __name__ == "__main__":
    unittest.main()
