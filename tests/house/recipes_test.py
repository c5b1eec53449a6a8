"""The recipes of CONTRIBUTING.md, carried out: a toy of each growth axis costs the files that its recipe lists, no more, and works.

A copy of the tree takes the toys of tests/house/toys/<recipe>/ one after the other (whole new files, and the edits of existing ones as
`FILE.edit`), with what each recipe says to run. What they speak of is built with the release preset, unchanged sources out of ccache, and
tried. Each toy changed exactly the files that its recipe lists, and nothing was left behind.

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


def recipe(title: str) -> str:
    """The section of CONTRIBUTING.md under that heading."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    found = re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found, f"CONTRIBUTING.md has no recipe '{title}'"
    return found.group(1)


def listed(text: str, toy: str) -> dict[str, re.Pattern[str]]:
    """The files that a recipe costs, as it quotes them, each with the names that it allows."""
    steps = "\n".join(re.findall(r"^\d+\. .*(?:\n {3}.*)*", text, re.MULTILINE))
    quoted = re.findall(r"`([^`\s]+)`", re.sub(r"\([^()]*\)", "", steps))
    places = {"<name>": toy, "<resource>": f"{toy}s", "<group>": r"\w+"}
    patterns = {}
    for name in quoted:
        if "/" in name and name.split("/")[0] in TOPS:
            pattern = re.sub(r"<\w+>", lambda place: places[place.group(0)], name.replace(".", r"\."))
            patterns[name] = re.compile(pattern + (".*" if name.endswith("/") else ""))
    return patterns


def state_of(folder: Path) -> dict[str, str]:
    """Every file that no build made, with its hash."""
    return {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in tree.files(folder)}


def differing(before: dict[str, str], after: dict[str, str]) -> list[str]:
    return sorted(name for name in before.keys() | after.keys() if before.get(name) != after.get(name))


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
    """A recipe with its toy."""

    def __init__(self, title: str, name: str, folder: str, also: tuple[str, ...] = (), commands: tuple[str, ...] = (),
                 left_out: tuple[str, ...] = ()) -> None:
        self.titles = (title, *also)  # the recipes that this one sends to are its own too
        self.name = name  # of its toy; another than that of the others, which must not know it
        self.toy = TOYS / folder
        self.commands = commands  # Python programs that it says to run
        self.left_out = left_out  # what it lists and the toy does not do
        self.changed: list[str] = []  # files, once it is carried out

    def carry_out(self, folder: Path) -> None:
        before = state_of(folder)
        for path in sorted(p for p in self.toy.rglob("*") if p.is_file()):
            name = path.relative_to(self.toy).as_posix()
            if name.endswith(".edit"):
                put_in(folder / name.removesuffix(".edit"), path.read_text())
            else:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, folder / name)
        for command in self.commands:
            subprocess.run([sys.executable, "-B", command], cwd=folder, check=True, timeout=PATIENCE_S)
        self.changed = differing(before, state_of(folder))


class GrowthAxes(unittest.TestCase):
    """Both toys in one copy of the tree, for its build costs minutes."""

    # Renewing the golden results takes every investigation of the corpus, minutes.
    cause = Recipe("Add a cause", "square_wave", "cause", left_out=("tests/corpus/golden/",))
    use_case = Recipe("Add a use case", "toy", "use_case", also=("Add a job kind", "Add an endpoint"),
                      commands=("clients/python/generate_contract.py",))

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-recipe-")))
        cls.scratch = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="driftlab-recipe-")))
        copy_of_the_tree(cls.folder)
        for each in (cls.cause, cls.use_case):
            each.carry_out(cls.folder)
        cls.carried_out = state_of(cls.folder)
        cls.programs = cls.folder / "build/release/bin"
        for command in (["cmake", "--preset", "release", "-DDRIFTLAB_TESTS=ON", "-DDRIFTLAB_BENCH=OFF", "-DDRIFTLAB_DASHBOARD=OFF"],
                        ["cmake", "--build", "--preset", "release", "--parallel", str(os.cpu_count()),
                         "--target", "test_hidden", "driftlab", "driftlabd", "test_analysis"]):
            done = subprocess.run(command, cwd=cls.folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            assert done.returncode == 0, (done.stdout + done.stderr)[-6000:]

    def run_here(self, *command: str | Path, **environment: str) -> str:
        done = subprocess.run([str(part) for part in command], cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE_S,
                              env={**os.environ, **environment}, check=False)
        self.assertEqual(done.returncode, 0, (done.stdout + done.stderr)[-6000:])
        return done.stdout

    def test_the_house_stands(self) -> None:
        for rule in ("floors.py", "causes.py", "licence.py", "documents.py"):
            self.run_here(sys.executable, "-B", f"tests/house/{rule}", DRIFTLAB_BIN=str(self.programs))

    def test_a_cause_is_hidden_found_and_held_to_its_law(self) -> None:
        said = self.run_here(self.programs / "test_hidden", "--gtest_filter=*square_wave*")
        self.assertIn("[  PASSED  ]", said)
        for law in ("IsNamed", "Injection"):
            self.assertRegex(said, rf"\[       OK \] \S*{law}\S*/square_wave", "the toy is hidden, found, and held to its closed form")

    def test_command_job_and_endpoint_of_a_use_case_give_one_answer(self) -> None:
        self.run_here(self.programs / "test_analysis", "--gtest_filter=Toy.*")
        here = {"DRIFTLAB": str(self.programs / "driftlab"), "DRIFTLABD": str(self.programs / "driftlabd"),
                "PYTHONPATH": os.pathsep.join(str(self.folder / part) for part in ("tests/api", "clients/python"))}
        for suite in ("tests/api/contract_test.py", "tests/python/contract_test.py"):
            self.run_here(PYTHON, "-B", suite, **here)
        (self.scratch / "ask.py").write_text(ASK)
        said = self.run_here(PYTHON, "-B", self.scratch / "ask.py", **here)
        (self.scratch / "gyro.csv").write_text(GYRO)
        local = json.loads(self.run_here(self.programs / "driftlab", "toy", self.scratch / "gyro.csv", "--rate-hz", "10", "--columns",
                                         "gz=angular_rate:z:deg/s"))
        self.assertEqual([m["mean"] for m in json.loads(said)["means"]], [2.0])
        self.assertEqual([m["mean"] for m in local["means"]], [2.0])

    def test_z_each_recipe_lists_what_it_costs(self) -> None:
        """The last of all: what building and trying the toys leaves behind would count too."""
        self.assertEqual(differing(self.carried_out, state_of(self.folder)), [], "left behind")
        for each in (self.cause, self.use_case):
            title = each.titles[0]
            costs = listed("".join(map(recipe, each.titles)), each.name)
            for name in each.changed:
                self.assertTrue(any(pattern.fullmatch(name) for pattern in costs.values()), f"the recipe '{title}' does not list {name}")
            for name, pattern in costs.items():
                found = any(pattern.fullmatch(change) for change in each.changed)
                self.assertNotEqual(found, name in each.left_out, f"the recipe '{title}' lists {name}; the toy changed {each.changed}")


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
