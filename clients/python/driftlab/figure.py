"""The log-log figure of variances: points with their 95 % band, decades of one length on both axes, so that -1/2 looks like -1/2.

A string of SVG and nothing else: no library, no script, no style sheet; every text is escaped.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy

from .html import text

Numbers = numpy.ndarray[Any, numpy.dtype[numpy.float64]]

INK, FAINT, HALO = "#1a1a1a", "#d8d8d8", "#ffffff"
COLOURS = ("#1a1a1a", "#1f6fb2", "#b07a17", "#5a7d2a", "#8a4f9e", "#b3402f")  # order, then dash, carry the meaning
DASHES = ("", "7 4", "2 3.5", "10 3 2 3", "4 4", "1 3")
LEFT, TOP, BOTTOM, KEYS = 64, 46, 40, 150
WIDEST, HIGHEST = 420, 330
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Line:
    """One curve with its band; what is not above 0 is not drawn."""

    name: str
    x: Numbers
    y: Numbers
    low: Numbers
    high: Numbers


@dataclass(frozen=True)
class Scale:
    """Decades of data -> pixels; both axes share the length of a decade."""

    left: float
    bottom: float
    x0: int
    x1: int
    y0: int
    y1: int
    decade: float

    @staticmethod
    def around(lines: Sequence[Line]) -> Scale:
        x0, x1 = decades(numpy.concatenate([line.x for line in lines]))
        y0, y1 = decades(numpy.concatenate([values for line in lines for values in (line.y, line.low, line.high)]))
        decade = min(WIDEST / (x1 - x0), HIGHEST / (y1 - y0), 110.0)
        return Scale(LEFT, TOP + decade * (y1 - y0), x0, x1, y0, y1, decade)

    @property
    def right(self) -> float:
        return self.left + self.decade * (self.x1 - self.x0)

    @property
    def top(self) -> float:
        return self.bottom - self.decade * (self.y1 - self.y0)

    def x(self, value: float) -> float:
        return self.left + self.decade * (math.log10(value) - self.x0)

    def y(self, value: float) -> float:
        """An end of an interval at 0 or without bound is drawn at the edge of the frame."""
        exponent = math.log10(value) if value > 0 and math.isfinite(value) else float(self.y1 if value == math.inf else self.y0)
        return self.bottom - self.decade * (min(max(exponent, self.y0), self.y1) - self.y0)


def decades(values: Numbers) -> tuple[int, int]:
    """Whole decades around what can be drawn; one at least."""
    good = values[numpy.isfinite(values) & (values > 0)]
    if good.size == 0:
        return 0, 1
    low, high = math.floor(math.log10(good.min())), math.ceil(math.log10(good.max()))
    return low, max(high, low + 1)


def log_log(title: str, x_name: str, y_name: str, lines: Sequence[Line]) -> str:
    """The figure as one <svg> element. `x_name` and `y_name` carry their units."""
    scale = Scale.around(lines)
    width, height = scale.right + KEYS, scale.bottom + BOTTOM
    described = f"{title}: {y_name} against {x_name}, {', '.join(line.name for line in lines)}, with 95 % intervals"
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}"'
             f' height="{height:.0f}" font-family="sans-serif" font-size="11" fill="{INK}">',
             f"<title>{text(title)}</title>", f"<desc>{text(described)}</desc>",
             f'<rect width="{width:.0f}" height="{height:.0f}" fill="{HALO}"/>',
             f'<text x="{LEFT - 52}" y="16" font-size="13">{text(title)}</text>', *grid(scale)]
    for number, line in enumerate(lines):
        parts += curve(scale, line, number)
    parts += keys(scale, lines)
    parts += [f'<text x="{LEFT - 52}" y="{TOP - 12}">{text(y_name)}</text>',
              f'<text x="{scale.right:.1f}" y="{scale.bottom + 33:.1f}" text-anchor="end">{text(x_name)}</text>', "</svg>"]
    return "\n".join(parts)


def grid(scale: Scale) -> list[str]:
    """Decades as hairlines with their powers of ten, minor ticks inside, axes left and below."""
    parts = []
    for power in range(scale.x0, scale.x1 + 1):
        x = scale.x(10.0 ** power)
        parts.append(f'<path d="M{x:.1f} {scale.bottom:.1f}V{scale.top:.1f}" stroke="{FAINT}" stroke-width="0.5"/>')
        parts.append(f'<text x="{x:.1f}" y="{scale.bottom + 15:.1f}" text-anchor="middle">{power_text(power)}</text>')
    for power in range(scale.y0, scale.y1 + 1):
        y = scale.y(10.0 ** power)
        parts.append(f'<path d="M{scale.left:.1f} {y:.1f}H{scale.right:.1f}" stroke="{FAINT}" stroke-width="0.5"/>')
        parts.append(f'<text x="{scale.left - 6:.1f}" y="{y + 4:.1f}" text-anchor="end">{power_text(power)}</text>')
    minor = [f"M{scale.x(m * 10.0 ** p):.1f} {scale.bottom:.1f}v-3" for p in range(scale.x0, scale.x1) for m in range(2, 10)]
    minor += [f"M{scale.left:.1f} {scale.y(m * 10.0 ** p):.1f}h3" for p in range(scale.y0, scale.y1) for m in range(2, 10)]
    parts.append(f'<path d="{"".join(minor)}" stroke="{INK}" stroke-width="0.5" fill="none"/>')
    parts.append(f'<path d="M{scale.left:.1f} {scale.top:.1f}V{scale.bottom:.1f}H{scale.right:.1f}" stroke="{INK}" fill="none"/>')
    return parts


def power_text(power: int) -> str:
    return "10" + str(power).translate(SUPERSCRIPTS)


def curve(scale: Scale, line: Line, number: int) -> list[str]:
    """Band, line and points of one curve; the band is open where an interval is."""
    colour, dash = COLOURS[number % len(COLOURS)], DASHES[number % len(DASHES)]
    good = numpy.isfinite(line.x) & numpy.isfinite(line.y) & (line.x > 0) & (line.y > 0)
    if not good.any():
        return []
    x = [scale.x(float(value)) for value in line.x[good]]
    y = [scale.y(float(value)) for value in line.y[good]]
    low = [scale.y(float(value)) for value in numpy.nan_to_num(line.low[good], nan=0.0)]
    high = [scale.y(float(value)) for value in numpy.nan_to_num(line.high[good], nan=math.inf)]
    around = [f"{a:.1f} {b:.1f}" for a, b in [*zip(x, low), *reversed([*zip(x, high)])]]
    along = [f"{a:.1f} {b:.1f}" for a, b in zip(x, y)]
    parts = [f'<path d="M{"L".join(around)}Z" fill="{colour}" fill-opacity="0.14" stroke="none"/>',
             f'<path d="M{"L".join(along)}" fill="none" stroke="{colour}" stroke-width="1.5" stroke-dasharray="{dash or "none"}"/>']
    inside = colour if number == 0 else HALO
    return parts + [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3.4" fill="{inside}" stroke="{colour}"/>' for a, b in zip(x, y)]


def keys(scale: Scale, lines: Sequence[Line]) -> list[str]:
    """The name of each curve at the right, at the height of its last point, none over another."""
    parts = []
    wanted = []
    for number, line in enumerate(lines):
        good = line.y[numpy.isfinite(line.y) & (line.y > 0)]
        if good.size:
            wanted.append((scale.y(float(good[-1])), number, line.name))
    above = -math.inf
    for y, number, name in sorted(wanted):
        above = max(y, above + 14)
        shown = name if len(name) <= 24 else name[:23] + "…"
        parts.append(f'<text x="{scale.right + 8:.1f}" y="{above + 4:.1f}" fill="{COLOURS[number % len(COLOURS)]}" stroke="{HALO}"'
                     f' stroke-width="3" paint-order="stroke">{text(shown)}</text>')
    return parts
