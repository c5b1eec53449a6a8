#!/usr/bin/env python3
"""The container: built from deploy/container/Containerfile, run, asked for its main job, stopped, and run again on the same data.

Label long: it installs the build's packages in a Debian image and compiles driftlab there. Where no image registry is reached, a Debian 12
root that mmdebstrap makes of the packages of this machine's mirror stands for debian:12-slim; $DRIFTLAB_CONTAINER_BASE is an archive of one
that is there already. Authorities that this machine trusts beside Debian's go into the base, for npm reaches its registry by HTTPS.
$DRIFTLAB_CONTAINER_CCACHE is a folder of ccache that the build uses, such as ~/.cache/ccache where the same sources were compiled before.
Needs buildah; says so where it, or whatever the base could come from, is absent.

Buildah runs what it built without a container engine (`--isolation chroot`), so that the test also works inside another container. Images lie
in a folder of the test and go with it.
"""
from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
GIVEN = os.environ.get("DRIFTLAB_CONTAINER_BASE")
COMPILED = os.environ.get("DRIFTLAB_CONTAINER_CCACHE")
DEBIAN = "debian:12-slim"
BASE = "localhost/driftlab-test-base"
IMAGE = "localhost/driftlab-test"
AUTHORITIES = Path("/usr/local/share/ca-certificates")
ISOLATED = ["--isolation", "chroot", "--network", "host"]
STORE: list[str] = []  # where buildah keeps the images of this test


def run(*words: str, limit_s: float = 300) -> str:
    ran = subprocess.run(words, capture_output=True, text=True, check=False, timeout=limit_s)
    assert ran.returncode == 0, f"{words}: {ran.returncode}\n{ran.stdout[-3000:]}{ran.stderr[-3000:]}"
    return ran.stdout.strip()


def buildah(*words: str, limit_s: float = 300) -> str:
    return run("buildah", *STORE, *words, limit_s=limit_s)


def open_store(folder: Path) -> None:
    """Images as layers over each other where the file system has that, else as copies."""
    for driver in ("overlay", "vfs"):
        STORE[:] = ["--root", str(folder / driver), "--runroot", str(folder / f"{driver}-run"), "--storage-driver", driver]
        try:
            buildah("run", *ISOLATED, buildah("from", "scratch"), "--", "/nothing")
        except AssertionError as refused:
            if "/nothing" in str(refused):  # it was mounted, and is empty
                buildah("rm", "--all")
                return
    raise AssertionError("buildah can keep no image here")


def base_container(folder: Path) -> str:
    """A container of debian:12-slim or of what stands for it. Skips where it can come from nowhere."""
    if GIVEN is None:
        try:
            return buildah("from", DEBIAN)
        except AssertionError as unreachable:
            print(f"no image registry: {str(unreachable).splitlines()[-1]}", file=sys.stderr)
        if shutil.which("mmdebstrap") is None:
            raise unittest.SkipTest("SKIPPED: no image registry is reached, and there is no mmdebstrap to make a base (apt-get install mmdebstrap)")
        run("mmdebstrap", "--variant=minbase", "bookworm", str(folder / "base.tar"), limit_s=1800)
    container = buildah("from", "scratch")
    buildah("add", container, GIVEN or str(folder / "base.tar"), "/")
    return container


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Running:
    """The image's entry point in a container made from it, on a port of loopback; the data lie in a folder outside."""

    def __init__(self, container: str, data: Path) -> None:
        self.port = free_port()
        entry = json.loads(buildah("inspect", container))["OCIv1"]["config"]["Entrypoint"]
        self.process = subprocess.Popen(
            ["buildah", *STORE, "run", *ISOLATED, "--volume", f"{data}:/var/lib/driftlab:rw", "--env", f"DRIFTLAB_LISTEN=127.0.0.1:{self.port}",
             container, "--", *entry], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for _ in range(300):
            try:
                if self.get("/readyz")[0] == 200:
                    return
            except OSError:
                pass
            assert self.process.poll() is None, self.process.stdout.read() if self.process.stdout else ""
            time.sleep(0.1)
        self.stop()
        raise AssertionError("the daemon in the container was not ready within 30 s")

    def request(self, method: str, target: str, body: bytes | None = None, **headers: str) -> tuple[int, bytes]:
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{target}", data=body, method=method,
                                         headers={name.replace("_", "-"): value for name, value in headers.items()})
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, answer.read()
        except urllib.error.HTTPError as refused:
            return refused.code, refused.read()

    def get(self, target: str, **headers: str) -> tuple[int, bytes]:
        return self.request("GET", target, **headers)

    def daemon(self) -> int:
        """The daemon's process: buildah would kill it where it is asked to end itself, so the test asks the daemon."""
        family = {self.process.pid}
        for _ in range(10):  # buildah starts itself twice before the program
            for status in Path("/proc").glob("[0-9]*/stat"):
                try:
                    pid, rest = status.read_text().split(" ", 1)
                    name, after = rest[1:].rsplit(")", 1)
                except OSError:
                    continue  # it ended meanwhile
                if int(after.split()[1]) in family:
                    family.add(int(pid))
                    if name == "driftlabd":
                        return int(pid)
        raise AssertionError("no process of the daemon")

    def stop(self) -> int:
        if self.process.poll() is None:
            os.kill(self.daemon(), signal.SIGTERM)
        code = self.process.wait(30)
        if self.process.stdout:
            self.process.stdout.close()
        return code


@unittest.skipUnless(shutil.which("buildah"), "SKIPPED: the container is not built, for there is no buildah (apt-get install buildah mmdebstrap)")
class Container(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        open_store(folder / "images")
        cls.addClassCleanup(lambda: (buildah("rm", "--all"), buildah("rmi", "--all", "--force")))
        begun = time.monotonic()
        base = base_container(folder)
        for authority in sorted(AUTHORITIES.glob("*.crt")):
            buildah("copy", base, str(authority), f"{AUTHORITIES}/")
        home = buildah("run", *ISOLATED, base, "--", "sh", "-c", "echo ~")
        buildah("commit", base, BASE)
        print(f"base made in {time.monotonic() - begun:.0f} s", file=sys.stderr)
        described = folder / "Containerfile"
        text = (REPOSITORY / "deploy/container/Containerfile").read_text()
        described.write_text(text.replace(f"FROM {DEBIAN}", f"FROM {BASE}"))
        begun = time.monotonic()
        compiled = ["--volume", f"{COMPILED}:{home}/.cache/ccache:rw"] if COMPILED else []
        buildah("build", *ISOLATED, *compiled, "--file", str(described), "--tag", IMAGE, str(REPOSITORY), limit_s=7200)
        print(f"container built in {time.monotonic() - begun:.0f} s", file=sys.stderr)

    def test_it_does_its_main_job_as_an_ordinary_user_and_keeps_its_data(self) -> None:
        container = buildah("from", IMAGE)
        self.addCleanup(buildah, "rm", container)
        user = json.loads(buildah("inspect", container))["OCIv1"]["config"]["User"]
        self.assertEqual(user, "8477", "no root in it")
        self.assertEqual(buildah("run", *ISOLATED, container, "--", "id", "-u"), "8477")
        self.assertNotIn("g++", buildah("run", *ISOLATED, container, "--", "ls", "/usr/bin").split(), "no compiler is shipped")
        with tempfile.TemporaryDirectory() as folder:
            data = Path(folder)
            os.chown(data, 8477, 8477)
            daemon = Running(container, data)
            try:
                rows = recording()
                target = "/v1/recordings?device=imu-1&condition=static&rate_hz=100"
                status, answer = daemon.request("POST", target, rows, Content_Type="text/csv")
                self.assertEqual(status, 201, answer)
                job = json.loads(self.job(daemon, json.loads(answer)["id"]))
                self.assertEqual(job["state"], "succeeded", job)
                table = self.table(daemon)
                self.assertIn(b"white", table.lower())
                self.assertEqual(daemon.get("/")[0], 200, "the dashboard is in it")
            finally:
                self.assertEqual(daemon.stop(), 0)
            again = Running(container, data)
            try:
                self.assertEqual(self.table(again), table, "what was stored is there after the container has gone")
            finally:
                self.assertEqual(again.stop(), 0)

    def job(self, daemon: Running, recording_id: str) -> bytes:
        wish = json.dumps({"kind": "characterise", "inputs": {"recordings": [recording_id]}, "parameters": {"models": ["WN"]}}).encode()
        status, answer = daemon.request("POST", "/v1/jobs", wish, Content_Type="application/json", Prefer="wait=60")
        self.assertIn(status, (200, 201, 202), answer)
        href = f"/v1/jobs/{json.loads(answer)['id']}"
        for _ in range(600):
            answer = daemon.get(href)[1]
            if json.loads(answer)["state"] in ("succeeded", "failed", "cancelled"):
                break
            time.sleep(0.1)
        return answer

    def table(self, daemon: Running) -> bytes:
        status, answer = daemon.get("/v1/parameter-tables?device=imu-1&sensor=gyroscope&axis=x", Prefer="wait=30")
        self.assertEqual(status, 200, answer)
        return answer


def recording() -> bytes:
    """White noise that everybody gets again: a linear congruential generator, twelve of its values summed."""
    state, lines = 20261124, ["gx [deg/s]"]
    for _ in range(20_000):
        total = -6.0
        for _ in range(12):
            state = (6364136223846793005 * state + 1442695040888963407) % 2**64
            total += (state >> 11) / 2**53
        lines.append(f"{0.01 * total:.6f}")
    return ("\n".join(lines) + "\n").encode()


if __name__ == "__main__":
    unittest.main(verbosity=2)
