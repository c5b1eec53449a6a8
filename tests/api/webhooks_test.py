"""Webhooks: who is told what and when, that a signature holds, that messages survive the daemon, and where they may not lead."""
from __future__ import annotations

import http.client
import json
import os
import signal
import socket
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path
from typing import Any

import samples
from daemon import PROGRAM, Daemon
from receiver import Message, Receiver
from suite import DaemonTest

LOST = (http.client.HTTPException, OSError)  # what a client sees of a daemon that dies
QUICK = ("--webhook-allow", "127.0.0.1", "--budget", "webhook_pause_milliseconds=20")


def settled(daemon: Daemon, webhook: str, count: int = 1) -> list[dict[str, Any]]:
    """The deliveries of a webhook once there are so many and none waits."""
    until = time.monotonic() + 60
    while time.monotonic() < until:
        found = daemon.items(f"/v1/webhooks/{webhook}/deliveries")
        if len(found) >= count and all(one["state"] != "waiting" for one in found):
            return found
        time.sleep(0.02)
    raise AssertionError(f"not settled: {found}")


class Telling(DaemonTest):
    arguments = QUICK

    def hook(self, receiver: Receiver, **more: Any) -> dict[str, Any]:
        made = self.expect(201, self.daemon.post("/v1/webhooks", {"url": receiver.url, **more}))
        self.addCleanup(self.daemon.request, "DELETE", made.headers["location"], headers={"If-Match": "*"})
        return dict(made.json)

    def recording(self, seed: int) -> str:
        return str(self.daemon.upload(samples.gyro_csv(seed=seed), rate_hz=100, columns=samples.GYRO_Z).json["id"])

    def test_the_end_of_a_job_is_told_with_a_signature_that_holds(self) -> None:
        with Receiver() as receiver:
            hook = self.hook(receiver)
            self.assertRegex(hook["secret"], r"^whsec_[A-Za-z0-9+/]{43}=$")
            job = self.daemon.finished(self.daemon.characterise(self.recording(1), models=["WN"]).json["id"])
            [message] = receiver.wait(1)
            message.verify(hook["secret"])
            self.assertEqual((message.path, message.headers["content-type"]), ("/hook", "application/json"))
            self.assertTrue(message.headers["user-agent"].startswith("driftlab/"))
            self.assertEqual(message.document, {"type": "job.ended", "timestamp": job["finished_at"], "data": {
                "job": job["id"], "kind": "characterise", "state": "succeeded", "attempt": 1, "devices": ["phone-07"],
                "href": f"/v1/jobs/{job['id']}", "result": f"/v1/jobs/{job['id']}/result", "problem": None}})
            [delivery] = settled(self.daemon, hook["id"])
            self.assertEqual((delivery["id"], delivery["state"], delivery["attempts"], delivery["last_status"], delivery["message"]),
                             (message.id, "delivered", 1, 204, message.document))
            self.daemon.finished(self.daemon.characterise(self.recording(1), models=["WN"]).json["id"])  # the same job: told once
            self.assertEqual(len(receiver.messages), 1)

    def test_regressions_and_investigations_have_events_of_their_own(self) -> None:
        with Receiver() as all_of_them, Receiver() as regressions:
            everything, own = self.hook(all_of_them), self.hook(regressions, events=["regression.ended"])
            made = [self.recording(seed) for seed in (11, 12)]
            for recording in made:
                self.daemon.finished(self.daemon.characterise(recording, models=["WN"]).json["id"])
            arms = {name: {"recordings": [{"recording": one}]} for name, one in zip(("baseline", "candidate"), made)}
            run = self.daemon.finished(self.daemon.post("/v1/jobs", {"kind": "regress", "inputs": {"device": "phone-07", **arms}}).json["id"])
            [message] = regressions.wait(1)
            message.verify(own["secret"])
            verdict = self.daemon.get(f"/v1/regressions/{run['id']}").json["verdict"]
            self.assertEqual((message.document["type"], message.document["data"]["verdict"], message.document["data"]["result"]),
                             ("regression.ended", verdict, f"/v1/regressions/{run['id']}"))
            self.assertIn(verdict, ("pass", "fail", "inconclusive"))
            study = self.daemon.post("/v1/studies", {"device": {"id": "phone-07"}, "recordings": [{"recording": made[0]}]}).json["id"]
            self.daemon.finished(self.daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study}}).json["id"])
            last = all_of_them.wait(4)[-1]
            last.verify(everything["secret"])
            self.assertEqual(last.document["type"], "investigation.ended")
            self.expect(200, self.daemon.get(last.document["data"]["result"]))
            self.assertEqual(last.document["data"]["result"], "/v1/investigations/" + last.document["data"]["investigation"])
            self.assertEqual(len(regressions.messages), 1)

    def test_a_job_that_is_cancelled_is_told_too(self) -> None:
        with Receiver() as receiver:
            self.hook(receiver, events=["job.ended"])
            job = self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 20000}).json["id"]
            self.expect(202, self.daemon.post(f"/v1/jobs/{job}/cancel"))
            [message] = receiver.wait(1)
            data = message.document["data"]
            self.assertEqual((data["job"], data["state"], data["result"], data["devices"]), (job, "cancelled", None, []))

    def test_what_did_not_arrive_is_sent_again_with_the_same_id(self) -> None:
        answers = [(500, {}), (302, {"Location": "http://127.0.0.1:1/"}), (404, {}), (429, {"Retry-After": "1"})]
        with Receiver(*answers) as receiver:
            hook = self.hook(receiver)
            queued = self.expect(202, self.daemon.post(f"/v1/webhooks/{hook['id']}/test")).json
            messages = receiver.wait(5)
            self.assertEqual({message.id for message in messages}, {queued["id"]})
            for message in messages:
                message.verify(hook["secret"])
                self.assertEqual(message.path, "/hook")  # no redirect was followed
            self.assertEqual(messages[0].document["type"], "webhook.test")
            self.assertGreaterEqual(messages[4].at - messages[3].at, 1.0)  # Retry-After
            [delivery] = settled(self.daemon, hook["id"])
            self.assertEqual((delivery["state"], delivery["attempts"]), ("delivered", 5))

    def test_gone_is_gone(self) -> None:
        with Receiver((410, {})) as receiver:
            hook = self.hook(receiver)
            self.daemon.post(f"/v1/webhooks/{hook['id']}/test")
            receiver.wait(1)
            [delivery] = settled(self.daemon, hook["id"])
            self.assertEqual((delivery["state"], delivery["last_status"]), ("given_up", 410))
            now = self.expect(200, self.daemon.get(f"/v1/webhooks/{hook['id']}"))
            self.assertFalse(now.json["enabled"])
            self.assertIn("410", now.json["disabled_why"])
            self.problem(409, "conflict", self.daemon.post(f"/v1/webhooks/{hook['id']}/test"))
            self.daemon.finished(self.daemon.characterise(self.recording(21), models=["WN"]).json["id"])
            changed = self.daemon.request("PATCH", f"/v1/webhooks/{hook['id']}", {"enabled": True}, {"If-Match": now.headers["etag"]})
            self.assertTrue(self.expect(200, changed).json["enabled"])
            self.daemon.post(f"/v1/webhooks/{hook['id']}/test")
            self.assertEqual(receiver.wait(2)[1].document["type"], "webhook.test")
            self.assertEqual(self.daemon.logged(event="webhook disabled", webhook=hook["id"])["level"], "warning")

    def test_two_secrets_sign_while_one_takes_over_from_the_other(self) -> None:
        with Receiver() as receiver:
            hook = self.hook(receiver)
            fresh = self.expect(200, self.daemon.post(f"/v1/webhooks/{hook['id']}/rotate"))
            self.assertEqual(fresh.headers["cache-control"], "no-store")
            self.daemon.post(f"/v1/webhooks/{hook['id']}/test")
            receiver.wait(1)[0].verify(hook["secret"], fresh.json["secret"])
            third = self.daemon.post(f"/v1/webhooks/{hook['id']}/rotate").json["secret"]
            self.daemon.post(f"/v1/webhooks/{hook['id']}/test")
            receiver.wait(2)[1].verify(fresh.json["secret"], third)  # the first has ended

    def test_the_secret_is_shown_once_and_never_logged(self) -> None:
        with Receiver() as receiver:
            hook = self.hook(receiver, description="pipeline")
            for target in ("/v1/webhooks", f"/v1/webhooks/{hook['id']}", f"/v1/webhooks/{hook['id']}/deliveries", "/v1/audit"):
                self.assertNotIn(hook["secret"], self.daemon.get(target).text)
            self.assertNotIn(hook["secret"], json.dumps(self.daemon.log))
            refused = self.daemon.post("/v1/webhooks", {"url": receiver.url}, {"Idempotency-Key": "k"})
            self.problem(400, "invalid_argument", refused, parameter="Idempotency-Key")
            actions = [row["action"] for row in self.daemon.items("/v1/audit") if row["object"] == hook["id"]]
            self.assertEqual(actions, ["webhook.create"])
            self.assertIn("driftlab_webhook_attempts_total", self.daemon.get("/metrics").text)

    def test_what_a_webhook_may_be(self) -> None:
        good = {"url": "https://ci.example.org/hook"}
        for body, pointer in (({}, "/url"), ({"url": 7}, "/url"), ({"url": "ci.example.org"}, "/url"), ({"url": "http://ci.example.org/"}, "/url"),
                              ({"url": "https://u:p@ci.example.org/"}, "/url"), ({"url": "https://169.254.169.254/"}, "/url"),
                              ({**good, "events": []}, "/events"),
                              ({**good, "events": ["job.began"]}, "/events"), ({**good, "events": ["job.ended", "job.ended"]}, "/events"),
                              ({**good, "secret": "whsec_AAAA"}, "/secret"), ({**good, "description": 1}, "/description")):
            document = self.expect(400, self.daemon.post("/v1/webhooks", body)).json
            self.assertIn(pointer, [error["pointer"] for error in document["errors"]], body)
        self.problem(413, "limit_exceeded", self.daemon.post("/v1/webhooks", {"url": "https://ci.example.org/" + "x" * 5000}))
        made = self.expect(201, self.daemon.post("/v1/webhooks", good))
        target = made.headers["location"]
        self.problem(428, "precondition_required", self.daemon.request("PATCH", target, {"description": "a"}))
        self.problem(428, "precondition_required", self.daemon.request("DELETE", target))
        self.expect(400, self.daemon.request("PATCH", target, {"enabled": "yes"}, {"If-Match": "*"}))
        self.expect(200, self.daemon.request("PATCH", target, {"description": "a", "events": ["job.ended"]}, {"If-Match": made.headers["etag"]}))
        self.problem(412, "precondition_failed", self.daemon.request("DELETE", target, headers={"If-Match": made.headers["etag"]}))
        self.expect(204, self.daemon.request("DELETE", target, headers={"If-Match": "*"}))
        for gone in (target, target + "/deliveries"):
            self.problem(404, "not_found", self.daemon.get(gone))
        self.problem(400, "invalid_argument", self.daemon.get(f"{target}/deliveries?state=lost"), parameter="state")


class Bounds(unittest.TestCase):
    def test_a_receiver_that_does_not_listen_is_given_up_and_disabled(self) -> None:
        arguments = (*QUICK, "--budget", "webhook_attempts=3", "--budget", "webhook_give_ups=2", "--budget", "webhook_seconds=1", "--budget", "webhooks=1")
        with socket.create_server(("127.0.0.1", 0)) as silent, Daemon(arguments=arguments) as daemon:  # connects, and never answers
            made = daemon.post("/v1/webhooks", {"url": f"http://127.0.0.1:{silent.getsockname()[1]}/"}).json
            refused = daemon.post("/v1/webhooks", {"url": "https://ci.example.org/"}).json
            self.assertIn("budget webhooks = 1", refused["detail"])
            for _ in range(2):
                daemon.post(f"/v1/webhooks/{made['id']}/test")
            deliveries = settled(daemon, made["id"], 2)
            self.assertEqual([(d["state"], d["attempts"]) for d in deliveries], [("given_up", 3)] * 2)
            self.assertIn("it took too long", deliveries[1]["last_error"])
            self.assertIn("2 deliveries in a row were given up", daemon.get(f"/v1/webhooks/{made['id']}").json["disabled_why"])
            metrics = daemon.get("/metrics").text
            self.assertIn('driftlab_webhook_attempts_total{outcome="given_up"} 2', metrics)
            self.assertIn('driftlab_webhook_attempts_total{outcome="failed"} 4', metrics)
            self.assertIn("driftlab_webhooks_disabled 1", metrics)

    def test_one_that_is_slow_holds_up_nobody_and_a_daemon_that_stops_does_not_wait_for_it(self) -> None:
        with socket.create_server(("127.0.0.1", 0)) as silent, Receiver() as receiver, Daemon(arguments=QUICK) as daemon:
            slow = daemon.post("/v1/webhooks", {"url": f"http://127.0.0.1:{silent.getsockname()[1]}/"}).json["id"]
            quick = daemon.post("/v1/webhooks", {"url": receiver.url}).json["id"]
            daemon.post(f"/v1/webhooks/{slow}/test")
            connection, _ = silent.accept()
            with connection:
                daemon.post(f"/v1/webhooks/{quick}/test")
                receiver.wait(1)
                start = time.monotonic()
                self.assertEqual(daemon.terminate(), 0)
                self.assertLess(time.monotonic() - start, 5.0)

    def test_a_setting_that_names_nothing_is_refused(self) -> None:
        clean = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}
        with tempfile.TemporaryDirectory() as folder:
            words = [PROGRAM, "--data", folder, "--webhook-allow", "10.0.0.0/99", "--listen", "127.0.0.1:0"]
            ran = subprocess.run(words, capture_output=True, text=True, check=False, timeout=60, env=clean)
        self.assertEqual(ran.returncode, 2, ran.stderr)
        self.assertIn("webhook_allow", ran.stderr)


class Leading(unittest.TestCase):
    """Where messages may not lead: what only the daemon can reach."""

    def test_a_name_that_leads_inside_is_refused_when_it_is_resolved(self) -> None:
        with Receiver() as receiver, Daemon(arguments=("--budget", "webhook_attempts=1")) as daemon:
            port = receiver.server.server_port
            self.assertEqual(daemon.post("/v1/webhooks", {"url": receiver.url}).status, 400)  # plain http, and an address
            hook = daemon.post("/v1/webhooks", {"url": f"https://localhost:{port}/"}).json["id"]  # a name: only resolving tells
            daemon.post(f"/v1/webhooks/{hook}/test")
            [delivery] = settled(daemon, hook)
            self.assertEqual((delivery["state"], delivery["last_status"]), ("given_up", None))
            self.assertIn("leads to no address of the Internet", delivery["last_error"])
            self.assertEqual(receiver.messages, [])

    def test_a_certificate_must_be_of_the_host_and_of_an_authority_that_is_trusted(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)

            def certificate(of: str) -> tuple[str, str]:
                chain, key = str(folder / f"{of}.pem"), str(folder / f"{of}.key")
                subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-days", "2", "-subj", "/CN=test",
                                "-addext", f"subjectAltName={of}", "-keyout", key, "-out", chain, "-nodes"], check=True, capture_output=True)
                return chain, key

            mine, other = certificate("IP:127.0.0.1"), certificate("DNS:elsewhere.example")
            trusted = folder / "trusted.pem"
            trusted.write_text(Path(mine[0]).read_text() + Path(other[0]).read_text())
            for chain, trust, error in ((mine, str(trusted), None), (mine, other[0], "is not trusted"), (other, str(trusted), "is not trusted")):
                with Receiver(chain=chain) as receiver, Daemon(arguments=(*QUICK, "--budget", "webhook_attempts=1"),
                                                               environment={"SSL_CERT_FILE": trust, "SSL_CERT_DIR": name + "/none"}) as daemon:
                    hook = daemon.post("/v1/webhooks", {"url": receiver.url}).json
                    daemon.post(f"/v1/webhooks/{hook['id']}/test")
                    [delivery] = settled(daemon, hook["id"])
                    if error is None:
                        self.assertEqual(delivery["state"], "delivered", delivery)
                        receiver.messages[0].verify(hook["secret"])
                    else:
                        self.assertIn(error, delivery["last_error"])
                        self.assertEqual(receiver.messages, [])


class Lives(unittest.TestCase):
    """Nothing that ended is untold, whenever the daemon is killed."""

    def test_an_end_that_was_committed_is_told_by_the_next_daemon(self) -> None:
        with tempfile.TemporaryDirectory() as folder, Receiver() as receiver:
            data = Path(folder) / "data"
            with Daemon(data, arguments=QUICK) as daemon:
                secret = daemon.post("/v1/webhooks", {"url": receiver.url}).json["secret"]
                recording = daemon.upload(samples.gyro_csv(seed=1), rate_hz=100, columns=samples.GYRO_Z).json["id"]
                self.assertEqual(daemon.terminate(), 0)
            # No thread delivers before the process dies at this point: the finish is committed, nobody was told.
            with Daemon(data, arguments=QUICK, environment={"DRIFTLAB_CRASH_AT": "job.finished"}) as daemon:
                try:
                    daemon.finished(daemon.characterise(recording, models=["WN"]).json["id"])
                except LOST:
                    pass
                self.assertEqual(daemon.wait(), -signal.SIGKILL)
            with Daemon(data, arguments=QUICK):
                messages = receiver.wait(1)
                messages[0].verify(secret)
                self.assertEqual(messages[0].document["data"]["state"], "succeeded")
                self.assertEqual(len({message.id for message in messages}), 1)

    def test_a_webhook_whose_row_is_damaged_is_told_nothing(self) -> None:
        """A changed byte of its address would carry what ended to somebody else."""
        with tempfile.TemporaryDirectory() as folder, Receiver() as receiver, Receiver() as stranger:
            data = Path(folder) / "data"
            limits = ("--budget", "scrub_bytes_per_second=0", "--budget", "webhook_attempts=2", "--budget", "webhook_give_ups=1")
            with Daemon(data, arguments=QUICK, environment={"DRIFTLAB_CRASH_AT": "job.finished"}) as daemon:
                hook = daemon.post("/v1/webhooks", {"url": receiver.url}).json["id"]
                try:
                    recording = daemon.upload(samples.gyro_csv(seed=1), rate_hz=100, columns=samples.GYRO_Z).json["id"]
                    daemon.finished(daemon.characterise(recording, models=["WN"]).json["id"])
                except LOST:
                    pass
                self.assertEqual(daemon.wait(), -signal.SIGKILL)
            self.assertEqual(daemon.rows("SELECT state FROM webhook_deliveries"), [["waiting"]])
            daemon.change("UPDATE webhooks SET url = ?", stranger.url)
            with Daemon(data, arguments=QUICK + limits) as daemon:
                until = time.monotonic() + 60
                why = ""
                while not why and time.monotonic() < until:
                    [[why]] = daemon.rows("SELECT disabled_why FROM webhooks")
                    time.sleep(0.05)
                self.assertEqual(why, "1 delivery was given up; the last attempt: The row of the webhook is damaged, so that where it leads is "
                                      "not known.")
                states = daemon.get("/readyz").json["states"]
                self.assertEqual([(state["state"], state["row"]) for state in states], [("row_damaged", f"webhooks/{hook}")])
                for target in ("/v1/webhooks", f"/v1/webhooks/{hook}"):
                    unsaid = daemon.get(target)
                    self.assertEqual((unsaid.status, unsaid.json["where"]), (500, {"damaged_row": f"webhooks/{hook}"}))
                self.assertEqual(daemon.post(f"/v1/webhooks/{hook}/rotate").status, 500)
                self.assertEqual(daemon.request("DELETE", f"/v1/webhooks/{hook}", headers={"If-Match": "*"}).status, 204)
                self.assertEqual(daemon.items("/v1/webhooks"), [])
                # Nobody reads in the background here; that the row is gone is seen all the same.
                until = time.monotonic() + 60
                while daemon.get("/readyz").json != {"status": "ready"} and time.monotonic() < until:
                    time.sleep(0.2)
                self.assertEqual(daemon.get("/readyz").json, {"status": "ready"})
            self.assertEqual((receiver.messages, stranger.messages), ([], []))

    def test_a_message_whose_answer_nobody_saw_comes_again_with_the_same_id(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            data = Path(folder) / "data"
            dying: list[Daemon] = []

            def kill(message: Message) -> tuple[int, dict[str, str]]:
                dying[0].process.kill()
                return (204, {})

            with Receiver(kill) as receiver:
                with Daemon(data, arguments=QUICK) as daemon:
                    dying.append(daemon)
                    hook = daemon.post("/v1/webhooks", {"url": receiver.url}).json
                    try:
                        daemon.post(f"/v1/webhooks/{hook['id']}/test")
                    except LOST:
                        pass
                    self.assertEqual(daemon.wait(), -signal.SIGKILL)
                with Daemon(data, arguments=QUICK) as daemon:
                    first, second = receiver.wait(2)[:2]
                    self.assertEqual((first.id, first.body), (second.id, second.body))
                    second.verify(hook["secret"])
                    self.assertEqual([d["state"] for d in settled(daemon, hook["id"])], ["delivered"])

    def test_killed_again_and_again_every_end_is_told(self) -> None:
        with tempfile.TemporaryDirectory() as folder, Receiver() as receiver:
            data = Path(folder) / "data"
            jobs: set[str] = set()
            for life in range(4):
                with Daemon(data, arguments=QUICK) as daemon:
                    if life == 0:
                        daemon.post("/v1/webhooks", {"url": receiver.url})
                    # After a few answers, however slow the machine is, and somewhere in the work that follows them.
                    stop = threading.Timer(0.02 + 0.03 * life, daemon.process.kill)
                    try:
                        for seed in range(100):
                            if seed == 2 + life:
                                stop.start()
                            content = samples.gyro_csv(300, seed=100 * life + seed)
                            made = daemon.upload(content, rate_hz=100, columns=samples.GYRO_Z).json["id"]
                            jobs.add(daemon.characterise(made, models=["WN"]).json["id"])
                    except LOST:
                        pass
                    daemon.wait()
            with Daemon(data, arguments=QUICK) as daemon:
                for job in jobs:
                    self.assertEqual(daemon.finished(job)["state"], "succeeded")
                until = time.monotonic() + 60
                while time.monotonic() < until and not jobs <= {message.document["data"]["job"] for message in receiver.messages}:
                    time.sleep(0.05)
                told: dict[str, set[str]] = {}
                for message in receiver.messages:
                    told.setdefault(message.document["data"]["job"], set()).add(message.id)
                self.assertLessEqual(jobs, set(told), "an end is untold")
                self.assertEqual({len(ids) for ids in told.values()}, {1}, "one end, one id")
            self.assertGreaterEqual(len(jobs), 2 + 3 + 4 + 5)


if __name__ == "__main__":
    unittest.main()
