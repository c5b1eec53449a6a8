"""HTTP with the daemon: one connection per request, retries that cannot do a thing twice, problems as exceptions."""
from __future__ import annotations

import email.utils
import http.client
import json
import random
import ssl
import time
import urllib.parse
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from .contract import OPERATIONS, Operation
from .problems import Problem, ServerProblem, Unavailable, problem_of

SLOWEST = 4e6  # bytes per second that a daemon needs at least to take and decode an upload
Query = Mapping[str, "str | int | float | bool | None"]


@dataclass
class Retry:
    """When a request is sent again: after a lost connection, 429, 503, and 409 of a request that is still running.

    The pause before attempt n+1 is drawn evenly from 0 to base_s 2^n, at most cap_s; `Retry-After` is added to it. A daemon that asks
    for more than patience_s is not waited for. sleep and generator are there for tests.
    """

    attempts: int = 6
    base_s: float = 0.25
    cap_s: float = 20.0
    patience_s: float = 120.0
    sleep: Callable[[float], None] = time.sleep
    generator: random.Random = field(default_factory=random.Random)

    def pause(self, attempt: int, retry_after: float | None) -> float:
        return float(retry_after or 0.0) + self.generator.uniform(0.0, min(self.cap_s, self.base_s * 2.0 ** attempt))


@dataclass(frozen=True)
class Body:
    """Bytes to send. `pieces` starts from the beginning at every call, so that a request can be sent again."""

    size: int
    media: str
    pieces: Callable[[], Iterable[bytes]]

    @staticmethod
    def of_json(document: object) -> Body:
        text = json.dumps(document, allow_nan=False).encode()
        return Body(len(text), "application/json", lambda: [text])


@dataclass(frozen=True)
class Answer:
    status: int
    headers: Mapping[str, str]  # names in lower case
    content: bytes

    @property
    def json(self) -> Any:
        try:
            return json.loads(self.content)
        except ValueError as error:
            raise ServerProblem("The answer is no JSON: is this the address of a driftlab daemon?", status=self.status,
                                code="not_json") from error


class Transport:
    def __init__(self, server: str, token: str | None, timeout: float, retry: Retry, tls: ssl.SSLContext | None) -> None:
        parts = urllib.parse.urlsplit(server)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError(f"{server!r} is no address of a daemon; one is http://127.0.0.1:8477")
        self.server = server.rstrip("/")
        self.timeout, self.retry = timeout, retry
        self._secure, self._host, self._port, self._base = parts.scheme == "https", parts.hostname, parts.port, parts.path.rstrip("/")
        self._token, self._tls = token, tls

    def call(self, operation: str, path: Mapping[str, str] | None = None, query: Query | None = None, body: Body | None = None, *,
             accept: str | None = None, if_match: str | None = None, idempotency_key: str | None = None, wait_s: float | None = None,
             headers: Mapping[str, str] | None = None, retries: bool = True) -> Answer:
        """One operation of the contract. Every POST carries an Idempotency-Key, so that a repetition is recognised.

        `wait_s` is sent as `Prefer: wait` where the operation takes it.
        """
        described = OPERATIONS[operation]
        sent = {"Accept": accept or ", ".join(described.media) or "*/*", **(headers or {})}
        if "Idempotency-Key" in described.headers:
            sent["Idempotency-Key"] = idempotency_key or uuid.uuid4().hex
        if if_match is not None:
            sent["If-Match"] = if_match
        patience = self.timeout + (body.size if body else 0) / SLOWEST
        if wait_s is not None and "Prefer" in described.headers:
            sent["Prefer"] = f"wait={max(0, round(wait_s))}"
            patience += wait_s
        return self._repeated(described, self.target(described, path, query), body, sent, patience, self.retry.attempts if retries else 1)

    def target(self, operation: Operation, path: Mapping[str, str] | None, query: Query | None) -> str:
        filled = operation.path
        for name, value in (path or {}).items():
            filled = filled.replace("{" + name + "}", urllib.parse.quote(value, safe=""))
        given = [(name, written(value)) for name, value in (query or {}).items() if value is not None]
        return self._base + filled + ("?" + urllib.parse.urlencode(given) if given else "")

    def _repeated(self, operation: Operation, target: str, body: Body | None, headers: Mapping[str, str], patience: float,
                  attempts: int) -> Answer:
        attempt = 0
        while True:
            try:
                return self._once(operation.method, target, body, headers, patience)
            except Problem as problem:
                attempt += 1
                # What a lost connection leaves unknown is safe to ask for again only where the daemon knows the request by its key.
                safe = operation.method in ("GET", "POST") or problem.code == "not_connected"
                lost = problem.status == 0 and problem.retryable and safe
                again = lost or problem.status in (429, 503) or (problem.status == 409 and problem.retryable)
                if not again or attempt >= attempts or (problem.retry_after or 0.0) > self.retry.patience_s:
                    raise
                self.retry.sleep(self.retry.pause(attempt - 1, problem.retry_after))

    def _connect(self, patience: float) -> http.client.HTTPConnection:
        connection = (http.client.HTTPSConnection(self._host, self._port, timeout=patience, context=self._tls) if self._secure
                      else http.client.HTTPConnection(self._host, self._port, timeout=patience))
        try:
            connection.connect()
        except OSError as error:
            raise self._unreachable(error, "not_connected") from error
        return connection

    def _unreachable(self, error: Exception, code: str) -> Unavailable:
        if isinstance(error, ssl.SSLCertVerificationError):
            return Unavailable(f"{self.server} shows a certificate that is not trusted: {error.verify_message}.", code="untrusted")
        said = str(error) or type(error).__name__
        return Unavailable(f"No answer from {self.server}: {said}. Is the daemon running there?", code=code, retryable=True)

    def _once(self, method: str, target: str, body: Body | None, headers: Mapping[str, str], patience: float) -> Answer:
        connection = self._connect(patience)
        try:
            response = self._exchange(connection, method, target, body, headers)
            answer = Answer(response.status, {name.lower(): value for name, value in response.getheaders()}, response.read())
        except (OSError, http.client.HTTPException) as error:
            raise self._unreachable(error, "connection_lost") from error
        finally:
            connection.close()
        return checked(answer)

    def _exchange(self, connection: http.client.HTTPConnection, method: str, target: str, body: Body | None,
                  headers: Mapping[str, str]) -> http.client.HTTPResponse:
        connection.putrequest(method, target, skip_accept_encoding=True)
        if self._token is not None:
            connection.putheader("Authorization", f"Bearer {self._token}")
        for name, value in headers.items():
            connection.putheader(name, value)
        if body is not None:
            connection.putheader("Content-Type", body.media)
        if body is not None or method == "POST":
            connection.putheader("Content-Length", str(body.size if body else 0))
        try:
            connection.endheaders()
            for piece in body.pieces() if body else ():
                connection.send(piece)
        except (BrokenPipeError, ConnectionResetError):
            pass  # the daemon may have answered, and closed, before it read everything: what it said is what counts
        return connection.getresponse()

    def lines(self, operation: str, path: Mapping[str, str] | None, headers: Mapping[str, str],
              query: Query | None = None) -> Iterator[str]:
        """The lines of an answer as they come, until the daemon closes."""
        described = OPERATIONS[operation]
        connection = self._connect(self.timeout)
        try:
            response = self._exchange(connection, described.method, self.target(described, path, query), None,
                                      {"Accept": ", ".join(described.media), **headers})
            if response.status >= 400:
                checked(Answer(response.status, {name.lower(): value for name, value in response.getheaders()}, response.read()))
            for line in response:
                yield line.decode().rstrip("\r\n")
        except (OSError, http.client.HTTPException) as error:
            raise self._unreachable(error, "connection_lost") from error
        finally:
            connection.close()


def written(value: str | int | float | bool) -> str:
    """A value of a query: true and false, numbers with all their digits."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def checked(answer: Answer) -> Answer:
    """The answer, or its problem document as an exception."""
    if answer.status < 400:
        return answer
    try:
        document = answer.json
    except ServerProblem:
        document = {}
    if not isinstance(document, dict):
        document = {}
    document.setdefault("request_id", answer.headers.get("x-request-id", ""))
    raise problem_of(document, answer.status, retry_after=seconds_of(answer.headers.get("retry-after")))


def seconds_of(retry_after: str | None) -> float | None:
    """Retry-After as seconds from now: a number, or a date (RFC 9110, 10.2.3)."""
    if retry_after is None:
        return None
    if retry_after.strip().isdigit():
        return float(retry_after)
    try:
        return max(0.0, email.utils.parsedate_to_datetime(retry_after).timestamp() - time.time())
    except ValueError:
        return None
