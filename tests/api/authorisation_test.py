"""Who may do what: the matrix of the contract, and what a token that is limited to one device can learn of another.

The matrix is made from the contract as the daemon serves it: every operation, asked by nobody, by a token of each
scope, and by tokens that ended. What must come of it is the operation's `x-scope`, and nothing else.
"""
from __future__ import annotations

import contextlib
import hashlib
import json
import re
import select
import socket
import time
import unittest
from typing import Any

import samples
from contract import Contract
from daemon import PATIENCE_S, Answer, multipart, read_all, read_answer
from suite import DaemonTest

SCOPES = ["read", "write", "run", "admin"]


class GuardedDaemon(DaemonTest):
    """A daemon that asks for tokens, and one token of each scope."""

    arguments = ("--require-tokens",)
    secrets: dict[str, str]

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.daemon.token = (cls.daemon.data / "first-admin-token").read_text().strip()
        cls.secrets = {scope: cls.token(scope) for scope in SCOPES}

    @classmethod
    def token(cls, scope: str, **more: Any) -> str:
        answer = cls.daemon.post("/v1/tokens", {"name": f"{scope} of the tests", "scope": scope, **more})
        assert answer.status == 201, answer.describe()
        return str(answer.json["secret"])

    def ask(self, secret: str | None, method: str, target: str, body: Any = None, headers: dict[str, str] | None = None) -> Answer:
        bearer = {"Authorization": f"Bearer {secret}"} if secret else {"Cookie": "unrelated=1"}
        return self.daemon.request(method, target, body, {**bearer, **(headers or {})})


def requests_of(contract: Contract) -> list[tuple[str, str, str, Any, dict[str, str]]]:
    """(operation, scope, method, target, ...) of every operation, on objects that do not exist and with bodies that ask for nothing."""
    asked = []
    for path, operations in contract.paths.items():
        for method, operation in operations.items():
            content = operation.get("requestBody", {}).get("content", {})
            body: Any = {} if "application/json" in content else b"not a recording" if content else None
            headers = {} if not content or isinstance(body, dict) else {"Content-Type": "application/octet-stream"}
            target = re.sub(r"\{[^}]*\}", "absent", path)
            verb = "HEAD" if path == "/v1/events" else method.upper()  # the stream itself does not end
            asked.append((operation["operationId"], operation["x-scope"], verb, target, (body, headers)))
    return asked  # type: ignore[return-value]


class Matrix(GuardedDaemon):
    def test_every_operation_admits_its_scope_and_those_above_and_nobody_else(self) -> None:
        expired = self.token("admin", expires_in_s=1)
        revoked = self.daemon.post("/v1/tokens", {"name": "revoked", "scope": "admin"}).json
        self.expect(200, self.daemon.post(f"/v1/tokens/{revoked['id']}/revoke"))
        altered = self.secrets["admin"][:-1] + ("0" if self.secrets["admin"][-1] != "0" else "1")
        time.sleep(1.1)
        nobody = {"nobody": None, "expired": expired, "revoked": revoked["secret"], "mistyped": altered,
                  "unknown": "dl_" + "0" * 30 + "_000000"}
        cases = requests_of(self.contract)
        self.assertGreater(len(cases), 45)
        for operation, needed, method, target, (body, headers) in cases:  # type: ignore[misc]
            for name, secret in nobody.items():
                with self.subTest(operation=operation, token=name):
                    answer = self.ask(secret, method, target, body, headers)  # type: ignore[has-type]
                    if needed == "public":
                        self.assertNotIn(answer.status, (403,), answer.describe())
                        self.assertTrue(answer.status != 401 or operation == "openSession", answer.describe())
                    elif method == "HEAD":
                        self.expect(401, answer)
                    else:
                        self.problem(401, "unauthorized", answer)
                        self.assertTrue(answer.headers["www-authenticate"].startswith('Bearer realm="driftlab"'))
            for scope in SCOPES:
                with self.subTest(operation=operation, scope=scope):
                    answer = self.ask(self.secrets[scope], method, target, body, headers)  # type: ignore[has-type]
                    if needed != "public" and SCOPES.index(scope) < SCOPES.index(needed):
                        self.problem(403, "forbidden", answer)
                        self.assertIn(f'scope="{needed}"', answer.headers["www-authenticate"])
                    else:
                        self.assertNotIn(answer.status, (401, 403), answer.describe())

    def test_the_body_of_a_stranger_is_not_awaited(self) -> None:
        for target in ("/v1/recordings?device=a&condition=static", "/v1/jobs"):
            raw = self.daemon.exchange(f"POST {target} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                                       "Content-Length: 1000000\r\nExpect: 100-continue\r\n\r\n".encode())
            self.assertTrue(raw.startswith(b"HTTP/1.1 401 "), raw[:200])
            self.assertNotIn(b"100 Continue", raw)

    def test_head_and_unknown_paths_tell_strangers_nothing(self) -> None:
        self.assertEqual(self.ask(None, "HEAD", "/v1/devices").status, 401)
        self.assertEqual(self.ask(None, "GET", "/v1/nothing").status, 404)
        self.assertEqual(self.ask(None, "GET", "/v1/devices?unknown=1").status, 401)

    def test_the_ways_to_write_a_token(self) -> None:
        secret = self.secrets["read"]
        for written, status in ((f"Bearer {secret}", 200), (f"bearer {secret} ", 200), (f"BEARER  {secret}", 200), (secret, 401),
                                (f"Basic {secret}", 401), ("Bearer", 401), ("Bearer ", 401), (f"Bearer {secret}x", 401)):
            answer = self.daemon.request("GET", "/v1/devices", headers={"Authorization": written})
            self.assertEqual(answer.status, status, written)

    def test_a_key_is_that_of_a_token(self) -> None:
        """A reply kept for one token is not given to another that guesses its Idempotency-Key."""
        key = {"Idempotency-Key": "the-same-key"}
        first = self.ask(self.secrets["write"], "POST", "/v1/devices", {"name": "keyed"}, key)
        self.expect(201, first)
        self.assertIn("idempotency-replayed", self.ask(self.secrets["write"], "POST", "/v1/devices", {"name": "keyed"}, key).headers)
        other = self.ask(self.secrets["run"], "POST", "/v1/devices", {"name": "keyed-too"}, key)
        self.expect(201, other)
        self.assertNotIn("idempotency-replayed", other.headers)

    def test_tokens_are_made_with_bounds(self) -> None:
        for body, pointer in (({"name": "", "scope": "read"}, "/name"), ({"name": "n" * 101, "scope": "read"}, "/name"),
                              ({"name": "a", "scope": "root"}, "/scope"), ({"name": "a", "scope": "public"}, "/scope"),
                              ({"name": "a", "scope": "admin", "devices": ["b"]}, "/devices"), ({"name": "a", "scope": "read", "devices": []}, "/devices"),
                              ({"name": "a", "scope": "read", "devices": "b"}, "/devices"), ({"name": "a", "scope": "read", "expires_in_s": 0}, "/expires_in_s")):
            document = self.problem(400, "invalid_argument", self.daemon.post("/v1/tokens", body))
            self.assertIn(pointer, [error["pointer"] for error in document["errors"]], body)  # type: ignore[index,union-attr]
        answer = self.daemon.post("/v1/tokens", {"name": "a", "scope": "read"}, {"Idempotency-Key": "k"})
        self.problem(400, "invalid_argument", answer, parameter="Idempotency-Key")

    def test_rotation_ends_the_old_secret_and_use_is_noted(self) -> None:
        made = self.daemon.post("/v1/tokens", {"name": "rotated", "scope": "read"})
        self.assertEqual(made.headers["cache-control"], "no-store")
        self.expect(200, self.ask(made.json["secret"], "GET", "/v1/devices"))
        fresh = self.expect(200, self.daemon.post(f"/v1/tokens/{made.json['id']}/rotate")).json
        self.expect(401, self.ask(made.json["secret"], "GET", "/v1/devices"))
        self.expect(200, self.ask(fresh["secret"], "GET", "/v1/devices"))
        listed = next(token for token in self.daemon.items("/v1/tokens") if token["id"] == fresh["id"])
        self.assertNotIn("secret", listed)
        self.assertIsNotNone(listed["rotated_at"])
        self.assertEqual([t["id"] for t in self.daemon.items("/v1/tokens?limit=2")], [t["id"] for t in self.daemon.items("/v1/tokens")])
        newest = self.daemon.items("/v1/tokens?limit=1&sort=-created_at")
        self.assertEqual([t["id"] for t in newest], [t["id"] for t in self.daemon.items("/v1/tokens")][::-1])

    def test_secrets_are_nowhere_on_the_disk_or_in_the_log(self) -> None:
        secret = self.token("read")
        self.expect(200, self.ask(secret, "GET", "/v1/devices"))
        stored = self.daemon.database_bytes()
        self.assertIn(hashlib.sha256(secret.encode()).hexdigest().encode(), stored)
        self.assertNotIn(secret.encode(), stored)
        self.assertNotIn(secret, json.dumps(self.daemon.log))


class Sessions(GuardedDaemon):
    def sign_in(self) -> str:
        answer = self.ask(None, "POST", "/v1/session", {"token": self.secrets["write"]})
        self.expect(201, answer)
        cookie = answer.headers["set-cookie"]
        for part in ("HttpOnly", "SameSite=Strict", "Path=/", "Max-Age=43200"):
            self.assertIn(part, cookie.split("; "))
        self.assertNotIn("Secure", cookie)  # without TLS a browser would not send it back
        self.assertEqual(answer.headers["cache-control"], "no-store")
        return cookie.partition(";")[0]

    def test_a_cookie_reads_and_changes_only_for_its_own_pages(self) -> None:
        cookie = {"Cookie": "theme=dark; " + self.sign_in()}
        who = self.expect(200, self.daemon.request("GET", "/v1/session", headers=cookie)).json
        self.assertEqual((who["authentication"], who["scope"]), ("session", "write"))
        own = f"http://127.0.0.1:{self.daemon.port}"
        for number, (said, status) in enumerate((({"Origin": own}, 201), ({"Sec-Fetch-Site": "same-origin"}, 201), ({}, 403),
                                                 ({"Origin": "http://127.0.0.1"}, 403), ({"Origin": "http://evil.example"}, 403),
                                                 ({"Sec-Fetch-Site": "cross-site"}, 403), ({"Sec-Fetch-Site": "same-site", "Origin": own}, 403))):
            answer = self.daemon.request("POST", "/v1/devices", {"name": f"device-{number}"}, {**cookie, **said})
            self.assertEqual(answer.status, status, f"{said}: {answer.describe()}")

    def test_it_ends_by_signing_out_and_with_its_token(self) -> None:
        cookie = {"Cookie": self.sign_in()}
        self.expect(204, self.daemon.request("DELETE", "/v1/session", headers={**cookie, "Sec-Fetch-Site": "same-origin"}))
        self.problem(401, "unauthorized", self.daemon.request("GET", "/v1/devices", headers=cookie))
        made = self.daemon.post("/v1/tokens", {"name": "short", "scope": "read"}).json
        answer = self.ask(None, "POST", "/v1/session", {"token": made["secret"]})
        cookie = {"Cookie": answer.headers["set-cookie"].partition(";")[0]}
        self.expect(200, self.daemon.request("GET", "/v1/devices", headers=cookie))
        self.expect(200, self.daemon.post(f"/v1/tokens/{made['id']}/revoke"))
        self.expect(401, self.daemon.request("GET", "/v1/devices", headers=cookie))
        self.problem(401, "unauthorized", self.ask(None, "POST", "/v1/session", {"token": made["secret"]}))

    def test_pages_are_there_to_sign_in_with(self) -> None:
        page = self.daemon.exchange(b"GET /devices HTTP/1.1\r\nHost: localhost\r\nAccept: text/html\r\nConnection: close\r\n\r\n")
        # 404: a daemon that was built without pages
        self.assertTrue(page.startswith((b"HTTP/1.1 200 ", b"HTTP/1.1 404 ")), page[:200])

    def test_an_event_stream_ends_with_its_session(self) -> None:
        cookie = self.sign_in()
        with self.daemon.connect() as connection:
            connection.sendall(f"GET /v1/events HTTP/1.1\r\nHost: localhost\r\nCookie: {cookie}\r\n\r\n".encode())
            self.assertTrue(connection.recv(65536).startswith(b"HTTP/1.1 200 "))
            self.expect(204, self.daemon.request("DELETE", "/v1/session", headers={"Cookie": cookie, "Sec-Fetch-Site": "same-origin"}))
            connection.settimeout(10)
            read_all(connection)

    def test_an_upload_ends_with_its_token(self) -> None:
        """While its bytes come, when they all came, and while it waits for a place: nothing of it is kept."""
        content = samples.stamped_csv(200_000)
        head = f"POST /v1/recordings?device=phone-late&condition=static HTTP/1.1\r\nHost: localhost\r\nContent-Length: {len(content)}\r\n"

        def begin(connection: socket.socket) -> str:
            made = self.daemon.post("/v1/tokens", {"name": "uploader", "scope": "write"}).json
            connection.sendall((head + f"Content-Type: text/csv\r\nAuthorization: Bearer {made['secret']}\r\n\r\n").encode())
            return f"/v1/tokens/{made['id']}/revoke"
        before = self.daemon.files("blobs")
        with self.subTest("its last bytes come after the end"), self.daemon.connect() as connection:
            revoke = begin(connection)
            connection.sendall(content[:-100])
            self.expect(200, self.daemon.post(revoke))
            connection.sendall(content[-100:])
            self.problem(401, "unauthorized", read_answer(connection))
        with self.subTest("it is refused before its end"), self.daemon.connect() as connection:
            revoke = begin(connection)
            connection.sendall(content[:100_000])
            self.expect(200, self.daemon.post(revoke))
            sent, until = 100_000, time.monotonic() + PATIENCE_S
            while not select.select([connection], [], [], 0.2)[0] and sent < len(content) - 70_000 and time.monotonic() < until:
                connection.sendall(content[sent:sent + 70_000])
                sent += 70_000
            self.problem(401, "unauthorized", read_answer(connection))
            self.assertLess(sent, len(content) - 70_000)
        with self.subTest("it waits for a place"), contextlib.ExitStack() as stack:
            for _ in range(16):  # budget uploads
                begin(stack.enter_context(self.daemon.connect()))
            waiting = stack.enter_context(self.daemon.connect())
            revoke = begin(waiting)
            time.sleep(0.3)
            self.expect(200, self.daemon.post(revoke))
            start = time.monotonic()
            self.problem(401, "unauthorized", read_answer(waiting))
            self.assertLess(time.monotonic() - start, 10.0)
        self.assertEqual(self.daemon.files("blobs"), before)
        self.assertNotIn("phone-late", [device["name"] for device in self.daemon.items("/v1/devices")])

    def test_an_event_stream_ends_with_its_token(self) -> None:
        made = self.daemon.post("/v1/tokens", {"name": "listener", "scope": "read"}).json
        job = self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000}).json["id"]
        with self.daemon.connect() as connection:
            connection.sendall(f"GET /v1/jobs/{job}/events HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {made['secret']}\r\n\r\n".encode())
            self.assertTrue(connection.recv(65536).startswith(b"HTTP/1.1 200 "))
            self.daemon.post(f"/v1/tokens/{made['id']}/revoke")
            start = time.monotonic()
            read_all(connection)
            self.assertLess(time.monotonic() - start, 10.0)
        self.assertNotIn(self.daemon.get(f"/v1/jobs/{job}").json["state"], ("succeeded",))
        self.daemon.post(f"/v1/jobs/{job}/cancel")


class OtherDevices(GuardedDaemon):
    """Two devices with everything a device can have, and a token that is limited to one of them."""

    theirs: dict[str, str]
    mine: dict[str, str]
    limited: str

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.theirs, cls.mine = cls.furnish("phone-theirs", 1), cls.furnish("phone-mine", 11)
        cls.limited = cls.token("run", devices=["phone-mine"])

    @classmethod
    def furnish(cls, name: str, seed: int) -> dict[str, str]:
        daemon = cls.daemon

        def made(answer: Answer) -> str:
            assert answer.status in (200, 201, 202), answer.describe()
            return str(answer.json["id"])

        device = made(daemon.post("/v1/devices", {"name": name, "model": "one-line", "serial": f"serial of {name}"}))
        first, second = (made(daemon.upload(samples.gyro_csv(seed=seed + i), device=name, rate_hz=100, columns=samples.GYRO_Z)) for i in range(2))
        job = made(daemon.characterise(first))
        daemon.finished(job)
        daemon.finished(made(daemon.characterise(second)))
        study = made(daemon.post("/v1/studies", {"device": {"id": name}, "recordings": [{"recording": first}]}))
        apply = {"reading_unit": "rad/s", "bias": [0.01 * seed, 0, 0], "correction": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}
        calibration = made(daemon.post("/v1/calibrations", {"device": {"id": name}, "calibration": {"gyroscope": {"apply": apply}}}))
        asked = made(daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study}}))
        daemon.finished(asked)
        investigation = daemon.items(f"/v1/investigations?device={name}")[0]["id"]
        arms = {arm: {"recordings": [{"recording": id_}]} for arm, id_ in (("baseline", first), ("candidate", second))}
        regression = made(daemon.post("/v1/jobs", {"kind": "regress", "inputs": {"device": name, **arms}}))
        daemon.finished(regression)
        white = {"name": f"white of {name}", "processes": [{"process": "white_noise", "params": {"N": {"value": seed, "unit": "deg/sqrt(h)"}}}]}
        own = made(daemon.post("/v1/models", {**white, "device": name}))
        loose = made(daemon.post("/v1/models", {**white, "name": f"loose of {name}"}))
        evaluation = made(daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 2, "seed": seed}))
        daemon.finished(evaluation)
        files = zip(samples.drive_csvs(seed=seed), (samples.DRIVE_IMU, samples.DRIVE_GNSS))
        drive = made(daemon.post("/v1/drives", samples.drive_document(*(
            made(daemon.upload(content, device=name, condition="drive", columns=samples.roles(roles))) for content, roles in files))))
        driven = made(daemon.post("/v1/drive-evaluations", {"drive": drive}))
        daemon.finished(driven)
        return {"device": device, "name": name, "drive": drive, "driven": driven, "recording": first, "second": second, "job": job, "study": study, "calibration": calibration,
                "investigation": investigation, "asked": asked, "regression": regression, "model": own, "loose": loose, "evaluation": evaluation,
                "fit": next(fit["id"] for fit in daemon.items(f"/v1/fits?device={name}") if fit["model"] == "WN" and fit["processes"][0]["params"]["N"])}

    def gets(self, of: dict[str, str]) -> list[str]:
        """Every address of the contract that reads something of a device, or a list."""
        ids = {"devices": of["device"], "recordings": of["recording"], "jobs": of["job"], "fits": of["fit"], "studies": of["study"],
               "calibrations": of["calibration"], "investigations": of["investigation"], "models": of["model"],
               "outage-evaluations": of["evaluation"], "drives": of["drive"], "drive-evaluations": of["driven"], "regressions": of["regression"], "exports": "kalibr"}
        targets = []
        for path, operations in self.contract.paths.items():
            group = path.split("/")[2] if path.startswith("/v1/") else ""
            if "get" not in operations or operations["get"]["x-scope"] != "read" or group in ("samples", "session", "events"):
                continue
            if group in ("uploads", "live-recordings"):  # pieces under way, of nobody's results; a secret id names them
                continue
            if "{" in path:
                self.assertIn(group, ids, f"the test does not know what a device has at {path}")
            target = re.sub(r"\{[^}]*\}", ids.get(group, ""), path)
            bound = map(self.contract.resolved, operations["get"].get("parameters", []))
            needed = {p["name"] for p in bound if p["in"] == "query"}
            if group in ("parameter-tables", "trends"):
                target += f"?device={of['name']}&axis=z"
            elif group == "exports" and "{" in path:
                target += f"?device={of['name']}"
            elif group == "structures":
                target += f"?of={of['recording']}:gz,{of['recording']}"
            elif group == "populations":
                target += "?model=one-line"
            elif group == "search":
                target += f"?q={of['name']}"
            elif {"recording", "channel"} <= needed:
                target += f"?recording={of['recording']}&channel=gz"
            elif "channel" in needed:
                target += "?channel=gz"
            targets.append(target)
            if "device" in needed and "?" not in target:
                targets += [f"{target}?device={of['name']}", f"{target}?device={of['device']}"]
            if "recording" in needed and "?" not in target:
                targets.append(f"{target}?recording={of['recording']}")
            if "job" in needed:
                targets.append(f"{target}?job={of['job']}")
        return targets + [f"/v1/jobs/{of[job]}" for job in ("asked", "regression", "evaluation")] + [f"/v1/models/{of['loose']}", f"/v1/devices/{of['name']}"]

    def read(self, target: str) -> Answer:
        if target.endswith("/events"):
            return self.daemon.request("GET", target, headers={"Authorization": f"Bearer {self.limited}", "Last-Event-ID": "1000000"})
        return self.ask(self.limited, "GET", target)

    def test_nothing_of_another_device_is_in_any_answer(self) -> None:
        wanted = self.gets(self.theirs)
        self.assertGreater(len(wanted), 40)
        for target in wanted:
            with self.subTest(target=target):
                answer = self.read(target)
                asked = [value for value in self.theirs.values() if value in target]
                text = answer.text
                for value in asked:  # what the request itself said may come back
                    text = text.replace(value, "")
                for name, value in self.theirs.items():
                    self.assertNotIn(value, text, f"{name}: {answer.describe()}")
                if asked and not any(query in target for query in ("?recording=", "?job=", "?q=")):  # these lists are empty
                    self.expect(404, answer)

    def test_what_is_hidden_reads_as_what_does_not_exist(self) -> None:
        for target in self.gets(self.theirs):
            asked = next((value for value in self.theirs.values() if value in target), None)
            if asked is None or "?" in target:
                continue
            with self.subTest(target=target):
                absent = asked[:-1] + ("0" if asked[-1] != "0" else "1")
                hidden, none = self.read(target), self.read(target.replace(asked, absent))

                def plain(answer: Answer, id_: str) -> Any:
                    document = json.loads(answer.text.replace(id_, "ID"))
                    document.pop("request_id")
                    return document
                self.assertEqual(plain(hidden, asked), plain(none, absent))

    def test_what_is_its_own_is_all_there(self) -> None:
        for target in self.gets(self.mine):
            with self.subTest(target=target):
                if self.mine["loose"] in target or self.mine["evaluation"] in target:
                    self.expect(404, self.read(target))  # of no device, and somebody else asked for it
                else:
                    self.expect(200, self.read(target))
        counts = self.ask(self.limited, "GET", "/v1/counts").json
        self.assertEqual((counts["devices"], counts["recordings"]), (1, 4))
        self.assertEqual([d["name"] for d in self.ask(self.limited, "GET", "/v1/devices").json["items"]], ["phone-mine"])
        everything = {r["id"] for r in self.daemon.items("/v1/jobs")}
        own = {r["id"] for r in self.ask(self.limited, "GET", "/v1/jobs?limit=500").json["items"]}
        self.assertLess(own, everything)
        self.assertIn(self.mine["regression"], own)

    def test_it_hears_that_its_own_device_is_gone_and_of_no_other(self) -> None:
        for name in ("gone-mine", "gone-theirs"):
            self.expect(201, self.daemon.post("/v1/devices", {"name": name}))
        secret = self.token("read", devices=["gone-mine"])
        with self.daemon.connect() as connection:
            connection.sendall(f"GET /v1/events HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {secret}\r\n\r\n".encode())
            text = b""
            while b"event: ready" not in text:
                text += connection.recv(65536)
            for name in ("gone-theirs", "gone-mine"):
                self.expect(204, self.daemon.request("DELETE", f"/v1/devices/{name}", headers={"If-Match": "*"}))
            while b"device.deleted" not in text:
                text += connection.recv(65536)
        self.assertIn(b"gone-mine", text)
        self.assertNotIn(b"gone-theirs", text)

    def test_the_stream_of_all_events_tells_of_its_own_devices_alone(self) -> None:
        with self.daemon.connect() as connection:
            connection.sendall(f"GET /v1/events HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {self.limited}\r\n\r\n".encode())
            text = b""
            while b"event: ready" not in text:
                text += connection.recv(65536)
            for of in (self.theirs, self.mine):
                for serial in ("a", f"serial of {of['name']}"):
                    self.expect(200, self.daemon.request("PATCH", f"/v1/devices/{of['device']}", {"serial": serial}, {"If-Match": "*"}))
                self.daemon.finished(self.daemon.characterise(of["recording"], models=["WN"]).json["id"])
            while text.count(b"event: result.created") < 1:
                text += connection.recv(65536)
        self.assertIn(self.mine["device"].encode(), text)
        for value in self.theirs.values():
            self.assertNotIn(value.encode(), text)

    def test_pages_of_lists_are_full(self) -> None:
        """Rows that are hidden take no room on a page, and no cursor leads through them."""
        first = self.ask(self.limited, "GET", "/v1/recordings?limit=2").json
        second = self.ask(self.limited, "GET", f"/v1/recordings?limit=2&cursor={first['next_cursor']}").json
        self.assertEqual([each["id"] for each in first["items"]], [self.mine["recording"], self.mine["second"]])
        self.assertEqual(len(second["items"]), 2)
        self.assertIsNone(second["next_cursor"])

    def test_nothing_of_another_device_can_be_changed_or_used(self) -> None:
        def refused(method: str, target: str, body: Any = None, headers: dict[str, str] | None = None) -> None:
            answer = self.ask(self.limited, method, target, body, headers)
            self.assertIn(answer.status, (400, 403, 404), answer.describe())
            self.assertNotIn("serial of", answer.text)
        them, match = self.theirs, {"If-Match": "*"}
        before = [self.daemon.get(f"/v1/{kind}/{them[one]}").text for kind, one in (("devices", "device"), ("recordings", "recording"))]
        refused("PATCH", f"/v1/devices/{them['device']}", {"serial": "x"}, match)
        refused("PATCH", f"/v1/recordings/{them['recording']}", {"id": "x"}, match)
        refused("DELETE", f"/v1/recordings/{them['recording']}", None, match)
        refused("POST", f"/v1/jobs/{them['job']}/cancel", b"")
        refused("POST", "/v1/jobs", {"kind": "characterise", "inputs": {"recordings": [them["recording"]]}})
        refused("POST", "/v1/jobs", {"kind": "characterise", "inputs": {"recordings": [self.mine["recording"], them["recording"]]}})
        refused("POST", "/v1/jobs", {"kind": "characterise", "inputs": {"study": them["study"]}})
        refused("POST", "/v1/jobs", {"kind": "investigate", "inputs": {"study": them["study"]}})
        refused("POST", "/v1/jobs", {"kind": "investigate", "inputs": {"study": self.mine["study"]},
                                     "parameters": {"baseline": {"kind": "model", "id": them["model"]}}})
        refused("POST", "/v1/jobs", {"kind": "investigate", "inputs": {"study": self.mine["study"]},
                                     "parameters": {"baseline": {"kind": "fit", "id": them["fit"]}}})
        refused("POST", "/v1/jobs", {"kind": "pool", "inputs": {"device": them["name"], "sensor": "gyroscope", "axis": "z"}})
        refused("POST", "/v1/studies", {"device": {"id": them["name"]}, "recordings": [{"recording": them["recording"]}]})
        refused("POST", "/v1/studies", {"device": {"id": self.mine["name"]}, "recordings": [{"recording": them["recording"]}]})
        refused("POST", "/v1/calibrations", {"device": {"id": them["name"]}, "calibration": {}})
        refused("POST", "/v1/models", {"name": "a", "processes": [], "device": them["name"]})
        refused("POST", "/v1/models", {"name": "a", "processes": [], "parent": them["model"]})
        after = [self.daemon.get(f"/v1/{kind}/{them[one]}").text for kind, one in (("devices", "device"), ("recordings", "recording"))]
        self.assertEqual(before, after)

    def changes(self, of: dict[str, str]) -> list[tuple[str, str, Any, dict[str, str]]]:
        """Every operation of the contract that changes something, asked of what a device has: its ids in the address, in the query and in
        the contract's own example of the body."""
        groups = {"devices": "device", "recordings": "recording", "jobs": "job", "studies": "study", "calibrations": "calibration", "models": "model", "investigations": "investigation"}
        of_kind = {value.partition("_")[0]: value for value in of.values() if re.fullmatch(r"[a-z]{3}_[0-9A-Z]{26}", value)}

        def theirs(node: Any, name: str = "") -> Any:
            if isinstance(node, dict):
                return {key: theirs(value, of["name"] if name == "device" and key == "id" else key) for key, value in node.items()}
            if isinstance(node, list):
                return [theirs(value, name) for value in node]
            found = re.fullmatch(r"([a-z]{3})_[0-9A-Z]{26}", node) if isinstance(node, str) else None
            if found:
                return of_kind.get(found[1], node)
            return of["name"] if name == of["name"] or (isinstance(node, str) and name == "device") else node

        asked = []
        for path, operations in self.contract.paths.items():
            group = path.split("/")[2] if path.startswith("/v1/") else ""
            for method in ("post", "put", "patch", "delete"):
                operation = operations.get(method)
                if operation is None or operation["x-scope"] not in ("read", "write", "run") or group == "session":
                    continue
                if path.endswith("/preview"):  # says what a file would be, and keeps nothing: of the device it reads nothing
                    continue
                named = {p["name"] for p in map(self.contract.resolved, operation.get("parameters", [])) if p["in"] == "query"}
                target = re.sub(r"\{[^}]*\}", of.get(groups.get(group, ""), "absent"), path)
                if "device" in named:
                    target += f"?device={of['name']}" + "&condition=static&rate_hz=100&columns=gz%3Dangular_rate%3Az%3Adeg%2Fs" * ("condition" in named)
                content = operation.get("requestBody", {}).get("content", {})
                media = next(iter(content), "")
                described = content.get(media, {})
                examples = [described["example"]] if "example" in described else [each["value"] for each in described.get("examples", {}).values()]
                headers = {"If-Match": "*", "Tus-Resumable": "1.0.0", **({"Content-Type": media} if media else {})}
                for body in ([theirs(example) for example in examples] if media.endswith("json") and examples else [samples.gyro_csv(seed=77) if media else None]):
                    asked.append((method.upper(), target, body, headers))
        return asked

    def test_no_operation_changes_anything_of_another_device(self) -> None:
        admin = [self.daemon.get(target) for target in self.gets(self.theirs)]
        audited = self.daemon.items("/v1/audit?limit=500")[-1]["sequence"]
        asked = self.changes(self.theirs)
        self.assertGreater(len(asked), 20)
        named = 0
        for method, target, body, headers in asked:
            with self.subTest(method=method, target=target, body=body if not isinstance(body, bytes) else b"..."):
                names = any(value in target or value in json.dumps(body if not isinstance(body, bytes) else "") for value in self.theirs.values())
                named += names
                answer = self.ask(self.limited, method, target, body, headers)
                self.assertNotEqual(answer.status // 100, 5, answer.describe())
                if names:
                    self.assertIn(answer.status, (400, 403, 404, 409, 415, 422), answer.describe())
                self.assertNotIn("serial of", answer.text)
        self.assertGreater(named, 12, "most operations are asked of something that is another's")
        for before in admin:
            if not any(part in before.target for part in ("/metrics", "/v1/jobs", "/v1/counts", "/v1/models", "/v1/outage", "/v1/search")):
                self.assertEqual(self.daemon.get(before.target).text, before.text, "an admin sees what was there before")
        ids = set(self.theirs.values())
        touched = [row for row in self.daemon.items("/v1/audit?limit=500") if row["sequence"] > audited and row["object"] in ids]
        self.assertEqual(touched, [], "the audit log knows of nothing either")

    def test_a_limited_token_makes_its_own_devices_only(self) -> None:
        """The refusal is the same whether the other device exists or not."""
        said = []
        for name in (self.theirs["name"], "phone-nobody-has"):
            said.append(self.problem(403, "forbidden", self.ask(self.limited, "POST", "/v1/devices", {"name": name}))["detail"])
            target = f"/v1/recordings?device={name}&condition=static&rate_hz=100&columns={samples.GYRO_Z}"
            stream = {"Content-Type": "application/octet-stream"}
            said.append(self.problem(403, "forbidden", self.ask(self.limited, "POST", target, samples.gyro_csv(seed=40), stream))["detail"])
        self.assertEqual(len(set(said)), 1)
        newcomer = self.token("write", devices=["phone-new"])
        self.expect(201, self.ask(newcomer, "POST", "/v1/devices", {"name": "phone-new"}))
        self.assertEqual([d["name"] for d in self.ask(newcomer, "GET", "/v1/devices").json["items"]], ["phone-new"])

    def test_a_refused_upload_leaves_nothing(self) -> None:
        """By every way in: a form, whose device comes with the file, and pieces, whose device comes after them."""
        before = [self.daemon.files(folder) for folder in ("blobs", "columns")]
        parts = [("metadata", json.dumps({"device": self.theirs["name"], "condition": {"kind": "static"}, "rate_hz": 100}).encode()),
                 ("file", samples.gyro_csv(seed=41))]
        for form in (parts, parts[::-1]):
            body, content_type = multipart(*form)
            self.problem(403, "forbidden", self.ask(self.limited, "POST", "/v1/recordings", body, {"Content-Type": content_type}))
        content, tus = samples.gyro_csv(seed=42), {"Tus-Resumable": "1.0.0"}
        upload = self.expect(201, self.ask(self.limited, "POST", "/v1/uploads", None, {**tus, "Upload-Length": str(len(content))})).headers["location"]
        piece = {**tus, "Content-Type": "application/offset+octet-stream", "Upload-Offset": "0"}
        self.expect(204, self.ask(self.limited, "PATCH", upload, content, piece))
        target = f"{upload}/recording?device={self.theirs['name']}&condition=static&rate_hz=100&columns={samples.GYRO_Z}"
        self.problem(403, "forbidden", self.ask(self.limited, "POST", target))
        self.assertEqual([self.daemon.files(folder) for folder in ("blobs", "columns")], before, "not even its bytes")
        self.assertEqual(self.daemon.files("incoming"), [])
        self.expect(204, self.ask(self.limited, "DELETE", upload, None, tus))

    def test_an_upload_under_way_is_there_for_who_began_it(self) -> None:
        tus = {"Tus-Resumable": "1.0.0"}
        begun = self.expect(201, self.ask(self.limited, "POST", "/v1/uploads", None, {**tus, "Upload-Length": "10"}))
        upload = begun.headers["location"]
        other = self.token("run")
        piece = {**tus, "Content-Type": "application/offset+octet-stream", "Upload-Offset": "0"}
        for method, target, body, headers in (("GET", upload, None, {}), ("HEAD", upload, None, tus), ("PATCH", upload, b"0123456789", piece),
                                              ("DELETE", upload, None, tus), ("POST", f"{upload}/recording?device=phone-mine&condition=static", b"", {})):
            self.assertEqual(self.ask(other, method, target, body, headers).status, 404, method)
        self.expect(204, self.ask(self.limited, "PATCH", upload, b"01234", piece))
        self.assertEqual(self.ask(self.limited, "GET", upload).json["offset"], 5)
        self.assertEqual(self.daemon.get(upload).json["offset"], 5, "an admin sees it")
        self.expect(204, self.ask(self.limited, "DELETE", upload, None, tus))

    def test_what_it_asked_for_it_sees(self) -> None:
        """A model of no device, and a job that names none, are seen by who asked and not by another limited token."""
        other = self.token("run", devices=["phone-nobody-has"])
        model = self.ask(self.limited, "POST", "/v1/models", {"name": "own", "processes": [
            {"process": "white_noise", "params": {"N": {"value": 77, "unit": "deg/sqrt(h)"}}}]}).json["id"]
        job = self.ask(self.limited, "POST", "/v1/outage-evaluations", {"scenario": "paper", "runs": 2, "seed": 77}).json["id"]
        for target in (f"/v1/models/{model}", f"/v1/jobs/{job}", f"/v1/outage-evaluations/{job}"):
            self.expect(200, self.ask(self.limited, "GET", target))
            self.expect(404, self.ask(other, "GET", target))
        self.assertNotIn(model, self.ask(other, "GET", "/v1/models").text)
        self.assertNotIn(job, self.ask(other, "GET", "/v1/jobs").text)
        self.assertIn(model, self.ask(self.limited, "GET", "/v1/models").text)


if __name__ == "__main__":
    unittest.main()
