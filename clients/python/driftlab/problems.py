"""Everything that can go wrong, as exceptions: a problem document (RFC 9457) of the daemon, or a sentence of the command line."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class Problem(Exception):
    """What failed and why. `str()` is the sentence; the members are those of the problem document.

    status      HTTP status; 0 where no answer came at all
    code        names the kind of problem in one word: `not_found`, `ragged_row`, ...
    detail      one sentence about this case
    errors      each fault of a body, with `pointer`, `code` and `detail`
    where       what is at fault: row, column, parameter, ...
    request_id  finds the request in the daemon's log; empty without one
    retryable   whether the same request may succeed later
    retry_after seconds after which to ask again, where the daemon said so
    """

    def __init__(self, detail: str, *, status: int = 0, code: str = "unknown", title: str = "", type: str = "",
                 errors: list[dict[str, str]] | None = None, where: Mapping[str, str | int] | None = None, request_id: str = "",
                 retryable: bool = False, retry_after: float | None = None) -> None:
        super().__init__(detail)
        self.detail, self.status, self.code, self.title, self.type = detail, status, code, title, type
        self.errors, self.where = list(errors or []), dict(where or {})
        self.request_id, self.retryable, self.retry_after = request_id, retryable, retry_after

    def __str__(self) -> str:
        faults = [f"{fault.get('pointer') or '/'}: {fault.get('detail', '')}" for fault in self.errors]
        return "\n  ".join([self.detail, *(fault for fault in faults if not fault.endswith(self.detail))])


class ClientProblem(Problem):
    """4xx: the request is at fault; sent again as it is, it fails again."""


class InvalidInput(ClientProblem):
    """400, 411, 413, 415, 422: a file, a body or a parameter is not what it has to be. Also exit code 2 of the command line."""


class Forbidden(ClientProblem):
    """401 and 403."""


class NotFound(ClientProblem):
    """404."""


class Conflict(ClientProblem):
    """409, 412, 428: it contradicts what is stored, or what is stored has changed."""


class ServerProblem(Problem):
    """5xx: the daemon, or the machine it runs on, could not do it."""


class Unavailable(ServerProblem):
    """429 and 503, and no answer at all (status 0), after every retry."""


class JobCancelled(Problem):
    """The job was cancelled before it ended."""


CLASSES: dict[int, type[Problem]] = {
    0: Unavailable, 400: InvalidInput, 401: Forbidden, 403: Forbidden, 404: NotFound, 409: Conflict, 411: InvalidInput, 412: Conflict,
    413: InvalidInput, 415: InvalidInput, 422: InvalidInput, 428: Conflict, 429: Unavailable, 503: Unavailable}


def class_of(status: int) -> type[Problem]:
    """The exception for a status, by its number or else by its class."""
    return CLASSES.get(status, ClientProblem if status < 500 else ServerProblem)


def problem_of(document: Mapping[str, Any], status: int, *, retry_after: float | None = None) -> Problem:
    """The exception for a problem document; members it lacks, as those of a job's problem do, are filled in."""
    status = int(document.get("status", status))
    return class_of(status)(
        str(document.get("detail") or document.get("title") or f"The daemon answered {status}."), status=status,
        code=str(document.get("code", "unknown")), title=str(document.get("title", "")), type=str(document.get("type", "")),
        errors=document.get("errors"), where=document.get("where"), request_id=str(document.get("request_id", "")),
        retryable=bool(document.get("retryable", status in (429, 503))), retry_after=retry_after)
