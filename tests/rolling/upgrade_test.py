"""Two releases of the daemon on one database: daemons and workers are replaced one after the other while clients upload, queue and read.

`driftlabd_next` has the objects of this driftlab, another version and one more migration, beside which this one may work;
`driftlabd_apart` has a further one, beside which it may not (tests/rolling/next). Clients ask at one address as those of a Kubernetes
Service do (service.py), by the Python client with its own repetitions: none may fail. What they were told is judged at the end
(shared_store.py).
"""
from __future__ import annotations

import os
import random
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path
from typing import Any

import driftlab
import postgres
import samples
from daemon import PATIENCE_S, PROGRAM, Daemon
from service import Service, wait_until_ready
from shared_store import MODELS, Judge, Told

NEXT, APART = os.environ.get("DRIFTLABD_NEXT", ""), os.environ.get("DRIFTLABD_APART", "")
RELEASED = len(list((Path(__file__).resolve().parents[2] / "migrations/postgres").glob("*.sql")))
DAEMONS = ("a", "b")
WORKERS = ("worker 1", "worker 2")
CLIENTS = 3
SEED = 20261129

if postgres.programs() is None or not NEXT:
    print("ROLLING UPGRADES NOT TESTED: there is no PostgreSQL, or this build has no later release.")
    raise SystemExit(77)


class Lab:
    """Daemons and workers on one database, each of some release, with the directory and the port that it always has."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.database = postgres.cluster()
        self.store = self.database.store_of(folder)
        self.running: dict[str, Daemon] = {}
        self.ports: dict[str, int] = {}

    def together(self) -> tuple[str, ...]:
        return ("--store", self.store, "--blobs", "database", "--budget", "reserve_bytes=0", "--workers", "1")

    def start(self, name: str, program: str = PROGRAM) -> Daemon:
        listen = f"127.0.0.1:{self.ports.get(name, 0)}"
        arguments = (*(("worker",) if name in WORKERS else ()), *self.together())
        daemon = Daemon(self.folder / name, arguments=arguments, listen=listen, program=program)
        self.ports[name] = daemon.port
        wait_until_ready(daemon)
        self.running[name] = daemon
        return daemon

    def replace(self, name: str, program: str) -> int:
        """SIGTERM, and the other release in its place; the exit code."""
        code = self.running[name].terminate()
        del self.running[name]
        self.start(name, program)
        return code

    def daemons(self) -> list[Daemon]:
        running = dict(self.running)
        return [running[name] for name in DAEMONS if name in running]

    def refused(self, name: str, program: str) -> str:
        """The sentence with which it does not start."""
        ran = subprocess.run([program, "--data", self.folder / name, "--listen", "127.0.0.1:0", *self.together()], capture_output=True,
                             text=True, check=False, timeout=PATIENCE_S, env={"PATH": os.environ["PATH"]})
        assert ran.returncode == 1, (ran.returncode, ran.stderr)
        return ran.stderr

    def rows(self, query: str) -> list[list[Any]]:
        return self.database.rows(self.folder, query)

    def end(self) -> None:
        for daemon in self.running.values():
            daemon.kill()


class Asking(threading.Thread):
    """Uploads, queues, waits and reads until it is told to stop; the first request that fails ends it."""

    def __init__(self, address: str, told: Told, seed: int, over: threading.Event) -> None:
        super().__init__()
        self.client = driftlab.Client(address)
        self.told, self.random, self.over = told, random.Random(seed), over
        self.failure = ""

    def run(self) -> None:
        try:
            while not self.over.is_set():
                self.round()
        except (driftlab.Problem, TimeoutError) as failed:
            self.failure = f"{type(failed).__name__}: {failed}"

    def round(self) -> None:
        content = samples.gyro_csv(2048, seed=self.random.randrange(1 << 30))
        device = f"phone-0{self.random.randrange(4)}"
        recording = self.client.upload(content, device=device, rate_hz=100, columns=samples.GYRO_Z)["id"]
        with self.told.lock:
            self.told.recordings[recording] = content
        asked: Any = {"kind": "characterise", "inputs": {"recordings": [recording]}, "parameters": {"models": MODELS}}
        job = self.client.create_job(asked)["id"]
        with self.told.lock:
            self.told.jobs[job] = recording
        self.client.wait(job, timeout_s=PATIENCE_S)
        result: Any = self.client.job_result(job)
        assert result["recordings"]
        assert sum(1 for _ in self.client.recordings(device=device))


class Reader:
    """A context manager: a transaction of somebody else that has read something and does not end."""

    def __init__(self, database: postgres.Cluster, query: str) -> None:
        self.process = subprocess.Popen(
            [database.programs / "psql", f"--host={database.folder}", f"--port={database.port}", "--username=driftlab", "--dbname=postgres",
             "--no-psqlrc"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(f"BEGIN; {query};\n")
        self.process.stdin.flush()
        self.process.stdout.readline()

    def __enter__(self) -> Reader:
        return self

    def __exit__(self, *unused: object) -> None:
        self.end()

    def end(self) -> None:
        if self.process.poll() is None:
            self.process.communicate("ROLLBACK;\n\\q\n", timeout=PATIENCE_S)


class Rolling(Judge):
    def setUp(self) -> None:
        self.lab = Lab(Path(self.enterContext(tempfile.TemporaryDirectory())))
        self.addCleanup(self.lab.end)

    def version(self, daemon: Daemon) -> str:
        return str(daemon.get("/healthz").json["version"])

    def newer_schema(self, daemon: Daemon) -> str:
        return str(daemon.get("/readyz").json.get("newer_schema", ""))

    def test_nothing_is_lost_while_one_release_takes_the_place_of_another_and_back(self) -> None:
        lab, told, over = self.lab, Told(), threading.Event()
        for name in (*DAEMONS, *WORKERS):
            lab.start(name)
        with Service(lab.daemons) as service:
            clients = [Asking(service.address, told, SEED + number, over) for number in range(CLIENTS)]
            for client in clients:
                client.start()
            try:
                for name in (*DAEMONS, *WORKERS):
                    self.work_on(told)
                    self.assertEqual(lab.replace(name, NEXT), 0)
                    if name == "a":
                        self.is_told_of_the_newer_schema()
                self.assertEqual(self.schema(), RELEASED + 1)
                for daemon in lab.daemons():
                    self.assertEqual((self.version(daemon), self.newer_schema(daemon)), ("0.1.0-next", ""))
                for name in (*WORKERS, *DAEMONS):
                    self.work_on(told)
                    self.assertEqual(lab.replace(name, PROGRAM), 0)
                self.work_on(told)
            finally:
                over.set()
                for client in clients:
                    client.join()
        self.assertEqual([client.failure for client in clients], [""] * CLIENTS, "no request fails for good")
        self.assertEqual(self.schema(), RELEASED + 1, "what was added stays")
        a, b = lab.daemons()
        self.judge(a, b, told, lab.rows)
        self.assertEqual(lab.rows("SELECT id FROM jobs WHERE state IN ('failed', 'dead')"), [])
        self.assertEqual(lab.rows("SELECT job_id FROM job_attempts"), [], "no attempt failed")
        self.assertIn("newer_schema", a.get("/readyz").json)

    def is_told_of_the_newer_schema(self) -> None:
        """b is of the release before, and works on."""
        b = self.lab.running["b"]
        said = f"The database has schema {RELEASED + 1} of a newer driftlab; this one works beside it with schema {RELEASED}."
        self.assertEqual(b.logged(event="newer schema")["detail"], said)
        self.assertEqual(self.newer_schema(b), said)
        self.assertEqual(self.version(b), "0.1.0")

    def schema(self) -> int:
        return int(self.lab.rows("SELECT max(number) FROM schema_migrations")[0][0])

    def work_on(self, told: Told) -> None:
        """Until two more jobs are queued."""
        enough, until = len(told.jobs) + 2, time.monotonic() + PATIENCE_S
        while len(told.jobs) < enough:
            self.assertLess(time.monotonic(), until, "clients are served")
            time.sleep(0.02)

    def test_a_release_that_bears_no_other_waits_until_it_is_alone(self) -> None:
        lab = self.lab
        a, b = (lab.start(name) for name in DAEMONS)
        said = lab.refused("c", APART)
        self.assertIn(f"The database has schema {RELEASED}, and the daemons and workers that are there could not work with it after "
                      f"migration {RELEASED + 2} (apart); stop all of them before this driftlab starts.", said)
        self.assertEqual(self.schema(), RELEASED, "neither of its migrations was applied")
        for daemon in (a, b):
            self.assertEqual(daemon.get("/readyz").status, 200)
            self.assertEqual(daemon.terminate(), 0)
        lab.running.clear()
        c = lab.start("c", APART)
        self.assertEqual((self.schema(), self.version(c)), (RELEASED + 2, "0.1.0-apart"))
        newer = f"The database has schema {RELEASED + 2}, but this driftlab knows only"
        self.assertIn(f"{newer} {RELEASED}; use the newer driftlab that wrote it.", lab.refused("a", PROGRAM))
        self.assertIn(f"{newer} {RELEASED + 1}; use the newer driftlab that wrote it.", lab.refused("a", NEXT))
        lab.start("b", APART)

    def test_who_was_cut_off_meanwhile_does_nothing_more(self) -> None:
        """The database becomes one with which the daemon may not work; it finds out, and works on once that is over."""
        lab = self.lab
        a = lab.start("a", NEXT)
        b = lab.start("b")
        lab.start("worker 1")
        a.kill()
        table = f"{lab.database.schema_of(lab.folder)}.schema_migrations"
        lab.database.sql(f"UPDATE {table} SET oldest = NULL WHERE number = {RELEASED + 1}")
        for name in ("b", "worker 1"):
            self.eventually(lab.running[name], 503)
        refused = b.get("/readyz")
        self.assertIn(f"The database has schema {RELEASED + 1} by now, and this driftlab works with {RELEASED}", refused.json["detail"])
        self.assertEqual(b.get("/v1/recordings").status, 503)
        lab.database.sql(f"UPDATE {table} SET oldest = {RELEASED} WHERE number = {RELEASED + 1}")
        for name in ("b", "worker 1"):
            self.eventually(lab.running[name], 200)
        recording = b.upload(samples.gyro_csv(2048), rate_hz=100, columns=samples.GYRO_Z).json["id"]
        self.assertEqual(b.finished(b.characterise(recording, models=MODELS).json["id"])["state"], "succeeded")

    def eventually(self, daemon: Daemon, status: int) -> None:
        until = time.monotonic() + PATIENCE_S
        while daemon.get("/readyz").status != status:
            self.assertLess(time.monotonic(), until, daemon.log[-3:])
            time.sleep(0.1)

    def test_a_migration_waits_shortly_for_who_reads_and_lets_others_pass(self) -> None:
        """Somebody reads a table for long, such as pg_dump: who works is not held up behind the migration that waits for that."""
        lab = self.lab
        b = lab.start("b")
        reader = self.enterContext(Reader(lab.database, f"SELECT count(*) FROM {lab.database.schema_of(lab.folder)}.jobs"))
        started: list[Daemon] = []
        starting = threading.Thread(target=lambda: started.append(lab.start("a", NEXT)))
        starting.start()
        longest = 0.0
        for _ in range(20):
            begun = time.monotonic()
            self.assertEqual(b.get("/v1/jobs?limit=1").status, 200)
            longest = max(longest, time.monotonic() - begun)
            time.sleep(0.1)
        self.assertEqual((started, self.schema()), ([], RELEASED), "it waits")
        self.assertLess(longest, 2.0)
        reader.end()
        starting.join(PATIENCE_S)
        self.assertEqual(self.schema(), RELEASED + 1)


class Alone(unittest.TestCase):
    def test_an_sqlite_store_goes_to_a_later_release_and_back(self) -> None:
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        recordings: list[str] = []
        for program in (PROGRAM, NEXT, PROGRAM, NEXT):
            with Daemon(folder / "data", program=program) as daemon:
                made = daemon.upload(samples.gyro_csv(2048, seed=len(recordings)), rate_hz=100, columns=samples.GYRO_Z)
                recordings.append(made.json["id"])
                self.assertEqual(daemon.finished(daemon.characterise(recordings[-1], models=MODELS).json["id"])["state"], "succeeded")
                self.assertEqual([each["id"] for each in daemon.items("/v1/recordings")], recordings)
                self.assertEqual("newer_schema" in daemon.get("/readyz").json, program == PROGRAM and len(recordings) > 1)
                self.assertEqual(daemon.terminate(), 0)
        with Daemon(folder / "data", program=APART) as daemon:
            daemon.kill()
        refused = subprocess.run([NEXT, "--data", folder / "data", "--listen", "127.0.0.1:0"], capture_output=True, text=True, check=False,
                                 timeout=PATIENCE_S)
        self.assertEqual(refused.returncode, 1)
        self.assertIn(f"The database has schema {RELEASED + 2}, but this driftlab knows only {RELEASED + 1}", refused.stderr)


if __name__ == "__main__":
    unittest.main()
