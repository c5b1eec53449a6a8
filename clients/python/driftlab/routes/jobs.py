"""Jobs, and evaluations of outages and drives, which are jobs of their own kinds."""
from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, cast

from ..contract import Characterisation, DriveEvaluation, DriveEvaluationResource, DriveEvaluationSummary
from ..contract import Investigation, Job, JobEvent, JobRequest, JobState
from ..contract import NewDriveEvaluation, NewOutageEvaluation, OutageEvaluation, OutageEvaluationResource, OutageEvaluationSummary
from .base import PAGE, Routes, Sort, operation


class JobRoutes(Routes):
    @operation("listJobs")
    def jobs(self, *, kind: str | None = None, state: JobState | None = None, device: str | None = None, sort: Sort | None = None,
             page_size: int = PAGE) -> Iterator[Job]:
        """Jobs, oldest first unless sorted otherwise; with `device` those that name it, or something of it."""
        return self._list("listJobs", {"kind": kind, "state": state, "device": device, "sort": sort}, page_size)

    @operation("createJob")
    def create_job(self, request: JobRequest, *, wait_s: float | None = None, idempotency_key: str | None = None) -> Job:
        """Queues a job, or gives the same one that lives or has succeeded already; `wait_s` where the daemon takes that wish here."""
        return cast(Job, self._post("createJob", request, idempotency_key, wait_s=wait_s))

    @operation("getJob")
    def job(self, id: str, *, wait_s: float | None = None) -> Job:
        """One job; with `wait_s` (at most 60) once it has ended, or after that time."""
        return cast(Job, self._get("getJob", {"id": id}, wait_s=wait_s))

    @operation("getJobResult")
    def job_result(self, id: str) -> Characterisation | OutageEvaluation | DriveEvaluation | Investigation:
        """What a job found, of the shape of its kind; NotFound until it has succeeded."""
        return cast("Characterisation | OutageEvaluation | DriveEvaluation | Investigation", self._get("getJobResult", {"id": id}))

    @operation("cancelJob")
    def cancel_job(self, id: str, *, idempotency_key: str | None = None) -> Job:
        """Asks a job to stop."""
        return cast(Job, self._post("cancelJob", None, idempotency_key, {"id": id}))

    @operation("streamJobEvents")
    def job_events(self, id: str, *, last_event_id: int | None = None) -> Iterator[tuple[int, JobEvent]]:
        """(number, event) from the first on, or from after `last_event_id`, until the job has ended. Not resumed by itself."""
        number, data = -1, ""
        headers = {} if last_event_id is None else {"Last-Event-ID": str(last_event_id)}
        for line in self._transport.lines("streamJobEvents", {"id": id}, headers):
            name, _, value = line.partition(":")
            if name == "id":
                number = int(value)
            elif name == "data":
                data += value.removeprefix(" ")
            elif not line and data:
                yield number, cast(JobEvent, json.loads(data))
                data = ""

    @operation("streamEvents")
    def events(self, *, topics: str | None = None, last_event_id: str | None = None) -> Iterator[tuple[str, str, dict[str, Any]]]:
        """(id, type, data) of everything that happens from now on, or from after `last_event_id`; `reset` says that some are lost."""
        id, kind, data = "", "", ""
        headers = {} if last_event_id is None else {"Last-Event-ID": last_event_id}
        for line in self._transport.lines("streamEvents", None, headers, {"topics": topics}):
            name, _, value = line.partition(":")
            if name == "id":
                id = value.strip()
            elif name == "event":
                kind = value.strip()
            elif name == "data":
                data += value.removeprefix(" ")
            elif not line and data:
                yield id, kind, json.loads(data)
                data = ""

    @operation("listOutageEvaluations")
    def outage_evaluations(self, *, state: JobState | None = None, q: str | None = None, since: str | None = None,
                           sort: Sort | None = None, page_size: int = PAGE) -> Iterator[OutageEvaluationSummary]:
        """Outage evaluations, oldest first unless sorted otherwise, without their results; `q` is part of the scenario's name."""
        return self._list("listOutageEvaluations", {"state": state, "q": q, "since": since, "sort": sort}, page_size)

    @operation("createOutageEvaluation")
    def create_outage_evaluation(self, request: NewOutageEvaluation, *, wait_s: float | None = None,
                                 idempotency_key: str | None = None) -> OutageEvaluationResource:
        """Queues the comparison of filters through simulated outages; the same request is the same evaluation."""
        return cast(OutageEvaluationResource, self._post("createOutageEvaluation", request, idempotency_key, wait_s=wait_s))

    @operation("getOutageEvaluation")
    def outage_evaluation(self, id: str, *, wait_s: float | None = None) -> OutageEvaluationResource:
        """One evaluation; its member `evaluation` is None until its job has succeeded."""
        return cast(OutageEvaluationResource, self._get("getOutageEvaluation", {"id": id}, wait_s=wait_s))

    @operation("listDriveEvaluations")
    def drive_evaluations(self, *, state: JobState | None = None, page_size: int = PAGE) -> Iterator[DriveEvaluationSummary]:
        """Drive evaluations, oldest first, without their results."""
        return self._list("listDriveEvaluations", {"state": state}, page_size)

    @operation("createDriveEvaluation")
    def create_drive_evaluation(self, request: NewDriveEvaluation, *, wait_s: float | None = None,
                                idempotency_key: str | None = None) -> DriveEvaluationResource:
        """Asks a stored drive: measure its outages, simulate them beside it, explain the difference, or compare models."""
        return cast(DriveEvaluationResource, self._post("createDriveEvaluation", request, idempotency_key, wait_s=wait_s))

    @operation("getDriveEvaluation")
    def drive_evaluation(self, id: str, *, wait_s: float | None = None) -> DriveEvaluationResource:
        """One evaluation; its member `evaluation` is None until its job has succeeded."""
        return cast(DriveEvaluationResource, self._get("getDriveEvaluation", {"id": id}, wait_s=wait_s))
