"""What every result that is a table can do: rows as dicts, a pandas frame where pandas is there, a page for a notebook."""
from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any, Protocol, Union

from . import html
from .contract import ParameterTable as ParameterTableDocument
from .contract import Trends as TrendsDocument

Cell = Union[str, int, float, bool, None]
Row = dict[str, Cell]
ARROWS = {"up": " ↑", "down": " ↓"}


class HasRows(Protocol):
    def rows(self) -> list[Row]: ...


class Frame:
    """For results with rows()."""

    def to_pandas(self: HasRows) -> Any:
        """The rows as a pandas DataFrame; ImportError with a sentence where pandas is not installed."""
        try:
            pandas = importlib.import_module("pandas")
        except ImportError as error:
            raise ImportError("to_pandas() needs pandas, which is not installed; rows() gives a list of dict without it.") from error
        return pandas.DataFrame(self.rows())


def split(row: Row, key: str, quantity: Mapping[str, Any] | None, unit: str | None = None) -> None:
    """A quantity as four cells of a row: key, its unit, and the ends of its 95 % interval."""
    low, high = quantity["ci95"] if quantity else (None, None)
    row.update({key: quantity["value"] if quantity else None, f"{key}.unit": quantity["unit"] if quantity else unit,
                f"{key}.low": low, f"{key}.high": high})


class ParameterTable(Frame):
    """One sensor axis of a device: a row per dynamic condition, a column per parameter. `document` is the answer as it came."""

    def __init__(self, document: ParameterTableDocument) -> None:
        self.document = document

    @property
    def title(self) -> str:
        head = self.document
        words = [head["device"], " ".join(word for word in (head["sensor"], head["axis"]) if word),
                 {"gmwm": "GMWM", "av": "Allan variance"}[head["method"]]]
        return ", ".join([*words, *([f"model {head['model']}"] if head["model"] else [])])

    @property
    def pooling(self) -> str:
        """pending while a job still fits replicates jointly, and the table will change; failed where it could not; else done."""
        members: dict[str, Any] = {**self.document}
        return str(members.get("pooling", {}).get("state", "done"))

    @property
    def columns(self) -> list[str]:
        return [column["key"] for column in self.document["columns"]]

    def rows(self) -> list[Row]:
        """A dict per condition: `condition`, `contamination`, `robust`, and for each parameter `key`, `key.unit`, `key.low`, `key.high`.

        A parameter that the data do not identify is None.
        """
        found = []
        for row in self.document["rows"]:
            made: Row = {"condition": row["label"], "recordings": len(row["recordings"]), "contamination": row.get("contamination"),
                         "robust": row.get("robust", False)}
            for column in self.document["columns"]:
                split(made, column["key"], row["values"].get(column["key"]), column["unit"])
            found.append(made)
        return found

    def value(self, condition: str, key: str) -> float | None:
        """One parameter under one condition; KeyError where the table has no such row or column."""
        for row in self.rows():
            if row["condition"] == condition:
                found = row[key]
                assert not isinstance(found, str)
                return found
        raise KeyError(condition)

    def _repr_html_(self) -> str:
        head = ["condition", *(f"{column['key']} [{column['unit'] or '?'}]" for column in self.document["columns"])]
        rows = []
        for row in self.document["rows"]:
            cells = [row["values"].get(key) for key in self.columns]
            changes = [ARROWS.get(cell["change"] or "", "") if cell else "" for cell in cells]
            label = row["label"] + ("*" if row.get("robust") else "")
            rows.append([label, *(html.estimate(cell) + change for cell, change in zip(cells, changes))])
        notes = ["value [95 % interval]; … not identifiable; ↑ ↓ changed against the first row"]
        if any(row.get("robust") for row in self.document["rows"]):
            notes.append("* gross errors: from robust variances")
        if self.pooling != "done":
            notes.append(f"The joint fit of replicates is {self.pooling}: they are averaged.")
        return html.table(head, rows, self.title, notes)


class Trends(Frame):
    """How each parameter of one sensor axis moves with |rate| and |angular acceleration|."""

    def __init__(self, document: TrendsDocument) -> None:
        self.document = document

    def rows(self) -> list[Row]:
        """A dict per parameter and magnitude: direction, p, relation and the sentence that says it."""
        return [{"parameter": trend["parameter"], "unit": trend["unit"], "against": trend["against"]["kind"],
                 "direction": trend["monotone"]["direction"], "p": trend["monotone"]["p"], "equal_p": trend["equal"]["p"],
                 "relation": trend["relation"]["formula"], "statement": trend["statement"]} for trend in self.document["trends"]]

    def _repr_html_(self) -> str:
        head = self.document
        title = f"{head['device']}, {head['sensor']} {head['axis'] or ''}: parameters against the motion"
        keys = ["parameter", "unit", "against", "direction", "p", "relation", "statement"]
        return html.table(keys, [[row[key] for key in keys] for row in self.rows()], title)
