"""`driftlab api`: every resource of the daemon from the command line."""
from __future__ import annotations

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import samples
from daemon import PATIENCE_S
from suite import DaemonTest

PROGRAM = os.environ["DRIFTLAB"]
NEEDS_MORE = {  # what these lists ask for; streams and what an own state needs are met elsewhere
    "/v1/parameter-tables": "?device=imu-07&axis=z", "/v1/trends": "?device=imu-07&axis=z", "/v1/search": "?q=imu", "/v1/populations": "?model=line",
}


class Reached(DaemonTest):
    def api(self, *words: str, stdin: str | None = None, code: int = 0) -> str:
        done = subprocess.run([PROGRAM, "api", *words, "--server", f"http://127.0.0.1:{self.daemon.port}"], input=stdin, capture_output=True,
                              text=True, timeout=PATIENCE_S, check=False)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout if code == 0 else done.stderr

    def test_a_device_and_its_recording_come_change_and_go(self) -> None:
        made = json.loads(self.api("POST", "/v1/devices", "--data", '{"name": "imu-07", "model": "line"}'))
        self.assertEqual(made["name"], "imu-07")
        with tempfile.TemporaryDirectory(prefix="driftlab-test-") as folder:
            file = Path(folder) / "still.csv"
            file.write_bytes(samples.gyro_csv(seed=5))
            columns = f"&columns={samples.GYRO_Z}"
            stored = json.loads(self.api("/v1/recordings?device=imu-07&condition=static&rate_hz=100" + columns, "--file", str(file)))
            back = Path(folder) / "back.csv"
            self.assertEqual(self.api(f"/v1/recordings/{stored['id']}/content", "--accept", "*/*", "--output", str(back)), "")
            self.assertEqual(back.read_bytes(), file.read_bytes())
            change = Path(folder) / "change.json"
            change.write_text('{"labels": {"firmware": "1.5.0"}}', "utf-8")
            self.assertEqual(json.loads(self.api("PATCH", f"/v1/recordings/{stored['id']}", "--data", f"@{change}"))["metadata"]["labels"],
                             {"firmware": "1.5.0"})
        job = json.loads(self.api("/v1/jobs", "--data", "@-", stdin=json.dumps({"kind": "characterise", "inputs": {"recordings": [stored["id"]]}})))["id"]
        self.daemon.finished(job)
        events = [json.loads(line) for line in self.api(f"/v1/jobs/{job}/events").splitlines()]
        self.assertEqual(events[-1]["state"], "succeeded")
        self.assertTrue(self.api("/v1/parameter-tables?device=imu-07&axis=z", "--accept", "text/markdown").startswith("**"))
        for path, operations in self.contract.paths.items():
            if "get" in operations and path.startswith("/v1/") and "{" not in path and path not in ("/v1/events", "/v1/audit-verification", "/v1/structures"):
                self.assertIsInstance(json.loads(self.api(path + NEEDS_MORE.get(path, ""))), dict, path)
        self.assertIn("What depends on the device", self.api("DELETE", "/v1/devices/imu-07", code=2))
        self.assertEqual(self.api("DELETE", f"/v1/recordings/{stored['id']}"), "")
        self.assertEqual(self.api("DELETE", "/v1/devices/imu-07"), "")
        self.assertEqual(json.loads(self.api("/v1/devices"))["items"], [])

    def test_what_cannot_be_is_one_sentence(self) -> None:
        for words, part in ((("BREW", "/v1/devices"), "no method"), (("v1/devices",), "no path of a resource"), (("/v1/devices/nobody",), "nobody"),
                            (("/v1/devices", "--data", "@/no/such"), "cannot be opened"), (("/v1/recordings", "--file", "/no/such"), "cannot be opened"),
                            (("DELETE", "/v1/devices/nobody", "--file", "/etc/hostname"), "by POST"), (("/v1/devices", "--data", "{"), "JSON")):
            said = self.api(*words, code=2)
            self.assertIn(part, said)
            self.assertEqual(len(said.splitlines()), 1, said)
        gone = subprocess.run([PROGRAM, "api", "/v1/devices", "--server", "http://127.0.0.1:1"], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
        self.assertEqual(gone.returncode, 4)


if __name__ == "__main__":
    unittest.main()
