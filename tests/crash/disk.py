"""A disk that fails on demand, and a power cut: the daemon runs on tests/crash/fault_shim.cpp."""
from __future__ import annotations

import errno
import mmap
import os
import shutil
import struct
import subprocess
from pathlib import Path

SHIM = os.environ.get("DRIFTLAB_FAULT_SHIM", "")
KINDS = {"read": 1, "write": 2, "fsync": 3, "rename": 4}
ERRORS = {"EIO": errno.EIO, "ENOSPC": errno.ENOSPC}
FOR_EVER = 1 << 40


class Disk:
    """The files below a directory, which must be there. `powered`: what is not synced is lost at `cut_power`."""

    def __init__(self, data: Path, *, powered: bool = False) -> None:
        self.data = data.resolve()
        self.control_file = data.parent / f"{data.name}.control"
        self.control_file.write_bytes(bytes(40))
        with self.control_file.open("r+b") as file:
            self.control = mmap.mmap(file.fileno(), 40)
        self.shadow = data.parent / f"{data.name}.shadow" if powered else None
        if self.shadow:
            self.keep_all()

    @property
    def environment(self) -> dict[str, str]:
        shadow = {"DRIFTLAB_FAULT_SHADOW": str(self.shadow)} if self.shadow else {}
        return {"LD_PRELOAD": SHIM, "DRIFTLAB_FAULT_BELOW": str(self.data), "DRIFTLAB_FAULT_CONTROL": str(self.control_file), **shadow}

    # --- faults

    def arm(self, kind: str, *, passes: int = 0, error: str = "EIO", fails: int = 1) -> None:
        """After `passes` calls of the kind (read, write, fsync, rename) the next `fails` fail."""
        self.control[8:40] = struct.pack("=4q", passes, ERRORS[error], fails, 0)
        self.control[0:8] = struct.pack("=q", KINDS[kind])

    def disarm(self) -> int:
        """How many calls have failed since it was armed."""
        self.control[0:8] = bytes(8)
        return int(struct.unpack("=q", self.control[32:40])[0])

    # --- power

    def identities(self) -> dict[str, tuple[str, str]]:
        """Path below the directory (empty: itself) -> (what it is: d or f, its identity as the shim writes it)."""
        paths = [self.data, *self.data.rglob("*")]
        listed = subprocess.run(["stat", "--printf", r"%F|%i|%.9W\n", "--", *map(str, paths)], capture_output=True, text=True, check=True).stdout
        found = {}
        for path, line in zip(paths, listed.splitlines(), strict=True):
            kind, inode, born = line.split("|")
            seconds, _, fraction = born.partition(".")
            assert int(seconds) > 0, "the file system does not say when a file was made"
            name = path.relative_to(self.data).as_posix() if path != self.data else ""
            found[name] = ("d" if kind == "directory" else "f", f"{inode}-{seconds}-{int(fraction)}")
        return found

    def keep_all(self) -> None:
        """Everything that is there now is on disk for certain."""
        assert self.shadow is not None
        shutil.rmtree(self.shadow, ignore_errors=True)
        self.shadow.mkdir()
        found = self.identities()
        for path, (kind, identity) in found.items():
            if kind == "f":
                shutil.copyfile(self.data / path, self.shadow / identity)
                continue
            inside = [(below, of) for below, of in found.items() if below and os.path.dirname(below) == path]
            text = "".join(f"{of[0]} {of[1]} {os.path.basename(below)}\n" for below, of in inside)
            (self.shadow / identity).write_text(text)

    def cut_power(self) -> None:
        """What was not on disk for certain is gone. No process may have files of the directory open."""
        assert self.shadow is not None
        root = self.identities()[""][1]
        after = self.data.parent / f"{self.data.name}.after"
        self._bring_back(root, after)
        shutil.rmtree(self.data)
        after.rename(self.data)
        self.keep_all()

    def _bring_back(self, folder: str, target: Path) -> None:
        assert self.shadow is not None
        target.mkdir()
        names = self.shadow / folder
        for line in names.read_text().splitlines() if names.exists() else []:
            kind, identity, name = line.split(" ", 2)
            if kind == "d":
                self._bring_back(identity, target / name)
            elif (self.shadow / identity).exists():
                shutil.copyfile(self.shadow / identity, target / name)
            else:
                (target / name).touch()  # its name is on disk, its content never was
