"""The same analyses without a daemon: the program `driftlab` in a process of its own, its documents as the same objects.

The program is the one given as `program`, or that of $DRIFTLAB, or the one on PATH. What it refuses is raised as InvalidInput.
"""
from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypedDict, Union

import numpy

from .contract import CalibrationSensors, Condition, OutageScenario, Regression, Study
from .figure import Numbers
from .problems import class_of
from .results import Calibration, Characterisation, Investigation, OutageEvaluation
from .tables import ParameterTable
from .uploads import Columns, columns_text, opener_of

PathName = Union[str, "os.PathLike[str]"]
Recorded = Union[PathName, Numbers]
Files = Union[Recorded, Sequence[Recorded]]
Arm = Union[Recorded, Characterisation, Sequence[Union[Recorded, Characterisation]]]
Document = Mapping[str, Any]
Result = Union[Characterisation, Investigation, OutageEvaluation, ParameterTable]

# How `driftlab export` begins what a file lacks; what else it says is about the recordings.
GAP = re.compile(r"\S+ is (not given\. |an upper limit: )")


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


def outcome(program: PathName | None, *words: str, ends: Sequence[int] = (0,), folder: PathName | None = None) -> tuple[str, str]:
    """Standard output of the program, and what it said beside it. `ends` are the exit codes of a result, `folder` is where it runs.

    Exit code 2 is InvalidInput with its sentence, another a ServerProblem; so is an end without a result.
    """
    ran = subprocess.run([program_of(program), *words], stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8",
                         errors="replace", check=False, cwd=folder)
    said = "\n".join(line.removeprefix("driftlab: ") for line in ran.stderr.strip().splitlines())
    if ran.returncode == 2:
        raise class_of(422)(said or "The program refused its input.", status=422, code="invalid_input")
    if ran.returncode not in ends or ran.returncode != 0 and not ran.stdout:
        last = said.splitlines()[-1] if said else f"The program ended with {ran.returncode} and said nothing."
        raise class_of(500)(last, status=500, code="program_failed")
    return ran.stdout, said


def run(program: PathName | None, *words: str, ends: Sequence[int] = (0,), folder: PathName | None = None) -> str:
    """The same, where what the program said is a warning."""
    text, said = outcome(program, *words, ends=ends, folder=folder)
    if said:
        warnings.warn(said, DriftlabWarning, stacklevel=3)
    return text


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


def several(files: Arm) -> list[Recorded | Characterisation]:
    return [files] if isinstance(files, (str, os.PathLike, numpy.ndarray, Characterisation)) else list(files)


def names_of(files: Arm, scratch: PathName, stem: str = "array") -> list[str]:
    """Names of files as they are given; arrays and results are written to `scratch`."""
    names, given = [], several(files)
    for number, each in enumerate(given, start=1):
        own = Path(scratch, stem if len(given) == 1 else f"{stem}-{number}")
        if isinstance(each, numpy.ndarray):
            own = own.with_suffix(".npy")
            with opener_of(each)() as stream:
                own.write_bytes(stream.read())
        elif isinstance(each, Characterisation):
            own = own.with_suffix(".json")
            own.write_text(json.dumps(each.document, allow_nan=False), "utf-8")
        names.append(os.fspath(each if isinstance(each, (str, os.PathLike)) else own))
    return names


def found_below(recording: Document, folder: PathName) -> Document:
    """A recording of a document, with the absolute names of its files."""
    return {**recording, **{member: str(Path(folder, recording[member]).resolve())
                            for member in ("file", "result", "calibration") if member in recording}}


@contextmanager
def as_files(files: Files | Document | Result, folder: PathName) -> Iterator[list[str]]:
    """Absolute names of files; arrays, studies and results are written to a folder that is removed afterwards.

    Files that a study document names are those below `folder`.
    """
    with tempfile.TemporaryDirectory(prefix="driftlab-") as scratch:
        if isinstance(files, (Characterisation, Investigation, OutageEvaluation, ParameterTable)):
            files = {**files.document}
        if isinstance(files, Mapping):
            document = {**files}
            if isinstance(document.get("recordings"), list):
                document["recordings"] = [found_below(recording, folder) if isinstance(recording, Mapping) and "channels" not in recording
                                          else recording for recording in document["recordings"]]
            name = Path(scratch, "study.json")
            name.write_text(json.dumps(document, allow_nan=False), "utf-8")
            yield [str(name)]
        else:
            yield [str(Path(name).resolve()) for name in names_of(files, scratch)]


def described(rate_hz: float | None, columns: Columns | None, stream: str | None, condition: str | Condition | None, device: str | None,
              calibration: PathName | None) -> list[str]:
    """The options that say what recordings are."""
    return options(rate_hz=rate_hz, columns=columns_text(columns), stream=stream,
                   condition=condition_text(condition) if condition else None, device=device,
                   calibration=str(Path(calibration).resolve()) if calibration else None)


def characterise(files: Files | Study, *, rate_hz: float | None = None, columns: Columns | None = None, stream: str | None = None,
                 condition: str | Condition | None = None, device: str | None = None, calibration: PathName | None = None,
                 models: Sequence[str] | None = None, stepwise: bool = False, bootstrap: int = 0, seed: int = 1,
                 also: Sequence[Literal["total", "theo1", "psd"]] = (), taus: int = 0,
                 folder: PathName = ".", program: PathName | None = None) -> Characterisation:
    """Variances, Allan coefficients and ranked models of recordings: files that share what is said of them, an array whose rows are
    samples, or a study (its file, or its document, whose recordings are then looked for below `folder`)."""
    said = options(models=",".join(models) if models else None, stepwise=stepwise, bootstrap=bootstrap or None, seed=seed,
                   total="total" in also, theo1="theo1" in also, psd="psd" in also, taus=taus or None)
    said += described(rate_hz, columns, stream, condition, device, calibration)
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


def run_below(document: Document, folder: PathName) -> Document:
    """A run.json whose files are those below `folder`; a recording without an id goes by the name that it is given here."""
    def arm(written: Any) -> Any:
        if not isinstance(written, Mapping) or not isinstance(written.get("recordings"), list):
            return written
        return {**written, "recordings": [{**({"id": each["file"]} if "file" in each else {}), **found_below(each, folder)}
                                          if isinstance(each, Mapping) else each for each in written["recordings"]]}
    made = {**document, **{name: arm(document[name]) for name in ("baseline", "candidate") if name in document}}
    if isinstance(document.get("history"), list):
        made["history"] = [arm(release) for release in document["history"]]
    return made


def regress(inputs: PathName | Document | None = None, *, baseline: Arm = (), candidate: Arm = (), history: Arm = (),
            baseline_label: str | None = None, candidate_label: str | None = None, device: str | None = None,
            rate_hz: float | None = None, columns: Columns | None = None, stream: str | None = None,
            condition: str | Condition | None = None, calibration: PathName | None = None, models: Sequence[str] | None = None,
            settings: PathName | Document | None = None, state: PathName | None = None, out: PathName | None = None,
            folder: PathName = ".", program: PathName | None = None) -> Regression:
    """Whether the noise of a device is no worse than before a change, as `Client.regression` gives it: `verdict` is pass, fail or
    inconclusive, and each of them is a result.

    What is compared is a run.json (its file, or its document, whose recordings are then looked for below `folder`), or `baseline` and
    `candidate`: files, arrays or what `characterise` gave, each one a session. `state` is the file that keeps anchor, looks and earlier
    releases; `out` is a folder for document, summary, JUnit report, figure and badge."""
    arms = {"baseline": baseline, "candidate": candidate, "history": history}
    arrays = any(isinstance(each, numpy.ndarray) for files in arms.values() for each in several(files))
    if arrays and state is not None:
        raise ValueError("A state knows recordings by the names of their files, which an array does not have: save it to a file first.")
    with tempfile.TemporaryDirectory(prefix="driftlab-") as scratch:
        words = []
        if isinstance(inputs, Mapping):
            Path(scratch, "run.json").write_text(json.dumps(run_below(inputs, folder), allow_nan=False), "utf-8")
            inputs = Path(scratch, "run.json")
        if inputs is not None:
            words.append(str(Path(inputs).resolve()))
        for arm, files in arms.items():
            for name in names_of(files, scratch, arm):
                # The name is the recording's: as it is given, and of an array that of its arm.
                if arrays:
                    name = Path(name).name if Path(name).parent == Path(scratch) else str(Path(name).resolve())
                words.append(f"--{arm}={name}")
        if isinstance(settings, Mapping):
            Path(scratch, "settings.json").write_text(json.dumps(settings, allow_nan=False), "utf-8")
            settings = Path(scratch, "settings.json")
        words += described(rate_hz, columns, stream, condition, device, calibration)
        words += options(baseline_label=baseline_label, candidate_label=candidate_label, models=",".join(models) if models else None,
                         settings=str(Path(settings).resolve()) if settings is not None else None,
                         state=str(Path(state).resolve()) if state is not None else None,
                         out=str(Path(out).resolve()) if out is not None else None)
        text = run(program, "regress", *words, "--json", ends=(0, 1, 3), folder=scratch if arrays else None)
        found: Regression = json.loads(text)
        return found


class Exported(TypedDict):
    """What `Client.export` gives too: the target, the text of its file, and a sentence for each name without a value or with an upper
    limit."""

    target: str
    gaps: list[str]
    text: str


def export(target: str, files: Files | Study | Document | Characterisation, *, rate_hz: float | None = None, columns: Columns | None = None,
           stream: str | None = None, condition: str | Condition | None = None, device: str | None = None,
           calibration: PathName | None = None, out: PathName | None = None, folder: PathName = ".",
           program: PathName | None = None) -> Exported:
    """Noise parameters in the file of another program, for example "kalibr": of recordings or a study, as `characterise` takes them, or
    of what it gave. `out` keeps the file."""
    said = options(target=target) + described(rate_hz, columns, stream, condition, device, calibration)
    with as_files(files, folder) as names:
        text, beside = outcome(program, "export", *names, *said)
    gaps = [line for line in beside.splitlines() if GAP.match(line)]
    remarks = [line for line in beside.splitlines() if line not in gaps]
    if remarks:
        warnings.warn("\n".join(remarks), DriftlabWarning, stacklevel=2)
    if out is not None:
        Path(out).write_text(text, "utf-8")
    return {"target": target, "gaps": gaps, "text": text}


def report(files: Files | Study | Document | Result, out: PathName | None = None, *, rate_hz: float | None = None,
           columns: Columns | None = None, stream: str | None = None, condition: str | Condition | None = None,
           device: str | None = None, calibration: PathName | None = None, folder: PathName = ".",
           program: PathName | None = None) -> str:
    """One page of HTML, in one file and without scripts: of recordings or a study, as `characterise` takes them, or of a result, such as
    what `characterise`, `investigate`, `regress` or `outages` gave. `out` keeps the page."""
    said = described(rate_hz, columns, stream, condition, device, calibration)
    with as_files(files, folder) as names:
        page = run(program, "report", *names, *said)
    if out is not None:
        Path(out).write_text(page, "utf-8")
    return page
