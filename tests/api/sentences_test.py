"""What a person gets who hands the command line a file that it cannot use: exit 2 and one sentence that names the file and the repair."""
from __future__ import annotations

import gzip
import os
import random
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["DRIFTLAB"]
HEAD = "t [s],gx [deg/s],gy [deg/s]\n"


def row(i: int) -> str:
    return f"{i * 0.01:.2f},{random.Random(i).gauss(0, 0.1):.5f},{random.Random(-i - 1).gauss(0, 0.1):.5f}\n"


ROWS = [row(i) for i in range(2000)]
GOOD = HEAD + "".join(ROWS)

# A file's content with words of the sentence: what is wrong, and what to do.
BROKEN: dict[str, tuple[str | bytes, str, str]] = {
    "empty.csv": ("", "empty", "empty"),
    "header.csv": (HEAD, "no samples", "under it"),
    "garbage.csv": (random.Random(1).randbytes(20000), "binary data", "send the samples as CSV or .npy"),
    "page.csv": ("<!DOCTYPE html><html><body>404</body></html>\n", "an HTML page", "fetch the file itself"),
    "words.csv": ("a report\nof last week\nand nothing more\n" * 9, "not a", "numbers"),
    "nan.csv": (HEAD + "".join(line.replace(",", ",nan,", 1).rsplit(",", 1)[0] + "\n" for line in ROWS), "2000 of 2000 rows", "leave the column out"),
    "text.csv": (HEAD + "".join(ROWS[:9]) + "0.09,abc,1\n" + "".join(ROWS[10:]), "Row 11, column 'gx [deg/s]' holds text", "correct or delete that row"),
    "infinite.csv": (HEAD + "".join(ROWS[:9]) + "0.09,inf,1\n" + "".join(ROWS[10:]), "holds an infinity", "correct or delete that row"),
    "ragged.csv": (HEAD + "".join(ROWS[:9]) + "0.09,1,1,1\n" + "".join(ROWS[10:]), "Line 11 has 4 values", "correct or delete that line"),
    "backward.csv": (HEAD + "".join(row(i if i % 7 else i // 2) for i in range(2000)), "steps back", "sort the rows"),
    "rate.csv": ("gx [deg/s],gy [deg/s]\n" + "".join(line.split(",", 1)[1] for line in ROWS), "no stated rate", "--rate-hz"),
    "unit.csv": (GOOD.replace("t [s]", "t"), "The time column 't' has no unit", "--rate-hz"),
    "cut.csv.gz": (gzip.compress(GOOD.encode())[:9000], "gzip stream ends before it is complete", "copy the file again"),
    "cut.npy": (b"\x93NUMPY\x01\x00v\x00" + b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000, 6), }".ljust(117) + b"\n" + bytes(800),
                "1000 x 6 numbers", "cut short"),
    "study.json": ('{"recordings": [', "not well-formed", "at byte"),
}


class Sentences(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-test-")))
        for name, (content, _, _) in BROKEN.items():
            (cls.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        (cls.folder / "good.csv").write_text(GOOD, "utf-8")

    def driftlab(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=120, check=False, stdin=subprocess.DEVNULL)

    def refused(self, *arguments: str, words: tuple[str, ...]) -> None:
        with self.subTest(arguments=arguments):
            done = self.driftlab(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertRegex(done.stderr, re.compile(r"\Adriftlab: [^\n]{15,}[.)]\n\Z"), "one line")
            for word in words:
                self.assertIn(word, done.stderr)

    def test_broken_recordings_are_refused_with_the_repair(self) -> None:
        for name, (_, wrong, repair) in BROKEN.items():
            for command in (("characterise",), ("plot",), ("export", "--target", "kalibr")):
                self.refused(*command, name, words=(name, wrong, repair))

    def test_a_recording_where_a_document_belongs_is_called_that(self) -> None:
        for arguments, wanted in ((("convert", "--output", "x.csv"), "that a command of driftlab wrote with --json"), (("population",), "driftlab characterise --json"),
                                  (("regress",), "--baseline and --candidate"), (("drive", "check"), "a drive document"),
                                  (("simulate", "--out", "x.csv", "--model"), "a model"),
                                  (("outages", "--scenario"), "a scenario"), (("characterise", "good.csv", "--calibration"), "a calibration")):
            self.refused(*arguments, "good.csv", words=("good.csv is no JSON document", wanted))
            self.refused(*arguments, "empty.csv", words=("empty.csv is empty", wanted))

    def test_several_documents_are_reported_one_at_a_time(self) -> None:
        for name in ("one.json", "two.json"):
            (self.folder / name).write_text("{}", "utf-8")
        for command, said in (("report", "One document is reported at a time"), ("plot", "One document is drawn at a time")):
            self.refused(command, "one.json", "two.json", words=(said, "one.json is one of 2 files"))
            self.refused(command, "good.csv", "two.json", words=(said, "two.json is one of 2 files"))

    def test_lines_left_out_are_counted(self) -> None:
        (self.folder / "banner.csv").write_text("12\n; ready\n" + GOOD, "utf-8")
        for lines, counted in (("1", "1 line left out by --skip-lines, 1 by --comment."),
                               ("2", "2 lines left out by --skip-lines, 0 by --comment.")):
            done = self.driftlab("characterise", "banner.csv", "--models", "WN", "--skip-lines", lines, "--comment", ";")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"driftlab: banner.csv: {counted}\n", done.stderr)

    def test_a_file_that_is_not_there_is_named(self) -> None:
        for arguments in (("characterise",), ("plot",), ("report",), ("investigate",), ("convert", "--output", "x.csv"), ("population",), ("regress",), ("drive", "check")):
            self.refused(*arguments, "absent.csv", words=("absent.csv", "No such file"))

    def test_a_word_that_is_no_command_gets_the_commands(self) -> None:
        self.refused("characterize", words=("There is no command 'characterize'", "characterise, ", "export"))

    def test_bars_and_units_behind_blanks_are_read(self) -> None:
        (self.folder / "bars.csv").write_text(GOOD.replace(",", "|"), "utf-8")
        (self.folder / "blanks.txt").write_text(GOOD.replace(",", " "), "utf-8")
        wanted = self.driftlab("characterise", "good.csv", "--models", "WN")
        self.assertEqual(wanted.returncode, 0, wanted.stderr)
        for name in ("bars.csv", "blanks.txt"):
            done = self.driftlab("characterise", "--models", "WN", name)  # the file may stand behind the list of models
            self.assertEqual((done.returncode, done.stdout.replace(name.split(".", maxsplit=1)[0], "good")), (0, wanted.stdout), done.stderr)

    def test_a_channel_that_never_moves_is_not_exported(self) -> None:
        (self.folder / "constant.csv").write_text("t [s],gx [deg/s]\n" + "".join(f"{i * 0.01:.2f},0.5\n" for i in range(1000)), "utf-8")
        self.refused("export", "--target", "kalibr", "constant.csv", words=("no axis has a noise density", "The channel is constant."))

    def test_columns_that_cannot_be_exported_are_refused_before_they_are_analysed(self) -> None:
        (self.folder / "counts.csv").write_text("gx,gy,az\n" + "".join(f"{i % 7},{i % 5},{i % 3}\n" for i in range(1000)), "utf-8")
        self.refused("export", "--target", "kalibr", "counts.csv", "--rate-hz", "100",
                     words=("columns gx, gy and az have no unit", "--columns gx=angular_rate:x:deg/s,gy=angular_rate:y:deg/s,az=specific_force:z:m/s^2"))
        (self.folder / "other.csv").write_text("pressure,volume\n" + "".join(f"{i % 7},{i % 5}\n" for i in range(1000)), "utf-8")
        self.refused("export", "--target", "kalibr", "other.csv", "--rate-hz", "100", words=("no column is known to be an axis", "pressure and volume", "--columns 0="))


if __name__ == "__main__":
    unittest.main()
