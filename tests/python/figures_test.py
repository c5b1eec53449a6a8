"""What notebooks show: sound markup whatever the data are called, and figures that are true to scale."""
from __future__ import annotations

import re
import sys
import types
import unittest
import xml.etree.ElementTree
from html.parser import HTMLParser
from typing import Any
from unittest import mock

import numpy

from driftlab import Calibration, Channel, Characterisation, Curve, Investigation, OutageEvaluation, ParameterTable, Trends, arrays
from driftlab.html import estimate, number
from driftlab.tables import Frame

HOSTILE = '<script>alert("1")</script>&\x00\x1b\ud800\'"><img src=x onerror=alert(1)>'
SVG = "{http://www.w3.org/2000/svg}"


def curve(**members: Any) -> Curve:
    tau = 0.01 * 2.0 ** numpy.arange(14)
    deviation = 0.1 / numpy.sqrt(tau)
    given = {"kind": "Allan", "of": "rest, gz", "tau_s": tau, "deviation": deviation, "low": 0.9 * deviation, "high": 1.1 * deviation,
             "unit": "deg/s", **members}
    return Curve(**given)


def hostile(node: Any) -> Any:
    """The document with every text in it replaced by a hostile one, but for the words that the client looks up."""
    if isinstance(node, dict):
        return {key: value if key in ("method", "change") else hostile(value) for key, value in node.items()}
    if isinstance(node, list):
        return [hostile(value) for value in node]
    return HOSTILE if isinstance(node, str) else node


class Tags(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.seen: set[str] = set()
        self.attributes: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.add(tag)
        self.attributes |= {name for name, _ in attrs}


QUANTITY: Any = {"value": 1.036, "unit": "deg/sqrt(h)", "ci95": [1.031, None]}
FIT = {"model": "WN", "robust": False, "processes": [{"process": "white_noise", "params": {"N": QUANTITY}}], "objective": 1.0, "wic": 1.0,
       "j_test": None, "status": "converged", "warnings": []}
CHANNEL = {"channel": "gz [deg/s]", "quantity": "angular_rate", "axis": "z", "unit": "deg/s", "samples": 9, "dt_s": 0.01, "mean": None,
           "allan": {"tau_s": [0.01, 0.02, 0.04], "deviation": [0.2, None, 0.1], "ci95": [[0.1, 0.3], [None, None], [None, 0.2]]},
           "haar": {"scale": [2, 4], "variance": [0.04, None], "ci95": [[0.03, 0.05], [0.01, None]]},
           "allan_parameters": {
               "N": QUANTITY, "B": None, "K": None, "Q": None, "R": None, "reasons": {"B": "No flicker."}},
           "fits": [FIT], "best": 0, "warnings": ["Short."]}
TABLE = {"device": "phone-07", "sensor": "gyroscope", "axis": "z", "method": "gmwm", "model": "WN",
         "columns": [{"key": "white_noise.N", "unit": "deg/sqrt(h)"}, {"key": "random_walk.K", "unit": None}],
         "rows": [{"condition": {"kind": "static"}, "label": "static", "recordings": ["a"], "robust": True,
                   "reasons": {"random_walk.K": "None."},
                   "values": {"white_noise.N": {**QUANTITY, "change": "up"}, "random_walk.K": None}}]}
TRENDS = {"device": "phone-07", "sensor": "gyroscope", "axis": "z", "method": "gmwm", "model": "WN", "trends": [
    {"parameter": "N", "unit": "deg/sqrt(h)", "against": {"kind": "rate", "unit": "deg/s"}, "points": [], "left_out": [],
     "equal": {"statistic": 1.0, "dof": 1, "p": 0.3}, "monotone": {"statistic": 1.0, "p": 0.3, "direction": "none", "few": True},
     "relation": {"kind": "constant", "formula": "1", "low": 1, "high": 1, "exponent": 1, "scale": 1, "spread": 0, "aicc": 1},
     "statement": "No change shown."}]}
INVESTIGATION = {"study": "rest", "checks": [], "unexplained": [{"channel": "gz", "explanation": "Unknown.", "checks": []}],
                 "gain": {"checks_failed_before": 2, "checks_failed_after": 1}, "findings": [
                     {"cause": "temperature_bias", "status": "identified", "channels": ["gz"], "explanation": "It warms up.",
                      "gain": {"log_score_per_sample": 0.1}}],
                 "figures": [{"channel": "gx", "wavelet": {"scale_s": [0.5]}},
                             {"channel": "gz", "unit": "deg/s", "wavelet": {"scale_s": [0.02, 0.04]}}]}
OUTAGES = {"runs": 2, "seed": 1, "claims": [{"claim": "c", "supported": False, "because": "b"}],
           "filters": [{"name": "matched", "states": 9, "mean_error_m": QUANTITY, "nees": 2, "coverage95": 0.9}]}
CALIBRATION = {"accelerometer": {"apply": {"reading_unit": "g", "bias": [0, 0, 0], "correction": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]},
                                 "bias": {"x": QUANTITY}}, "notes": ["Six positions."]}
CHARACTERISATION = {"study": None, "recordings": [{"id": "rest", "condition": {"kind": "static"}, "duration_s": 1.0, "rate_hz": 100,
                                                   "quality": {"notes": ["A gap."]}, "channels": [CHANNEL]}]}
SHOWN: list[tuple[Any, Any]] = [
    (ParameterTable, TABLE), (Trends, TRENDS), (Investigation, INVESTIGATION), (OutageEvaluation, OUTAGES), (Calibration, CALIBRATION),
    (Characterisation, CHARACTERISATION), (lambda document: Channel(document, HOSTILE), CHANNEL)]


class Markup(unittest.TestCase):
    def test_no_text_of_the_data_becomes_markup(self) -> None:
        for make, document in SHOWN:
            with self.subTest(document=list(document)):
                shown = make(hostile(document))._repr_html_()
                tags = Tags()
                tags.feed(shown)
                self.assertEqual(tags.seen & {"script", "img"}, set(), shown)
                self.assertFalse({name for name in tags.attributes if name.startswith("on")} | tags.attributes & {"src", "style"}, shown)
                self.assertIn("&lt;script&gt;", shown)
                self.assertNotIn("\x00", shown)
                shown.encode()

    def test_a_hostile_figure_is_well_formed_and_holds_only_shapes(self) -> None:
        root = xml.etree.ElementTree.fromstring(curve(of=HOSTILE, unit=HOSTILE, kind=HOSTILE)._repr_svg_())
        shapes = {element.tag.removeprefix(SVG) for element in root.iter()}
        self.assertEqual(shapes, {"svg", "title", "desc", "rect", "path", "circle", "text"})

    def test_tables_show_what_there_is(self) -> None:
        for make, document in SHOWN:
            shown = make(document)._repr_html_()
            self.assertIn("<table>", shown)
            self.assertNotIn("None", shown)
            self.assertNotIn("nan", shown)
        shown = ParameterTable(TABLE)._repr_html_()  # type: ignore[arg-type]
        for part in ("phone-07, gyroscope z, GMWM, model WN",
                     "white_noise.N [deg/sqrt(h)]", "1.036 [1.031, …] ↑", "static*", "from robust"):
            self.assertIn(part, shown)

    def test_a_table_that_will_change_says_so(self) -> None:
        pending: Any = {**TABLE, "pooling": {"state": "pending", "job": "/v1/jobs/job_x", "reason": None}}
        self.assertIn("is pending", ParameterTable(pending)._repr_html_())
        self.assertEqual((ParameterTable(pending).pooling, ParameterTable(TABLE).pooling), ("pending", "done"))  # type: ignore[arg-type]

    def test_numbers_are_written_as_the_command_line_does(self) -> None:
        written = [number(x) for x in (1.0364, 160.38, 0.0, 1e-5, 123456.0, float("nan"), None, 7, "word")]
        self.assertEqual(written, ["1.036", "160.4", "0", "1.000e-05", "1.235e+05", "…", "…", "7", "word"])
        self.assertEqual(estimate(None), "…")


class Figures(unittest.TestCase):
    def test_decades_are_equal_so_that_a_half_looks_like_a_half(self) -> None:
        root = xml.etree.ElementTree.fromstring(curve()._repr_svg_())
        points = [(float(c.get("cx", "")), float(c.get("cy", ""))) for c in root.iter(SVG + "circle")]
        self.assertEqual(len(points), 14)
        (x0, y0), (x1, y1) = points[0], points[-1]
        self.assertAlmostEqual((y1 - y0) / (x1 - x0), 0.5, delta=0.002)  # pixels grow downwards; a tenth of a pixel is written

    def test_a_figure_has_title_units_and_band(self) -> None:
        shown = curve()._repr_svg_()
        for part in ("<title>Allan deviation of rest, gz</title>",
                     "deviation [deg/s]", "averaging time τ [s]", "95 % intervals", 'fill-opacity="0.14"'):
            self.assertIn(part, shown)

    def test_curves_over_each_other_are_told_apart(self) -> None:
        root = xml.etree.ElementTree.fromstring(curve().svg(curve(of="table, gz")))
        texts = [element.text for element in root.iter(SVG + "text")]
        self.assertIn("rest, gz", texts)
        self.assertIn("table, gz", texts)
        self.assertEqual(len({element.get("stroke-dasharray") for element in root.iter(SVG + "path")} - {None}), 2)
        with self.assertRaisesRegex(ValueError, "share no axis"):
            curve().svg(curve(unit="mg"))

    def test_what_cannot_be_drawn_is_left_out(self) -> None:
        nothing = numpy.full(14, numpy.nan)
        for deviation in (nothing, numpy.zeros(14), numpy.full(14, numpy.inf)):
            shown = curve(deviation=deviation, low=nothing, high=nothing)._repr_svg_()
            self.assertNotIn("<circle", shown)
            self.assertIsNone(re.search(r"\b(nan|inf)\b", shown))
        low = numpy.zeros(14)
        shown = curve(low=low, high=numpy.full(14, numpy.inf))._repr_svg_()
        self.assertIsNone(re.search(r"\b(nan|inf)\b", shown))
        self.assertIsNone(re.search(r"\b(nan|inf)\b", Channel(CHANNEL, "rest").allan._repr_svg_()))  # type: ignore[arg-type]


class Rows(unittest.TestCase):
    def test_a_quantity_is_four_cells(self) -> None:
        row = ParameterTable(TABLE).rows()[0]  # type: ignore[arg-type]
        self.assertEqual({key: row[key] for key in row if key.startswith("white")}, {
            "white_noise.N": 1.036, "white_noise.N.unit": "deg/sqrt(h)", "white_noise.N.low": 1.031, "white_noise.N.high": None})
        self.assertIsNone(row["random_walk.K"])
        self.assertEqual(Channel(CHANNEL, "rest").rows()[1]["reason"], "No flicker.")  # type: ignore[arg-type]

    def test_a_pandas_frame_is_made_where_pandas_is(self) -> None:
        stand_in = types.ModuleType("pandas")
        setattr(stand_in, "DataFrame", lambda rows: ("frame", rows))
        table = ParameterTable(TABLE)  # type: ignore[arg-type]
        with mock.patch.dict(sys.modules, {"pandas": stand_in}):
            self.assertEqual(table.to_pandas(), ("frame", table.rows()))
        with mock.patch.dict(sys.modules, {"pandas": None}), self.assertRaisesRegex(ImportError, r"rows\(\) gives a list of dict"):
            table.to_pandas()
        self.assertTrue(issubclass(Channel, Frame))

    def test_every_list_of_numbers_is_an_array_by_its_path(self) -> None:
        found = arrays({"a": {"b": [1, None]}, "c": [{"d": [2.5]}, {"d": []}], "e": ["x"], "f": 1})
        self.assertEqual(list(found), ["a.b", "c.0.d"])
        numpy.testing.assert_array_equal(found["a.b"], [1.0, numpy.nan])
        report = Investigation(INVESTIGATION)  # type: ignore[arg-type]
        numpy.testing.assert_array_equal(report.series("temperature_bias")["wavelet.scale_s"], [0.02, 0.04])
        with self.assertRaisesRegex(KeyError, "temperature_bias was"):
            report.series("vibration")

    def test_open_ends_of_intervals_are_zero_and_infinity(self) -> None:
        allan = Channel(CHANNEL, "rest").allan  # type: ignore[arg-type]
        numpy.testing.assert_array_equal(allan.low, [0.1, 0.0, 0.0])
        numpy.testing.assert_array_equal(allan.high, [0.3, numpy.inf, 0.2])
        numpy.testing.assert_array_equal(numpy.isnan(allan.deviation), [False, True, False])
        self.assertEqual((allan.of, allan.unit), ("rest, gz", "deg/s"))


if __name__ == "__main__":
    unittest.main()
