#!/usr/bin/env python3
"""Fails on an include that climbs a floor, on what core/ may not use, and on documents that compute.

Each module stands only on those named here; `tests/` stands on everything. A relative include of a driftlab header is a
fault too, for it hides the floor.
"""
from __future__ import annotations

import re
from pathlib import Path

import tree

# Module -> the modules it may include beside itself, directly; what these include follows by the same table.
CORE = ["core/signal", "core/process", "core/variance", "core/fit"]
INVESTIGATE = [f"core/investigate/{room}" for room in ("study", "slow", "fullrate", "facts", "consistency", "causes", "search", "report")]  # lowest first
ANALYSIS = [*CORE, "core/datasheet", "core/campaign", "core/export", "core/calibrate", "core/navigate", "core/investigate", *INVESTIGATE]
USE_CASES = [*ANALYSIS, "core/read", "core/analysis"]
# What stands above the use cases holds no analysis of its own: it asks core/analysis, and reads results of campaigns.
RESULTS = ["core/signal", "core/datasheet", "core/campaign", "core/export", "core/analysis", "schema/json", "schema/text", "schema/figure", "schema"]
# Documents are of these: core/export writes no document of its own, and the other rooms of an investigation are its arithmetic.
DOCUMENTED = [*CORE, "core/datasheet", "core/campaign", "core/calibrate", "core/navigate", "core/investigate",
              *(f"core/investigate/{room}" for room in ("study", "causes", "search", "report")), "core/read", "core/analysis"]
SERVER = ["core/signal", "server/store", "server/observe"]  # what every upper floor of the server may use
FLOORS: dict[str, list[str]] = {
    "core/signal": [],
    "core/read": ["core/signal"],
    "core/process": CORE[:1],
    "core/variance": CORE[:2],
    "core/fit": CORE[:3],
    "core/datasheet": ["core/signal"],  # what manufacturers state
    "core/campaign": [*CORE, "core/datasheet"],
    "core/export": [*CORE, "core/campaign"],  # what other programs want of a campaign
    "core/calibrate": CORE,
    "core/navigate": CORE,
    **{room: [*CORE, *INVESTIGATE[:floor]] for floor, room in enumerate(INVESTIGATE)},
    # what a result says in a sentence, what a finding costs in navigation
    "core/investigate/report": [*CORE, "core/campaign", "core/navigate", *INVESTIGATE[:-1]],
    "core/investigate": [*CORE, "core/campaign", "core/calibrate", "core/navigate", *INVESTIGATE],
    "core/analysis": [*ANALYSIS, "core/read"],  # one file per use case: what the command line and the jobs ask for
    "schema/figure": ["core/signal"],  # drawings: data in, nothing known of where they come from
    "schema/json": [*DOCUMENTED, "schema/figure"],
    "schema/text": USE_CASES,  # for people: tables and lines, of the same types and without a document in between
    "schema/shell": [],  # what --help knows, as manuals and completions
    "schema": [],  # schema/contract.hpp: the documents inside the binary
    "server/store": ["core/signal"],
    "server/observe": ["core/signal", "server/store", "schema/json"],
    "server/auth": SERVER,
    "server/jobs": [*RESULTS, *SERVER],
    "server/http": [*SERVER, "server/auth", "schema/json"],
    "server/webhooks": SERVER,
    "server/api": [*RESULTS, "core/read", *SERVER, "server/auth", "server/jobs", "server/http", "server/webhooks"],
    "server/pages": ["server/store", "server/http"],
    "server": [*RESULTS, "core/read", *SERVER, "server/pages", "server/auth", "server/jobs", "server/http", "server/webhooks", "server/api", "schema/shell"],
    "clients/cli": [*RESULTS, "core/read", "schema/shell"],
    "clients/decode": ["core/signal", "core/read"],  # a process of its own for files that may break it
}

# Of core/campaign they ask these: what is pooled or compared, and the tables, populations and settings that come of it.
# Its other headers are the arithmetic between.
ABOVE_USE_CASES = ("server/jobs", "server/api", "server", "clients/cli")
CAMPAIGN_DOORS = {"core/campaign/" + name for name in (
    "glance.hpp", "parameter_table.hpp", "population_report.hpp", "sensor_sources.hpp",
    "regression/kept_settings.hpp", "regression/recordings.hpp")}
# Of core/signal these: the types of a recording, errors, progress, and how a number or a sentence is written. How columns
# are read, times laid on a grid and channels surveyed is for the use cases to ask.
SIGNAL_DOORS = {"core/signal/" + name for name in (
    "angle.hpp", "condition.hpp", "find_column.hpp", "number.hpp", "progress.hpp", "quantity.hpp",
    "recording.hpp", "result.hpp", "text.hpp", "with_count.hpp")}

# Of these modules documents are about results, not about how they come about: a result's types, the functions that tell it in
# other words (deviations, equivalents, a mean efficiency), names and units of processes, a model that somebody gives.
JSON_DOORS: dict[str, set[str]] = {
    "core/signal": SIGNAL_DOORS | {f"core/signal/{name}.hpp" for name in ("estimate", "measured_temperature", "significant", "unit")},
    "core/process": {f"core/process/{name}.hpp" for name in ("model", "parameter_unit", "registry")},
    "core/variance": {"core/variance/deviation.hpp"},
    "core/fit": {f"core/fit/{name}.hpp" for name in ("characterisation", "characterise", "j_test", "noise_equivalents", "robust_efficiency")},
    "core/investigate/study": {"core/investigate/study/study.hpp"},
    "core/investigate/causes": {"core/investigate/causes/cause.hpp"},
    "core/investigate/search": {"core/investigate/search/given_model.hpp"},
    "core/read": {"core/read/text_shape.hpp"},
}

# Headers -> the modules (by prefix) and single files that may include them; everything else may not.
RESERVED = {
    r"sqlite3\.h": ("server/store", "core/read/rosbag2.cpp"),  # a ROS 2 bag is an SQLite database
    r"libpq-fe\.h": ("server/store",),
    r"boost/(beast|asio).*": ("server", "clients/cli"),
    r"nlohmann/.*": ("schema/json", "server", "clients/cli"),
    r"cairo/.*": ("schema/figure/png.cpp",),
    r"hdf5.*": ("clients/decode",),
    r"spdlog/.*": ("server",),
    r"iostream": ("server", "clients/cli"),
}

# What core/ may not say: it neither prints, logs, exits, reads clock or environment, nor draws unseeded randomness.
FORBIDDEN_IN_CORE = {
    r"\bstd::(cout|cerr|clog)\b": "prints",
    r"\b(printf|fprintf|vprintf|vfprintf|puts|fputs|putchar|perror)\s*\(": "prints",
    r"\bgetenv\b": "reads the environment",
    r"\b(system_clock|steady_clock|high_resolution_clock|clock_gettime|gettimeofday)\b": "reads a clock",
    r"\btime\s*\(\s*(nullptr|NULL|0)\s*\)": "reads a clock",
    r"\brandom_device\b": "draws unseeded randomness",
    r"(?<![\w.>])(std::)?s?rand\s*\(": "draws unseeded randomness",
    r"(?<![\w.>])(std::)?(exit|_Exit|quick_exit|abort|terminate)\s*\(": "ends the process",
}

# What schema/json may not say: a document is what core computed, in the units of its readers. Whoever needs a function of
# <cmath> or <numeric> there computes, and so does who looks for the least or greatest, and who adds, subtracts, multiplies or
# divides numbers of a document by another (ARITHMETIC). A change of units passes. These write numbers: whether one is finite, to
# how many decimals, that a whole number fits its type, and the bytes of a MATLAB file.
COMPUTING_HEADERS = {"cmath", "complex", "numeric", "valarray", "math.h"}
COMPUTING = re.compile(
    r"\bstd::(sqrt|cbrt|hypot|exp2?|expm1|log(2|10|1p)?|pow|a?(sin|cos|tan)h?|atan2|erfc?|[lt]gamma|l?l?round|floor|ceil|trunc|f?abs|fmod|"
    r"remainder|fma|lerp|midpoint|accumulate|(transform_)?reduce|inner_product|partial_sum|(inclusive|exclusive)_scan|nth_element|"
    r"(ranges::)?(min|max|minmax)(_element)?|(ranges::)?clamp|plus|minus|multiplies|divides)\b"
    r"|\b(ned_axes|to_euler|deviation_of|distances_2p|(white_noise|random_walk)_equivalents|ellipse95|horizontal_m)\b"
    r"|\.(transpose|conjugate|inverse|squaredNorm|norm|dot|cross)\(")
WRITE_NUMBERS = {"schema/json/json.cpp", "schema/json/rounded.cpp", "schema/json/mat_file.cpp"}

# clang-format puts blanks around an operator of two operands, and none beside one of a single operand or a pointer.
ARITHMETIC = re.compile(r"(?<=[\w)\]])\s+([-+*/])\s+(?=[\w(*\-])|(?<=[\w)\]])\s+([-*/]=)\s")
# The last name of an operand that is a unit: kDegree, unit.per_si, a factor; or a power of ten, a reciprocal.
UNIT = re.compile(r"k(Degree|StandardGravity|MilliG|Percent|RegressionMg|RegressionPpm)|per|(\w+_)?per_si|si|(\w+_)?factor|unit|100\.0|1e-?\d+")
WHOLE = re.compile(r"\d[\d']*U?")
PLACE = re.compile(r"size|begin|end|length")  # in a list or a text
# Strings are added too: numbers are known by a unit in their name, by their decimals, or as elements of two lists.
MEASURED = re.compile(r"\w+_(m|m2|s|hz|rad|deg|degc|m_s|rad_s|m_s2|si)|\d+\.\d*|missing|implausible|samples")

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)
COMMENT_OR_LITERAL = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|' r"(?<!\w)'(?:\\.|[^'\\\n])+'", re.DOTALL)


def module_of(name: str) -> str | None:
    """The longest module that is the folder of `name`, or holds it further down."""
    folder = Path(name).parent
    while str(folder) != ".":
        if folder.as_posix() in FLOORS:
            return folder.as_posix()
        folder = folder.parent
    return None


def code_of(text: str) -> str:
    """The text with comments and literals blanked out, line breaks kept."""
    return COMMENT_OR_LITERAL.sub(lambda match: "\n" * match.group(0).count("\n") or " ", text)


def hangs(code: str, place: int) -> bool:
    """Whether the character belongs to names, members, calls and elements that hang together."""
    return code[place].isalnum() or code[place] in "_.:'()[]" or "->" in code[max(0, place - 1):place + 2]


def left_of(code: str, end: int) -> str:
    """The operand that ends before `end`."""
    start, depth = end, 0
    while start > 0:
        depth += (code[start - 1] in ")]") - (code[start - 1] in "([")
        if depth < 0 or (depth == 0 and not hangs(code, start - 1)):
            break
        start -= 1
    return code[start:end]


def right_of(code: str, start: int) -> str:
    """The operand that starts at `start`, without a sign or a star of its own."""
    while code[start:start + 1] in ("*", "-"):
        start += 1
    end, depth = start, 0
    while end < len(code):
        depth += (code[end] in "([") - (code[end] in ")]")
        if depth < 0 or (depth == 0 and not hangs(code, end)):
            break
        end += 1
    return code[start:end]


def last_name(operand: str) -> str:
    """`back` of `list.back()`, `mean` of `channel.mean`, `]` of an element, `)` of what stands in brackets alone."""
    if operand.endswith("]"):
        return "]"
    depth, end = 0, len(operand)
    while end > 0 and operand.endswith(")"):
        depth += (operand[end - 1] == ")") - (operand[end - 1] == "(")
        end -= 1
        if depth == 0:
            break
    name = operand[:end]
    if re.fullmatch(r"[\d'].*|.*\d\.\d*|\d+\.", name):
        return name
    return re.split(r"\.|->|::", name)[-1] or ")"


def inside_an_index(code: str, position: int) -> bool:
    depth = 0
    for k in range(position - 1, max(0, position - 200), -1):
        depth += (code[k] in ")]") - (code[k] in "([")
        if depth < 0 and code[k] == "[":
            return True
        if code[k] in ";{}":
            return False
    return False


def arithmetic_of(code: str) -> list[tuple[int, str]]:
    """Where numbers are added, subtracted, multiplied or divided that are neither places in a list nor changes of units."""
    found: list[tuple[int, str]] = []
    for match in ARITHMETIC.finditer(code):
        left, right = left_of(code, match.start()), right_of(code, match.end())
        names = (last_name(left), last_name(right))
        sign = match.group(1) or match.group(2)
        counted = any(WHOLE.fullmatch(name) or (sign in "+-" and PLACE.fullmatch(name)) for name in names) or inside_an_index(code, match.start())
        unit = any(UNIT.fullmatch(name) for name in names[1 if sign[0] == "/" else 0:]) or (sign == "/" and left == "1.0")
        number = sign != "+" or any(MEASURED.fullmatch(name) for name in names) or names == ("]", "]")
        if number and not counted and not (unit and sign[0] in "*/"):
            found.append((match.start(), f"{left} {sign} {right}"))
    return found


def faults_of(root: Path, name: str, text: str) -> list[str]:
    faults: list[str] = []
    module = module_of(name)
    if module is None:
        top = name.split("/")[0]
        return [f"{name}: belongs to no floor; name its module in tests/house/floors.py"] if top != "tests" else []

    def fault(position: int, sentence: str) -> None:
        faults.append(f"{name}:{text.count(chr(10), 0, position) + 1}: {sentence}")

    for match in INCLUDE.finditer(text):
        included = match.group(2)
        target = module_of(included)
        if target is not None and target != module and target not in FLOORS[module]:
            fault(match.start(2), f"{module} may not include {included}: {target} is not below it")
        if module in ABOVE_USE_CASES and target == "core/campaign" and included not in CAMPAIGN_DOORS:
            fault(match.start(2), f"{module} may not include {included}: it is arithmetic of core/campaign")
        if module in ABOVE_USE_CASES and target == "core/signal" and included not in SIGNAL_DOORS:
            fault(match.start(2), f"{module} may not include {included}: it is arithmetic of core/signal")
        if module == "schema/json" and target in JSON_DOORS and included not in JSON_DOORS[target]:
            fault(match.start(2), f"{module} may not include {included}: it is arithmetic of {target}")
        if match.group(1) == '"' and target is None and (root / name).parent.joinpath(included).exists():
            fault(match.start(2), f"include {included} by its path from the top of the repository")
        if module == "schema/json" and name not in WRITE_NUMBERS and included in COMPUTING_HEADERS:
            fault(match.start(2), f"schema/json may not include <{included}>: documents compute nothing, core does")
        for pattern, owners in RESERVED.items():
            if re.fullmatch(pattern, included) and not any(o in (module, name) or module.startswith(o + "/") for o in owners):
                fault(match.start(2), f"{module} may not include <{included}>: it is kept to {', '.join(owners)}")
    if module == "schema/json" and name not in WRITE_NUMBERS:
        for number, line in enumerate(code_of(text).split("\n"), start=1):
            for match in COMPUTING.finditer(line):
                faults.append(f"{name}:{number}: schema/json computes ({match.group(0)}): that belongs to core")
        code = code_of(text)
        for position, said in arithmetic_of(code):
            faults.append(f"{name}:{code.count(chr(10), 0, position + 1) + 1}: schema/json computes ({said}): that belongs to core")
    if module.startswith("core/"):
        for number, line in enumerate(code_of(text).split("\n"), start=1):
            for pattern, sentence in FORBIDDEN_IN_CORE.items():
                for match in re.finditer(pattern, line):
                    faults.append(f"{name}:{number}: core {sentence} ({match.group(0).strip('( ')})")
    return faults


def check(root: Path) -> list[str]:
    faults: list[str] = []
    seen = 0
    for path in tree.files(root):
        name = path.relative_to(root).as_posix()
        if path.suffix in {".hpp", ".cpp", ".h"} and name.split("/")[0] in {"core", "schema", "server", "clients"}:
            seen += 1
            faults += faults_of(root, name, path.read_text())
    return faults if seen else [f"no sources under {root}"]


if __name__ == "__main__":
    tree.main(check)
