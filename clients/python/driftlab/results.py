"""Results as objects: `document` is what the daemon or the command line gave; arrays are NumPy, tables have rows()."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy

from . import figure, html
from .contract import CalibrationSensor, CalibrationSensors, CharacterisationChannel, CharacterisationRecording, FitModelFit
from .contract import Characterisation as CharacterisationDocument
from .contract import Investigation as InvestigationDocument
from .contract import InvestigationFinding
from .contract import OutageEvaluation as OutageEvaluationDocument
from .figure import Numbers
from .tables import Frame, Row, Trends, split


def array(values: list[Any]) -> Numbers:
    """A list of numbers as an array; null is NaN."""
    return numpy.array([numpy.nan if value is None else value for value in values], dtype=numpy.float64)


def ends(intervals: list[Any], count: int) -> tuple[Numbers, Numbers]:
    """Low and high ends of intervals; an open low end is 0, an open high end infinite, a missing interval NaN."""
    pairs = [interval if interval is not None else (numpy.nan, numpy.nan) for interval in intervals] or [(numpy.nan, numpy.nan)] * count
    return (array([0.0 if low is None else low for low, _ in pairs]), array([numpy.inf if high is None else high for _, high in pairs]))


def arrays(document: Any) -> dict[str, Numbers]:
    """Every list of numbers in a document as an array, under its path: `wavelet.scale_s`, `filters.0.outages.2.errors.north_m`, ..."""
    found: dict[str, Numbers] = {}

    def walk(node: Any, path: str) -> None:
        if isinstance(node, list) and node and all(value is None or isinstance(value, (int, float)) for value in node):
            found[path] = array(node)
        elif isinstance(node, (dict, list)):
            for key, value in node.items() if isinstance(node, dict) else enumerate(node):
                walk(value, f"{path}.{key}" if path else str(key))
    walk(document, "")
    return found


@dataclass(frozen=True, eq=False)
class Curve:
    """A deviation against averaging time with its 95 % interval, one array each; shown as a log-log figure in a notebook."""

    kind: str  # Allan, Haar wavelet
    of: str  # the recording and the channel
    tau_s: Numbers
    deviation: Numbers
    low: Numbers
    high: Numbers
    unit: str

    def svg(self, *others: Curve) -> str:
        """The figure as SVG, with other curves of the same unit over it."""
        for other in others:
            if other.unit != self.unit:
                raise ValueError(f"The curve of {other.of} is in {other.unit}, that of {self.of} in {self.unit}: they share no axis.")
        curves = (self, *others)
        kinds, subjects = {curve.kind for curve in curves}, {curve.of for curve in curves}
        title = " of ".join([f"{self.kind} deviation" if len(kinds) == 1 else "Deviations", *([self.of] if len(subjects) == 1 else [])])
        lines = []
        for c in curves:
            name = ", ".join([*([c.of] if len(subjects) > 1 else []), *([c.kind] if len(kinds) > 1 or len(curves) == 1 else [])])
            lines.append(figure.Line(name or c.kind, c.tau_s, c.deviation, c.low, c.high))
        return figure.log_log(title, "averaging time τ [s]", f"deviation [{self.unit}]", lines)

    def _repr_svg_(self) -> str:
        return self.svg()


class Channel(Frame):
    """One channel of a characterised recording: variances, coefficients and models."""

    def __init__(self, document: CharacterisationChannel, recording: str) -> None:
        self.document, self.recording = document, recording
        self.name, self.unit, self.axis, self.quantity = document["channel"], document["unit"], document["axis"], document["quantity"]

    @property
    def title(self) -> str:
        """The recording and the column, whose unit stands at the axis."""
        return f"{self.recording}, {self.name.partition(' [')[0]}"

    @property
    def allan(self) -> Curve:
        """The overlapping Allan deviation at octaves."""
        found = self.document["allan"]
        low, high = ends(found["ci95"], len(found["tau_s"]))
        return Curve("Allan", self.title, array(found["tau_s"]), array(found["deviation"]), low, high, self.unit)

    @property
    def haar(self) -> Curve:
        """The Haar wavelet deviation, the root of the variance; its averaging time is half the length of the filter."""
        found = self.document["haar"]
        low, high = ends(found["ci95"], len(found["scale"]))
        tau = array(found["scale"]) * (0.5 * self.document["dt_s"])
        return Curve("Haar wavelet", self.title, tau, numpy.sqrt(array(found["variance"])),
                     numpy.sqrt(low), numpy.sqrt(high), self.unit)

    @property
    def best(self) -> FitModelFit | None:
        """The model that the criterion ranks first; None where none could be fitted."""
        index = self.document["best"]
        return None if index is None else self.document["fits"][index]

    def rows(self) -> list[Row]:
        """A dict per parameter: those of IEEE Std 952 (method av), then those of the best model (method gmwm)."""
        found = []
        coefficients: dict[str, Any] = {**self.document["allan_parameters"]}
        best = self.best
        model = best["model"] if best else ""
        entries = [("av", "", key, coefficients[key], coefficients["reasons"].get(key)) for key in "NBKQR"]
        for process in best["processes"] if best else []:
            entries += [("gmwm", model, f"{process['process']}.{key}", value, process.get("reasons", {}).get(key))
                        for key, value in process["params"].items()]
        for method, model, key, value, reason in entries:
            row: Row = {"recording": self.recording, "channel": self.name, "method": method, "model": model, "parameter": key}
            split(row, "value", value)
            found.append({**row, "reason": reason})
        return found

    def _repr_html_(self) -> str:
        rows = [[row["parameter"], row["model"] or "IEEE Std 952", row["value.unit"], row["value"], row["value.low"], row["value.high"]]
                for row in self.rows() if row["value"] is not None]
        head = ["parameter", "model", "unit", "value", "95 % low", "95 % high"]
        return self.allan.svg() + "\n" + html.table(head, rows, self.title, self.document["warnings"])


class Characterisation(Frame):
    """Every channel of some recordings, characterised."""

    def __init__(self, document: CharacterisationDocument) -> None:
        self.document = document

    @property
    def recordings(self) -> list[CharacterisationRecording]:
        return self.document["recordings"]

    @property
    def channels(self) -> list[Channel]:
        return [Channel(channel, recording["id"]) for recording in self.recordings for channel in recording["channels"]]

    def channel(self, name: str | None = None, recording: str | None = None) -> Channel:
        """A channel by its column name, its name without the unit, or its axis; KeyError where none or several are meant."""
        found = [c for c in self.channels if name in (None, c.name, c.name.partition(" ")[0], c.axis) and recording in (None, c.recording)]
        if len(found) == 1:
            return found[0]
        there = ", ".join(f"{c.name} of {c.recording}" for c in self.channels)
        raise KeyError(f"{len(found)} channels are meant by {name!r}; there are {there}")

    @property
    def trends(self) -> list[Trends]:
        """How the parameters move with the dynamics, per sensor axis with two recordings or more."""
        return [Trends(document) for document in self.document.get("trends", [])]

    def rows(self) -> list[Row]:
        """The rows of every channel."""
        return [row for channel in self.channels for row in channel.rows()]

    def _repr_html_(self) -> str:
        rows = []
        for channel in self.channels:
            best = channel.best
            said = [f"{row['parameter']} {html.number(row['value'])} {row['value.unit']}" for row in channel.rows()
                    if row["method"] == "gmwm" and row["value"] is not None]
            rows.append([channel.recording, channel.name, channel.document["samples"], best["model"] if best else None, ", ".join(said)])
        notes = [f"{recording['id']}: {note}" for recording in self.recordings for note in recording["quality"]["notes"]]
        return html.table(["recording", "channel", "samples", "best model", "its parameters"], rows, "Characterisation", notes)


class Investigation(Frame):
    """What a simulation gets wrong about the recordings of a study, and why."""

    def __init__(self, document: InvestigationDocument) -> None:
        self.document = document

    @property
    def findings(self) -> list[InvestigationFinding]:
        return self.document["findings"]

    def series(self, cause: str) -> dict[str, Numbers]:
        """The arrays of the figures of a finding's channel: measured and simulated `allan.…`, `wavelet.…`, `spectrum.…`, `course.…`."""
        for finding in self.findings:
            if finding["cause"] == cause:
                columns = [channel.rpartition("/")[2] for channel in finding["channels"]]
                return arrays(next((f for f in self.document.get("figures", []) if f["channel"] in columns), {}))
        raise KeyError(f"{cause!r} was not found; {', '.join(f['cause'] for f in self.findings) or 'nothing'} was.")

    def rows(self) -> list[Row]:
        """A dict per finding: cause, status, channels, the sentence, and its gain on samples it was not fitted to [nat per sample]."""
        return [{"cause": f["cause"], "status": f["status"], "channels": ", ".join(f["channels"]), "explanation": f["explanation"],
                 "gain": f["gain"]["log_score_per_sample"]} for f in self.findings]

    def _repr_html_(self) -> str:
        gain = self.document["gain"]
        failed = f"{gain['checks_failed_before']} before, {gain['checks_failed_after']} after, of {len(self.document['checks'])}"
        notes = [f"Checks failed: {failed}.",
                 *(f"Unexplained, {rest['channel']}: {rest['explanation']}" for rest in self.document["unexplained"])]
        if not self.findings:
            notes.insert(0, "Nothing was found that the baseline gets wrong.")
        rows = [[row["cause"], row["status"], row["channels"], row["gain"], row["explanation"]] for row in self.rows()]
        head = ["cause", "status", "channels", "gain [nat per sample]", "explanation"]
        return html.table(head, rows, f"Investigation of {self.document['study']}", notes)


class OutageEvaluation(Frame):
    """Filters compared through simulated GNSS outages."""

    def __init__(self, document: OutageEvaluationDocument) -> None:
        self.document = document

    def rows(self) -> list[Row]:
        """A dict per filter: mean horizontal error at the end of the outages [m] with its interval, NEES, coverage."""
        found = []
        for each in self.document["filters"]:
            row: Row = {"filter": each["name"], "states": each["states"]}
            split(row, "mean_error", {**each["mean_error_m"]})
            row["nees"], row["coverage95"] = each["nees"], each["coverage95"]
            found.append(row)
        return found

    def _repr_html_(self) -> str:
        rows = [[each["name"], html.estimate({**each["mean_error_m"]}), float(each["nees"]), float(each["coverage95"])]
                for each in self.document["filters"]]
        title = f"Simulated outages, {self.document['runs']} runs, seed {self.document['seed']}"
        claims = [f"{claim['claim']}: {'supported' if claim['supported'] else 'not supported'}, {claim['because']}"
                  for claim in self.document["claims"]]
        return html.table(["filter", "mean error [m]", "NEES (2 is right)", "share within 95 %"], rows, title, claims)


class Calibration(Frame):
    """Bias, scale factor and misalignment of a device's sensors, and the correction of readings by them."""

    def __init__(self, sensors: CalibrationSensors, id: str | None = None) -> None:
        self.document, self.id = sensors, id

    @property
    def sensors(self) -> dict[str, CalibrationSensor]:
        known = {"accelerometer": self.document.get("accelerometer"), "gyroscope": self.document.get("gyroscope")}
        return {name: sensor for name, sensor in known.items() if sensor is not None}

    def correct(self, sensor: str, readings: Numbers) -> Numbers:
        """True values [m/s^2 or rad/s] from readings in the calibration's `reading_unit`: rows are samples, columns x, y, z."""
        apply = self.sensors[sensor]["apply"]
        made: Numbers = (numpy.asarray(readings, dtype=numpy.float64) - array(apply["bias"])) @ numpy.array(apply["correction"]).T
        return made

    def rows(self) -> list[Row]:
        """A dict per number: sensor, what it is, axis, value, unit and interval."""
        found = []
        for name, sensor in self.sensors.items():
            for what in ("bias", "scale_factor", "misalignment", "correction"):
                estimates: dict[str, Any] = sensor.get(what) or {}  # type: ignore[assignment]
                for axis, value in estimates.items():
                    row: Row = {"sensor": name, "what": what, "axis": axis}
                    split(row, "value", value)
                    found.append(row)
        return found

    def _repr_html_(self) -> str:
        head = ["sensor", "what", "axis", "value.unit", "value", "value.low", "value.high"]
        return html.table(head, [[row[key] for key in head] for row in self.rows()], "Calibration", self.document.get("notes", []))
