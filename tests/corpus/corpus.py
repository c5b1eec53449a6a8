"""The fixed corpus: recordings made up here, and every document that driftlab makes of them.

A redesign must not move a bit of any of these. The recordings come from Python's own generator, not from driftlab's
simulator, and are rounded to six digits; so they are the same whatever driftlab does.

`documents(driftlab, driftlabd)` yields (name, text): results of the command line in its own process, then of a daemon. What
differs from run to run by its nature (ids, times, ports, the daemon's version) is replaced by names in the order of appearance.
"""
from __future__ import annotations

import json
import math
import random
import re
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import samples

RATE_HZ = 50
GRAVITY = 9.80665
GYRO = {"gx": {"quantity": "angular_rate", "axis": "x", "unit": "deg/s"}, "gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}}
SCENARIO: dict[str, Any] = {
    "name": "one turn", "duration_s": 45, "imu_rate_hz": 20,
    "trajectory": {"start": {"speed_m_s": 15}, "segments_by_start_time": [{"t_s": 30, "kind": "turn", "rate_deg_s": 9, "duration_s": 10}]},
    "outages": [{"start_s": 30, "duration_s": 10}],
    "truth": {"gyro": {"processes": [{"process": "white_noise", "params": {"N": {"value": 1.03, "unit": "deg/sqrt(h)"}}},
                                     {"process": "gauss_markov", "params": {"sigma": {"value": 62, "unit": "deg/h"}, "beta": {"value": 0.01, "unit": "1/s"}}}],
                       "constant_bias_sd_deg_s": 0.05},
              "accelerometer": {"white_noise_mg_per_sqrt_hz": 2, "constant_bias_sd_mg": 10}},
    "filters": [{"name": "matched"}],
}


class Noise:
    """White noise, a Gauss-Markov process and a random walk, per sample, of unit levels."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def white(self, count: int, sd: float) -> list[float]:
        return [self.random.gauss(0.0, sd) for _ in range(count)]

    def gauss_markov(self, count: int, sd: float, beta_dt: float) -> list[float]:
        phi, value, out = 1.0 - beta_dt, self.random.gauss(0.0, sd), []
        for _ in range(count):
            out.append(value)
            value = phi * value + self.random.gauss(0.0, sd * math.sqrt(1.0 - phi * phi))
        return out

    def walk(self, count: int, step: float) -> list[float]:
        value, out = 0.0, []
        for _ in range(count):
            out.append(value)
            value += self.random.gauss(0.0, step)
        return out


def added(*parts: list[float]) -> list[float]:
    return [sum(values) for values in zip(*parts, strict=True)]


def write_csv(path: Path, columns: dict[str, list[float]]) -> None:
    rows = zip(*columns.values(), strict=True)
    path.write_text("\n".join([",".join(columns), *(",".join(f"{value:.6f}" for value in row) for row in rows)]) + "\n")


def campaign(folder: Path) -> Path:
    """Two gyroscope axes at rest twice, at two rates (the first twice) and on a ramp: noise that grows with the rate."""
    recordings = []
    kinds = [("rest-1", {"kind": "static"}, 0.0), ("rest-2", {"kind": "static"}, 0.0),
             ("slow-1", {"kind": "constant_rate", "axis": "z", "value": 9.0, "unit": "deg/s"}, 9.0),
             ("slow-2", {"kind": "constant_rate", "axis": "z", "value": 9.0, "unit": "deg/s"}, 9.0),
             ("fast", {"kind": "constant_rate", "axis": "z", "value": 72.0, "unit": "deg/s"}, 72.0),
             ("ramp", {"kind": "constant_angular_acceleration", "axis": "z", "value": 0.5, "unit": "deg/s^2"}, None)]
    for number, (name, condition, rate) in enumerate(kinds):
        noise = Noise(100 + number)
        count = 6000
        turning = [0.5 * i / RATE_HZ if rate is None else rate for i in range(count)]
        columns = {}
        for column, part in (("gx", 0.0), ("gz", 1.0)):
            level = 0.1 * (1.0 + 0.01 * (rate or 0.0))
            columns[column] = added([part * value for value in turning], noise.white(count, level), noise.gauss_markov(count, 0.05, 0.02),
                                    noise.walk(count, 0.0005))
        if name == "rest-2":
            for i in range(50, count, 997):
                columns["gz"][i] += 3.0  # gross errors: robust variances take part
        write_csv(folder / f"{name}.csv", columns)
        recordings.append({"id": name, "file": f"{name}.csv", "rate_hz": RATE_HZ, "columns": GYRO, "condition": condition})
    path = folder / "campaign.json"
    path.write_text(json.dumps({"device": {"id": "corpus"}, "recordings": recordings, "baseline": {"kind": "auto"}}))
    return path


def profiles(folder: Path, name: str, baseline: dict[str, Any]) -> Path:
    """At rest while the temperature rises, and two profiles with their reference: a scale factor, a step, a temperature."""
    recordings = []
    columns: dict[str, Any] = {"gz": GYRO["gz"], "rz": {"quantity": "reference_angular_rate", "axis": "z", "unit": "deg/s"},
                               "temp": {"quantity": "temperature", "unit": "degC"}, "t": {"quantity": "time", "unit": "s"}}
    for number in range(3):
        noise = Noise(200 + number)
        count = 9000
        time = [i / RATE_HZ for i in range(count)]
        rate = [0.0 if number == 0 else 60.0 * math.sin(0.3 * t + number) * math.sin(0.011 * t) for t in time]
        temperature = [25.0 + 10.0 * (1.0 - math.exp(-t / 60.0)) + 0.01 * w for t, w in zip(time, noise.white(count, 1.0), strict=True)]
        reading = added([1.004 * w for w in rate], [0.01 * (c - 25.0) for c in temperature], noise.white(count, 0.08),
                        noise.gauss_markov(count, 0.02, 0.01), [0.05 if number == 0 and t > 100.0 else 0.0 for t in time])
        reading = [round(value / 0.01) * 0.01 for value in reading]
        write_csv(folder / f"{name}-{number}.csv", {"t": time, "gz": reading, "rz": rate, "temp": temperature})
        condition = {"kind": "static"} if number == 0 else {"kind": "profile"}
        used = {c: role for c, role in columns.items() if number > 0 or c != "rz"}
        recordings.append({"id": f"{name}-{number}", "file": f"{name}-{number}.csv", "rate_hz": RATE_HZ, "columns": used, "condition": condition})
    path = folder / f"{name}.json"
    path.write_text(json.dumps({"device": {"id": name}, "recordings": recordings, "baseline": baseline}))
    return path


def positions(folder: Path) -> Path:
    recordings = []
    roles = {f"f{a}": {"quantity": "specific_force", "axis": a, "unit": "m/s^2"} for a in "xyz"}
    for i, axis in enumerate("xyz"):
        for direction in ("up", "down"):
            noise = Noise(300 + 2 * i + (direction == "up"))
            columns = {}
            for j, name in enumerate("xyz"):
                truth = (GRAVITY if direction == "up" else -GRAVITY) if i == j else 0.0
                columns[f"f{name}"] = added(noise.white(1000, 0.02), [0.1 * (j + 1) + truth * (1 + 0.001 * (j + 1)) + 0.002 * truth] * 1000)
            write_csv(folder / f"{axis}-{direction}.csv", columns)
            recordings.append({"id": f"{axis}-{direction}", "file": f"{axis}-{direction}.csv", "rate_hz": RATE_HZ, "columns": roles,
                               "condition": {"kind": "six_position", "axis": axis, "direction": direction}})
    path = folder / "positions.json"
    path.write_text(json.dumps({"device": {"id": "level"}, "recordings": recordings}))
    return path


def firmwares(folder: Path) -> Path:
    """Two sessions each of two firmwares, the second 40 % noisier about z."""
    arms: dict[str, Any] = {}
    for arm, (firmware, level) in {"baseline": ("1.4", 1.0), "candidate": ("1.5", 1.4)}.items():
        recordings = []
        for session in range(2):
            noise = Noise(400 + 10 * session + (arm == "candidate"))
            name = f"{arm}-{session}"
            write_csv(folder / f"{name}.csv", {"gx": noise.white(6000, 0.1), "gz": added(noise.white(6000, 0.1 * level), noise.walk(6000, 0.0005))})
            recordings.append({"id": name, "file": f"{name}.csv", "session": name, "rate_hz": RATE_HZ, "columns": GYRO, "condition": {"kind": "static"}})
        arms[arm] = {"labels": {"firmware": firmware}, "recordings": recordings}
    path = folder / "firmwares.json"
    path.write_text(json.dumps({"device": {"id": "corpus"}, **arms}))
    return path


def recorded_drive(folder: Path) -> Path:
    """The made-up car of the interface's tests, whose unit is stamped 0.3 s late."""
    readings, fixes = samples.drive_csvs(seconds=400)
    (folder / "readings.csv").write_bytes(readings)
    (folder / "fixes.csv").write_bytes(fixes)
    document = samples.drive_document("readings.csv", "fixes.csv")
    for source in ("imu", "gnss"):
        document[source]["file"] = document[source].pop("recording")
    document["imu"]["time"]["offset_s"] = 0.3
    path = folder / "drive.json"
    path.write_text(json.dumps(document))
    return path


GIVEN = {"kind": "model", "processes": [{"process": "white_noise", "params": {"N": {"value": 0.0113, "unit": "deg/s/sqrt(Hz)"}}},
                                        {"process": "gauss_markov", "params": {"sigma": {"value": 0.02, "unit": "deg/s"}, "beta": {"value": 0.5, "unit": "1/s"}}}]}

ID = re.compile(r"\b(rec|dev|job|fit|chr|stu|inv|mod|cal|bkp)_[0-9A-Za-z]{20,}\b")
TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z")


def timeless(text: str, folder: Path) -> str:
    """Ids by number in the order of appearance, times as one word."""
    seen: dict[str, str] = {}

    def named(match: re.Match[str]) -> str:
        return seen.setdefault(match.group(0), f"{match.group(1)}#{sum(v.startswith(match.group(1)) for v in seen.values()) + 1}")

    return TIME.sub("TIME", ID.sub(named, text)).replace(str(folder), "FOLDER")


def local(driftlab: str, folder: Path) -> Iterator[tuple[str, str]]:
    def run(*arguments: str, codes: tuple[int, ...] = (0,)) -> str:
        done = subprocess.run([driftlab, *arguments], cwd=folder, capture_output=True, text=True, check=False, timeout=600)
        if done.returncode not in codes:
            raise AssertionError(f"{arguments}: {done.stderr}")
        return timeless(done.stdout, folder)

    study, automatic = str(campaign(folder)), str(profiles(folder, "auto", {"kind": "auto"}))
    given, level = str(profiles(folder, "given", GIVEN)), str(positions(folder))
    yield "characterise-campaign.json", run("characterise", study, "--models", "WN,WN+GM,WN+GM+RW,WN+RW", "--json")
    yield "characterise-campaign.txt", run("characterise", study, "--models", "WN,WN+GM,WN+GM+RW,WN+RW")
    one = ("rest-2.csv", "--rate-hz", str(RATE_HZ), "--columns", "gx=angular_rate:x:deg/s,gz=angular_rate:z:deg/s")
    yield "characterise-nine-models.json", run("characterise", *one, "--json")
    yield "characterise-stepwise.txt", run("characterise", *one, "--stepwise", "--bootstrap", "40")
    yield "investigate-automatic.json", run("investigate", automatic, "--json", "--markdown", "auto.md")
    yield "investigate-automatic.md", timeless((folder / "auto.md").read_text(), folder)
    yield "investigate-given.json", run("investigate", given, "--json")
    yield "investigate-campaign.json", run("investigate", study, "--json")
    yield "calibrate.json", run("calibrate", level, "--misalignment", "--json")
    yield "calibrate.txt", run("calibrate", level)
    (folder / "scenario.json").write_text(json.dumps(SCENARIO))
    yield "outages-turn.json", run("outages", "--scenario", "scenario.json", "--runs", "8", "--json")
    yield "outages-paper.json", run("outages", "--scenario", "paper", "--runs", "2", "--json")
    yield "outages-paper.txt", run("outages", "--scenario", "paper-nhc", "--runs", "2")
    run("simulate", "--preset", "iphone5s-z", "--duration-s", "20", "--out", "preset.csv")
    yield "simulate-preset.csv", (folder / "preset.csv").read_text()
    (folder / "extended.json").write_text(run("investigate", automatic, "--json"))
    run("simulate", "--model", "extended.json", "--duration-s", "20", "--out", "model.csv")
    yield "simulate-model.csv", (folder / "model.csv").read_text()
    run("simulate", "--scenario", "scenario.json", "--out", "drive.csv", "--gnss", "gnss.csv", "--truth", "truth.csv")
    for name in ("drive", "gnss", "truth"):
        yield f"simulate-{name}.csv", (folder / f"{name}.csv").read_text()
    verdicts = (0, 1, 3)
    yield "regression.json", run("regress", str(firmwares(folder)), "--json", "--markdown", "firmwares.md", codes=verdicts)
    yield "regression.md", timeless((folder / "firmwares.md").read_text(), folder)
    drive = str(recorded_drive(folder))
    yield "drive-run.json", run("drive", "run", drive, "--json")
    yield "drive-run.txt", run("drive", "run", drive)


def served(start: Callable[[], Any], folder: Path) -> Iterator[tuple[str, str]]:
    """The same campaign through a daemon, one job after another."""
    with start() as daemon:
        study = json.loads((folder / "campaign.json").read_text())
        spec = {entry["id"]: entry for entry in study["recordings"]}

        def get(target: str, accept: str = "application/json") -> str:
            answer = daemon.get(target, Accept=accept, Prefer="wait=60")
            assert answer.status == 200, answer.describe()
            return timeless(answer.text, folder)

        ids = {}
        for name, entry in spec.items():
            metadata = {key: value for key, value in entry.items() if key not in ("file", "id")}
            metadata["device"] = {"id": "corpus"}
            answer = daemon.upload_parts(("metadata", json.dumps(metadata).encode()), ("file", (folder / entry["file"]).read_bytes()))
            assert answer.status == 201, answer.describe()
            ids[name] = answer.json["id"]
        for names in (("rest-1", "slow-1"), ("rest-2", "slow-2"), ("fast", "ramp")):
            job = daemon.finished(daemon.characterise(*(ids[n] for n in names), models=["WN", "WN+GM", "WN+RW", "WN+GM+RW"]).json["id"])
            assert job["state"] == "succeeded", job
            yield f"job-{names[0]}.json", get(job["result"]["href"])
        for axis in "xz":
            for method in ("gmwm", "av"):
                target = f"/v1/parameter-tables?device=corpus&axis={axis}&method={method}"
                yield f"table-{axis}-{method}.json", get(target)
                yield f"table-{axis}-{method}.txt", get(target, "text/plain")
            yield f"table-{axis}.csv", get(f"/v1/parameter-tables?device=corpus&axis={axis}", "text/csv")
            yield f"table-{axis}.md", get(f"/v1/parameter-tables?device=corpus&axis={axis}", "text/markdown")
            yield f"trends-{axis}.json", get(f"/v1/trends?device=corpus&axis={axis}")
            yield f"trends-{axis}.txt", get(f"/v1/trends?device=corpus&axis={axis}", "text/plain")
        stored = daemon.post("/v1/studies", {"device": {"id": "corpus"}, "recordings": [{"recording": id_} for id_ in ids.values()]}).json["id"]
        job = daemon.finished(daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": stored}}).json["id"])
        assert job["state"] == "succeeded", job
        result = daemon.get(job["result"]["href"]).json
        yield "investigation.json", timeless(json.dumps(result), folder)
        yield "investigation.md", get(f"/v1/investigations/{result['id']}", "text/markdown")
        yield "model.json", get(f"/v1/models/{result['model']}")
        [fit] = [f for f in daemon.items(f"/v1/fits?model=WN%2BGM&recording={ids['rest-1']}") if f["axis"] == "z"]
        for name, gyro in (("table", {"table": {"device": "corpus", "axis": "z"}}), ("fit", {"fit": fit["id"], "constant_bias_sd_deg_s": 0.05}),
                           ("model", {"simulation_model": result["model"], "channel": "gz"})):
            scenario = json.loads(json.dumps(SCENARIO))
            scenario["filters"].append({"name": name, "gyro": gyro})
            answer = daemon.post("/v1/outage-evaluations", {"scenario": scenario, "runs": 2})
            assert answer.status == 202, answer.describe()
            daemon.finished(answer.json["id"])
            yield f"outage-{name}.json", timeless(json.dumps(daemon.get(answer.headers["location"]).json["evaluation"]), folder)


def documents(driftlab: str, start: Callable[[], Any]) -> Iterator[tuple[str, str]]:
    """Every document of the corpus; `start` gives a running daemon."""
    with tempfile.TemporaryDirectory(prefix="driftlab-corpus-") as name:
        folder = Path(name)
        yield from local(driftlab, folder)
        yield from served(start, folder)
