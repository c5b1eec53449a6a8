#!/usr/bin/env python3
"""Fails on an include that climbs a floor, on what core/ may not use, and on documents that compute or run an analysis.

Each module stands only on those named here; `tests/` stands on everything. A relative include of a driftlab header is a
fault too, for it hides the floor.
"""
from __future__ import annotations

import re
from pathlib import Path

import accounting
import computing
import running
import tree

# Module -> the modules it may include beside itself, directly; what these include follows by the same table.
CORE = ["core/signal", "core/process", "core/variance", "core/fit"]
INVESTIGATE = [f"core/investigate/{room}" for room in ("study", "slow", "fullrate", "facts", "consistency", "causes", "unnamed", "search", "report")]  # lowest first
ANALYSIS = [*CORE, "core/datasheet", "core/campaign", "core/export", "core/calibrate", "core/navigate", "core/investigate", *INVESTIGATE]
USE_CASES = [*ANALYSIS, "core/read", "core/analysis"]
# What stands above the use cases holds no analysis of its own: it asks core/analysis, and reads results of campaigns.
RESULTS = ["core/signal", "core/datasheet", "core/campaign", "core/export", "core/analysis", "schema/json", "schema/text", "schema/figure", "schema/snapshot", "schema"]
# Documents are of these: core/export writes no document of its own, and the other rooms of an investigation are its arithmetic.
DOCUMENTED = [*CORE, "core/datasheet", "core/campaign", "core/calibrate", "core/navigate", "core/investigate",
              *(f"core/investigate/{room}" for room in ("study", "causes", "unnamed", "search", "report")), "core/read", "core/analysis"]
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
    "schema/text": [*USE_CASES, "schema/figure"],  # for people: tables and lines, of the same types and without a document in between
    "schema/snapshot": CORE,  # results as bytes, from one process to another
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
    "glance.hpp", "parameter_table.hpp", "population_report.hpp", "population_verdict.hpp", "sensor_sources.hpp",
    "regression/kept_settings.hpp", "regression/recordings.hpp")}
# Of core/signal these: the types of a recording, errors, progress, and how a number or a sentence is written. How columns
# are read, times laid on a grid and channels surveyed is for the use cases to ask.
SIGNAL_DOORS = {"core/signal/" + name for name in (
    "angle.hpp", "column_unit.hpp", "condition.hpp", "find_column.hpp", "name_list.hpp", "number.hpp", "progress.hpp", "quantity.hpp",
    "recording.hpp", "result.hpp", "short_name.hpp", "text.hpp", "with_count.hpp")}

# Of these modules documents are about results, not about how they come about: a result's types, the functions that tell it in
# other words (deviations, equivalents, a mean efficiency), names and units of processes, a model that somebody gives. A use case's
# header holds its request and its result, so that every one of core/analysis is open: a new use case costs no line here.
JSON_DOORS: dict[str, set[str]] = {
    "core/signal": SIGNAL_DOORS | {f"core/signal/{name}.hpp" for name in ("estimate", "measured_temperature", "significant", "unit")},
    "core/process": {f"core/process/{name}.hpp" for name in ("model", "parameter_unit", "registry")},
    "core/variance": {"core/variance/deviation.hpp"},
    "core/fit": {f"core/fit/{name}.hpp" for name in ("characterisation", "characterise", "noise_equivalents", "robust_efficiency")},
    "core/investigate/study": {"core/investigate/study/study.hpp"},
    "core/investigate/causes": {"core/investigate/causes/cause.hpp"},
    "core/investigate/unnamed": {"core/investigate/unnamed/unnamed_effect.hpp", "core/investigate/unnamed/unnamed_search.hpp"},
    "core/investigate/search": {"core/investigate/search/given_model.hpp"},
    "core/read": {"core/read/text_shape.hpp"},
    "core/campaign": {f"core/campaign/{name}.hpp" for name in (
        "campaign_summary", "parameter_table", "pooled_sensor", "population_report", "regression/ratios",
        "regression/recordings", "reported_channel", "trend_table", "verdict")},
    "core/calibrate": {f"core/calibrate/{name}.hpp" for name in ("multi_position", "sensor_calibration", "six_position")},
    "core/navigate": {f"core/navigate/{name}.hpp" for name in (
        "drive/document", "imu_simulator", "outage_evaluation", "outage_progress", "outage_scenario", "paper_scenario")},
}
# Module -> of these modules below it, the headers that it may include; of the others, all.
DOORS = {**{module: {"core/campaign": CAMPAIGN_DOORS, "core/signal": SIGNAL_DOORS} for module in ABOVE_USE_CASES}, "schema/json": JSON_DOORS}

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

# A number of processors is asked for by name of the class; no thread is started by that.
THREADS = re.compile(r"\bstd::(jthread|thread|async)\b(?!::)|\bpthread_create\b")
EXECUTOR = "core/signal/executor.cpp"

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def module_of(name: str) -> str | None:
    """The longest module that is the folder of `name`, or holds it further down."""
    folder = Path(name).parent
    while str(folder) != ".":
        if folder.as_posix() in FLOORS:
            return folder.as_posix()
        folder = folder.parent
    return None


def faults_of(root: Path, name: str, text: str, functions: set[str], members: set[str]) -> list[str]:
    """`functions` and `members` run an analysis: no document calls them."""
    faults: list[str] = []
    module = module_of(name)
    if module is None:
        top = name.split("/")[0]
        return [f"{name}: belongs to no floor; name its module in tests/house/floors.py"] if top != "tests" else []

    def fault(position: int, sentence: str, within: str = text) -> None:
        faults.append(f"{name}:{within.count(chr(10), 0, position) + 1}: {sentence}")

    for match in INCLUDE.finditer(text):
        included = match.group(2)
        target = module_of(included)
        if target is not None and target != module and target not in FLOORS[module]:
            fault(match.start(2), f"{module} may not include {included}: {target} is not below it")
        doors = DOORS.get(module, {}).get(target or "")
        if doors is not None and included not in doors:
            fault(match.start(2), f"{module} may not include {included}: it is arithmetic of {target}")
        if match.group(1) == '"' and target is None and (root / name).parent.joinpath(included).exists():
            fault(match.start(2), f"include {included} by its path from the top of the repository")
        if module == "schema/json" and name not in computing.WRITE_NUMBERS and included in computing.COMPUTING_HEADERS:
            fault(match.start(2), f"schema/json may not include <{included}>: documents compute nothing, core does")
        if module == "schema/text" and included == "numeric":
            fault(match.start(2), "schema/text may not include <numeric>: texts compute nothing, core does")
        for pattern, owners in RESERVED.items():
            if re.fullmatch(pattern, included) and not any(o in (module, name) or module.startswith(o + "/") for o in owners):
                fault(match.start(2), f"{module} may not include <{included}>: it is kept to {', '.join(owners)}")
    code = computing.code_of(text)
    if module == "schema/json" and name not in computing.WRITE_NUMBERS:
        for position, said in computing.computing_in(code):
            fault(position, f"schema/json computes ({said}): that belongs to core", code)
    if module == "schema/text" and name not in computing.WRITE_NUMBERS:
        for position, said in computing.told_in(code) + accounting.unaccounted_in(name, code):
            fault(position, f"schema/text computes ({said}): that belongs to core", code)
    if module.split("/")[0] == "schema":
        for position, said in running.run_in(code, functions, members):
            fault(position, f"{module} runs an analysis ({said}): it tells what one found", code)
    if module in ABOVE_USE_CASES:
        unaccounted = accounting.unaccounted_in(name, code) if module != "server/api" else []
        for position, said in computing.statistics_in(code) + unaccounted:
            fault(position, f"{module} analyses ({said}): that belongs to core/analysis", code)
    if module.startswith("core/"):
        for match in THREADS.finditer(code) if name != EXECUTOR else ():
            fault(match.start(), f"core starts threads in {EXECUTOR} alone, which keeps the budget ({match.group(0)})", code)
        for pattern, sentence in FORBIDDEN_IN_CORE.items():
            for match in re.finditer(pattern, code):
                fault(match.start(), f"core {sentence} ({match.group(0).strip('( ')})", code)
    return faults


def check(root: Path) -> list[str]:
    functions, members, empty = running.runners(root)
    faults = [f"{name}: no function of the use case is known; one that neither takes a request nor fails is named in "
              "tests/house/running.py" for name in empty]
    seen = 0
    for path in tree.files(root):
        name = path.relative_to(root).as_posix()
        if path.suffix in {".hpp", ".cpp", ".h"} and name.split("/")[0] in {"core", "schema", "server", "clients"}:
            seen += 1
            faults += faults_of(root, name, path.read_text(), functions, members)
    return faults if seen else [f"no sources under {root}"]


if __name__ == "__main__":
    tree.main(check)
