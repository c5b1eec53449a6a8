"""schema/openapi.yaml and its JSON Schemas as a judge of answers.

Every answer is held to its operation: the status is listed, the body matches the schema for it, and holds no member
that the schema does not name. What is open for clients (members may be added) is closed here, so that nothing leaves
the daemon undocumented.
"""
from __future__ import annotations

import json
import re
import urllib.parse
from typing import Any

import jsonschema

from daemon import Answer, Daemon

MEMBERS = {"properties", "$defs"}  # objects whose keys are names of the schema's subject, not keywords


def bundle(contract: dict[str, Any], schemas: dict[str, Any]) -> dict[str, Any]:
    """One document: the contract with every schema file under #/$defs/FILE and references that say so."""
    whole = _redirected(contract, "")
    whole["$defs"] = {name: _redirected(schema, f"/$defs/{name}") for name, schema in schemas.items()}
    return whole


def _redirected(node: Any, here: str) -> Any:
    if isinstance(node, list):
        return [_redirected(value, here) for value in node]
    if not isinstance(node, dict):
        return node
    result = {key: _redirected(value, here) for key, value in node.items() if key != "$schema"}
    if isinstance(node.get("$ref"), str):
        file, _, fragment = node["$ref"].partition("#")
        result["$ref"] = "#" + (f"/$defs/{file.rpartition('/')[2]}" if file else here) + fragment
    return result


def closed(node: Any, parent: str = "") -> Any:
    """Objects that list their members take no others, unless they say themselves what else they take."""
    if isinstance(node, list):
        return [closed(value) for value in node]
    if not isinstance(node, dict):
        return node
    result = {key: closed(value, key) for key, value in node.items()}
    describes_members = "properties" in node and parent not in MEMBERS
    if describes_members and not {"additionalProperties", "unevaluatedProperties", "oneOf", "allOf"} & set(node):
        result["additionalProperties"] = False
    return result


class Contract:
    def __init__(self, contract: dict[str, Any], schemas: dict[str, Any]) -> None:
        self.whole = bundle(contract, schemas)
        self.strict = closed(self.whole)
        # A recording's members are closed by who refers to them, not by themselves.
        self.strict["$defs"]["recording.schema.json"] = self.whole["$defs"]["recording.schema.json"]
        self.paths: dict[str, dict[str, Any]] = self.whole["paths"]
        self.seen: set[tuple[str, int]] = set()  # (operationId, status)

    @classmethod
    def served(cls, daemon: Daemon) -> Contract:
        """From /openapi.json, with every schema it leads to."""
        contract = json.loads(daemon.get("/openapi.json").body)
        schemas: dict[str, Any] = {}
        wanted = _files(contract)
        while wanted:
            name = wanted.pop()
            answer = daemon.get(f"/schemas/{name}")
            assert answer.status == 200, answer.describe()
            schemas[name] = answer.json
            wanted |= _files(answer.json) - set(schemas)
        return cls(contract, schemas)

    def operation(self, method: str, target: str) -> dict[str, Any] | None:
        path = urllib.parse.unquote(target.partition("?")[0])
        for pattern, operations in self.paths.items():
            if re.fullmatch(re.sub(r"\\?\{[^}]*\\?\}", "[^/]+", re.escape(pattern).replace(r"\{", "{").replace(r"\}", "}")), path):
                return operations.get("get" if method == "HEAD" else method.lower())
        return None

    def resolved(self, node: dict[str, Any]) -> dict[str, Any]:
        while "$ref" in node:
            found: Any = self.whole
            for step in node["$ref"].removeprefix("#/").split("/"):
                found = found[step]
            node = found
        return node

    def judge(self, answer: Answer) -> None:
        """AssertionError where the answer is not one that the contract lists."""
        operation = self.operation(answer.method, answer.target)
        if operation is None:
            assert answer.status in (400, 403, 404, 405, 411, 413, 431), "not in the contract: " + answer.describe()
            self.check_problem(answer)
            return
        self.seen.add((operation["operationId"], answer.status))
        responses = operation["responses"]
        assert str(answer.status) in responses, f"{operation['operationId']} does not list " + answer.describe()
        response = self.resolved(responses[str(answer.status)])
        for header in response.get("headers", {}):
            if header in ("ETag", "Location"):
                assert header.lower() in answer.headers, f"no {header}: " + answer.describe()
        assert "x-request-id" in answer.headers, answer.describe()
        if "content" not in response:
            assert answer.body == b"", answer.describe()
            return
        media = answer.headers["content-type"].partition(";")[0]
        assert media in response["content"], f"{media} is not listed: " + answer.describe()
        if answer.method == "HEAD":
            assert answer.body == b"", answer.describe()
        elif media.endswith("json"):
            self.match(answer.json, response["content"][media]["schema"])
        if answer.status >= 400:
            self.check_problem(answer)

    def check_problem(self, answer: Answer) -> None:
        assert answer.headers.get("content-type") == "application/problem+json", answer.describe()
        if answer.method == "HEAD":
            return
        document = answer.json
        self.match(document, {"$ref": "#/$defs/problem.schema.json"})
        assert document["status"] == answer.status, answer.describe()
        assert document["type"] == "/problems/" + document["code"].replace("_", "-"), answer.describe()
        assert document["request_id"] == answer.headers["x-request-id"], answer.describe()
        if answer.status in (429, 503):
            assert "retry-after" in answer.headers, answer.describe()

    def match(self, document: Any, schema: dict[str, Any], *, strict: bool = True) -> None:
        root = self.strict if strict else self.whole
        whole = {"$schema": "https://json-schema.org/draft/2020-12/schema", "allOf": [closed(schema) if strict else schema],
                 "$defs": root["$defs"], "components": root["components"]}
        faults = sorted(jsonschema.Draft202012Validator(whole).iter_errors(document), key=lambda e: list(e.absolute_path))
        assert not faults, "\n".join(f"/{'/'.join(map(str, e.absolute_path))}: {e.message[:600]}" for e in faults[:5])


def _files(node: Any) -> set[str]:
    if isinstance(node, list):
        return set().union(*map(_files, node))
    if not isinstance(node, dict):
        return set()
    own = {node["$ref"].partition("#")[0].rpartition("/")[2]} if isinstance(node.get("$ref"), str) else set()
    return {name for name in own if name} | set().union(*map(_files, node.values()))
