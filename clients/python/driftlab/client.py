"""The client: every route of the daemon, and the few calls that put routes together."""
from __future__ import annotations

import os
import ssl
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Literal, cast

from .contract import Calibration as CalibrationDocument
from .contract import Characterisation as CharacterisationDocument
from .contract import Investigation as InvestigationDocument
from .contract import Job, JobRequest, NewOutageEvaluation, OutageScenario, StudyBaseline
from .contract import OutageEvaluation as OutageEvaluationDocument
from .problems import JobCancelled, problem_of
from .results import Calibration, Characterisation, Investigation, OutageEvaluation
from .routes.access import AccessRoutes
from .routes.base import given
from .routes.jobs import JobRoutes
from .routes.recordings import RecordingRoutes
from .routes.results import ResultRoutes
from .routes.service import ServiceRoutes
from .routes.studies import StudyRoutes
from .routes.webhooks import WebhookRoutes
from .transport import Retry, Transport

PIECE_S = 20.0  # the daemon is asked to wait this long at a time
JobProgress = Callable[[float, str], None]  # fraction done, what is being done


class Client(ServiceRoutes, RecordingRoutes, JobRoutes, ResultRoutes, StudyRoutes, AccessRoutes, WebhookRoutes):
    """A daemon at an address, for example Client("http://127.0.0.1:8477").

    Where the daemon asks for a token, it is `token`, or what the file `token_file` holds, or DRIFTLAB_TOKEN of the environment.
    Every failure is a Problem. Lost connections, 429 and 503 are retried with growing pauses; every POST carries an
    Idempotency-Key, so that nothing is done twice. An object may be used by several threads: it holds no connection.
    """

    def __init__(self, server: str = "http://127.0.0.1:8477", token: str | None = None, *,
                 token_file: str | os.PathLike[str] | None = None, timeout_s: float = 60.0, retry: Retry | None = None,
                 tls: ssl.SSLContext | None = None) -> None:
        if token is None and token_file is not None:
            token = Path(token_file).read_text("utf-8").strip()
        if token is None:
            token = os.environ.get("DRIFTLAB_TOKEN") or None
        super().__init__(Transport(server, token, timeout_s, retry or Retry(), tls))

    def __repr__(self) -> str:
        return f"Client({self._transport.server!r})"

    def wait(self, job: str | Job, *, timeout_s: float | None = None, progress: JobProgress | None = None) -> Job:
        """The job once it has succeeded. Its problem is raised where it failed, JobCancelled where it was cancelled, and TimeoutError
        after `timeout_s`; the job then goes on. `progress` is called about once a second with the fraction done and the stage."""
        id = job if isinstance(job, str) else job["id"]
        until = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            left = PIECE_S if until is None else max(0.0, until - time.monotonic())
            found = self.job(id, wait_s=min(left, 1.0 if progress else PIECE_S))
            if progress is not None:
                progress(found["progress"], found["stage"] or found["state"])
            if found["state"] == "succeeded":
                return found
            if found["state"] == "cancelled":
                raise JobCancelled(f"The job {id} was cancelled.", code="cancelled")
            if found["finished_at"] is not None:
                raise problem_of({"detail": f"The job {id} has {found['state']}.", **(found["problem"] or {})}, 500)
            if until is not None and time.monotonic() >= until:
                raise TimeoutError(f"The job {id} has not ended after {timeout_s} s; it goes on.")

    def _result(self, request: dict[str, Any], timeout_s: float | None, progress: JobProgress | None) -> Any:
        job = self.wait(self.create_job(cast(JobRequest, request)), timeout_s=timeout_s, progress=progress)
        return self.job_result(job["id"])

    def characterise(self, *recordings: str, study: str | None = None, models: Sequence[str] | None = None, seed: int | None = None,
                     search: Literal["listed", "stepwise"] | None = None, bootstrap: int | None = None, dynamic: int | None = None,
                     also: Sequence[Literal["total", "theo1", "psd"]] | None = None, taus: int | None = None,
                     priority: int | None = None, timeout_s: float | None = None, progress: JobProgress | None = None) -> Characterisation:
        """Characterises uploaded recordings, or those of a study, and waits for the result."""
        parameters = given(models=None if models is None else list(models), seed=seed, search=search, bootstrap=bootstrap,
                           dynamic=dynamic, also=None if also is None else list(also), taus=taus)
        inputs = given(recordings=list(recordings) or None, study=study)
        request = given(kind="characterise", inputs=inputs, parameters=parameters or None, priority=priority)
        return Characterisation(cast(CharacterisationDocument, self._result(request, timeout_s, progress)))

    def investigate(self, study: str, *, baseline: StudyBaseline | None = None, priority: int | None = None,
                    timeout_s: float | None = None, progress: JobProgress | None = None) -> Investigation:
        """Asks what the baseline of a study gets wrong, and waits for the report."""
        parameters = given(baseline=baseline)
        request = given(kind="investigate", inputs={"study": study}, parameters=parameters or None, priority=priority)
        return Investigation(cast(InvestigationDocument, self._result(request, timeout_s, progress)))

    def outages(self, scenario: str | OutageScenario = "paper", *, runs: int | None = None, seed: int | None = None,
                relative_precision: float | None = None, priority: int | None = None, timeout_s: float | None = None,
                progress: JobProgress | None = None) -> OutageEvaluation:
        """Compares filters through simulated outages, and waits for the result."""
        request = given(scenario=scenario, runs=runs, seed=seed, relative_precision=relative_precision, priority=priority)
        queued = self.create_outage_evaluation(cast(NewOutageEvaluation, request))
        job = self.wait(queued["id"], timeout_s=timeout_s, progress=progress)
        return OutageEvaluation(cast(OutageEvaluationDocument, self.job_result(job["id"])))

    def calibrate(self, device: str, recordings: Sequence[str], *, gravity_m_s2: float | None = None,
                  misalignment: bool | None = None) -> Calibration:
        """Calibrates from uploaded recordings; the result's `id` is what a recording's metadata name."""
        made: CalibrationDocument = self.create_calibration(device, recordings=recordings, gravity_m_s2=gravity_m_s2,
                                                            misalignment=misalignment)
        return Calibration(made["calibration"], made["id"])
