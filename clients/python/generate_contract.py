#!/usr/bin/env python3
"""Writes driftlab/contract.py from schema/: a TypedDict per object of the contract, and the table of its operations.

usage: generate_contract.py [--check] [SCHEMA_FOLDER [OUTPUT]]

--check writes nothing and exits 1 where the committed file is not what would be written. What a schema says beyond shape (patterns,
limits) is left to the daemon, which says it in a sentence.
"""
from __future__ import annotations

import argparse
import json
import keyword
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import]

HERE = Path(__file__).resolve().parent
WIDTH = 120
SCALARS = {"string": "str", "integer": "int", "number": "float", "boolean": "bool", "null": "None"}
MERGED = ("required", "properties", "additionalProperties")

HEAD = '''"""The wire contract as Python types. Made by generate_contract.py from schema/; not edited by hand."""
from __future__ import annotations

from typing import Any, Literal, NamedTuple, NotRequired, TypeAlias, TypedDict


class Operation(NamedTuple):
    """One row of the contract: how a request is put together. Parameters that every request may have are not listed."""

    method: str
    path: str
    query: tuple[str, ...]
    headers: tuple[str, ...]
    media: tuple[str, ...]


'''


def camel(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in re.split(r"[^A-Za-z0-9]+", name) if part)


class Types:
    """Turns schemas into declarations; each is made once, under the name of where it stands."""

    def __init__(self, folder: Path) -> None:
        self.contract: dict[str, Any] = yaml.safe_load((folder / "openapi.yaml").read_text("utf-8"))
        self.files: dict[str, dict[str, Any]] = {
            path.name: json.loads(path.read_text("utf-8")) for path in sorted(folder.glob("*.schema.json"))}
        self.files["openapi.yaml"] = self.contract
        self.made: dict[str, str] = {}  # name -> declaration
        self.known: dict[str, str] = {}  # name of a schema that is referred to -> its type
        self.underway: set[str] = set()
        self.classes: list[tuple[dict[str, Any], str]] = []  # schemas that are classes already: one may be met at two places
        places = [(file, where) for file, schema in self.files.items() for where in ("", *schema.get("$defs", {}))]
        self.reserved = {self.resolve(f"#/$defs/{where}" if where else "#", file)[2] for file, where in places}

    # --- references

    def resolve(self, reference: str, file: str) -> tuple[dict[str, Any], str, str]:
        """The schema, the file it stands in, and the name of its type."""
        target, _, fragment = reference.partition("#")
        file = target or file
        steps = [step for step in fragment.split("/") if step]
        node: Any = self.files[file]
        for step in steps:
            node = node[step]
        words = [step for step in steps if step not in ("$defs", "properties", "components", "schemas", "parameters", "responses")]
        stem = "" if file == "openapi.yaml" else camel(file.removesuffix(".schema.json"))
        return node, file, stem + "".join(camel(word) for word in words)

    # --- types

    def expression(self, node: dict[str, Any], file: str, name: str) -> str:
        """The type of a schema; `name` is for a class, should it need one."""
        if "$ref" in node:
            target, file, name = self.resolve(node["$ref"], file)
            return self.named(target, file, name)
        if "const" in node:
            return f"Literal[{node['const']!r}]"
        if "enum" in node:
            return f"Literal[{', '.join(repr(value) for value in node['enum'])}]"
        choices = node.get("oneOf") or node.get("anyOf") or []
        if choices and not all(set(choice) == {"required"} for choice in choices):
            return self.union(node, choices, file, name)
        if "properties" in node or "allOf" in node:
            made = self.class_of(node, file, name)
            return f"{made} | None" if "null" in node.get("type", "object") else made
        kinds = node.get("type", [])
        kinds = kinds if isinstance(kinds, list) else [kinds]
        return joined([self.of_kind(kind, node, file, name) for kind in kinds]) if kinds else "Any"

    def named(self, node: dict[str, Any], file: str, name: str) -> str:
        """A schema that is referred to: a class of that name where it is an object, an alias where it is a choice or a list."""
        if name in self.underway:
            return name
        if name not in self.known:
            self.underway.add(name)
            made = self.expression(node, file, name)
            self.underway.remove(name)
            # A class has its name; str, list[float | None], ... need none to be clear.
            if name not in self.made and re.search(r"\b(?!None\b)[A-Z]\w+", made):
                self.made[name] = f'{name}: TypeAlias = "{made}"'
                made = name
            self.known[name] = made
        return self.known[name]

    def union(self, node: dict[str, Any], choices: list[dict[str, Any]], file: str, name: str) -> str:
        parts = []
        base = {key: node[key] for key in MERGED if key in node}
        for number, choice in enumerate(choices):
            if base:  # each choice says more about the one object
                choice = {**base, **choice, "required": [*base.get("required", []), *choice.get("required", [])],
                          "properties": {**base.get("properties", {}), **choice.get("properties", {})}}
            only = len([c for c in choices if c != {"type": "null"}]) == 1
            parts.append(self.expression(choice, file, name if only else name + (self.telling_constant(choice) or str(number + 1))))
        return joined(parts)

    @staticmethod
    def telling_constant(choice: dict[str, Any]) -> str:
        """The name of a choice, from the kind it is for: AxisAngle of {kind: {const: axis_angle}}."""
        kind = choice.get("properties", {}).get("kind", {})
        return camel(str(kind.get("const") or "_".join(kind.get("enum", []))))

    def of_kind(self, kind: str, node: dict[str, Any], file: str, name: str) -> str:
        if kind in SCALARS:
            return SCALARS[kind]
        if kind == "array":
            if "prefixItems" in node:
                return f"list[{joined([self.expression(item, file, name) for item in node['prefixItems']])}]"
            return f"list[{self.expression(node.get('items', {}), file, singular(name))}]"
        assert kind == "object", kind
        more = node.get("additionalProperties")
        return f"dict[str, {self.expression(more, file, singular(name)) if isinstance(more, dict) else 'Any'}]"

    def class_of(self, node: dict[str, Any], file: str, name: str) -> str:
        for known, its_name in self.classes:
            if known is node:
                return its_name
        required, members = self.members(node, file)
        if name in self.reserved - self.underway:  # `request` of job.schema.json is not job-request.schema.json
            name += "Member"
        if name in self.made:
            raise SystemExit(f"two schemas would be {name}: give one of them a title")
        self.classes.append((node, name))
        self.made[name] = ""  # its place: before what it is made of
        lines = [f"class {name}(TypedDict):"]
        said = " ".join(str(node.get(key, "")).rstrip(".") + "." for key in ("title", "description") if node.get(key))
        if said:
            lines += textwrap.wrap(f'"""{escaped(said)}"""', WIDTH, initial_indent="    ", subsequent_indent="    ") + [""]
        # A member such as `is` is no name in Python: it stands in a base that is written as a call.
        odd = {member: members.pop(member) for member in list(members) if not member.isidentifier() or keyword.iskeyword(member)}
        if odd:
            kinds = {member: self.expression(schema, where, name + camel(member)) for member, (schema, where) in odd.items()}
            entries = ", ".join(f'"{member}": {kind if member in required else f"NotRequired[{kind}]"}' for member, kind in kinds.items())
            self.made[f"{name}Odd"] = f'{name}Odd = TypedDict("{name}Odd", {{{entries}}})'
            lines[0] = f"class {name}({name}Odd):"
        for member, (schema, where) in members.items():
            kind = self.expression(schema, where, name + camel(member))
            if "description" in schema:
                lines += textwrap.wrap(schema["description"], WIDTH, initial_indent="    # ", subsequent_indent="    # ")
            lines += wrapped(f"    {member}: {kind if member in required else f'NotRequired[{kind}]'}")
        if not members:
            lines.append("    pass")
        self.made[name] = "\n".join(lines)
        return name

    def members(self, node: dict[str, Any], file: str) -> tuple[set[str], dict[str, tuple[dict[str, Any], str]]]:
        """What an object requires and holds, with what `allOf` and a neighbouring `$ref` add, and where each stands."""
        required: set[str] = set(node.get("required", []))
        found: dict[str, tuple[dict[str, Any], str]] = {}
        for part in node.get("allOf", []):
            where = file
            while "$ref" in part:
                part, where, _ = self.resolve(part["$ref"], where)
            needs, more = self.members(part, where)
            required |= needs
            found.update(more)
        found.update({name: (schema, file) for name, schema in node.get("properties", {}).items()})
        return required, found

    # --- operations

    def operations(self) -> list[str]:
        rows = []
        for path, methods in self.contract["paths"].items():
            for method, operation in methods.items():
                bound = [self.resolve(p["$ref"], "openapi.yaml")[0] if "$ref" in p else p for p in operation.get("parameters", [])]
                names = {place: tuple(p["name"] for p in bound if p["in"] == place) for place in ("query", "header")}
                good = [r for status, r in operation["responses"].items() if status.startswith("2")]
                media = tuple(dict.fromkeys(kind for r in good for kind in r.get("content", {})))
                headers = tuple(name for name in names["header"] if name != "If-None-Match")
                row = f"        {method.upper()!r}, {path!r}, {names['query']!r}, {headers!r}, {media!r}),"
                rows += [f"    {operation['operationId']!r}: Operation("]
                rows += [row] if len(row) <= WIDTH else [f"        {method.upper()!r}, {path!r},", *wrapped(f"        {names['query']!r},"),
                                                         f"        {headers!r}, {media!r}),"]
        return rows

    def listed(self) -> None:
        """Types of bodies that openapi.yaml writes out itself."""
        for path, methods in self.contract["paths"].items():
            for operation in methods.values():
                for status, response in operation["responses"].items():
                    body = response.get("content", {}).get("application/json", {}).get("schema")
                    if not status.startswith("2") or body is None or "$ref" in body:
                        continue
                    if "items" in body.get("properties", {}):
                        self.expression(body["properties"]["items"]["items"], "openapi.yaml", camel(operation["operationId"]) + "Item")
                    elif "properties" in body:
                        self.named(body, "openapi.yaml", camel(operation["operationId"]) + "Answer")

    def text(self) -> str:
        for file in self.files:
            if file != "openapi.yaml":
                self.named(self.files[file], file, self.resolve(file, file)[2])
                for definition in self.files[file].get("$defs", {}):
                    target, where, name = self.resolve(f"#/$defs/{definition}", file)
                    self.named(target, where, name)
        for name, schema in self.contract["components"]["schemas"].items():
            self.named(schema, "openapi.yaml", name)
        self.listed()
        classes = [made for name, made in sorted(self.made.items()) if made.startswith("class")]
        bases = [made for name, made in sorted(self.made.items()) if " = TypedDict(" in made]
        aliases = [made for name, made in sorted(self.made.items()) if not made.startswith("class") and made not in bases]
        return (HEAD + "".join(base + "\n" for base in bases) + "\n" * (2 if bases else 0)
                + "\n\n\n".join(classes) + "\n\n\n" + "\n".join(broken(a) for a in aliases)
                + "\n\n# operationId -> what it takes and gives; `media` are the types of a good answer.\n"
                + "OPERATIONS: dict[str, Operation] = {\n" + "\n".join(self.operations()) + "\n}\n")


def joined(parts: list[str]) -> str:
    """One union; a member once, None last."""
    flat = list(dict.fromkeys(part for parts_ in parts for part in top_level(parts_)))
    if "Any" in flat:
        return "Any"
    literals = [part[len("Literal["):-1] for part in flat if part.startswith("Literal[")]
    if len(literals) > 1:
        flat = [f"Literal[{', '.join(literals)}]", *(part for part in flat if not part.startswith("Literal["))]
    return " | ".join([part for part in flat if part != "None"] + ["None"] * ("None" in flat))


def top_level(union: str) -> list[str]:
    """The members of a union; what stands in brackets or quotes is not parted."""
    found, depth = [""], 0
    for piece in re.split(r"('[^']*'|[\[\]]| \| )", union):
        depth += (piece == "[") - (piece == "]")
        if piece == " | " and depth == 0:
            found.append("")
        else:
            found[-1] += piece
    return found


def singular(name: str) -> str:
    for ending, one in (("ies", "y"), ("sses", "ss"), ("xes", "x")):
        if name.endswith(ending):
            return name[:-len(ending)] + one
    return name[:-1] if name.endswith("s") and not name.endswith("ss") else name + "Item"


def escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', "'")


def wrapped(line: str) -> list[str]:
    """A long line broken at its commas, under its last opening bracket."""
    if len(line) <= WIDTH:
        return [line]
    at = line.find("Literal[") + 8 if "Literal[" in line else line.find("(") + 1
    pieces = re.findall(r"(?:'[^']*'|[^',])+,?\s*", line[at:])
    lines = [line[:at]]
    for piece in pieces:
        if len(lines[-1]) + len(piece.rstrip()) > WIDTH:
            lines[-1] = lines[-1].rstrip()
            lines.append(" " * at)
        lines[-1] += piece
    return lines


def broken(alias: str) -> str:
    """A long alias on lines of its own."""
    if len(alias) <= WIDTH:
        return alias
    name, _, value = alias.partition(": TypeAlias = ")
    lines = textwrap.wrap(value.strip('"'), WIDTH - 8)
    return f"{name}: TypeAlias = (\n" + "\n".join(f'    "{line}{" " if number + 1 < len(lines) else ""}"'
                                                  for number, line in enumerate(lines)) + ")"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 where the file is not current")
    parser.add_argument("schema", nargs="?", type=Path, default=HERE.parents[1] / "schema")
    parser.add_argument("output", nargs="?", type=Path, default=HERE / "driftlab/contract.py")
    options = parser.parse_args()
    text = Types(options.schema).text()
    if options.check:
        if options.output.is_file() and options.output.read_text("utf-8") == text:
            return 0
        print(f"{options.output.name} is not what schema/ says: run clients/python/generate_contract.py", file=sys.stderr)
        return 1
    options.output.write_text(text, "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
