"""The client against the contract, both ways: every operation has its method, and every method its operation."""
from __future__ import annotations

import inspect
import json
import re
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import]

import driftlab
from driftlab import Client
from driftlab.contract import OPERATIONS

REPOSITORY = Path(__file__).resolve().parents[2]
CONTRACT = yaml.safe_load((REPOSITORY / "schema/openapi.yaml").read_text("utf-8"))
GENERATOR = REPOSITORY / "clients/python/generate_contract.py"
# Answers that are kept nowhere, so that none can be repeated.
SECRETS = {"openSession", "createToken", "rotateToken", "createWebhook", "rotateWebhook"}
BY_THE_CLIENT = {"limit", "cursor"}  # lists ask for page after page by themselves


def described() -> dict[str, dict[str, Any]]:
    return {operation["operationId"]: operation for methods in CONTRACT["paths"].values() for operation in methods.values()}


def methods() -> dict[str, Callable[..., Any]]:
    marked = inspect.getmembers(Client, lambda member: hasattr(member, "operation"))
    found = {getattr(member, "operation"): member for _, member in marked}
    assert len(found) == len(marked), "two methods claim one operation"
    return found


class Contract(unittest.TestCase):
    def test_the_types_are_those_of_the_schemas(self) -> None:
        ran = subprocess.run([sys.executable, "-B", str(GENERATOR), "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(ran.returncode, 0, ran.stderr)

    def test_a_schema_that_changes_is_noticed(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            for path in [REPOSITORY / "schema/openapi.yaml", *(REPOSITORY / "schema").glob("*.schema.json")]:
                Path(folder, path.name).write_bytes(path.read_bytes())
            device = json.loads(Path(folder, "device.schema.json").read_text())
            device["properties"]["colour"] = {"enum": ["red", "green"]}
            Path(folder, "device.schema.json").write_text(json.dumps(device))
            words = [sys.executable, "-B", str(GENERATOR), "--check", folder, str(REPOSITORY / "clients/python/driftlab/contract.py")]
            ran = subprocess.run(words, capture_output=True, text=True, check=False)
            self.assertEqual(ran.returncode, 1)
            self.assertIn("run clients/python/generate_contract.py", ran.stderr)
            made = Path(folder, "contract.py")
            subprocess.run([sys.executable, "-B", str(GENERATOR), folder, str(made)], check=True)
            self.assertIn("    colour: NotRequired[Literal['red', 'green']]\n", made.read_text())

    def test_every_operation_has_its_method_and_every_method_its_operation(self) -> None:
        self.assertEqual(set(methods()), set(described()))
        self.assertEqual(set(OPERATIONS), set(described()))

    def test_a_method_takes_every_parameter_of_its_operation(self) -> None:
        for name, method in methods().items():
            with self.subTest(operation=name):
                taken = set(inspect.signature(method).parameters)
                in_query = {p["name"] for p in described()[name].get("parameters", []) if p.get("in") == "query"}
                self.assertEqual(in_query - BY_THE_CLIENT - taken, set())
                in_path = set(re.findall(r"\{(\w+)\}", OPERATIONS[name].path))
                self.assertEqual(in_path, taken & in_path)
                for header, parameter in (("Idempotency-Key", "idempotency_key"), ("If-Match", "if_match"), ("Prefer", "wait_s")):
                    if header in OPERATIONS[name].headers:
                        self.assertIn(parameter, taken)
                self.assertTrue(method.__doc__)

    def test_every_post_carries_an_idempotency_key(self) -> None:
        for name, operation in OPERATIONS.items():
            keyed = operation.method == "POST" and name not in SECRETS
            self.assertEqual("Idempotency-Key" in operation.headers, keyed, name)

    def test_the_manual_names_every_method(self) -> None:
        page = (REPOSITORY / "schema/docs/python.md").read_text("utf-8")
        for name, method in methods().items():
            self.assertIn(f"`{method.__name__}`", page, name)

    def test_the_package_has_the_version_of_the_contract(self) -> None:
        self.assertEqual(driftlab.__version__, CONTRACT["info"]["version"])
        project = (REPOSITORY / "clients/python/pyproject.toml").read_text("utf-8")
        self.assertIn(f'\nversion = "{driftlab.__version__}"\n', project)


if __name__ == "__main__":
    unittest.main()
