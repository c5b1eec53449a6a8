#!/usr/bin/env python3
"""From a recording to its noise model, without a server: simulates a gyroscope at rest and on a table, and compares the two.

usage: first_steps.py [FOLDER]    the recordings and a figure are written there
"""
from __future__ import annotations

import sys
from pathlib import Path

from driftlab import local


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    curves = []
    for condition in ("static", "constant_rate:z:9:deg/s"):
        name = folder / (condition.partition(":")[0] + ".csv")
        local.simulate(name, condition=condition, duration_s=600)
        channel = local.characterise(name, rate_hz=100, condition=condition).channel("gz")
        best = channel.best
        print(f"{condition}: {best['model'] if best else 'no model'}")
        for row in channel.rows():
            if row["method"] == "gmwm" and row["value"] is not None:
                print(f"  {row['parameter']} = {row['value']:.4g} [{row['value.low']:.4g}, {row['value.high']:.4g}] {row['value.unit']}")
        curves.append(channel.allan)
    (folder / "allan.svg").write_text(curves[0].svg(*curves[1:]), "utf-8")


if __name__ == "__main__":
    main()
