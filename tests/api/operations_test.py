"""What an operator does: watch, stop, reload, check, back up, restore; and what is offered to do it with (deploy/)."""
from __future__ import annotations

import http.client
import json
import os
import re
import resource
import shutil
import signal
import socket
import sqlite3
import subprocess
import tempfile
import threading
import time
import unittest
import urllib.parse
import urllib.request
from contextlib import closing
from pathlib import Path
from typing import Any

import samples
from daemon import PATIENCE_S, PROGRAM, STORE, Daemon
from suite import DaemonTest

SOURCE = Path(__file__).resolve().parents[2]
SLOW = 10 if os.environ.get("DRIFTLAB_SANITIZE") else 1


def csv(rows: int, seed: int = 1) -> bytes:
    return ("t [s],gz [deg/s]\n" + "".join(f"{i / 100:.2f},{(i * 7919 + seed * 131) % 101 / 100:.2f}\n" for i in range(rows))).encode()


def tool(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE_S, check=False)


def free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


class Watched(DaemonTest):
    def test_metrics_are_those_of_prometheus_and_bounded(self) -> None:
        recording = self.expect(201, self.daemon.upload(csv(2000))).json["id"]
        self.daemon.finished(self.daemon.characterise(recording).json["id"])
        for i in range(50):
            self.daemon.get(f"/v1/devices/nobody-{i}")
            self.daemon.get(f"/no/such/{i}")
        self.daemon.exchange(b"BREW / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        page = self.expect(200, self.daemon.get("/metrics"))
        self.assertEqual(page.headers["content-type"], "text/plain; version=0.0.4; charset=utf-8")
        self.assertIn('driftlab_job_attempts_total{kind="characterise",outcome="succeeded"} 1', page.text)
        self.assertIn('driftlab_http_requests_total{method="GET",route="/v1/devices/{id}",status="4xx"} 50', page.text)
        self.assertIn('method="other"', page.text)
        self.assertNotIn("nobody-", page.text)
        self.assertIn("driftlab_recordings 1\n", page.text)
        self.assertIn("driftlab_ready 1\n", page.text)
        self.assertIn("driftlab_http_requests_in_flight 1\n", page.text, "this one")
        self.assertIn("driftlab_jobs_dead_total 0\n", page.text)
        self.assertIn(f"driftlab_blob_bytes {len(csv(2000))}\n", page.text)
        values = dict(line.rsplit(" ", 1) for line in page.text.splitlines() if not line.startswith("#"))
        self.assertGreater(float(values["driftlab_store_write_seconds_count"]), 3)
        self.assertGreater(float(values["driftlab_store_write_seconds_sum"]), 0)
        self.assertEqual(values['driftlab_store_write_seconds_bucket{le="+Inf"}'], values["driftlab_store_write_seconds_count"])
        if not STORE:
            self.assertGreater(float(values["driftlab_store_log_pages"]), 0)
        self.assertEqual({float(value) for name, value in values.items() if name.startswith("driftlab_bad_states{")}, {0.0})
        if shutil.which("promtool") is None:
            self.skipTest("SKIPPED: promtool (package prometheus) is not here")
        checked = subprocess.run(["promtool", "check", "metrics"], input=page.text, capture_output=True, text=True, check=False)
        self.assertEqual((checked.returncode, checked.stderr), (0, ""), checked.stdout)

    def test_every_log_line_is_an_object_and_names_its_request(self) -> None:
        self.daemon.get("/healthz", X_Request_Id="seen-in-the-log")
        entry = self.daemon.logged(event="request", request_id="seen-in-the-log")
        self.assertEqual((entry["route"], entry["status"], entry["method"]), ("/healthz", 200, "GET"))
        self.assertFalse([line for line in self.daemon.log if "raw" in line])


@unittest.skipUnless(shutil.which("prometheus") and shutil.which("promtool"), "SKIPPED: prometheus is not here")
class WithPrometheus(unittest.TestCase):
    def test_alerts_and_figures_ask_for_what_is_there(self) -> None:
        rules = SOURCE / "deploy/prometheus/driftlab.rules.yml"
        checked = tool("promtool", "check", "rules", str(rules))
        self.assertEqual(checked.returncode, 0, checked.stderr)
        queries = re.findall(r"^ +expr: (.+)$", rules.read_text(), re.MULTILINE)
        board = json.loads((SOURCE / "deploy/grafana/driftlab.json").read_text())
        queries += [target["expr"] for panel in board["panels"] for target in panel["targets"]]
        self.assertGreater(len(queries), 30)
        deaf = ("--webhook-allow", "127.0.0.1", "--budget", "webhook_pause_milliseconds=1", "--budget", "webhook_attempts=7")
        with tempfile.TemporaryDirectory() as folder, Daemon(arguments=(*deaf, "--backups", f"{folder}/backups")) as daemon:
            recording = daemon.upload(csv(2000)).json["id"]
            daemon.finished(daemon.characterise(recording).json["id"])
            port = free_port()
            shutil.copy(rules, folder)
            config = (SOURCE / "deploy/prometheus/prometheus.yml").read_text().replace("127.0.0.1:8477", f"127.0.0.1:{daemon.port}")
            (Path(folder) / "prometheus.yml").write_text("global: {scrape_interval: 1s, evaluation_interval: 1s}\n" + config)
            server = subprocess.Popen(["prometheus", f"--config.file={folder}/prometheus.yml", f"--storage.tsdb.path={folder}/data",
                                       f"--web.listen-address=127.0.0.1:{port}", "--log.level=error"],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                def ask(query: str) -> list[object]:
                    with urllib.request.urlopen(f"http://127.0.0.1:{port}/api/v1/query?" + urllib.parse.urlencode({"query": query}), timeout=10) as answer:
                        document = json.load(answer)
                    self.assertEqual(document["status"], "success", query)
                    return list(document["data"]["result"])
                until = time.monotonic() + 30 * SLOW
                while time.monotonic() < until:
                    try:
                        if len(ask("count_over_time(driftlab_ready[1m]) >= 3")) == 1:
                            break
                    except OSError:
                        pass
                    time.sleep(0.2)
                self.assertEqual(len(ask('up{job="driftlab"} == 1')), 1, "the scrape succeeds")
                known = set(re.findall(r"^# TYPE (\w+)", daemon.get("/metrics").text, re.MULTILINE))
                for query in queries:
                    ask(query)
                    for name in re.findall(r"\bdriftlab_\w+", query):
                        self.assertIn(re.sub(r"_(bucket|sum|count)$", "", name), known, query)
                    if not re.search(r"[<>]|== 0", query):  # figures show something; alerts must not
                        self.assertTrue(ask(query), query)
                alerts = dict(re.findall(r"- alert: (\w+)\n +expr: (.+)", rules.read_text()))
                missed = [alerts[name] for name in ("DriftlabWebhooksFail", "DriftlabWebhookGivenUp")]
                self.assertEqual([ask(query) for query in missed], [[], []])
                hook = daemon.post("/v1/webhooks", {"url": f"http://127.0.0.1:{free_port()}/nobody"}).json["id"]
                self.assertEqual(daemon.post(f"/v1/webhooks/{hook}/test").status, 202)
                until = time.monotonic() + 30 * SLOW
                while time.monotonic() < until and not all(ask(query) for query in missed):
                    time.sleep(0.5)
                for query in missed:
                    self.assertTrue(ask(query), query)
            finally:
                server.terminate()
                server.wait(PATIENCE_S)


class OffersForOperators(unittest.TestCase):
    @unittest.skipUnless(shutil.which("systemd-analyze"), "SKIPPED: systemd-analyze is not here")
    def test_the_unit_is_closed(self) -> None:
        said = tool("systemd-analyze", "security", "--offline=true", str(SOURCE / "deploy/systemd/driftlabd.service"))
        found = re.search(r"Overall exposure level for driftlabd.service: ([\d.]+)", said.stdout)
        assert found, said.stdout + said.stderr
        self.assertLess(float(found.group(1)), 2.0)


class Manager:
    """The socket of a service manager (sd_notify(3))."""

    def __init__(self, folder: Path) -> None:
        self.name = folder / "notify"
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(str(self.name))
        self.socket.settimeout(PATIENCE_S)

    def next_but(self, *ignored: str) -> str:
        while (said := self.socket.recv(4096).decode()) in ignored:
            pass
        return said


class UnderAServiceManager(unittest.TestCase):
    def test_it_says_how_it_stands_and_that_it_is_alive(self) -> None:
        manager = Manager(Path(self.enterContext(tempfile.TemporaryDirectory())))
        self.addCleanup(manager.socket.close)
        with Daemon(environment={"NOTIFY_SOCKET": str(manager.name), "WATCHDOG_USEC": "800000"}) as daemon:
            self.assertEqual(manager.next_but("WATCHDOG=1"), "READY=1")
            self.assertEqual([manager.next_but() for _ in range(3)], ["WATCHDOG=1"] * 3)
            daemon.process.send_signal(signal.SIGHUP)
            self.assertEqual([manager.next_but("WATCHDOG=1") for _ in range(2)], ["RELOADING=1", "READY=1"])
            daemon.process.send_signal(signal.SIGTERM)
            self.assertEqual(manager.next_but("WATCHDOG=1"), "STOPPING=1")
            self.assertEqual(daemon.wait(), 0)

    def test_without_a_watchdog_it_says_nothing_of_its_life(self) -> None:
        manager = Manager(Path(self.enterContext(tempfile.TemporaryDirectory())))
        self.addCleanup(manager.socket.close)
        for more in ({}, {"WATCHDOG_USEC": "100000", "WATCHDOG_PID": "1"}):
            with Daemon(environment={"NOTIFY_SOCKET": str(manager.name), **more}) as daemon:
                time.sleep(0.5)
                self.assertEqual(daemon.terminate(), 0)
            self.assertEqual([manager.next_but() for _ in range(2)], ["READY=1", "STOPPING=1"])


class BehindAProxy(unittest.TestCase):
    SAID = {"Forwarded": 'for=198.51.100.1, for="203.0.113.9:4711";proto=https', "X-Forwarded-For": "198.51.100.2"}

    def test_the_address_is_the_one_that_a_listed_proxy_names(self) -> None:
        for arguments, address in ((("--proxies", "127.0.0.1"), "203.0.113.9"), ((), "127.0.0.1"), (("--proxies", "192.0.2.1"), "127.0.0.1")):
            with self.subTest(arguments=arguments), Daemon(arguments=arguments) as daemon:
                daemon.request("POST", "/v1/devices", {"name": "behind"}, {**self.SAID, "X-Request-Id": "forwarded"})
                self.assertEqual(daemon.logged(event="request", request_id="forwarded")["address"], address)
                [row] = [row for row in daemon.items("/v1/audit") if row["action"] == "device.create"]
                self.assertEqual(row["address"], address)

    def test_budgets_are_those_of_whoever_is_behind_it(self) -> None:
        """One client with an upload that stands still; another one's of the same proxy is taken all the same."""
        narrow = ("--proxies", "127.0.0.1", "--budget", "uploads_per_address=1", "--budget", "upload_wait_seconds=1")
        with Daemon(arguments=narrow) as daemon:
            def upload(seed: int, address: str) -> int:
                return daemon.upload(csv(200, seed), headers={"Forwarded": f"for={address}"}).status
            with daemon.connect() as slow:
                slow.sendall(b"POST /v1/recordings?device=slow&condition=static HTTP/1.1\r\nHost: localhost\r\nForwarded: for=203.0.113.9\r\n"
                             b"Content-Type: application/octet-stream\r\nContent-Length: 100000\r\n\r\nt [s],gz [deg/s]\n")
                until = time.monotonic() + 30
                while "driftlab_uploads_running 1\n" not in daemon.get("/metrics").text and time.monotonic() < until:
                    time.sleep(0.02)
                self.assertEqual(upload(1, "203.0.113.9"), 503, "its own budget is used up")
                self.assertEqual(upload(2, "203.0.113.10"), 201)


class Stops(unittest.TestCase):
    def test_not_ready_is_said_before_the_door_closes(self) -> None:
        with Daemon(arguments=("--budget", "drain_milliseconds=1500")) as daemon:
            self.assertEqual(daemon.get("/readyz").status, 200)
            daemon.process.send_signal(signal.SIGTERM)
            daemon.logged(event="stopping")
            answer = daemon.get("/readyz")
            self.assertEqual(answer.status, 503)
            self.assertIn("stopping", answer.json["detail"])
            self.assertEqual(daemon.get("/healthz").status, 200)
            begun = time.monotonic()
            self.assertEqual(daemon.wait(), 0)
            self.assertLess(time.monotonic() - begun, 10)

    def test_it_stops_in_time_though_nobody_reads_its_log(self) -> None:
        read, write = os.pipe()
        port = free_port()
        with tempfile.TemporaryDirectory() as folder:
            process = subprocess.Popen([PROGRAM, "--data", folder, "--listen", f"127.0.0.1:{port}", "--log-level", "debug",
                                        "--budget", "stop_seconds=5"], stderr=write, stdin=subprocess.DEVNULL)
            os.close(write)
            for _ in range(200):
                try:
                    http.client.HTTPConnection("127.0.0.1", port, timeout=5).request("GET", "/healthz")
                    break
                except OSError:
                    time.sleep(0.05)
            for _ in range(600):  # more lines than a pipe holds, and nobody takes them
                connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
                connection.request("GET", "/healthz?" + "x" * 300)
                connection.getresponse().read()
                connection.close()
            begun = time.monotonic()
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(30), 0)
            self.assertLess(time.monotonic() - begun, 6.5)
        os.close(read)

    def test_cancel_takes_a_second_and_stopping_ten_whatever_runs(self) -> None:
        with Daemon(arguments=("--workers", "2")) as daemon:
            recordings = [daemon.upload(csv(400_000, seed), device="d").json["id"] for seed in range(2)]
            study = daemon.post("/v1/studies", {"device": {"id": "d"}, "recordings": [{"id": f"r{i}", "recording": r} for i, r in enumerate(recordings)]}).json["id"]
            scenario = json.loads((SOURCE / "tests/api/long_drive.json").read_text())
            # Of a long recording the search of lines and what it held out ran on for seconds (tests/bench/cancel_times.py has every kind).
            rows = samples.npy([column * 60 for column in samples.noise(20_000, 3)])
            long = daemon.upload(rows, device="long", rate_hz=100, columns=",".join(f"{i}=angular_rate:{'xyz'[i]}:deg/s" for i in range(3)))
            self.assertEqual(long.status, 201, long.describe())
            long_study = daemon.post("/v1/studies", {"device": {"id": "long"}, "recordings": [{"id": "r", "recording": long.json["id"]}]}).json["id"]
            kinds = {"characterise": {"recordings": recordings}, "investigate": {"study": study}, "outage_evaluation": {"scenario": scenario}}
            slowest = {}
            for name, kind, inputs in (*((kind, kind, inputs) for kind, inputs in kinds.items()), ("investigate 1.2 million rows", "investigate", {"study": long_study})):
                worst = 0.0
                for wait in (0.05, 0.5, 2.0):
                    queued = daemon.post("/v1/jobs", {"kind": kind, "inputs": inputs})
                    self.assertIn(queued.status, {200, 202}, queued.describe())
                    job = queued.json["id"]
                    until = time.monotonic() + PATIENCE_S
                    while daemon.get(f"/v1/jobs/{job}").json["state"] == "queued" and time.monotonic() < until:
                        time.sleep(0.01)
                    time.sleep(wait)
                    begun = time.monotonic()
                    daemon.post(f"/v1/jobs/{job}/cancel")
                    ended = daemon.finished(job)
                    worst = max(worst, time.monotonic() - begun)
                    if ended["state"] == "succeeded":
                        break
                slowest[name] = worst
            print("longest cancel:", {kind: f"{seconds:.2f} s" for kind, seconds in slowest.items()})
            self.assertTrue(all(seconds < 1.0 * SLOW + 0.5 for seconds in slowest.values()), slowest)
            for kind in ("investigate", "outage_evaluation"):
                daemon.post("/v1/jobs", {"kind": kind, "inputs": kinds[kind]})
            time.sleep(1.0)
            begun = time.monotonic()
            self.assertEqual(daemon.terminate(), 0)
            self.assertLess(time.monotonic() - begun, 10)

    def test_a_closed_standard_error_keeps_log_lines_out_of_data(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            port = free_port()
            process = subprocess.Popen(["sh", "-c", f'exec "{PROGRAM}" --data {folder} --listen 127.0.0.1:{port} --log-level debug 2>&-'], stdin=subprocess.DEVNULL)
            for _ in range(200):
                try:
                    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
                    connection.request("GET", "/v1/devices")
                    connection.getresponse().read()
                    break
                except OSError:
                    time.sleep(0.05)
            opened = {os.readlink(f"/proc/{process.pid}/fd/{n}") for n in (0, 1, 2)}
            process.terminate()
            self.assertEqual(process.wait(30), 0)
            self.assertIn("/dev/null", opened)
            self.assertFalse(any(folder in name for name in opened), opened)
            for file in Path(folder).rglob("*"):
                if file.is_file():
                    self.assertNotIn(b'"event":', file.read_bytes(), file)

    def test_a_limit_of_file_size_is_an_answer_not_the_end(self) -> None:
        def small_files() -> None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (20_000_000, 20_000_000))
        with Daemon(arguments=("--budget", "reserve_bytes=0"), before_exec=small_files) as daemon:
            answer = daemon.upload(b"0.5,0.25\n" * 3_000_000)
            self.assertEqual(answer.status, 507, answer.describe())
            self.assertEqual(daemon.upload(csv(200)).status, 201)

    def test_the_log_file_is_opened_again_at_sighup(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "driftlab.log"
            port = free_port()
            process = subprocess.Popen([PROGRAM, "--data", f"{folder}/data", "--listen", f"127.0.0.1:{port}", "--log-file", str(log)])
            def wait_for(text: str) -> None:
                until = time.monotonic() + PATIENCE_S
                while time.monotonic() < until and not (log.exists() and text in log.read_text()):
                    time.sleep(0.02)
                self.assertIn(text, log.read_text())
            wait_for('"listening"')
            log.rename(Path(folder) / "driftlab.log.1")
            process.send_signal(signal.SIGHUP)
            wait_for('"reloaded"')
            self.assertIn('"listening"', (Path(folder) / "driftlab.log.1").read_text())
            process.terminate()
            self.assertEqual(process.wait(30), 0)
            self.assertIn('"stopped"', log.read_text())


def flip(path: Path, at: int = -100) -> None:
    content = bytearray(path.read_bytes())
    content[at] ^= 4
    path.chmod(0o600)
    path.write_bytes(bytes(content))


class Kept(unittest.TestCase):
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

    def test_a_flipped_bit_in_the_problem_of_a_job_is_not_shown(self) -> None:
        """Of a failed job and of one that succeeded: answered by its name, listed as damaged, told once and by `check`."""
        scrubbing = ("--budget", "scrub_bytes_per_second=0")
        with Daemon(self.folder / "data", arguments=scrubbing) as daemon:
            short = daemon.upload(csv(3), id="short").json["id"]
            failed = daemon.finished(daemon.characterise(short).json["id"])
            self.assertEqual(failed["state"], "failed")
            sound = daemon.finished(daemon.characterise(short, seed=2).json["id"])
            evaluation = daemon.finished(daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 100}).json["id"])["id"]
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

    @unittest.skipUnless(os.geteuid() == 0, "SKIPPED: mounting a small disk needs root")
    def test_removing_works_on_a_full_disk(self) -> None:
        disk = self.folder / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=24m", "tmpfs", str(disk)], check=False, capture_output=True).returncode != 0:
            self.skipTest("SKIPPED: no tmpfs can be mounted")
        try:
            with Daemon(disk / "data", arguments=("--budget", "reserve_bytes=4194304", "--budget", "least_free_bytes=0")) as daemon:
                made = [daemon.upload(csv(20_000, seed), device=f"d{seed}") for seed in range(3)]
                self.assertTrue(all(answer.status == 201 for answer in made))
                until = time.monotonic() + 30
                while not (disk / "data/reserve").exists() and time.monotonic() < until:
                    time.sleep(0.1)
                self.assertTrue((disk / "data/reserve").exists())
                filler = os.open(disk / "filler", os.O_WRONLY | os.O_CREAT)
                try:
                    while True:
                        os.write(filler, b"\0" * 4096)
                except OSError:
                    os.close(filler)
                self.assertEqual(daemon.upload(csv(20_000, 9)).status, 507)
                for answer in made:
                    target = f"/v1/recordings/{answer.json['id']}"
                    gone = daemon.request("DELETE", target, headers={"If-Match": "*"})
                    self.assertEqual(gone.status, 204, gone.describe())
                self.assertEqual(daemon.items("/v1/recordings"), [])
        finally:
            subprocess.run(["umount", "-l", str(disk)], check=False)


if __name__ == "__main__":
    unittest.main()
