#!/usr/bin/env python3
"""Memory of the daemon under mixed load, and 200 uploads of 5 MB at once.

usage: mixed_load.py [MINUTES] [--settle MINUTES] [--pause SECONDS] [--no-burst] [--budget NAME=VALUE] [--plot FILE.svg]
       (default 30, 5, 0; DRIFTLABD is the daemon)

First 200 clients upload 5 MB each at the same moment; all must be stored. Then four clients upload, characterise, read
tables, lists, traces and answers they have already, follow events, are refused and delete, until time is up; each keeps
its last eight recordings, for what a table pools, and a job of it takes, grows with them. Each second the anonymous
resident memory (RssAnon) is read. At the settling time and at the end the clients rest until no job
runs any more: what the daemon has then is kept, and the ratio of the two is what a leak would raise. The medians of minutes and the
largest mean of ten seconds tell of jobs at work beside it. Exit 1 where the ratio at rest is above 1.05 or a request failed.
"""
from __future__ import annotations

import argparse
import random
import statistics
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
from daemon import Daemon  # noqa: E402 - beside the tests

CLIENTS = 4
KEPT = 8  # recordings of a client
AT_ONCE = 200
FLAT = 1.05


def csv(rows: int, seed: int) -> bytes:
    values = np.random.default_rng(seed).normal(0.0, 1e-2, (rows, 3))
    return b"gx [deg/s],gy [deg/s],gz [deg/s]\n" + "\n".join("%.6f,%.6f,%.6f" % tuple(row) for row in values).encode() + b"\n"


def uploads_at_once(daemon: Daemon) -> None:
    base = csv(180_000, 0)
    begun = time.monotonic()
    with ThreadPoolExecutor(AT_ONCE) as clients:
        answers = list(clients.map(lambda k: daemon.upload(base + b"%d,0,0\n" % k, device=f"many-{k}", rate_hz=100), range(AT_ONCE)))
    took = time.monotonic() - begun
    stored = sum(answer.status == 201 for answer in answers)
    print(f"{AT_ONCE} uploads of {len(base) / 1e6:.1f} MB at once: {stored} stored in {took:.1f} s, {AT_ONCE * len(base) / 1e6 / took:.0f} MB/s", flush=True)
    if stored != AT_ONCE:
        sys.exit(f"not stored: {[answer.describe() for answer in answers if answer.status != 201][:3]}")
    for answer in answers:
        daemon.request("DELETE", f"/v1/recordings/{answer.json['id']}", None, {"If-Match": "*"})


class Client:
    """One of the clients: a step is an upload with everything that follows from it."""

    def __init__(self, daemon: Daemon, number: int) -> None:
        self.daemon, self.number = daemon, number
        self.chance = random.Random(number)
        self.requests = 0
        self.turn = 0
        self.kept: list[str] = []
        self.failures: list[str] = []

    def ask(self, wanted: set[int], method: str, target: str, body: object = None, headers: dict[str, str] | None = None) -> object:
        answer = self.daemon.request(method, target, body, headers)
        self.requests += 1
        if answer.status not in wanted:
            self.failures.append(answer.describe())
        return answer

    def step(self, turn: int) -> None:
        device = f"imu-{self.number}"
        content = csv(self.chance.choice([2_000, 10_000, 40_000]), turn * CLIENTS + self.number)
        stored = self.daemon.upload(content, device=device, rate_hz=100)
        if stored.status != 201:
            self.failures.append(stored.describe())
            return
        recording = stored.json["id"]
        job = self.daemon.characterise(recording)
        if self.daemon.finished(job.json["id"])["state"] != "succeeded":
            self.failures.append(job.describe())
        table = self.daemon.get(f"/v1/parameter-tables?device={device}&sensor=gyroscope&axis=x", Prefer="wait=20")
        tag = {"If-None-Match": table.headers.get("etag", "")}
        for _ in range(20):
            self.ask({200, 304}, "GET", table.target, None, tag if self.chance.random() < 0.5 else None)
        self.ask({200}, "GET", "/v1/devices?limit=50")
        self.ask({200}, "GET", f"/v1/recordings?device={device}&limit=20")
        self.ask({200}, "GET", f"/v1/recordings/{recording}/characterisation?channel=gx%20%5Bdeg%2Fs%5D")
        self.ask({200}, "GET", f"/v1/jobs/{job.json['id']}/events")
        self.ask({404}, "GET", "/v1/recordings/rec_00000000000000000000000000")
        self.ask({400}, "POST", "/v1/jobs", b"{")
        self.ask({200}, "GET", "/metrics")
        self.kept.append(recording)
        if len(self.kept) > KEPT:
            self.ask({204}, "DELETE", f"/v1/recordings/{self.kept.pop(0)}", None, {"If-Match": "*"})


def plot(path: Path, memory: list[tuple[float, float]], settle_s: float) -> None:
    """Resident memory over time, as a figure that stands alone."""
    width, height, left, bottom = 720, 300, 60, 40
    last, top = memory[-1][0], 1.1 * max(mib for _, mib in memory)
    points = " ".join(f"{left + (width - left - 10) * t / last:.1f},{height - bottom - (height - bottom - 10) * mib / top:.1f}" for t, mib in memory)
    ticks = "".join(f'<text x="{left - 6}" y="{height - bottom - (height - bottom - 10) * k / 4 + 4:.0f}" text-anchor="end">{top * k / 4:.0f}</text>' for k in range(5))
    ticks += "".join(f'<text x="{left + (width - left - 10) * k / 6:.0f}" y="{height - bottom + 16}" text-anchor="middle">{last / 60 * k / 6:.0f}</text>' for k in range(7))
    settled = left + (width - left - 10) * settle_s / last
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">'
                    f'<title>Resident memory of the daemon under mixed load</title><rect width="{width}" height="{height}" fill="#fff"/>'
                    f'<line x1="{settled:.1f}" x2="{settled:.1f}" y1="10" y2="{height - bottom}" stroke="#999" stroke-dasharray="3 3"/>'
                    f'<polyline fill="none" stroke="#1f5fa8" stroke-width="1.2" points="{points}"/>{ticks}'
                    f'<text x="{width / 2}" y="{height - 8}" text-anchor="middle">time [min]; dashed: from here it must be flat</text>'
                    f'<text x="{left}" y="9">RssAnon [MiB]</text></svg>\n')


def work(daemon: Daemon, clients: list[Client], seconds: float, pause: float, memory: list[tuple[float, float]]) -> None:
    """All clients for that time; each second of it is added to `memory`."""
    before = memory[-1][0] + 1 if memory else 0.0
    begun = time.monotonic()

    def turns(client: Client) -> None:
        while time.monotonic() < begun + seconds:
            client.turn += 1
            client.step(client.turn)
            time.sleep(pause)

    threads = [threading.Thread(target=turns, args=(client,)) for client in clients]
    for thread in threads:
        thread.start()
    while time.monotonic() < begun + seconds:
        memory.append((before + time.monotonic() - begun, daemon.memory_kib("RssAnon") / 1024))
        time.sleep(1)
    for thread in threads:
        thread.join()


def at_rest(daemon: Daemon) -> float:
    """The least that the daemon has within ten seconds, MiB, once no job waits or runs."""
    while any(daemon.get(f"/v1/jobs?state={state}").json["items"] for state in ("queued", "running")):
        time.sleep(0.5)
    time.sleep(2)
    seconds = []
    for _ in range(10):
        seconds.append(daemon.memory_kib("RssAnon") / 1024)
        time.sleep(1)
    return min(seconds)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("minutes", nargs="?", type=float, default=30.0)
    parser.add_argument("--settle", type=float, default=5.0)
    parser.add_argument("--pause", type=float, default=0.0, help="of each client between two of its uploads")
    parser.add_argument("--no-burst", action="store_true", help="without the 200 uploads, which a machine with no time to spare cuts")
    parser.add_argument("--budget", action="append", default=[], metavar="NAME=VALUE", help="of the daemon, as its own option")
    parser.add_argument("--plot", type=Path)
    given = parser.parse_args()
    with Daemon(arguments=tuple(word for budget in given.budget for word in ("--budget", budget))) as daemon:
        if not given.no_burst:
            uploads_at_once(daemon)
        clients = [Client(daemon, number) for number in range(CLIENTS)]
        memory: list[tuple[float, float]] = []
        work(daemon, clients, 60 * given.settle, given.pause, memory)
        settled_at_rest = at_rest(daemon)
        work(daemon, clients, 60 * (given.minutes - given.settle), given.pause, memory)
        ended_at_rest = at_rest(daemon)
    if given.plot:
        plot(given.plot, memory, 60 * given.settle)
    minutes = [[mib for t, mib in memory if 60 * k <= t < 60 * (k + 1)] for k in range(int(given.minutes))]
    medians = [statistics.median(minute) for minute in minutes]
    settled = int(given.settle)
    reference = medians[settled - 1]
    later = [mib for t, mib in memory if t >= 60 * given.settle]
    largest = max(statistics.fmean(later[k:k + 10]) for k in range(0, len(later) - 9))
    kept = ended_at_rest / settled_at_rest
    failures = [failure for client in clients for failure in client.failures]
    requests = sum(client.requests for client in clients)
    print(f"{given.minutes:g} min of mixed load: {requests} requests beside uploads and jobs, {len(failures)} failed")
    print(*failures[:5], sep="\n")
    each = [f"{min(minute):.0f}/{median:.0f}/{max(minute):.0f}" for minute, median in zip(minutes, medians)]
    print("RssAnon, least, median and most of each minute [MiB]:", *each)
    print(f"RssAnon: median {reference:.1f} MiB at {given.settle:g} min, of later minutes at most {max(medians[settled:]):.1f} MiB, "
          f"ratio {max(medians[settled:]) / reference:.3f}; largest ten seconds {largest:.1f} MiB, ratio {largest / reference:.3f}")
    print(f"RssAnon at rest: {settled_at_rest:.1f} MiB at {given.settle:g} min, {ended_at_rest:.1f} MiB at the end, ratio {kept:.3f}")
    sys.exit(0 if kept <= FLAT and not failures else 1)


if __name__ == "__main__":
    main()
