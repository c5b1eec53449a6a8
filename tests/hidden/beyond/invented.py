#!/usr/bin/env python3
"""Writes studies for score.py whose effects have no name anywhere in driftlab.

    invented.py FOLDER [--studies 6] [--seed 515] [--z 30]

Sizes are those that an oracle sees at z standard deviations who knows base, place and shape: of a mean m over noise of deviation s
z^2 = sum m^2/s^2, of a modulation of the noise's power by 1 + d, z^2 = sum d^2/2. Beside slow noise, which s does not count, a slow
mean shows less: `oracle_z` of an answer is what one sees of it who knows the slow noise's law too. The answer of every study is
`unnamed`: what is said must not be another name with confidence. The seed fixes everything; none of driftlab's code is used. Standard library only.
"""
from __future__ import annotations

import argparse
import json
import math
import random
from collections.abc import Callable
from pathlib import Path

from fresh import World

Course = Callable[[int, float], float]


def scaled(world: World, shape: Course, total: float) -> float:
    """The factor of a shape whose squares sum to `total`."""
    square = sum(shape(r, i * world.dt) ** 2 for r in range(len(world.recordings)) for i in range(world.n))
    return math.sqrt(total / square)


def seen(world: World, mean: list[float]) -> float:
    """z^2 of a mean beside white and Gauss-Markov noise: the Kalman filter that whitens the noise, run over the mean."""
    sigma, beta = world.gm[0] if world.gm else (0.0, 1.0)
    phi = math.exp(-beta * world.dt)
    white, driven = world.N ** 2 / world.dt, sigma ** 2 * (1 - phi * phi)
    x, p, total = 0.0, sigma ** 2, 0.0
    for value in mean:
        innovation, variance = value - x, p + white
        total += innovation ** 2 / variance
        gain = p / variance
        x, p = phi * (x + gain * innovation), phi * phi * (1 - gain) * p + driven
    return total


def add_mean(world: World, shape: Course, z: float) -> float:
    """What an oracle sees of it who knows the slow noise too."""
    factor = world.N / math.sqrt(world.dt) * scaled(world, shape, z * z)
    total = 0.0
    for r, recording in enumerate(world.recordings):
        mean = [factor * shape(r, i * world.dt) for i in range(world.n)]
        total += seen(world, mean)
        y = recording["columns"]["gz"]
        for i, value in enumerate(mean):
            y[i] += value
    return math.sqrt(total)


def add_power(world: World, shape: Course, z: float) -> float:
    """Noise whose power is multiplied by 1 + d; made anew, for what is slow in it stays as it is."""
    factor = scaled(world, shape, 2 * z * z)
    sd = world.N / math.sqrt(world.dt)
    for r, recording in enumerate(world.recordings):
        y = recording["columns"]["gz"]
        for i in range(world.n):
            d = max(-0.9, factor * shape(r, i * world.dt))
            y[i] += sd * world.rng.gauss(0, 1) * math.sqrt(d) if d > 0 else 0.0
            if d < 0:
                y[i] = world.bias["z"] + (y[i] - world.bias["z"]) * math.sqrt(1 + d)
    return z


def filtered(world: World, taps: list[float], feedback: list[float]) -> None:
    """White noise alone, behind a filter."""
    for recording in world.recordings:
        sd = world.N / math.sqrt(world.dt)
        x = [0.0] * len(taps)
        y = [0.0] * len(feedback)
        out = []
        for _ in range(world.n):
            x = [sd * world.rng.gauss(0, 1), *x[:-1]]
            value = sum(t * v for t, v in zip(taps, x)) - sum(f * v for f, v in zip(feedback, y))
            y = [value, *y[:-1]] if feedback else y
            out.append(world.bias["z"] + value)
        recording["columns"]["gz"] = out


def rests(world: World, count: int = 3, warm: bool = False) -> Course:
    """Static recordings; their temperature, which goes up and down in each in a way of its own."""
    periods = [world.rng.uniform(150, 300) for _ in range(count)]
    phases = [2 * math.pi * world.rng.random() for _ in range(count)]

    def temperature(r: int, t: float) -> float:
        return 30 + 8 * math.sin(2 * math.pi * t / periods[r] + phases[r])
    for r in range(count):
        columns = world.static(f"static-{r + 1}")["columns"]
        if warm:
            columns["T"] = [temperature(r, i * world.dt) for i in range(world.n)]
    return temperature


def profiles(world: World) -> list[list[float]]:
    """A rest and two profiles; the rate of each recording."""
    world.static("static-1")
    rates = [[0.0] * world.n]
    for k in range(2):
        rates.append(list(world.profile(f"profile-{k + 1}")["columns"]["rz"]))
    return rates


def turning(world: World) -> list[float]:
    """A rest and three constant rates [deg/s]."""
    world.static("static-1")
    values = [18.0, -36.0, 72.0]
    for value in values:
        world.constant(f"rate-{value:g}", "z", value)
    return [0.0, *values]


def make(kind: str, world: World, z: float) -> float:
    """Puts the effect in; what an oracle sees of it."""
    rng = world.rng
    if kind in ("noise_by_temperature", "bias_by_temperature"):
        temperature = rests(world, warm=True)
        return (add_power if kind[0] == "n" else add_mean)(world, lambda r, t: math.sin(2 * math.pi * (temperature(r, t) - 22) / 8), z)
    elif kind in ("noise_by_angle", "bias_by_angle"):
        rates = turning(world)
        lobes = rng.choice([3, 4, 5])
        return (add_power if kind[0] == "n" else add_mean)(world, lambda r, t: math.cos(lobes * math.radians(rates[r] * t)) if rates[r] else 0.0, z)
    elif kind == "noise_by_sign_of_rate":
        rates_at = profiles(world)
        return add_power(world, lambda r, t: 1.0 if rates_at[r][min(int(t / world.dt + 0.5), world.n - 1)] > 5 else 0.0, z)
    elif kind == "bias_wavers_with_rate":
        rates_at = profiles(world)
        return add_mean(world, lambda r, t: math.sin(rates_at[r][min(int(t / world.dt + 0.5), world.n - 1)] / 6), z)
    elif kind == "swelling_in_time":
        rests(world)
        period, phase = rng.uniform(40, 90), 2 * math.pi * rng.random()
        return add_power(world, lambda r, t: math.sin(2 * math.pi * t / period + phase), z)
    elif kind == "quiet_spells":
        rests(world)
        spells = [(rng.randrange(3), rng.uniform(0, world.n * world.dt - 10)) for _ in range(6)]
        return add_power(world, lambda r, t: -1.0 if any(s[0] == r and s[1] <= t < s[1] + 10 for s in spells) else 0.0, z)
    elif kind == "pulses":
        rests(world)
        period, width = rng.uniform(5, 12), rng.uniform(0.05, 0.15)
        return add_mean(world, lambda r, t: 1.0 if t % period < width else 0.0, z)
    elif kind == "triangle_in_one":
        rests(world)
        middle, half = rng.uniform(0.3, 0.7) * world.n * world.dt, rng.uniform(20, 50)
        return add_mean(world, lambda r, t: max(0.0, 1 - abs(t - middle) / half) if r == 1 else 0.0, z)
    elif kind == "echo":
        rests(world)
        lag = rng.randrange(5, 12)
        filtered(world, [1.0, *[0.0] * (lag - 1), z / math.sqrt(3 * world.n)], [])
    elif kind == "notch":
        rests(world)
        turn = 2 * math.pi * rng.uniform(0.1, 0.25)
        zero, pole = 0.75, 0.55
        filtered(world, [1.0, -2 * zero * math.cos(turn), zero * zero], [-2 * pole * math.cos(turn), pole * pole])
    elif kind == "tilt":
        rests(world)
        # First difference of order a: density |2 sin(w/2)|^2a, of which the logarithm's variance is a^2 pi^2/3.
        a = z / math.sqrt(3 * world.n * math.pi ** 2 / 6)
        taps = [1.0]
        for k in range(1, 200):
            taps.append(taps[-1] * (k - 1 - a) / k)
        filtered(world, taps, [])
    elif kind == "lopsided":
        rests(world)
        # e + s (e^2 - 1): the third moment is 6 s, seen at 6 s sqrt(n/6).
        s = z / math.sqrt(6 * 3 * world.n)
        sd = world.N / math.sqrt(world.dt)
        for recording in world.recordings:
            recording["columns"]["gz"] = [world.bias["z"] + sd * (e + s * (e * e - 1)) for e in (rng.gauss(0, 1) for _ in range(world.n))]
    else:
        raise ValueError(kind)
    return z


KINDS = ["noise_by_temperature", "bias_by_temperature", "noise_by_angle", "bias_by_angle", "noise_by_sign_of_rate", "bias_wavers_with_rate", "swelling_in_time",
         "quiet_spells", "pulses", "triangle_in_one", "echo", "notch", "tilt", "lopsided"]


def write_studies(what: str, seed: int, letter: str, kinds: list[str], put_in: Callable[[str, World, float], float],
                  axes: dict[str, str] | None = None, allowed: dict[str, list[str]] | None = None) -> None:
    """The program of a set of kinds: `put_in` puts one into a world of its `axes` (z where nothing is said); `allowed` are facts besides."""
    parser = argparse.ArgumentParser(description=what)
    parser.add_argument("folder")
    parser.add_argument("--studies", type=int, default=6, help="of each kind")
    parser.add_argument("--seed", type=int, default=seed)
    parser.add_argument("--z", type=float, default=30.0)
    given = parser.parse_args()
    folder = Path(given.folder)
    answers: dict[str, dict] = {}
    for c, kind in enumerate(kinds):
        for k in range(given.studies):
            world = World(random.Random(given.seed * 300007 + 1000 * c + k), 50.0, 300.0, (axes or {}).get(kind, "z"), "wn" if k % 2 == 0 else "gm")
            oracle_z = put_in(kind, world, given.z)
            ident = f"{letter}{c:02d}{k:02d}"
            world.write(folder / "cases" / ident, ident)
            answers[ident] = {"group": "outside", "kind": kind, "cause": "unnamed", "allowed": (allowed or {}).get(kind, []), "oracle_z": round(oracle_z, 1)}
    (folder / "answers.json").write_text(json.dumps({"cases": answers}, indent=1))


if __name__ == "__main__":
    write_studies("Writes studies whose effects have no name.", 515, "i", KINDS, make)
