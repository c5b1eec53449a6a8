"""What was found: fits, parameter tables, trends, investigations and regression runs."""
from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, cast

from ..contract import Export, ExportTarget, Fit, GetImpliedCurvesAnswer, InvestigationSummary, Regression, RegressionRun
from ..contract import Investigation as InvestigationDocument
from ..contract import ParameterTable as ParameterTableDocument
from ..contract import Trends as TrendsDocument
from ..results import Investigation
from ..tables import ParameterTable, Trends
from ..transport import Query
from .base import PAGE, Routes, operation

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
                        model: str | None = None, wait_s: float | None = 30.0) -> ParameterTable:
        """Parameters of one sensor axis, a row per dynamic condition. Without `model`: the one that is best over all rows.

        `wait_s` is how long the daemon may wait until recordings of one condition are fitted jointly (`pooling` of the document).
        """
        query = {"device": device, "sensor": sensor, "axis": axis, "method": method, "model": model}
        return ParameterTable(cast(ParameterTableDocument, self._get("getParameterTable", None, query, wait_s)))

    def parameter_table_text(self, device: str, *, media: TableText = "text/plain", sensor: Sensor = "gyroscope", axis: Axis | None = None,
                             method: AnalysisMethod = "gmwm", model: str | None = None, wait_s: float | None = 30.0) -> str:
        """The same table as the daemon writes it: aligned text, CSV or Markdown."""
        query: Query = {"device": device, "sensor": sensor, "axis": axis, "method": method, "model": model}
        return self._text("getParameterTable", media, None, query, wait_s)

    @operation("getTrends")
    def trends(self, device: str, *, sensor: Sensor = "gyroscope", axis: Axis | None = None, method: AnalysisMethod = "gmwm",
               model: str | None = None, wait_s: float | None = 30.0) -> Trends:
        """How each parameter of that table moves with |rate| and |angular acceleration|."""
        query = {"device": device, "sensor": sensor, "axis": axis, "method": method, "model": model}
        return Trends(cast(TrendsDocument, self._get("getTrends", None, query, wait_s)))

    def trends_text(self, device: str, *, sensor: Sensor = "gyroscope", axis: Axis | None = None, method: AnalysisMethod = "gmwm",
                    model: str | None = None, wait_s: float | None = 30.0) -> str:
        """The same trends as the daemon writes them."""
        query: Query = {"device": device, "sensor": sensor, "axis": axis, "method": method, "model": model}
        return self._text("getTrends", "text/plain", None, query, wait_s)

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
                       page_size: int = PAGE) -> Iterator[InvestigationSummary]:
        """Investigations with their findings, without the reports."""
        return self._list("listInvestigations", {"device": device, "study": study, "job": job}, page_size)

    @operation("getInvestigation")
    def investigation(self, id: str) -> Investigation:
        """One report."""
        return Investigation(cast(InvestigationDocument, self._get("getInvestigation", {"id": id})))

    def investigation_markdown(self, id: str) -> str:
        """One report as a page for people."""
        return self._text("getInvestigation", "text/markdown", {"id": id})

    @operation("listRegressions")
    def regressions(self, *, page_size: int = PAGE) -> Iterator[RegressionRun]:
        """Regression runs with their verdicts, oldest first. A run is a job of kind `regress`."""
        return self._list("listRegressions", {}, page_size)

    @operation("getRegression")
    def regression(self, id: str) -> Regression:
        """One run with every test."""
        return cast(Regression, self._get("getRegression", {"id": id}))
