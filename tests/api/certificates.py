"""Authorities and certificates of a test's own, made by the program openssl."""
from __future__ import annotations

import socket
import subprocess
from pathlib import Path

CURVE = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2")


def can_be_made() -> bool:
    try:
        return subprocess.run(["openssl", "version"], check=False, capture_output=True).returncode == 0
    except OSError:
        return False


def openssl(*words: str) -> None:
    subprocess.run(["openssl", *words], check=True, capture_output=True)


def authority(folder: Path, name: str) -> Path:
    openssl("req", "-x509", *CURVE, "-subj", f"/CN={name}", "-keyout", str(folder / f"{name}.key"), "-out", str(folder / f"{name}.pem"))
    return folder / f"{name}.pem"


def certificate(folder: Path, signed_by: Path, host: str) -> tuple[Path, Path]:
    """A certificate of a server for one name, and its key."""
    chain, key, request, names = (folder / f"server.{kind}" for kind in ("pem", "key", "csr", "names"))
    openssl("req", "-new", *CURVE[:-2], "-subj", f"/CN={host}", "-keyout", str(key), "-out", str(request))
    names.write_text(f"subjectAltName=DNS:{host}\n")
    openssl("x509", "-req", "-in", str(request), "-CA", str(signed_by), "-CAkey", str(signed_by.with_suffix(".key")), "-CAcreateserial",
            "-days", "2", "-extfile", str(names), "-out", str(chain))
    return chain, key


def free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])
