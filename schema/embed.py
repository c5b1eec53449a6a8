#!/usr/bin/env python3
"""Writes the wire contract into a C++ source: openapi.yaml as JSON, the JSON Schemas and the user documentation.

usage: embed.py OUTPUT.cpp OPENAPI.yaml FILE...

Every FILE (schemas `*.schema.json`, documentation `docs/*.md`) becomes one entry named by its path below schema/.
"""
import json
import pathlib
import sys

import yaml


def literal(text: str) -> str:
    """A C++ string literal; split because compilers limit the length of one."""
    pieces = []
    for start in range(0, max(len(text), 1), 8000):
        piece = text[start:start + 8000]
        out = []
        for byte in piece.encode("utf-8"):
            char = chr(byte)
            if char == "\n":
                out.append("\\n")
            elif char in '"\\':
                out.append("\\" + char)
            elif 32 <= byte < 127 and char != "?":
                out.append(char)
            else:
                out.append(f"\\{byte:03o}")
        pieces.append('"' + "".join(out) + '"')
    return "\n    ".join(pieces)


def served(node: object) -> object:
    """The contract as the daemon serves it: schemas lie beside openapi.yaml here, but below /schemas/ there."""
    if isinstance(node, dict):
        return {key: f"schemas/{value}" if key == "$ref" and ".schema.json" in value else served(value)
                for key, value in node.items()}
    return [served(value) for value in node] if isinstance(node, list) else node


def main() -> int:
    output, contract, *files = (pathlib.Path(name) for name in sys.argv[1:])
    root = contract.parent
    entries = [("openapi.json", json.dumps(served(yaml.safe_load(contract.read_text("utf-8"))), ensure_ascii=False))]
    for path in sorted(files):
        entries.append((path.relative_to(root).as_posix(), path.read_text("utf-8")))
    # Clang warns of literals beyond the 64 KiB that every compiler has to take; GCC and Clang take any length.
    lines = ['#include "schema/contract.hpp"', "", '#pragma GCC diagnostic ignored "-Woverlength-strings"', "", "namespace driftlab {", "",
             "const std::vector<ContractFile>& contract_files() {", "  static const std::vector<ContractFile> files{"]
    lines += [f'    {{"{name}",\n    {literal(text)}}},' for name, text in entries]
    lines += ["  };", "  return files;", "}", "", "}  // namespace driftlab", ""]
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text("\n".join(lines), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
