"""What of a document's code computes, and what of a job kind's, an endpoint's or a command's is an analysis.

A document is what core computed, in the units of its readers. Whoever needs a function of <cmath> or <numeric> in schema/json
computes, and so does who looks for the least, the greatest or the middle, who counts the numbers that are so and so, who sums the
elements of a matrix, and who adds, subtracts, multiplies or divides numbers of a document by another. A change of units passes.
"""
from __future__ import annotations

import re
import textwrap

COMPUTING_HEADERS = {"cmath", "complex", "numeric", "valarray", "math.h"}
COMPUTING = re.compile(
    r"\bstd::(sqrt|cbrt|hypot|exp2?|expm1|log(2|10|1p)?|pow|a?(sin|cos|tan)h?|atan2|erfc?|[lt]gamma|l?l?round|floor|ceil|trunc|f?abs|fmod|"
    r"remainder|fma|lerp|midpoint|accumulate|(transform_)?reduce|inner_product|partial_sum|(inclusive|exclusive)_scan|nth_element|"
    r"(ranges::)?(min|max|minmax)(_element)?|(ranges::)?clamp|plus|minus|multiplies|divides)\b")
# Functions of core that compute, and members of a matrix.
OF_CORE = re.compile(
    r"\b(ned_axes|to_euler|deviation_of|distances_2p|(white_noise|random_walk)_equivalents|ellipse95|horizontal_m)\b"
    r"|\.(transpose|conjugate|inverse|squaredNorm|norm|dot|cross)\(")
# The same without std::, which <cmath> declares too; not a member, nor a function of another name space.
UNQUALIFIED = re.compile(
    r"(?<![\w.:])(?<!->)(sqrt|cbrt|hypot|exp2?|expm1|log(2|10|1p)?|pow|a?(sin|cos|tan)h?|atan2|erfc?|[lt]gamma|l?l?round|floor|ceil|trunc|f?abs|fmod|"
    r"remainder|fma)\(")
REDUCTION = re.compile(r"(\.|->)(sum|mean|prod|maxCoeff|minCoeff)\(")  # of a matrix
# In one function: sorted, and then the element in the middle.
MEDIAN = re.compile(r"\bstd::(ranges::)?(stable_|partial_)?sort\b((?!\n\}).)*?(size\(\)(\s*-\s*1U?\))?\s*/\s*2U?\b|\[[^][]*/\s*2U?\s*\])", re.DOTALL)
COUNTING = re.compile(r"\bstd::(ranges::)?count_if\((?:(?!;).)*?\]\s*\(\s*(const\s+)?(double|float)\b", re.DOTALL)  # of numbers, by what they are

# What nobody needs to move documents, files and jobs about: job kinds, endpoints and commands hold no analysis (core/analysis does).
# What they may add and divide beside it, accounting.py says; endpoints are held to this alone.
STATISTICS = re.compile(
    r"\bstd::(sqrt|cbrt|hypot|exp2?|expm1|log(2|10|1p)?|pow|a?(sin|cos|tan)h?|atan2|erfc?|[lt]gamma|fma|lerp|midpoint|accumulate|"
    r"(transform_)?reduce|inner_product|partial_sum|(inclusive|exclusive)_scan|nth_element|plus|minus|multiplies|divides)\b")
# These write numbers: whether one is finite, to how many decimals, that a whole number fits its type, the bytes of a MATLAB file.
WRITE_NUMBERS = {"schema/json/json.cpp", "schema/json/rounded.cpp", "schema/json/mat_file.cpp", "schema/text/printed.cpp"}

# clang-format puts blanks around an operator of two operands, and none beside one of a single operand or a pointer.
ARITHMETIC = re.compile(r"(?<=[\w)\]])\s+([-+*/])\s+(?=[\w(*\-])|(?<=[\w)\]])\s+([-+*/]=)\s")
# The last name of an operand that is a unit: kDegree, unit.per_si, a factor; or a power of ten, a reciprocal.
UNIT = re.compile(r"k(Degree|StandardGravity|MilliG|Percent|RegressionMg|RegressionPpm)|per|(\w+_)?per_si|si|(\w+_)?factor|unit|100\.0|1e-?\d+")
CHOSEN_UNIT = re.compile(r"\([\w.]+ \? kDegree : 1\.0\)")
WHOLE = re.compile(r"\d[\d']*U?")
PLACE = re.compile(r"size|begin|end|data|length")  # in a list or a text
# Strings are added too: numbers are known by a unit in their name, by their decimals, as numbers taken from a document, or as
# elements of two lists; what is added to also by its declaration.
MEASURED = re.compile(r"\w+_(m|m2|s|hz|rad|deg|degc|m_s|rad_s|m_s2|si)|\d+\.\d*|missing|implausible|samples|get<(double|float)>")
DECLARED = re.compile(r"\b(?:double|float|int|unsigned|long|(?:std::)?(?:size_t|u?int\d+_t|ptrdiff_t))&?\s+(\w+)\s*(?=[={;:,)])|\bauto\s+(\w+)\s*=\s*\d")
ARGUMENT = re.compile(r"<[\w:]+>")  # of a template: get<double>

COMMENT_OR_LITERAL = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|' r"(?<!\w)'(?:\\.|[^'\\\n])+'", re.DOTALL)


def code_of(text: str) -> str:
    """The text with comments and literals blanked out, line breaks kept."""
    return COMMENT_OR_LITERAL.sub(lambda match: "\n" * match.group(0).count("\n") or " ", text)


def hangs(code: str, place: int) -> bool:
    """Whether the character belongs to names, members, calls and elements that hang together, or to a number."""
    return (code[place].isalnum() or code[place] in "_.:'()[]" or "->" in code[max(0, place - 1):place + 2]
            or (code[place] in "+-" and re.search(r"(?<![\w.])\d[\d.]*e$", code[max(0, place - 24):place]) is not None))


def left_of(code: str, end: int) -> str:
    """The operand that ends before `end`."""
    start, depth = end, 0
    while start > 0:
        if code[start - 1] == ">" and (argument := re.search(r"\w(<[\w:]+>)$", code[max(0, start - 40):start])):
            start -= len(argument.group(1))
            continue
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
        if code[end] == "<" and (argument := ARGUMENT.match(code, end)):
            end = argument.end()
            continue
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


def arithmetic_of(code: str) -> list[tuple[int, str, str, str]]:
    """Where numbers are added, subtracted, multiplied or divided that are neither places in a list nor changes of units: the place,
    what stands left of the sign, the sign and what stands right of it.
    """
    found: list[tuple[int, str, str, str]] = []
    declared = {name for match in DECLARED.finditer(code) for name in match.groups()}
    for match in ARITHMETIC.finditer(code):
        left, right = left_of(code, match.start()), right_of(code, match.end())
        names = (last_name(left), last_name(right))
        sign = match.group(1) or match.group(2)
        places = any(PLACE.fullmatch(name) for name in names)
        whole = [bool(WHOLE.fullmatch(name)) for name in names]
        counted = (sign[0] in "+-" and (places or any(whole))) or (places and any(whole)) or all(whole) or inside_an_index(code, match.start())
        unit = (any(UNIT.fullmatch(name) for name in names[1 if sign[0] == "/" else 0:]) or (sign == "/" and left == "1.0")
                or CHOSEN_UNIT.fullmatch(right))
        compared = re.match(r"\s+([<>!=]=?|\?)\s", code[match.end() + len(right):])  # text += i < full ? "#" : ".";
        number = sign[0] != "+" or any(MEASURED.fullmatch(name) for name in names) or names == ("]", "]") \
            or left in declared or (right in declared and not compared)
        if number and not counted and not (unit and sign[0] in "*/"):
            found.append((match.start(), left, sign, right))
    return found


def said_by(patterns: tuple[re.Pattern[str], ...], code: str) -> list[tuple[int, str]]:
    return [(match.start(), textwrap.shorten(match.group(0), 80)) for pattern in patterns for match in pattern.finditer(code)]


def told_in(code: str) -> list[tuple[int, str]]:
    """Where code without comments calls what only an analysis calls, or a function of core that computes."""
    return statistics_in(code) + said_by((OF_CORE,), code)


def statistics_in(code: str) -> list[tuple[int, str]]:
    """Where code without comments calls what only an analysis calls."""
    return said_by((STATISTICS, UNQUALIFIED, REDUCTION, MEDIAN, COUNTING), code)


def computing_in(code: str) -> list[tuple[int, str]]:
    """Where code without comments computes, and what it says there."""
    return said_by((COMPUTING, OF_CORE, UNQUALIFIED, REDUCTION, MEDIAN, COUNTING), code) + [
        (place, f"{left} {sign} {right}") for place, left, sign, right in arithmetic_of(code)]
