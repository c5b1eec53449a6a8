"""Two daemons and eight workers on hosts of their own, PostgreSQL with a synchronous standby on others; faults by a seeded schedule.

Hosts are network namespaces (network.py), the database is that of replicated.py. A round is two events after a while of undisturbed work, each
one fault or two at once: kill -9 of anything, a host that is cut off from the databases and comes back, a slow network, a failover, a clock
that is three hours off. Clients upload, ask and read all the time. After each event results must be read at half the rate of before within
30 s; after five rounds what clients were told is a history that is judged (shared_store.py): nothing acknowledged is lost, no result is there
twice. DRIFTLAB_HOSTS_ROUNDS and DRIFTLAB_HOSTS_SEED ask for more and for others; figures are in tests/SCALE.md.
"""
from __future__ import annotations

import json
import os
import random
import sys
import tempfile
import time
import unittest
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import network
import postgres
from daemon import PATIENCE_S, Daemon
from network import Host
from replicated import Replicated
from shared_store import Client, Judge, Told

ROUNDS = int(os.environ.get("DRIFTLAB_HOSTS_ROUNDS", "5"))
SEED = int(os.environ.get("DRIFTLAB_HOSTS_SEED", "20261128"))
ONLY = os.environ.get("DRIFTLAB_HOSTS_FAULT", "")  # of the names in `Lab.kinds`
LOG = os.environ.get("DRIFTLAB_HOSTS_LOG", "")  # file to which a line of JSON goes for each event and each history that was judged
CLOCK_SHIM = os.environ.get("DRIFTLAB_CLOCK_SHIM", "")
ROUNDS_OF_A_LAB = 5
EVENTS = 2  # in a round
DAEMONS = ("a", "b")
WORKERS = tuple(f"worker {i}" for i in range(1, 9))
RECOVERY_S = 30.0
WINDOW_S = 2.0
WRONG_S = 3 * 3600


def skip(why: str) -> None:
    print(f"SEVERAL HOSTS NOT TESTED: {why}.", flush=True)
    raise SystemExit(77)


if postgres.programs() is None:
    skip("there is no PostgreSQL")
if os.environ.get("DRIFTLAB_SANITIZE", ""):
    skip("eleven sanitized processes are too slow for 30 s to mean anything")
if refused := network.move_into_a_network():
    skip(refused)
SLOW = network.ways_to_be_slow(lambda words: print(words, flush=True))
if not CLOCK_SHIM:
    print("CLOCKS NOT TESTED: DRIFTLAB_CLOCK_SHIM names no library.", flush=True)


class Busy(Client):
    """Has up to six jobs under way, until it is told to stop."""

    def __init__(self, lab: Lab, told: Told, seed: int) -> None:
        super().__init__(lab.daemons, told, seed)

    def run(self) -> None:
        pending: list[str] = []
        content: bytes | None = None
        asked = 0
        while not self.stop.is_set():
            while len(pending) < 6 and not self.stop.is_set():
                content = content or self.content()
                # Results of one device are pooled by a further job: a new one now and then keeps that as small as it was.
                job = self.ask(content, device=f"phone {self.name} {asked // 4}")
                if job is None:
                    break
                pending, content, asked = [*pending, job], None, asked + 1
            pending = [job for job in pending if not self.read(job)]
            self.stop.wait(0.15)


@dataclass
class Fault:
    kind: str
    begin: Callable[[], None]
    end: Callable[[], None]
    repair: Callable[[], None] = lambda: None  # when work goes on again


class Lab:
    """The hosts, what runs on them, and what can happen to them."""

    def __init__(self, folder: Path, schedule: random.Random) -> None:
        self.folder, self.random = folder, schedule
        self.hosts = {name: Host(name, number) for number, name in enumerate((*DAEMONS, *WORKERS), start=1)}
        self.database_hosts = [Host(f"database {i}", 100 + i) for i in range(3)]
        self.database = Replicated(self.database_hosts)
        self.running: dict[str, Daemon] = {}
        for name in self.hosts:
            self.start(name)

    def start(self, name: str, ahead_s: int = 0) -> None:
        """As a service manager does: again and again, until it is there."""
        until = time.monotonic() + PATIENCE_S
        host = self.hosts[name]
        arguments = ("--store", self.database.store, "--blobs", "database", "--budget", "reserve_bytes=0", "--workers", "1", "--threads", "1")
        role = ("--insecure", "--allow-host", host.front) if name in DAEMONS else ("worker",)
        listen = f"{host.front}:0" if name in DAEMONS else "127.0.0.1:0"
        environment = {"LD_PRELOAD": CLOCK_SHIM, "DRIFTLAB_CLOCK_AHEAD": str(ahead_s)} if ahead_s != 0 else {}
        while True:
            try:
                daemon = Daemon(self.folder / name, arguments=(*(role if role[0] == "worker" else ()), *arguments, *(role if role[0] != "worker" else ())),
                                listen=listen, before_exec=host.enter_and_end_with_parent, environment=environment)
                break
            except AssertionError as failed:
                if time.monotonic() > until:
                    raise
                print(f"  {name} begins again: {str(failed)[-300:]}", file=sys.stderr, flush=True)
                time.sleep(0.5)
        daemon.host, daemon.patience_s = (host.front if name in DAEMONS else "127.0.0.1"), 10.0
        self.running[name] = daemon

    def kill(self, *names: str) -> None:
        """Those of them that run: another fault may have been there before."""
        for name in names:
            if name in self.running:
                self.running.pop(name).kill()

    def daemons(self) -> list[Daemon]:
        running = dict(self.running)
        return [running[name] for name in DAEMONS if name in running]

    def end(self) -> None:
        for daemon in self.running.values():
            daemon.kill()
        self.database.remove()
        for host in (*self.hosts.values(), *self.database_hosts):
            host.end()

    # --- what can happen

    def kinds(self) -> dict[str, Callable[[], Fault]]:
        found = {
            "a daemon is killed": lambda: self.killed("a daemon is killed", [self.random.choice(DAEMONS)]),
            "workers are killed": lambda: self.killed("workers are killed", self.random.sample(WORKERS, self.random.randint(1, 4))),
            "all daemons and workers are killed": lambda: self.killed("all daemons and workers are killed", [*DAEMONS, *WORKERS]),
            "a worker is cut off": lambda: self.cut_off("a worker is cut off", self.random.choice(WORKERS)),
            "a daemon is cut off": lambda: self.cut_off("a daemon is cut off", self.random.choice(DAEMONS)),
            "the database crashes": self.crash,
            "the standby crashes": self.standby_crashes,
            "the standby is cut off": self.standby_cut_off,
            "failover, the primary was killed": self.failover_from_killed,
            "failover, the host of the primary was lost": self.failover_from_lost,
        }
        if SLOW:
            found["a slow network at the primary"] = self.slow_primary
        if CLOCK_SHIM:
            found["a clock is three hours off"] = self.wrong_clock
        return found

    DATABASE = ("the database crashes", "the standby crashes", "the standby is cut off", "failover, the primary was killed",
                "failover, the host of the primary was lost", "a slow network at the primary", "all daemons and workers are killed")

    def event(self) -> list[Fault]:
        kinds = self.kinds()
        if ONLY:
            return [kinds[ONLY]()]
        names = [self.random.choice(list(kinds))]
        if self.random.random() < 0.3:
            others = [kind for kind in ("a daemon is killed", "workers are killed", "a worker is cut off", *self.DATABASE)
                      if kind in kinds and kind not in names and not (names[0] in self.DATABASE and kind in self.DATABASE)]
            names.append(self.random.choice(others))
        # Whoever is killed is not cut off as well, for neither could end.
        if names[0] in ("a daemon is cut off", "a worker is cut off", "a clock is three hours off") and len(names) > 1 and names[1] not in self.DATABASE[:5]:
            names.pop()
        if len(names) > 1 and names[1] == "a worker is cut off" and "killed" in names[0]:
            names.pop()
        return [kinds[name]() for name in names]

    def killed(self, kind: str, names: list[str]) -> Fault:
        return Fault(kind, lambda: self.kill(*names), lambda: self.start_again(names))

    def start_again(self, names: Sequence[str]) -> None:
        for name in names:
            if name not in self.running:
                self.start(name)

    def cut_off(self, kind: str, name: str) -> Fault:
        return Fault(kind, self.hosts[name].cut_off, self.hosts[name].connect)

    def wrong_clock(self) -> Fault:
        name, ahead = self.random.choice((*DAEMONS, *WORKERS)), self.random.choice((-WRONG_S, WRONG_S))

        def begin() -> None:
            self.kill(name)
            self.start(name, ahead)
        return Fault("a clock is three hours off", begin, lambda: None)

    def crash(self) -> Fault:
        primary = self.database.primary
        return Fault("the database crashes", primary.kill, primary.start)

    def standby_crashes(self) -> Fault:
        standby = self.database.standby
        return Fault("the standby crashes", standby.kill, standby.start)

    def standby_cut_off(self) -> Fault:
        host = self.database.standby.host
        return Fault("the standby is cut off", host.cut_off, host.connect)

    def slow_primary(self) -> Fault:
        host, way = self.database.primary.host, self.random.choice(SLOW)
        return Fault("a slow network at the primary", lambda: host.slow(*way), host.hurry)

    def failover_from_killed(self) -> Fault:
        self.database.be_synchronous()
        return Fault("failover, the primary was killed", self.database.primary.kill, lambda: self.database.fail_over().remove())

    def failover_from_lost(self) -> Fault:
        """It stays lost until work goes on without it, and comes back without its server."""
        self.database.be_synchronous()
        primary = self.database.primary

        def repair() -> None:
            primary.kill()
            primary.host.connect()
            primary.remove()
        return Fault("failover, the host of the primary was lost", primary.host.cut_off, lambda: self.database.fail_over() and None, repair)


def note(**fields: object) -> None:
    print("  " + ", ".join(f"{name} {value}" for name, value in fields.items()), file=sys.stderr, flush=True)
    if LOG:
        with open(LOG, "a") as log:
            log.write(json.dumps(fields) + "\n")


def rate(told: Told, begin: float, end: float) -> float:
    with told.lock:
        return sum(begin <= moment < end for moment in told.read_at) / (end - begin)


class OnSeveralHosts(Judge):
    def test_nothing_is_lost_or_done_twice_and_work_goes_on_whatever_fails(self) -> None:
        for first in range(0, ROUNDS, ROUNDS_OF_A_LAB):
            with self.subTest(seed=SEED + first), tempfile.TemporaryDirectory() as folder:
                self.lab(Path(folder), SEED + first, min(ROUNDS_OF_A_LAB, ROUNDS - first))

    def lab(self, folder: Path, seed: int, rounds: int) -> None:
        schedule = random.Random(seed)
        lab, told = Lab(folder, schedule), Told()
        clients = [Busy(lab, told, schedule.randrange(1 << 30)) for _ in range(4)]
        try:
            for client in clients:
                client.start()
            self.warm_up(told)
            try:
                for number in range(rounds):
                    for _ in range(EVENTS):
                        self.disturb(lab, told, seed + number)
            finally:
                for client in clients:
                    client.stop.set()
                for client in clients:
                    client.join()
            asked = time.monotonic()
            a, b = lab.daemons()
            for daemon in (a, b):
                daemon.patience_s = PATIENCE_S
            self.judge(a, b, told, lambda query: lab.database.primary.rows(folder, query))
            note(judged=seed, rounds=rounds, recordings=len(told.recordings), jobs=len(told.jobs), lost=0, twice=0,
                 judging_s=round(time.monotonic() - asked, 1))
        finally:
            lab.end()

    def warm_up(self, told: Told) -> None:
        until = time.monotonic() + PATIENCE_S
        while len(told.read_at) < 20:
            self.assertLess(time.monotonic(), until, "nothing is done though nothing is wrong")
            time.sleep(0.1)

    def disturb(self, lab: Lab, told: Told, seed: int) -> None:
        quiet = time.monotonic()
        time.sleep(lab.random.uniform(WINDOW_S, 1.5 * WINDOW_S))
        before = rate(told, quiet, time.monotonic())
        self.assertGreater(before, 0.0, "nothing is done though nothing is wrong")
        faults = lab.event()
        kind = " and ".join(fault.kind for fault in faults)
        for fault in faults:
            fault.begin()
        time.sleep(lab.random.uniform(0.2, 4.0))
        ended = time.monotonic()
        # The database first, for nobody starts without it.
        for fault in sorted(faults, key=lambda fault: fault.kind not in lab.DATABASE):
            fault.end()
        after = self.recovery(told, ended, before, kind)
        for fault in faults:
            fault.repair()
        note(seed=seed, fault=kind, recovered_s=round(after, 1), rate_before=round(before, 1))

    def recovery(self, told: Told, ended: float, before: float, kind: str) -> float:
        """After how many seconds a window of two seconds begins in which half as many results are read as before, or more."""
        begin = ended
        while True:
            while time.monotonic() < begin + WINDOW_S:
                time.sleep(0.02)
            if rate(told, begin, begin + WINDOW_S) >= 0.5 * before:
                return begin - ended
            begin += 0.1
            self.assertLess(begin - ended, RECOVERY_S, f"{kind}: work does not go on, {before:.1f} results a second before")


if __name__ == "__main__":
    unittest.main()
