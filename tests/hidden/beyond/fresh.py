#!/usr/bin/env python3
"""Writes fresh studies for score.py: many without any effect, of many kinds, and some with effects of the kinds of challenge/beyond.

    fresh.py FOLDER [--nulls 120] [--effects 4] [--seed 2026]

FOLDER/cases/<id>/ are studies as driftlab reads them, FOLDER/answers.json says what they hold. The seed fixes everything. None of
driftlab's code is used: white noise, Gauss-Markov processes, random walks, lattices and effects are written here a second time.
Standard library only.
"""
from __future__ import annotations

import argparse
import gzip
import json
import math
import random
from pathlib import Path

DEGREE = math.pi / 180


class World:
    """One study under construction; channels in deg/s."""

    def __init__(self, rng: random.Random, rate: float, seconds: float, axes: str = "z", base: str = "wn", step: float = 1e-4) -> None:
        self.rng, self.rate, self.n, self.axes, self.base, self.step = rng, rate, int(rate * seconds), axes, base, step
        self.dt = 1 / rate
        self.N = rng.uniform(0.015, 0.05)  # deg/sqrt(s)
        self.gm = [(rng.uniform(0.01, 0.03), rng.uniform(0.02, 0.6)) for _ in range({"wn": 0, "gm": 1, "3gm": 3, "t5": 0, "rw": 0, "tactical": 1}[base])]
        self.K = rng.uniform(2e-4, 6e-4) if base == "rw" else 0.0
        if base == "tactical":
            self.N, self.gm = self.N / 100, [(s / 100, b) for s, b in self.gm]
        self.bias = {a: rng.gauss(0, 0.5) for a in axes}
        self.recordings: list[dict] = []

    def white(self) -> float:
        if self.base == "t5":
            g = self.rng.gammavariate(2.5, 0.4)  # chi-square of 5 over 5
            return self.rng.gauss(0, 1) / math.sqrt(g) * math.sqrt(3 / 5)
        return self.rng.gauss(0, 1)

    def noise(self) -> list[float]:
        sd = self.N / math.sqrt(self.dt)
        out = [sd * self.white() for _ in range(self.n)]
        for sigma, beta in self.gm:
            phi = math.exp(-beta * self.dt)
            q = sigma * math.sqrt(1 - phi * phi)
            x = sigma * self.rng.gauss(0, 1)
            for i in range(self.n):
                out[i] += x
                x = phi * x + q * self.rng.gauss(0, 1)
        if self.K:
            x, q = 0.0, self.K * math.sqrt(self.dt)
            for i in range(self.n):
                out[i] += x
                x += q * self.rng.gauss(0, 1)
        return out

    def add(self, name: str, condition: dict, rate_of: dict[str, list[float]] | None = None, reference: bool = False) -> dict:
        rates = rate_of or {}
        columns = {}
        for a in self.axes:
            noise = self.noise()
            w = rates.get(a)
            columns["g" + a] = [v + self.bias[a] + (w[i] if w else 0.0) for i, v in enumerate(noise)]
        if reference:
            for a, w in rates.items():
                columns["r" + a] = list(w)
        self.recordings.append({"name": name, "condition": condition, "columns": columns, "units": {}, "t": None})
        return self.recordings[-1]

    def static(self, name: str) -> dict:
        return self.add(name, {"kind": "static"})

    def constant(self, name: str, axis: str, value: float) -> dict:
        return self.add(name, {"kind": "constant_rate", "axis": axis, "value": value, "unit": "deg/s"}, {axis: [value] * self.n})

    def profile(self, name: str) -> dict:
        waves = [(0.005 * 60 ** self.rng.random(), self.rng.uniform(10, 40), 2 * math.pi * self.rng.random()) for _ in range(6)]
        self.waves = waves
        w = [self.motion(i * self.dt) for i in range(self.n)]
        return self.add(name, {"kind": "profile"}, {"z": w}, reference=True)

    def motion(self, t: float) -> float:
        return sum(a * (math.sin(2 * math.pi * f * t + p) - math.sin(p)) for f, a, p in self.waves)

    def write(self, folder: Path, ident: str) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        entries = []
        for recording in self.recordings:
            names = list(recording["columns"])
            stamps = recording["t"]
            digits = max(0, -math.floor(math.log10(self.step) + 1e-9)) if self.step < 1 else 0
            digits = max(digits, 4)
            with gzip.open(folder / (recording["name"] + ".csv.gz"), "wt", compresslevel=1) as out:
                out.write(",".join((["t"] if stamps else []) + names) + "\n")
                for i in range(len(recording["columns"][names[0]])):
                    row = [f"{stamps[i]:.6f}"] if stamps else []
                    for name in names:
                        v = recording["columns"][name][i]
                        row.append(f"{v:.6f}" if name[0] == "r" else f"{self.step * round(v / self.step):.{digits + 2}f}" if self.step > 1e-3 else f"{v:.{digits}f}")
                    out.write(",".join(row) + "\n")
            columns = {"t": {"quantity": "time", "unit": "s"}} if stamps else {}
            for name in names:
                quantity = "angular_rate" if name[0] == "g" else "reference_angular_rate"
                columns[name] = {"quantity": "temperature", "unit": "degC"} if name == "T" else {
                    "quantity": quantity, "axis": name[1], "unit": "deg/s"}
            entries.append({"id": recording["name"], "file": recording["name"] + ".csv.gz", "rate_hz": recording.get("rate_hz", self.rate), "columns": columns,
                            "condition": recording["condition"], "trim": {"start_s": 0, "end_s": 0}})
        baseline: dict = {"kind": "auto"}
        (folder / "study.json").write_text(json.dumps({"device": {"id": ident, "model": "made", "imu": "made", "serial": ident}, "recordings": entries,
                                                       "baseline": baseline}, indent=1))


def null(rng: random.Random, k: int) -> tuple[str, World, list[str]]:
    kinds = ["static-wn", "static-gm", "static-3gm", "static-rw", "static-t5", "table-wn", "table-gm", "table-3gm", "table-axes", "profile-wn", "profile-gm",
             "lattice-fine", "lattice-coarse", "lattice-table", "tactical-table", "short", "many", "10hz", "200hz", "stamped"]
    kind = kinds[k % len(kinds)]
    base = {"static-gm": "gm", "static-3gm": "3gm", "static-rw": "rw", "static-t5": "t5", "table-gm": "gm", "table-3gm": "3gm", "profile-gm": "gm",
            "tactical-table": "tactical", "many": "gm"}.get(kind, "wn")
    rate = {"10hz": 10.0, "200hz": 200.0}.get(kind, rng.choice([25.0, 50.0]))
    seconds = {"short": 60.0, "200hz": 200.0, "10hz": 1200.0}.get(kind, rng.choice([300.0, 500.0]))
    world = World(rng, rate, seconds, "xz" if kind == "table-axes" else "z", base)
    allowed: list[str] = ["heavy_tailed_noise"] if base == "t5" else []
    sd = world.N / math.sqrt(world.dt)
    if kind.startswith("lattice"):
        world.step = round(sd * {"lattice-fine": 0.3, "lattice-coarse": rng.uniform(0.4, 2.0), "lattice-table": rng.uniform(0.4, 2.0)}[kind], 6)
        allowed.append("output_resolution")
    if kind == "tactical-table":
        world.step = 1e-6
    if kind in ("static-wn", "static-gm", "static-3gm", "static-rw", "static-t5", "lattice-fine", "lattice-coarse", "short", "10hz", "200hz", "stamped"):
        for i in range(2 + rng.randrange(2)):
            recording = world.static(f"static-{i + 1}")
            if kind == "stamped":
                recording["t"] = [round(j * world.dt, 6) for j in range(world.n)]
    elif kind == "many":
        for i in range(8):
            world.static(f"static-{i + 1}")
    elif kind.startswith("profile"):
        world.static("static-1")
        world.profile("profile-1")
    else:
        world.static("static-1")
        world.static("static-2")
        for value in (18.0, -36.0, 72.0):
            world.constant(f"rate-{value:g}", "z", value)
    return kind, world, allowed


def effect(rng: random.Random, cause: str) -> World:
    rate, seconds = rng.choice([25.0, 50.0, 100.0]), rng.choice([300.0, 500.0])
    base = rng.choice(["wn", "gm"])
    world = World(rng, rate, seconds, "xz" if cause == "swapped_axes" else "z", base)
    world.step = 1e-4
    sd = world.N / math.sqrt(world.dt)
    table = cause in ("turned_sign", "swapped_axes", "unit_error")
    clock = cause in ("clock_jump", "sampling_rate_change")
    if cause in ("heading_dependent_bias", "biases_at_headings"):
        return at_headings(rng, world, cause)
    if cause in ("reference_noise", "coarse_reference"):
        return beside_reference(rng, world, cause)
    if table:
        world.static("static-1")
        world.static("static-2")
        for value in (20.0, -45.0, 90.0):
            world.constant(f"rate-{value:g}", "z", value)
    elif clock:
        world.static("static-1")
        world.profile("profile-1")
    else:
        for i in range(2):
            world.static(f"static-{i + 1}")
    if table:
        recording = world.recordings[2 + rng.randrange(3)]
        columns = recording["columns"]
        if cause == "turned_sign":
            columns["gz"] = [-v for v in columns["gz"]]
        elif cause == "swapped_axes":
            columns["gx"], columns["gz"] = columns["gz"], columns["gx"]
        else:
            recording = world.recordings[1 + rng.randrange(4)]
            recording["columns"]["gz"] = [v * DEGREE for v in recording["columns"]["gz"]]
            world.step = 1e-6
        return world
    if clock:
        recording = world.recordings[1]
        t0 = seconds * rng.uniform(0.35, 0.6)
        size = rng.choice([-1, 1]) * (rng.uniform(0.02, 0.08) if cause == "clock_jump" else rng.uniform(4e-4, 1e-3))
        for i in range(world.n):
            t = i * world.dt
            if t >= t0:
                read = t - size if cause == "clock_jump" else t0 + (t - t0) * (1 + size)
                recording["columns"]["gz"][i] += world.motion(read) - world.motion(t)
        return world
    phase = 2 * math.pi * rng.random()
    samples = 2 * world.n
    f0, f1, fm = rng.uniform(0.1, 0.2) * rate, rng.uniform(0.25, 0.4) * rate, rng.uniform(0.02, 0.05)
    dwell = rng.uniform(15, 45)
    quality, fr = rng.uniform(3, 15), rng.uniform(0.08, 0.4) * rate
    burst_left, state = 0.0, 0j
    for recording in world.recordings:
        y = recording["columns"]["gz"]
        if cause == "duplicated_blocks":
            at = 500
            while at < world.n - 500:
                length = rng.randrange(40, 200)
                y[at:at + length] = y[at - length:at]
                at += length + rng.randrange(1500, 4000)
        elif cause == "interpolated_samples":
            recording["columns"]["gz"] = [y[i] if i % 2 == 0 else 0.5 * (y[i - 1] + y[min(i + 1, world.n - 1 - (world.n - 1) % 2)]) for i in range(world.n)]
        elif cause == "averaged_samples":
            m = rng.choice([2, 3, 4]) if recording is world.recordings[0] else m
            recording["columns"]["gz"] = [sum(y[max(0, i - m + 1):i + 1]) / min(m, i + 1) for i in range(world.n)]
        elif cause == "bursty_clock":
            length = rng.choice([5, 8, 16]) if recording is world.recordings[0] else length
            recording["t"] = [round((i - i % length + length) * world.dt + 2e-5 * (i % length), 6) for i in range(world.n)]
        elif cause == "random_telegraph_noise":
            a = 1.0 * world.N * rng.uniform(0.9, 1.2)
            side = a
            for i in range(world.n):
                y[i] += side
                if rng.random() < 1 - math.exp(-world.dt / dwell):
                    side = -side
        elif cause == "chirped_disturbance":
            a = 30 * sd * math.sqrt(2 / samples)
            for i in range(world.n):
                t = i * world.dt
                y[i] += a * math.sin(2 * math.pi * (f0 * t + 0.5 * (f1 - f0) / seconds * t * t) + phase)
        elif cause == "modulated_disturbance":
            a = 20 * sd * math.sqrt(16 / 3 / samples)
            for i in range(world.n):
                t = i * world.dt
                y[i] += 0.5 * a * (1 + math.cos(2 * math.pi * fm * t)) * math.sin(2 * math.pi * f0 * t + phase)
        elif cause == "resonance":
            # The peak is 0.3 to 1.2 of the white noise's density: 2 Q sigma^2/w = height N^2 (two-sided).
            height = rng.uniform(0.3, 1.2) if recording is world.recordings[0] else height
            w = 2 * math.pi * fr
            sigma = math.sqrt(height * world.N ** 2 * w / (2 * quality))
            damping = w / (2 * quality)
            turn = math.sqrt(w * w - damping * damping)
            e, c, s = math.exp(-damping * world.dt), math.cos(turn * world.dt), math.sin(turn * world.dt)
            f11, f12, f21, f22 = e * (c + damping / turn * s), e * s / turn, -e * s * w * w / turn, e * (c - damping / turn * s)
            p11, p22 = sigma ** 2, (sigma * w) ** 2
            q11 = p11 - (f11 * f11 * p11 + f12 * f12 * p22)
            q12 = -(f11 * f21 * p11 + f12 * f22 * p22)
            q22 = p22 - (f21 * f21 * p11 + f22 * f22 * p22)
            l11 = math.sqrt(max(q11, 0.0))
            l21 = q12 / l11 if l11 > 0 else 0.0
            l22 = math.sqrt(max(q22 - l21 * l21, 0.0))
            x, v = sigma * rng.gauss(0, 1), sigma * w * rng.gauss(0, 1)
            for i in range(world.n):
                y[i] += x
                a1, a2 = rng.gauss(0, 1), rng.gauss(0, 1)
                x, v = f11 * x + f12 * v + l11 * a1, f21 * x + f22 * v + l21 * a1 + l22 * a2
        elif cause == "vibration_bursts":
            for i in range(world.n):
                if burst_left <= 0 and rng.random() < world.dt / 70:
                    burst_left = rng.uniform(5, 20)
                damping = math.exp(-math.pi * 0.6 * world.dt)
                turn = complex(math.cos(2 * math.pi * f1 * world.dt), math.sin(2 * math.pi * f1 * world.dt))
                state = state * damping * turn + math.sqrt(1 - damping * damping) * complex(rng.gauss(0, 1), rng.gauss(0, 1))
                y[i] += 0.45 * sd * state.real if burst_left > 0 else 0.0
                burst_left -= world.dt
    return world


def at_headings(rng: random.Random, world: World, cause: str) -> World:
    """Static recordings all round: the bias goes with the heading, or it merely differs from switching on to switching on."""
    count = rng.choice([4, 6, 8, 12])
    phase = 360 * rng.random()
    sd = world.N / math.sqrt(world.n * world.dt)
    amplitude = sd * rng.uniform(12, 40)
    for k in range(count):
        heading = round((360 * k / min(count, 6)) % 360, 1)
        recording = world.add(f"static-{k + 1}", {"kind": "static", "heading_deg": heading})
        shift = amplitude * math.cos(math.radians(heading - phase)) if cause == "heading_dependent_bias" else rng.gauss(0, amplitude / math.sqrt(2))
        recording["columns"]["gz"] = [v + shift for v in recording["columns"]["gz"]]
    return world


def beside_reference(rng: random.Random, world: World, cause: str) -> World:
    """A profile whose reference column is noisy, or rounded to a coarse step."""
    world.static("static-1")
    sd = world.N / math.sqrt(world.dt)
    level = sd * rng.uniform(0.3, 1.5)
    for k in range(2):
        column = world.profile(f"profile-{k + 1}")["columns"]
        if cause == "reference_noise":
            column["rz"] = [v + rng.gauss(0, level) for v in column["rz"]]
        else:
            step = math.sqrt(12) * level
            column["rz"] = [step * round(v / step) for v in column["rz"]]
    return world


CAUSES = ["turned_sign", "swapped_axes", "unit_error", "clock_jump", "sampling_rate_change", "duplicated_blocks", "interpolated_samples", "averaged_samples",
          "bursty_clock", "random_telegraph_noise", "chirped_disturbance", "modulated_disturbance", "vibration_bursts", "resonance",
          "heading_dependent_bias", "biases_at_headings", "reference_noise", "coarse_reference"]
# Kinds of studies that bear another name than what is hidden in them.
NAMES = {"biases_at_headings": "turn_on_bias", "coarse_reference": "reference_noise"}


def main() -> None:
    parser = argparse.ArgumentParser(description="Writes fresh studies, most of them without any effect.")
    parser.add_argument("folder")
    parser.add_argument("--nulls", type=int, default=120)
    parser.add_argument("--effects", type=int, default=4, help="studies of each cause")
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--only", nargs="*", default=CAUSES, choices=CAUSES, help="these effects alone")
    given = parser.parse_args()
    folder = Path(given.folder)
    answers: dict[str, dict] = {}
    for k in range(given.nulls):
        rng = random.Random(given.seed * 100003 + k)
        kind, world, allowed = null(rng, k)
        world.write(folder / "cases" / f"n{k:04d}", f"n{k:04d}")
        answers[f"n{k:04d}"] = {"group": "null", "kind": kind, "allowed": allowed}
    for c, cause in enumerate(CAUSES):
        for k in range(given.effects if cause in given.only else 0):
            rng = random.Random(given.seed * 200003 + 1000 * c + k)
            ident = f"e{c:02d}{k:02d}"
            effect(rng, cause).write(folder / "cases" / ident, ident)
            answers[ident] = {"group": "listed", "kind": cause, "cause": NAMES.get(cause, cause), "allowed": []}
    (folder / "answers.json").write_text(json.dumps({"cases": answers}, indent=1))


if __name__ == "__main__":
    main()
