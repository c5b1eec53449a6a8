#!/usr/bin/env python3
"""Writes a second set of studies for score.py whose effects have no name: other kinds than those of invented.py, made as those are.

    strange.py FOLDER [--studies 6] [--seed 616] [--z 30]

s is the deviation of the white noise, n the number of samples, e white noise of variance one; sums run over all recordings. What an
oracle sees at z standard deviations who knows place and shape and the law of everything else:

- a mean m: z^2 = sum m^2/s^2 (backlash, lock_in, knocks, one_sided_excursions, many_levels, wandering_scale, motion_memory,
  bias_by_warming). `oracle_z` is what is seen of it beside slow noise;
- power multiplied by 1 + d: z^2 = sum d^2/2 (two_populations, interleaved_noise, noise_by_direction_of_acceleration);
- two axes, each white and Gaussian on its own and uncorrelated, whose absolute values are ranked alike, by a Gaussian copula of
  correlation c: twice the expected logarithm of the likelihood ratio to independence is z^2 = -n log(1 - c^2) (shared_loudness);
- white noise that is e_t + q_t e_(t-1) over sqrt(1 + q_t^2): z^2 = sum q^2 to first order (colour_by_temperature, colour_by_rate);
- x_t = e_t + a |x_(t-1)|, whose spectrum is white: z^2 = a^2 n (1 - 2/pi) to first order (threshold_autoregression);
- density like exp(-|x/a|^p), p > 2: twice the expected logarithm of the likelihood ratio to the Gaussian of the same variance is z^2,
  2 n (log(p/(2 a Gamma(1/p))) - 1/p + log(2 pi e)/2), from which p (light_tails);
- even codes 1 + e wide, odd ones 1 - e: z = e sqrt(n), where the codes are narrow beside the noise (uneven_codes);
- GARCH(1, 1) has no closed form: its weight is sought until twice the logarithm of the likelihood ratio to constant variance, of the
  white noise drawn, is z^2 (garch).

The answer of every study is `unnamed`; that the codes of uneven_codes are coarse is true and may be said. Standard library only.
"""
from __future__ import annotations

import bisect
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from statistics import NormalDist

from fresh import World
from invented import Course, add_mean, add_power, profiles, rests, turning, write_studies


@contextmanager
def silent(world: World) -> Iterator[None]:
    """What is recorded here has its slow noise alone."""
    density, world.N = world.N, 0.0
    yield
    world.N = density


def add_white(world: World, noise_of: Callable[[int], list[float]], axis: str = "z") -> None:
    """To recordings made silent: the noise of each, in standard deviations of what the white noise would have been."""
    sd = world.N / math.sqrt(world.dt)
    for r, recording in enumerate(world.recordings):
        y = recording["columns"]["g" + axis]
        for i, value in enumerate(noise_of(r)):
            y[i] += sd * value


def gaussian(world: World) -> list[float]:
    return [world.rng.gauss(0, 1) for _ in range(world.n)]


def at(series: list[list[float]], world: World) -> Course:
    """A course that is held as samples."""
    return lambda r, t: series[r][min(int(t / world.dt + 0.5), world.n - 1)]


def grown(square: Callable[[float], float], wanted: float, high: float) -> float:
    """Where what grows from nothing is as large as wanted."""
    low = 0.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if square(middle) < wanted else (low, middle)
    return 0.5 * (low + high)


def random_times(world: World, mean_wait: float) -> list[float]:
    """A Poisson process over one recording."""
    times = [world.rng.expovariate(1 / mean_wait)]
    while times[-1] < world.n * world.dt:
        times.append(times[-1] + world.rng.expovariate(1 / mean_wait))
    return times[:-1]


def answers_to_events(world: World, mean_wait: float, tail: float, draw: Callable[[], float], answer: Callable[[float], float]) -> Course:
    """Each event is answered for `tail` seconds, with a size that is drawn."""
    series = []
    for _ in world.recordings:
        y = [0.0] * world.n
        for start in random_times(world, mean_wait):
            size = draw()
            first = math.ceil(start / world.dt)
            for i in range(first, min(world.n, first + int(tail / world.dt))):
                y[i] += size * answer(i * world.dt - start)
        series.append(y)
    return at(series, world)


def jumps(world: World, dwell: float, levels: list[float]) -> Course:
    """A Markov process that leaves a level for any other."""
    series = []
    for _ in world.recordings:
        ends = random_times(world, dwell)
        states = [world.rng.choice(levels)]
        for _ in ends:
            states.append(world.rng.choice([v for v in levels if v != states[-1]]))
        series.append([states[bisect.bisect(ends, i * world.dt)] for i in range(world.n)])
    return at(series, world)


def directions(rates: list[list[float]]) -> list[list[float]]:
    """The sign of the rate's change; 0 at rest."""
    return [[float((b > a) - (b < a)) for a, b in zip(w, [*w[1:], 2 * w[-1] - w[-2]])] for w in rates]


def heated(rates: list[list[float]], gain: float) -> list[list[float]]:
    """The square of the rate through a lag of first order, that takes the share `gain` of what is new at each sample."""
    series = []
    for w in rates:
        state, out = 0.0, []
        for value in w:
            state += gain * (value * value - state)
            out.append(state)
        series.append(out)
    return series


def locked(rate: float, threshold: float) -> float:
    """What two oscillators that lock within the threshold lose of the rate (a ring laser without dither)."""
    return math.copysign(math.sqrt(rate * rate - threshold * threshold), rate) - rate if abs(rate) > threshold else -rate


def garch(world: World, z: float) -> None:
    persistence = world.rng.uniform(0.95, 0.98)
    with silent(world):
        rests(world)
    drawn = [gaussian(world) for _ in world.recordings]

    def run(weight: float, u: list[float]) -> tuple[list[float], float]:
        power, out, ratio = 1.0, [], 0.0
        for value in u:
            x = math.sqrt(power) * value
            ratio += x * x - value * value - math.log(power)
            out.append(x)
            power = 1 - persistence + weight * x * x + (persistence - weight) * power
        return out, ratio
    weight = grown(lambda a: sum(run(a, u)[1] for u in drawn), z * z, 0.2)
    add_white(world, lambda r: run(weight, drawn[r])[0])


def light_tailed(world: World, divergence: float) -> Callable[[int], list[float]]:
    """Noise of variance one, less peaked than the Gaussian and so far from it."""
    def width(p: float) -> float:
        return math.sqrt(math.gamma(1 / p) / math.gamma(3 / p))

    def away(more: float) -> float:
        p = 2 + more
        return math.log(p / (2 * width(p) * math.gamma(1 / p))) - 1 / p + 0.5 * math.log(2 * math.pi * math.e)
    p = 2 + grown(away, divergence, 20.0)
    draw = world.rng
    return lambda r: [draw.choice([-1, 1]) * width(p) * draw.gammavariate(1 / p, 1) ** (1 / p) for _ in range(world.n)]


def coloured(world: World, shape: Course, z: float) -> None:
    """White noise whose correlation from sample to sample follows the shape."""
    count = len(world.recordings)
    factor = z / math.sqrt(sum(shape(r, i * world.dt) ** 2 for r in range(count) for i in range(world.n)))

    def noise(r: int) -> list[float]:
        u = gaussian(world)
        out = []
        for i in range(world.n):
            q = factor * shape(r, i * world.dt)
            out.append((u[i] + q * u[i - 1]) / math.sqrt(1 + q * q))
        return out
    add_white(world, noise)


def loud_together(world: World, correlation: float) -> None:
    normal = NormalDist()

    def loudness(g: float) -> float:
        return world.rng.choice([-1, 1]) * normal.inv_cdf(min(0.5 + 0.5 * normal.cdf(g), 1 - 1e-15))
    ranks = [gaussian(world) for _ in world.recordings]
    own = math.sqrt(1 - correlation ** 2)
    add_white(world, lambda r: [loudness(g) for g in ranks[r]], "x")
    add_white(world, lambda r: [loudness(correlation * g + own * h) for g, h in zip(ranks[r], gaussian(world))])


def uneven(world: World, z: float) -> None:
    rests(world)
    sd = world.N / math.sqrt(world.dt)
    world.step = round(sd * world.rng.uniform(0.25, 0.5), 6)
    wide = 1 + z / math.sqrt(len(world.recordings) * world.n)
    for recording in world.recordings:
        pairs = [divmod(v / world.step, 2.0) for v in recording["columns"]["gz"]]
        recording["columns"]["gz"] = [world.step * (2 * pair + (0 if rest < wide else 1)) for pair, rest in pairs]


def warming(world: World) -> Course:
    """Rests whose temperature has waves of many lengths, so that its change is no lagged copy of it; the change."""
    rests(world)
    changes = []
    for recording in world.recordings:
        draw = world.rng
        waves = [(draw.uniform(1, 3), 2 * math.pi / (25 * 8 ** draw.random()), 2 * math.pi * draw.random()) for _ in range(5)]
        times = [i * world.dt for i in range(world.n)]
        recording["columns"]["T"] = [30 + sum(a * math.sin(w * t + p) for a, w, p in waves) for t in times]
        changes.append([sum(a * w * math.cos(w * t + p) for a, w, p in waves) for t in times])
    return at(changes, world)


def make(kind: str, world: World, z: float) -> float:
    """Puts the effect in; what an oracle sees of it."""
    rng = world.rng
    if kind == "backlash":
        # Motion is fast beside the play, so that the play is taken up at once: half of it, against the direction of the last change.
        signs = at(directions(profiles(world)), world)
        return add_mean(world, lambda r, t: -signs(r, t), z)
    if kind == "lock_in":
        rates = profiles(world)
        power = world.N ** 2 / world.dt
        threshold = grown(lambda limit: sum(locked(v, limit) ** 2 for w in rates for v in w) / power, z * z, 20.0)
        rate_at = at(rates, world)
        return add_mean(world, lambda r, t: locked(rate_at(r, t), threshold), z)
    if kind == "garch":
        garch(world, z)
    elif kind == "two_populations":
        rests(world)
        return add_power(world, jumps(world, rng.uniform(1, 4), [0.0, 1.0]), z)
    elif kind == "knocks":
        # A mount that is damped critically, struck at random from both sides.
        rests(world)
        tau = rng.uniform(0.08, 0.2)

        def size() -> float:
            return rng.choice([-1, 1]) * rng.uniform(0.5, 1.5)
        return add_mean(world, answers_to_events(world, 20.0, 8 * tau, size, lambda t: t * math.exp(-t / tau)), z)
    elif kind == "one_sided_excursions":
        rests(world)
        tau = rng.uniform(2, 6)
        return add_mean(world, answers_to_events(world, 40.0, 8 * tau, lambda: rng.uniform(0.5, 1.5), lambda t: math.exp(-t / tau)), z)
    elif kind == "many_levels":
        rests(world)
        return add_mean(world, jumps(world, rng.uniform(10, 30), [-2.0, -1.0, 0.0, 1.0, 2.0]), z)
    elif kind == "uneven_codes":
        uneven(world, z)
    elif kind == "colour_by_temperature":
        with silent(world):
            temperature = rests(world, warm=True)
        coloured(world, lambda r, t: (temperature(r, t) - 30) / 8, z)
    elif kind == "colour_by_rate":
        with silent(world):
            values = turning(world)
        coloured(world, lambda r, t: values[r], z)
    elif kind == "threshold_autoregression":
        with silent(world):
            rests(world)
        a = z / math.sqrt(len(world.recordings) * world.n * (1 - 2 / math.pi))

        def noise(_: int) -> list[float]:
            out, last = [], 0.0
            for value in gaussian(world):
                last = value + a * (abs(last) - math.sqrt(2 / math.pi))
                out.append(last)
            return out
        add_white(world, noise)
    elif kind == "wandering_scale":
        rate_at = at(profiles(world), world)
        waves = [(rng.uniform(60, 120), 2 * math.pi * rng.random()) for _ in world.recordings]
        return add_mean(world, lambda r, t: rate_at(r, t) * math.sin(2 * math.pi * t / waves[r][0] + waves[r][1]), z)
    elif kind == "interleaved_noise":
        rests(world)
        every = rng.choice([2, 3, 4, 5])
        return add_power(world, lambda r, t: 1.0 if int(t / world.dt + 0.5) % every == 0 else 0.0, z)
    elif kind == "motion_memory":
        rates = profiles(world)
        return add_mean(world, at(heated(rates, world.dt / rng.uniform(10, 40)), world), z)
    elif kind == "noise_by_direction_of_acceleration":
        signs = at(directions(profiles(world)), world)
        return add_power(world, lambda r, t: max(0.0, signs(r, t)), z)
    elif kind == "shared_loudness":
        with silent(world):
            rests(world)
        loud_together(world, math.sqrt(-math.expm1(-z * z / (len(world.recordings) * world.n))))
    elif kind == "bias_by_warming":
        return add_mean(world, warming(world), z)
    elif kind == "light_tails":
        with silent(world):
            rests(world)
        add_white(world, light_tailed(world, z * z / (2 * len(world.recordings) * world.n)))
    else:
        raise ValueError(kind)
    return z


KINDS = ["backlash", "lock_in", "garch", "two_populations", "knocks", "one_sided_excursions", "many_levels", "uneven_codes",
         "colour_by_temperature", "colour_by_rate", "threshold_autoregression", "wandering_scale", "interleaved_noise", "motion_memory",
         "noise_by_direction_of_acceleration", "shared_loudness", "bias_by_warming", "light_tails"]


if __name__ == "__main__":
    write_studies("Writes studies whose effects have no name, of other kinds than invented.py.", 616, "s", KINDS, make,
                  {"shared_loudness": "xz"}, {"uneven_codes": ["output_resolution"]})
