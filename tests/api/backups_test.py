"""Backups that the daemon makes, asked or by its timer, and those made while it works; and back."""
from __future__ import annotations

import tempfile
import threading
import time
import unittest
from pathlib import Path
from typing import Any

from daemon import PATIENCE_S, PROGRAM, Daemon
from operating import csv, flip, tool


class Backups(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_the_daemon_backs_itself_up_when_asked_and_by_its_timer(self) -> None:
        kept = self.folder / "backups"
        def ended(daemon: Daemon, count: int) -> list[dict[str, Any]]:
            until = time.monotonic() + PATIENCE_S
            while time.monotonic() < until:
                found = [each for each in daemon.items("/v1/backups?sort=-created_at") if each["state"] != "running"]
                if len(found) >= count:
                    return found
                time.sleep(0.05)
            raise AssertionError(daemon.get("/v1/backups").describe())
        with Daemon(self.folder / "data", arguments=("--backups", str(kept), "--keep-backups", "2")) as daemon:
            recording = daemon.upload(csv(500, 1)).json["id"]
            [first] = ended(daemon, 1)  # there was none: the timer made one at once, before or after the upload
            asked = daemon.post("/v1/backups")
            self.assertEqual(asked.status, 202, asked.describe())
            made = next(each for each in ended(daemon, 2) if each["name"] == asked.json["name"])
            self.assertEqual((made["state"], made["recordings"], made["faults"]), ("complete", 1, []))
            self.assertRegex(daemon.get("/metrics").text, r"(?m)^driftlab_backup_age_seconds \d")
            self.assertIn(made["name"], [row["object"] for row in daemon.items("/v1/audit") if row["action"] == "backup.complete"])
            page = daemon.get("/v1/backups?limit=1").json
            self.assertEqual([each["name"] for each in page["items"]], [first["name"]])
            self.assertEqual([each["name"] for each in daemon.get(f"/v1/backups?limit=1&cursor={page['next_cursor']}").json["items"]], [made["name"]])
            third = daemon.post("/v1/backups").json["name"]
            until = time.monotonic() + PATIENCE_S
            while third not in (names := [each["name"] for each in ended(daemon, 2)]) or first["name"] in names:
                self.assertLess(time.monotonic(), until, names)
                time.sleep(0.05)
            self.assertEqual(names, [third, made["name"]], "those that are gone are not listed")
        self.assertEqual(len(list(kept.iterdir())), 2, "the newest two")
        back = tool(PROGRAM, "restore", "--from", str(kept / made["name"]), "--data", str(self.folder / "again"))
        self.assertEqual(back.returncode, 0, back.stderr)
        with Daemon(self.folder / "again") as daemon:
            self.assertEqual([each["id"] for each in daemon.items("/v1/recordings")], [recording])
            refused = daemon.post("/v1/backups")
            self.assertEqual((refused.status, refused.json["code"]), (409, "conflict"), refused.describe())
            self.assertIn("--backups", refused.json["detail"])

    def test_a_backup_made_while_uploads_run_is_whole_and_comes_back(self) -> None:
        acknowledged: list[str] = []
        stop = threading.Event()
        with Daemon(self.folder / "data") as daemon:
            def upload(worker: int) -> None:
                seed = 0
                while not stop.is_set():
                    answer = daemon.upload(csv(400, 1000 * worker + seed), device=f"w{worker}")
                    if answer.status == 201:
                        acknowledged.append(answer.json["id"])
                    seed += 1
            workers = [threading.Thread(target=upload, args=(i,)) for i in range(3)]
            for worker in workers:
                worker.start()
            while len(acknowledged) < 10:
                time.sleep(0.01)
            before = list(acknowledged)
            made = tool(PROGRAM, "backup", "--data", str(self.folder / "data"), "--to", str(self.folder / "copy"))
            stop.set()
            for worker in workers:
                worker.join()
            self.assertEqual(made.returncode, 0, made.stderr)
            self.assertEqual(tool(PROGRAM, "backup", "--data", str(self.folder / "data"), "--to", str(self.folder / "copy")).returncode, 2)
        back = tool(PROGRAM, "restore", "--from", str(self.folder / "copy"), "--data", str(self.folder / "again"))
        self.assertEqual(back.returncode, 0, back.stderr)
        with Daemon(self.folder / "again") as daemon:
            stored = {r["id"] for r in daemon.items("/v1/recordings?limit=500")}
            self.assertLessEqual(set(before), stored, "all that was acknowledged before the backup began")
            self.assertEqual(daemon.finished(daemon.characterise(before[0]).json["id"])["state"], "succeeded")
        manifest = self.folder / "copy/driftlab.db"
        flip(manifest, 5000)
        refused = tool(PROGRAM, "restore", "--from", str(self.folder / "copy"), "--data", str(self.folder / "third"))
        self.assertEqual(refused.returncode, 1)
        self.assertFalse((self.folder / "third").exists())

    def test_a_backup_that_fails_is_shown_and_the_daemon_stays_ready(self) -> None:
        """Where the directory cannot be made: the age counts from the start, the state says why, and no answer says where."""
        disk = self.folder / "disk"
        disk.write_text("no directory")
        with Daemon(self.folder / "data", arguments=("--backups", str(disk / "backups"), "--backup-hours", "6")) as daemon:
            begun = daemon.logged(event="bad state", state="backups_fail", cause="io")
            self.assertIn(f"The last backup failed: Could not use {disk}", begun["detail"])
            ready = daemon.get("/readyz")
            self.assertEqual(ready.status, 200, ready.text)
            self.assertEqual([(state["state"], state["cause"]) for state in ready.json["states"]], [("backups_fail", "io")])
            metrics = daemon.get("/metrics").text
            self.assertRegex(metrics, r"(?m)^driftlab_backup_age_seconds \d")
            self.assertIn("driftlab_backup_period_seconds 21600\n", metrics)
            self.assertIn('driftlab_bad_states{state="backups_fail",cause="io"} 1\n', metrics)
            self.assertIn("driftlab_ready 1\n", metrics)
            self.assertEqual(len(daemon.items("/v1/backups")), 1, "the timer waits")
            until = time.monotonic() + PATIENCE_S
            def told() -> list[dict[str, Any]]:
                return [row for row in daemon.items("/v1/audit") if row["action"] in ("backup.failed", "state.begin")]
            while len(told()) < 2 and time.monotonic() < until:
                time.sleep(0.1)
            self.assertEqual(sorted(row["action"] for row in told()), ["backup.failed", "state.begin"])
            for text in (ready.text, daemon.get("/v1/backups").text, str(told())):
                self.assertIn("Could not use", text)
                self.assertNotIn(str(self.folder), text)
            disk.unlink()
            name = daemon.post("/v1/backups").json["name"]
            daemon.logged(event="backup complete", backup=name)
            daemon.logged(event="bad state ended", state="backups_fail")
            self.assertEqual(daemon.get("/readyz").json, {"status": "ready"})

    def test_a_directory_may_be_named_with_a_slash_behind_it(self) -> None:
        with Daemon(self.folder / "data") as daemon:
            recording = daemon.upload(csv(500)).json["id"]
        for name, data in (("slash/", "back/"), ("slash-and-dot/.", "back-with-dot/.")):
            made = tool(PROGRAM, "backup", "--data", str(self.folder / "data"), "--to", f"{self.folder}/{name}")
            self.assertEqual((made.returncode, made.stderr), (0, ""))
            back = tool(PROGRAM, "restore", "--from", f"{self.folder}/{name}", "--data", f"{self.folder}/{data}")
            self.assertEqual((back.returncode, back.stderr), (0, ""))
            with Daemon(self.folder / data) as daemon:
                self.assertEqual([each["id"] for each in daemon.items("/v1/recordings")], [recording])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["back", "back-with-dot", "data", "slash", "slash-and-dot"])

    def test_what_is_called_as_an_unfinished_backup_and_is_none_stays(self) -> None:
        with Daemon(self.folder / "data") as daemon:
            daemon.upload(csv(500))
        mine = self.folder / "copy.part"
        mine.mkdir()
        (mine / "notes.txt").write_text("kept by hand")
        def back_up() -> tuple[int, str]:
            made = tool(PROGRAM, "backup", "--data", str(self.folder / "data"), "--to", str(self.folder / "copy"))
            return made.returncode, made.stderr
        self.assertEqual(back_up(), (2, f"driftlabd: There is a {mine} that no driftlabd left unfinished; move it away, or name another.\n"))
        self.assertEqual((mine / "notes.txt").read_text(), "kept by hand")
        (mine / "notes.txt").rename(mine / "driftlab.db")
        self.assertEqual(back_up(), (0, ""), "one that was broken off is replaced")
        self.assertEqual(tool(PROGRAM, "check", "--data", str(self.folder / "copy")).returncode, 0)
        data = self.folder / "again"
        (self.folder / "again.part").write_text("a file")
        refused = tool(PROGRAM, "restore", "--from", str(self.folder / "copy"), "--data", str(data))
        self.assertEqual((refused.returncode, data.exists(), (self.folder / "again.part").read_text()), (2, False, "a file"))


if __name__ == "__main__":
    unittest.main()
