"""Every setting has an origin that `driftlabd config` names: flag, variable, file or default."""
from __future__ import annotations

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from daemon import PROGRAM


class ConfigurationHasOrigins(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def shown(self, *arguments: str, **environment: str) -> dict[str, dict[str, dict[str, object]]]:
        settings = {k: v for k, v in os.environ.items() if not k.startswith("DRIFTLAB_")}
        run = subprocess.run([PROGRAM, "config", "--json", *arguments], capture_output=True, text=True,
                             env={**settings, **environment}, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def refused(self, *arguments: str, **environment: str) -> str:
        settings = {k: v for k, v in os.environ.items() if not k.startswith("DRIFTLAB_")}
        run = subprocess.run([PROGRAM, "config", *arguments], capture_output=True, text=True,
                             env={**settings, **environment}, check=False)
        self.assertEqual((run.returncode, run.stdout), (2, ""), run.stderr)
        return run.stderr

    def test_flag_over_variable_over_file_over_default(self) -> None:
        file = self.folder / "driftlabd.toml"
        file.write_text('workers = 3\nio_threads = 4\nthreads = 5\nallow_host = ["a", "b"]\n[budgets]\nuploads = 7\nlabels = 9\n')
        found = self.shown("--config", str(file), "--workers", "6", "--budget", "labels=10", DRIFTLAB_IO_THREADS="8", DRIFTLAB_BUDGET_UPLOADS="11")
        told = {name: (entry["value"], entry["origin"]) for part in found.values() for name, entry in part.items()}
        self.assertEqual(told["workers"], (6, "flag --workers"))
        self.assertEqual(told["io_threads"], (8, "variable DRIFTLAB_IO_THREADS"))
        self.assertEqual(told["threads"], (5, f"file {file}"))
        self.assertEqual(told["allow_host"], (["a", "b"], f"file {file}"))
        self.assertEqual(told["listen"], ("127.0.0.1:8477", "default"))
        self.assertEqual(told["uploads"], (11, "variable DRIFTLAB_BUDGET_UPLOADS"))
        self.assertEqual(told["labels"], (10, "flag --budget"))

    def test_what_it_prints_can_be_read_again(self) -> None:
        printed = subprocess.run([PROGRAM, "config", "--workers", "2"], capture_output=True, check=True, text=True).stdout
        file = self.folder / "again.toml"
        file.write_text(printed)
        self.assertEqual(self.shown("--config", str(file))["settings"]["workers"]["value"], 2)

    def test_what_is_not_known_or_impossible_is_one_sentence(self) -> None:
        def write(text: str) -> str:
            (self.folder / "bad.toml").write_text(text)
            return str(self.folder / "bad.toml")
        self.assertIn("no setting 'colour'", self.refused("--config", write("colour = 1\n")))
        self.assertIn("no setting 'budgets.colour'", self.refused("--config", write("[budgets]\ncolour = 1\n")))
        self.assertIn("no TOML at line 2", self.refused("--config", write("workers = 1\n= 3\n")))
        self.assertIn("does not exist", self.refused("--config", str(self.folder / "absent.toml")))
        self.assertIn("from 0 to 256", self.refused("--workers", "many"))
        self.assertIn("from 1 to 10000", self.refused("--budget", "uploads=0"))
        self.assertIn("NAME=VALUE", self.refused("--budget", "uploads"))
        self.assertIn("no setting 'budgets.colour'", self.refused(DRIFTLAB_BUDGET_COLOUR="1"))
        self.assertIn("debug, info, warning or error", self.refused("--log-level", "loud"))
        self.assertIn("cannot be read", self.refused("--config", str(self.folder)))
        self.assertIn("setting allow_host", self.refused("--config", write('allow_host = [1.5, "b"]\n')))
        for with_port in ("host:8443", "[2001:db8::1]:8443"):
            self.assertIn("without a port", self.refused("--allow-host", with_port))
        self.assertIn("10.1.2.0/24, not 'not-an-ip'", self.refused("--proxies", "not-an-ip"))
        self.shown("--proxies", "10.0.0.0/8", "--proxies", "2001:db8::1", "--allow-host", "[2001:db8::1]", "--allow-host", "lab.example")

    def test_a_variable_that_is_a_letter_off_is_a_mistake_and_others_are_for_others(self) -> None:
        for slip in ("DRIFTLAB_REQUIRE_TOKEN", "DRIFTLAB_WORKERSS", "DRIFTLAB_WORKRS", "DRIFTLAB_LOG_LEVAL"):
            self.assertIn(f"no variable {slip}", self.refused(**{slip: "1"}))
        self.shown(DRIFTLAB_SERVICE_HOST="10.0.0.1", DRIFTLAB_PORT="tcp://10.0.0.1:8477", DRIFTLAB_SHARED="../shared")


if __name__ == "__main__":
    unittest.main()
