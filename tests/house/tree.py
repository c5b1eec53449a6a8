"""The files of the repository, and how a house check reports."""
from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

BUILT = {"build", ".git", "node_modules", "__pycache__"}


def files(root: Path) -> list[Path]:
    """Every file git knows or would add, or, outside a work tree, every file that no build made. Absolute, sorted."""
    listed = subprocess.run(
        ["git", "-c", "safe.directory=*", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        capture_output=True, check=False)
    if listed.returncode == 0 and (root / ".git").exists():
        found = [root / name for name in listed.stdout.decode().split("\0") if name]
    else:
        found = [path for path in root.rglob("*") if not BUILT & set(path.relative_to(root).parts)]
    return sorted(path for path in found if path.is_file())


def text_of(path: Path) -> str | None:
    """The file as text; nothing where it is binary."""
    data = path.read_bytes()
    return None if b"\0" in data[:8192] else data.decode(errors="replace")


def main(check: Callable[[Path], list[str]]) -> None:
    """Runs a check over the tree given as argument (default: this repository) and exits 1 where it finds something."""
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
    found = check(root)
    print("\n".join(found) if found else "clean")
    sys.exit(1 if found else 0)
