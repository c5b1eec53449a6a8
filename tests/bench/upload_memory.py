#!/usr/bin/env python3
"""Resident memory of the daemon while it takes a large upload, which is made up as it is sent and stored nowhere else.

usage: upload_memory.py [MEBIBYTES]     (default 2048; DRIFTLABD is the daemon, TMPDIR needs three times the room)

Prints VmHWM and VmRSS before and after. The high-water mark counts mapped pages of the column file too, as far as the
system keeps them resident; RssAnon is what the daemon itself allocated.
"""
from __future__ import annotations

import argparse
import hashlib
import http.client
import random
import struct
import sys
import time
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
from daemon import Daemon  # noqa: E402 - beside the tests

PIECE = 1 << 20


@dataclass
class Figures:
    megabytes: float
    seconds: float
    before_kib: dict[str, int]
    after_kib: dict[str, int]

    @property
    def growth_mib(self) -> float:
        return (self.after_kib["VmHWM"] - self.before_kib["VmHWM"]) / 1024


def npy_pieces(doubles: int) -> Iterator[bytes]:
    """A header for one column of float64, then noise: a seeded block of 2^17 doubles, shifted a little each time."""
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({doubles},), }}".encode()
    header += b" " * (63 - (10 + len(header)) % 64) + b"\n"
    yield b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header
    generator = random.Random(1)
    block = array("d", (generator.gauss(0.0, 1.0) for _ in range(PIECE // 8)))
    while doubles > 0:
        block[generator.randrange(len(block))] = generator.gauss(0.0, 1.0)
        count = min(doubles, len(block))
        yield block[:count].tobytes()
        doubles -= count


def measure(mebibytes: int) -> Figures:
    doubles = mebibytes * (1 << 20) // 8
    names = ("VmHWM", "VmRSS", "RssAnon")
    with Daemon() as daemon:
        small = daemon.upload(b"gz\n1\n2\n3\n", device="warm-up", rate_hz=100)  # every code path has run once
        assert small.status == 201, small.describe()
        before = {name: daemon.memory_kib(name) for name in names}
        length = doubles * 8 + 128
        pieces = npy_pieces(doubles)
        first = next(pieces)
        assert len(first) == 128
        digest = hashlib.sha256(first)
        connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=600)
        connection.putrequest("POST", "/v1/recordings?device=big&condition=static&rate_hz=100&columns=0=angular_rate:z:deg/s")
        connection.putheader("Content-Length", str(length))
        connection.endheaders()
        started = time.monotonic()
        connection.send(first)
        for piece in pieces:
            digest.update(piece)
            connection.send(piece)
        response = connection.getresponse()
        body = response.read()
        seconds = time.monotonic() - started
        connection.close()
        assert response.status == 201, body
        assert digest.hexdigest().encode() in body, "the stored digest is another"
        after = {name: daemon.memory_kib(name) for name in names}
    return Figures(length / 1e6, seconds, before, after)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("mebibytes", nargs="?", type=int, default=2048)
    figures = measure(parser.parse_args().mebibytes)
    print(f"{figures.megabytes:.0f} MB in {figures.seconds:.1f} s ({figures.megabytes / figures.seconds:.0f} MB/s, sending and answering)")
    for name in figures.before_kib:
        print(f"{name:8} {figures.before_kib[name] / 1024:8.1f} MiB before {figures.after_kib[name] / 1024:8.1f} MiB after")
    print(f"growth of the high-water mark: {figures.growth_mib:.1f} MiB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
