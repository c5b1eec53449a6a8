"""What of a document's code computes, and what of a job kind's, an endpoint's or a command's is an analysis.

A document is what core computed, in the units of its readers. Whoever needs a function of <cmath> or <numeric> in schema/json
computes, and so does who looks for the least or greatest, and who adds, subtracts, multiplies or divides numbers of a document by
another. A change of units passes.
"""
from __future__ import annotations

import re

COMPUTING_HEADERS = {"cmath", "complex", "numeric", "valarray", "math.h"}
COMPUTING = re.compile(
    r"\bstd::(sqrt|cbrt|hypot|exp2?|expm1|log(2|10|1p)?|pow|a?(sin|cos|tan)h?|atan2|erfc?|[lt]gamma|l?l?round|floor|ceil|trunc|f?abs|fmod|"
    r"remainder|fma|lerp|midpoint|accumulate|(transform_)?reduce|inner_product|partial_sum|(inclusive|exclusive)_scan|nth_element|"
    r"(ranges::)?(min|max|minmax)(_element)?|(ranges::)?clamp|plus|minus|multiplies|divides)\b"
    r"|\b(ned_axes|to_euler|deviation_of|distances_2p|(white_noise|random_walk)_equivalents|ellipse95|horizontal_m)\b"
    r"|\.(transpose|conjugate|inverse|squaredNorm|norm|dot|cross)\(")
# What nobody needs to move documents, files and jobs about: job kinds, endpoints and commands hold no analysis (core/analysis does).
# Costs, progress, paths and times are added and divided there, so that plain arithmetic passes.
STATISTICS = re.compile(
    r"\bstd::(sqrt|cbrt|hypot|exp2?|expm1|log(2|10|1p)?|pow|a?(sin|cos|tan)h?|atan2|erfc?|[lt]gamma|fma|lerp|midpoint|accumulate|"
    r"(transform_)?reduce|inner_product|partial_sum|(inclusive|exclusive)_scan|nth_element)\b")
# These write numbers: whether one is finite, to how many decimals, that a whole number fits its type, the bytes of a MATLAB file.
WRITE_NUMBERS = {"schema/json/json.cpp", "schema/json/rounded.cpp", "schema/json/mat_file.cpp"}

# clang-format puts blanks around an operator of two operands, and none beside one of a single operand or a pointer.
ARITHMETIC = re.compile(r"(?<=[\w)\]])\s+([-+*/])\s+(?=[\w(*\-])|(?<=[\w)\]])\s+([-*/]=)\s")
# The last name of an operand that is a unit: kDegree, unit.per_si, a factor; or a power of ten, a reciprocal.
UNIT = re.compile(r"k(Degree|StandardGravity|MilliG|Percent|RegressionMg|RegressionPpm)|per|(\w+_)?per_si|si|(\w+_)?factor|unit|100\.0|1e-?\d+")
WHOLE = re.compile(r"\d[\d']*U?")
PLACE = re.compile(r"size|begin|end|length")  # in a list or a text
# Strings are added too: numbers are known by a unit in their name, by their decimals, or as elements of two lists.
MEASURED = re.compile(r"\w+_(m|m2|s|hz|rad|deg|degc|m_s|rad_s|m_s2|si)|\d+\.\d*|missing|implausible|samples")

COMMENT_OR_LITERAL = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|' r"(?<!\w)'(?:\\.|[^'\\\n])+'", re.DOTALL)


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


def statistics_in(code: str) -> list[tuple[int, str]]:
    """Where code without comments calls what only an analysis calls."""
    return [(match.start(), match.group(0)) for match in STATISTICS.finditer(code)]


def computing_in(code: str) -> list[tuple[int, str]]:
    """Where code without comments computes, and what it says there."""
    return [(match.start(), match.group(0)) for match in COMPUTING.finditer(code)] + arithmetic_of(code)
