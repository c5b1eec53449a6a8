#!/usr/bin/env python3
"""Fails where a function of an unnamed namespace hides one of an outer namespace that takes the same.

Files are compiled several at a time (unity builds), so that a function which one file has for itself is there in the
files behind it too. Where it has the name of a function of an outer namespace, and parameters of the same types, those
files call it instead, without a word from the compiler: `server::(unnamed)::split` stood for `driftlab::split`. Where
a parameter is of a type of driftlab's own, the compiler looks there too, and calls such a pair ambiguous.
"""
from __future__ import annotations

import re
from pathlib import Path

import tree

FLOORS = ("core", "schema", "server", "clients")
OPENS = re.compile(r"(?:inline )?namespace(?: ([\w:]+))? \{")
FUNCTION = re.compile(r"(?:\[\[nodiscard\]\] )?(?:(?:inline|constexpr|static) )*[\w:<>,&*\s]+?[\s&*](\w+)\(([^()]*)\)")
KNOWN_TYPE = re.compile(r"(?:std::[\w:]+|double|float|bool|char|int|long|short|unsigned|[<>,*\[\]0-9])+")


def types_of(parameters: str) -> tuple[str, ...]:
    """Types without names, defaults, const and references."""
    parameters = re.sub(r"'\\?.'", "0", parameters)
    types = []
    for parameter in re.split(r",(?![^<]*>)", re.sub(r"\s+", " ", parameters)) if parameters.strip() else []:
        text = re.sub(r"\bconst\b", "", parameter.split("=")[0]).strip()
        text = re.sub(r"(?<=[\w>&*]) ?\b(?!int$|long$|char$|double$|unsigned$)\w+$", "", text) if re.search(r"[\s&*]\w+$", text) else text
        types.append(re.sub(r"[&\s]", "", text))
    return tuple(types)


def functions(text: str) -> list[tuple[str, bool, str, tuple[str, ...]]]:
    """Of every function that stands in a namespace: that namespace, whether in an unnamed one, name and types."""
    found = []
    stack: list[str] = []
    for line in re.finditer(r"^.*$", text, re.MULTILINE):
        opened = OPENS.match(line[0])
        if opened:
            stack.append(opened[1] or "")
        elif line[0].startswith("}  // namespace") and stack:
            stack.pop()
        elif stack and re.match(r"[\[a-zA-Z]", line[0]) and not re.match(r"(struct|class|using|enum|return|template)\b", line[0]):
            one = FUNCTION.match(text, line.start())
            if one:
                found.append(("::".join(filter(None, stack)), "" in stack, one[1], types_of(one[2])))
    return found


def check(root: Path) -> list[str]:
    shared: dict[tuple[str, tuple[str, ...]], list[tuple[str, str]]] = {}
    own = []
    for path in tree.files(root):
        name = path.relative_to(root).as_posix()
        if name.split("/")[0] not in FLOORS or path.suffix not in (".hpp", ".cpp"):
            continue
        for namespace, unnamed, function, types in functions(path.read_text(encoding="utf-8")):
            if not all(KNOWN_TYPE.fullmatch(one) for one in types):
                continue
            if unnamed:
                own.append((name, namespace, function, types))
            elif path.suffix == ".hpp":
                shared.setdefault((function, types), []).append((namespace, name))
    return [f"{name}: {function} of an unnamed namespace hides {outer}::{function} of {header} in the files that are compiled with it"
            for name, namespace, function, types in own
            for outer, header in shared.get((function, types), []) if namespace.startswith(outer + "::")]


if __name__ == "__main__":
    tree.main(check)
