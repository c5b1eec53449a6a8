"""The same analyses without a daemon: the program `driftlab` in a process of its own, its documents as the same objects.

The program is the one given as `program`, or that of $DRIFTLAB, or the one on PATH. What it refuses is raised as InvalidInput.
"""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Union

import numpy

from .contract import CalibrationSensors, Condition, OutageScenario, Study
from .figure import Numbers
from .problems import class_of
from .results import Calibration, Characterisation, Investigation, OutageEvaluation
from .uploads import Columns, columns_text, opener_of

PathName = Union[str, "os.PathLike[str]"]
Files = Union[PathName, Numbers, Sequence[PathName]]
Document = Mapping[str, Any]


class DriftlabWarning(UserWarning):
    """What the program said beside its result."""


def program_of(program: PathName | None) -> str:
    """The program to run; FileNotFoundError with a sentence where there is none."""
    wanted = os.fspath(program or os.environ.get("DRIFTLAB") or "driftlab")
    found = shutil.which(wanted)
    if found is None:
        raise FileNotFoundError(f"There is no program {wanted!r}: build it (./deploy/quickstart.sh), then put it on PATH, set "
                                "DRIFTLAB to it, or give it as program=.")
    return found


def run(program: PathName | None, *words: str) -> str:
    """Standard output of the program. Exit code 2 is InvalidInput with its sentence, another a ServerProblem."""
    ran = subprocess.run([program_of(program), *words], stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8",
                         errors="replace", check=False)
    said = ran.stderr.strip().removeprefix("driftlab: ")
    if ran.returncode == 2:
        raise class_of(422)(said or "The program refused its input.", status=422, code="invalid_input")
    if ran.returncode != 0:
        last = said.splitlines()[-1] if said else f"The program ended with {ran.returncode} and said nothing."
        raise class_of(500)(last, status=500, code="program_failed")
    if said:
        warnings.warn(said, DriftlabWarning, stacklevel=3)
    return ran.stdout


def document_of(program: PathName | None, *words: str) -> Any:
    return json.loads(run(program, *words, "--json"))


def options(**values: str | int | float | bool | None) -> list[str]:
    """--name=value for what is given: one word each, so that no value is taken for an option."""
    words = []
    for name, value in values.items():
        flag = "--" + name.replace("_", "-")
        if value is True:
            words.append(flag)
        elif value is not None and value is not False:
            words.append(f"{flag}={value}")
    return words


def condition_text(condition: str | Condition) -> str:
    """kind:axis:value:unit or kind:axis:direction, as the command line takes it."""
    if isinstance(condition, str):
        return condition
    members: dict[str, Any] = {**condition}
    return ":".join(str(members[key]) for key in ("kind", "axis", "value", "unit", "direction") if key in members)


@contextmanager
def as_files(files: Files | Document, folder: PathName) -> Iterator[list[str]]:
    """Absolute names of files; arrays and study documents are written to a folder that is removed afterwards.

    Files that a study document names are those below `folder`.
    """
    with tempfile.TemporaryDirectory(prefix="driftlab-") as scratch:
        if isinstance(files, numpy.ndarray):
            name = Path(scratch, "array.npy")
            with opener_of(files)() as stream:
                name.write_bytes(stream.read())
            yield [str(name)]
        elif isinstance(files, Mapping):
            document = {**files}
            if "recordings" in document:
                document["recordings"] = [{**recording, **{member: str(Path(folder, recording[member]).resolve())
                                                           for member in ("file", "calibration") if member in recording}}
                                          for recording in document["recordings"]]
            name = Path(scratch, "study.json")
            name.write_text(json.dumps(document, allow_nan=False), "utf-8")
            yield [str(name)]
        else:
            several = [files] if isinstance(files, (str, os.PathLike)) else files
            yield [str(Path(each).resolve()) for each in several]


def characterise(files: Files | Study, *, rate_hz: float | None = None, columns: Columns | None = None, stream: str | None = None,
                 condition: str | Condition | None = None, device: str | None = None, calibration: PathName | None = None,
                 models: Sequence[str] | None = None, stepwise: bool = False, bootstrap: int = 0, seed: int = 1,
                 also: Sequence[Literal["total", "theo1", "psd"]] = (), taus: int = 0,
                 folder: PathName = ".", program: PathName | None = None) -> Characterisation:
    """Variances, Allan coefficients and ranked models of recordings: files that share what is said of them, an array whose rows are
    samples, or a study (its file, or its document, whose recordings are then looked for below `folder`)."""
    said = options(rate_hz=rate_hz, columns=columns_text(columns), stream=stream,
                   condition=condition_text(condition) if condition else None, device=device,
                   calibration=str(Path(calibration).resolve()) if calibration else None,
                   models=",".join(models) if models else None, stepwise=stepwise, bootstrap=bootstrap or None, seed=seed,
                   total="total" in also, theo1="theo1" in also, psd="psd" in also, taus=taus or None)
    with as_files(files, folder) as names:
        return Characterisation(document_of(program, "characterise", *names, *said))


def investigate(study: PathName | Study, *, folder: PathName = ".", program: PathName | None = None) -> Investigation:
    """What the baseline of a study gets wrong about its recordings, and why."""
    with as_files(study, folder) as names:
        return Investigation(document_of(program, "investigate", *names))


def outages(scenario: str | PathName | OutageScenario = "paper", *, runs: int = 400, seed: int = 1, precision: float = 0.0,
            threads: int = 0, program: PathName | None = None) -> OutageEvaluation:
    """Filters compared through simulated outages: a scenario by name, a file of one, or its document."""
    said = options(runs=runs, seed=seed, precision=precision, threads=threads)
    if isinstance(scenario, str) and not scenario.endswith(".json"):
        return OutageEvaluation(document_of(program, "outages", *options(scenario=scenario), *said))
    with as_files(scenario, ".") as names:
        return OutageEvaluation(document_of(program, "outages", *options(scenario=names[0]), *said))


def calibrate(files: Files | Study, *, rate_hz: float | None = None, columns: Columns | None = None,
              condition: str | Condition | None = None, gravity_m_s2: float = 9.80665, misalignment: bool = False,
              folder: PathName = ".", program: PathName | None = None) -> Calibration:
    """Bias, scale factor and misalignment of a triad from a study of positions, or from one recording with rests in any attitude."""
    said = options(rate_hz=rate_hz, columns=columns_text(columns), condition=condition_text(condition) if condition else None,
                   gravity=gravity_m_s2, misalignment=misalignment)
    with as_files(files, folder) as names:
        found: CalibrationSensors = document_of(program, "calibrate", *names, *said)
        return Calibration(found)


@dataclass(frozen=True, eq=False)
class Simulation:
    """A simulated recording: rows of `samples` are samples, `columns` name them with their units as in the file."""

    columns: list[str]
    samples: Numbers

    def __getitem__(self, name: str) -> Numbers:
        """One column, by its name with or without the unit."""
        for number, column in enumerate(self.columns):
            if name in (column, column.partition(" ")[0]):
                values: Numbers = self.samples[:, number]
                return values
        raise KeyError(f"There is no column {name!r}; there are {', '.join(self.columns)}.")


def simulate(out: PathName | None = None, *, preset: str | None = None, model: PathName | Document | None = None,
             channel: str | None = None, condition: str | Condition = "static", rate_hz: float = 100.0, duration_s: float = 900.0,
             seed: int = 1, scenario: str | PathName | None = None, run_number: int = 0, gnss: PathName | None = None,
             truth: PathName | None = None, program: PathName | None = None) -> Simulation:
    """A recording simulated from an error model (a published preset, or a model, report or fit as file or document), or all six axes along
    the drive of a scenario. `out` keeps the CSV file, `gnss` and `truth` those of a scenario."""
    with tempfile.TemporaryDirectory(prefix="driftlab-") as scratch:
        name = Path(out).resolve() if out is not None else Path(scratch, "simulated.csv")
        if name.suffix == ".npy":
            raise ValueError("A simulation is read back with the names of its columns, which a .npy file does not hold: name a .csv file.")
        if isinstance(model, Mapping):
            Path(scratch, "model.json").write_text(json.dumps(model), "utf-8")
            model = Path(scratch, "model.json")
        if scenario is not None:
            said = options(scenario=os.fspath(scenario), run=run_number, gnss=str(Path(gnss).resolve()) if gnss else None,
                           truth=str(Path(truth).resolve()) if truth else None)
        else:
            said = options(preset=preset, model=str(Path(model).resolve()) if model else None, channel=channel,
                           condition=condition_text(condition), rate_hz=rate_hz, duration_s=duration_s)
        run(program, "simulate", f"--out={name}", *said, *options(seed=seed))
        with name.open(encoding="utf-8") as file:
            header = next(line for line in file if not line.startswith("#")).strip()
            samples = numpy.loadtxt(file, delimiter=",", ndmin=2)
        return Simulation(header.split(","), samples)
