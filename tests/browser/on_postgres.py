"""Runs a browser suite on daemons whose rows are in PostgreSQL: `on_postgres.py COMMAND...`; 77 where there is none.

The server is the tests' own (tests/api/postgres.py) and ends with the command; world.mjs gives every daemon a schema of it.
"""
from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import postgres  # noqa: E402 - beside the tests of the API


def main() -> int:
    if postgres.programs() is None:
        print("PAGES ON POSTGRESQL NOT TESTED: there is no PostgreSQL.")
        return 77
    server = postgres.cluster()
    return subprocess.run(sys.argv[1:], env={**os.environ, "DRIFTLAB_TEST_POSTGRES": str(server.folder)}).returncode


if __name__ == "__main__":
    raise SystemExit(main())
