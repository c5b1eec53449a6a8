"""A campaign gives the same tables to the bit on 1, 2 and 8 workers, whatever comes first, and through kill -9.

Two jobs that ended together on one axis once pooled without each other: the number of workers decided whether a table
showed a joint fit or an average.
"""
from __future__ import annotations

import json
import random
import re
import tempfile
import time
import unittest
from pathlib import Path
from typing import Any

import samples
from daemon import Daemon

DEVICE = "campaign"
AXES = ("x", "z")
MODELS = ["WN", "WN+RW", "WN+GM"]
# Recordings of each condition; the noise grows from one to the next.
CONDITIONS = {"static": 3, "constant_rate:z:9:deg/s": 2, "constant_rate:z:40:deg/s": 2}
COLUMNS = "gx=angular_rate:x:deg/s,gz=angular_rate:z:deg/s"
FORMS = ("application/json", "text/plain", "text/markdown", "text/csv")


def recordings() -> list[tuple[str, bytes]]:
    """(condition, file) of the whole campaign; all of them drift, so that more than white noise is seen."""
    made = []
    for level, (condition, replicates) in enumerate(CONDITIONS.items()):
        for replicate in range(replicates):
            columns = samples.noise(3000, 2, 100 * level + replicate)
            for column in columns:
                walk = 0.0
                for i, value in enumerate(column):
                    walk += 0.02 * value
                    column[i] = round(1.5**level * value + walk, 6)
            made.append((condition, samples.csv(columns, ["gx", "gz"])))
    return made


class Life:
    """Uploads and queues one job for each recording; goes on after the daemon was killed."""

    def __init__(self, campaign: list[tuple[str, bytes]]) -> None:
        self.campaign = campaign
        self.names: dict[str, str] = {}  # id of a recording -> its hash, which is the same in every life

    def go_on(self, daemon: Daemon, until: int | None = None) -> None:
        for condition, content in self.campaign[:until]:
            answer = daemon.upload(content, device=DEVICE, condition=condition, rate_hz=100, columns=COLUMNS)
            assert answer.status in (200, 201), answer.describe()
            self.names[answer.json["id"]] = answer.json["file"]["sha256"]
            queued = daemon.characterise(answer.json["id"], models=MODELS)
            assert queued.status in (200, 202), queued.describe()

    def end(self, daemon: Daemon) -> dict[str, Any]:
        """Every table once all is done, with names in place of ids."""
        self.go_on(daemon)
        for job in daemon.items("/v1/jobs?kind=characterise"):
            assert daemon.finished(job["id"])["state"] == "succeeded", job
        found = {}
        for axis in AXES:
            for method in ("gmwm", "av"):
                query = f"?device={DEVICE}&sensor=gyroscope&axis={axis}&method={method}"
                for form in FORMS:
                    answer = daemon.get("/v1/parameter-tables" + query, Accept=form, Prefer="wait=60")
                    assert answer.status == 200, answer.describe()
                    found[f"table {axis} {method} {form}"] = self.named(answer.text)
                found[f"trends {axis} {method}"] = self.named(daemon.get("/v1/trends" + query, Prefer="wait=60").text)
            pooling = daemon.get(f"/v1/parameter-tables?device={DEVICE}&axis={axis}").json["pooling"]
            assert pooling["state"] == "done", pooling
            pooled = daemon.get(pooling["job"] + "/result").json
            for condition in pooled["conditions"]:
                condition["members"] = len(condition["members"])
            found[f"pooled {axis}"] = self.named(json.dumps(pooled))
        return found

    def named(self, text: str) -> str:
        text = re.sub(r"rec_[0-9A-Z]{26}", lambda match: self.names[match.group()], text)
        return re.sub(r"\b(job|dev)_[0-9A-Z]{26}", r"\1", text)


class Pooling(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        with tempfile.TemporaryDirectory(prefix="driftlab-pooling-") as folder:
            cls.reference = cls.live(Path(folder), 1, recordings(), [])

    @staticmethod
    def live(folder: Path, workers: int, campaign: list[tuple[str, bytes]], kills: list[tuple[int, float]]) -> dict[str, Any]:
        """The tables after a life in which the daemon was killed: after so many uploads, and then so many seconds."""
        life = Life(campaign)
        arguments = ("--workers", str(workers), "--threads", str(workers))
        for uploads, pause in kills:
            with Daemon(folder / "data", arguments=arguments) as daemon:
                life.go_on(daemon, uploads)
                time.sleep(pause)
                daemon.kill()
        with Daemon(folder / "data", arguments=arguments) as daemon:
            found = life.end(daemon)
            jobs = daemon.items("/v1/jobs?kind=pool")
            assert len({job["id"] for job in jobs if job["state"] == "succeeded" and job["result"]}) >= len(AXES), jobs
            assert {job["state"] for job in jobs} <= {"succeeded", "cancelled"}, jobs
        return found

    def same(self, workers: int, seed: int, kills: int = 0) -> None:
        generator = random.Random(seed)
        campaign = recordings()
        generator.shuffle(campaign)
        moments = [(generator.randint(2, len(campaign)), generator.uniform(0.0, 0.5)) for _ in range(kills)]
        with tempfile.TemporaryDirectory(prefix="driftlab-pooling-") as folder:
            found = self.live(Path(folder), workers, campaign, moments)
        self.assertEqual(found.keys(), self.reference.keys())
        for what, text in self.reference.items():
            self.assertEqual(found[what], text, f"{what} on {workers} workers, order {seed}, {kills} kills")

    def test_replicates_are_fitted_jointly(self) -> None:
        for axis in AXES:
            table = json.loads(self.reference[f"table {axis} gmwm application/json"])
            self.assertEqual([(row["pooling"], len(row["recordings"])) for row in table["rows"]], [("joint", n) for n in CONDITIONS.values()])

    def test_one_worker_in_another_order(self) -> None:
        self.same(1, seed=11)

    def test_two_workers(self) -> None:
        self.same(2, seed=12)

    def test_eight_workers(self) -> None:
        self.same(8, seed=13)

    def test_eight_workers_and_kill_9(self) -> None:
        self.same(8, seed=14, kills=3)

    def test_one_worker_and_kill_9(self) -> None:
        self.same(1, seed=16, kills=3)

    def test_two_workers_and_kill_9(self) -> None:
        self.same(2, seed=15, kills=3)


if __name__ == "__main__":
    unittest.main()
