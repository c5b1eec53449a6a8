"""A job states what it would take, and is refused, made to wait or ended by its budget (tests/RELIABILITY.md)."""
from __future__ import annotations

import json
import os
import random
import time
import unittest
from pathlib import Path

from daemon import Answer, Daemon
from samples import stamped_csv

SOURCE = Path(__file__).resolve().parents[2]


class JobsHaveABudget(unittest.TestCase):
    def test_a_drive_of_a_day_is_refused_before_it_takes_anything(self) -> None:
        with Daemon(arguments=("--budget", "job_memory_bytes=1000000000")) as daemon:
            scenario = json.loads((SOURCE / "tests/api/long_drive.json").read_text())
            for answer in (daemon.post("/v1/jobs", {"kind": "outage_evaluation", "inputs": {"scenario": scenario}}),
                           daemon.post("/v1/outage-evaluations", {"scenario": scenario})):
                self.assertEqual(answer.status, 413, answer.describe())
                self.assertIn("(budget job_memory_bytes = ", answer.json["detail"])
            self.assertLess(daemon.memory_kib("VmHWM"), 200 * 1024)

    def test_a_regression_run_is_admitted_by_the_results_that_it_reads(self) -> None:
        """It stated nothing but the least that every job takes. 32 MiB and 128 KiB for each of six results are 34,340,864."""
        noise = random.Random(6)
        with Daemon(arguments=("--budget", "job_memory_bytes=34300000")) as daemon:
            ids = []
            for _ in range(6):
                table = "gz [deg/s]\n" + "".join(f"{noise.gauss(0.0, 0.05):.6f}\n" for _ in range(6000))
                ids.append(daemon.upload(table.encode(), device="gated", rate_hz=100).json["id"])
                self.assertEqual(daemon.finished(daemon.characterise(ids[-1], models=["WN"]).json["id"])["state"], "succeeded")

            def ask(of_arm: int) -> Answer:
                arms = {name: {"labels": {"firmware": name}, "recordings": [{"recording": each} for each in part[:of_arm]]}
                        for name, part in (("baseline", ids[:3]), ("candidate", ids[3:]))}
                return daemon.post("/v1/jobs", {"kind": "regress", "inputs": {"device": "gated", **arms}})

            refused = ask(3)
            self.assertEqual(refused.status, 413, refused.describe())
            self.assertRegex(refused.json["detail"], r"would take about 32 MiB of memory.*\(budget job_memory_bytes = 34300000\)")
            admitted = ask(2)
            self.assertEqual(admitted.status, 202, admitted.describe())
            self.assertEqual(daemon.finished(admitted.json["id"])["state"], "succeeded")

    @unittest.skipIf(os.environ.get("DRIFTLAB_SANITIZE"), "sanitizers keep memory of their own")
    def test_an_investigation_takes_no_more_than_it_is_admitted_for(self) -> None:
        most = 75_000_000  # 32 MiB and 89 bytes for each of 400,000 samples are 69,154,432; it was once 220 a sample
        noise = random.Random(5)
        table = "gz [deg/s]\n" + "".join(f"{noise.gauss(0.0, 0.05):.6f}\n" for _ in range(400_000))
        with Daemon(arguments=("--budget", f"job_memory_bytes={most}", "--workers", "1")) as daemon:
            recording = daemon.upload(table.encode(), rate_hz=100).json["id"]
            study = daemon.post("/v1/studies", {"device": {"id": "phone-07"}, "recordings": [{"recording": recording}]}).json["id"]
            before = daemon.memory_kib("RssAnon")
            job = daemon.post("/v1/jobs", {"kind": "investigate", "inputs": {"study": study}})
            self.assertEqual(job.status, 202, job.describe())
            largest = 0
            until = time.monotonic() + 120
            while time.monotonic() < until and not daemon.get(f"/v1/jobs/{job.json['id']}").json["finished_at"]:
                largest = max(largest, daemon.memory_kib("RssAnon") - before)
                time.sleep(0.02)
            self.assertEqual(daemon.finished(job.json["id"])["state"], "succeeded")
            self.assertLess(largest * 1024, most)
            self.assertGreater(largest, 0)

    def test_a_job_has_a_deadline_that_is_named(self) -> None:
        with Daemon(arguments=("--budget", "job_seconds=1", "--workers", "1")) as daemon:
            recording = daemon.upload(stamped_csv(400_000)).json["id"]
            job = daemon.characterise(recording, bootstrap=2000).json
            ended = daemon.finished(job["id"])
            self.assertEqual(ended["state"], "failed")
            self.assertIn("(budget job_seconds = 1)", ended["problem"]["detail"])

    def test_a_job_that_could_not_end_in_time_is_refused_before_it_begins(self) -> None:
        with Daemon(arguments=("--budget", "job_seconds=1")) as daemon:
            recording = daemon.upload(stamped_csv(1_500_000)).json["id"]
            for answer in (daemon.characterise(recording),
                           daemon.post("/v1/jobs", {"kind": "outage_evaluation", "inputs": {"scenario": "paper"}, "parameters": {"runs": 100_000}})):
                self.assertEqual(answer.status, 413, answer.describe())
                self.assertIn("(budget job_seconds = 1)", answer.json["detail"])
            self.assertEqual(daemon.items("/v1/jobs"), [])

    def test_jobs_that_would_not_fit_together_wait_for_each_other(self) -> None:
        with Daemon(arguments=("--budget", "job_memory_bytes=60000000", "--workers", "2", "--threads", "2")) as daemon:
            recordings = [daemon.upload(stamped_csv(400_000 + i)).json["id"] for i in range(2)]
            jobs = [daemon.characterise(r).json["id"] for r in recordings]
            stages = set()
            until = time.monotonic() + 60
            while time.monotonic() < until:
                states = [daemon.get(f"/v1/jobs/{job}").json for job in jobs]
                stages |= {s["stage"] for s in states if s["state"] == "running"}
                if all(s["finished_at"] for s in states):
                    break
                time.sleep(0.02)
            self.assertTrue(all(s["state"] == "succeeded" for s in states), states)
            self.assertIn("wait for memory", stages)

    def test_the_queue_has_a_length(self) -> None:
        with Daemon(arguments=("--budget", "queued_jobs=2", "--workers", "1")) as daemon:
            recording = daemon.upload(stamped_csv(300_000)).json["id"]
            answers = [daemon.characterise(recording, seed=seed) for seed in range(6)]
            full = [a for a in answers if a.status == 503]
            self.assertTrue(full, [a.status for a in answers])
            self.assertIn("(budget queued_jobs = 2)", full[0].json["detail"])
            self.assertIn("retry-after", full[0].headers)


if __name__ == "__main__":
    unittest.main()
