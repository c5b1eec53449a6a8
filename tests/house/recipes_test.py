"""The recipes of CONTRIBUTING.md, carried out: a toy of each growth axis costs the files that its recipe lists, no more, and works.

Each test copies the tree, adds the toy of tests/house/toys/<recipe>/ (whole new files, and the edits of existing ones as `FILE.edit`),
runs what the recipe says to run, builds what it speaks of with the release preset, and tries it. Unchanged sources come out of ccache.
At the end the copy differs from the tree in exactly the files that the recipe lists.

A recipe lists a file where a numbered step quotes its path from the top; what stands in parentheses is only referred to. `<name>` is
the toy's name there, `<resource>` that of its endpoint, `<group>` any word; a folder stands for files below it.
"""
from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import tree

ROOT = Path(__file__).resolve().parent.parent.parent
TOYS = Path(__file__).resolve().parent / "toys"
PATIENCE_S = 1500
TOPS = ("core", "schema", "server", "clients", "migrations", "tests", "deploy")
PLACES = {"<name>": "toy", "<resource>": "toys", "<group>": r"\w+"}


def recipe(title: str) -> str:
    """The section of CONTRIBUTING.md under that heading."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    found = re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found, f"CONTRIBUTING.md has no recipe '{title}'"
    return found.group(1)


def listed(text: str) -> dict[str, re.Pattern[str]]:
    """The files that a recipe costs, as it quotes them, each with the names that it allows."""
    steps = "\n".join(re.findall(r"^\d+\. .*(?:\n {3}.*)*", text, re.MULTILINE))
    quoted = re.findall(r"`([^`\s]+)`", re.sub(r"\([^()]*\)", "", steps))
    patterns = {}
    for name in quoted:
        if "/" in name and name.split("/")[0] in TOPS:
            pattern = re.sub(r"<\w+>", lambda place: PLACES[place.group(0)], name.replace(".", r"\."))
            patterns[name] = re.compile(pattern + (".*" if name.endswith("/") else ""))
    return patterns


def state_of(folder: Path) -> dict[str, str]:
    """Every file that no build made, with its hash."""
    return {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in tree.files(folder)}


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
    commands: tuple[str, ...] = ()  # Python programs that the recipe says to run
    left_out: tuple[str, ...] = ()  # what it lists and the toy does not do

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-recipe-")))
        cls.scratch = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-recipe-")))
        copy_of_the_tree(cls.folder)
        cls.before = state_of(cls.folder)
        for path in sorted(p for p in (TOYS / cls.toy).rglob("*") if p.is_file()):
            name = path.relative_to(TOYS / cls.toy).as_posix()
            if name.endswith(".edit"):
                put_in(cls.folder / name.removesuffix(".edit"), path.read_text())
            else:
                (cls.folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, cls.folder / name)
        for command in cls.commands:
            subprocess.run([sys.executable, "-B", command], cwd=cls.folder, check=True, timeout=PATIENCE_S)

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

    def test_z_the_tree_differs_in_what_the_recipe_lists(self) -> None:
        """The last of its class: what building and trying the toy leaves behind counts too."""
        after = state_of(self.folder)
        changed = sorted(name for name in self.before.keys() | after.keys() if self.before.get(name) != after.get(name))
        costs = listed("".join(recipe(title) for title in (self.title, *self.also)))
        for name in changed:
            self.assertTrue(any(pattern.fullmatch(name) for pattern in costs.values()), f"the recipe '{self.title}' does not list {name}")
        for name, pattern in costs.items():
            found = any(pattern.fullmatch(change) for change in changed)
            self.assertNotEqual(found, name in self.left_out, f"the recipe '{self.title}' lists {name}; the toy changed {changed}")


class AddACause(Recipe, unittest.TestCase):
    title = "Add a cause"
    toy = "cause"
    left_out = ("tests/corpus/golden/",)  # renewing it takes both programs and every investigation of the corpus, minutes

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
    commands = ("clients/python/generate_contract.py",)

    def test_command_job_and_endpoint_give_one_answer(self) -> None:
        self.house_stands()
        programs = self.build("driftlab", "driftlabd", "test_analysis")
        self.run_here(programs / "test_analysis", "--gtest_filter=Toy.*")
        self.run_here(sys.executable, "-B", "tests/house/documents.py", DRIFTLAB_BIN=str(programs))
        here = {"DRIFTLAB": str(programs / "driftlab"), "DRIFTLABD": str(programs / "driftlabd"),
                "PYTHONPATH": os.pathsep.join(str(self.folder / part) for part in ("tests/api", "clients/python"))}
        for suite in ("tests/api/contract_test.py", "tests/python/contract_test.py"):
            self.run_here(PYTHON, "-B", suite, **here)
        (self.scratch / "ask.py").write_text(ASK)
        said = self.run_here(PYTHON, "-B", self.scratch / "ask.py", **here)
        (self.scratch / "gyro.csv").write_text(GYRO)
        local = json.loads(self.run_here(programs / "driftlab", "toy", self.scratch / "gyro.csv", "--rate-hz", "10", "--columns", "gz=angular_rate:z:deg/s"))
        self.assertEqual([m["mean"] for m in json.loads(said)["means"]], [2.0])
        self.assertEqual([m["mean"] for m in local["means"]], [2.0])


# The Python client's suites need NumPy, which Debian's Python has.
PYTHON = "/usr/bin/python3" if Path("/usr/bin/python3").exists() else sys.executable
GYRO = "gz\n" + "1.0\n2.0\n3.0\n2.0\n" * 16
# The result is read where the server says that it is.
ASK = f'''import json
from daemon import Daemon
from events_test import stream, until
with Daemon() as daemon:
    recording = daemon.upload({GYRO!r}.encode(), rate_hz=10, columns="gz=angular_rate:z:deg/s").json["id"]
    with stream(daemon, "?topics=results") as events:
        job = daemon.finished(daemon.post("/v1/jobs", {{"kind": "toy", "inputs": {{"recordings": [recording]}}}}).json["id"])
        assert job["state"] == "succeeded", job
        told = until(events, "result.created")[-1][2]
    assert told["href"] == "/v1/toys/" + job["id"], told
    print(json.dumps(daemon.get(told["href"]).json))
'''


if __name__ == "__main__":
    unittest.main()
