"""Switching authentication on, tokens and the audit log on the command line, and where the daemon may listen."""
from __future__ import annotations

import json
import os
import sqlite3
import stat
import subprocess
import tempfile
import unittest
from contextlib import closing
from pathlib import Path

import samples
from daemon import PROGRAM, Daemon
from suite import DaemonTest


def command(*words: str, data: Path) -> subprocess.CompletedProcess[str]:
    clean = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}
    return subprocess.run([PROGRAM, *words, "--data", str(data)], capture_output=True, text=True, check=False, timeout=120, env=clean)


class SwitchingOn(DaemonTest):
    def test_without_a_token_everything_is_as_it_was_and_the_first_must_be_an_admin(self) -> None:
        who = self.expect(200, self.daemon.get("/v1/session")).json
        self.assertEqual(who, {"authentication": "off", "token": None, "name": None, "scope": "admin", "devices": None})
        self.expect(201, self.daemon.post("/v1/devices", {"name": "open"}))
        self.problem(409, "conflict", self.daemon.post("/v1/tokens", {"name": "a", "scope": "run"}))
        self.problem(409, "conflict", self.daemon.post("/v1/session", {"token": "x"}))
        first = self.expect(201, self.daemon.post("/v1/tokens", {"name": "a", "scope": "admin"})).json
        self.problem(401, "unauthorized", self.daemon.get("/v1/devices"))
        self.daemon.token = first["secret"]
        self.addCleanup(setattr, self.daemon, "token", None)
        self.assertEqual(self.daemon.items("/v1/devices")[0]["name"], "open")
        self.problem(409, "conflict", self.daemon.post(f"/v1/tokens/{first['id']}/revoke"))  # the last admin
        self.assertEqual(self.daemon.logged(event="request", route="/v1/devices", method="GET", status=200)["token"], first["id"])


class Commands(unittest.TestCase):
    def setUp(self) -> None:
        self.data = Path(self.enterContext(tempfile.TemporaryDirectory())) / "data"

    def made(self, *words: str) -> str:
        ran = command("token", "create", *words, data=self.data)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertRegex(ran.stdout, r"^dl_[0-9A-Za-z]{30}_[0-9A-Za-z]{6}\n$")
        return ran.stdout.strip()

    def test_a_token_whose_row_is_damaged_lets_nobody_in(self) -> None:
        """One bit made a reader of an admin, or an admin of a reader: neither is one any more."""
        admin = self.made("--name", "head", "--scope", "admin")
        reader = self.made("--name", "line", "--scope", "read")
        with closing(sqlite3.connect(self.data / "driftlab.db")) as database, database:
            [identifier] = database.execute("SELECT id FROM tokens WHERE name = 'line'").fetchone()
            database.execute("UPDATE tokens SET scope = 'admin' WHERE id = ?", (identifier,))
        listed = command("token", "list", data=self.data)
        self.assertRegex(listed.stdout, rf"(?m)^{identifier} .* damaged ")
        with Daemon(self.data, arguments=("--budget", "scrub_bytes_per_second=0")) as daemon:
            refused = daemon.get("/v1/devices", Authorization=f"Bearer {reader}")
            self.assertEqual((refused.status, refused.json["code"]), (401, "unauthorized"))
            self.assertIn(f"The row of the token {identifier} is damaged", refused.json["detail"])
            self.assertEqual(daemon.get("/v1/devices", Authorization=f"Bearer {admin}").status, 200)
            states = daemon.get("/readyz", Authorization=f"Bearer {admin}").json["states"]
            self.assertEqual([(state["state"], state["row"]) for state in states], [("row_damaged", f"tokens/{identifier}")])
            unsaid = daemon.get("/v1/tokens", Authorization=f"Bearer {admin}")
            self.assertEqual((unsaid.status, unsaid.json["where"]), (500, {"damaged_row": f"tokens/{identifier}"}))
            revoked = daemon.post(f"/v1/tokens/{identifier}/revoke", headers={"Authorization": f"Bearer {admin}"})
            self.assertEqual(revoked.status, 200, revoked.describe())
            self.assertEqual(daemon.get("/v1/tokens", Authorization=f"Bearer {admin}").status, 200)

    def test_required_tokens_begin_with_one_in_a_file_of_the_owner(self) -> None:
        with Daemon(self.data, arguments=("--require-tokens",)) as daemon:
            path = self.data / "first-admin-token"
            self.assertEqual(stat.S_IMODE(path.stat().st_mode), 0o600)
            secret = path.read_text().strip()
            self.assertEqual(daemon.get("/v1/devices").status, 401)
            self.assertEqual(daemon.get("/v1/devices", Authorization=f"Bearer {secret}").status, 200)
            self.assertNotIn(secret, json.dumps(daemon.log))
            daemon.terminate()
        path.unlink()
        with Daemon(self.data, arguments=("--require-tokens",)) as daemon:  # it is made once
            self.assertFalse(path.exists())
            self.assertEqual(daemon.get("/v1/devices", Authorization=f"Bearer {secret}").status, 200)

    def test_tokens_of_the_command_line_switch_authentication_on_for_good(self) -> None:
        refused = command("token", "create", "--name", "a", "--scope", "read", data=self.data)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("first token must have the scope admin", refused.stderr)
        admin = self.made("--name", "operator", "--scope", "admin")
        reader = self.made("--name", "screen in the hall", "--scope", "read", "--device", "phone-07", "--expires-days", "30")
        listed = command("token", "list", data=self.data).stdout
        self.assertIn("screen in the hall [phone-07]", listed)
        self.assertNotIn("dl_", listed)
        ids = [line.split()[0] for line in listed.splitlines()[1:]]
        with Daemon(self.data) as daemon:
            self.assertEqual(daemon.get("/v1/devices").status, 401)
            self.assertEqual(daemon.get("/v1/devices", Authorization=f"Bearer {reader}").status, 200)
            busy = command("token", "list", data=self.data)
            self.assertEqual(busy.returncode, 2)
            self.assertIn("Another driftlab daemon", busy.stderr)
            daemon.terminate()
        self.assertIn(" 20", command("token", "list", data=self.data).stdout.splitlines()[2].split("live")[1][26:52])  # last used
        self.assertEqual(command("token", "rotate", ids[1], data=self.data).returncode, 0)
        for id_ in ids:
            self.assertEqual(command("token", "revoke", id_, data=self.data).returncode, 0)
        self.assertEqual(command("token", "revoke", "nobody", data=self.data).returncode, 2)
        with Daemon(self.data) as daemon:  # nobody is admitted; it does not open up again
            for secret in (admin, reader):
                self.assertEqual(daemon.get("/v1/devices", Authorization=f"Bearer {secret}").status, 401)
            self.assertEqual(daemon.get("/v1/devices").status, 401)
            daemon.terminate()
        verified = command("audit", "verify", data=self.data)
        self.assertEqual(verified.returncode, 0, verified.stderr)

    def test_a_typing_error_makes_no_directory(self) -> None:
        for words in (("token", "list"), ("audit", "verify"), ("token", "revoke", "x")):
            ran = command(*words, data=self.data)
            self.assertEqual(ran.returncode, 2, words)
            self.assertIn("There is no database", ran.stderr)
            self.assertFalse(self.data.exists())


class Audit(unittest.TestCase):
    def test_every_change_is_a_row_that_names_who_and_a_broken_chain_is_found(self) -> None:
        data = Path(self.enterContext(tempfile.TemporaryDirectory())) / "data"
        with Daemon(data, arguments=("--require-tokens",)) as daemon:
            daemon.token = (data / "first-admin-token").read_text().strip()
            writer = daemon.post("/v1/tokens", {"name": "w", "scope": "run"}).json
            as_writer = {"Authorization": f"Bearer {writer['secret']}"}
            device = daemon.post("/v1/devices", {"name": "a"}, {**as_writer, "X-Request-Id": "the-request"}).json["id"]
            daemon.post("/v1/devices", {"name": "a"}, as_writer)  # changes nothing: no row
            daemon.request("PATCH", f"/v1/devices/{device}", {"serial": "1"}, {"If-Match": "*", **as_writer})
            recording = daemon.upload(samples.gyro_csv(), as_writer, device="b", rate_hz=100, columns=samples.GYRO_Z).json["id"]
            job = daemon.characterise(recording, headers=as_writer).json["id"]
            daemon.finished(job)
            daemon.post(f"/v1/tokens/{writer['id']}/revoke")
            rows = daemon.items("/v1/audit?limit=3")
            self.assertEqual([(row["action"], row["actor"] == writer["id"]) for row in rows][2:], [
                ("device.create", True), ("device.change", True), ("device.create", True), ("recording.add", True), ("job.create", True),
                ("token.revoke", False)])
            self.assertEqual([row["sequence"] for row in rows], list(range(1, len(rows) + 1)))
            self.assertEqual((rows[2]["object"], rows[2]["request_id"], rows[2]["address"]), (device, "the-request", "127.0.0.1"))
            self.assertEqual(rows[5]["object"], recording)
            verdict = daemon.get("/v1/audit-verification").json
            self.assertEqual(verdict, {"rows": len(rows), "head": rows[-1]["digest"], "sound": True, "fault": None})
            self.assertEqual(daemon.logged(event="audit", sequence=3)["digest"], rows[2]["digest"])
            self.assertEqual([r["sequence"] for r in daemon.items("/v1/audit?sort=-created_at&limit=2")][:3], [len(rows), len(rows) - 1, len(rows) - 2])
            self.assertEqual(daemon.get("/v1/audit?cursor=x").status, 400)
            daemon.terminate()
        head = rows[-1]["digest"]
        self.assertEqual(command("audit", "verify", "--head", head, data=data).returncode, 0)
        exported = data.parent / "audit.jsonl"
        exported.write_text(command("audit", "export", data=data).stdout)
        self.assertEqual(command("audit", "verify", "--file", str(exported), "--head", head, data=data).returncode, 0)

        lines = exported.read_text().splitlines()
        for name, broken in (("altered", [lines[0], lines[1].replace("token.create", "token.revoke"), *lines[2:]]),
                             ("removed", [lines[0], *lines[2:]]), ("swapped", [lines[1], lines[0], *lines[2:]]),
                             ("not a row", [*lines, "{"]), ("cut", lines[:-1])):
            with self.subTest(name=name):
                exported.write_text("\n".join(broken) + "\n")
                ran = command("audit", "verify", "--file", str(exported), "--head", head, data=data)
                self.assertEqual(ran.returncode, 3, ran.stdout)
                self.assertTrue(ran.stderr.startswith("driftlabd: "), ran.stderr)

        with sqlite3.connect(data / "driftlab.db") as database:
            for statement in ("UPDATE audit SET actor = 'nobody' WHERE sequence = 2", "DELETE FROM audit WHERE sequence = 2"):
                with self.assertRaises(sqlite3.DatabaseError):
                    database.execute(statement)
            database.execute("DROP TRIGGER audit_is_not_changed")
            database.execute("UPDATE audit SET actor = 'nobody' WHERE sequence = 2")
        ran = command("audit", "verify", data=data)
        self.assertEqual(ran.returncode, 3)
        self.assertIn("Row 2 was altered", ran.stderr)


if __name__ == "__main__":
    unittest.main()
