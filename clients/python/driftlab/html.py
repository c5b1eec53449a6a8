"""Tables for notebooks. Everything that comes from data is escaped; no text of a recording becomes markup."""
from __future__ import annotations

import html
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff\ud800-\udfff]")
MISSING = "…"  # as in the tables of the command line: not identifiable


def text(value: object) -> str:
    """Anything as text that is safe between tags and in attributes, in HTML and in SVG."""
    return html.escape(CONTROL.sub("\ufffd", str(value)), quote=True)


def number(value: object) -> str:
    """Text as it is, a float with four significant digits as the tables of the command line have it, `…` for what there is not."""
    if value is None or isinstance(value, float) and not math.isfinite(value):
        return MISSING
    if not isinstance(value, float):
        return str(value)
    size = abs(value)
    if size and not 1e-3 <= size < 1e5:
        return f"{value:.3e}"
    return f"{value:.{min(6, max(0, 3 - math.floor(math.log10(size)))) if size else 0}f}"


def estimate(quantity: Mapping[str, Any] | None) -> str:
    """value [low, high] of a quantity document, without its unit."""
    if quantity is None:
        return MISSING
    low, high = (number(None if end is None else float(end)) for end in quantity["ci95"])
    return f"{number(float(quantity['value']))} [{low}, {high}]"


def table(head: Sequence[object], rows: Iterable[Sequence[object]], caption: str = "", notes: Sequence[str] = ()) -> str:
    """A plain table: no style, no script. Cells are text, numbers or None."""
    lines = ["<table>"]
    if caption:
        lines.append(f"<caption>{text(caption)}</caption>")
    lines.append("<thead><tr>" + "".join(f'<th scope="col">{text(cell)}</th>' for cell in head) + "</tr></thead>")
    lines.append("<tbody>")
    lines += ["<tr>" + "".join(f"<td>{text(number(cell))}</td>" for cell in row) + "</tr>" for row in rows]
    lines.append("</tbody></table>")
    lines += [f"<p>{text(note)}</p>" for note in notes]
    return "\n".join(lines)
