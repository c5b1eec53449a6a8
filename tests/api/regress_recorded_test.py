"""`driftlab regress` on recorded sessions in which nothing was changed, and with noise of one axis made larger.

Usage: regress_recorded_test.py [--table]      (--table prints the section of tests/ACCURACY.md and tests nothing)

The recordings of $DRIFTLAB_SHARED (default ../shared beside the repository) may not be committed; without them the suite is skipped.

What is a session here, and what is not. A session is one power-up. There are three long recordings of an ADIS16405, of 2.8 h each, and
each is taken for a session; whether one unit made them is not documented. Of each four segments of 900 s are used, 50 min from one
beginning to the next. Several segments of one recording are one session, and so:

- one against one takes segments of two recordings: two sessions. The 30 runs are of three pairs of sessions, five choices of segments each
  way, and no 30 independent runs.
- two against one (and one against two) takes all three sessions: the most that they hold of what moves from one power-up to the next.
- three against three is not to be had from three sessions. Another segment of the same three recordings stands in the other arm: what moves
  between power-ups is equal in both arms and cancels. Such runs pass more easily than those of six sessions would; they say something of
  the noise within a recording, of the sampling errors and of power, and nothing of wrong failures by scatter between sessions.
- segments of one recording that are given as one session count once, and those given as three sessions are the mistake that
  spec/regression.md warns of.

The other repeats at hand: four headings of a CXD5602 board, 30 s each, in one sitting (no power-ups between them). Of the MPU-6050 there is
one recording at rest, of other sensors one, or rests between moves, which are no replicates.
"""
from __future__ import annotations

import array
import collections
import functools
import itertools
import json
import lzma
import os
import random
import statistics
import struct
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from suite import SKIPPED

PROGRAM = os.environ.get("DRIFTLAB", "")
SHARED = Path(os.environ.get("DRIFTLAB_SHARED") or Path(__file__).resolve().parents[3] / "shared")
PATIENCE_S = 280

ADIS = [SHARED / f"data/adis_16405_imu{number}.npy.xz" for number in (1, 2, 3)]
HEADINGS = {degrees: SHARED / f"data/cxd5602pwbimu-8heading/log_imu_{degrees}deg.txt" for degrees in ("000", "090", "180", "270")}
COLUMNS = ",".join(f"{i}={'angular_rate' if i < 3 else 'specific_force'}:{'xyz'[i % 3]}:{'deg/s' if i < 3 else 'g'}" for i in range(6))
STEP_DEG_S = 0.05  # of the gyroscopes
ROWS = 90000  # 900 s
FIRST_ROW = {"A": 0, "B": 303000, "C": 606000, "D": 909000}
SESSIONS = "123"
PAIRS = list(itertools.permutations(SESSIONS, 2))

# As the specification's figures were measured: one look, and the noise alone, whatever samples are missing.
NOISE_ALONE = {"looks": 1, "event_limits": {"missing": 100}}


class Piece(NamedTuple):
    """900 s of a recording, with the noise of gyro x `factor` times as large, or a whole recording of the board."""
    recording: str
    segment: str = ""
    factor: float = 1.0

    @property
    def name(self) -> str:
        return f"{self.recording}{self.segment}" + ("" if self.factor == 1.0 else f"_x{self.factor:g}")


class Run(NamedTuple):
    baseline: list[Piece]
    candidate: list[Piece]
    one_session: bool = False  # the pieces of an arm are said to be of one session; else each is one


def pieces(recordings: Iterable[str], segments: Iterable[str], factor: float = 1.0) -> list[Piece]:
    return [Piece(recording, segment, factor) for recording, segment in itertools.product(recordings, segments)]


def one_against_one(segments: Iterable[tuple[str, str]], factor: float = 1.0) -> list[Run]:
    return [Run(pieces(before, s), pieces(after, t, factor)) for before, after in PAIRS for s, t in segments]


def three_against_three(segments: Iterable[tuple[str, str]], factor: float = 1.0) -> list[Run]:
    return [Run(pieces(SESSIONS, s), pieces(SESSIONS, t, factor)) for s, t in segments]


AROUND = [("A", "B"), ("B", "C"), ("C", "D"), ("D", "A")]
TO_B = [("A", "B"), ("C", "B"), ("D", "B")]
THREE = [("ABC", "BCD"), ("BCD", "ABC")]
TWO_AGAINST_ONE = [Run(pieces([r for r in SESSIONS if r != single], s), pieces(single, t)) for single in SESSIONS for s, t in AROUND]
ONE_SESSION = [Run(pieces(before, s), pieces(after, t), True) for before, after in PAIRS for s, t in THREE]
UNCHANGED = {
    "1 v 1": one_against_one([*AROUND, ("B", "D")]),
    "2 v 1, all three sessions": TWO_AGAINST_ONE,
    "1 v 2, all three sessions": [Run(run.candidate, run.baseline) for run in TWO_AGAINST_ONE],
    "3 v 3, the same power-ups in both arms": three_against_three(itertools.permutations(FIRST_ROW, 2)),
    "3 segments of one session v 3 of another, as one session each": ONE_SESSION,
    "the same as three sessions each, which they are not": [run._replace(one_session=False) for run in ONE_SESSION],
}
# Of the specification's six recordings: pass / inconclusive / fail.
ASKED = {"1 v 1": "3 / 97 / 0, 30 pairs of 6 sessions", "3 v 3, the same power-ups in both arms": "70 / 30 / 0, 20 splits of 6 sessions",
         "the same as three sessions each, which they are not": "40 / 40 / 20"}
LOUDER = {(plan, factor): runs for factor in (1.2, 1.5, 2.0)
          for plan, runs in (("1 v 1", one_against_one(TO_B if factor == 1.2 else TO_B[:1], factor)),
                             ("3 v 3, the same power-ups in both arms", three_against_three(TO_B, factor)))}
ASKED_FAILS = {("1 v 1", 1.2): 27, ("3 v 3, the same power-ups in both arms", 1.2): 90}
BOARD = [Run([Piece(h) for h in before], [Piece(h) for h in HEADINGS if h not in before]) for before in itertools.combinations(HEADINGS, 2)]


class Workshop:
    """The results of the pieces that are asked for, each characterised once, and the runs over them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def driftlab(self, *arguments: str) -> tuple[int, Any]:
        done = subprocess.run([PROGRAM, *arguments, "--json"], cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False,
                              stdin=subprocess.DEVNULL)
        assert done.returncode in (0, 1, 3), f"{arguments} ended with {done.returncode}: {done.stderr}"
        return done.returncode, json.loads(done.stdout)

    @functools.cache
    def segments(self, recording: str) -> dict[str, "array.array[float]"]:
        """Rows of six numbers."""
        raw = lzma.decompress(ADIS[int(recording) - 1].read_bytes())
        [length] = struct.unpack_from("<H", raw, 8)
        row = 6 * 8
        return {name: array.array("d", raw[10 + length + first * row:10 + length + (first + ROWS) * row]) for name, first in FIRST_ROW.items()}

    @functools.cache
    def result(self, piece: Piece) -> str:
        """The file of what `driftlab characterise --json` says of a piece."""
        if piece.recording in HEADINGS:
            said = self.driftlab("characterise", str(HEADINGS[piece.recording]), "--device", "board")
        else:
            values = self.segments(piece.recording)[piece.segment][:]
            if piece.factor != 1.0:
                values[0::6] = louder(values[0::6], piece.factor, f"{piece.recording}{piece.segment}")
            header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({ROWS}, 6), }}".encode()
            header += b" " * (63 - (10 + len(header)) % 64) + b"\n"
            file = self.folder / f"{piece.name}.npy"
            file.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + values.tobytes())
            said = self.driftlab("characterise", file.name, "--rate-hz", "100", "--columns", COLUMNS, "--device", "adis16405")
            file.unlink()
        name = f"{piece.name}.json"
        (self.folder / name).write_text(json.dumps(said[1]))
        return name

    def compared(self, run: Run, settings: dict[str, Any]) -> tuple[int, dict[str, Any]]:
        """The exit code and the document."""
        def arm(of: list[Piece]) -> dict[str, Any]:
            return {"recordings": [{"result": self.result(piece), "session": piece.recording if run.one_session else piece.name} for piece in of]}
        asked = {"device": {"id": "recorded"}, "baseline": arm(run.baseline), "candidate": arm(run.candidate), "settings": settings}
        (self.folder / "run.json").write_text(json.dumps(asked))
        code, document = self.driftlab("regress", "run.json")
        return code, dict(document)

    def all(self, runs: Iterable[Run], settings: dict[str, Any]) -> Iterator[tuple[Run, dict[str, Any]]]:
        for run in runs:
            code, document = self.compared(run, settings)
            assert code == {"pass": 0, "fail": 1, "inconclusive": 3}[document["verdict"]]
            yield run, document


def louder(values: "array.array[float]", factor: float, seed: str) -> "array.array[float]":
    """A channel whose noise about its mean is `factor` times as large, on the same lattice: the step of the values is no larger than
    before. What is within a step is drawn evenly, which adds 0.1 % to the deviation of these gyroscopes."""
    draw, mean = random.Random(seed), statistics.fmean(values)
    return array.array("d", [STEP_DEG_S * round((mean + factor * (value - mean + STEP_DEG_S * (draw.random() - 0.5))) / STEP_DEG_S)
                             for value in values])


def beyond(document: dict[str, Any]) -> set[str]:
    """The axes of which a test is shown to be beyond its margin."""
    return {f"{unit['sensor']} {unit['axis']}" for unit in document["units"] for test in unit["tests"] if test["verdict"] == "beyond"}


def failed_checks(document: dict[str, Any]) -> set[str]:
    return {finding["check"] for finding in document["findings"] if finding["verdict"] == "fail"}


def shares(verdicts: list[str]) -> str:
    return " / ".join(f"{100.0 * verdicts.count(verdict) / len(verdicts):.0f}" for verdict in ("pass", "inconclusive", "fail"))


class Recorded(unittest.TestCase):
    workshop: Workshop

    @classmethod
    def setUpClass(cls) -> None:
        cls.workshop = Workshop(Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-recorded-"))))

    def unchanged(self, name: str) -> list[str]:
        verdicts = []
        for run, document in self.workshop.all(UNCHANGED[name], NOISE_ALONE):
            self.assertEqual((beyond(document), failed_checks(document)), (set(), set()), f"{run}: {document['summary']['verdict']}")
            self.assertNotEqual(document["verdict"], "fail", run)
            verdicts.append(document["verdict"])
        print(f"{name}: {len(verdicts)} runs, {shares(verdicts)} %")
        return verdicts

    def test_one_unchanged_session_against_another_does_not_fail(self) -> None:
        self.assertIn("inconclusive", self.unchanged("1 v 1"), "one session an arm rests on the prior")

    def test_two_unchanged_sessions_against_the_third_do_not_fail(self) -> None:
        one, two = self.unchanged("2 v 1, all three sessions"), self.unchanged("1 v 2, all three sessions")
        self.assertIn("pass", one + two)

    def test_three_sessions_against_others_of_the_same_power_ups_pass(self) -> None:
        """What moves between power-ups cancels in these: a run that fails or stays open is one of the noise."""
        verdicts = self.unchanged("3 v 3, the same power-ups in both arms")
        self.assertGreaterEqual(verdicts.count("pass"), len(verdicts) / 2, "the specification's six sessions passed in 70 % of 20 splits")

    def test_segments_of_one_session_are_one_session(self) -> None:
        for run, document in self.workshop.all(ONE_SESSION, NOISE_ALONE):
            self.assertNotEqual(document["verdict"], "fail", run)
            for arm, of in (("baseline", run.baseline), ("candidate", run.candidate)):
                [session] = document["arms"][arm]["sessions"]
                self.assertEqual((session["session"], len(session["recordings"])), (of[0].recording, 3))
                self.assertEqual(document["arms"][arm]["merged"], [of[0].recording])
            self.assertEqual(document["between"]["contrasts"], 0, "no scatter between sessions is learnt from one")
        doubled = Run(pieces("1", "ACD"), [Piece("2", "B", 2.0), *pieces("2", "CD")], True)
        parts = Run(doubled.baseline, doubled.candidate[:1], True)
        [(_, of_one_part), (_, of_three)] = [(run, self.workshop.compared(run, NOISE_ALONE)[1]) for run in (parts, doubled)]
        self.assertEqual(beyond(of_one_part), {"gyroscope x"})
        self.assertLess(worst(of_three), worst(of_one_part), "a part of a session that is louder is averaged with the others")

    def test_a_louder_gyroscope_axis_fails_and_is_named(self) -> None:
        for (plan, factor), runs in LOUDER.items():
            verdicts = []
            for run, document in self.workshop.all(runs, NOISE_ALONE):
                with self.subTest(plan, factor=factor):
                    self.assertEqual(failed_checks(document), set(), "the lattice and the repeats are as before")
                    self.assertLessEqual(beyond(document), {"gyroscope x"}, run)
                    if factor > 1.2:
                        self.assertEqual((document["verdict"], beyond(document)), ("fail", {"gyroscope x"}), run)
                        self.assertRegex(document["summary"]["verdict"], r"^gyro x is worse: \+\d+ % \[\+\d+, \+\d+\]")
                        [first] = [test for unit in document["units"] if (unit["sensor"], unit["axis"]) == ("gyroscope", "x")
                                   for test in unit["tests"] if test.get("tau_s") == 0.01]
                        # The sessions are 3 % apart, the specification's prior scatter is 2 %.
                        self.assertAlmostEqual(first["ratio"] / factor, 1.0, delta=0.1)
                verdicts.append(document["verdict"])
            print(f"gyro x times {factor:g}, {plan}: {len(verdicts)} runs, {shares(verdicts)} %")

    def test_by_default_nothing_fails(self) -> None:
        """The noise of the accelerometers is about one step of their values: 24 to 38 % of the samples equal the one before by chance, and
        that share moves with the session. The check `repeated` failed 25 of all 30 runs by it."""
        verdicts = []
        for run, document in self.workshop.all(UNCHANGED["1 v 1"][::3], {}):
            self.assertEqual((beyond(document), failed_checks(document)), (set(), set()), run)
            verdicts.append(document["verdict"])
        self.assertNotIn("fail", verdicts)
        print(f"1 v 1, default settings: {len(verdicts)} runs, {shares(verdicts)} %")

    @unittest.skipUnless(all(path.is_file() for path in HEADINGS.values()), f"SKIPPED: the headings of the CXD5602, for they are not in {SHARED}")
    def test_the_noise_of_a_board_is_the_same_at_other_headings(self) -> None:
        verdicts = []
        for run, document in self.workshop.all(BOARD, NOISE_ALONE):
            self.assertEqual((beyond(document), failed_checks(document)), (set(), set()), run)
            verdicts.append(document["verdict"])
        self.assertNotIn("fail", verdicts)
        print(f"2 v 2 headings of 30 s: {len(verdicts)} runs, {shares(verdicts)} %")


def worst(document: dict[str, Any]) -> float:
    """The largest ratio of gyro x to 1 s."""
    return max(float(test["ratio"]) for unit in document["units"] if (unit["sensor"], unit["axis"]) == ("gyroscope", "x")
               for test in unit["tests"] if test.get("tau_s", 2.0) <= 1.0)


def table(workshop: Workshop) -> str:
    def measured(runs: list[Run], settings: dict[str, Any]) -> tuple[list[str], collections.Counter[str], collections.Counter[str]]:
        documents = [document for _, document in workshop.all(runs, settings)]
        return ([document["verdict"] for document in documents], collections.Counter(check for d in documents for check in failed_checks(d)),
                collections.Counter(axis for d in documents for axis in beyond(d)))

    lines = ["| nothing changed | runs | noise alone | specification | default settings | failed by then |", "|---|---|---|---|---|---|"]

    def row(name: str, runs: list[Run], alone: dict[str, Any]) -> None:
        verdicts, checks, axes = measured(runs, alone)
        by_default, default_checks, _ = measured(runs, {})
        noisy = "".join(f", {count} by {what}" for what, count in (checks + axes).items())
        why = ", ".join(f"{check} {count}" for check, count in sorted(default_checks.items()))
        lines.append(f"| {name} | {len(runs)} | {shares(verdicts)}{noisy} | {ASKED.get(name, '-')} | {shares(by_default)} | {why or '-'} |")
    for name, runs in UNCHANGED.items():
        row(name, runs, NOISE_ALONE)
    if all(path.is_file() for path in HEADINGS.values()):
        row("2 v 2 headings of the CXD5602 board, 30 s each", BOARD, NOISE_ALONE)
    lines += ["", "| gyro x of the candidate times | plan | runs | noise alone | axes beyond their margin | specification: fails |",
              "|---|---|---|---|---|---|"]
    for (plan, factor), runs in LOUDER.items():
        verdicts, _, axes = measured(runs, NOISE_ALONE)
        named = ", ".join(f"{axis} in {count}" for axis, count in sorted(axes.items()))
        lines.append(f"| {factor:g} | {plan} | {len(runs)} | {shares(verdicts)} | {named or '-'} | {ASKED_FAILS.get((plan, factor), 100)} % |")
    return "\n".join(lines)


if __name__ == "__main__":
    if not all(path.is_file() for path in ADIS):
        print(f"SKIPPED, NOT PASSED: the recordings adis_16405_imu1 to 3, for they are not in {SHARED}; set DRIFTLAB_SHARED")
        sys.exit(SKIPPED)
    if sys.argv[1:] == ["--table"]:
        with tempfile.TemporaryDirectory(prefix="driftlab-recorded-") as scratch:
            print(table(Workshop(Path(scratch))))
        sys.exit(0)
    unittest.main()
