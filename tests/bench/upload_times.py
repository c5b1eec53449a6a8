#!/usr/bin/env python3
"""How long one more upload takes a device that has many recordings already, and the counts of the store beside them.

usage: upload_times.py [RECORDINGS [UPLOADS]]     (default 100000 100; DRIFTLABD is the daemon; SQLite)

A daemon makes one recording; its row and that of its blob are copied by SQL for the same device, so that there are RECORDINGS of it. Their
files are not there: what is measured does not read them. Then UPLOADS small files are sent one behind the other. Prints medians and
the slowest.
"""
from __future__ import annotations

import sqlite3
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import samples  # noqa: E402 - beside the tests
from daemon import Daemon  # noqa: E402


def copy_rows(database: Path, copies: int) -> None:
    connection = sqlite3.connect(database)
    for table, changed in (("blobs", {"sha256": "printf('%064x', n)"}),
                           ("recordings", {"id": "printf('rec_%026d', n)", "blob_sha256": "printf('%064x', n)"})):
        columns = [row[1] for row in connection.execute(f"PRAGMA table_info({table})")]
        values = ", ".join(changed.get(column, column) for column in columns)
        connection.execute(f"WITH RECURSIVE many (n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM many WHERE n < ?) INSERT INTO {table} ({', '.join(columns)}) "
                           f"SELECT {values} FROM many, (SELECT * FROM {table} LIMIT 1)", (copies,))
    connection.commit()
    connection.close()


def upload(daemon: Daemon, number: int) -> None:
    answer = daemon.upload(samples.gyro_csv(256) + f"{number / 1e6:.6f}\n".encode(), device="unit", rate_hz=100, columns=samples.GYRO_Z)
    assert answer.status == 201, answer.describe()


def main() -> None:
    recordings, uploads = (int(given) for given in (sys.argv[1:] + ["100000", "100"][len(sys.argv) - 1:]))
    allowed = ("--budget", f"recordings_per_device={2 * recordings + uploads}")
    with tempfile.TemporaryDirectory() as folder:
        with Daemon(Path(folder) / "d", arguments=allowed) as daemon:
            upload(daemon, 0)
        copy_rows(Path(folder) / "d/driftlab.db", recordings - 1)
        with Daemon(Path(folder) / "d", arguments=allowed) as daemon:
            for name, ask in (("upload", lambda i: upload(daemon, i + 1)), ("counts", lambda i: daemon.get(f"/v1/counts?since=2020-01-01T00:00:{i % 60:02d}Z"))):
                took = []
                for i in range(uploads):
                    begun = time.monotonic()
                    ask(i)
                    took.append(1e3 * (time.monotonic() - begun))
                print(f"{name} beside {recordings:,} recordings of the device: median {statistics.median(took):.1f} ms, slowest {max(took):.1f} ms", flush=True)


if __name__ == "__main__":
    main()
