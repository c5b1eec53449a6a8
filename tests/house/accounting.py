"""What job kinds, commands and the daemon add, divide, sort and compare: what they keep account of, and nothing that was measured.
And what texts do: they lay out.

The former move documents, files and jobs about. That takes arithmetic of bytes, rows, times by the clock and shares of a progress, and
it is known by the names of all that goes into it: one name that is none of these makes it a number of somebody's recording. Texts
count letters, cells and lines.
"""
from __future__ import annotations

import re

import computing

# What each part of these modules keeps account of. A name stands for itself, whoever it is a member of.
COUNTED = re.compile("|".join((
    r"\w*bytes\w*|sizeof|length|size|machine|allowed",  # of memory and files
    r"rows|columns|count|members|results|filters|files_?|threads|computing|workers|hardware_concurrency|removed|jobs",  # how many
    r"now|newest|\w+_at_?|begun_|grace|turn|watchdog_|\w*micros\w*|\w+_(days|hours|seconds)_?|seconds",  # times and how long
    r"progress\w*|fraction|done_?|step",  # of a bar
    r"k[A-Z]\w*|[ijk]|\d[\w.']*",  # constants, and places in lists
)))
# Where a word stands in a text, and how wide a table is.
LAID_OUT = re.compile(r"k[A-Z]\w*|[ijkrc]|\d[\w.']*|size|length|count|widths?|depth|at|from|end|grid|shown|all|columns|lines?")
# What is not said by a name above, and why it may stand there.
PLACES: dict[str, tuple[str, str]] = {
    "server/jobs/outage_evaluation.cpp": (r"duration_s|imu_rate_hz|epochs|runs", "what the scenario costs before it runs"),
    "server/jobs/drive_evaluation.cpp": (r"fits|seconds_per_row", "what its filters cost before they run"),
    "server/jobs/investigate.cpp": (r"beside_others", "rows, of which memory is needed at once"),
    "server/jobs/job_cost.cpp": (r"most|left_|whole_|memory_of_process", "bytes of the gate and of the machine"),
    "server/jobs/maintenance.cpp": (r"gone", "files that it removed"),
    "server/jobs/worker_pool.cpp": (r"idle|renewing|telling", "when a lease is renewed"),
    "server/process.cpp": (r"resident|sysconf|_SC_\w+|tv_n?sec", "memory and time of this process"),
    "server/service_manager.cpp": (r"number_of|variable", "the time between two signs of life"),
    "clients/cli/local.cpp": (r"alike|axes", "tables that are printed side by side"),
    "clients/cli/remote.cpp": (r"condition", "names of the members of a condition"),
    "clients/cli/progress.cpp": (r"last_", "when the bar was last drawn"),
    "clients/cli/regress_there.cpp": (r"before", "the progress before a file"),
    "clients/cli/remote_job.cpp": (r"event|get", "the progress that an event tells"),
    "clients/cli/table_file.cpp": (r"c", "a column of a row of bytes"),
    "schema/text/regression_junit.cpp": (r"tests|failures|errors|skipped", "cases of a suite that it has written"),
}
SORTED = re.compile(r"ids|names|members|known|files")  # what has no middle
TEXT = re.compile(r"find\w*|size|data|at|colon|stop|value|comma")  # places in a text
PATH = re.compile(r"folder_?|data|path|parent_path|kept")  # a file in it

NOT_A_NAME = re.compile(
    r"(std::)?(u?int\d+_t|size_t|uintmax_t|ptrdiff_t|streamsize|min|max|clamp|floor|l?l?round)|double|int|unsigned|static_cast|"
    r"(std::)?chrono(::\w+)*|clock|UtcMicros|JobCost")
NAMES = re.compile(r"[A-Za-z_]\w*(?:(?:\.|->|::)[A-Za-z_]\w*)*|(?<![\w.])\d[\w.']*")
ROUNDED = re.compile(r"\bstd::(l?l?round|floor|ceil|trunc|f?abs|fmod|remainder)\b")
EXTREMUM = re.compile(r"\bstd::(ranges::)?(min|max|minmax|clamp)\b")
ELEMENT = re.compile(r"\bstd::(ranges::)?(min|max|minmax)_element\b")
SORT = re.compile(r"\bstd::(?:ranges::)?(?:stable_|partial_)?sort\(\s*([\w.>-]+?)(?:\.begin\(|\.data\(|[\[,)(])")


def names_in(operand: str) -> list[str]:
    """The names that go into an operand: of `static_cast<double>(list.size()) * one.rows` the names size and rows."""
    bare = re.sub(r"<[\w:<>, ]*>(?=\()|\[[^][]*\]|\(\)", "", operand)
    bare = re.sub(r"\(\*(\w+)\)", r"\1", bare)
    return [re.split(r"\.(?!\d)|->|::", name)[-1] if not name[0].isdigit() else name
            for name in NAMES.findall(bare) if not NOT_A_NAME.fullmatch(name)]


def parts_of(call: str) -> list[str]:
    """The arguments of a call, taken apart at the commas between them."""
    parts, depth = [""], 0
    for letter in call[call.index("(") + 1:-1]:
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return parts


def is_counted(name: str, *operands: str) -> bool:
    known = LAID_OUT if name.startswith("schema/text/") else COUNTED
    here = re.compile(PLACES.get(name, ("", ""))[0])
    return all(known.fullmatch(said) or here.fullmatch(said) for operand in operands for said in names_in(operand))


def unaccounted_in(name: str, code: str) -> list[tuple[int, str]]:
    """Where the code of the file, without comments, computes with what it keeps no account of."""
    found = [(place, f"{left} {sign} {right}") for place, left, sign, right in computing.arithmetic_of(code)
             if not (sign == "/" and PATH.fullmatch(computing.last_name(left)))
             and not (sign in "+-" and all(TEXT.fullmatch(said) for said in names_in(left) + names_in(right)))
             and not is_counted(name, left, right)]
    for match in (*ROUNDED.finditer(code), *EXTREMUM.finditer(code)):
        call = computing.right_of(code, match.start())
        parts = parts_of(call) if "(" in call else [call]
        in_a_text = any(computing.PLACE.fullmatch(computing.last_name(part.strip())) for part in parts)
        if not in_a_text and not is_counted(name, *parts):
            found.append((match.start(), call))
    sorts = [match for match in SORT.finditer(code) if not SORTED.fullmatch(computing.last_name(match.group(1)))
             and not is_counted(name, match.group(1))]
    return found + [(match.start(), match.group(0)) for match in (*sorts, *ELEMENT.finditer(code))]
