"""The Python of the manual, the examples and the notebook run as they stand."""
from __future__ import annotations

import contextlib
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

from daemon import Daemon

REPOSITORY = Path(__file__).resolve().parents[2]
EXAMPLES = REPOSITORY / "clients/python/examples"
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
DEFAULT = "http://127.0.0.1:8477"


class Examples(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)

    def run_blocks(self, page: Path) -> dict[str, Any]:
        """Every block, one after the other, in one namespace; the default address is that of a daemon of the test."""
        blocks = BLOCK.findall(page.read_text("utf-8"))
        self.assertTrue(blocks)
        names: dict[str, Any] = {"__name__": page.stem}
        with Daemon() as daemon, contextlib.redirect_stdout(io.StringIO()) as printed:
            for number, block in enumerate(blocks, start=1):
                text = block.replace(DEFAULT, f"http://127.0.0.1:{daemon.port}")
                exec(compile(text, f"{page.name}, block {number}", "exec"), names)
        names["printed"] = printed.getvalue()
        return names

    def test_every_block_of_the_manual_runs(self) -> None:
        names = self.run_blocks(REPOSITORY / "schema/docs/python.md")
        for part in ("WN", "not_a_number", "absent.csv", "100% ", "bytes"):
            self.assertIn(part, names["printed"])
        self.assertIn("<svg", Path("allan.svg").read_text("utf-8"))
        self.assertIn("gyroscope_noise_density: ", names["printed"])
        self.assertIn(names["run"]["verdict"], ("pass", "inconclusive"), "nothing was changed")
        self.assertIn("<h1>phone-07</h1>", Path("gate.html").read_text("utf-8"))

    def test_the_readme_of_the_package_runs(self) -> None:
        from driftlab import local
        local.simulate("my_gyro.csv", duration_s=100)
        local.simulate("my_gyro_after.csv", duration_s=100, seed=2)
        names = self.run_blocks(REPOSITORY / "clients/python/README.md")
        self.assertIn(names["gate"]["verdict"], ("pass", "inconclusive"), "nothing was changed")

    def test_every_script_runs(self) -> None:
        scripts = sorted(EXAMPLES.glob("*.py"))
        self.assertTrue(scripts)
        for script in scripts:
            with self.subTest(script=script.name):
                ran = subprocess.run([sys.executable, "-B", str(script)], capture_output=True, text=True, check=False)
                self.assertEqual(ran.returncode, 0, ran.stderr)
                self.assertIn("white_noise.N = ", ran.stdout)
        self.assertIn(">static, gz<", Path("allan.svg").read_text("utf-8"))

    def test_every_notebook_runs_and_shows_its_figures(self) -> None:
        notebooks = sorted(EXAMPLES.glob("*.ipynb"))
        self.assertTrue(notebooks)
        # A kernel of its own, so that no kernel that a user has installed is taken in its place.
        kernel = self.folder / "kernels/python3"
        kernel.mkdir(parents=True)
        words = [sys.executable, "-B", "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        (kernel / "kernel.json").write_text(json.dumps({"argv": words, "display_name": "Python 3", "language": "python"}))
        environment = {**os.environ, "JUPYTER_PATH": str(self.folder), "IPYTHONDIR": str(self.folder / "ipython"),
                       "JUPYTER_CONFIG_DIR": str(self.folder), "JUPYTER_RUNTIME_DIR": str(self.folder / "runtime"),
                       "JUPYTER_PLATFORM_DIRS": "0"}
        for notebook in notebooks:
            with self.subTest(notebook=notebook.name):
                stored = json.loads(notebook.read_text("utf-8"))
                self.assertEqual([cell["outputs"] for cell in stored["cells"] if cell["cell_type"] == "code" and cell["outputs"]], [],
                                 "outputs are not committed")
                (self.folder / notebook.name).write_bytes(notebook.read_bytes())
                ran = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output", "executed.ipynb",
                                      notebook.name], capture_output=True, text=True, check=False, env=environment)
                self.assertEqual(ran.returncode, 0, ran.stderr[-3000:])
                cells = [cell for cell in json.loads(Path("executed.ipynb").read_text("utf-8"))["cells"] if cell["cell_type"] == "code"]
                kinds = {kind for cell in cells for output in cell["outputs"] for kind in output.get("data", {})}
                self.assertLessEqual({"image/svg+xml", "text/html"}, kinds)
                texts = json.dumps(cells)
                self.assertIn("white_noise.N", texts)
                self.assertNotIn('"stderr"', texts)


if __name__ == "__main__":
    unittest.main()
