"""One client with small inputs neither stops the daemon, nor fills its memory or its disk, nor shuts others out.

Each test is an attack that worked before its budget was there (figures: tests/RELIABILITY.md). The page of the budgets,
the file that states them and `driftlabd config` say the same.
"""
from __future__ import annotations

import io
import json
import lzma
import os
import random
import re
import resource
import socket
import sqlite3
import subprocess
import tempfile
import threading
import time
import unittest
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from daemon import PROGRAM, Answer, Daemon, read_all, read_answer
from suite import DaemonTest

SOURCE = Path(__file__).resolve().parents[2]
FAST_S = 3.0 if not os.environ.get("DRIFTLAB_SANITIZE") else 60.0


def csv(rows: int, column: str = "gz [deg/s]") -> bytes:
    return (f"t [s],{column}\n" + "".join(f"{i / 100:.2f},{(i * 7919) % 101 / 100:.2f}\n" for i in range(rows))).encode()


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
        content = csv(20_000)
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
            with socket.socket() as slow, socket.socket() as still:
                for connection in (slow, still):
                    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                    connection.connect(("127.0.0.1", daemon.port))
                    send_head(connection, "/v1/models", "Connection: close\r\n")
                whole = len(daemon.get("/v1/models").body)
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
            answer = daemon.upload(csv(10_000))
            self.assertEqual(answer.status, 201)
            self.assertLess(time.monotonic() - begun, 2 * FAST_S)
            for one in bombs:
                self.assertIn(one.result().status, {201, 413})

    def test_more_uploads_than_places_wait_and_all_are_stored(self) -> None:
        with Daemon(arguments=("--budget", "uploads=2")) as daemon, ThreadPoolExecutor(12) as clients:
            answers = list(clients.map(lambda k: daemon.upload(csv(2000 + k), device=f"imu-{k}"), range(12)))
        self.assertEqual([answer.status for answer in answers], [201] * 12)

    def test_who_waits_too_long_for_a_place_is_told_which_budget_it_was(self) -> None:
        with Daemon(arguments=("--budget", "uploads=1", "--budget", "upload_wait_seconds=1")) as daemon, daemon.connect() as holding:
            send_head(holding, "/v1/recordings?device=imu-1&condition=static", "Content-Length: 1000\r\nContent-Type: text/csv\r\n", "POST")
            time.sleep(0.2)
            answer = daemon.upload(csv(100), device="imu-2")
            self.assertEqual(answer.status, 503, answer.describe())
            self.assertIn("upload_wait_seconds", answer.json["detail"])
            self.assertIn("retry-after", answer.headers)
            holding.close()
            self.assertEqual(daemon.upload(csv(100), device="imu-2").status, 201)

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
            self.assertEqual(daemon.upload(csv(200)).status, 201)
            self.assertEqual(daemon.upload(csv(300)).status, 201)
            self.assertEqual(daemon.upload(csv(300)).status, 200, "what is there already costs nothing")
            full = daemon.upload(csv(400))
            self.assertEqual(full.status, 507, full.describe())
            self.assertIn("recordings_per_device = 2", full.json["detail"])
            heavy = daemon.upload(csv(20_000), device="other")
            self.assertEqual(heavy.status, 507, heavy.describe())
            self.assertIn("device_bytes = 100000", heavy.json["detail"])
            self.assertEqual(daemon.upload(csv(400), device="other").status, 201)


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
        upload = daemon.upload(csv(200))
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

    def test_what_is_kept(self) -> None:
        daemon, one, other = self.daemon("recordings_per_token=2", "token_bytes=100000")
        daemon.token = one
        first = daemon.upload(csv(200), device="a")
        self.assertEqual((first.status, daemon.upload(csv(300), device="b").status), (201, 201))
        self.assertEqual(daemon.upload(csv(300), device="b").status, 200, "what is there already costs nothing")
        full = daemon.upload(csv(400), device="c")
        self.assertEqual(full.status, 507, full.describe())
        self.assertIn("The token has all that it may have (budget recordings_per_token = 2)", full.json["detail"])
        daemon.token = other
        self.assertEqual(daemon.upload(csv(400), device="c").status, 201)
        self.assertIn("token_bytes = 100000", daemon.upload(csv(20_000), device="d").json["detail"])
        daemon.token = one
        self.assertEqual(daemon.request("DELETE", f"/v1/recordings/{first.json['id']}", headers={"If-Match": "*"}).status, 204)
        self.assertEqual(daemon.upload(csv(500), device="a").status, 201, "what was removed makes room")


class WhatIsOldGoes(unittest.TestCase):
    def test_recordings_and_ended_jobs_after_their_days(self) -> None:
        """Two days later (the rows are dated back): gone with their files, and what is younger stays."""
        data = Path(self.enterContext(tempfile.TemporaryDirectory())) / "data"
        with Daemon(data) as daemon:
            old, young = (daemon.upload(csv(200 + 100 * n), device=f"d{n}").json for n in range(2))
            jobs = []
            for seed in range(2):
                jobs.append(daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000, "seed": seed}).json["id"])
                daemon.post(f"/v1/jobs/{jobs[-1]}/cancel")
                self.assertEqual(daemon.finished(jobs[-1])["state"], "cancelled")
            self.assertEqual(daemon.terminate(), 0)
        database = sqlite3.connect(data / "driftlab.db")
        before = int((time.time() - 2 * 86400) * 1e6)
        database.execute("UPDATE recordings SET created_at = ? WHERE id = ?", (before, old["id"]))
        database.execute("UPDATE jobs SET finished_at = ? WHERE id = ?", (before, jobs[0]))
        database.commit()
        database.close()
        blob = data / "blobs" / old["file"]["sha256"][:2] / old["file"]["sha256"]
        columns = data / "columns" / blob.parent.name / f"{blob.name}.columns"
        for file in (blob, columns):
            os.utime(file, (before / 1e6, before / 1e6))
        with Daemon(data) as daemon:  # by default everything stays
            time.sleep(1.0)
            self.assertEqual(len(daemon.items("/v1/recordings")), 2)
        with Daemon(data, arguments=("--budget", "keep_recordings_days=1", "--budget", "keep_jobs_days=1")) as daemon:
            until = time.monotonic() + 30
            while (blob.exists() or columns.exists()) and time.monotonic() < until:
                time.sleep(0.05)
            self.assertEqual([r["id"] for r in daemon.items("/v1/recordings")], [young["id"]])
            self.assertFalse(blob.exists() or columns.exists(), "the space is free")
            self.assertEqual([daemon.get(f"/v1/jobs/{job}").status for job in jobs], [404, 200])


class JobsHaveABudget(unittest.TestCase):
    def test_a_drive_of_a_day_is_refused_before_it_takes_anything(self) -> None:
        with Daemon(arguments=("--budget", "job_memory_bytes=1000000000")) as daemon:
            scenario = json.loads((SOURCE / "tests/api/long_drive.json").read_text())
            for answer in (daemon.post("/v1/jobs", {"kind": "outage_evaluation", "inputs": {"scenario": scenario}}),
                           daemon.post("/v1/outage-evaluations", {"scenario": scenario})):
                self.assertEqual(answer.status, 413, answer.describe())
                self.assertIn("(budget job_memory_bytes = ", answer.json["detail"])
            self.assertLess(daemon.memory_kib("VmHWM"), 200 * 1024)

    def test_a_regression_run_is_admitted_by_the_results_that_it_reads(self) -> None:
        """It stated nothing but the least that every job takes. 32 MiB and 128 KiB for each of six results are 34,340,864."""
        noise = random.Random(6)
        with Daemon(arguments=("--budget", "job_memory_bytes=34300000")) as daemon:
            ids = []
            for _ in range(6):
                table = "gz [deg/s]\n" + "".join(f"{noise.gauss(0.0, 0.05):.6f}\n" for _ in range(6000))
                ids.append(daemon.upload(table.encode(), device="gated", rate_hz=100).json["id"])
                self.assertEqual(daemon.finished(daemon.characterise(ids[-1], models=["WN"]).json["id"])["state"], "succeeded")

            def ask(of_arm: int) -> Answer:
                arms = {name: {"labels": {"firmware": name}, "recordings": [{"recording": each} for each in part[:of_arm]]}
                        for name, part in (("baseline", ids[:3]), ("candidate", ids[3:]))}
                return daemon.post("/v1/jobs", {"kind": "regress", "inputs": {"device": "gated", **arms}})

            refused = ask(3)
            self.assertEqual(refused.status, 413, refused.describe())
            self.assertRegex(refused.json["detail"], r"would take about 32 MiB of memory.*\(budget job_memory_bytes = 34300000\)")
            admitted = ask(2)
            self.assertEqual(admitted.status, 202, admitted.describe())
            self.assertEqual(daemon.finished(admitted.json["id"])["state"], "succeeded")

    @unittest.skipIf(os.environ.get("DRIFTLAB_SANITIZE"), "sanitizers keep memory of their own")
    def test_an_investigation_takes_no_more_than_it_is_admitted_for(self) -> None:
        most = 75_000_000  # 32 MiB and 89 bytes for each of 400,000 samples are 69,154,432; it was once 220 a sample
        noise = random.Random(5)
        table = "gz [deg/s]\n" + "".join(f"{noise.gauss(0.0, 0.05):.6f}\n" for _ in range(400_000))
        with Daemon(arguments=("--budget", f"job_memory_bytes={most}", "--workers", "1")) as daemon:
            recording = daemon.upload(table.encode(), rate_hz=100).json["id"]
            study = daemon.post("/v1/studies", {"device": {"id": "phone-07"}, "recordings": [{"recording": recording}]}).json["id"]
            before = daemon.memory_kib("RssAnon")
            job = daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study}})
            self.assertEqual(job.status, 202, job.describe())
            largest = 0
            until = time.monotonic() + 120
            while time.monotonic() < until and not daemon.get(f"/v1/jobs/{job.json['id']}").json["finished_at"]:
                largest = max(largest, daemon.memory_kib("RssAnon") - before)
                time.sleep(0.02)
            self.assertEqual(daemon.finished(job.json["id"])["state"], "succeeded")
            self.assertLess(largest * 1024, most)
            self.assertGreater(largest, 0)

    def test_a_job_has_a_deadline_that_is_named(self) -> None:
        with Daemon(arguments=("--budget", "job_seconds=1", "--workers", "1")) as daemon:
            recording = daemon.upload(csv(400_000)).json["id"]
            job = daemon.characterise(recording, bootstrap=2000).json
            ended = daemon.finished(job["id"])
            self.assertEqual(ended["state"], "failed")
            self.assertIn("(budget job_seconds = 1)", ended["problem"]["detail"])

    def test_a_job_that_could_not_end_in_time_is_refused_before_it_begins(self) -> None:
        with Daemon(arguments=("--budget", "job_seconds=1")) as daemon:
            recording = daemon.upload(csv(1_500_000)).json["id"]
            for answer in (daemon.characterise(recording),
                           daemon.post("/v1/jobs", {"kind": "outage_evaluation", "inputs": {"scenario": "paper"}, "parameters": {"runs": 100_000}})):
                self.assertEqual(answer.status, 413, answer.describe())
                self.assertIn("(budget job_seconds = 1)", answer.json["detail"])
            self.assertEqual(daemon.items("/v1/jobs"), [])

    def test_jobs_that_would_not_fit_together_wait_for_each_other(self) -> None:
        with Daemon(arguments=("--budget", "job_memory_bytes=60000000", "--workers", "2")) as daemon:
            recordings = [daemon.upload(csv(400_000 + i)).json["id"] for i in range(2)]
            jobs = [daemon.characterise(r).json["id"] for r in recordings]
            stages = set()
            until = time.monotonic() + 60
            while time.monotonic() < until:
                states = [daemon.get(f"/v1/jobs/{job}").json for job in jobs]
                stages |= {s["stage"] for s in states if s["state"] == "running"}
                if all(s["finished_at"] for s in states):
                    break
                time.sleep(0.02)
            self.assertTrue(all(s["state"] == "succeeded" for s in states), states)
            self.assertIn("wait for memory", stages)

    def test_the_queue_has_a_length(self) -> None:
        with Daemon(arguments=("--budget", "queued_jobs=2", "--workers", "1")) as daemon:
            recording = daemon.upload(csv(300_000)).json["id"]
            answers = [daemon.characterise(recording, seed=seed) for seed in range(6)]
            full = [a for a in answers if a.status == 503]
            self.assertTrue(full, [a.status for a in answers])
            self.assertIn("(budget queued_jobs = 2)", full[0].json["detail"])
            self.assertIn("retry-after", full[0].headers)


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


class ConfigurationHasOrigins(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def shown(self, *arguments: str, **environment: str) -> dict[str, dict[str, dict[str, object]]]:
        settings = {k: v for k, v in os.environ.items() if not k.startswith("DRIFTLAB_")}
        run = subprocess.run([PROGRAM, "config", "--json", *arguments], capture_output=True, text=True,
                             env={**settings, **environment}, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def refused(self, *arguments: str, **environment: str) -> str:
        settings = {k: v for k, v in os.environ.items() if not k.startswith("DRIFTLAB_")}
        run = subprocess.run([PROGRAM, "config", *arguments], capture_output=True, text=True,
                             env={**settings, **environment}, check=False)
        self.assertEqual((run.returncode, run.stdout), (2, ""), run.stderr)
        return run.stderr

    def test_flag_over_variable_over_file_over_default(self) -> None:
        file = self.folder / "driftlabd.toml"
        file.write_text('workers = 3\nio_threads = 4\nthreads = 5\nallow_host = ["a", "b"]\n[budgets]\nuploads = 7\nlabels = 9\n')
        found = self.shown("--config", str(file), "--workers", "6", "--budget", "labels=10", DRIFTLAB_IO_THREADS="8", DRIFTLAB_BUDGET_UPLOADS="11")
        told = {name: (entry["value"], entry["origin"]) for part in found.values() for name, entry in part.items()}
        self.assertEqual(told["workers"], (6, "flag --workers"))
        self.assertEqual(told["io_threads"], (8, "variable DRIFTLAB_IO_THREADS"))
        self.assertEqual(told["threads"], (5, f"file {file}"))
        self.assertEqual(told["allow_host"], (["a", "b"], f"file {file}"))
        self.assertEqual(told["listen"], ("127.0.0.1:8477", "default"))
        self.assertEqual(told["uploads"], (11, "variable DRIFTLAB_BUDGET_UPLOADS"))
        self.assertEqual(told["labels"], (10, "flag --budget"))

    def test_what_it_prints_can_be_read_again(self) -> None:
        printed = subprocess.run([PROGRAM, "config", "--workers", "2"], capture_output=True, check=True, text=True).stdout
        file = self.folder / "again.toml"
        file.write_text(printed)
        self.assertEqual(self.shown("--config", str(file))["settings"]["workers"]["value"], 2)

    def test_what_is_not_known_or_impossible_is_one_sentence(self) -> None:
        def write(text: str) -> str:
            (self.folder / "bad.toml").write_text(text)
            return str(self.folder / "bad.toml")
        self.assertIn("no setting 'colour'", self.refused("--config", write("colour = 1\n")))
        self.assertIn("no setting 'budgets.colour'", self.refused("--config", write("[budgets]\ncolour = 1\n")))
        self.assertIn("no TOML at line 2", self.refused("--config", write("workers = 1\n= 3\n")))
        self.assertIn("does not exist", self.refused("--config", str(self.folder / "absent.toml")))
        self.assertIn("from 0 to 256", self.refused("--workers", "many"))
        self.assertIn("from 1 to 10000", self.refused("--budget", "uploads=0"))
        self.assertIn("NAME=VALUE", self.refused("--budget", "uploads"))
        self.assertIn("no setting 'budgets.colour'", self.refused(DRIFTLAB_BUDGET_COLOUR="1"))
        self.assertIn("debug, info, warning or error", self.refused("--log-level", "loud"))


if __name__ == "__main__":
    unittest.main()
