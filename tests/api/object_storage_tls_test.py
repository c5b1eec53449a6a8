"""HTTPS to an object storage: what is kept and read there, and every certificate that is refused."""
from __future__ import annotations

import ssl
import tempfile
import unittest
from pathlib import Path

import certificates
import object_storage
import postgres
import samples
from daemon import Daemon
from object_storage import Fault, FaultyWay
from store_test import start
from suite import SKIPPED

if postgres.programs() is None:
    print("OBJECT STORAGE NOT TESTED: there is no PostgreSQL.")
    raise SystemExit(SKIPPED)
if not object_storage.is_installed() or not certificates.can_be_made():
    print("OBJECT STORAGE NOT TESTED: python3-swift or openssl is not installed (./deploy/packages.sh test).")
    raise SystemExit(SKIPPED)


class OverHttps(unittest.TestCase):
    """A storage behind a certificate of its own for `localhost`."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.files = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.ours, cls.other = certificates.authority(cls.files, "ours"), certificates.authority(cls.files, "other")
        chain, key = certificates.certificate(cls.files, cls.ours, "localhost")
        cls.tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        cls.tls.load_cert_chain(chain, key)

    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.store = postgres.cluster().store_of(self.folder)
        self.swift = object_storage.server()
        self.way = FaultyWay(self.swift.port, self.tls)

    def place(self, port: int | None = None, host: str = "localhost") -> str:
        named = object_storage.place_of(self.folder, port or self.way.port)
        return named.replace(f"http://127.0.0.1:{port or self.way.port}", f"https://{host}:{port or self.way.port}")

    def together(self, place: str) -> tuple[str, ...]:
        return ("--store", self.store, "--blobs", place, "--budget", "reserve_bytes=0")

    def trusting(self, authority: Path) -> dict[str, str]:
        return {**object_storage.KEY, "SSL_CERT_FILE": str(authority), "SSL_CERT_DIR": str(self.folder)}

    def start(self, name: str) -> Daemon:
        return self.enterContext(Daemon(self.folder / name, arguments=self.together(self.place()), environment=self.trusting(self.ours)))

    def refused(self, place: str, authority: Path, said: str) -> None:
        ran = start(self.folder / "refused", self.store, "--blobs", place, environment=self.trusting(authority))
        self.assertIn(ran.returncode, (1, 2), ran.stderr)
        last = ran.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith("driftlabd: ") and last.endswith("."), last)
        self.assertIn(said, last)
        self.assertNotIn(object_storage.SECRET, ran.stderr + ran.stdout)

    def test_recordings_are_kept_and_read_over_https(self) -> None:
        a, content = self.start("a"), samples.gyro_csv(4096, seed=1)
        recording = a.upload(content, rate_hz=100, columns=samples.GYRO_Z).json["id"]
        b = self.start("b")
        self.assertEqual(b.get(f"/v1/recordings/{recording}/content").body, content)
        self.assertEqual(b.finished(b.characterise(recording, models=["WN"]).json["id"])["state"], "succeeded")
        self.assertTrue(self.way.seen)

    def test_a_large_file_goes_in_parts(self) -> None:
        a, content = self.start("a"), samples.gyro_csv(3_800_000, seed=2)
        recording = a.upload(content, rate_hz=100, columns=samples.GYRO_Z).json["id"]
        self.assertGreater(len([one for one in self.way.seen if "partNumber" in one]), 2)
        self.assertEqual(self.start("b").get(f"/v1/recordings/{recording}/content").body, content)

    def test_a_connection_that_is_cut_is_made_again(self) -> None:
        a, content = self.start("a"), samples.gyro_csv(4096, seed=3)
        self.way.fault = Fault("cut", times=1)
        answer = a.upload(content, rate_hz=100, columns=samples.GYRO_Z)
        self.assertIn(answer.status, (200, 201), answer.describe())
        self.assertEqual(self.start("b").get(f"/v1/recordings/{answer.json['id']}/content").body, content)

    def test_an_authority_that_is_not_trusted_is_refused(self) -> None:
        self.refused(self.place(), self.other, "has a certificate that is not trusted: ")
        self.assertEqual(self.way.seen, [], "nothing was asked of it")

    def test_a_certificate_of_another_name_is_refused(self) -> None:
        self.refused(self.place(host="127.0.0.1"), self.ours, "has a certificate that is not trusted: ")
        self.assertEqual(self.way.seen, [])

    def test_a_storage_that_speaks_no_tls_is_refused(self) -> None:
        plain = FaultyWay(self.swift.port)
        self.refused(self.place(plain.port), self.ours, "speaks no TLS that could be agreed on")
        self.assertEqual([one for one in plain.seen if "lab/" in one], [])

    def test_an_old_tls_is_refused(self) -> None:
        old = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        old.load_cert_chain(*(self.files / name for name in ("server.pem", "server.key")))
        old.set_ciphers("ALL:@SECLEVEL=0")
        old.minimum_version = ssl.TLSVersion.TLSv1
        old.maximum_version = ssl.TLSVersion.TLSv1_1
        self.refused(self.place(FaultyWay(self.swift.port, old).port), self.ours, "speaks no TLS that could be agreed on")


if __name__ == "__main__":
    unittest.main(verbosity=2)
