"""Recordings made up for the tests: seeded white noise in every container the daemon reads. Standard library only."""
from __future__ import annotations

import array
import gzip
import lzma
import random
import struct
import subprocess
from collections.abc import Callable, Sequence


def noise(samples: int, columns: int = 1, seed: int = 1) -> list[list[float]]:
    """Columns of white noise whose values a decimal of six digits holds exactly."""
    generator = random.Random(seed)
    return [[round(generator.gauss(0.0, 1.0), 6) for _ in range(samples)] for _ in range(columns)]


def csv(columns: Sequence[Sequence[float]], names: Sequence[str] | None = None) -> bytes:
    """A header and rows; repr gives a double back bit for bit."""
    lines = [",".join(names or [f"c{i}" for i in range(len(columns))])]
    lines += [",".join(repr(value) for value in row) for row in zip(*columns)]
    return ("\n".join(lines) + "\n").encode()


def npy(columns: Sequence[Sequence[float]], *, shape: str | None = None, kind: str = "<f8", flat: bool = False) -> bytes:
    """Version 1.0 of the format, rows by columns in C order; `shape` lets the header lie."""
    rows = len(columns[0])
    honest = f"({rows},)" if flat else f"({rows}, {len(columns)})"
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape or honest}, }}".encode()
    header += b" " * (63 - (10 + len(header)) % 64) + b"\n"
    values = array.array("f" if kind == "<f4" else "d", columns[0] if len(columns) == 1 else (value for row in zip(*columns) for value in row))
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + values.tobytes()


def zstd(content: bytes) -> bytes:
    return subprocess.run(["zstd", "-q", "-c"], input=content, capture_output=True, check=True).stdout


COMPRESSIONS: dict[str, Callable[[bytes], bytes]] = {
    "none": lambda content: content,
    "gzip": lambda content: gzip.compress(content, 6, mtime=0),
    "xz": lzma.compress,
    "zstd": zstd,
}

GYRO_Z = "gz=angular_rate:z:deg/s"


def gyro_csv(samples: int = 512, seed: int = 1) -> bytes:
    """One gyroscope channel called gz."""
    return csv(noise(samples, 1, seed), ["gz"])
