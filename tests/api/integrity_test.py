"""What is stored is verified: a flipped bit is noticed before anything uses it, told, and healed where it can be."""
from __future__ import annotations

import json
import sqlite3
import tempfile
import time
import unittest
from contextlib import closing
from pathlib import Path
from typing import Any

import samples
from daemon import PATIENCE_S, PROGRAM, Daemon
from operating import csv, flip, tool


class Stored(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_a_flipped_bit_is_noticed_before_a_result_uses_it(self) -> None:
        with Daemon(arguments=("--budget", "scrub_bytes_per_second=0")) as daemon:
            uploads = [daemon.upload(csv(3000, seed), device=f"d{seed}").json for seed in range(3)]
            first = daemon.characterise(uploads[0]["id"])
            whole = daemon.finished(first.json["id"])
            before = daemon.get(whole["result"]["href"]).json
            def columns(upload: dict[str, dict[str, str]]) -> Path:
                sha = upload["file"]["sha256"]
                return daemon.data / "columns" / sha[:2] / f"{sha}.columns"
            sound = columns(uploads[0]).read_bytes()
            flip(columns(uploads[0]))
            again = daemon.finished(daemon.characterise(uploads[0]["id"], seed=9).json["id"])
            self.assertEqual(again["state"], "succeeded")
            self.assertEqual(columns(uploads[0]).read_bytes(), sound, "healed from the bytes")
            after = daemon.get(again["result"]["href"]).json
            self.assertEqual(after["recordings"][0]["channels"][0]["allan"], before["recordings"][0]["channels"][0]["allan"])
            daemon.logged(event="columns were made anew from the uploaded bytes")
            sha = uploads[1]["file"]["sha256"]
            flip(columns(uploads[1]))
            flip(daemon.data / "blobs" / sha[:2] / sha)
            job = daemon.characterise(uploads[1]["id"]).json["id"]
            until = time.monotonic() + PATIENCE_S
            while not daemon.get(f"/v1/jobs/{job}").json["failed_attempts"] and time.monotonic() < until:
                time.sleep(0.05)
            seen = daemon.get(f"/v1/jobs/{job}").json
            self.assertNotEqual(seen["state"], "succeeded")
            self.assertIn("damaged", seen["failed_attempts"][0]["detail"])
            self.assertEqual(daemon.get("/readyz").json["damaged_files"], 1)
            self.assertEqual(len([line for line in daemon.log if line.get("event") == "bad state"]), 1)

    def test_a_flipped_bit_is_not_drawn_either(self) -> None:
        with Daemon(arguments=("--budget", "scrub_bytes_per_second=0")) as daemon:
            upload = daemon.upload(csv(3000, 1)).json
            sha = upload["file"]["sha256"]
            columns = daemon.data / "columns" / sha[:2] / f"{sha}.columns"
            looks = [f"/v1/recordings/{upload['id']}/{look}?channel=gz%20%5Bdeg/s%5D" for look in ("trace", "spectrum")]
            before = [daemon.get(look) for look in looks]
            self.assertEqual([answer.status for answer in before], [200, 200], [answer.text for answer in before])
            for answer in before:
                flip(columns)
                self.assertEqual(daemon.get(answer.target).body, answer.body, "made anew from the bytes")
            flip(columns)
            flip(daemon.data / "blobs" / sha[:2] / sha)
            for look in looks:
                answer = daemon.get(look)
                self.assertGreaterEqual(answer.status, 500)
                self.assertIn("damaged", answer.json["detail"])

    def test_the_background_finds_and_heals(self) -> None:
        with Daemon(arguments=("--budget", "scrub_bytes_per_second=1000000000")) as daemon:
            uploads = [daemon.upload(csv(3000, seed), device=f"d{seed}").json for seed in range(2)]
            sha = uploads[0]["file"]["sha256"]
            flip(daemon.data / "columns" / sha[:2] / f"{sha}.columns")
            other = uploads[1]["file"]["sha256"]
            flip(daemon.data / "blobs" / other[:2] / other)
            damaged = daemon.logged(event="bad state", blob=other, state="file_damaged", cause="damage")
            self.assertIn("damaged bytes", damaged["detail"])
            [state] = daemon.get("/readyz").json["states"]
            self.assertEqual((state["state"], state["cause"], state["file"]), ("file_damaged", "damage", other))
            self.assertIn('driftlab_bad_states{state="file_damaged",cause="damage"} 1\n', daemon.get("/metrics").text)
            daemon.logged(event="columns were made anew from the uploaded bytes", blob=sha)
            self.assertIn("driftlab_blobs_damaged 1\n", daemon.get("/metrics").text)
            self.assertEqual(daemon.upload(csv(3000, 1), device="d1").status, 200, "the same file again heals it")
            until = time.monotonic() + PATIENCE_S
            def audited(action: str) -> list[str]:
                return [row["object"] for row in daemon.items("/v1/audit") if row["action"] == action]
            while not audited("state.begin") and time.monotonic() < until:
                time.sleep(0.1)
            self.assertEqual(audited("state.begin"), [other], "once, with what it is about")

    def test_a_flipped_bit_in_a_row_is_noticed_before_an_answer_has_it(self) -> None:
        """One bit of what a row says, in the file of the database itself; and two rows that somebody wrote to."""
        scrubbing = ("--budget", "scrub_bytes_per_second=0")
        with Daemon(self.folder / "data", arguments=scrubbing) as daemon:
            recording = daemon.upload(csv(3000), id="kiwi fruit").json["id"]
            other = daemon.upload(csv(3000, 2), id="other").json["id"]
            job = daemon.finished(daemon.characterise(other).json["id"])["id"]
            asked = daemon.finished(daemon.characterise(other, seed=9).json["id"])["id"]
            fit = daemon.items("/v1/fits")[0]["id"]
            self.assertEqual(daemon.terminate(), 0)
        file = self.folder / "data/driftlab.db"
        content = file.read_bytes()
        self.assertGreater(content.count(b"kiwi fruit"), 0)
        file.write_bytes(content.replace(b"kiwi fruit", b"kiwi gruit"))  # 0x66 and 0x67
        with closing(sqlite3.connect(file)) as database, database:
            for table, key, of in (("fits", fit, "id"), ("job_results", job, "job_id"), ("jobs", asked, "id")):
                column = "request_json" if table == "jobs" else "document_json"
                other = f"UPDATE {table} SET {column} = replace({column}, '1', '3') WHERE {of} = ?"
                changed = database.execute(other, (key,)).rowcount
                self.assertEqual(changed, 1, table)
        rows = {f"/v1/recordings/{recording}": f"recordings/{recording}", f"/v1/fits/{fit}": f"fits/{fit}",
                f"/v1/jobs/{job}/result": f"job_results/{job}", f"/v1/jobs/{asked}": f"jobs/{asked}"}
        checked = tool(PROGRAM, "check", "--data", str(self.folder / "data"))
        self.assertEqual(checked.returncode, 1)
        for row in rows.values():
            self.assertIn(f"The row {row} of the database is damaged.", checked.stderr)
        with Daemon(self.folder / "data", arguments=scrubbing) as daemon:
            for target, row in rows.items():
                for _ in range(2):
                    answer = daemon.get(target)
                    self.assertEqual((answer.status, answer.json["code"]), (500, "io"), answer.describe())
                    self.assertEqual(answer.json["where"], {"damaged_row": row})
            self.assertEqual(daemon.characterise(recording).status, 500, "no result is made of it")
            states = daemon.get("/readyz").json["states"]
            self.assertEqual({(state["state"], state["cause"]) for state in states}, {("row_damaged", "damage")})
            self.assertEqual({state["row"] for state in states}, set(rows.values()))
            self.assertIn('driftlab_bad_states{state="row_damaged",cause="damage"} 4\n', daemon.get("/metrics").text)
            self.assertEqual(sorted(line["row"] for line in daemon.log if line.get("event") == "bad state"), sorted(rows.values()), "once")
            until = time.monotonic() + PATIENCE_S
            begun: list[str] = []
            while begun != sorted(rows.values()) and time.monotonic() < until:
                begun = sorted(row["object"] for row in daemon.items("/v1/audit") if row["action"] == "state.begin")
                time.sleep(0.1)
            self.assertEqual(begun, sorted(rows.values()))
            self.assertEqual(daemon.request("DELETE", f"/v1/recordings/{recording}", headers={"If-Match": '"1"'}).status, 500)
            gone = daemon.request("DELETE", f"/v1/recordings/{recording}", headers={"If-Match": "*"})
            self.assertEqual(gone.status, 204, gone.describe())

    def test_what_is_made_once_can_be_deleted_though_its_row_is_damaged(self) -> None:
        made: dict[str, dict[str, Any]] = {"studies": {"device": {"id": "a"}}, "calibrations": {"device": {"id": "a"}, "calibration": {"gyroscope": {"apply": samples.CORRECTION}}},
                "models": {"name": "white", "device": "a", "processes": [samples.WHITE_NOISE]}}
        with Daemon(self.folder / "data") as daemon:
            recording = daemon.upload(csv(3000), device="a").json["id"]
            made["studies"]["recordings"] = [{"recording": recording}]
            places = {table: daemon.post(f"/v1/{table}", body).headers["location"] for table, body in made.items()}
            self.assertEqual(daemon.terminate(), 0)
        with closing(sqlite3.connect(self.folder / "data/driftlab.db")) as database, database:
            for table in made:
                self.assertEqual(database.execute(f"UPDATE {table} SET document_json = replace(document_json, 'r', 's')").rowcount, 1, table)
        with Daemon(self.folder / "data") as daemon:
            for table, place in places.items():
                self.assertEqual(daemon.get(place).status, 500, table)
                self.assertEqual(daemon.request("DELETE", place, headers={"If-Match": '"other"'}).status, 500, table)
                gone = daemon.request("DELETE", place)
                self.assertEqual(gone.status, 204, gone.describe())
                self.assertEqual(daemon.get(place).status, 404, table)

    def test_a_flipped_bit_in_the_problem_of_a_job_is_not_shown(self) -> None:
        """Of a failed job and of one that succeeded: answered by its name, listed as damaged, told once and by `check`."""
        scrubbing = ("--budget", "scrub_bytes_per_second=0")
        with Daemon(self.folder / "data", arguments=scrubbing) as daemon:
            short = daemon.upload(csv(3), id="short").json["id"]
            failed = daemon.finished(daemon.characterise(short).json["id"])
            self.assertEqual(failed["state"], "failed")
            sound = daemon.finished(daemon.characterise(short, seed=2).json["id"])
            evaluation = daemon.finished(daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 10}).json["id"])["id"]
            self.assertEqual(daemon.terminate(), 0)
        file, told = self.folder / "data/driftlab.db", failed["problem"]["detail"]
        other = told[:-2] + chr(ord(told[-2]) ^ 1) + told[-1]
        with closing(sqlite3.connect(file)) as database, database:
            for table, key, job in (("jobs", "id", failed), ("job_attempts", "job_id", sound)):
                change = f"UPDATE {table} SET problem_json = replace(problem_json, ?, ?) WHERE {key} = ?"
                self.assertEqual(database.execute(change, (told, other, job["id"])).rowcount, 1)
            database.execute("UPDATE jobs SET started_at = started_at + 1 WHERE id = ?", (evaluation,))
        rows = {failed["id"]: f"jobs/{failed['id']}", sound["id"]: f"job_attempts/{sound['id']}/1", evaluation: f"jobs/{evaluation}"}
        checked = tool(PROGRAM, "check", "--data", str(self.folder / "data"))
        self.assertEqual(checked.returncode, 1)
        for row in rows.values():
            self.assertEqual(checked.stderr.count(f"The row {row} of the database is damaged."), 1, checked.stderr)
        with Daemon(self.folder / "data", arguments=scrubbing) as daemon:
            for target, row in [*((f"/v1/jobs/{job}", row) for job, row in rows.items()), (f"/v1/outage-evaluations/{evaluation}", rows[evaluation])]:
                answer = daemon.get(target)
                self.assertEqual((answer.status, answer.json["code"], answer.json["where"]), (500, "io", {"damaged_row": row}), answer.describe())
            listed = {job["id"]: job for job in [*daemon.items("/v1/jobs"), *daemon.items("/v1/outage-evaluations")]}
            for job in (failed["id"], evaluation):
                self.assertEqual(listed[job]["problem"]["where"], {"damaged_row": rows[job]})
            self.assertEqual(listed[sound["id"]]["problem"], sound["problem"], "its attempt is damaged, and not what is listed of it")
            self.assertNotIn(other, json.dumps(listed))
            self.assertEqual({state["row"] for state in daemon.get("/readyz").json["states"]}, set(rows.values()))
            self.assertEqual(sorted(line["row"] for line in daemon.log if line.get("event") == "bad state"), sorted(rows.values()), "once")
            again = daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 100})
            self.assertEqual(again.status, 202, "made anew")
            self.assertNotEqual(again.json["id"], evaluation)

    def test_a_check_compares_the_amounts_that_are_kept_with_the_rows(self) -> None:
        with Daemon(self.folder / "data") as daemon:
            daemon.upload(csv(3000), device="a")
            device = daemon.get("/v1/devices/a").json["id"]
            gone = daemon.upload(csv(2000), device="b").json["id"]
            self.assertEqual(daemon.request("DELETE", f"/v1/recordings/{gone}", headers={"If-Match": "*"}).status, 204)
            self.assertEqual(daemon.terminate(), 0)
        self.assertEqual(tool(PROGRAM, "check", "--data", str(self.folder / "data")).returncode, 0)
        for change in ("number = number + 1", "number = number - 1, bytes = bytes + 1"):
            with closing(sqlite3.connect(self.folder / "data/driftlab.db")) as database, database:
                database.execute(f"UPDATE stored_amounts SET {change} WHERE kept_by = ?", (f"device/{device}",))
            checked = tool(PROGRAM, "check", "--data", str(self.folder / "data"))
            self.assertEqual(checked.returncode, 1)
            self.assertIn(f"The amount that is kept of device/{device} is not that of what is stored.", checked.stderr)

    def test_the_background_finds_damaged_rows_and_says_when_they_are_gone(self) -> None:
        with Daemon(self.folder / "data") as daemon:
            recording = daemon.upload(csv(3000)).json["id"]
        with closing(sqlite3.connect(self.folder / "data/driftlab.db")) as database, database:
            [(sound,)] = database.execute("SELECT quality_json FROM recordings").fetchall()
            database.execute("UPDATE recordings SET quality_json = ?", (sound.replace("0", "1", 1),))
        with Daemon(self.folder / "data", arguments=("--budget", "scrub_bytes_per_second=1000000000")) as daemon:
            daemon.logged(event="bad state", state="row_damaged", cause="damage", row=f"recordings/{recording}")
            gone = daemon.request("DELETE", f"/v1/recordings/{recording}", headers={"If-Match": "*"})
            self.assertEqual(gone.status, 204, gone.describe())
            deadline = time.monotonic() + 90
            while daemon.get("/readyz").json != {"status": "ready"} and time.monotonic() < deadline:
                time.sleep(0.5)
            self.assertEqual(daemon.get("/readyz").json, {"status": "ready"})

    def test_check_tells_what_is_damaged_or_missing(self) -> None:
        with Daemon(self.folder / "data") as daemon:
            uploads = [daemon.upload(csv(500, seed)).json["file"]["sha256"] for seed in range(3)]
            running = tool(PROGRAM, "check", "--data", str(self.folder / "data"))
            self.assertEqual(running.returncode, 0, running.stderr)
            self.assertIn("3 files of recordings", running.stdout)
        flip(self.folder / "data/blobs" / uploads[0][:2] / uploads[0])
        (self.folder / "data/columns" / uploads[1][:2] / f"{uploads[1]}.columns").unlink()
        checked = tool(PROGRAM, "check", "--data", str(self.folder / "data"))
        self.assertEqual(checked.returncode, 1)
        self.assertIn(f"The bytes of {uploads[0]} are damaged.", checked.stderr)
        self.assertIn(f"The columns of {uploads[1]} are missing.", checked.stderr)
        self.assertIn("2 faults", checked.stdout)
        self.assertEqual(tool(PROGRAM, "check", "--data", str(self.folder / "nothing")).returncode, 1)

    def test_columns_without_their_checksum_are_not_called_sound(self) -> None:
        """Whatever became of them: nobody can say that they are what was written. The daemon makes them anew."""
        with Daemon(self.folder / "data") as daemon:
            recording = daemon.upload(csv(3000)).json
            self.assertEqual(daemon.terminate(), 0)
        sha = recording["file"]["sha256"]
        columns = self.folder / "data/columns" / sha[:2] / f"{sha}.columns"
        sound = columns.read_bytes()
        flip(columns)
        columns.with_name(f"{columns.name}.sha256").unlink()
        told = f"driftlabd: The columns of {sha} cannot be verified, for they have no checksum; a daemon makes them anew from the bytes.\n"
        for words in (("check",), ("backup", "--to", str(self.folder / "copy"))):
            found = tool(PROGRAM, *words, "--data", str(self.folder / "data"))
            self.assertEqual((found.returncode, found.stderr), (1, told), words)
            self.assertIn("1 faults", found.stdout)
        with Daemon(self.folder / "data") as daemon:
            self.assertEqual(daemon.finished(daemon.characterise(recording["id"]).json["id"])["state"], "succeeded")
            self.assertEqual(daemon.terminate(), 0)
        self.assertEqual(columns.read_bytes(), sound)
        self.assertEqual(tool(PROGRAM, "check", "--data", str(self.folder / "data")).returncode, 0)


if __name__ == "__main__":
    unittest.main()
