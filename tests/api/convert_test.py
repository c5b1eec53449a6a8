"""`driftlab convert`: any result as CSV and as a MATLAB file, read back by readers that know nothing of the writers."""
from __future__ import annotations

import csv
import io
import json
import math
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

import mat5
import samples
from suite import DaemonTest

PROGRAM = os.environ.get("DRIFTLAB", "")
REPOSITORY = Path(__file__).resolve().parents[2]
CLEAN = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}


def driftlab(*words: str | Path, code: int = 0, text: str | None = None) -> str:
    ran = subprocess.run([PROGRAM, *map(str, words)], input=text, capture_output=True, text=True, check=False, timeout=280, env=CLEAN)
    assert ran.returncode == code, f"{words}: {ran.returncode} {ran.stdout[-1000:]}{ran.stderr[-1000:]}"
    return ran.stdout if code == 0 else ran.stderr


def valid(name: str, taken: set[str]) -> str:
    """The rule of the manual for names that MATLAB does not take."""
    changed = re.sub(r"[^A-Za-z0-9_]", "_", name.encode().decode("latin-1"))
    changed = (changed if re.match("[A-Za-z]", changed) else "x" + changed)[:63]
    unique, number = changed, 2
    while unique in taken:
        unique, number = f"{changed[:63 - len(str(number)) - 1]}_{number}", number + 1
    taken.add(unique)
    return unique


def is_row(node: Any) -> bool:
    numbers = isinstance(node, list) and all(value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)) for value in node)
    return numbers and any(value is not None for value in node)


def as_matlab_has_it(node: Any) -> Any:
    """The document under the rules of the manual, as mat5.read gives it."""
    if isinstance(node, dict):
        taken: set[str] = set()
        return {valid(name, taken): as_matlab_has_it(value) for name, value in node.items()}
    if isinstance(node, list):
        if not node:
            return None
        if is_row(node):
            row = [math.nan if value is None else float(value) for value in node]
            return row if len(row) > 1 else row[0]
        if all(is_row(row) and len(row) == len(node[0]) for row in node):
            rows = [[math.nan if value is None else float(value) for value in row] for row in node]
            return rows if len(rows) > 1 else as_matlab_has_it(node[0])
        return [as_matlab_has_it(value) for value in node]
    return float(node) if isinstance(node, (int, float)) and not isinstance(node, bool) else node


def flat(node: Any) -> Any:
    """Numbers compare as text, so that NaN is itself."""
    if isinstance(node, dict):
        return {name: flat(value) for name, value in node.items()}
    if isinstance(node, list):
        return [flat(value) for value in node]
    return repr(node) if isinstance(node, float) else node


class Convert(DaemonTest):
    def documents(self, folder: Path) -> dict[str, Any]:
        """One result of each kind."""
        recording = folder / "recording.csv"
        driftlab("simulate", "--preset", "iphone5s-z", "--duration-s", "200", "--out", recording)
        study = folder / "study.json"
        study.write_text(json.dumps({"device": {"id": "phone-07"}, "recordings": [
            {"id": "rest", "file": "recording.csv", "condition": {"kind": "static"}}]}))
        return {"characterise": json.loads(driftlab("characterise", recording, "--json", "--models", "WN,WN+GM", "--psd", "--taus", "20")),
                "investigate": json.loads(driftlab("investigate", study, "--json")),
                "outages": json.loads(driftlab("outages", "--scenario", "paper", "--runs", "2", "--json"))}

    def test_every_kind_of_result_is_read_back_as_it_was(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for kind, document in self.documents(folder).items():
                with self.subTest(kind=kind):
                    source = folder / f"{kind}.json"
                    source.write_text(json.dumps(document))
                    driftlab("convert", source, "--output", folder / "out.mat")
                    content = (folder / "out.mat").read_bytes()
                    [(variable, read)] = mat5.read(content).items()
                    self.assertEqual(variable, "result")
                    wanted = as_matlab_has_it(document)
                    self.maxDiff = 4000
                    self.assertEqual(json.dumps(flat(read)), json.dumps(flat(wanted)))
                    driftlab("convert", source, "--output", folder / "again.mat")
                    self.assertEqual(content, (folder / "again.mat").read_bytes(), "equal documents give equal files")
                    rows = list(csv.DictReader(io.StringIO(driftlab("convert", source, "--output", "-"))))
                    self.assertEqual(self.rebuilt(rows), self.leaves(document))

    def leaves(self, node: Any, path: str = "") -> dict[tuple[str, str], Any]:
        found: dict[tuple[str, str], Any] = {}
        if isinstance(node, dict):
            for name, value in node.items():
                found.update(self.leaves(value, f"{path}.{name}" if path else name))
        elif isinstance(node, list):
            for number, value in enumerate(node):
                if isinstance(value, (dict, list)):
                    found.update(self.leaves(value, f"{path}.{number}" if path else str(number)))
                else:
                    found[path, str(number + 1)] = value
        else:
            found[path, ""] = None if node == "" else node  # a table has one kind of nothing
        return found

    def rebuilt(self, rows: list[dict[str, str]]) -> dict[tuple[str, str], Any]:
        values: dict[tuple[str, str], Any] = {}
        for row in rows:
            value: Any = row["text"] or None
            if row["number"]:
                value = json.loads(row["number"])
            values[row["path"], row["index"]] = {"true": True, "false": False}.get(row["text"], value)
        return values

    def test_a_job_of_a_daemon_and_standard_input(self) -> None:
        recording = self.daemon.upload(samples.gyro_csv(seed=1), rate_hz=100, columns=samples.GYRO_Z).json["id"]
        job = self.daemon.finished(self.daemon.characterise(recording, models=["WN"]).json["id"])["id"]
        server = f"http://127.0.0.1:{self.daemon.port}"
        direct = driftlab("convert", "--job", job, "--server", server, "--output", "-")
        self.assertEqual(direct, driftlab("convert", "-", "--output", "-", text=self.daemon.get(f"/v1/jobs/{job}/result").text))
        self.assertIn("recordings.0.channels.0.", direct)

    def test_what_cannot_be_converted_is_one_sentence(self) -> None:
        for words, code in ((("nowhere.json", "--output", "a.csv"), 2), (("--output", "a.csv"), 2), (("-", "--output", "a.xlsx"), 2),
                            (("--job", "job_1", "--output", "-", "--server", "http://127.0.0.1:1"), 4)):
            said = driftlab("convert", *words, code=code, text="{}")
            self.assertEqual(len(said.splitlines()), 1, said)


if __name__ == "__main__":
    unittest.main()
