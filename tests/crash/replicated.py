"""A PostgreSQL with a synchronous standby, each on a host of its own, and a third host for the next standby.

Synchronous commit, without exception: `synchronous_standby_names = *` and `synchronous_commit = on`, so that a write is acknowledged when the
standby has it too, and waits where there is none. Whoever runs it promotes a standby that was synchronous when its primary went, and
lets the old primary write no more: what patroni does with `synchronous_mode_strict`. `fsync` is off: programs die here, machines do not.
"""
from __future__ import annotations

import atexit
import shutil
import signal
import subprocess
import time
from pathlib import Path

import postgres
from network import BACK, Host
from postgres import PATIENCE_S

SETTINGS = ("synchronous_standby_names=*", "synchronous_commit=on", "max_connections=300", "wal_sender_timeout=3s", "wal_receiver_timeout=3s",
            "wal_retrieve_retry_interval=200ms", "tcp_user_timeout=15s", "shared_buffers=32MB")


class Server(postgres.Cluster):
    """On one host; begins as a standby of `primary`, or as a new primary."""

    def __init__(self, host: Host, primary: Server | None = None) -> None:
        self.host, self.primary = host, primary
        self.settings = (*SETTINGS, f"listen_addresses={host.back}")
        super().__init__()

    def _make_data(self) -> None:
        if self.primary is not None:
            self._run("pg_basebackup", f"--pgdata={self.folder / 'data'}", f"--host={self.primary.host.back}", "--username=driftlab",
                      "--checkpoint=fast", "--no-sync", "--write-recovery-conf")
            return
        super()._make_data()
        with open(self.folder / "data/pg_hba.conf", "a") as hba:
            hba.write(f"host all,replication all {BACK}.0/24 trust\n")

    def _in_child(self) -> None:
        self.host.enter()
        super()._in_child()

    @staticmethod
    def schema_of(data: Path) -> str:
        return "public"

    def start(self) -> None:
        """Again where what is left of a crash still holds its memory."""
        until = time.monotonic() + PATIENCE_S
        while True:
            with open(self.folder / "log", "ab") as log:
                words = [word for setting in ("fsync=off", *self.settings) for word in ("-c", setting)]
                self.server = subprocess.Popen([self.programs / "postgres", "-D", self.folder / "data", "-k", self.folder, *words],
                                               stdout=log, stderr=log, preexec_fn=self._in_child, cwd="/")
            while self.server.poll() is None:
                if subprocess.run([self.programs / "pg_isready", "--quiet", f"--host={self.folder}"], check=False).returncode == 0:
                    return
                time.sleep(0.02)
            assert time.monotonic() < until, (self.folder / "log").read_text()[-2000:]
            time.sleep(0.1)

    def kill(self) -> None:
        """kill -9 of the server's first process; the others end when they see it."""
        self.server.send_signal(signal.SIGKILL)
        self.server.wait(PATIENCE_S)

    def remove(self) -> None:
        super().remove()
        atexit.unregister(self.remove)

    def has_synchronous_standby(self) -> bool:
        return self.sql("SELECT count(*) FROM pg_stat_replication WHERE sync_state = 'sync' AND state = 'streaming'") == "1"


class Replicated:
    def __init__(self, hosts: list[Host]) -> None:
        self.primary = Server(hosts[0])
        self.standby = Server(hosts[1], self.primary)
        self.spare = hosts[2]
        addresses = ",".join(host.back for host in hosts)
        self.store = f"postgresql://driftlab@{addresses}/postgres?target_session_attrs=read-write"
        self.be_synchronous()

    def be_synchronous(self) -> None:
        until = time.monotonic() + PATIENCE_S
        while not self.primary.has_synchronous_standby():
            assert time.monotonic() < until, "the standby does not follow"
            time.sleep(0.05)

    def fail_over(self) -> Server:
        """The standby takes over from a primary that is gone, and gets a standby of its own on the spare host. The old primary."""
        old, self.primary = self.primary, self.standby
        self.primary.sql("SELECT pg_promote(true, 30)")
        self.standby = Server(self.spare, self.primary)
        self.spare = old.host
        return old

    def remove(self) -> None:
        for server in (self.standby, self.primary):
            if server.server.poll() is None:
                server.kill()
            time.sleep(0.2)
            server.remove()
            shutil.rmtree(server.folder, ignore_errors=True)
