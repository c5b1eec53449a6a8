"""Starts the real daemon for a test, speaks HTTP with it, and looks into its data directory."""
from __future__ import annotations

import contextlib
import http.client
import json
import os
import re
import shutil
import signal
import socket
import sqlite3
import subprocess
import tempfile
import threading
import time
import urllib.parse
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import postgres

PROGRAM = os.environ.get("DRIFTLABD", "")
# `postgres`: daemons keep their rows in a PostgreSQL that the test starts, unless a test names another store.
STORE = os.environ.get("DRIFTLAB_TEST_STORE", "")
# No test waits longer than this for something that must happen; sanitized code runs three to twenty times slower.
PATIENCE_S = 600.0 if os.environ.get("DRIFTLAB_SANITIZE") else 120.0


@dataclass
class Answer:
    method: str
    target: str
    status: int
    headers: dict[str, str]  # names in lower case
    body: bytes

    @property
    def text(self) -> str:
        return self.body.decode()

    @property
    def json(self) -> Any:
        return json.loads(self.body)

    def describe(self) -> str:
        return f"{self.method} {self.target} -> {self.status} {self.body[:600]!r}"


class Daemon:
    """One `driftlabd` process on a directory of its own, on a free port. A context manager: killed at the end."""

    host = "127.0.0.1"  # where it is asked
    patience_s = PATIENCE_S  # for an answer

    def __init__(self, data: Path | None = None, *, arguments: tuple[str, ...] = (), environment: dict[str, str] | None = None,
                 before_exec: Callable[[], None] | None = None, listen: str = "127.0.0.1:0", program: str = "") -> None:
        self._own = Path(tempfile.mkdtemp(prefix="driftlab-test-")) if data is None else None
        self.data = data if data is not None else self._own / "data"  # type: ignore[operator]
        self.log: list[dict[str, Any]] = []
        self.checks: list[Callable[[Answer], None]] = []
        self.token: str | None = None  # sent with every request that says nothing else
        self._listening = threading.Event()
        self.port = 0
        if STORE == "postgres" and "--store" not in arguments:
            arguments = ("--store", postgres.cluster().store_of(self.data), *arguments)
        settings = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}
        self.process = subprocess.Popen(
            [program or PROGRAM, "--data", str(self.data), "--listen", listen, *arguments], stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env={**settings, **(environment or {})},
            preexec_fn=before_exec)
        self._reader = threading.Thread(target=self._read_log, daemon=True)
        self._reader.start()
        if not self._listening.wait(PATIENCE_S) or self.port == 0:
            self.process.kill()
            self.process.wait()
            raise AssertionError(f"the daemon does not listen: {self.log[-5:]}")

    def _read_log(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            try:
                entry = json.loads(line)
            except ValueError:
                entry = {"raw": line.decode(errors="replace")}
            self.log.append(entry)
            if entry.get("event") == "listening" or entry.get("msg") == "listening" or "listening" in entry.values():
                found = re.search(rb'"port": ?(\d+)', line)
                if found:
                    self.port = int(found.group(1))
                    self._listening.set()
        self._listening.set()

    def __enter__(self) -> Daemon:
        return self

    def __exit__(self, *unused: object) -> None:
        self.kill()
        if self._own is not None:
            shutil.rmtree(self._own, ignore_errors=True)

    def kill(self) -> None:
        """SIGKILL, where it still runs."""
        if self.process.poll() is None:
            self.process.kill()
        self.wait()

    def terminate(self) -> int:
        """SIGTERM; the exit code."""
        self.process.send_signal(signal.SIGTERM)
        return self.wait()

    def wait(self) -> int:
        code = self.process.wait(PATIENCE_S)
        self._reader.join(PATIENCE_S)
        if self.process.stderr is not None:
            self.process.stderr.close()
        return code

    def logged(self, **fields: Any) -> dict[str, Any]:
        """The log entry with these fields; waits for it, for the log is written behind the answers."""
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            for entry in list(self.log):
                if all(entry.get(name) == value for name, value in fields.items()):
                    return entry
            time.sleep(0.005)
        raise AssertionError(f"not logged: {fields}")

    # --- HTTP

    def request(self, method: str, target: str, body: Any = None, headers: dict[str, str] | None = None) -> Answer:
        """One request on a connection of its own. A body that is no bytes is written as JSON; a body is JSON where nothing else is said."""
        sent = dict(headers or {})
        if self.token is not None and not {"Authorization", "Cookie"} & set(sent):
            sent["Authorization"] = f"Bearer {self.token}"
        if body is not None and not isinstance(body, bytes):
            body = json.dumps(body).encode()
        if body:
            sent.setdefault("Content-Type", "application/json")
        connection = http.client.HTTPConnection(self.host, self.port, timeout=self.patience_s)
        try:
            connection.request(method, target, body=body, headers=sent)
            response = connection.getresponse()
            fields = [(name.lower(), value) for name, value in response.getheaders()]
            assert len({name for name, _ in fields}) == len(fields), f"{method} {target}: a field comes twice in {fields}"
            answer = Answer(method, target, response.status, dict(fields), response.read())
        finally:
            connection.close()
        for check in self.checks:
            check(answer)
        return answer

    def get(self, target: str, **headers: str) -> Answer:
        return self.request("GET", target, headers={k.replace("_", "-"): v for k, v in headers.items()})

    def post(self, target: str, body: Any = None, headers: dict[str, str] | None = None) -> Answer:
        return self.request("POST", target, b"" if body is None else body, headers)

    def upload(self, content: bytes, headers: dict[str, str] | None = None, **query: str | float) -> Answer:
        """POST /v1/recordings with the metadata in the query; device and condition have defaults, `name=None` drops one."""
        given = {"device": "phone-07", "condition": "static", **query}
        pairs = [(name, str(value)) for name, value in given.items() if value is not None]
        target = "/v1/recordings?" + urllib.parse.urlencode(pairs)
        return self.post(target, content, {"Content-Type": "application/octet-stream", **(headers or {})})

    def upload_parts(self, *parts: tuple[str, bytes], target: str = "/v1/recordings", headers: dict[str, str] | None = None) -> Answer:
        body, content_type = multipart(*parts)
        return self.post(target, body, {"Content-Type": content_type, **(headers or {})})

    def characterise(self, *recordings: str, headers: dict[str, str] | None = None, **parameters: Any) -> Answer:
        request: dict[str, Any] = {"kind": "characterise", "inputs": {"recordings": list(recordings)}}
        if parameters:
            request["parameters"] = parameters
        return self.post("/v1/jobs", request, headers)

    def finished(self, job: str) -> dict[str, Any]:
        """The job once it is in a terminal state."""
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            document = self.get(f"/v1/jobs/{job}", Prefer="wait=20").json
            if document["finished_at"] is not None:
                return document
        raise AssertionError(f"the job does not end: {document}")

    def items(self, target: str) -> list[dict[str, Any]]:
        """Every item of a list, page by page."""
        found: list[dict[str, Any]] = []
        cursor = None
        while True:
            separator = "&" if "?" in target else "?"
            page = self.get(target + (f"{separator}cursor={cursor}" if cursor else "")).json
            found += page["items"]
            cursor = page["next_cursor"]
            if cursor is None:
                return found

    def connect(self) -> socket.socket:
        """A bare connection, for what no HTTP client would send."""
        return socket.create_connection((self.host, self.port), timeout=PATIENCE_S)

    def exchange(self, text: bytes) -> bytes:
        """Sends bytes as they are and reads until the daemon closes."""
        with self.connect() as connection:
            connection.sendall(text)
            return read_all(connection)

    # --- what lies in the store

    def rows(self, query: str, *values: str) -> list[list[Any]]:
        """Rows of the daemon's database, read beside it; values stand for the `?` of the query."""
        if STORE == "postgres":
            return postgres.cluster().rows(self.data, query, *values)
        database = sqlite3.connect(f"file:{self.data / 'driftlab.db'}?mode=ro", uri=True)
        try:
            return [list(row) for row in database.execute(query, values)]
        finally:
            database.close()

    def change(self, statement: str, *values: str) -> None:
        """Changes rows behind the daemon's back; values stand for the `?` of the statement."""
        if STORE == "postgres":
            postgres.cluster().change(self.data, statement, *values)
            return
        with contextlib.closing(sqlite3.connect(self.data / "driftlab.db")) as database, database:
            database.execute(statement, values)

    def database_bytes(self) -> bytes:
        """Everything that the database holds, as it lies on the disk or as a dump."""
        if STORE == "postgres":
            return postgres.cluster().dump(self.data)
        return b"".join(path.read_bytes() for path in self.data.glob("driftlab.db*"))

    # --- what lies on the disk

    def files(self, folder: str) -> list[str]:
        root = self.data / folder
        return sorted(path.relative_to(root).as_posix() for path in root.rglob("*") if path.is_file()) if root.is_dir() else []

    def traces(self) -> dict[str, Any]:
        """Everything an upload could leave behind."""
        return {"devices": [d["id"] for d in self.items("/v1/devices")],
                "recordings": [r["id"] for r in self.items("/v1/recordings")],
                **{folder: self.files(folder) for folder in ("blobs", "columns", "incoming")}}

    def memory_kib(self, name: str) -> int:
        """A line of /proc/PID/status, for example VmHWM."""
        status = Path(f"/proc/{self.process.pid}/status").read_text("ascii")
        found = re.search(rf"^{name}:\s+(\d+) kB", status, re.MULTILINE)
        assert found, name
        return int(found.group(1))

    def processor_s(self) -> float:
        """User and system time of all its threads so far, without the decoder's processes."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text("ascii").rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def read_all(connection: socket.socket) -> bytes:
    pieces = []
    while True:
        try:
            piece = connection.recv(65536)
        except ConnectionResetError:
            break
        if not piece:
            break
        pieces.append(piece)
    return b"".join(pieces)


def read_answer(connection: socket.socket, method: str = "GET", target: str = "") -> Answer:
    """One whole answer from a bare connection that may stay open."""
    raw = b""
    while b"\r\n\r\n" not in raw:
        piece = connection.recv(65536)
        assert piece, f"closed after {raw!r}"
        raw += piece
    wanted = int(parse_answer(raw).headers.get("content-length", 0)) + raw.index(b"\r\n\r\n") + 4
    while len(raw) < wanted:
        piece = connection.recv(wanted - len(raw))
        assert piece, f"closed after {raw!r}"
        raw += piece
    return parse_answer(raw, method, target)


def parse_answer(raw: bytes, method: str = "GET", target: str = "") -> Answer:
    """The first answer in bytes read from a bare connection."""
    head, _, rest = raw.partition(b"\r\n\r\n")
    lines = head.decode("latin-1").split("\r\n")
    if not lines or not lines[0].startswith("HTTP/1.1 "):
        raise AssertionError(f"no HTTP answer: {raw[:200]!r}")
    headers = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in lines[1:])}
    length = int(headers.get("content-length", len(rest)))
    return Answer(method, target, int(lines[0].split()[1]), headers, rest[:length])


def multipart(*parts: tuple[str, bytes], boundary: str = "a-boundary-of-the-tests") -> tuple[bytes, str]:
    body = b""
    for name, content in parts:
        file_name = '; filename="data"' if name == "file" else ""
        body += f'--{boundary}\r\nContent-Disposition: form-data; name="{name}"{file_name}\r\n\r\n'.encode() + content + b"\r\n"
    return body + f"--{boundary}--\r\n".encode(), f"multipart/form-data; boundary={boundary}"


@dataclass
class Event:
    id: int
    type: str
    data: dict[str, Any]


def events(daemon: Daemon, job: str, last: int | None = None) -> Iterator[Event]:
    """The server-sent events of a job until the stream closes."""
    connection = http.client.HTTPConnection(daemon.host, daemon.port, timeout=PATIENCE_S)
    try:
        connection.request("GET", f"/v1/jobs/{job}/events", headers={} if last is None else {"Last-Event-ID": str(last)})
        response = connection.getresponse()
        assert response.status == 200, response.read()
        assert response.getheader("Content-Type") == "text/event-stream", response.getheaders()
        fields: dict[str, str] = {}
        for raw in response:
            line = raw.decode().rstrip("\n")
            if line:
                name, _, value = line.partition(": ")
                fields[name] = value
            elif "data" in fields:
                yield Event(int(fields["id"]), fields["event"], json.loads(fields["data"]))
                fields = {}
            else:
                fields = {}  # a comment, or `retry`
    finally:
        connection.close()
