#!/usr/bin/env python3
"""A PostgreSQL database of many recordings and fits: how long it is asked, how large it is, how it is vacuumed and migrated.

usage: large_store.py [DEVICES [OLD_DAEMON]]     (default 1000; DRIFTLABD is the daemon)

One device with ten recordings of one axis, each characterised by the nine models of the default, and their pooling are made by a
daemon; its rows are then copied by SQL for DEVICES devices, with ids, times, hashes and seals of their own, in the order of
campaigns: all first recordings, all second ones, ... So 100,000 devices are 10^6 recordings and 9 * 10^6 fits. The audit log is not
copied, for each of its rows has the hash of the row before. Files are not there: what is measured are rows.

DRIFTLAB_BENCH_FIRST=1: what is measured has the processor before whatever else the machine does (SCHED_RR; needs root).
DRIFTLAB_BENCH_ALSO=DAEMON: another program is asked the same of other devices afterwards.
DRIFTLAB_BENCH_COLD=1: in the end it is asked once more where the database has 64 MB of shared buffers and the system no page of it.
With OLD_DAEMON, a driftlabd of an earlier schema, the rows are written for that; then DRIFTLABD migrates them while a reader asks.
"""
from __future__ import annotations

import http.client
import os
import random
import signal
import statistics
import sys
import tempfile
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import daemon as daemons  # noqa: E402 - beside the tests
import postgres  # noqa: E402
import samples  # noqa: E402
from copied_rows import copy_device  # noqa: E402
from daemon import Daemon  # noqa: E402

RECORDINGS = 10
REPEATS = 200
CLIENTS = 16
ASKING_S = 20.0


class Tuned(postgres.Cluster):
    """Loads quickly; a quarter of a small server's memory for its pages."""

    settings = ("shared_buffers=2GB", "max_wal_size=4GB", "wal_level=minimal", "max_wal_senders=0", "maintenance_work_mem=512MB",
                "checkpoint_timeout=30min")


def make_template(server: postgres.Cluster, folder: Path, program: str) -> None:
    with Daemon(folder / "d", program=program, arguments=("--store", server.store_of(folder), "--budget", "reserve_bytes=0")) as daemon:
        for i in range(RECORDINGS):
            condition = "static" if i % 2 == 0 else f"constant_rate:z:{10 * i}:deg/s"
            stored = daemon.upload(samples.csv(samples.noise(6000, 1, i), ["gz"]), device="unit-0000000", id=f"run {i:02d} 0000000", condition=condition,
                                   rate_hz=100, columns=samples.GYRO_Z)
            daemon.finished(daemon.characterise(stored.json["id"]).json["id"])
        while daemon.get("/v1/counts").json["jobs"]["queued"] + daemon.get("/v1/counts").json["jobs"]["running"] > 0:
            time.sleep(0.1)


class Asked:
    """Answers of one daemon, and how long they took [ms]."""

    times = 0

    def __init__(self, daemon: Daemon, server: postgres.Cluster, folder: Path, devices: int) -> None:
        self.daemon, self.devices = daemon, devices
        Asked.times += 1
        self.chance = random.Random(Asked.times)  # devices that were not asked for before: few of their pages are in memory
        ids = server.rows(folder, "SELECT (SELECT id FROM recordings ORDER BY id OFFSET (SELECT count(*) / 2 FROM recordings) LIMIT 1) AS recording, "
                                  "(SELECT id FROM jobs ORDER BY id OFFSET (SELECT count(*) / 2 FROM jobs) LIMIT 1) AS job, "
                                  "(SELECT id FROM fits WHERE id > 'fit_01M7' ORDER BY id OFFSET (SELECT count(*) / 2 FROM fits) LIMIT 1) AS fit")[0]
        self.middle = {"recordings": ids[0], "jobs": ids[1], "fits": ids[2]}

    def device(self) -> str:
        return f"unit-{self.chance.randrange(self.devices):07d}"

    def lists(self) -> dict[str, str]:
        """What is asked now, by its name in the table."""
        device = self.device()
        return {
            "table of an axis": f"/v1/parameter-tables?device={device}&sensor=gyroscope&axis=z",
            "tables of all axes": f"/v1/parameter-tables?device={device}&sensor=gyroscope&axis=all",
            "trend of an axis": f"/v1/trends?device={device}&sensor=gyroscope&axis=z",
            "a device": f"/v1/devices/{device}",
            "devices with summary": "/v1/devices?include=summary&sort=name",
            "devices, q of one": f"/v1/devices?q={device}",
            "recordings, newest": "/v1/recordings?sort=-created_at",
            "recordings, from the middle": f"/v1/recordings?sort=-created_at&cursor={self.middle['recordings']}",
            "recordings, by name": "/v1/recordings?sort=name",
            "recordings of a device": f"/v1/recordings?device={device}",
            "recordings, one condition": "/v1/recordings?condition=constant_rate:z:50:deg/s&sort=-created_at",
            "recordings with a result": "/v1/recordings?has_result=true&sort=-created_at",
            "recordings without a result": "/v1/recordings?has_result=false&sort=-created_at",
            "recordings of a label nobody has": "/v1/recordings?labels=firmware=9",
            "recordings of a device, q": f"/v1/recordings?device={device}&q=constant_rate",
            "recordings, q of one": f"/v1/recordings?q={device.removeprefix('unit-')}",
            "recordings, q of none": f"/v1/recordings?q=nowhere{device}",
            "jobs, newest": "/v1/jobs?sort=-created_at",
            "jobs, from the middle": f"/v1/jobs?sort=-created_at&cursor={self.middle['jobs']}",
            "jobs of a device": f"/v1/jobs?device={device}&sort=-created_at",
            "jobs that failed": "/v1/jobs?state=failed&sort=-created_at",
            "fits of a device": f"/v1/fits?device={device}",
            "best fits of a device": f"/v1/fits?device={device}&best=true",
            "fits, from the middle": f"/v1/fits?cursor={self.middle['fits']}",
            "fits of a model nobody has": "/v1/fits?model=WN%2BQN%2BDR",
            "attention": "/v1/attention",
            "counts": "/v1/counts",
            "search of a device": f"/v1/search?q={device}",
            "search of nothing": f"/v1/search?q=nowhere{device}",
        }

    def table(self) -> None:
        took: dict[str, list[float]] = {}
        rows: dict[str, int] = {}
        gone: set[str] = set()
        for _ in range(REPEATS):
            for name, target in self.lists().items():
                if name in gone:
                    continue
                start = time.perf_counter()
                answer = self.daemon.get(target)
                took.setdefault(name, []).append(1000.0 * (time.perf_counter() - start))
                if answer.status != 200:
                    print(f"{name}: {answer.describe()}", flush=True)
                    gone.add(name)
                    continue
                rows[name] = len(answer.json.get("items", []))
                if sum(took[name]) > 10_000.0:  # slow: fewer times
                    gone.add(name)
        print(f"\n| asked | times | median ms | p99 ms | rows |{'':1}\n|---|---|---|---|---|".replace("| \n", "|\n"))
        for name, times in took.items():
            p99 = sorted(times)[max(0, round(0.99 * len(times)) - 1)]
            print(f"| {name} | {len(times)} | {statistics.median(times):.1f} | {p99:.1f} | {rows.get(name, 0)} |", flush=True)


    def asked_at_once(self) -> None:
        """Clients that each keep a connection, and ask for tables and lists of any device."""
        took: dict[str, list[float]] = {}
        until = time.monotonic() + ASKING_S

        def ask() -> None:
            connection = http.client.HTTPConnection(self.daemon.host, self.daemon.port)
            while time.monotonic() < until:
                for name, target in self.lists().items():
                    if name not in ("table of an axis", "recordings of a device", "jobs, newest", "fits of a device"):
                        continue
                    start = time.perf_counter()
                    connection.request("GET", target)
                    answer = connection.getresponse()
                    answer.read()
                    assert answer.status == 200, target
                    took.setdefault(name, []).append(1000.0 * (time.perf_counter() - start))

        clients = [threading.Thread(target=ask) for _ in range(CLIENTS)]
        for client in clients:
            client.start()
        for client in clients:
            client.join()
        print(f"\n{CLIENTS} clients at once: {sum(map(len, took.values())) / ASKING_S:.0f} answers a second")
        for name, times in took.items():
            print(f"| {name} | {len(times)} | {statistics.median(times):.1f} | {sorted(times)[round(0.99 * len(times)) - 1]:.1f} |", flush=True)


def settle(server: postgres.Cluster, folder: Path) -> None:
    """What filling leaves behind is done: its rows are known as visible, its pages are on the disk."""
    schema = server.schema_of(folder)
    begun = time.monotonic()
    for table, in server.rows(folder, f"SELECT relname FROM pg_class WHERE relkind = 'r' AND relnamespace = '{schema}'::REGNAMESPACE"):
        server.sql(f"VACUUM ANALYZE {schema}.{table}")
    server.sql("CHECKPOINT")
    print(f"vacuum and a checkpoint of what was filled: {time.monotonic() - begun:.1f} s", flush=True)


def index_again(server: postgres.Cluster, folder: Path) -> None:
    """How long a migration that adds an index to the fits would hold up who writes them."""
    schema = server.schema_of(folder)
    begun = time.monotonic()
    server.sql(f"SET search_path = {schema}; CREATE INDEX fits_again ON fits (model, id)")
    print(f"\nan index of fits by model was built in {time.monotonic() - begun:.1f} s", flush=True)
    server.sql(f"SET search_path = {schema}; DROP INDEX fits_again")


def sizes(server: postgres.Cluster, folder: Path) -> None:
    schema = server.schema_of(folder)
    print("\n| table | rows | table MB | long texts MB | indexes MB |\n|---|---|---|---|---|")
    for name, rows, heap, toast, indexes in server.rows(
            folder, "SELECT relname, reltuples::BIGINT, pg_relation_size(oid), coalesce(pg_total_relation_size(nullif(reltoastrelid, 0)), 0), pg_indexes_size(oid) "
                    f"FROM pg_class WHERE relkind = 'r' AND relnamespace = '{schema}'::REGNAMESPACE AND reltuples > 1000 ORDER BY pg_total_relation_size(oid) DESC"):
        print(f"| {name} | {rows:,} | {heap / 1e6:,.0f} | {toast / 1e6:,.0f} | {indexes / 1e6:,.0f} |")
    print("\n| index | MB |\n|---|---|")
    for name, size in server.rows(folder, "SELECT relname, pg_relation_size(oid) FROM pg_class WHERE relkind = 'i' AND "
                                          f"relnamespace = '{schema}'::REGNAMESPACE ORDER BY pg_relation_size(oid) DESC LIMIT 16"):
        print(f"| {name} | {size / 1e6:,.0f} |")


def vacuum(server: postgres.Cluster, folder: Path) -> None:
    """The queue's table after a hundred thousand of its jobs have run once more, and what the others take."""
    schema = server.schema_of(folder)
    for change in ("state = 'running', lease_expires_at = 1, finished_at = NULL", "stage = 'fit', progress = 0.5", "lease_expires_at = 2",
                   "state = 'succeeded', finished_at = 1, lease_expires_at = NULL, stage = '', progress = 1"):
        server.sql(f"SET search_path = {schema}; UPDATE jobs SET {change} WHERE id IN (SELECT id FROM jobs ORDER BY id LIMIT 100000)")
    time.sleep(1)
    live, dead, hot = server.rows(folder, f"SELECT n_live_tup, n_dead_tup, n_tup_hot_upd FROM pg_stat_all_tables WHERE relname = 'jobs' AND schemaname = '{schema}'")[0]
    print(f"\nqueue: {live:,} rows, {dead:,} of them dead after four updates of 100,000 ({hot:,} of these touched no index)")
    for table in ("jobs", "recordings", "fits", "job_events", "channel_results"):
        begun = time.monotonic()
        server.sql(f"VACUUM ANALYZE {schema}.{table}")
        print(f"VACUUM ANALYZE {table}: {time.monotonic() - begun:.1f} s", flush=True)


class Reader(threading.Thread):
    """Reads a recording again and again while something else goes on; the longest that it had to wait [s]."""

    def __init__(self, server: postgres.Cluster, folder: Path) -> None:
        super().__init__(daemon=True)
        self.server, self.schema = server, server.schema_of(folder)
        self.ended, self.longest, self.reads = False, 0.0, 0

    def run(self) -> None:
        while not self.ended:
            begun = time.monotonic()
            for table in ("recordings", "jobs", "fits"):
                self.server.sql(f"SELECT id FROM {self.schema}.{table} LIMIT 1")
            self.longest = max(self.longest, time.monotonic() - begun)
            self.reads += 1


def come_first(server: postgres.Cluster) -> None:
    """From here on: this process, the programs that it starts and the connections that the database takes."""
    for process in (os.getpid(), server.server.pid):
        os.sched_setscheduler(process, os.SCHED_RR, os.sched_param(1))


def forget_pages(server: postgres.Cluster) -> None:
    """What is read then comes from the disk."""
    server.server.send_signal(signal.SIGINT)
    server.server.wait()
    for path in (server.folder / "data/base").rglob("*"):
        if path.is_file():
            pages = os.open(path, os.O_RDONLY)
            os.fsync(pages)
            os.posix_fadvise(pages, 0, 0, os.POSIX_FADV_DONTNEED)
            os.close(pages)
    server.settings = (*server.settings, "shared_buffers=64MB")
    server.start()


def ask(server: postgres.Cluster, folder: Path, devices: int, program: str, before: str) -> None:
    """Everything that is asked through HTTP, of a program that follows another on the database."""
    reader = Reader(server, folder)
    reader.start()
    begun = time.monotonic()
    with Daemon(folder / "d", program=program, arguments=("--store", server.store_of(folder), "--budget", "reserve_bytes=0")) as daemon:
        print(f"started after {time.monotonic() - begun:.1f} s, with the migrations of {before if before != program else 'none'}", flush=True)
        reader.ended = True
        reader.join()
        print(f"a reader of three tables read {reader.reads} times meanwhile and waited {reader.longest:.2f} s at most", flush=True)
        for entry in daemon.log:
            print({key: value for key, value in entry.items() if key not in ("ts", "level")})
        asked = Asked(daemon, server, folder, devices)
        asked.table()
        asked.asked_at_once()


def main() -> None:
    postgres.PATIENCE_S = 3600.0
    devices = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    new, old = daemons.PROGRAM, sys.argv[2] if len(sys.argv) > 2 else daemons.PROGRAM
    server = Tuned()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make_template(server, folder, old)
        begun = time.monotonic()
        copy_device(server, server.schema_of(folder), devices)
        print(f"{devices:,} devices copied in {time.monotonic() - begun:.0f} s", flush=True)
        settle(server, folder)
        if os.environ.get("DRIFTLAB_BENCH_FIRST"):
            come_first(server)
        daemons.PATIENCE_S = 3600.0
        ask(server, folder, devices, new, old)
        if also := os.environ.get("DRIFTLAB_BENCH_ALSO"):
            print(f"\n{also}:")
            ask(server, folder, devices, also, new)
        if os.environ.get("DRIFTLAB_BENCH_COLD"):
            print("\nfrom the disk:")
            forget_pages(server)
            ask(server, folder, devices, also or new, new)
        sizes(server, folder)
        index_again(server, folder)
        vacuum(server, folder)
    server.remove()


if __name__ == "__main__":
    main()
