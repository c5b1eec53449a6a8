"""`driftlabd migrate`: a lab goes from SQLite to PostgreSQL and back with everything, also where it is cut off on the way."""
from __future__ import annotations

import itertools
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path
from typing import Any

import daemon as daemons
import object_storage
import postgres
import samples
from daemon import Daemon
from store_test import start
from suite import SKIPPED

if postgres.programs() is None or "built without PostgreSQL" in start(Path("/nonexistent"), "postgresql://127.0.0.1:1/x").stderr:
    print("MIGRATE NOT TESTED: there is no PostgreSQL.")
    raise SystemExit(SKIPPED)

LISTS = ("/v1/devices", "/v1/recordings", "/v1/jobs", "/v1/fits", "/v1/models", "/v1/regression-anchors", "/v1/audit")


class Migrate(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.data = self.folder / "data"
        self.store = postgres.cluster().store_of(self.folder)

    def fill(self) -> dict[str, Any]:
        """A lab with something of most kinds; everything that its lists say."""
        with Daemon(self.data) as daemon:
            for seed in range(3):
                recording = daemon.upload(samples.gyro_csv(4096, seed=seed), rate_hz=100, columns=samples.GYRO_Z, condition="static")
                self.assertEqual(recording.status, 201, recording.describe())
                job = daemon.characterise(recording.json["id"], models=["WN", "WN+RW"]).json["id"]
                self.assertEqual(daemon.finished(job)["state"], "succeeded")
            made = daemon.post("/v1/tokens", {"name": "first", "scope": "admin"})
            daemon.token = made.json["secret"]
            self.token = daemon.token
            self.assertEqual(daemon.post("/v1/devices", {"name": "süß"}, {"Idempotency-Key": "k"}).status, 201)
            said = self.everything(daemon)
            self.assertEqual(daemon.terminate(), 0)
        return said

    @staticmethod
    def everything(daemon: Daemon) -> dict[str, Any]:
        while waiting := [job["id"] for job in daemon.items("/v1/jobs") if job["state"] in ("queued", "running")]:
            for job in waiting:
                daemon.finished(job)  # a pooling follows the last characterisation by itself
        said: dict[str, Any] = {target: daemon.items(target) for target in LISTS}
        said["counts"] = daemon.get("/v1/counts").body
        for recording in said["/v1/recordings"]:
            said[recording["id"]] = daemon.get(f"/v1/recordings/{recording['id']}/content").body
        for job in said["/v1/jobs"]:
            result = daemon.get(f"/v1/jobs/{job['id']}/result")
            said[job["id"]] = result.body if result.status == 200 else result.json["code"]
        return said

    def migrate(self, source: Path | str, target: Path | str, *more: str) -> subprocess.CompletedProcess[str]:
        settings = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")} | object_storage.KEY
        return subprocess.run([daemons.PROGRAM, "migrate", "--from", str(source), "--to", str(target), *more], capture_output=True,
                              text=True, timeout=daemons.PATIENCE_S, env=settings)

    def moved(self, *arguments: Any) -> str:
        ran = self.migrate(*arguments)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("all compared", ran.stdout)
        return ran.stdout

    def test_there_and_back_it_is_the_same_lab(self) -> None:
        before = self.fill()
        places = {"folder": str(self.folder / "shared"), "database": "database"}
        if object_storage.is_installed():
            places["objects"] = object_storage.place_of(self.folder)
        else:
            print("OBJECT STORAGE NOT TESTED: python3-swift is not installed.")
        for name, blobs in places.items():
            with self.subTest(blobs=name):
                store = postgres.cluster().store_of(self.folder / name)
                local = self.folder / f"local-{name}"
                more = ("--blobs", blobs, "--data", str(local))
                self.moved(self.data, store, *more)
                shutil.rmtree(local)
                with Daemon(local, arguments=("--store", store, "--blobs", blobs), environment=object_storage.KEY) as daemon:
                    daemon.token = self.token
                    self.assertEqual(self.everything(daemon), before)
                    replay = daemon.post("/v1/devices", {"name": "süß"}, {"Idempotency-Key": "k"})
                    self.assertEqual(replay.headers.get("idempotency-replayed"), "true", replay.describe())
                    recording = before["/v1/recordings"][0]["id"]
                    again = daemon.characterise(recording, models=["WN", "WN+GM"]).json["id"]  # numbers go on behind those that came
                    self.assertEqual(daemon.finished(again)["state"], "succeeded")
                    after = self.everything(daemon)
                    self.assertEqual(daemon.terminate(), 0)
                back = self.folder / f"back-{name}"
                self.moved(store, back, *more)
                with Daemon(back) as daemon:
                    daemon.token = self.token
                    self.assertEqual(self.everything(daemon), after)
                    self.assertEqual(daemon.terminate(), 0)
                self.assertEqual(subprocess.run([daemons.PROGRAM, "check", "--data", str(back)], capture_output=True).returncode, 0)

    def ahead(self, source: Path | str, target: Path | str, *more: str) -> tuple[int, ...]:
        """Recordings, new ones; rows, new, changed and gone ones."""
        ran = self.migrate(source, target, *more, "--ahead")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        said = re.fullmatch(r"copied ahead: (\d+) recordings, (\d+) of them in this run; (\d+) rows, (\d+) new, (\d+) changed, (\d+) gone\n",
                            ran.stdout)
        assert said is not None, ran.stdout
        return tuple(int(number) for number in said.groups())

    def test_a_lab_goes_ahead_while_its_daemons_work(self) -> None:
        self.fill()
        files = sorted(path for path in (self.data / "blobs").rglob("*") if path.is_file())
        local, back = self.folder / "local", self.folder / "back"
        more = ("--blobs", "database", "--data", str(local))
        with Daemon(self.data) as daemon:
            daemon.token = self.token
            self.assertIn("uses the directory", self.migrate(self.data, self.store, *more).stderr, "the move itself needs it alone")
            recordings, copied, rows, new, changed, gone = self.ahead(self.data, self.store, *more)
            self.assertEqual((recordings, copied, changed, gone), (3, 3, 0, 0))
            self.assertEqual(rows, new)
            self.assertGreater(rows, 50)
            self.assertIn("is being filled", start(self.folder / "early", self.store, "--blobs", "database").stderr, "a part of a lab is none")
            made = daemon.upload(samples.gyro_csv(4096, seed=7), rate_hz=100, columns=samples.GYRO_Z, condition="static")
            self.assertEqual(made.status, 201, made.describe())
            first = daemon.items("/v1/recordings")[0]["id"]
            labelled = daemon.request("PATCH", f"/v1/recordings/{first}", {"labels": {"bench": "7"}}, {"If-Match": "*"})
            self.assertEqual(labelled.status, 200, labelled.describe())
            self.assertEqual(daemon.post("/v1/devices", {"name": "soon gone"}).status, 201)
            recordings, copied, rows, new, changed, gone = self.ahead(self.data, self.store, *more)
            self.assertEqual((recordings, copied, gone), (4, 1, 0))
            self.assertGreaterEqual(new, 3, "a recording, its bytes, a device, what the log says of them")
            self.assertGreaterEqual(changed, 1, "labels")
            soon = next(each["id"] for each in daemon.items("/v1/devices") if each["name"] == "soon gone")
            self.assertEqual(daemon.request("DELETE", f"/v1/devices/{soon}", None, {"If-Match": "*"}).status, 204)
            self.assertGreaterEqual(self.ahead(self.data, self.store, *more)[5], 1)
            self.assertEqual(daemon.upload(samples.gyro_csv(4096, seed=8), rate_hz=100, columns=samples.GYRO_Z).status, 201)
            before = self.everything(daemon)
            self.assertEqual(daemon.terminate(), 0)
        said = re.search(r"moved: (\d+) rows of \d+ tables and 5 recordings, (\d+) and 1 of them", self.moved(self.data, self.store, *more))
        assert said is not None
        self.assertLess(int(said[2]), 25, f"of {said[1]} rows; the rest was there")
        self.assertFalse((self.data / "moved-ahead").exists())
        self.assertLessEqual(set(files), set((self.data / "blobs").rglob("*")), "the source stays as it is")
        with Daemon(local, arguments=("--store", self.store, "--blobs", "database")) as daemon:
            daemon.token = self.token
            self.assertEqual(self.everything(daemon), before)
            third = ("--blobs", "database", "--data", str(self.folder / "third"))
            self.assertIn("stop them", self.migrate(self.data, self.store, *third, "--ahead").stderr, "a target that is at work")
            copies = ("--blobs", "database", "--data", str(self.folder / "copies"))
            self.assertEqual(self.ahead(self.store, back, *copies)[:2], (5, 5))
            self.assertIn("is being filled", start(back, "").stderr)
            self.assertEqual(daemon.post("/v1/devices", {"name": "late"}).status, 201)
            self.assertEqual(self.ahead(self.store, back, *copies)[:2], (5, 0))
            before = self.everything(daemon)
            self.assertEqual(daemon.terminate(), 0)
        self.assertRegex(self.moved(self.store, back, *more), r"and 5 recordings, \d+ and 0 of them")
        with Daemon(back) as daemon:
            daemon.token = self.token
            self.assertEqual(self.everything(daemon), before)

    def test_what_names_another_goes_with_it(self) -> None:
        """A model and the one that it was made of are removed between two runs; a half-filled store is no source; a move that ended is not done again."""
        self.fill()
        more = ("--blobs", "database", "--data", str(self.folder / "local"))
        noise = {"process": "white_noise", "params": {"N": {"value": 0.3, "unit": "deg/sqrt(h)"}}}
        with Daemon(self.data) as daemon:
            daemon.token = self.token
            first = daemon.post("/v1/models", {"name": "first", "processes": [noise]})
            self.assertEqual(first.status, 201, first.describe())
            second = daemon.post("/v1/models", {"name": "second", "parent": first.json["id"], "processes": [noise, noise]})
            self.assertEqual(second.status, 201, second.describe())
            self.ahead(self.data, self.store, *more)
            for made in (second, first):
                removed = daemon.request("DELETE", f"/v1/models/{made.json['id']}", None, {"If-Match": "*"})
                self.assertEqual(removed.status, 204, removed.describe())
            self.assertGreaterEqual(self.ahead(self.data, self.store, *more)[5], 2)
            half = self.migrate(self.store, self.folder / "elsewhere", "--blobs", "database", "--data", str(self.folder / "copies"), "--ahead")
            self.assertIn("is being filled", half.stderr)
            self.assertEqual(daemon.terminate(), 0)
        mark = self.data / "moved-ahead"
        said = mark.read_text()
        self.moved(self.data, self.store, *more)
        mark.write_text(said)  # as after a kill in its last steps
        again = self.migrate(self.data, self.store, *more)
        self.assertEqual(again.returncode, 2)
        self.assertIn("had ended", again.stderr)

    def test_nothing_is_missing_of_what_was_uploaded_while_it_went_ahead(self) -> None:
        """Clients upload, label, characterise and remove all the time; runs go ahead beside them, one is killed, then the lab is moved."""
        self.fill()
        more = ("--blobs", "database", "--data", str(self.folder / "local"))
        with Daemon(self.data) as daemon:
            daemon.token = self.token
            ended = threading.Event()
            kept: list[str] = []
            failed: list[str] = []

            def work() -> None:
                for seed in itertools.count(100):
                    if ended.is_set():
                        return
                    made = daemon.upload(samples.gyro_csv(1024, seed=seed), rate_hz=100, columns=samples.GYRO_Z, condition="static")
                    if made.status != 201:
                        failed.append(made.describe())
                        return
                    recording = made.json["id"]
                    if seed % 3 == 0:
                        daemon.request("DELETE", f"/v1/recordings/{recording}", None, {"If-Match": "*"})
                        continue
                    daemon.request("PATCH", f"/v1/recordings/{recording}", {"labels": {"seed": str(seed)}}, {"If-Match": "*"})
                    daemon.characterise(recording, models=["WN"])
                    kept.append(recording)

            client = threading.Thread(target=work)
            client.start()
            for _ in range(3):
                self.ahead(self.data, self.store, *more)
            process = subprocess.Popen([daemons.PROGRAM, "migrate", "--from", str(self.data), "--to", self.store, *more, "--ahead"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(0.1)
            process.kill()
            process.wait()
            self.ahead(self.data, self.store, *more)
            ended.set()
            client.join()
            self.assertEqual(failed, [])
            self.assertGreater(len(kept), 3)
            before = self.everything(daemon)
            self.assertEqual(daemon.terminate(), 0)
        self.moved(self.data, self.store, *more)
        with Daemon(self.folder / "local", arguments=("--store", self.store, "--blobs", "database")) as daemon:
            daemon.token = self.token
            self.assertLessEqual(set(kept), {each["id"] for each in daemon.items("/v1/recordings")})
            self.assertEqual(self.everything(daemon), before)

    def test_what_was_copied_ahead_to_another_target_is_not_believed(self) -> None:
        self.fill()
        more = ("--blobs", "database", "--data", str(self.folder / "local"))
        self.assertEqual(self.ahead(self.data, self.store, *more)[:2], (3, 3))
        cluster = postgres.cluster()
        schema = cluster.schema_of(self.folder)
        cluster.sql(f"DROP SCHEMA {schema} CASCADE; CREATE SCHEMA {schema}")
        shutil.rmtree(self.folder / "local")
        self.assertRegex(self.moved(self.data, self.store, *more), r"and 3 recordings, \d+ and 3 of them")

    def test_a_move_that_was_killed_goes_on(self) -> None:
        self.fill()
        arguments = ("--blobs", "database", "--data", str(self.folder / "local"))
        command = [daemons.PROGRAM, "migrate", "--from", str(self.data), "--to", self.store, *arguments]
        killed, began_s = 0, 0.0
        for more_s in (0.0, 0.02, 0.05, 0.1):  # from its beginning: a fast machine moves this lab in a fifth of a second
            begun = time.monotonic()
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while not (self.data / "moving").exists() and process.poll() is None:
                time.sleep(0.001)
            began_s = began_s or time.monotonic() - begun  # the mark of a killed one stays
            time.sleep(max(0.0, begun + began_s + more_s - time.monotonic()))
            if process.poll() is None:
                process.send_signal(signal.SIGKILL)
                killed += 1
            process.wait()
            if (self.data / "moving").exists():
                refused = start(self.data, "")
                self.assertIn("is being moved", refused.stderr)
        self.assertGreater(killed, 0)
        ran = self.migrate(self.data, self.store, *arguments)
        if ran.returncode != 0:  # one of them had ended before it was killed
            self.assertIn("holds rows already", ran.stderr)
        self.assertFalse((self.data / "moving").exists())
        with Daemon(self.folder / "local", arguments=("--store", self.store, "--blobs", "database")) as daemon:
            daemon.token = self.token
            self.assertEqual(len(daemon.items("/v1/recordings")), 3)

    def test_what_cannot_be_moved_is_one_sentence(self) -> None:
        self.fill()
        local = ("--blobs", "database", "--data", str(self.folder / "local"))
        for arguments, said in (((self.data, self.folder / "other"), "name one of each"),
                                ((self.store, self.store), "name one of each"),
                                ((self.data, "postgresql://127.0.0.1:1/x", *local), "does not answer")):
            ran = self.migrate(*arguments)
            self.assertIn(ran.returncode, (1, 2))
            self.assertIn(said, ran.stderr)
        with Daemon(self.data):
            self.assertIn("uses the directory", self.migrate(self.data, self.store, *local).stderr)
        with Daemon(self.folder / "a", arguments=("--store", self.store, "--blobs", "database")) as daemon:
            self.assertIn("stop them", self.migrate(self.data, self.store, *local).stderr)
            self.assertEqual(daemon.post("/v1/devices", {"name": "other"}).status, 201)
        self.assertIn("holds rows already", self.migrate(self.data, self.store, *local).stderr)
        with Daemon(self.data) as daemon:
            self.assertEqual(daemon.get("/v1/devices", Authorization=f"Bearer {self.token}").status, 200, "the source stays as it is")


if __name__ == "__main__":
    unittest.main()
