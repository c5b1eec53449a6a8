"""What suites of operation share: recordings, programs, ports and flipped bits."""
from __future__ import annotations

import socket
import subprocess
from pathlib import Path

from daemon import PATIENCE_S


def csv(rows: int, seed: int = 1) -> bytes:
    return ("t [s],gz [deg/s]\n" + "".join(f"{i / 100:.2f},{(i * 7919 + seed * 131) % 101 / 100:.2f}\n" for i in range(rows))).encode()


def tool(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE_S, check=False)


def free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


def flip(path: Path, at: int = -100) -> None:
    content = bytearray(path.read_bytes())
    content[at] ^= 4
    path.chmod(0o600)
    path.write_bytes(bytes(content))
