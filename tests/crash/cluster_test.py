"""Two daemons and two workers on one PostgreSQL database; kill -9 of any of them, and of the database, by a seeded schedule.

What clients were told is a history that is checked at the end (shared_store.py). The server keeps `fsync` off: processes die here, the
machine does not. hosts_test.py does the same over a network.
"""
from __future__ import annotations

import os
import random
import tempfile
import time
import unittest
from pathlib import Path

import postgres
from daemon import PATIENCE_S, Daemon
from shared_store import Client, Judge, Told

ROUNDS = int(os.environ.get("DRIFTLAB_CLUSTER_ROUNDS", "5"))
SEED = int(os.environ.get("DRIFTLAB_CLUSTER_SEED", "20261124"))
DAEMONS = ("a", "b")
WORKERS = ("worker 1", "worker 2")
FAULTS = 3  # in a round
UPLOADS = 6

if postgres.programs() is None:
    print("SEVERAL DAEMONS NOT TESTED: there is no PostgreSQL.")
    raise SystemExit(77)


class Cluster:
    """The processes of one database, each of which may be dead."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.database = postgres.cluster()
        self.store = self.database.store_of(folder)
        self.running: dict[str, Daemon] = {}

    def start(self, name: str) -> None:
        together = ("--store", self.store, "--blobs", str(self.folder / "shared"), "--budget", "reserve_bytes=0", "--workers", "1")
        self.running[name] = Daemon(self.folder / name, arguments=(*(("worker",) if name in WORKERS else ()), *together))

    def kill(self, name: str) -> None:
        if name == "database":
            self.database.stop()
            self.database.start()
        else:
            self.running.pop(name).kill()
            self.start(name)

    def daemons(self) -> list[Daemon]:
        running = dict(self.running)
        return [running[name] for name in DAEMONS if name in running]

    def end(self) -> None:
        for daemon in self.running.values():
            daemon.kill()


class Uploader(Client):
    def run(self) -> None:
        until = time.monotonic() + 2 * PATIENCE_S
        for _ in range(UPLOADS):
            content = self.content()
            while (job := self.ask(content)) is None:
                if time.monotonic() > until:
                    self.failure = "no daemon served a client in time"
                    return
                time.sleep(0.1)
            self.read(job)


class Killed(Judge):
    def test_nothing_is_lost_or_done_twice_whatever_dies(self) -> None:
        for number in range(ROUNDS):
            with self.subTest(round=number, seed=SEED + number):
                self.round(SEED + number)

    def round(self, seed: int) -> None:
        schedule = random.Random(seed)
        with tempfile.TemporaryDirectory() as folder:
            cluster, told = Cluster(Path(folder)), Told()
            try:
                for name in (*DAEMONS, *WORKERS):
                    cluster.start(name)
                clients = [Uploader(cluster.daemons, told, schedule.randrange(1 << 30)) for _ in range(2)]
                for client in clients:
                    client.start()
                for _ in range(FAULTS):
                    time.sleep(schedule.uniform(0.2, 2.0))
                    cluster.kill(schedule.choice((*DAEMONS, *WORKERS, *DAEMONS, *WORKERS, "database")))
                for client in clients:
                    client.join()
                    self.assertEqual(client.failure, "")
                a, b = cluster.daemons()
                self.judge(a, b, told, lambda query: cluster.database.rows(cluster.folder, query))
            finally:
                cluster.end()


if __name__ == "__main__":
    unittest.main()
