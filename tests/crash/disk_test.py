"""A disk that fails, and power that goes: seeded rounds over the calls that durability rests on, SQLite's among them.

    DRIFTLAB_POWER_LIVES=1000 DRIFTLAB_FAULT_CASES=400 DRIFTLAB_CRASH_SEED=7 ctest --test-dir build/release -R crash.disk

The first of the power cuts and of the failing calls are those of `.ci/run`.
"""
from __future__ import annotations

import os
import random
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from typing import Any

from daemon import PATIENCE_S, Answer, Daemon, events
from disk import FOR_EVER, KINDS, SHIM, Disk
from history import Client, History, Judge, Unknown, at_work

SEED = int(os.environ.get("DRIFTLAB_CRASH_SEED", "20261124"))
POWER_LIVES = int(os.environ.get("DRIFTLAB_POWER_LIVES", "5"))
FAULT_CASES = int(os.environ.get("DRIFTLAB_FAULT_CASES", "40"))  # 39 were tried by hand when issue 17 was written
LIVES_OF_A_DIRECTORY = 30
ARGUMENTS = ("--budget", "reserve_bytes=0")

if not SHIM or os.environ.get("DRIFTLAB_SANITIZE"):
    print("A FAILING DISK IS NOT TESTED: sanitizers put their own calls before those of the shim.")
    raise SystemExit(77)


def integrity(data: Path) -> list[Any]:
    database = sqlite3.connect(data / "driftlab.db")
    try:
        return [*database.execute("PRAGMA integrity_check").fetchall(), *database.execute("PRAGMA foreign_key_check").fetchall()]
    finally:
        database.close()


class Round(Judge):
    def setUp(self) -> None:
        folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="driftlab-disk-")))
        self.data = folder / "data"
        self.data.mkdir()
        self.answers: list[Answer] = []

    def daemon(self, disk: Disk | None = None) -> Daemon:
        daemon = Daemon(self.data, arguments=ARGUMENTS, environment=disk.environment if disk else None)
        daemon.checks.append(self.tells_no_path)
        return daemon

    def tells_no_path(self, answer: Answer) -> None:
        said = answer.body + repr(answer.headers).encode()
        self.assertNotIn(str(self.data.parent).encode(), said, f"where the daemon keeps its files: {answer.describe()}")


class TheShim(Round):
    """What the rounds rest on: a disk that would lose nothing would prove nothing."""

    WRITER = ("import os,sys\n"
              "def put(name, sync):\n"
              "    file = os.open(name, os.O_WRONLY | os.O_CREAT, 0o600)\n"
              "    os.write(file, b'first'); os.fsync(file) if sync else None\n"
              "    os.write(file, b'second'); os.close(file)\n"
              "def names(): folder = os.open('.', os.O_RDONLY); os.fsync(folder); os.close(folder)\n"
              "put('kept', True); os.mkdir('folder'); names(); put('nameless', True); put('folder/lost', True)\n"
              "put('before', False); names(); os.rename('kept', 'renamed')\n")

    def test_power_takes_what_was_not_synced(self) -> None:
        disk = Disk(self.data, powered=True)
        subprocess.run([sys.executable, "-c", self.WRITER], cwd=self.data, env=disk.environment, check=True)
        self.assertEqual((self.data / "renamed").read_bytes(), b"firstsecond")
        disk.cut_power()
        left = {path.relative_to(self.data).as_posix(): path.read_bytes() for path in self.data.rglob("*") if path.is_file()}
        self.assertEqual(left, {"kept": b"first", "nameless": b"first", "before": b""})
        disk.cut_power()
        self.assertEqual((self.data / "kept").read_bytes(), b"first", "what came back is on disk")

    def test_calls_fail_when_they_are_told_to(self) -> None:
        disk = Disk(self.data)
        for kind, call in {"write": "os.write(f, b'x')", "fsync": "os.fsync(f)", "read": "os.pread(f, 1, 0)", "rename": "os.rename(h + '/x', h + '/y')"}.items():
            disk.arm(kind, passes=1, error="ENOSPC", fails=1)
            text = f"import os\nh = os.getcwd()\nf = os.open('x', os.O_RDWR | os.O_CREAT)\n{call}\nopen('x', 'a')\ntry:\n    {call}\nexcept OSError as e:\n    print(e.errno)\n"
            said = subprocess.run([sys.executable, "-c", text], cwd=self.data, env=disk.environment, check=True, capture_output=True, text=True)
            self.assertEqual((said.stdout, disk.disarm()), ("28\n", 1), kind)


class FailingCalls(Round):
    """One call of a kind fails, at a place drawn by the seed, while a client works; then power goes, or the process dies."""

    def test_a_call_that_fails_loses_nothing(self) -> None:
        generator = random.Random(SEED)
        cases = [(kind, error) for kind in KINDS for error in ("EIO", "ENOSPC") if (kind, error) != ("read", "ENOSPC")]
        hit = {case: 0 for case in cases}
        history, disk = History(), Disk(self.data, powered=True)
        client = Client(history, generator.randrange(1 << 30))
        for first in range(0, FAULT_CASES, 10):
            with self.daemon(disk) as daemon:
                self.judge(daemon, history)
                for number in range(first, min(first + 10, FAULT_CASES)):
                    kind, error = cases[number % len(cases)]
                    with self.subTest(case=number, kind=kind, error=error):
                        disk.arm(kind, passes=generator.randrange(12), error=error, fails=generator.choice((1, 1, 2, 5)))
                        for _ in range(6):
                            self.try_one(client, daemon)
                        hit[kind, error] += disk.disarm() > 0
                        self.judge(daemon, history)
                daemon.kill()
            disk.cut_power()
        with self.daemon() as daemon:
            self.judge(daemon, history, whole=True)
            self.assertEqual(daemon.terminate(), 0)
        self.assertEqual(integrity(self.data), [("ok",)])
        self.assertGreaterEqual(sum(hit.values()), FAULT_CASES * 3 // 5, hit)
        self.assertTrue(FAULT_CASES < len(cases) or all(hit.values()), hit)
        self.assertGreater(len(history.recordings), FAULT_CASES // 4, "the client did too little")

    def try_one(self, client: Client, daemon: Daemon) -> None:
        try:
            client.step(daemon)
        except Unknown:
            pass
        self.assertIsNone(daemon.process.poll(), "the daemon goes on")


class PowerCuts(Round):
    def test_what_was_acknowledged_was_on_disk(self) -> None:
        generator = random.Random(SEED + 1)
        for first in range(0, POWER_LIVES, LIVES_OF_A_DIRECTORY):
            self.setUp()
            with self.subTest(first=first):
                self.live(min(LIVES_OF_A_DIRECTORY, POWER_LIVES - first), generator)

    def live(self, lives: int, generator: random.Random) -> None:
        history, disk = History(), Disk(self.data, powered=True)
        clients = [Client(history, generator.randrange(1 << 30)) for _ in range(2)]
        failures: list[str] = []
        for _ in range(lives):
            with self.daemon(disk) as daemon:
                self.judge(daemon, history)
                threads = at_work(clients, daemon, failures)
                time.sleep(generator.uniform(0.05, 0.6))
                if generator.random() < 0.25:  # power often goes with a disk that fails before
                    disk.arm("fsync", fails=FOR_EVER)
                    time.sleep(0.05)
                daemon.kill()
                for thread in threads:
                    thread.join()
                disk.disarm()
            disk.cut_power()
        self.assertEqual([failure for failure in failures if not failure.startswith("Unknown")], [])
        with self.daemon() as daemon:
            self.judge(daemon, history, whole=True)
            self.assertEqual(daemon.terminate(), 0)
        self.assertEqual(integrity(self.data), [("ok",)])
        self.assertGreater(len(history.recordings), lives // 2, "the clients did too little")


class BadStates(Round):
    """A bad state is said once with its cause, shown while it lasts, and no answer tells where files lie."""

    def wait_until(self, daemon: Daemon, what: str, holds: Any) -> None:
        until = time.monotonic() + PATIENCE_S
        while not holds():
            self.assertLess(time.monotonic(), until, f"{what}: {daemon.log[-5:]}")
            time.sleep(0.1)

    def states(self, daemon: Daemon, action: str) -> list[dict[str, Any]]:
        return [row for row in daemon.items("/v1/audit?limit=500") if row["action"] == action]

    def test_a_store_that_cannot_be_written(self) -> None:
        for error, cause in (("EIO", "io"), ("ENOSPC", "disk_full")):
            with self.subTest(error=error):
                self.setUp()
                disk = Disk(self.data)
                with self.daemon(disk) as daemon:
                    self.assertEqual(daemon.get("/readyz").json, {"status": "ready"})
                    disk.arm("write", error=error, fails=FOR_EVER)
                    self.wait_until(daemon, "not ready", lambda: daemon.get("/readyz").status == 503)
                    detail = daemon.get("/readyz").json["detail"]
                    self.assertIn(f"(state store_unwritable, cause {cause})", detail)
                    self.assertIn(f'driftlab_bad_states{{state="store_unwritable",cause="{cause}"}} 1\n', daemon.get("/metrics").text)
                    refused = daemon.upload(b"gz\n1\n2\n", rate_hz=100, columns="gz=angular_rate:z:deg/s")
                    self.assertIn(refused.status, (500, 507), refused.describe())
                    failed = daemon.logged(event="failed", route="/v1/recordings")
                    self.assertIn(str(self.data), failed["detail"], "the log says which file it was")
                    self.assertEqual(failed["request_id"], refused.json["request_id"])
                    disk.disarm()
                    self.wait_until(daemon, "ready", lambda: daemon.get("/readyz").status == 200)
                    self.wait_until(daemon, "in the audit log", lambda: self.states(daemon, "state.end"))
                    begun = [row for row in self.states(daemon, "state.begin") if row["object"] == "store_unwritable"]
                    self.assertEqual(len(begun), 1, "once")
                    self.assertEqual(begun[0]["actor"], "daemon")
                    self.assertTrue(begun[0]["detail"].startswith(f"store_unwritable, {cause}, since "), begun)
                    logged = [line for line in daemon.log if line.get("event") == "bad state" and line["state"] == "store_unwritable"]
                    self.assertEqual([line["cause"] for line in logged], [cause])
                    self.assertIn(f'driftlab_bad_states{{state="store_unwritable",cause="{cause}"}} 0\n', daemon.get("/metrics").text)
                    after = daemon.get("/readyz").json
                    self.assertEqual([(s["state"], s["cause"]) for s in after["states"]], [("files_fail", cause)], "in the last five minutes")

    def test_files_that_cannot_be_read(self) -> None:
        """A directory stands where a recording's bytes were: every way to them fails, and none says where that is."""
        client = Client(History(), SEED)
        with self.daemon() as daemon:
            client.upload(daemon)
            [recording] = daemon.items("/v1/recordings")
            sha256 = recording["file"]["sha256"]
            for path in (self.data / "blobs" / sha256[:2] / sha256, self.data / "columns" / sha256[:2] / f"{sha256}.columns"):
                path.unlink()
                path.mkdir()
            here = f"/v1/recordings/{recording['id']}"
            asked = [daemon.get(here + way) for way in ("/content", "/trace?channel=gz", "/spectrum?channel=gz", "/preview", "/samples?channel=gz")]
            self.assertTrue([answer for answer in asked if answer.status >= 500], [answer.describe() for answer in asked])
            job = daemon.characterise(recording["id"]).json["id"]
            self.wait_until(daemon, "an attempt fails", lambda: daemon.get(f"/v1/jobs/{job}").json["failed_attempts"])
            daemon.post(f"/v1/jobs/{job}/cancel")
            said = [event.data for event in events(daemon, job)]
            self.assertNotIn(str(self.data.parent), repr(said))
            for target in (f"/v1/jobs/{job}", "/v1/jobs", "/readyz", "/metrics", "/v1/audit"):
                daemon.get(target)

    def lives(self, count: int) -> History:
        """Recordings that were acknowledged before the daemon was killed: they are in the write-ahead log alone."""
        history = History()
        client = Client(history, SEED)
        with self.daemon() as daemon:
            for _ in range(count):
                client.upload(daemon)
            daemon.kill()
        self.assertGreater((self.data / "driftlab.db-wal").stat().st_size, 0)
        return history

    def audited_as_lost(self, daemon: Daemon) -> list[dict[str, Any]]:
        return [row for row in self.states(daemon, "state.begin") if row["object"] == "writes_lost"]

    def said_to_be_lost(self, daemon: Daemon) -> int:
        """Says it everywhere, once; how many transactions it says."""
        [state] = daemon.get("/readyz").json["states"]
        self.assertEqual((state["state"], state["cause"]), ("writes_lost", "damage"))
        self.assertIn('driftlab_bad_states{state="writes_lost",cause="damage"} 1\n', daemon.get("/metrics").text)
        logged = [line for line in daemon.log if line.get("event") == "bad state" and line["state"] == "writes_lost"]
        self.assertEqual(len(logged), 1)
        self.wait_until(daemon, "in the audit log", lambda: self.audited_as_lost(daemon))
        return int(state["detail"].split("lacks ")[1].split()[0])

    def test_a_log_that_was_cut_while_the_daemon_was_down(self) -> None:
        """SQLite takes what is left of its log for all that there was: nobody would be told."""
        for name, left in (("half of it", 0.5), ("a page of it", None), ("nothing of it", 0.0), ("it is gone", -1.0)):
            with self.subTest(name):
                self.setUp()
                history = self.lives(12)
                log = self.data / "driftlab.db-wal"
                size = log.stat().st_size
                if left == -1.0:
                    log.unlink()
                else:
                    os.truncate(log, size - 4096 if left is None else int(size * left))
                with self.daemon() as daemon:
                    there = {recording["id"] for recording in daemon.items("/v1/recordings?limit=500")}
                    gone = set(history.recordings) - there
                    self.assertTrue(gone or left is None)
                    self.assertGreaterEqual(self.said_to_be_lost(daemon), len(gone))
                    Client(History(), SEED + 1).upload(daemon)
                    self.assertEqual(daemon.terminate(), 0)
                self.assertEqual(integrity(self.data), [("ok",)])
                with self.daemon() as daemon:
                    self.assertEqual(daemon.get("/readyz").json, {"status": "ready"}, "it was said; a second loss would be another one")
                    self.assertTrue(self.audited_as_lost(daemon), "for ever")

    def test_a_log_that_is_whole_is_not_said_to_be_cut(self) -> None:
        history = self.lives(3)
        for _ in range(2):
            with self.daemon() as daemon:
                self.judge(daemon, history)
                self.assertEqual(daemon.get("/readyz").json, {"status": "ready"})
                daemon.kill()

    def test_a_log_that_is_cut_under_the_daemon(self) -> None:
        """What is written behind a cut would leave a hole of zeros, which a checkpoint copies over good pages."""
        history = History()
        client = Client(history, SEED)
        with self.daemon() as daemon:
            for _ in range(8):
                client.upload(daemon)
            log = self.data / "driftlab.db-wal"
            os.truncate(log, log.stat().st_size // 2)
            refused = daemon.upload(b"gz\n1\n2\n", rate_hz=100, columns="gz=angular_rate:z:deg/s")
            self.assertEqual(refused.status, 500, refused.describe())
            self.wait_until(daemon, "not ready", lambda: daemon.get("/readyz").status == 503)
            self.assertIn("write-ahead log", daemon.logged(event="bad state", state="store_unwritable")["detail"])
            daemon.terminate()
        self.assertEqual(integrity(self.data), [("ok",)], "nothing was copied from a log with a hole")
        with self.daemon() as daemon:
            gone = set(history.recordings) - {recording["id"] for recording in daemon.items("/v1/recordings?limit=500")}
            self.assertTrue(gone)
            self.assertGreaterEqual(self.said_to_be_lost(daemon), len(gone))

    def test_a_log_that_is_taken_away_under_the_daemon(self) -> None:
        history = History()
        client = Client(history, SEED)
        with self.daemon() as daemon:
            for _ in range(8):
                client.upload(daemon)
            (self.data / "driftlab.db-wal").unlink()
            refused = daemon.upload(b"gz\n1\n2\n", rate_hz=100, columns="gz=angular_rate:z:deg/s")
            self.assertEqual(refused.status, 500, refused.describe())
            self.assertEqual(daemon.get("/readyz").status, 503)
            daemon.kill()
        with self.daemon() as daemon:
            self.judge(daemon, history, whole=True)
            self.assertEqual(daemon.get("/readyz").json, {"status": "ready"}, "it was still open, and is in the database")
        self.assertEqual(integrity(self.data), [("ok",)])


if __name__ == "__main__":
    unittest.main()
