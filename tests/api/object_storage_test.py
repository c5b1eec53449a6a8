"""Recordings in an object storage: a real server, an independent client, and what happens when the storage fails."""
from __future__ import annotations

import contextlib
import http.client
import json
import os
import shutil
import tempfile
import threading
import time
import unittest
from pathlib import Path

import daemon as daemons
import object_storage
import postgres
import samples
from daemon import Answer, Daemon
from object_storage import Fault
from store_test import start
from suite import SKIPPED

if postgres.programs() is None or "built without PostgreSQL" in start(Path("/nonexistent"), "postgresql://127.0.0.1:1/x").stderr:
    print("OBJECT STORAGE NOT TESTED: there is no PostgreSQL.")
    raise SystemExit(SKIPPED)
if not object_storage.is_installed() or not Path(object_storage.AWS).exists():
    print("OBJECT STORAGE NOT TESTED: python3-swift or awscli is not installed (./deploy/packages.sh test).")
    raise SystemExit(SKIPPED)

SMALL = ("--budget", "reserve_bytes=0")


def content_of(seed: int, rows: int = 4096) -> bytes:
    return samples.gyro_csv(rows, seed=seed)


class InObjectStorage(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.store = postgres.cluster().store_of(self.folder)
        self.swift = object_storage.server()
        self.way = object_storage.FaultyWay(self.swift.port)
        self.bucket = object_storage.bucket_of(self.folder)
        self.place = object_storage.place_of(self.folder, self.way.port)

    def start(self, name: str = "a", *arguments: str, environment: dict[str, str] | None = None, blobs: str | None = None) -> Daemon:
        together = ("--store", self.store, "--blobs", blobs or self.place, *SMALL, *arguments)
        return self.enterContext(Daemon(self.folder / name, arguments=together, environment=environment or object_storage.KEY))

    def upload(self, daemon: Daemon, content: bytes) -> Answer:
        return daemon.upload(content, rate_hz=100, columns=samples.GYRO_Z)

    def kept(self, daemon: Daemon, content: bytes) -> dict[str, object]:
        answer = self.upload(daemon, content)
        self.assertIn(answer.status, (200, 201), answer.describe())
        return dict(answer.json)

    def readiness(self, daemon: Daemon, status: int) -> str:
        until = time.monotonic() + 60
        while (answer := daemon.get("/readyz")).status != status and time.monotonic() < until:
            time.sleep(0.1)
        self.assertEqual(answer.status, status, answer.describe())
        return answer.text

    def refused(self, *arguments: str, said: str, blobs: str | None = None, environment: dict[str, str] | None = None) -> None:
        ran = start(self.folder / "refused", self.store, "--blobs", blobs or self.place, *arguments,
                    environment=object_storage.KEY if environment is None else environment)
        self.assertIn(ran.returncode, (1, 2), ran.stderr)
        last = ran.stderr.strip().splitlines()[-1]
        self.assertIn(said, last)
        self.assertTrue(last.startswith("driftlabd: ") and last.endswith("."), last)
        self.assertNotIn(object_storage.SECRET, ran.stderr + ran.stdout)

    def objects(self, prefix: str = "lab/blobs/") -> list[str]:
        return self.swift.keys(self.bucket, prefix)

    # --- an independent client

    def test_another_client_reads_what_is_written_and_writes_what_is_read(self) -> None:
        content = content_of(1)
        a = self.start()
        recording = self.kept(a, content)
        sha256 = recording["file"]["sha256"]  # type: ignore[index]
        key = f"s3://{self.bucket}/lab/blobs/{sha256[:2]}/{sha256}"
        self.assertEqual(object_storage.aws("s3", "cp", key, "-"), content)
        self.assertEqual(a.terminate(), 0)
        copy = self.folder / "copy"
        object_storage.aws("s3", "sync", "--quiet", f"s3://{self.bucket}/lab", str(copy))
        self.assertEqual((copy / "postgresql-store").read_text().count("\n"), 1)
        object_storage.aws("s3", "sync", "--quiet", str(copy), f"s3://{self.bucket}/again")
        b = self.start("b", blobs=self.place.replace("/lab?", "/again?"))
        self.assertEqual(b.get(f"/v1/recordings/{recording['id']}/content").body, content)
        job = b.characterise(str(recording["id"]), models=["WN"]).json["id"]
        self.assertEqual(b.finished(job)["state"], "succeeded")

    def test_a_large_file_goes_in_parts_and_comes_back(self) -> None:
        content = content_of(2, rows=3_800_000)
        self.assertGreater(len(content), 32 << 20)
        a = self.start()
        begun = time.monotonic()
        recording = self.kept(a, content)
        uploaded = time.monotonic() - begun
        self.assertGreater(len([one for one in self.way.seen if "partNumber" in one]), 2)
        b = self.start("b")
        begun = time.monotonic()
        self.assertEqual(b.get(f"/v1/recordings/{recording['id']}/content").body, content)
        size = len(content) / 1e6
        print(f"{size:.0f} MB: uploaded, decoded and stored at {size / uploaded:.0f} MB/s, read at {size / (time.monotonic() - begun):.0f} MB/s")

    # --- what fails

    def test_an_outage_is_said_and_ends(self) -> None:
        a = self.start()
        first = self.kept(a, content_of(1))
        for kind in ("unavailable", "slow", "cut", "denied"):
            with self.subTest(kind):
                self.way.fault = Fault(kind)
                said = self.readiness(a, 503)
                self.assertIn("Recordings cannot be reached: The object storage at 127.0.0.1", said)
                self.assertIn("state blobs_silent, cause io", said)
                self.way.fault = None
                self.readiness(a, 200)
        self.way.fault = Fault("unavailable")
        answer = self.upload(a, content_of(2))
        self.assertEqual(answer.status, 503, answer.describe())
        self.assertIn("retry-after", answer.headers)
        self.assertIn("cannot do it now", answer.json["detail"])
        self.way.fault = Fault("denied")
        answer = self.upload(a, content_of(2))
        self.assertEqual(answer.status, 500, answer.describe())
        self.assertIn("refuses this key", answer.json["detail"])
        self.way.fault = None
        self.assertEqual(len(a.items("/v1/recordings")), 1, "what was refused is not there")
        self.kept(a, content_of(2))
        b = self.start("b")
        self.assertEqual(b.get(f"/v1/recordings/{first['id']}/content").body, content_of(1))

    def test_an_outage_is_no_damage_and_a_job_waits_for_its_end(self) -> None:
        a = self.start()
        recording = str(self.kept(a, content_of(1))["id"])
        b = self.start("b")
        a.kill()
        self.way.fault = Fault("unavailable")
        answer = b.get(f"/v1/recordings/{recording}/content")
        self.assertEqual(answer.status, 503, answer.describe())
        job = str(b.characterise(recording, models=["WN"]).json["id"])
        until = time.monotonic() + 60
        while not b.get(f"/v1/jobs/{job}").json["failed_attempts"] and time.monotonic() < until:
            time.sleep(0.1)
        self.way.fault = None
        self.assertEqual(b.finished(job)["state"], "succeeded")
        self.assertNotIn("file_damaged", json.dumps(b.log))

    def test_a_full_bucket_is_a_full_disk(self) -> None:
        a = self.start()
        self.kept(a, content_of(1))
        self.swift.make_bucket(self.bucket, quota_bytes=1)
        answer = self.upload(a, content_of(2))
        self.assertEqual(answer.status, 507, answer.describe())
        self.assertIn("has no room for more", answer.json["detail"])
        self.swift.make_bucket(self.bucket, quota_bytes=1 << 30)
        self.kept(a, content_of(2))

    def test_damage_and_loss_are_found_and_healed_by_the_same_file(self) -> None:
        content = content_of(1)
        a = self.start()
        recording = self.kept(a, content)
        sha256 = str(recording["file"]["sha256"])  # type: ignore[index]
        key = f"lab/blobs/{sha256[:2]}/{sha256}"
        for spoil in (self.swift.damage, self.swift.lose):
            spoil(self.bucket, key)
            spoil(self.bucket, f"lab/columns/{sha256[:2]}/{sha256}.columns")
            b = self.start(f"after-{spoil.__name__}")
            answer = b.get(f"/v1/recordings/{recording['id']}/content")
            self.assertEqual(answer.status, 500, answer.describe())
            self.assertIn("uploading it again heals it", answer.json["detail"])
            self.assertEqual(self.upload(b, content).status, 200)
            self.assertEqual(b.get(f"/v1/recordings/{recording['id']}/content").body, content)
            c = self.start(f"healed-{spoil.__name__}")
            self.assertEqual(c.get(f"/v1/recordings/{recording['id']}/content").body, content)
            b.kill()
            c.kill()

    def test_what_a_killed_upload_leaves_is_no_recording(self) -> None:
        content = content_of(1)
        a = self.start()
        self.way.fault = Fault("slow", within="columns")

        def begin() -> None:
            with contextlib.suppress(OSError, http.client.HTTPException):
                self.upload(a, content)

        upload = threading.Thread(target=begin)
        upload.start()
        until = time.monotonic() + 60
        while not self.objects() and time.monotonic() < until:
            time.sleep(0.05)
        a.kill()
        upload.join()
        self.way.fault = None
        self.assertEqual((len(self.objects()), len(self.objects("lab/columns/"))), (1, 0))
        b = self.start()
        self.assertEqual(b.items("/v1/recordings"), [])
        self.kept(b, content)

    def test_workers_share_what_daemons_keep(self) -> None:
        a = self.start("a")
        recordings = [str(self.kept(a, content_of(seed))["id"]) for seed in range(6)]
        workers = [self.start(f"worker-{i}", "worker") for i in range(2)]
        jobs = [str(a.characterise(recording, models=["WN", "WN+RW"]).json["id"]) for recording in recordings]
        a.kill()
        c = self.start("c")
        self.assertEqual([c.finished(job)["state"] for job in jobs], ["succeeded"] * len(jobs))
        self.assertEqual([worker.terminate() for worker in workers], [0, 0])

    def test_copies_stay_within_their_budget(self) -> None:
        a = self.start()
        recordings = [self.kept(a, content_of(seed, rows=60_000)) for seed in range(4)]
        b = self.start("b", "--cache-megabytes", "4")
        copies = self.folder / "b" / "copies"
        for recording in recordings * 2:
            sent = b.get(f"/v1/recordings/{recording['id']}/content")
            self.assertEqual(sent.status, 200, sent.describe())
            job = str(b.characterise(str(recording["id"]), models=["WN"]).json["id"])
            self.assertEqual(b.finished(job)["state"], "succeeded")
            for path in copies.rglob("*"):  # as if ten minutes had gone by: what was used a moment ago is left alone
                if path.is_file() and "columns" in path.parts or "blobs" in path.parts:
                    os.utime(path, (time.time() - 600, time.time() - 600))
        largest = max(path.stat().st_size for path in copies.rglob("*") if path.is_file())
        kept = sum(path.stat().st_size for path in copies.rglob("*") if path.is_file())
        self.assertLess(kept, 4_000_000 + 3 * largest)
        self.assertLess(kept, sum(int(one["file"]["bytes"]) for one in recordings) * 2)  # type: ignore[index]

    # --- keys and places

    def test_the_key_is_in_a_file_and_nowhere_else(self) -> None:
        key = self.folder / "key"
        key.write_text(f"[default]\naws_access_key_id = {object_storage.KEY_ID}\naws_secret_access_key = {object_storage.SECRET}\n")
        settings = {name: value for name, value in os.environ.items() if not name.startswith("AWS_")}
        a = self.start("a", "--blobs-credentials", str(key), environment={**settings, "AWS_ACCESS_KEY_ID": ""})
        self.kept(a, content_of(1))
        for target in ("/readyz", "/metrics", "/v1/audit"):
            self.assertNotIn(object_storage.SECRET, a.get(target).text)
        self.assertNotIn(object_storage.SECRET, json.dumps(a.log))
        self.assertNotIn(object_storage.SECRET, Path(f"/proc/{a.process.pid}/cmdline").read_text())
        shown = start(self.folder / "x", "", "config", "--blobs", self.place, "--blobs-credentials", str(key), environment=object_storage.KEY)
        self.assertIn(self.bucket, shown.stdout)
        self.assertNotIn(object_storage.SECRET, shown.stdout)
        key.write_text(f"[default]\naws_access_key_id = {object_storage.KEY_ID}\naws_secret_access_key = wrong\n")
        os.utime(key, (time.time() + 5, time.time() + 5))
        self.assertIn("refuses this key", self.readiness(a, 503))
        key.write_text(f"[default]\naws_access_key_id = {object_storage.KEY_ID}\naws_secret_access_key = {object_storage.SECRET}\n")
        os.utime(key, (time.time() + 10, time.time() + 10))
        self.readiness(a, 200)

    def test_what_cannot_be_is_one_sentence(self) -> None:
        nothing = {"AWS_ACCESS_KEY_ID": "", "AWS_SECRET_ACCESS_KEY": ""}
        self.refused(said="needs a key", environment=nothing)
        self.refused("--blobs-credentials", str(self.folder / "none"), said="does not exist", environment=nothing)
        self.refused(said="refuses this key", environment={**object_storage.KEY, "AWS_SECRET_ACCESS_KEY": "another"})
        self.refused(said="refuses this key", environment={**object_storage.KEY, "AWS_ACCESS_KEY_ID": object_storage.STRANGER})
        self.refused(said="has no bucket nowhere", blobs=self.place.replace(self.bucket, "nowhere"))
        self.refused(said="could not be reached", blobs=self.place.replace(str(self.way.port), "1"))
        self.refused(said="must not hold a key", blobs=f"s3://me:{object_storage.SECRET}@{self.bucket}")
        self.refused(said="must name a bucket", blobs="s3://x")
        self.refused(said="must be nothing for --data, database, the absolute path of a folder, or s3://BUCKET", blobs="elsewhere")
        ran = start(self.folder / "refused", "", "--blobs", self.place, environment=object_storage.KEY)
        self.assertIn("name their database with --store", ran.stderr)

    def test_a_bucket_belongs_to_one_database(self) -> None:
        a = self.start()
        self.kept(a, content_of(1))
        self.assertEqual(a.terminate(), 0)
        other = postgres.cluster().store_of(self.folder / "other")
        ran = start(self.folder / "other", other, "--blobs", self.place, environment=object_storage.KEY)
        self.assertIn("keeps the recordings of another database", ran.stderr)
        ran = start(self.folder / "other", self.store, "--blobs", self.place.replace("/lab?", "/elsewhere?"), environment=object_storage.KEY)
        self.assertIn("The recordings of the database are not in the bucket", ran.stderr)
        object_storage.aws("s3", "cp", "--quiet", "--recursive", f"s3://{self.bucket}/lab/blobs", f"s3://{self.bucket}/unmarked/blobs")
        ran = start(self.folder / "other", other, "--blobs", self.place.replace("/lab?", "/unmarked?"), environment=object_storage.KEY)
        self.assertIn("keeps the recordings of", ran.stderr)

    def test_uploads_at_once_of_the_same_and_of_others(self) -> None:
        a, b = self.start("a"), self.start("b")
        answers: list[Answer] = []
        threads = [threading.Thread(target=lambda d=daemon, s=seed: answers.append(self.upload(d, content_of(s))))  # type: ignore[misc]
                   for daemon in (a, b) for seed in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(daemons.PATIENCE_S)
        self.assertEqual(sorted(answer.status for answer in answers), [200] * 4 + [201] * 4, [answer.describe() for answer in answers])
        self.assertEqual(len(self.objects()), 4)
        shutil.rmtree(self.folder / "b", ignore_errors=True)


if __name__ == "__main__":
    unittest.main()
