"""An object storage of the test's own: OpenStack Swift with its S3 interface, and a way to it on which things go wrong.

Swift runs as one process in a temporary folder on loopback (swift_server.py, Debian's package python3-swift); it ends with the test. A `FaultyWay` is a proxy in front of it. Run by itself this file
obeys the lines of its standard input, for the tests in C++ (tests/unit/store/s3/object_storage.hpp).
"""
from __future__ import annotations

import atexit
import hashlib
import http.client
import http.server
import shutil
import socket
import ssl
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
from dataclasses import dataclass
from pathlib import Path

PATIENCE_S = 60.0
PYTHON = "/usr/bin/python3"  # Debian's, which has Swift
AWS = "/usr/bin/aws"
KEY_ID, SECRET, REGION = "lab:driftlab", "a-secret-of-the-tests", "test-region"
KEY = {"AWS_ACCESS_KEY_ID": KEY_ID, "AWS_SECRET_ACCESS_KEY": SECRET}  # as variables
STRANGER = "lab:stranger"  # a key of the same secret that has no right to anything
HERE = Path(__file__).resolve().parent


def is_installed() -> bool:
    return Path("/usr/lib/python3/dist-packages/swift/common/middleware/s3api").exists()


class Swift:
    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="driftlab-swift-"))
        atexit.register(self.remove)
        self.start()

    def start(self) -> None:
        (self.folder / "port").unlink(missing_ok=True)
        with open(self.folder / "output", "ab") as output:
            self.server = subprocess.Popen([PYTHON, "-B", HERE / "swift_server.py", self.folder], stdin=subprocess.DEVNULL,
                                           stdout=output, stderr=output, env={"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8"})
        until = time.monotonic() + PATIENCE_S
        while not (self.folder / "port").exists():
            assert self.server.poll() is None and time.monotonic() < until, (self.folder / "output").read_text()
            time.sleep(0.02)
        self.port = int((self.folder / "port").read_text())

    def remove(self) -> None:
        self.server.kill()
        self.server.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    # --- Swift's own interface, for what S3's would not do

    def own(self, method: str, path: str, body: bytes = b"", **headers: str) -> tuple[int, dict[str, str], bytes]:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        try:
            connection.request("GET", "/auth/v1.0", headers={"X-Auth-User": KEY_ID, "X-Auth-Key": SECRET})
            granted = connection.getresponse()
            granted.read()
            token = granted.headers["X-Auth-Token"]
            connection.request(method, "/v1/AUTH_lab/" + urllib.parse.quote(path), body=body,
                               headers={"X-Auth-Token": token, **{name.replace("_", "-"): value for name, value in headers.items()}})
            answer = connection.getresponse()
            return answer.status, {name.lower(): value for name, value in answer.headers.items()}, answer.read()
        finally:
            connection.close()

    def make_bucket(self, name: str, quota_bytes: int | None = None) -> None:
        quota = {} if quota_bytes is None else {"X_Container_Meta_Quota_Bytes": str(quota_bytes)}
        status, _, body = self.own("PUT", name, **quota)
        assert status in (201, 202), body

    def keys(self, bucket: str, prefix: str = "") -> list[str]:
        _, _, body = self.own("GET", bucket)
        return [name for name in body.decode().splitlines() if name.startswith(prefix)]

    def damage(self, bucket: str, key: str) -> None:
        """Other bytes under the same name and with the same metadata."""
        _, headers, content = self.own("GET", f"{bucket}/{key}")
        other = bytes([content[0] ^ 1]) + content[1:] if content else b"x"
        kept = {"X_Object_Meta_Sha256": headers["x-object-meta-sha256"]} if "x-object-meta-sha256" in headers else {}
        status, _, body = self.own("PUT", f"{bucket}/{key}", other, **kept)
        assert status == 201, body

    def lose(self, bucket: str, key: str) -> None:
        self.own("DELETE", f"{bucket}/{key}")


@dataclass
class Fault:
    """`kind` befalls the next `times` requests of these methods whose target has `within`."""

    kind: str
    times: int = 1_000_000
    methods: str = ""
    within: str = ""


STATUSES = {"unavailable": (503, "SlowDown"), "broken": (500, "InternalError"), "full": (507, "InsufficientStorage"),
            "denied": (403, "AccessDenied"), "missing": (404, "NoSuchKey"), "skewed": (403, "RequestTimeTooSkewed")}


class FaultyWay:
    """Hands requests on to a storage, but for what `fault` says. `seen` counts requests, also those it kept."""

    def __init__(self, port: int, tls: ssl.SSLContext | None = None) -> None:
        """With `tls` it is asked by HTTPS."""
        self.upstream = port
        self.fault: Fault | None = None
        self.seen: list[str] = []
        self._lock = threading.Lock()
        way = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def handle_one_request(self) -> None:
                try:
                    super().handle_one_request()
                except (ConnectionError, TimeoutError, ssl.SSLError):
                    self.close_connection = True

            def __getattr__(self, name: str) -> object:
                if name.startswith("do_"):
                    return lambda: way.answer(self)
                raise AttributeError(name)

            def log_message(self, *unused: object) -> None:
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        if tls is not None:  # each connection shakes hands in a thread of its own, when it is first read
            self.server.socket = tls.wrap_socket(self.server.socket, server_side=True, do_handshake_on_connect=False)
        self.port = int(self.server.server_address[1])
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def _befalls(self, method: str, target: str) -> Fault | None:
        with self._lock:
            self.seen.append(f"{method} {target}")
            fault = self.fault
            if fault is None or fault.times <= 0 or method not in (fault.methods or method) or fault.within not in target:
                return None
            fault.times -= 1
            return fault

    def answer(self, request: http.server.BaseHTTPRequestHandler) -> None:
        fault = self._befalls(request.command, request.path)
        kind = fault.kind if fault else ""
        length = int(request.headers.get("Content-Length", "0"))
        if kind == "cut":  # in the middle of the body, or of the answer
            request.rfile.read(length // 2)
            if length:
                return self._cut(request)
        body = request.rfile.read(length - length // 2 if kind == "cut" else length)
        if kind == "slow":
            while self.fault is fault and fault is not None:
                time.sleep(0.02)
            return self._cut(request)
        if kind in STATUSES:
            return self._say(request, *STATUSES[kind])
        if kind == "damaged_request" and body:
            body = bytes([body[0] ^ 1]) + body[1:]
        connection = http.client.HTTPConnection("127.0.0.1", self.upstream, timeout=PATIENCE_S)
        try:
            connection.putrequest(request.command, request.path, skip_host=True, skip_accept_encoding=True)
            for name, value in request.headers.items():
                connection.putheader(name, value)
            connection.endheaders(body if body else None)
            answer = connection.getresponse()
            content = answer.read()
            if kind == "lost":  # done, but nobody hears of it
                return self._cut(request)
            if kind == "damaged" and content:
                content = bytes([content[0] ^ 1]) + content[1:]
            request.send_response_only(answer.status)
            for name, value in answer.getheaders():
                if name.lower() not in ("transfer-encoding", "connection", "content-length"):
                    request.send_header(name, value)
            stated = answer.headers.get("Content-Length") if request.command == "HEAD" else str(len(content))
            if stated is not None:
                request.send_header("Content-Length", stated)
            request.end_headers()
            if kind == "cut":
                request.wfile.write(content[: len(content) // 2])
                return self._cut(request)
            if kind == "trickle":
                for byte in content:
                    request.wfile.write(bytes([byte]))
                    request.wfile.flush()
                    time.sleep(0.2)
            elif request.command != "HEAD":
                request.wfile.write(content)
        finally:
            connection.close()

    @staticmethod
    def _cut(request: http.server.BaseHTTPRequestHandler) -> None:
        request.wfile.flush()
        request.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        request.close_connection = True
        request.connection.close()

    @staticmethod
    def _say(request: http.server.BaseHTTPRequestHandler, status: int, code: str) -> None:
        body = f'<?xml version="1.0"?><Error><Code>{code}</Code><Message>a test &amp; nothing else</Message></Error>'.encode()
        request.send_response(status)  # with the header Date
        request.send_header("Content-Type", "application/xml")
        request.send_header("Content-Length", str(len(body)))
        request.end_headers()
        if request.command != "HEAD":
            request.wfile.write(body)


_servers: list[Swift] = []


def server() -> Swift:
    """That of this process, started when it is first asked for."""
    if not _servers:
        _servers.append(Swift())
    return _servers[0]


def bucket_of(folder: Path) -> str:
    """The same for the same folder."""
    return "t" + hashlib.sha256(str(folder.resolve()).encode()).hexdigest()[:20]


def place_of(folder: Path, port: int | None = None) -> str:
    """--blobs for a test's folder, in a bucket that is made where it is absent; by another way to the storage where one is named."""
    server().make_bucket(bucket_of(folder))
    return f"s3://{bucket_of(folder)}/lab?endpoint=http://127.0.0.1:{port or server().port}&region={REGION}"


def aws(*arguments: str, content: bytes | None = None) -> bytes:
    """The independent client."""
    settings = {"PATH": "/usr/bin:/bin", "HOME": str(server().folder), **KEY, "AWS_DEFAULT_REGION": REGION, "AWS_EC2_METADATA_DISABLED": "true"}
    done = subprocess.run([AWS, "--endpoint-url", f"http://127.0.0.1:{server().port}", *arguments], input=content,
                          capture_output=True, env=settings, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout


def obey() -> None:
    """Each line one command, each answered by a line."""
    swift = server()
    way = FaultyWay(swift.port)
    print(swift.port, way.port, KEY_ID, SECRET, STRANGER, flush=True)
    for line in sys.stdin:
        verb, *words = line.split()
        if verb == "bucket":
            swift.make_bucket(words[0], int(words[1]) if len(words) > 1 else None)
        elif verb == "fault":
            way.fault = Fault(words[0], int(words[1]), *("" if word == "-" else word for word in words[2:]))
        elif verb == "pass":
            way.fault = None
        elif verb == "damage":
            swift.damage(*words)
        elif verb == "lose":
            swift.lose(*words)
        elif verb == "stop":
            swift.server.kill()
            swift.server.wait()
        if verb == "seen":
            print(sum(words[0] in one for one in way.seen), flush=True)
            way.seen.clear()
        elif verb == "keys":
            print(" ".join(swift.keys(*words)), flush=True)
        else:
            print("done", flush=True)


if __name__ == "__main__":
    obey()
