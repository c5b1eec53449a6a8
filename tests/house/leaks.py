#!/usr/bin/env python3
"""Fails on what may not be in the repository: secrets, paths of one machine, big files, shared recordings.

Shared recordings carry licences that forbid shipping them. Where $DRIFTLAB_SHARED (default ../shared) is there, every
file is compared with them by content; elsewhere that part is skipped, loudly. Fonts under the Open Font License may be
shipped, with its text beside them.
"""
from __future__ import annotations

import hashlib
import os
import re
from pathlib import Path

import tree

LARGEST = 1 << 20  # bytes; a recording of real length is larger, a fixture is not

# The patterns are written so that they do not match themselves.
LEAKS = {
    r"-----BEGIN [A-Z ]*PRIVATE KEY-----": "a private key",
    r"\b(AKIA|ASIA)[0-9A-Z]{16}\b": "a cloud access key",
    r"\bgh[pousr]_[A-Za-z0-9]{36}\b": "a GitHub token",
    r"\bxox[abprs]-[A-Za-z0-9-]{20,}": "a chat token",
    r"\bdl_[0-9A-Za-z]{30}_[0-9A-Za-z]{6}\b": "a driftlab token",
    r"\beyJ[A-Za-z0-9_-]{15,}\.eyJ[A-Za-z0-9_-]{15,}\.": "a signed web token",
    r"(?i)\b(password|passwd|secret|api_?key)\b\s*[:=]\s*[\"'][^\"'\s]{8,}[\"']": "a password",
    r"(?<![\w.~$}])/(home/[a-z]|Users/[A-Za-z]|root/|work/|mnt/[a-z]|media/[a-z])[\w./-]*": "a path of one machine",
}


def shared_digests(root: Path) -> dict[int, set[str]]:
    """Size -> SHA-256 of the shared files of that size, or nothing where there are none."""
    shared = Path(os.environ.get("DRIFTLAB_SHARED") or root.parent / "shared")
    digests: dict[int, set[str]] = {}
    for path in (shared.rglob("*") if shared.is_dir() else []):
        if path.suffix == ".woff2" or path.name.endswith("-OFL.txt"):
            continue
        if path.is_file() and 0 < path.stat().st_size <= LARGEST:
            digests.setdefault(path.stat().st_size, set()).add(hashlib.sha256(path.read_bytes()).hexdigest())
    if not digests:
        print(f"SKIPPED: comparison with shared recordings, for there are none in {shared} (set DRIFTLAB_SHARED)")
    return digests


def check(root: Path) -> list[str]:
    faults: list[str] = []
    shared = shared_digests(root)
    for path in tree.files(root):
        name = path.relative_to(root).as_posix()
        size = path.stat().st_size
        if size > LARGEST:
            faults.append(f"{name}: {size} bytes; nothing larger than {LARGEST} is committed")
            continue
        if size in shared and hashlib.sha256(path.read_bytes()).hexdigest() in shared[size]:
            faults.append(f"{name}: is a copy of a shared file, whose licence keeps it out")
        text = tree.text_of(path)
        for number, line in enumerate((text or "").split("\n"), start=1):
            for pattern, what in LEAKS.items():
                match = re.search(pattern, line)
                if match:
                    faults.append(f"{name}:{number}: {what} ({match.group(0)[:40]})")
    return faults


if __name__ == "__main__":
    tree.main(check)
