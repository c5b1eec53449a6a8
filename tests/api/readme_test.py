"""The README's commands for curl, run by curl itself in their order."""
from __future__ import annotations

import json
import os
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import samples
from daemon import PATIENCE_S
from suite import DaemonTest

README = Path(__file__).parents[2] / "README.md"


def commands() -> list[str]:
    """The commands of the block under "With curl", each as one text; the first names the server."""
    section = README.read_text(encoding="utf-8").split("\n## With curl\n", 1)[1].split("\n## ", 1)[0]
    block = section.split("```sh\n", 1)[1].split("```", 1)[0].replace("\\\n", "")
    return [line for line in block.splitlines() if line and not line.startswith("#")]


class WithCurl(DaemonTest):
    """One worker, which a long evaluation keeps from pooling what the last command asks for."""

    arguments = ("--workers", "1")

    def test_each_command_does_what_is_said_of_it_and_the_table_waits_for_its_pooling(self) -> None:
        server, upload, queue, wait, follow, table = commands()
        self.assertRegex(server, r"^server=http://127\.0\.0\.1:\d+$")
        server = f"server=http://127.0.0.1:{self.daemon.port}"

        def run(command: str, folder: str) -> str:
            bare = {**os.environ, "CURL_HOME": folder, "no_proxy": "*"}
            done = subprocess.run(["bash", "-c", f"{server}\n{command}"], cwd=folder, env=bare, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout

        with tempfile.TemporaryDirectory(prefix="driftlab-test-") as folder:
            ids = []
            for seed in (1, 2):
                Path(folder, "my_gyro.csv").write_bytes(samples.gyro_csv(20_000, seed=seed))
                ids.append(json.loads(run(upload, folder))["id"])
            self.assertIn('["rec_…"]', queue)
            job = json.loads(run(queue.replace('["rec_…"]', json.dumps(ids)), folder))["id"]
            long = self.expect(202, self.daemon.post("/v1/outage-evaluations", {"scenario": "paper", "runs": 100_000})).json["id"]
            self.assertIn("job_…", wait)
            while json.loads(run(wait.replace("job_…", job), folder))["finished_at"] is None:
                pass
            self.assertIn("job_…", follow)
            self.assertIn("succeeded", run(follow.replace("job_…", job), folder))
            self.assertIn("Prefer: wait=20", table)
            at_once = run(table.replace("--header 'Prefer: wait=20'", ""), folder)
            self.assertIn("pooling pending", at_once)
            threading.Timer(1.0, lambda: self.daemon.post(f"/v1/jobs/{long}/cancel")).start()
            waited = run(table, folder)
            self.assertRegex(waited, r"(?m)^static\b")
            self.assertNotIn("pending", waited)


if __name__ == "__main__":
    unittest.main()
