"""A PostgreSQL server of the test's own, for daemons that keep their rows in it (DRIFTLAB_TEST_STORE=postgres).

A cluster in a temporary folder, reached by a socket in it alone. initdb refuses root, so that it then runs as the user
`postgres` of Debian's package. Each data directory has a schema of its own. The server ends with the test, also where that
is killed.
"""
from __future__ import annotations

import atexit
import ctypes
import hashlib
import json
import os
import pwd
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

PATIENCE_S = 60.0
PR_SET_PDEATHSIG = 1


def programs() -> Path | None:
    """The programs of the newest PostgreSQL of 15 or later; nothing where none is installed."""
    folders = [path for path in Path("/usr/lib/postgresql").glob("*/bin") if path.parent.name.isdigit() and int(path.parent.name) >= 15]
    return max(folders, key=lambda path: int(path.parent.name), default=None)


def become_owner() -> None:
    """In the child: the user of the cluster, and an end with its parent."""
    if os.getuid() == 0:
        owner = pwd.getpwnam("postgres")
        os.setgroups([])
        os.setgid(owner.pw_gid)
        os.setuid(owner.pw_uid)
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGQUIT)


class Cluster:
    """`settings`: of the server beside its own, such as `ssl=on`."""

    settings: tuple[str, ...] = ()
    port = 5432  # of the socket in its folder, and of the addresses that `settings` may name

    def __init__(self) -> None:
        self._take_folder()
        self._make_data()
        self.start()
        atexit.register(self.remove)

    def _take_folder(self) -> None:
        folder = programs()
        assert folder is not None, "there is no PostgreSQL 15 in /usr/lib/postgresql"
        self.programs = folder
        self.folder = Path(tempfile.mkdtemp(prefix="driftlab-postgres-"))
        if os.getuid() == 0:
            owner = pwd.getpwnam("postgres")
            os.chown(self.folder, owner.pw_uid, owner.pw_gid)

    def _make_data(self) -> None:
        self._run("initdb", f"--pgdata={self.folder / 'data'}", "--username=driftlab", "--auth=trust", "--encoding=UTF8",
                  "--locale=C.UTF-8", "--no-sync")

    def _in_child(self) -> None:
        """Before a program of the server begins."""
        become_owner()

    def _run(self, program: str, *arguments: str) -> str:
        done = subprocess.run([self.programs / program, *arguments], capture_output=True, text=True, timeout=PATIENCE_S,
                              preexec_fn=self._in_child, cwd="/")
        assert done.returncode == 0, done.stderr
        return done.stdout

    def start(self) -> None:
        with open(self.folder / "log", "ab") as log:
            self.server = subprocess.Popen(
                [self.programs / "postgres", "-D", self.folder / "data", "-k", self.folder, "-c", "listen_addresses=", "-c", "fsync=off", "-p", str(self.port),
                 *(word for setting in self.settings for word in ("-c", setting))],
                stdout=log, stderr=log, preexec_fn=self._in_child, cwd="/")
        self._until(lambda: subprocess.run([self.programs / "pg_isready", "--quiet", f"--host={self.folder}", f"--port={self.port}"]).returncode == 0)

    def stop(self) -> None:
        """At once, as a crash would: connections are cut."""
        self.server.send_signal(signal.SIGQUIT)
        self.server.wait(PATIENCE_S)

    def remove(self) -> None:
        if self.server.poll() is None:
            self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    @staticmethod
    def _until(done: Callable[[], bool]) -> None:
        until = time.monotonic() + PATIENCE_S
        while not done():
            assert time.monotonic() < until, "PostgreSQL does not start"
            time.sleep(0.02)

    def sql(self, statements: str) -> str:
        """Runs statements as superuser; the rows of the last, a line each."""
        writable = "dbname=postgres options='-c default_transaction_read_only=off'"
        return self._run("psql", f"--host={self.folder}", f"--port={self.port}", "--username=driftlab", f"--dbname={writable}", "--no-psqlrc", "--quiet",
                         "--tuples-only", "--no-align", "--set=ON_ERROR_STOP=1", f"--command={statements}").strip()

    @staticmethod
    def schema_of(data: Path) -> str:
        return "t" + hashlib.sha256(str(data.resolve()).encode()).hexdigest()[:20]

    @staticmethod
    def _filled(statement: str, values: tuple[str, ...]) -> str:
        for value in values:
            statement = statement.replace("?", "'" + value.replace("'", "''") + "'", 1)
        return statement

    def change(self, data: Path, statement: str, *values: str) -> None:
        """Changes rows of the store of a data directory behind the daemon's back; values stand for the `?` of the statement."""
        self.sql(f"SET search_path = {self.schema_of(data)}; {self._filled(statement, values)}")

    def rows(self, data: Path, query: str, *values: str) -> list[list[Any]]:
        """Rows of the store of a data directory; values stand for the `?` of the query."""
        found = self.sql(f"SET search_path = {self.schema_of(data)}; SELECT json_agg(found) FROM ({self._filled(query, values)}) AS found")
        return [list(row.values()) for row in json.loads(found)] if found else []

    def dump(self, data: Path) -> bytes:
        """The store of a data directory as pg_dump writes it."""
        return self._run("pg_dump", f"--host={self.folder}", f"--port={self.port}", "--username=driftlab", "--dbname=postgres", f"--schema={self.schema_of(data)}").encode()

    def store_of(self, data: Path) -> str:
        """The connection string for a data directory: the same for the same directory."""
        schema = self.schema_of(data)
        self.sql(f"CREATE SCHEMA IF NOT EXISTS {schema}")
        return f"postgresql:///postgres?user=driftlab&host={self.folder}&options=-csearch_path%3D{schema}"


_cluster: list[Cluster] = []


def cluster() -> Cluster:
    """That of this process, started when it is first asked for."""
    if not _cluster:
        _cluster.append(Cluster())
    return _cluster[0]
