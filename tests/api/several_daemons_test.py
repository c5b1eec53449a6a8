"""Several daemons and workers on one PostgreSQL database: what one does the others know, and what dies is taken over."""
from __future__ import annotations

import datetime
import json
import os
import tempfile
import threading
import time
import unittest
from pathlib import Path
from typing import Any

import daemon as daemons
import object_storage
import postgres
import samples
import yaml
from daemon import Daemon, events
from events_test import stream
from store_test import start
from suite import SKIPPED

if postgres.programs() is None or "built without PostgreSQL" in start(Path("/nonexistent"), "postgresql://127.0.0.1:1/x").stderr:
    print("SEVERAL DAEMONS NOT TESTED: there is no PostgreSQL.")
    raise SystemExit(SKIPPED)

if not object_storage.is_installed():
    print("OBJECT STORAGE NOT TESTED: python3-swift is not installed.")

DEPLOY = Path(__file__).resolve().parents[2] / "deploy"
SMALL = ("--budget", "reserve_bytes=0")
CLOCK_SHIM = os.environ.get("DRIFTLAB_CLOCK_SHIM", "")


class Several(unittest.TestCase):
    """Daemons with a folder of recordings between them; `InDatabase` and `InObjectStorage` run the same without one."""

    environment: dict[str, str] = {}

    def place(self) -> str:
        return str(self.folder / "shared")

    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.cluster = postgres.cluster()
        self.store = self.cluster.store_of(self.folder)
        self.blobs = self.place()

    def start(self, name: str, *arguments: str, environment: dict[str, str] | None = None) -> Daemon:
        together = ("--store", self.store, "--blobs", self.blobs, *SMALL, *arguments)
        return self.enterContext(Daemon(self.folder / name, arguments=together, environment={**self.environment, **(environment or {})}))

    def upload(self, daemon: Daemon, seed: int = 1) -> str:
        answer = daemon.upload(samples.gyro_csv(4096, seed=seed), rate_hz=100, columns=samples.GYRO_Z)
        self.assertIn(answer.status, (200, 201), answer.describe())
        return str(answer.json["id"])

    def job(self, daemon: Daemon, recording: str, **parameters: Any) -> str:
        answer = daemon.characterise(recording, **(parameters or {"models": ["WN"]}))
        self.assertIn(answer.status, (200, 202), answer.describe())
        return str(answer.json["id"])

    def eventually(self, what: str, done: Any, seconds: float = 60.0) -> None:
        until = time.monotonic() + seconds
        while not done():
            self.assertLess(time.monotonic(), until, what)
            time.sleep(0.05)

    def test_what_one_does_is_on_the_streams_of_the_other(self) -> None:
        a, b = self.start("a"), self.start("b")
        heard: list[tuple[str, dict[str, Any]]] = []
        with stream(a) as told:
            self.assertEqual(next(told)[1], "ready")
            reader = threading.Thread(target=lambda: heard.extend((kind, data) for _, kind, data in until_result(told)))
            reader.start()
            recording = self.upload(b)
            job = self.job(b, recording)
            reader.join(daemons.PATIENCE_S)
        kinds = [kind for kind, _ in heard]
        self.assertIn("recording.created", kinds)
        states = [data["state"] for kind, data in heard if kind == "job" and data["job"] == job]
        self.assertIn("succeeded", states)
        self.assertEqual(heard[-1][1]["job"], job)
        for daemon in (a, b):
            seen = [event.data["state"] for event in events(daemon, job) if event.type == "state"]
            self.assertEqual((seen[0], seen[-1]), ("queued", "succeeded"))
        self.assertEqual(a.get(f"/v1/jobs/{job}/result").body, b.get(f"/v1/jobs/{job}/result").body)
        self.assertEqual(a.items(f"/v1/fits?job={job}"), b.items(f"/v1/fits?job={job}"))
        content = samples.gyro_csv(4096, seed=1)
        self.assertEqual(a.get(f"/v1/recordings/{recording}/content").body, content)
        self.assertEqual(a.upload(content, rate_hz=100, columns=samples.GYRO_Z).status, 200, "the same bytes are the same recording")

    def test_a_request_is_repeated_at_another_daemon(self) -> None:
        a, b = self.start("a"), self.start("b")
        key = {"Idempotency-Key": "once"}
        first = a.post("/v1/devices", {"name": "told"}, key)
        self.assertEqual(first.status, 201, first.describe())
        again = b.post("/v1/devices", {"name": "told"}, key)
        self.assertEqual((again.status, again.body), (201, first.body), again.describe())
        self.assertEqual(again.headers.get("idempotency-replayed"), "true")
        self.assertEqual(b.post("/v1/devices", {"name": "other"}, key).status, 422)
        answers: list[daemons.Answer] = []

        def ask(daemon: Daemon) -> None:
            answers.append(daemon.post("/v1/devices", {"name": "at once"}, {"Idempotency-Key": "at-once"}))

        threads = [threading.Thread(target=ask, args=(daemon,)) for daemon in (a, b) * 8]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertLessEqual({answer.status for answer in answers}, {201, 409}, [answer.describe() for answer in answers])
        made = [answer for answer in answers if answer.status == 201]
        self.assertEqual(len({answer.body for answer in made}), 1)
        self.assertEqual(sum("idempotency-replayed" not in answer.headers for answer in made), 1, "one of them ran")

    def test_a_token_holds_at_every_daemon_and_goes_at_every_one(self) -> None:
        a, b = self.start("a"), self.start("b")
        made = a.post("/v1/tokens", {"name": "first", "scope": "admin"})
        self.assertEqual(made.status, 201, made.describe())
        admin = {"Authorization": f"Bearer {made.json['secret']}"}
        self.eventually("b lets nobody in without a token", lambda: b.get("/v1/devices").status == 401, 10)
        self.assertEqual(b.get("/v1/devices", **admin).status, 200)
        reader = a.post("/v1/tokens", {"name": "reader", "scope": "read"}, admin).json
        bearer = {"Authorization": f"Bearer {reader['secret']}"}
        self.eventually("b knows the token", lambda: b.get("/v1/devices", **bearer).status == 200, 10)
        self.assertEqual(a.post(f"/v1/tokens/{reader['id']}/revoke", None, admin).status, 200)
        self.eventually("b refuses it", lambda: b.get("/v1/devices", **bearer).status == 401, 10)

    @unittest.skipUnless(CLOCK_SHIM, "sanitizers put their own calls before those of the shim")
    def test_a_machine_whose_clock_is_wrong_goes_by_that_of_the_database(self) -> None:
        # Tokens that others had issued were refused by it as expired, and its own lived three hours longer elsewhere.
        right = self.start("right", "--workers", "0")
        wrong = self.start("wrong", environment={"LD_PRELOAD": CLOCK_SHIM, "DRIFTLAB_CLOCK_AHEAD": str(3 * 3600)})
        recording = self.upload(wrong)
        job = self.job(wrong, recording)
        self.assertEqual(wrong.finished(job)["state"], "succeeded")
        shown = [right.get(f"/v1/recordings/{recording}").json["created_at"], *(right.get(f"/v1/jobs/{job}").json[at] for at in ("created_at", "finished_at"))]
        for said in shown:
            age = datetime.datetime.now(datetime.timezone.utc) - datetime.datetime.fromisoformat(said.replace("Z", "+00:00"))
            self.assertLess(abs(age.total_seconds()), 120, shown)
        right.token = right.post("/v1/tokens", {"name": "first", "scope": "admin"}).json["secret"]
        hour = right.post("/v1/tokens", {"name": "an hour", "scope": "read", "expires_in_s": 3600})
        self.assertEqual(hour.status, 201, hour.describe())
        bearer = {"Authorization": f"Bearer {hour.json['secret']}"}
        self.eventually("it asks for tokens", lambda: wrong.get("/v1/devices").status == 401, 10)
        self.eventually("the token is known", lambda: wrong.get("/v1/devices", **bearer).status == 200, 10)

    def test_what_a_killed_daemon_had_is_done_by_another(self) -> None:
        a = self.start("a")
        recordings = [self.upload(a, seed) for seed in range(4)]
        b = self.start("b")
        jobs = [self.job(a, recording, models=["WN", "WN+RW", "WN+GM"]) for recording in recordings]
        a.kill()
        for job in jobs:
            self.assertEqual(b.finished(job)["state"], "succeeded")
            states = [event.data["state"] for event in events(b, job) if event.type == "state"]
            self.assertEqual(states.count("succeeded"), 1, states)
            self.assertEqual(len(b.items(f"/v1/fits?job={job}")), 3)

    def test_a_later_daemon_leaves_running_jobs_alone(self) -> None:
        a = self.start("a")
        jobs = [self.job(a, self.upload(a, seed), models=["WN", "WN+GM"]) for seed in range(3)]
        self.start("b")
        for job in jobs:
            a.finished(job)
            states = [event.data["state"] for event in events(a, job) if event.type == "state"]
            self.assertEqual(states, ["queued", "running", "succeeded"])

    def test_all_workers_are_those_of_every_process(self) -> None:
        a = self.start("a", "--workers", "1")
        self.assertEqual(a.get("/v1/workers").json, {"workers": 1})
        worker = self.start("worker", "worker", "--threads", "3", "--workers", "3")
        self.eventually("the worker is counted", lambda: a.get("/v1/workers").json == {"workers": 4})
        worker.kill()
        self.eventually("one that is gone is not", lambda: a.get("/v1/workers").json == {"workers": 1})

    def test_a_worker_works_and_has_no_api(self) -> None:
        a = self.start("a")
        worker = self.start("worker", "worker")
        self.assertEqual(worker.get("/healthz").status, 200)
        self.assertEqual(worker.get("/readyz").status, 200)
        self.assertIn("driftlab_jobs_queued", worker.get("/metrics").text)
        for target in ("/v1/devices", "/", "/openapi.json", "/docs"):
            self.assertEqual(worker.get(target).status, 404, target)
        recording = self.upload(a)
        jobs = [self.job(a, self.upload(a, seed)) for seed in range(2, 6)] + [self.job(a, recording)]
        a.kill()
        self.eventually("the worker has done them", lambda: not self.cluster.rows(
            self.folder, "SELECT id FROM jobs WHERE state IN ('queued', 'running')"))
        self.assertEqual(worker.terminate(), 0)
        b = self.start("b")
        for job in jobs:
            self.assertEqual(b.get(f"/v1/jobs/{job}").json["state"], "succeeded")

    def test_cancelling_at_one_stops_what_the_other_does(self) -> None:
        a = self.start("a")
        content = samples.gyro_csv(200_000, seed=3)
        recording = a.upload(content, rate_hz=100, columns=samples.GYRO_Z).json["id"]
        job = self.job(a, recording, models=["WN", "WN+RW", "WN+GM", "WN+GM+GM", "WN+GM+RW"])
        self.eventually("it runs", lambda: a.get(f"/v1/jobs/{job}").json["state"] != "queued")
        b = self.start("b")
        self.assertIn(b.post(f"/v1/jobs/{job}/cancel").status, (200, 202))
        self.assertIn(b.finished(job)["state"], ("cancelled", "succeeded"))


class WithoutFolder(Several):
    def test_a_daemon_with_nothing_but_what_is_shared_has_everything(self) -> None:
        a = self.start("a")
        recording = self.upload(a)
        self.assertEqual(a.finished(self.job(a, recording))["state"], "succeeded")
        self.assertEqual(a.terminate(), 0)
        b = self.start("elsewhere")
        self.assertEqual(b.get(f"/v1/recordings/{recording}/content").body, samples.gyro_csv(4096, seed=1))
        again = self.job(b, recording, models=["WN", "WN+RW"])
        self.assertEqual(b.finished(again)["state"], "succeeded")
        deleted = b.request("DELETE", f"/v1/recordings/{recording}", headers={"If-Match": "*"})
        self.assertEqual(deleted.status, 204, deleted.describe())


class InDatabase(WithoutFolder):
    def place(self) -> str:
        return "database"


@unittest.skipUnless(object_storage.is_installed(), "OBJECT STORAGE NOT TESTED: python3-swift is not installed")
class InObjectStorage(WithoutFolder):
    environment = object_storage.KEY

    def place(self) -> str:
        return object_storage.place_of(self.folder)


del WithoutFolder  # has no place of its own


class Refused(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.store = postgres.cluster().store_of(self.folder)

    def refused(self, *arguments: str, said: str, store: str | None = None) -> None:
        ran = start(self.folder / "refused", self.store if store is None else store, *arguments)
        self.assertIn(ran.returncode, (1, 2), ran.stderr)
        last = ran.stderr.strip().splitlines()[-1]
        self.assertIn(said, last)
        self.assertTrue(last.startswith("driftlabd: ") and last.endswith("."), last)

    def test_one_that_keeps_recordings_for_itself_is_alone(self) -> None:
        shared = str(self.folder / "shared")
        with Daemon(self.folder / "a", arguments=("--store", self.store, "--blobs", shared)):
            self.refused(said="Another daemon works with the database")

    def test_a_worker_needs_what_daemons_share(self) -> None:
        self.refused("worker", said="--blobs")
        self.refused("worker", "--blobs", str(self.folder / "shared"), said="--store", store="")
        self.refused("--blobs", str(self.folder / "shared"), said="--store", store="")
        self.refused("--blobs", "shared", said="absolute path")


class Manifests(unittest.TestCase):
    """What deploy/ sets are settings that there are, and every container says whether it lives and can work."""

    def test_settings_and_probes(self) -> None:
        ran = start(Path("/nonexistent"), "", "config", "--json")
        told = json.loads(ran.stdout)
        known = {"DRIFTLAB_" + name.upper() for name in told["settings"]} | {"DRIFTLAB_BUDGET_" + name.upper() for name in told["budgets"]}
        compose = yaml.safe_load((DEPLOY / "compose/compose.yml").read_text())
        ours = [service for service in compose["services"].values() if service["image"].startswith("driftlab")]
        self.assertEqual([service.get("command") for service in ours], [None, None, ["worker"]])
        for service in ours:
            self.assertLessEqual(set(service["environment"]), known)
            self.assertIn("/readyz", service["healthcheck"]["test"])
        manifests = list(yaml.safe_load_all((DEPLOY / "kubernetes/driftlab.yaml").read_text()))
        containers = [container for manifest in manifests if manifest["kind"] == "Deployment"
                      for container in manifest["spec"]["template"]["spec"]["containers"]]
        self.assertEqual([container.get("args") for container in containers], [None, ["worker"]])
        for container in containers:
            self.assertLessEqual({variable["name"] for variable in container["env"]}, known)
            self.assertEqual(container["livenessProbe"]["httpGet"]["path"], "/healthz")
            self.assertEqual(container["readinessProbe"]["httpGet"]["path"], "/readyz")
            ports = {port["name"] for port in container["ports"]}
            self.assertIn(container["readinessProbe"]["httpGet"]["port"], ports)


    def test_workers_are_scaled_by_a_metric_that_there_is(self) -> None:
        [scaler] = list(yaml.safe_load_all((DEPLOY / "kubernetes/autoscaling.yaml").read_text()))
        manifests = list(yaml.safe_load_all((DEPLOY / "kubernetes/driftlab.yaml").read_text()))
        deployments = {each["metadata"]["name"]: each for each in manifests if each["kind"] == "Deployment"}
        spec = scaler["spec"]
        target = deployments[spec["scaleTargetRef"]["name"]]
        self.assertEqual((target["apiVersion"], target["kind"]), (spec["scaleTargetRef"]["apiVersion"], spec["scaleTargetRef"]["kind"]))
        self.assertEqual(target["spec"]["template"]["spec"]["containers"][0]["args"], ["worker"])
        self.assertLessEqual(spec["minReplicas"], target["spec"]["replicas"])
        self.assertLessEqual(target["spec"]["replicas"], spec["maxReplicas"])
        [metric] = spec["metrics"]
        with Daemon(Path(self.enterContext(tempfile.TemporaryDirectory())) / "data") as daemon:
            self.assertRegex(daemon.get("/metrics").text, rf"(?m)^{metric['external']['metric']['name']} \d")
        budgets = [each["spec"]["selector"]["matchLabels"] for each in manifests if each["kind"] == "PodDisruptionBudget"]
        self.assertCountEqual(budgets, [each["spec"]["selector"]["matchLabels"] for each in deployments.values()], "each has a budget")


def until_result(told: Any) -> list[tuple[str, str, dict[str, Any]]]:
    seen = []
    for event in told:
        seen.append(event)
        if event[1] == "result.created":
            break
    return seen


if __name__ == "__main__":
    unittest.main()
