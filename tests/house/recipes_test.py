"""The recipes of CONTRIBUTING.md, carried out: a toy of each growth axis costs the files that its recipe lists, and works.

Each test copies the tree, adds the toy of tests/house/toys/<recipe>/ (whole new files, and the edits of existing ones as `FILE.edit`),
builds what the recipe speaks of with the release preset, and runs it. Unchanged sources come out of ccache.
"""
from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
TOYS = Path(__file__).resolve().parent / "toys"
PATIENCE_S = 1500


def recipe(title: str) -> str:
    """The section of CONTRIBUTING.md under that heading."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    found = re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found, f"CONTRIBUTING.md has no recipe '{title}'"
    return found.group(1)


def copy_of_the_tree(folder: Path) -> None:
    names = subprocess.run(["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                           capture_output=True, check=True).stdout.decode().split("\0")
    for name in filter(None, names):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)


def put_in(target: Path, edits: str) -> None:
    """Each edit, behind a line of dashes, is a piece of text that stands there once, a line of equals signs, and what stands there then."""
    text = target.read_text()
    for edit in edits.removesuffix("\n").split("\n----\n"):
        old, _, new = edit.partition("\n====\n")
        assert text.count(old) == 1, f"{target.name} does not hold once: {old}"
        text = text.replace(old, new)
    target.write_text(text)


class Recipe:
    """A toy, put into a copy of the tree; the base of every test here."""

    title: str
    toy: str
    also: tuple[str, ...] = ()

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-recipe-")))
        copy_of_the_tree(cls.folder)
        cls.touched: list[str] = []
        for path in sorted(p for p in (TOYS / cls.toy).rglob("*") if p.is_file()):
            name = path.relative_to(TOYS / cls.toy).as_posix()
            if name.endswith(".edit"):
                name = name.removesuffix(".edit")
                put_in(cls.folder / name, path.read_text())
            else:
                (cls.folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, cls.folder / name)
            cls.touched.append(name)

    def build(self, *targets: str) -> Path:
        """Configures and builds as ./tests/run.sh does; the folder of the programs."""
        for command in (["cmake", "--preset", "release", "-DDRIFTLAB_TESTS=ON", "-DDRIFTLAB_BENCH=OFF", "-DDRIFTLAB_DASHBOARD=OFF"],
                        ["cmake", "--build", "--preset", "release", "--parallel", str(os.cpu_count()), "--target", *targets]):
            done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            self.assertEqual(done.returncode, 0, (done.stdout + done.stderr)[-6000:])
        return self.folder / "build/release/bin"

    def run_here(self, *command: str | Path, **environment: str) -> str:
        done = subprocess.run([str(part) for part in command], cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE_S,
                              env={**os.environ, **environment}, check=False)
        self.assertEqual(done.returncode, 0, (done.stdout + done.stderr)[-6000:])
        return done.stdout

    def house_stands(self) -> None:
        for rule in ("floors.py", "causes.py", "licence.py"):
            self.run_here(sys.executable, "-B", f"tests/house/{rule}")

    def test_the_recipe_lists_what_it_costs(self) -> None:
        said = "".join(recipe(title) for title in (self.title, *self.also))
        listed = [re.sub(r"<\w+>", r"\\w+", re.escape(quoted).replace(r"\<", "<").replace(r"\>", ">")) for quoted in re.findall(r"`([^`\n]+)`", said)]
        for name in self.touched:
            self.assertTrue(any(re.fullmatch(pattern, name) for pattern in listed), f"the recipe '{self.title}' does not list {name}")


class AddACause(Recipe, unittest.TestCase):
    title = "Add a cause"
    toy = "cause"

    def test_it_is_hidden_found_and_held_to_its_law(self) -> None:
        self.house_stands()
        programs = self.build("test_hidden")
        said = self.run_here(programs / "test_hidden", "--gtest_filter=*toy*")
        self.assertIn("[  PASSED  ]", said)
        for law in ("IsNamed", "Injection"):
            self.assertRegex(said, rf"\[       OK \] \S*{law}\S*/toy", "the toy is hidden, found, and held to its closed form")


class AddAUseCase(Recipe, unittest.TestCase):
    title = "Add a use case"
    toy = "use_case"
    also = ("Add a job kind", "Add an endpoint")  # the recipe sends there

    def test_command_job_and_endpoint_give_one_answer(self) -> None:
        self.run_here(sys.executable, "-B", "clients/python/generate_contract.py")
        self.house_stands()
        programs = self.build("driftlab", "driftlabd", "test_analysis")
        self.run_here(programs / "test_analysis", "--gtest_filter=Toy.*")
        self.run_here(sys.executable, "-B", "tests/house/documents.py", DRIFTLAB_BIN=str(programs))
        here = {"DRIFTLAB": str(programs / "driftlab"), "DRIFTLABD": str(programs / "driftlabd"),
                "PYTHONPATH": os.pathsep.join(str(self.folder / part) for part in ("tests/api", "clients/python"))}
        for suite in ("tests/api/contract_test.py", "tests/python/contract_test.py"):
            self.run_here(PYTHON, "-B", suite, **here)
        (self.folder / "ask.py").write_text(ASK)
        said = self.run_here(sys.executable, "-B", "ask.py", **here)
        (self.folder / "gyro.csv").write_text(GYRO)
        local = json.loads(self.run_here(programs / "driftlab", "toy", "gyro.csv", "--rate-hz", "10", "--columns", "gz=angular_rate:z:deg/s"))
        self.assertEqual([m["mean"] for m in json.loads(said)["means"]], [2.0])
        self.assertEqual([m["mean"] for m in local["means"]], [2.0])


# The Python client's suites need NumPy, which Debian's Python has.
PYTHON = "/usr/bin/python3" if Path("/usr/bin/python3").exists() else sys.executable
GYRO = "gz\n" + "1.0\n2.0\n3.0\n2.0\n" * 16
ASK = f'''import json
from daemon import Daemon
with Daemon() as daemon:
    recording = daemon.upload({GYRO!r}.encode(), rate_hz=10, columns="gz=angular_rate:z:deg/s").json["id"]
    job = daemon.finished(daemon.post("/v1/jobs", {{"kind": "toy", "inputs": {{"recordings": [recording]}}}}).json["id"])
    assert job["state"] == "succeeded", job
    print(json.dumps(daemon.get("/v1/toys/" + job["id"]).json))
'''


if __name__ == "__main__":
    unittest.main()
