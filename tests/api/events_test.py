"""One stream of everything: what it tells, how it resumes, and that it says when something was missed."""
from __future__ import annotations

import http.client
import json
import unittest
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import samples
from daemon import PATIENCE_S, Daemon
from suite import DaemonTest

Heard = tuple[str, str, dict[str, Any]]


@contextmanager
def stream(daemon: Daemon, query: str = "", last: str | None = None) -> Iterator[Iterator[Heard]]:
    connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=PATIENCE_S)
    connection.request("GET", f"/v1/events{query}", headers={} if last is None else {"Last-Event-ID": last})
    response = connection.getresponse()
    assert response.getheader("Content-Type") == "text/event-stream", response.status

    def heard() -> Iterator[Heard]:
        fields: dict[str, str] = {}
        for raw in response:
            name, _, value = raw.decode().rstrip("\n").partition(": ")
            if name:
                fields[name] = value
            elif "event" in fields:
                yield fields["id"], fields["event"], json.loads(fields["data"])
                fields = {}
            else:
                fields = {}
    try:
        yield heard()
    finally:
        connection.close()


def until(events: Iterator[Heard], kind: str) -> list[Heard]:
    seen = []
    for event in events:
        seen.append(event)
        if event[1] == kind:
            return seen
    raise AssertionError(f"the stream ended without {kind}")


class Events(DaemonTest):
    def work(self, seed: int) -> str:
        recording = self.daemon.upload(samples.gyro_csv(seed=seed), rate_hz=100, columns=samples.GYRO_Z)
        return str(self.daemon.characterise(recording.json["id"]).json["id"])

    def test_a_listener_hears_a_recording_its_job_and_the_sentence_of_its_result(self) -> None:
        with stream(self.daemon) as events:
            self.assertEqual(next(events)[1], "ready")
            job = self.work(1)
            seen = until(events, "result.created")
        kinds = [kind for _, kind, _ in seen]
        self.assertIn("recording.created", kinds)
        states = [data["state"] for _, kind, data in seen if kind == "job" and data["job"] == job]
        self.assertEqual((states[0], states[-1]), ("queued", "succeeded"))
        result = seen[-1][2]
        self.assertEqual((result["job"], result["kind"], result["href"]), (job, "characterise", f"/v1/jobs/{job}/result"))
        self.assertIn("white noise", result["verdict"].lower())
        self.expect(200, self.daemon.get(result["href"]))

    def test_a_connection_that_broke_goes_on_where_it_was(self) -> None:
        """Ids name the place: what is heard after any of them is what came behind it."""
        with stream(self.daemon, "?topics=recordings,results") as events:
            next(events)
            self.work(2)
            seen = until(events, "result.created")
        self.assertEqual({kind for _, kind, _ in seen}, {"recording.created", "result.created"})
        with stream(self.daemon, "?topics=recordings,results", last=seen[0][0]) as events:
            self.assertEqual(next(events)[1], "ready")
            self.assertEqual(until(events, "result.created"), seen[1:])

    def test_what_is_gone_is_said(self) -> None:
        for last in ("run-1", "0123456789AB-1", "x"):
            with stream(self.daemon, last=last) as events:
                self.assertEqual(next(events)[1], "reset", last)
        self.problem(400, "invalid_argument", self.daemon.get("/v1/events?topics=jobs,weather"), parameter="topics")

    def test_changes_of_devices_and_recordings_are_told(self) -> None:
        with stream(self.daemon, "?topics=devices,recordings") as events:
            next(events)
            device = self.daemon.post("/v1/devices", {"name": "told"})
            self.daemon.request("PATCH", device.headers["location"], {"serial": "7"}, {"If-Match": "*"})
            recording = self.daemon.upload(samples.gyro_csv(seed=9), rate_hz=100, columns=samples.GYRO_Z)
            self.daemon.request("PATCH", recording.headers["location"], {"condition": {"kind": "drive"}}, {"If-Match": "*"})
            self.daemon.request("DELETE", recording.headers["location"], headers={"If-Match": "*"})
            name = device.headers["location"]
            self.expect(204, self.daemon.request("DELETE", name, headers={"If-Match": self.daemon.get(name).headers["etag"]}))
            seen = until(events, "device.deleted")
        self.assertEqual([kind for _, kind, _ in seen],
                         ["device.created", "device.changed", "recording.created", "recording.changed", "recording.deleted", "device.deleted"])
        self.assertEqual(seen[-1][2]["name"], "told")


if __name__ == "__main__":
    unittest.main()
