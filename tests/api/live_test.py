"""Recordings made live: pieces in any order, gaps, growth followed, a token for this recording alone, a daemon that dies."""
from __future__ import annotations

import http.client
import json
import math
import random
import struct
import tempfile
import time
import unittest
from pathlib import Path
from typing import Any

from daemon import PATIENCE_S, Answer, Daemon
from suite import DaemonTest

COLUMNS = {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}, "az": {"quantity": "specific_force", "axis": "z", "unit": "m/s^2"}}
ABOUT = {"device": "phone-07", "condition": {"kind": "static"}, "columns": COLUMNS, "id": "live-1"}
RATE = 100


def rows(first: int, count: int, seed: int = 1) -> bytes:
    generator = random.Random(seed * 1000 + first)
    return b"".join(struct.pack("<dff", 10 + i / RATE, generator.gauss(0.1, 0.05), 9.81 + generator.gauss(0, 0.01)) for i in range(first, first + count))


class Live(DaemonTest):
    def begin(self, about: dict[str, Any] = ABOUT) -> tuple[str, dict[str, str]]:
        made = self.expect(201, self.daemon.post("/v1/live-recordings", about))
        self.assertTrue(made.json["href"].startswith(f"/record?live={made.json['id']}#"))
        return made.headers["location"], {"Live-Token": made.json["token"], "Content-Type": "application/octet-stream"}

    def test_pieces_grow_into_a_recording_that_is_characterised(self) -> None:
        """Pieces come late, twice and not at all: each instant stands once, in order, and the missing second is a gap."""
        live, token = self.begin()
        for number in (0, 2, 1, 2, *(n for n in range(3, 60) if n != 30)):
            self.expect(204, self.daemon.request("POST", f"{live}/samples?sequence={number}", rows(number * RATE, RATE), token))
        state = self.expect(200, self.daemon.get(live)).json
        self.assertEqual((state["samples"], state["pieces"], state["columns"]), (59 * RATE, 59, ["gz", "az"]))
        made = self.expect(201, self.daemon.request("POST", f"{live}/finish", headers={"Live-Token": token["Live-Token"]})).json
        recording = made["recording"]
        self.assertEqual(recording["quality"]["samples"], 59 * RATE)
        self.assertEqual(recording["quality"]["gaps"], 1)
        self.assertAlmostEqual(recording["quality"]["measured_rate_hz"], RATE, delta=2)
        self.assertEqual(self.daemon.finished(made["job"]["id"])["state"], "succeeded")
        found = self.daemon.get(f"/v1/recordings/{recording['id']}/characterisation?channel=gz").json
        # 0.05 deg/s a sample at 100 Hz is 0.05/10 deg/s/sqrt(Hz), times 60 in deg/sqrt(h)
        n = found["channels"][0]["result"]["fits"][0]["processes"][0]["params"]["N"]
        self.assertAlmostEqual(n["value"], 0.3, delta=0.03)
        self.problem(404, "not_found", self.daemon.get(live))

    def test_growth_is_followed_with_intervals(self) -> None:
        live, token = self.begin()
        for number in range(20):
            self.expect(204, self.daemon.request("POST", f"{live}/samples?sequence={number}", rows(number * RATE, RATE, 2), token))
        connection = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=PATIENCE_S)
        connection.request("GET", f"{live}/events?channel=gz")
        kinds = []
        growth: dict[str, Any] = {}
        for raw in connection.getresponse():
            name, _, value = raw.decode().rstrip("\n").partition(": ")
            if name == "event":
                kinds.append(value)
            if name == "data" and kinds[-1] == "growth":
                growth = growth or json.loads(value)
                self.daemon.request("POST", f"{live}/finish", headers={"Live-Token": token["Live-Token"]})
            if kinds and kinds[-1] == "finished":
                break
        connection.close()
        self.assertEqual((growth["samples"], growth["gaps"], growth["still"], growth["unit"]), (2000, 0, True, "deg/s"))
        self.assertAlmostEqual(growth["rate_hz"], RATE, delta=0.01)
        low, high = growth["N"]["ci95"]
        self.assertEqual(growth["N"]["unit"], "deg/sqrt(h)")
        self.assertTrue(low < 0.3 < high or math.isclose(growth["N"]["value"], 0.3, rel_tol=0.2))
        self.assertEqual([round(tau, 9) for tau in growth["allan"]["tau_s"][:3]], [0.01, 0.02, 0.04])
        self.assertGreater(growth["next"]["in_s"], 0)

    def test_only_whoever_has_the_token_adds_and_finishes(self) -> None:
        live, token = self.begin()
        other, foreign = self.begin({**ABOUT, "id": "live-2"})
        for headers in ({"Content-Type": "application/octet-stream"}, foreign, {**token, "Live-Token": "lt_wrong"}):
            self.problem(404, "not_found", self.daemon.request("POST", f"{live}/samples?sequence=0", rows(0, 10), headers), parameter="Live-Token")
        self.problem(404, "not_found", self.daemon.request("POST", f"{live}/finish", headers={"Live-Token": foreign["Live-Token"]}), parameter="Live-Token")
        self.assertNotIn("token", self.daemon.get(other).json)

    def test_what_is_no_sample_is_refused_and_nothing_of_it_kept(self) -> None:
        live, token = self.begin()
        back = rows(0, 2)[16:] + rows(0, 2)[:16]
        for piece in (b"", b"x" * 15, back, struct.pack("<dff", math.nan, 0, 0)):
            self.problem(400, "invalid_argument", self.daemon.request("POST", f"{live}/samples?sequence=0", piece, token))
        self.problem(400, "invalid_argument", self.daemon.request("POST", f"{live}/samples", rows(0, 2), token), parameter="sequence")
        self.problem(413, "limit_exceeded", self.daemon.request("POST", f"{live}/samples?sequence=0", rows(0, 70000), token))
        self.assertEqual(self.daemon.get(live).json["samples"], 0)
        self.problem(422, "no_samples", self.daemon.request("POST", f"{live}/finish", headers={"Live-Token": token["Live-Token"]}))
        self.problem(422, "unknown_column", self.daemon.get(f"{live}/events?channel=gx"), parameter="channel")
        for about in ({**ABOUT, "columns": {}}, {**ABOUT, "columns": {"gz": {"quantity": "angular_rate", "axis": "z"}}}, {**ABOUT, "columns": {"time": COLUMNS["gz"]}}):
            self.problem(400, "invalid_argument", self.daemon.post("/v1/live-recordings", about))


class Tokens(unittest.TestCase):
    """A live recording is that of the token that began it: what that one may have, may do, and until when."""

    def begin_daemon(self, *budgets: str) -> Daemon:
        words = [word for budget in budgets for word in ("--budget", budget)]
        daemon = self.enterContext(Daemon(arguments=("--require-tokens", "--workers", "1", *words)))
        daemon.token = (daemon.data / "first-admin-token").read_text().strip()
        return daemon

    def token(self, daemon: Daemon, scope: str) -> dict[str, Any]:
        return dict(daemon.post("/v1/tokens", {"name": scope, "scope": scope}).json)

    def begin(self, daemon: Daemon, secret: str, id_: str = "live-1", **more: Any) -> Answer:
        return daemon.request("POST", "/v1/live-recordings", {**ABOUT, "id": id_, **more}, {"Authorization": f"Bearer {secret}"})

    def add(self, daemon: Daemon, live: Answer, number: int = 0, seed: int = 1) -> Answer:
        headers = {"Live-Token": live.json["token"], "Content-Type": "application/octet-stream", "Cookie": "unrelated=1"}
        return daemon.request("POST", f"{live.headers['location']}/samples?sequence={number}", rows(number * RATE, RATE, seed), headers)

    def finish(self, daemon: Daemon, live: Answer) -> Answer:
        return daemon.request("POST", f"{live.headers['location']}/finish", headers={"Live-Token": live.json["token"], "Cookie": "unrelated=1"})

    def test_so_many_may_be_open(self) -> None:
        daemon = self.begin_daemon("live_recordings=3", "live_recordings_per_token=2")
        one, other = (self.token(daemon, "write")["secret"] for _ in range(2))
        first = self.begin(daemon, one)
        self.assertEqual((first.status, self.begin(daemon, one).status), (201, 201))
        of_token = self.begin(daemon, one)
        self.assertEqual((of_token.status, of_token.headers["retry-after"]), (429, "1"), of_token.describe())
        self.assertIn("(budget live_recordings_per_token = 2)", of_token.json["detail"])
        self.assertEqual(self.begin(daemon, other).status, 201)
        of_all = self.begin(daemon, other)
        self.assertEqual(of_all.status, 503, of_all.describe())
        self.assertIn("(budget live_recordings = 3)", of_all.json["detail"])
        self.assertEqual((self.add(daemon, first).status, self.finish(daemon, first).status), (204, 201))
        self.assertEqual(self.begin(daemon, one).status, 201, "one that is finished makes room")

    def test_its_recordings_are_those_of_the_token(self) -> None:
        daemon = self.begin_daemon("recordings_per_token=1")
        token = self.token(daemon, "write")
        first, second = self.begin(daemon, token["secret"]), self.begin(daemon, token["secret"], "live-2")
        for number, live in enumerate((first, second)):
            self.assertEqual(self.add(daemon, live, seed=number + 1).status, 204)
        made = self.finish(daemon, first)
        self.assertEqual(made.status, 201, made.describe())
        self.assertIsNone(made.json["job"], "a job takes the scope run")
        self.assertEqual(daemon.items("/v1/jobs"), [])
        [row] = [row for row in daemon.items("/v1/audit?limit=500") if row["object"] == made.json["recording"]["id"]]
        self.assertEqual(row["actor"], token["id"])
        full = self.finish(daemon, second)
        self.assertEqual(full.status, 507, full.describe())
        self.assertIn("(budget recordings_per_token = 1)", full.json["detail"])

    def test_a_full_queue_takes_no_more(self) -> None:
        daemon = self.begin_daemon("queued_jobs=1")
        live = self.begin(daemon, self.token(daemon, "run")["secret"])
        self.assertEqual(self.add(daemon, live).status, 204)
        jobs = [daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000, "seed": 1}).json["id"]]
        until = time.monotonic() + PATIENCE_S
        while daemon.get(f"/v1/jobs/{jobs[0]}").json["state"] == "queued" and time.monotonic() < until:
            time.sleep(0.05)
        jobs.append(daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000, "seed": 2}).json["id"])
        made = self.finish(daemon, live)
        self.assertEqual((made.status, made.json["job"]), (201, None), made.describe())
        for job in jobs:
            daemon.post(f"/v1/jobs/{job}/cancel")

    def test_it_ends_with_the_token(self) -> None:
        daemon = self.begin_daemon()
        token = self.token(daemon, "run")
        live = self.begin(daemon, token["secret"])
        self.assertEqual(self.add(daemon, live).status, 204)
        self.assertEqual(daemon.post(f"/v1/tokens/{token['id']}/revoke").status, 200)
        for answer in (self.add(daemon, live, 1), self.finish(daemon, live)):
            self.assertEqual((answer.status, answer.json["code"]), (401, "unauthorized"), answer.describe())
            self.assertIn("was revoked", answer.json["detail"])
        self.assertEqual(daemon.get(live.headers["location"]).json["samples"], RATE)
        self.assertEqual(daemon.items("/v1/recordings"), [])

    def test_its_metadata_have_the_budgets_of_any_other(self) -> None:
        daemon = self.begin_daemon("labels=1")
        secret = self.token(daemon, "write")["secret"]
        many = self.begin(daemon, secret, labels={"a": "1", "b": "2"})
        self.assertEqual(many.status, 413, many.describe())
        self.assertIn("(budget labels = 1)", many.text)
        self.assertEqual(self.begin(daemon, secret, labels={"a": "1"}).status, 201)


class Restart(unittest.TestCase):
    def test_a_recording_goes_on_after_the_daemon_was_killed(self) -> None:
        folder = self.enterContext(tempfile.TemporaryDirectory())  # removed last, when no daemon writes into it
        daemon = self.enterContext(Daemon(Path(folder)))
        made = daemon.post("/v1/live-recordings", ABOUT)
        live, token = made.headers["location"], {"Live-Token": made.json["token"], "Content-Type": "application/octet-stream"}
        for number in range(5):
            assert daemon.request("POST", f"{live}/samples?sequence={number}", rows(number * RATE, RATE), token).status == 204
        daemon.kill()
        daemon = self.enterContext(Daemon(Path(folder)))
        self.assertEqual(daemon.get(live).json["samples"], 5 * RATE)
        daemon.request("POST", f"{live}/samples?sequence=4", rows(4 * RATE, RATE), token)  # the answer may have been lost
        daemon.request("POST", f"{live}/samples?sequence=5", rows(5 * RATE, RATE), token)
        finished = daemon.request("POST", f"{live}/finish", headers={"Live-Token": token["Live-Token"]})
        self.assertEqual(finished.status, 201, finished.describe())
        self.assertEqual(finished.json["recording"]["quality"]["samples"], 6 * RATE)


if __name__ == "__main__":
    unittest.main()
