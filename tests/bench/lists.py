#!/usr/bin/env python3
"""How long lists take in a lab's store: what each filter and order costs for one page of 50.

usage: lists.py [DEVICES [RECORDINGS [RESULTS]]]     (default 1000 20000 1; DRIFTLABD is the daemon)

Fills a store through the API, characterises RESULTS recordings of each device, and asks for each list 21 times in turn. Before each turn a
device is changed, so that no answer is one that was kept. Prints a table of the median
and the slowest answer in ms, as bench/lists.md holds it.
"""
from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "api"))
import samples  # noqa: E402 - beside the tests
from daemon import Daemon  # noqa: E402

REPEATS = 21
AT_ONCE = 4
WANTED_MS = 50.0  # of a search (dashboard brief, need A3)


def fill(daemon: Daemon, devices: int, recordings: int, results: int) -> None:
    base = samples.gyro_csv(256)

    def recorded(i: int) -> None:
        rate = i // devices % 5
        condition = "static" if rate == 0 else f"constant_rate:z:{10 * rate}:deg/s"
        content = base + f"{i / 1e6:.6f}\n".encode()
        answer = daemon.upload(content, device=f"unit-{i % devices:04d}", id=f"run {i:05d} bench", condition=condition, rate_hz=100,
                               columns=samples.GYRO_Z)
        assert answer.status == 201, answer.describe()
        if i < devices * results:
            assert daemon.characterise(answer.json["id"], models=["WN"]).status in (201, 202)

    with ThreadPoolExecutor(AT_ONCE) as pool:
        list(pool.map(recorded, range(recordings)))
    while daemon.get("/v1/counts").json["jobs"]["queued"] + daemon.get("/v1/counts").json["jobs"]["running"] > 0:
        time.sleep(0.5)


def lists(devices: int, recordings: int) -> dict[str, Callable[[int], str]]:
    """What is asked, by its name in the table; the argument differs each time."""
    last = f"unit-{devices - 1:04d}"

    def since(i: int) -> str:
        return f"since=2020-01-01T00:00:{i:02d}Z"
    return {
        "devices, by name": lambda i: "/v1/devices?sort=name&limit=50",
        "devices with summary, newest first": lambda i: "/v1/devices?include=summary&sort=-created_at&limit=50",
        "recordings, newest first": lambda i: f"/v1/recordings?sort=-created_at&{since(i)}",
        "recordings, by name": lambda i: f"/v1/recordings?sort=name&{since(i)}",
        "recordings, q of all": lambda i: f"/v1/recordings?q=bench&{since(i)}",
        "recordings, q of one": lambda i: f"/v1/recordings?q={recordings - 1 - i:05d}",
        "recordings, q of none": lambda i: f"/v1/recordings?q=nowhere{i}",
        "recordings with a result": lambda i: f"/v1/recordings?has_result=true&sort=-created_at&{since(i)}",
        "recordings without a result": lambda i: f"/v1/recordings?has_result=false&sort=-created_at&{since(i)}",
        "recordings of a device, q": lambda i: f"/v1/recordings?device={last}&q=constant_rate&{since(i)}",
        "recordings since now": lambda i: f"/v1/recordings?since=2100-01-01T00:00:{i:02d}Z",
        "jobs of a device": lambda i: f"/v1/jobs?device=unit-{10 * i % devices:04d}&sort=-created_at",
        "investigations, q": lambda i: f"/v1/investigations?q=unit{i}&{since(i)}",
        "attention": lambda i: f"/v1/attention?{since(i)}",
        "counts": lambda i: f"/v1/counts?{since(i)}",
        "search, beginning": lambda i: f"/v1/search?q=unit-{i:03d}&limit=10",
        "search, a recording": lambda i: f"/v1/search?q={recordings - 1 - i:05d}&limit=10",
        "search, a condition": lambda i: f"/v1/search?q={10 * (i % 4 + 1)}%20deg/s&limit={10 + i}",
        "search, beginning of an id": lambda i: f"/v1/search?q=rec_01{i % 10}&limit={10 + i}",
        "search, nothing": lambda i: f"/v1/search?q=nowhere{i}&limit=10",
        "devices, q of one": lambda i: f"/v1/devices?include=summary&q=nit-{devices - 1 - i:04d}",
    }


def main() -> None:
    devices, recordings, results = (int(given) for given in (sys.argv[1:] + ["1000", "20000", "1"][len(sys.argv) - 1:]))
    with Daemon() as daemon:
        began = time.monotonic()
        fill(daemon, devices, recordings, results)
        print(f"{devices} devices, {recordings} recordings stored in {time.monotonic() - began:.0f} s\n")
        print("| list | median ms | slowest ms | rows |\n|---|---|---|---|")
        asked = lists(devices, recordings)
        took: dict[str, list[float]] = {name: [] for name in asked}
        rows: dict[str, int] = {}
        changed = "/v1/devices/" + daemon.get("/v1/devices?limit=1").json["items"][0]["id"]
        for i in range(REPEATS):
            revision = {"If-Match": daemon.get(changed).headers["etag"]}
            assert daemon.request("PATCH", changed, {"serial": str(i)}, revision).status == 200
            for name, target in asked.items():
                start = time.perf_counter()
                answer = daemon.get(target(i))
                took[name].append(1000.0 * (time.perf_counter() - start))
                assert answer.status == 200, answer.describe()
                rows[name] = len(answer.json.get("items", []))
        for name, times in took.items():
            print(f"| {name} | {statistics.median(times):.1f} | {max(times):.1f} | {rows[name]} |")
        slow = [name for name, times in took.items() if statistics.median(times) > WANTED_MS]
        print("\nSlower than 50 ms: " + (", ".join(slow) or "none"))


if __name__ == "__main__":
    main()
