"""What an operator does: watch, run under a service manager, behind a proxy, on a full disk; and what is offered to do it with (deploy/)."""
from __future__ import annotations

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest
import urllib.parse
import urllib.request
from pathlib import Path

from daemon import PATIENCE_S, STORE, Daemon
from events_test import stream
from operating import csv, free_port, tool
from suite import DaemonTest

SOURCE = Path(__file__).resolve().parents[2]
SLOW = 10 if os.environ.get("DRIFTLAB_SANITIZE") else 1


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

    def test_the_time_of_requests_is_the_daemons_own(self) -> None:
        with stream(self.daemon):
            time.sleep(1.5 * SLOW)
        with socket.create_connection(("127.0.0.1", self.daemon.port)) as slow:
            slow.sendall(b"POST /v1/devices HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 16\r\nConnection: close\r\n\r\n")
            time.sleep(1.5 * SLOW)
            slow.sendall(b'{"name": "slow"}')
            self.assertIn(b" 201 ", slow.recv(100))
        job = self.expect(202, self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 5000})).json["id"]
        self.assertEqual(self.daemon.get(f"/v1/jobs/{job}", Prefer=f"wait={2 * SLOW}").json["state"], "running")
        self.daemon.post(f"/v1/jobs/{job}/cancel", {})
        ended = time.monotonic() + PATIENCE_S
        counts = {}
        while time.monotonic() < ended and 'route="/v1/events"' not in str(counts):  # counted when the daemon sees that nobody reads
            page = self.daemon.get("/metrics").text
            counts = dict(re.findall(r'^(driftlab_http_request_seconds_(?:bucket|count){.*}) (.*)$', page, re.MULTILINE))
            time.sleep(0.1)
        for route in ("/v1/events", "/v1/devices", "/v1/jobs/{id}"):
            within = counts[f'driftlab_http_request_seconds_bucket{{route="{route}",le="1"}}']
            self.assertEqual(within, counts[f'driftlab_http_request_seconds_count{{route="{route}"}}'], route)

    def test_what_it_writes_is_for_its_user_alone(self) -> None:
        self.expect(201, self.daemon.upload(csv(2000, 3)))
        files = [path for path in self.daemon.data.rglob("*") if path.is_file()]
        self.assertGreater(len(files), 3)
        self.assertEqual([str(path) for path in files if path.stat().st_mode & 0o077], [])

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

    def test_the_alert_of_old_backups_goes_by_the_time_of_the_timer(self) -> None:
        """After twice that time, whatever it is; never where backups are made only when asked."""
        rules = SOURCE / "deploy/prometheus/driftlab.rules.yml"
        def series(name: str, instance: str, values: str) -> dict[str, str]:
            return {"series": f'{name}{{job="driftlab",instance="{instance}"}}', "values": values}
        def alerts(hours: int, *expected: str) -> dict[str, object]:
            days = f"{hours // 24}d " if hours >= 24 else ""
            told = f"driftlab on {{}} has had no sound backup for {days}{hours % 24}h 0m 0s; /readyz and the log say why."
            return {"eval_time": f"{hours}h", "alertname": "DriftlabBackupOld",
                    "exp_alerts": [{"exp_labels": {"severity": "warn", "job": "driftlab", "instance": each},
                                    "exp_annotations": {"summary": told.format(each)}} for each in expected]}
        periods = {"often": 6, "daily": 24, "asked": 0}
        given = [series("driftlab_backup_age_seconds", each, "0+3600x80") for each in periods]
        given += [series("driftlab_backup_period_seconds", each, f"{3600 * hours}x80") for each, hours in periods.items()]
        told = [alerts(12), alerts(13, "often"), alerts(48, "often"), alerts(49, "often", "daily")]
        document = {"rule_files": [str(rules)], "evaluation_interval": "1h",
                    "tests": [{"interval": "1h", "input_series": given, "alert_rule_test": told}]}
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "test.yml").write_text(json.dumps(document))  # JSON is YAML
            tested = tool("promtool", "test", "rules", f"{folder}/test.yml")
        self.assertEqual(tested.returncode, 0, tested.stdout + tested.stderr)


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


class OnAFullDisk(unittest.TestCase):
    @unittest.skipUnless(os.geteuid() == 0, "SKIPPED: mounting a small disk needs root")
    def test_removing_works_on_a_full_disk(self) -> None:
        disk = Path(self.enterContext(tempfile.TemporaryDirectory())) / "disk"
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
