"""TLS between the daemon and its database, and a password: what sslmode asks for holds, and what fails is said in one sentence."""
from __future__ import annotations

import secrets
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import certificates
import postgres
import samples
from daemon import PATIENCE_S, Daemon
from store_test import start
from suite import SKIPPED

if not certificates.can_be_made():
    print("SKIPPED: certificates of the test are made by the program openssl, which is not here")
    raise SystemExit(SKIPPED)

PASSWORD = secrets.token_hex(12)


class OverTls(unittest.TestCase):
    """One server with a certificate of its own for `localhost`, on loopback, which lets in by password and over TLS alone."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.folder.chmod(0o755)
        cls.ours, cls.other = certificates.authority(cls.folder, "ours"), certificates.authority(cls.folder, "other")
        cls.port = certificates.free_port()
        cls.cluster = postgres.Cluster()
        cls.addClassCleanup(cls.cluster.remove)
        data = cls.cluster.folder / "data"
        for file in certificates.certificate(cls.folder, cls.ours, "localhost"):
            kept = data / file.name
            shutil.copy(file, kept)
            kept.chmod(0o600)
            owner = (data / "PG_VERSION").stat()
            shutil.chown(kept, owner.st_uid, owner.st_gid)
        cls.cluster.sql(f"CREATE ROLE lab LOGIN PASSWORD '{PASSWORD}'; GRANT CREATE ON DATABASE postgres TO lab")
        with open(data / "pg_hba.conf", "w") as hba:
            hba.write("local all driftlab trust\nhostssl all lab 127.0.0.1/32 scram-sha-256\n")
        cls.restart(ssl=True)

    @classmethod
    def restart(cls, *, ssl: bool) -> None:
        cls.cluster.stop()
        cls.cluster.port = cls.port
        cls.cluster.settings = ("listen_addresses=127.0.0.1", f"ssl={'on' if ssl else 'off'}",
                                "ssl_cert_file=server.pem", "ssl_key_file=server.key")
        cls.cluster.start()

    def setUp(self) -> None:
        self.data = Path(self.enterContext(tempfile.TemporaryDirectory())) / "data"
        self.schema = self.cluster.schema_of(self.data)
        self.cluster.sql(f"CREATE SCHEMA {self.schema} AUTHORIZATION lab")

    def store(self, *parameters: str, host: str = "localhost", password: str = PASSWORD) -> str:
        return f"postgresql://lab:{password}@{host}:{self.port}/postgres?" + "&".join((*parameters, f"options=-csearch_path%3D{self.schema}"))

    def refused(self, store: str, said: str) -> None:
        """In one sentence, with the reason, and with the password nowhere."""
        ran = start(self.data, store)
        self.assertIn(ran.returncode, (1, 2), ran.stderr)
        last = ran.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith('driftlabd: The database "postgres" on ') and last.endswith("."), last)
        self.assertIn(said, last)
        self.assertNotIn(PASSWORD, ran.stdout + ran.stderr)

    def test_a_server_whose_authority_is_named_is_used_and_every_connection_is_encrypted(self) -> None:
        store = self.store("sslmode=verify-full", f"sslrootcert={self.ours}")
        with Daemon(self.data, arguments=("--store", store)) as daemon:
            recording = daemon.upload(samples.gyro_csv(2048), rate_hz=100, columns=samples.GYRO_Z).json["id"]
            self.assertEqual(daemon.finished(daemon.characterise(recording, models=["WN"]).json["id"])["state"], "succeeded")
            connections = self.cluster.sql("SELECT ssl, version FROM pg_stat_ssl JOIN pg_stat_activity USING (pid) WHERE usename = 'lab'")
            self.assertTrue(connections)
            self.assertLessEqual(set(connections.splitlines()), {"t|TLSv1.2", "t|TLSv1.3"})
            self.assertEqual(daemon.terminate(), 0)
            self.assertNotIn(PASSWORD, repr(daemon.log))

    def test_another_authority_is_refused(self) -> None:
        self.refused(self.store("sslmode=verify-full", f"sslrootcert={self.other}"), "certificate verify failed")
        self.refused(self.store("sslmode=verify-ca", f"sslrootcert={self.other}"), "certificate verify failed")

    def test_another_name_is_refused_where_names_are_compared(self) -> None:
        self.refused(self.store("sslmode=verify-full", f"sslrootcert={self.ours}", host="127.0.0.1"), "does not match host name")
        with Daemon(self.data, arguments=("--store", self.store("sslmode=verify-ca", f"sslrootcert={self.ours}", host="127.0.0.1"))) as daemon:
            self.assertEqual(daemon.get("/readyz").status, 200)

    def test_an_authority_that_is_not_there_and_a_wrong_password_are_said(self) -> None:
        self.refused(self.store("sslmode=verify-full", f"sslrootcert={self.folder / 'absent.pem'}"), "absent.pem")
        self.refused(self.store("sslmode=verify-full", f"sslrootcert={self.ours}", password=PASSWORD + "x"), "password authentication failed")

    def test_a_plain_server_is_refused_where_tls_is_required(self) -> None:
        self.restart(ssl=False)
        try:
            for mode in ("require", "verify-full"):
                self.refused(self.store(f"sslmode={mode}", f"sslrootcert={self.ours}"), "does not support SSL")
        finally:
            self.restart(ssl=True)

    def test_plain_text_is_refused_where_the_server_asks_for_tls(self) -> None:
        self.refused(self.store("sslmode=disable"), "no pg_hba.conf entry")

    def test_a_server_that_comes_back_without_tls_gets_nothing(self) -> None:
        store = self.store("sslmode=verify-full", f"sslrootcert={self.ours}")
        with Daemon(self.data, arguments=("--store", store)) as daemon:
            self.restart(ssl=False)
            try:
                told = daemon.get("/v1/devices")
                self.assertEqual((told.status, told.json["type"]), (503, "/problems/not-ready"), told.describe())
                self.assertNotIn(PASSWORD, told.text)
            finally:
                self.restart(ssl=True)
            until = time.monotonic() + PATIENCE_S
            while daemon.get("/readyz").status != 200:
                self.assertLess(time.monotonic(), until, "it does not find its database again")
                time.sleep(0.1)
            self.assertEqual(daemon.get("/v1/devices").status, 200)


if __name__ == "__main__":
    unittest.main()
