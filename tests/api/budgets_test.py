"""One client with small inputs neither stops the daemon, nor fills its memory or its disk, nor shuts others out.

Each test is an attack that worked before its budget was there (figures: tests/RELIABILITY.md). The page of the budgets,
the file that states them and `driftlabd config` say the same.
"""
from __future__ import annotations

import io
import json
import lzma
import os
import re
import resource
import socket
import subprocess
import tempfile
import threading
import time
import unittest
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from daemon import PATIENCE_S, PROGRAM, Answer, Daemon, read_all
from events_test import stream as listening
from samples import stamped_csv
from suite import DaemonTest

SOURCE = Path(__file__).resolve().parents[2]
FAST_S = 3.0 if not os.environ.get("DRIFTLAB_SANITIZE") else 60.0


def big_model(number: int, size: int) -> dict[str, object]:
    white = {"process": "white_noise", "params": {"N": {"value": 0.01, "unit": "deg/sqrt(s)"}}}
    return {"name": f"model {number}", "processes": [white] * (size // len(json.dumps(white)))}


def send_head(connection: socket.socket, target: str, extra: str = "", method: str = "GET") -> None:
    connection.sendall(f"{method} {target} HTTP/1.1\r\nHost: localhost\r\n{extra}\r\n".encode())


class OneClientCannotTakeIt(DaemonTest):
    def test_a_body_that_nobody_reads_is_no_second_request(self) -> None:
        smuggled = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"
        for target in ("/v1/jobs/job_00000000000000000000000000/events", "/v1/nothing", "/healthz", "/"):
            with self.subTest(target=target), self.daemon.connect() as connection:
                send_head(connection, target, f"Content-Length: {len(smuggled)}\r\nConnection: close\r\n")
                connection.sendall(smuggled)
                self.assertEqual(read_all(connection).count(b"HTTP/1.1 "), 1)
        with self.daemon.connect() as connection:  # and none where the client would keep the connection
            send_head(connection, "/v1/jobs/job_00000000000000000000000000/events", f"Content-Length: {len(smuggled)}\r\n")
            connection.sendall(smuggled)
            answers = read_all(connection)
            self.assertEqual(answers.count(b"HTTP/1.1 "), 1, answers)
            self.assertIn(b"Connection: close", answers)

    def test_an_object_of_very_many_members_is_refused_at_once(self) -> None:
        members = b"{" + b",".join(b'"%x":1' % i for i in range(105_000)) + b"}"
        self.assertLess(len(members), 1024 * 1024)
        as_json = {"Content-Type": "application/json"}
        begun = time.monotonic()
        self.problem(400, "parse_error", self.daemon.post("/v1/models", members, as_json))
        self.problem(400, "parse_error", self.daemon.post("/v1/devices", b'{"name":"x","labels":' + members + b"}", as_json))
        few = {"name": "x", **{f"m{i}": 1 for i in range(9_000)}}
        problem = self.problem(400, "invalid_argument", self.daemon.post("/v1/models", few))
        self.assertLess(time.monotonic() - begun, FAST_S)
        self.assertEqual(len(problem["errors"]), 100)  # type: ignore[arg-type]
        self.assertIn("9001 faults", str(problem["detail"]))

    def test_names_labels_and_reasons_have_lengths(self) -> None:
        def refused(body: dict[str, object], budget: str, target: str = "/v1/devices") -> None:
            problem = self.problem(413, "limit_exceeded", self.daemon.post(target, body))
            self.assertIn(f"(budget {budget} = ", str(problem["detail"]))
        refused({"name": "a", "labels": {f"l{i}": "x" for i in range(65)}}, "labels")
        refused({"name": "a", "labels": {"l": "x" * 257}}, "label_bytes")
        refused({"name": "a", "serial": "x" * 257}, "name_bytes")
        refused({**big_model(1, 100), "name": "x" * 257}, "name_bytes", "/v1/models")
        refused({**big_model(1, 100), "why": "x" * 4097}, "note_bytes", "/v1/models")

    def test_the_names_of_an_upload_have_the_length_of_any_other(self) -> None:
        long = "x" * 257

        def refused(answer: Answer, pointer: str) -> None:
            problem = self.problem(413, "limit_exceeded", answer)
            self.assertIn("(budget name_bytes = 256)", str(problem["detail"]))
            self.assertEqual([error["pointer"] for error in problem["errors"]], [pointer])  # type: ignore[attr-defined]

        def said(**more: object) -> Answer:
            metadata = {"device": "long-names", "condition": {"kind": "static"}, **more}
            return self.daemon.upload_parts(("metadata", json.dumps(metadata).encode()), ("file", stamped_csv(200)))
        for member in ("model", "imu", "serial"):
            refused(said(device={"id": "long-names", member: long}), f"/device/{member}")
        for member in ("id", "stream", "calibration"):
            refused(said(**{member: long}), f"/{member}")
            refused(self.daemon.upload(stamped_csv(200), device="long-names", **{member: long}), f"/{member}")
        refused(said(columns={long: {"quantity": "time", "unit": "s"}}), "/columns")
        recording = self.expect(201, said()).json
        target = f"/v1/recordings/{recording['id']}"
        refused(self.daemon.request("PATCH", target, {"id": long}, {"If-Match": "*"}), "/id")
        self.expect(200, self.daemon.request("PATCH", target, {"id": long[:256]}, {"If-Match": "*"}))

    def test_a_search_answers_as_much_as_a_list(self) -> None:
        with Daemon(arguments=("--budget", "name_bytes=60000", "--budget", "page_bytes=200000")) as daemon:
            for number in range(12):
                self.assertEqual(daemon.post("/v1/devices", {"name": f"many-{number}", "model": "m" * 50_000}).status, 201)
            answer = daemon.get("/v1/search?q=many&limit=50")
            self.assertEqual(answer.status, 200)
            self.assertEqual([hit["title"] for hit in answer.json["items"]], ["many-0", "many-1", "many-2"])
            self.assertLess(len(answer.body), 200_000)
        with Daemon(arguments=("--budget", "name_bytes=60000", "--budget", "page_bytes=4096")) as daemon:
            for number in range(2):
                self.assertEqual(daemon.post("/v1/devices", {"name": f"many-{number}", "model": "m" * 50_000}).status, 201)
            found = daemon.get("/v1/search?q=many").json["items"]
            self.assertEqual([hit["title"] for hit in found], ["many-0"], "one that is larger comes alone")

    def test_notes_about_a_file_are_counted_not_kept(self) -> None:
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w") as archive:
            header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (200, 2), }"
            header += b" " * (117 - len(header)) + b"\n"
            samples = b"".join(__import__("struct").pack("<dd", i / 100, i % 7) for i in range(200))
            archive.writestr("imu.npy", b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + samples)
            for i in range(3000):
                archive.writestr(f"{'n' * 200}{i}.txt", b"no array")
        answer = self.expect(201, self.daemon.upload(content.getvalue(), rate_hz=100, columns="imu_0=time::s,imu_1=angular_rate:z:deg/s"))
        notes = answer.json["file"]["notes"]
        self.assertLessEqual(len(notes), 65)
        self.assertIn("2936 more", notes[-1])
        self.assertLess(len(answer.body), 65 * 1100 + 4000)

    def test_a_text_of_a_few_kilobytes_does_not_become_a_gigabyte(self) -> None:
        bomb = lzma.compress(b"a [deg/s]\n" + b"1\n" * 40_000_000, preset=6)
        self.assertLess(len(bomb), 60_000)
        before = self.daemon.traces()
        begun = time.monotonic()
        problem = self.problem(413, "decompression_limit", self.daemon.upload(bomb, rate_hz=100))
        self.assertRegex(str(problem["detail"]), r"bytes that it may become|expands")
        self.assertLess(time.monotonic() - begun, 20 * FAST_S)
        self.assertEqual(self.daemon.traces(), before)

    def test_equal_uploads_at_once_are_stored_once(self) -> None:
        content = stamped_csv(20_000)
        key = {"Idempotency-Key": "the-same"}
        with ThreadPoolExecutor(12) as pool:
            answers = list(pool.map(lambda i: self.daemon.upload(content, key, device=f"twin-{i % 4}"), range(12)))
        self.assertEqual([a.status for a in answers if a.status < 300 and "idempotency-replayed" not in a.headers], [201])
        self.assertTrue(all(a.status in {201, 409, 422, 503} for a in answers), [a.status for a in answers])
        stored = [r for r in self.daemon.items("/v1/recordings?limit=500") if "twin" in json.dumps(r["metadata"])
                  or r["file"]["sha256"] == next(a for a in answers if a.status == 201).json["file"]["sha256"]]
        self.assertEqual(len(stored), 1)


class ListsHaveABudget(DaemonTest):
    COUNT = 40

    def test_a_page_of_large_documents_is_cut_and_read_in_parts(self) -> None:
        with ThreadPoolExecutor(4) as pool:
            made = list(pool.map(lambda i: self.daemon.post("/v1/models", big_model(i, 900_000)), range(self.COUNT)))
        self.assertTrue(all(answer.status == 201 for answer in made), made[0].describe())
        self.daemon.checks.clear()  # judging megabytes against the contract takes seconds each
        page = self.daemon.get("/v1/models?limit=500")
        self.assertLessEqual(len(page.body), 4 * 1024 * 1024 + 100)
        self.assertIsNotNone(page.json["next_cursor"])
        self.assertIn('rel="next"', page.headers["link"])
        before = self.daemon.memory_kib("VmHWM")
        with ThreadPoolExecutor(8) as pool:
            pages = list(pool.map(lambda _: self.daemon.get("/v1/models?limit=500"), range(8)))
        self.assertTrue(all(p.body == page.body for p in pages))
        grown = self.daemon.memory_kib("VmHWM") - before
        self.assertLess(grown, 400 * 1024, "KiB for eight pages at once")
        found = self.daemon.items("/v1/models?limit=500")
        self.assertEqual(len({m["id"] for m in found}), self.COUNT)


class OneLargerThanThePageComesAlone(DaemonTest):
    arguments = ("--budget", "page_bytes=4096")

    def test_one_larger_than_the_page_comes_alone(self) -> None:
        for i in range(3):
            self.expect(201, self.daemon.post("/v1/models", big_model(i, 8000)))
        page = self.daemon.get("/v1/models?limit=2").json
        self.assertEqual(len(page["items"]), 1)
        self.assertEqual(len(self.daemon.items("/v1/models?limit=2")), 3)


class ConnectionsHaveABudget(unittest.TestCase):
    def test_idle_connections_lock_nobody_out(self) -> None:
        with Daemon() as daemon:
            idle = [daemon.connect() for _ in range(200)]
            self.assertEqual(daemon.get("/healthz").status, 200)
            for connection in idle:
                connection.close()

    def test_where_every_place_is_taken_the_longest_idle_goes(self) -> None:
        with Daemon(arguments=("--budget", "connections=20")) as daemon:
            silent = [daemon.connect() for _ in range(10)]
            trickling = [daemon.connect() for _ in range(10)]
            for connection in trickling:
                connection.sendall(b"GET /heal")
            time.sleep(0.2)
            for _ in range(15):
                self.assertEqual(daemon.get("/healthz").status, 200)
            silent[0].settimeout(5)
            self.assertEqual(silent[0].recv(1), b"", "the longest idle was closed")

    def test_many_silent_connections_take_little_memory(self) -> None:
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        most = min(1000, soft - 100)
        with Daemon(arguments=("--budget", "idle_seconds=60")) as daemon:
            before = daemon.memory_kib("VmRSS")
            silent = [daemon.connect() for _ in range(most)]
            self.assertEqual(daemon.get("/healthz").status, 200)
            self.assertLess(daemon.memory_kib("VmRSS") - before, 32 * 1024)
            del silent, hard

    def test_a_slow_reader_is_served_and_one_that_takes_nothing_is_cut(self) -> None:
        with Daemon(arguments=("--budget", "write_stall_seconds=2", "--budget", "send_buffer_bytes=4096")) as daemon:
            for i in range(3):
                self.assertEqual(daemon.post("/v1/models", big_model(i, 900_000)).status, 201)
            whole = len(daemon.get("/v1/models").body)
            with socket.socket() as slow, socket.socket() as still:
                for connection in (slow, still):
                    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                    connection.connect(("127.0.0.1", daemon.port))
                    send_head(connection, "/v1/models", "Connection: close\r\n")
                taken, begun, slow_for = 0, time.monotonic(), 5.0
                while True:  # slower than all at once for longer than the deadline, then fast
                    piece = slow.recv(4096 if time.monotonic() - begun < slow_for else 65536)
                    taken += len(piece)
                    if not piece:
                        break
                    if time.monotonic() - begun < slow_for:
                        time.sleep(0.05)
                self.assertGreater(time.monotonic() - begun, slow_for)
                self.assertGreater(taken, whole, "a reader that makes progress gets everything")
                still.settimeout(10)
                rest = read_all(still)
                self.assertLess(len(rest), whole // 2, "one that took nothing for two seconds was cut")


class UploadsShare(unittest.TestCase):
    def test_bombs_do_not_stall_an_honest_upload(self) -> None:
        # Hundreds of millions of bytes of text in a small file; each takes as long as it may.
        bomb = lzma.compress((b"a [deg/s],b,c,d,e,f\n" + b"1,1,1,1,1,1\n" * 2_400_000), preset=1)
        with Daemon(arguments=("--budget", "decode_seconds=20")) as daemon, ThreadPoolExecutor(4) as pool:
            bombs = [pool.submit(daemon.upload, bomb, rate_hz=100, device=f"b{i}") for i in range(3)]
            time.sleep(0.1)
            begun = time.monotonic()
            answer = daemon.upload(stamped_csv(10_000))
            self.assertEqual(answer.status, 201)
            self.assertLess(time.monotonic() - begun, 2 * FAST_S)
            for one in bombs:
                self.assertIn(one.result().status, {201, 413})

    def test_more_uploads_than_places_wait_and_all_are_stored(self) -> None:
        with Daemon(arguments=("--budget", "uploads=2")) as daemon, ThreadPoolExecutor(12) as clients:
            answers = list(clients.map(lambda k: daemon.upload(stamped_csv(2000 + k), device=f"imu-{k}"), range(12)))
        self.assertEqual([answer.status for answer in answers], [201] * 12)

    def test_who_waits_too_long_for_a_place_is_told_which_budget_it_was(self) -> None:
        with Daemon(arguments=("--budget", "uploads=1", "--budget", "upload_wait_seconds=1")) as daemon, daemon.connect() as holding:
            send_head(holding, "/v1/recordings?device=imu-1&condition=static", "Content-Length: 1000\r\nContent-Type: text/csv\r\n", "POST")
            time.sleep(0.2)
            answer = daemon.upload(stamped_csv(100), device="imu-2")
            self.assertEqual(answer.status, 503, answer.describe())
            self.assertIn("upload_wait_seconds", answer.json["detail"])
            self.assertIn("retry-after", answer.headers)
            holding.close()
            self.assertEqual(daemon.upload(stamped_csv(100), device="imu-2").status, 201)

    def test_a_decoding_has_a_time_limit_that_is_named(self) -> None:
        rows = b"0.123456789,0.23456789,0.3456789,0.456789,0.56789,0.6789\n" * 400_000
        text = b"a [deg/s],b,c,d,e,f\n" + rows
        with Daemon(arguments=("--budget", "decode_seconds=1", "--budget", "decode_bytes_per_second=1000000000000")) as daemon:
            workers = [threading.Thread(target=lambda: daemon.upload(text, rate_hz=100, device="busy")) for _ in range(6)]
            for worker in workers:
                worker.start()
            answer = daemon.upload(lzma.compress(text + 3 * rows, preset=1), rate_hz=100)
            for worker in workers:
                worker.join()
            if answer.status != 201:  # a fast machine may decode it in time
                self.assertEqual(answer.status, 413, answer.describe())
                self.assertIn("decode_seconds = 1", answer.json["detail"])
            self.assertEqual(daemon.files("incoming"), [])

    def test_a_device_has_a_quota(self) -> None:
        with Daemon(arguments=("--budget", "recordings_per_device=2", "--budget", "device_bytes=100000")) as daemon:
            self.assertEqual(daemon.upload(stamped_csv(200)).status, 201)
            self.assertEqual(daemon.upload(stamped_csv(300)).status, 201)
            self.assertEqual(daemon.upload(stamped_csv(300)).status, 200, "what is there already costs nothing")
            full = daemon.upload(stamped_csv(400))
            self.assertEqual(full.status, 507, full.describe())
            self.assertIn("recordings_per_device = 2", full.json["detail"])
            heavy = daemon.upload(stamped_csv(20_000), device="other")
            self.assertEqual(heavy.status, 507, heavy.describe())
            self.assertIn("device_bytes = 100000", heavy.json["detail"])
            self.assertEqual(daemon.upload(stamped_csv(400), device="other").status, 201)


class NothingIsMadeOnAFullDisk(DaemonTest):
    arguments = ("--budget", "least_free_bytes=1000000000000")

    def test_what_creates_is_refused_and_what_ends_is_not(self) -> None:
        refused, done = set(), set()
        for path, operations in self.contract.paths.items():
            if "post" not in operations:
                continue
            name, content = operations["post"]["operationId"], operations["post"].get("requestBody", {}).get("content", {})
            if not content or "application/json" in content:
                answer = self.daemon.post(re.sub(r"\{[^}]*\}", "absent", path), {} if content else None)
                full = answer.status == 507 and "(budget least_free_bytes = " in answer.json["detail"]
                (refused if full else done).add(name)
        self.assertEqual(done, {"cancelJob", "openSession", "createToken", "rotateToken", "revokeToken", "rotateWebhook", "createBackup"})
        for name in ("createJob", "createModel", "createStudy", "createCalibration", "createDrive", "createDevice", "moveRegressionAnchor",
                     "createOutageEvaluation", "createDriveEvaluation", "createLiveRecording"):
            self.assertIn(name, refused)
        self.problem(507, "disk_full", self.daemon.upload(stamped_csv(200)))


class RepeatedAnswers(DaemonTest):
    def test_a_long_one_is_read_again_and_not_kept(self) -> None:
        key = {"Idempotency-Key": "long"}
        long, short = big_model(1, 200_000), big_model(2, 1000)
        made = self.expect(201, self.daemon.post("/v1/models", long, key))
        again = self.expect(201, self.daemon.post("/v1/models", long, key))
        self.assertEqual((again.json, again.headers["location"]), (made.json, made.headers["location"]))
        self.assertEqual(again.headers["idempotency-replayed"], "true")
        self.expect(201, self.daemon.post("/v1/models", short, {"Idempotency-Key": "short"}))
        self.assertEqual(sorted(length > 0 for [length] in self.daemon.rows("SELECT length(body) FROM idempotent_replies")), [False, True])
        self.problem(422, "idempotency_key_reused", self.daemon.post("/v1/models", short, key))
        self.expect(204, self.daemon.request("DELETE", made.headers["location"]))
        self.problem(404, "not_found", self.daemon.post("/v1/models", long, key))


class PiecesAreUploads(unittest.TestCase):
    def test_an_upload_in_pieces_is_no_longer_than_another(self) -> None:
        content = stamped_csv(2000)
        with Daemon(arguments=("--budget", "upload_bytes=10000")) as daemon:
            whole = daemon.upload(content)
            begun = begin_pieces(daemon, len(content))
            for answer in (whole, begun):
                self.assertEqual((answer.status, answer.json["code"]), (413, "body_too_large"), answer.describe())
                self.assertIn("(budget upload_bytes = 10000)", answer.json["detail"])
            self.assertEqual(begin_pieces(daemon, 10000).status, 201)


def begin_pieces(daemon: Daemon, length: int) -> Answer:
    return daemon.request("POST", "/v1/uploads", headers={"Tus-Resumable": "1.0.0", "Upload-Length": str(length)})


class TokensHaveBudgets(unittest.TestCase):
    """What one token may take, so that another has its share."""

    def daemon(self, *budgets: str) -> tuple[Daemon, str, str]:
        daemon = self.enterContext(Daemon(arguments=("--require-tokens", *(word for budget in budgets for word in ("--budget", budget)))))
        daemon.token = (daemon.data / "first-admin-token").read_text().strip()
        one, other = (daemon.post("/v1/tokens", {"name": name, "scope": "run"}).json["secret"] for name in ("one", "other"))
        return daemon, one, other

    def test_requests_under_way(self) -> None:
        daemon, one, other = self.daemon("requests_per_token=2")
        streams = [daemon.connect() for _ in range(2)]
        for stream in streams:
            send_head(stream, "/v1/events", f"Authorization: Bearer {one}\r\n")
            self.assertTrue(stream.recv(65536).startswith(b"HTTP/1.1 200 "))
        daemon.token = one
        refused = daemon.get("/v1/devices")
        self.assertEqual((refused.status, refused.headers["retry-after"]), (429, "1"), refused.describe())
        self.assertIn("requests_per_token = 2", refused.json["detail"])
        upload = daemon.upload(stamped_csv(200))
        self.assertEqual(upload.status, 429, "before its body is read")
        daemon.token = other
        self.assertEqual(daemon.get("/v1/devices").status, 200)
        for stream in streams:
            stream.close()
        until = time.monotonic() + 30
        daemon.token = one
        while daemon.get("/v1/devices").status != 200 and time.monotonic() < until:
            daemon.token = other  # something to tell: so the daemon learns that nobody listens
            daemon.post("/v1/devices", {"name": f"device-{time.monotonic_ns()}"})
            daemon.token = one
            time.sleep(0.05)
        self.assertEqual(daemon.get("/v1/devices").status, 200, "a place that was given back")

    def test_jobs_that_run_at_once(self) -> None:
        daemon, one, other = self.daemon("running_jobs_per_token=1")
        self.assertGreater(len(os.sched_getaffinity(0)), 1, "two jobs can run at once here")

        def ask(secret: str, seed: int) -> str:
            daemon.token = secret
            return str(daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000, "seed": seed}).json["id"])
        first, second = ask(one, 1), ask(one, 2)
        third = ask(other, 3)

        def state(job: str, secret: str) -> str:
            daemon.token = secret
            return str(daemon.get(f"/v1/jobs/{job}").json["state"])
        until = time.monotonic() + 60
        while state(third, other) == "queued" and time.monotonic() < until:
            time.sleep(0.05)
        self.assertEqual((state(first, one), state(second, one), state(third, other)), ("running", "queued", "running"), "the other's passes the second of the one")
        daemon.token = one
        daemon.post(f"/v1/jobs/{first}/cancel")
        while state(second, one) == "queued" and time.monotonic() < until:
            time.sleep(0.05)
        self.assertEqual(state(second, one), "running", "its turn")
        for job, secret in ((second, one), (third, other)):
            daemon.token = secret
            daemon.post(f"/v1/jobs/{job}/cancel")

    def test_the_queue_is_that_of_all(self) -> None:
        """A token that sees one device alone finds the queue as full as it is."""
        daemon, one, _ = self.daemon("queued_jobs=1", "running_jobs_per_token=1")
        limited = daemon.post("/v1/tokens", {"name": "limited", "scope": "run", "devices": ["a"]}).json["secret"]
        daemon.token = one
        jobs = [daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000, "seed": 1}).json["id"]]
        until = time.monotonic() + PATIENCE_S
        while daemon.get(f"/v1/jobs/{jobs[0]}").json["state"] == "queued" and time.monotonic() < until:
            time.sleep(0.05)
        jobs.append(daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000, "seed": 2}).json["id"])
        daemon.token = limited
        for target, body in (("/v1/outage-evaluations", {"scenario": "paper", "runs": 2, "seed": 3}),
                             ("/v1/jobs", {"kind": "outage_evaluation", "inputs": {}, "parameters": {"scenario": "paper", "runs": 2, "seed": 3}})):
            full = daemon.post(target, body)
            self.assertEqual(full.status, 503, full.describe())
            self.assertIn("(budget queued_jobs = 1)", full.json["detail"])
        daemon.token = one
        for job in jobs:
            daemon.post(f"/v1/jobs/{job}/cancel")

    def test_what_is_kept(self) -> None:
        daemon, one, other = self.daemon("recordings_per_token=2", "token_bytes=100000")
        daemon.token = one
        first = daemon.upload(stamped_csv(200), device="a")
        self.assertEqual((first.status, daemon.upload(stamped_csv(300), device="b").status), (201, 201))
        self.assertEqual(daemon.upload(stamped_csv(300), device="b").status, 200, "what is there already costs nothing")
        full = daemon.upload(stamped_csv(400), device="c")
        self.assertEqual(full.status, 507, full.describe())
        self.assertIn("The token has all that it may have (budget recordings_per_token = 2)", full.json["detail"])
        daemon.token = other
        self.assertEqual(daemon.upload(stamped_csv(400), device="c").status, 201)
        self.assertIn("token_bytes = 100000", daemon.upload(stamped_csv(20_000), device="d").json["detail"])
        daemon.token = one
        self.assertEqual(daemon.request("DELETE", f"/v1/recordings/{first.json['id']}", headers={"If-Match": "*"}).status, 204)
        self.assertEqual(daemon.upload(stamped_csv(500), device="a").status, 201, "what was removed makes room")

    def test_what_was_begun_in_pieces_counts_as_kept(self) -> None:
        daemon, one, other = self.daemon("recordings_per_token=3", "token_bytes=100000")
        daemon.token = one
        content = stamped_csv(1000)
        begun = [begin_pieces(daemon, length) for length in (len(content), 70_000)]
        self.assertEqual([answer.status for answer in begun], [201, 201])
        for refused in (begin_pieces(daemon, 30_000), daemon.upload(stamped_csv(2000))):
            self.assertEqual(refused.status, 507, refused.describe())
            self.assertIn("The token has all that it may have (budget token_bytes = 100000)", refused.json["detail"])
        self.assertEqual(begin_pieces(daemon, 1).status, 201)
        self.assertIn("recordings_per_token = 3", begin_pieces(daemon, 1).json["detail"])
        piece = {"Tus-Resumable": "1.0.0", "Upload-Offset": "0", "Content-Type": "application/offset+octet-stream"}
        upload = begun[0].headers["location"]
        self.assertEqual(daemon.request("PATCH", upload, content, piece).status, 204)
        recorded = daemon.post(f"{upload}/recording?device=a&condition=static")
        self.assertEqual(recorded.status, 201, recorded.describe() + "an upload does not count beside its recording")
        removed = daemon.request("DELETE", begun[1].headers["location"], headers={"Tus-Resumable": "1.0.0"})
        self.assertEqual(removed.status, 204)
        self.assertEqual(daemon.upload(stamped_csv(2000)).status, 201, "what was removed makes room")
        daemon.token = other
        self.assertEqual(begin_pieces(daemon, 30_000).status, 201)


class WhatIsOldGoes(unittest.TestCase):
    def test_recordings_and_ended_jobs_after_their_days(self) -> None:
        """Two days later (the rows are dated back): gone with their files, and what is younger stays, or named by a study."""
        data = Path(self.enterContext(tempfile.TemporaryDirectory())) / "data"
        with Daemon(data) as daemon:
            old, named, young = (daemon.upload(stamped_csv(200 + 100 * n), device=f"d{n}").json for n in range(3))
            self.assertEqual(daemon.post("/v1/studies", {"device": {"id": "d1"}, "recordings": [{"recording": named["id"]}]}).status, 201)
            jobs = []
            for seed in range(2):
                jobs.append(daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000, "seed": seed}).json["id"])
                daemon.post(f"/v1/jobs/{jobs[-1]}/cancel")
                self.assertEqual(daemon.finished(jobs[-1])["state"], "cancelled")
            self.assertEqual(daemon.terminate(), 0)
            before = int((time.time() - 2 * 86400) * 1e6)
            for recording in (old, named):
                daemon.change(f"UPDATE recordings SET created_at = {before} WHERE id = ?", recording["id"])
            daemon.change(f"UPDATE jobs SET finished_at = {before} WHERE id = ?", jobs[0])
        blob = data / "blobs" / old["file"]["sha256"][:2] / old["file"]["sha256"]
        columns = data / "columns" / blob.parent.name / f"{blob.name}.columns"
        for file in (blob, columns):
            os.utime(file, (before / 1e6, before / 1e6))
        with Daemon(data) as daemon:  # by default everything stays
            time.sleep(1.0)
            self.assertEqual(len(daemon.items("/v1/recordings")), 3)
        with Daemon(data, arguments=("--budget", "keep_recordings_days=1", "--budget", "keep_jobs_days=1")) as daemon:
            until = time.monotonic() + 30
            while (blob.exists() or columns.exists()) and time.monotonic() < until:
                time.sleep(0.05)
            self.assertEqual({r["id"] for r in daemon.items("/v1/recordings")}, {young["id"], named["id"]})
            self.assertFalse(blob.exists() or columns.exists(), "the space is free")
            self.assertEqual([daemon.get(f"/v1/jobs/{job}").status for job in jobs], [404, 200])

    def aged(self) -> tuple[Path, list[str], str]:
        """Three recordings of the day before yesterday and one of today."""
        data = Path(self.enterContext(tempfile.TemporaryDirectory())) / "data"
        with Daemon(data) as daemon:
            *old, young = (daemon.upload(stamped_csv(200 + 100 * n), device=f"d{n}").json["id"] for n in range(4))
            self.assertEqual(daemon.terminate(), 0)
            for recording in old:
                daemon.change(f"UPDATE recordings SET created_at = {int((time.time() - 2 * 86400) * 1e6)} WHERE id = ?", recording)
        return data, old, young

    def await_recordings(self, daemon: Daemon, expected: set[str]) -> None:
        until = time.monotonic() + 30
        while (answer := daemon.get("/v1/recordings")).status != 200 or {recording["id"] for recording in answer.json["items"]} != expected:
            self.assertLess(time.monotonic(), until, answer.describe())
            time.sleep(0.1)

    def test_what_goes_for_its_age_leaves_a_trace(self) -> None:
        """In the log, in the audit log by `daemon`, and for whoever listens, as when somebody deletes it."""
        data, old, young = self.aged()
        with Daemon(data, arguments=("--budget", "keep_recordings_days=1")) as daemon:
            for n, recording in enumerate(old):
                line = daemon.logged(event="recording expired", recording=recording)
                self.assertEqual(line["device"], daemon.get(f"/v1/devices/d{n}").json["id"])
            rows = [(row["actor"], row["object"]) for row in daemon.items("/v1/audit") if row["action"] == "recording.expire"]
            self.assertEqual(rows, [("daemon", recording) for recording in old])
            self.assertTrue(daemon.get("/v1/audit-verification").json["sound"])
            with listening(daemon) as events:
                run = str(next(events)[0]).rsplit("-", 1)[0]
            with listening(daemon, last=f"{run}-0") as events:
                seen = [next(events) for _ in range(4)]
            self.assertEqual([told["recording"] for _, kind, told in seen if kind == "recording.deleted"], old)
            self.assertEqual([recording["id"] for recording in daemon.items("/v1/recordings")], [young])

    def test_a_damaged_row_does_not_stop_it(self) -> None:
        data, old, young = self.aged()
        with Daemon(data) as daemon:
            self.assertEqual(daemon.terminate(), 0)
            daemon.change("UPDATE recordings SET condition = 'another' WHERE id = ?", old[0])
        with Daemon(data, arguments=("--budget", "keep_recordings_days=1")) as daemon:
            self.await_recordings(daemon, {young})

    def test_a_row_of_another_time_does_not_stop_it(self) -> None:
        """Times have no checksum: the oldest says that it is of tomorrow."""
        data, old, young = self.aged()
        with Daemon(data) as daemon:
            self.assertEqual(daemon.terminate(), 0)
            daemon.change(f"UPDATE recordings SET created_at = {int((time.time() + 86400) * 1e6)} WHERE id = ?", old[0])
        with Daemon(data, arguments=("--budget", "keep_recordings_days=1")) as daemon:
            self.await_recordings(daemon, {old[0], young})


class BudgetsAreStatedOnce(unittest.TestCase):
    def test_page_file_and_program_agree(self) -> None:
        shown = json.loads(subprocess.run([PROGRAM, "config", "--json"], capture_output=True, check=True, text=True).stdout)
        page = (SOURCE / "schema/docs/budgets.md").read_text()
        rows = re.findall(r"^\| `(\w+)` \| ([\d,]+) \| (.+) \|$", page, re.MULTILINE)
        self.assertEqual([r[0] for r in rows], list(shown["budgets"]), "the page lists every budget once, in order")
        for name, value, meaning in rows:
            self.assertEqual(int(value.replace(",", "")), shown["budgets"][name]["value"], name)
            self.assertEqual(meaning, shown["budgets"][name]["meaning"], name)
        stated = (SOURCE / "server/store/budgets.hpp").read_text()
        self.assertEqual(re.findall(r"^  BUDGET\((\w+),", stated, re.MULTILINE), list(shown["budgets"]))


if __name__ == "__main__":
    unittest.main()
