"""A receiver of webhooks, written from the text of Standard Webhooks 1.0 and not from the daemon: it believes no message
whose signature it did not compute itself, and answers as a test wants it to."""
from __future__ import annotations

import base64
import hashlib
import hmac
import json
import ssl
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

PATIENCE_S = 60.0
TOLERANCE_S = 300


def signatures(secret: str, identity: str, timestamp: str, body: bytes) -> str:
    key = base64.b64decode(secret.removeprefix("whsec_"), validate=True)
    content = b".".join((identity.encode(), timestamp.encode(), body))
    return "v1," + base64.b64encode(hmac.new(key, content, hashlib.sha256).digest()).decode()


@dataclass
class Message:
    id: str
    path: str
    headers: dict[str, str]
    body: bytes
    at: float = field(default_factory=time.monotonic)

    @property
    def document(self) -> dict[str, Any]:
        return dict(json.loads(self.body))

    def verify(self, *secrets: str) -> None:
        """Every secret has signed this, and nothing else has."""
        timestamp = self.headers["webhook-timestamp"]
        assert abs(time.time() - int(timestamp)) < TOLERANCE_S, timestamp
        expected = {signatures(secret, self.id, timestamp, self.body) for secret in secrets}
        assert set(self.headers["webhook-signature"].split(" ")) == expected, self.headers


Answer = tuple[int, dict[str, str]]


class Receiver:
    """Answers each message with the next of `answers`, which may be a function of it; then with 204."""

    def __init__(self, *answers: Answer | Callable[[Message], Answer], chain: tuple[str, str] | None = None) -> None:
        self.messages: list[Message] = []
        self._answers = list(answers)
        self._changed = threading.Condition()
        receiver = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:  # noqa: N802
                body = self.rfile.read(int(self.headers["Content-Length"]))
                headers = {name.lower(): value for name, value in self.headers.items()}
                receiver._answer(self, Message(headers.get("webhook-id", ""), self.path, headers, body))

            do_GET = do_POST

            def log_message(self, *unused: object) -> None:
                pass

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.server.handle_error = lambda *unused: None  # type: ignore[method-assign]  # connections that end are expected
        if chain is not None:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(*chain)
            self.server.socket = context.wrap_socket(self.server.socket, server_side=True)
        self.url = f"http{'s' if chain else ''}://127.0.0.1:{self.server.server_port}/hook"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def _answer(self, handler: BaseHTTPRequestHandler, message: Message) -> None:
        with self._changed:
            self.messages.append(message)
            answer = self._answers.pop(0) if self._answers else (204, {})
            self._changed.notify_all()
        status, headers = answer(message) if callable(answer) else answer
        handler.send_response(status)
        for name, value in {"Content-Length": "0", **headers}.items():
            handler.send_header(name, value)
        handler.end_headers()

    def wait(self, count: int) -> list[Message]:
        """The messages once there are so many."""
        with self._changed:
            assert self._changed.wait_for(lambda: len(self.messages) >= count, PATIENCE_S), f"{len(self.messages)} of {count} messages came"
            return list(self.messages)

    def __enter__(self) -> Receiver:
        return self

    def __exit__(self, *unused: object) -> None:
        self.server.shutdown()
        self.server.server_close()
