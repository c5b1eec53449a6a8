"""What clients did and were told, and what must therefore be there after whatever befell the daemon.

An operation that was answered with success must have happened; one that was not answered, or answered with a failure of the
daemon, may have happened, as a whole. A client touches its own recordings alone, one operation at a time.
"""
from __future__ import annotations

import copy
import hashlib
import http.client
import random
import threading
import unittest
from dataclasses import dataclass, field
from typing import Any

import samples
from daemon import Answer, Daemon

MODELS = ["WN", "WN+GM"]
LOST = (http.client.HTTPException, OSError)  # what a client sees of a daemon that dies
FAILED = {500, 503, 507}  # a daemon whose disk fails says so
TUS = {"Tus-Resumable": "1.0.0"}
PIECE = {**TUS, "Content-Type": "application/offset+octet-stream"}
META = "device=phone-07&condition=static&rate_hz=100&columns=gz%3Dangular_rate%3Az%3Adeg%2Fs"


class Unknown(Exception):
    """Nobody knows whether the operation has happened."""


@dataclass
class Told:
    """Of one recording."""

    content: bytes
    labels: list[dict[str, str]] = field(default_factory=lambda: [{}])  # what they may be
    gone: str = "no"  # or "maybe", "yes"
    version: int = 0  # grows with every operation that begins


@dataclass
class Piecewise:
    """Of one resumable upload."""

    content: bytes
    offset: int = 0
    ending: bool = False  # its recording was asked for


class History:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.recordings: dict[str, Told] = {}
        self.jobs: dict[str, str] = {}  # id -> its recording
        self.results: dict[str, str] = {}  # id of a job -> digest of its result
        self.uploads: dict[str, Piecewise] = {}
        self.sent: set[str] = set()  # digests of everything that was sent

    def snapshot(self) -> History:
        taken = History()
        with self.lock:
            for name in ("recordings", "jobs", "results", "uploads", "sent"):
                setattr(taken, name, copy.deepcopy(getattr(self, name)))
        return taken


def done(answer: Answer, *statuses: int) -> Answer:
    if answer.status in FAILED:
        raise Unknown(answer.describe())
    assert answer.status in statuses, answer.describe()
    return answer


class Client:
    """Does one thing after the other, by a seeded choice."""

    def __init__(self, history: History, seed: int) -> None:
        self.history, self.random, self.own = history, random.Random(seed), []  # type: ignore[var-annotated]
        self.open: list[str] = []

    def step(self, daemon: Daemon) -> None:
        """One operation. Raises Unknown where the daemon failed, and LOST where it is gone."""
        choice = self.random.random()
        living = [identity for identity in self.own if self.history.recordings[identity].gone == "no"]
        if choice < 0.4 or not living:
            self.upload(daemon)
        elif choice < 0.55:
            self.piecewise(daemon)
        elif choice < 0.75:
            self.label(daemon, self.random.choice(living))
        elif choice < 0.85:
            self.remove(daemon, self.random.choice(living))
        else:
            self.characterise(daemon, self.random.choice(living))

    def content(self) -> bytes:
        content = samples.gyro_csv(300, seed=self.random.randrange(1 << 30))
        with self.history.lock:
            self.history.sent.add(hashlib.sha256(content).hexdigest())
        return content

    def note(self, identity: str, content: bytes) -> None:
        with self.history.lock:
            self.history.recordings.setdefault(identity, Told(content))
        self.own.append(identity)

    def upload(self, daemon: Daemon) -> None:
        content = self.content()
        self.note(done(daemon.upload(content, rate_hz=100, columns=samples.GYRO_Z), 200, 201).json["id"], content)

    def piecewise(self, daemon: Daemon) -> None:
        if not self.open:
            content = self.content()
            made = done(daemon.request("POST", "/v1/uploads", headers={**TUS, "Upload-Length": str(len(content))}), 201)
            with self.history.lock:
                self.history.uploads[made.headers["location"]] = Piecewise(content)
            self.open.append(made.headers["location"])
            return
        place = self.open[0]
        told = self.history.uploads[place]
        stands = daemon.get(place)
        if stands.status == 404 and told.ending:
            self.open.pop(0)  # the recording was made, and nobody heard of it
            return
        at = int(done(stands, 200).json["offset"])
        assert at >= told.offset, f"{place} has lost bytes that were acknowledged: {at} of {told.offset}"
        if at < len(told.content):
            end = min(len(told.content), at + 1500)
            done(daemon.request("PATCH", place, told.content[at:end], {**PIECE, "Upload-Offset": str(at)}), 204)
            told.offset = end
            return
        told.ending = True
        identity = done(daemon.request("POST", f"{place}/recording?{META}"), 200, 201).json["id"]
        self.open.pop(0)
        with self.history.lock:
            del self.history.uploads[place]
        self.note(identity, told.content)

    def label(self, daemon: Daemon, identity: str) -> None:
        told = self.history.recordings[identity]
        wanted = {"turn": str(self.random.randrange(1 << 30))}
        told.version += 1
        told.labels.append(wanted)
        done(daemon.request("PATCH", f"/v1/recordings/{identity}", {"labels": wanted}, {"If-Match": "*"}), 200)
        told.labels = [wanted]

    def remove(self, daemon: Daemon, identity: str) -> None:
        told = self.history.recordings[identity]
        told.version += 1
        told.gone = "maybe"
        answer = done(daemon.request("DELETE", f"/v1/recordings/{identity}", headers={"If-Match": "*"}), 204, 409)
        told.gone = "yes" if answer.status == 204 else "no"  # 409: a job is using it

    def characterise(self, daemon: Daemon, identity: str) -> None:
        job = done(daemon.characterise(identity, models=MODELS), 200, 202).json["id"]
        with self.history.lock:
            self.history.jobs[job] = identity
        self.result(daemon, job)

    def result(self, daemon: Daemon, job: str) -> None:
        answer = daemon.get(f"/v1/jobs/{job}/result", Prefer="wait=1")
        if answer.status == 200:
            with self.history.lock:
                self.history.results.setdefault(job, hashlib.sha256(answer.body).hexdigest())


def at_work(clients: list[Client], daemon: Daemon, failures: list[str]) -> list[threading.Thread]:
    """The clients, each doing one thing after the other in a thread of its own until the daemon is gone. What nobody
    foresaw goes to `failures`, for the thread of the test to tell."""
    def work(client: Client) -> None:
        try:
            while True:
                client.step(daemon)
        except LOST:
            pass
        except Exception as unforeseen:  # noqa: BLE001
            failures.append(repr(unforeseen))
    threads = [threading.Thread(target=work, args=(client,)) for client in clients]
    for thread in threads:
        thread.start()
    return threads


class Judge(unittest.TestCase):
    """Nothing that was acknowledged is lost, nothing is there twice, nothing by half."""

    def judge(self, daemon: Daemon, told: History, *, live: History | None = None, whole: bool = False) -> None:
        """`live`: a later history; what it has touched since is not asked about. `whole`: every job is waited for."""
        listed = {recording["id"]: recording for recording in daemon.items("/v1/recordings?limit=500")}
        pairs = [(recording["device"], recording["file"]["sha256"]) for recording in listed.values()]
        self.assertEqual(len(pairs), len(set(pairs)), "a recording is there twice")
        for identity, recording in listed.items():
            self.judge_files(daemon, recording)
            self.assertIn(recording["file"]["sha256"], (live or told).sent, "a recording that nobody sent")
        for identity, expected in told.recordings.items():
            if live is not None and live.recordings[identity].version != expected.version:
                continue
            self.judge_recording(identity, expected, listed.get(identity), daemon)
        for place, upload in told.uploads.items():
            if live is None:
                self.judge_upload(daemon, place, upload)
        if whole:
            self.judge_jobs(daemon, told, set(listed))

    def judge_files(self, daemon: Daemon, recording: dict[str, Any]) -> None:
        sha256 = recording["file"]["sha256"]
        content = (daemon.data / "blobs" / sha256[:2] / sha256).read_bytes()
        self.assertEqual(hashlib.sha256(content).hexdigest(), sha256, "a blob is damaged")
        self.assertTrue((daemon.data / "columns" / sha256[:2] / f"{sha256}.columns").exists(), "a recording by half")

    def judge_recording(self, identity: str, expected: Told, found: dict[str, Any] | None, daemon: Daemon) -> None:
        if found is None:
            self.assertIn(expected.gone, ("maybe", "yes"), f"{identity}, which was acknowledged, is lost")
            expected.gone = "yes"
            return
        self.assertIn(expected.gone, ("maybe", "no"), f"{identity} is there again")
        expected.gone = "no"
        self.assertEqual(found["file"]["sha256"], hashlib.sha256(expected.content).hexdigest())
        labels = dict(daemon.get(f"/v1/recordings/{identity}").json["metadata"].get("labels") or {})
        self.assertIn(labels, expected.labels, f"{identity} has lost an acknowledged change")
        expected.labels = [labels]

    def judge_upload(self, daemon: Daemon, place: str, upload: Piecewise) -> None:
        answer = daemon.get(place)
        if answer.status == 404:
            self.assertTrue(upload.ending, f"{place}, which was acknowledged, is lost")
            return
        self.assertEqual(answer.status, 200, answer.describe())
        self.assertGreaterEqual(answer.json["offset"], upload.offset, f"{place} has lost bytes that were acknowledged")

    def judge_jobs(self, daemon: Daemon, told: History, recordings: set[str]) -> None:
        for job, recording in told.jobs.items():
            if recording not in recordings:
                continue  # a removed recording takes its results along
            answer = daemon.get(f"/v1/jobs/{job}")
            self.assertEqual(answer.status, 200, f"{job}, which was acknowledged, is lost")
            document = daemon.finished(job)
            self.assertEqual(document["state"], "succeeded", document)
            result = daemon.get(document["result"]["href"])
            digest = hashlib.sha256(result.body).hexdigest()
            self.assertEqual(told.results.setdefault(job, digest), digest, "a result that was read has changed")
            fits = daemon.items(f"/v1/fits?job={job}")
            self.assertEqual(sorted(fit["model"] for fit in fits), sorted(MODELS), "results are written once")
