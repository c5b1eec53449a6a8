"""Recordings of one firmware and another, for the suites of regression runs."""
from __future__ import annotations

import random


def gyroscope(seed: int, white: float, scale: float = 1.0, rows: int = 12000) -> str:
    """A gyroscope axis at rest, stamped, 20 Hz: white noise and a little of slow noise, both times `scale`.

    Where a pass must be certain the candidate is the baseline's noise times 1.01: that chance alone leaves a fifth of unchanged devices
    undecided is for tests/accuracy to say.
    """
    draw = random.Random(seed)
    slow, lines = 0.0, ["t [s],gz [deg/s]"]
    for row in range(rows):
        slow = 0.999 * slow + 0.002 * draw.gauss(0.0, 1.0)
        lines.append(f"{row * 0.05:.3f},{scale * (white * draw.gauss(0.0, 1.0) + slow):.6f}")
    return "\n".join(lines) + "\n"
