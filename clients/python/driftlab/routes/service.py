"""Health, contract and documentation."""
from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal, cast

from ..contract import (Attention, Backup, ContractAnswer, GetCountsAnswer, GetWorkersAnswer, HealthAnswer, ListDocumentationAnswer,
                        ReadinessAnswer)
from .base import PAGE, Routes, Sort, operation


class ServiceRoutes(Routes):
    @operation("frontPage")
    def front_page(self) -> str:
        """The page a person sees first, as HTML."""
        return self._text("frontPage", "text/html")

    @operation("health")
    def health(self) -> HealthAnswer:
        """The process answers; its version."""
        return cast(HealthAnswer, self._get("health"))

    @operation("readiness")
    def readiness(self) -> ReadinessAnswer:
        """The daemon can take work; Unavailable at once, without retries, where it cannot."""
        return cast(ReadinessAnswer, self._transport.call("readiness", retries=False).json)

    @operation("metrics")
    def metrics(self) -> str:
        """What the daemon counts, in the text format of Prometheus."""
        return self._text("metrics", "text/plain")

    @operation("getCounts")
    def counts(self, *, since: str | None = None, include: Literal["attention"] | None = None) -> GetCountsAnswer:
        """How many devices and recordings there are, and jobs that live; with `since` (RFC 3339) jobs that ended from then on, with
        `include` also the newest results that must be read first."""
        return cast(GetCountsAnswer, self._get("getCounts", None, {"since": since, "include": include}))

    @operation("getWorkers")
    def workers(self) -> GetWorkersAnswer:
        """How many jobs run at a time, in all processes that have the store."""
        return cast(GetWorkersAnswer, self._get("getWorkers"))

    @operation("listAttention")
    def attention(self, *, device: str | None = None, since: str | None = None, sort: Sort | None = None,
                  page_size: int = PAGE) -> Iterator[Attention]:
        """Results whose verdict is not fine, newest first unless sorted otherwise."""
        return self._list("listAttention", {"device": device, "since": since, "sort": sort}, page_size)

    @operation("listBackups")
    def backups(self, *, sort: Sort | None = None, page_size: int = PAGE) -> Iterator[Backup]:
        """Those that the daemon has made since it started, and complete ones of its directory."""
        return self._list("listBackups", {"sort": sort}, page_size)

    @operation("createBackup")
    def create_backup(self, *, idempotency_key: str | None = None) -> Backup:
        """Begins a backup, or names the one that is being made; `backups` says how it ended."""
        return cast(Backup, self._post("createBackup", None, idempotency_key))

    @operation("contract")
    def contract(self) -> ContractAnswer:
        """The daemon's own OpenAPI document."""
        return cast(ContractAnswer, self._get("contract"))

    @operation("getSchema")
    def schema(self, name: str) -> dict[str, Any]:
        """A JSON Schema that the contract refers to, for example recording.schema.json."""
        return cast("dict[str, Any]", self._transport.call("getSchema", {"name": name}).json)

    @operation("listDocumentation")
    def documentation(self) -> ListDocumentationAnswer:
        """The pages of the manual and of the problem types."""
        return cast(ListDocumentationAnswer, self._get("listDocumentation"))

    @operation("getDocumentation")
    def documentation_page(self, page: str) -> str:
        """A page of the manual as Markdown."""
        return self._text("getDocumentation", "text/markdown", {"page": page})

    @operation("getProblemType")
    def problem_type(self, slug: str) -> str:
        """What a problem type means and what to do about it, as Markdown; `slug` is the last part of a problem's `type`."""
        return self._text("getProblemType", "text/markdown", {"slug": slug})
