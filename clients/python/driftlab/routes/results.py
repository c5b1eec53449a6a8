"""What was found: fits, parameter tables, trends, investigations and regression runs."""
from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal, cast
from urllib.parse import quote

from ..contract import DataSheet, PooledSensorStructure, RegressionAnchor
from ..contract import Export, ExportTarget, Fit, GetImpliedCurvesAnswer, InvestigationSummary, Regression, RegressionRun
from ..contract import Investigation as InvestigationDocument
from ..contract import ParameterTable as ParameterTableDocument
from ..contract import Population as PopulationDocument
from ..contract import Trends as TrendsDocument
from ..results import Investigation
from ..tables import ParameterTable, Trends
from ..transport import Query
from .base import PAGE, Routes, Sort, operation

Sensor = Literal["gyroscope", "accelerometer"]
Axis = Literal["x", "y", "z"]
AnalysisMethod = Literal["gmwm", "av"]
TableText = Literal["text/csv", "text/plain", "text/markdown"]


class ResultRoutes(Routes):
    @operation("listFits")
    def fits(self, *, device: str | None = None, recording: str | None = None, job: str | None = None, quantity: str | None = None,
             axis: str | None = None, model: str | None = None, best: bool = False, page_size: int = PAGE) -> Iterator[Fit]:
        """Models fitted to channels; with `best` only the first of each channel."""
        return self._list("listFits", {"device": device, "recording": recording, "job": job, "quantity": quantity, "axis": axis,
                                       "model": model, "best": "true" if best else None}, page_size)

    @operation("getFit")
    def fit(self, id: str) -> Fit:
        """One fit."""
        return cast(Fit, self._get("getFit", {"id": id}))

    @operation("getImpliedCurves")
    def implied(self, id: str) -> GetImpliedCurvesAnswer:
        """Allan deviation and density that a fit implies, as a whole and process by process."""
        return cast(GetImpliedCurvesAnswer, self._get("getImpliedCurves", {"id": id}))

    @operation("getParameterTable")
    def parameter_table(self, device: str, *, sensor: Sensor = "gyroscope", axis: Axis | None = None, method: AnalysisMethod = "gmwm",
                        model: str | None = None, reference: str | None = None, wait_s: float | None = 30.0) -> ParameterTable:
        """Parameters of one sensor axis, a row per dynamic condition. Without `model`: the one that is best over all rows.

        Changes and ratios are against the first row, or that of the condition `reference`, for example static. `wait_s` is how long
        the daemon may wait until recordings of one condition are fitted jointly (`pooling` of the document).
        """
        query = {"device": device, "sensor": sensor, "axis": axis, "method": method, "model": model, "reference": reference}
        return ParameterTable(cast(ParameterTableDocument, self._get("getParameterTable", None, query, wait_s)))

    def parameter_tables(self, device: str, *, sensor: Sensor = "gyroscope", method: AnalysisMethod = "gmwm", model: str | None = None,
                         reference: str | None = None, wait_s: float | None = 30.0) -> list[ParameterTable]:
        """The same table of each axis that has results."""
        query: Query = {"device": device, "sensor": sensor, "axis": "all", "method": method, "model": model, "reference": reference}
        document = cast("dict[str, list[ParameterTableDocument]]", self._get("getParameterTable", None, query, wait_s))
        return [ParameterTable(table) for table in document["tables"]]

    def parameter_table_text(self, device: str, *, media: TableText | Literal["text/x-latex"] = "text/plain",
                             sensor: Sensor = "gyroscope", axis: Axis | Literal["all"] | None = None,
                             method: AnalysisMethod = "gmwm", model: str | None = None, reference: str | None = None,
                             wait_s: float | None = 30.0) -> str:
        """The same table as the daemon writes it: aligned text, CSV, Markdown or LaTeX (text/x-latex)."""
        query: Query = {"device": device, "sensor": sensor, "axis": axis, "method": method, "model": model, "reference": reference}
        return self._text("getParameterTable", media, None, query, wait_s)

    @operation("getStructure")
    def structure(self, *recordings: str | tuple[str, str]) -> PooledSensorStructure:
        """Whether two to eight recordings have one structure: ids, or ids with a channel, of which an id alone means the first."""
        asked = [(one, "") if isinstance(one, str) else one for one in recordings]
        of = ",".join(f"{id}:{quote(channel, safe='')}" if channel else id for id, channel in asked)
        return cast(PooledSensorStructure, self._get("getStructure", None, {"of": of}))

    @operation("getTrends")
    def trends(self, device: str, *, sensor: Sensor = "gyroscope", axis: Axis | None = None, method: AnalysisMethod = "gmwm",
               model: str | None = None, wait_s: float | None = 30.0) -> Trends:
        """How each parameter of that table moves with |rate| and |angular acceleration|."""
        query = {"device": device, "sensor": sensor, "axis": axis, "method": method, "model": model}
        return Trends(cast(TrendsDocument, self._get("getTrends", None, query, wait_s)))

    def trends_text(self, device: str, *, media: TableText = "text/plain", sensor: Sensor = "gyroscope", axis: Axis | None = None,
                    method: AnalysisMethod = "gmwm", model: str | None = None, wait_s: float | None = 30.0) -> str:
        """The same trends as the daemon writes them: lines, CSV or Markdown."""
        query: Query = {"device": device, "sensor": sensor, "axis": axis, "method": method, "model": model}
        return self._text("getTrends", media, None, query, wait_s)

    @operation("getPopulations")
    def population(self, model: str, *, sensor: Sensor | None = None) -> PopulationDocument:
        """All devices of a model: mean, spread, prediction, and which of them is not of the line."""
        return cast(PopulationDocument, self._get("getPopulations", None, {"model": model, "sensor": sensor}))

    def population_text(self, model: str, *, media: TableText = "text/plain", sensor: Sensor | None = None) -> str:
        """The same populations as the daemon writes them: lines, CSV or Markdown."""
        return self._text("getPopulations", media, None, {"model": model, "sensor": sensor})

    @operation("listDataSheets")
    def data_sheets(self, model: str | None = None) -> list[DataSheet]:
        """What manufacturers state of their sensors, with the source; with `model` of the sensors that this text names."""
        return cast("list[DataSheet]", self._get("listDataSheets", None, {"model": model})["items"])

    @operation("listExportTargets")
    def export_targets(self) -> list[ExportTarget]:
        """The programs whose files can be written, each with what its numbers mean."""
        return cast("list[ExportTarget]", self._get("listExportTargets")["items"])

    @operation("getExport")
    def export(self, target: str, device: str) -> Export:
        """Noise parameters of a device in the file of another program (`text`), and what of it is missing (`gaps`)."""
        return cast(Export, self._get("getExport", {"target": target}, {"device": device}))

    @operation("listInvestigations")
    def investigations(self, *, device: str | None = None, study: str | None = None, job: str | None = None,
                       q: str | None = None, since: str | None = None, sort: Sort | None = None,
                       page_size: int = PAGE) -> Iterator[InvestigationSummary]:
        """Investigations with their findings, without the reports; `q` is part of the device's name, the id or what was found."""
        query = {"device": device, "study": study, "job": job, "q": q, "since": since, "sort": sort}
        return self._list("listInvestigations", query, page_size)

    @operation("getInvestigation")
    def investigation(self, id: str) -> Investigation:
        """One report."""
        return Investigation(cast(InvestigationDocument, self._get("getInvestigation", {"id": id})))

    def investigation_markdown(self, id: str) -> str:
        """One report as a page for people."""
        return self._text("getInvestigation", "text/markdown", {"id": id})

    @operation("deleteInvestigation")
    def delete_investigation(self, id: str, *, if_match: str | None = None) -> None:
        """Deletes an investigation with its job; the models that it made stay."""
        self._transport.call("deleteInvestigation", {"id": id}, if_match=if_match)

    @operation("listRegressions")
    def regressions(self, *, device: str | None = None, label: str | None = None, parameter: str | None = None,
                    page_size: int = PAGE) -> Iterator[RegressionRun]:
        """Regression runs with their verdicts, oldest first; `label` is the candidate's. A run is a job of kind `regress`. With
        `parameter` each tells its tests of that one too."""
        return self._list("listRegressions", {"device": device, "label": label, "parameter": parameter}, page_size)

    @operation("getRegression")
    def regression(self, id: str) -> Regression:
        """One run with every test."""
        return cast(Regression, self._get("getRegression", {"id": id}))

    def regression_text(self, id: str, *, media: Literal["text/plain", "text/markdown"] = "text/plain") -> str:
        """The same run as text or as a page."""
        return self._text("getRegression", media, {"id": id})

    @operation("getRegressionJunit")
    def regression_junit(self, id: str, *, inconclusive: Literal["pass", "fail"] | None = None) -> str:
        """The same run as a JUnit report; with `pass` what is open is skipped, else an error."""
        return self._text("getRegressionJunit", "text/xml", {"id": id}, {"inconclusive": inconclusive})

    @operation("getRegressionFigure")
    def regression_figure(self, id: str) -> str:
        """Candidate over baseline against averaging time, as SVG."""
        return self._text("getRegressionFigure", "image/svg+xml", {"id": id})

    @operation("getRegressionBadge")
    def regression_badge(self, id: str) -> str:
        """The verdict as a badge, SVG of 20 px."""
        return self._text("getRegressionBadge", "image/svg+xml", {"id": id})

    @operation("listRegressionAnchors")
    def regression_anchors(self, *, device: str | None = None, page_size: int = PAGE) -> Iterator[RegressionAnchor]:
        """Each time an anchor was moved, oldest first; the newest of a device holds."""
        return self._list("listRegressionAnchors", {"device": device}, page_size)

    @operation("moveRegressionAnchor")
    def move_regression_anchor(self, device: str, label: str, reason: str, *, settings: dict[str, Any] | None = None,
                               idempotency_key: str | None = None) -> RegressionAnchor:
        """Runs of the device compare with this label from now on, with these margins, scope and alpha; left out: as before."""
        body: dict[str, Any] = {"device": device, "label": label, "reason": reason, **({} if settings is None else {"settings": settings})}
        return cast(RegressionAnchor, self._post("moveRegressionAnchor", body, idempotency_key))
