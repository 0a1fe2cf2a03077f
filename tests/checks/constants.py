#!/usr/bin/env python3
"""Checks that "nothing", "no limit", the inch and each function of analysis have one name.

usage: constants.py TOP
host_tools/geometry/nurbs/plan_vector.hpp defines kInfinite, kUnbounded and kNoValue. Elsewhere in host_tools no number of 1e9 or
more replaces them: it is allowed only as a named constant (`constexpr`). No constant is another name of the three, and
none is written as std::numeric_limits. LACK may not include plan_vector.hpp and write std::numeric_limits.
kMillimetresPerInch of firmware/base/inch.hpp is the only 25.4. JSON is written by host_tools/base/json_text alone: dump() throws at
bytes that are no UTF-8. The sine and its like are those of host_tools/base/elementary, as C libraries differ in them. Comments and strings do not count.
Exit status: 0 all do, 1 some do not, 2 there are no sources.
"""
import pathlib
import re
import sys

HOME = "host_tools/geometry/nurbs/plan_vector.hpp"
INCH = "firmware/base/inch.hpp"
ELEMENTARY = "host_tools/base/elementary/"
JSON_TEXT = "host_tools/base/json_text/json_text.hpp"
LACK = ("host_tools/controller/program_run/", "host_tools/judge/view/")
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
HUGE = re.compile(r"(?<![\w.])[\d']+(?:\.\d*)?[eE]\+?0*(?:9|[1-9]\d+)\b")
ALIAS = re.compile(r"\bk\w+(?: = |\{)-?k(?:Infinite|Unbounded|NoValue)[;}]")
LIMITS = re.compile(r"numeric_limits<(?:double|float)>::(?:max|lowest)\b|numeric_limits<double>::(?:infinity|quiet_NaN)\b|\bstd::nan\(|\b(?:HUGE_VAL|INFINITY|NAN)\b")
DUMP = re.compile(r"\.dump\(")
ANALYSIS = re.compile(r"(?<![\w.>])(?<!\belementary::)(?:std)?(?:::)?\b(a?(?:sin|cos|tan)h?|atan2|sincos|hypot|cbrt|pow|exp[2m]?1?|log(?:2|10|1p|b)?|fma|tgamma|lgamma|erfc?)[fl]?\(")
TWENTY_FIVE = re.compile(r"(?<![\w.])25\.4F?(?![\w.])")


def complaints(text, place):
    lines = COMMENT_OR_STRING.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text).split("\n")
    for number, line in enumerate(lines, 1):
        if place != INCH and TWENTY_FIVE.search(line):
            yield f"{place}:{number}: 25.4 is kMillimetresPerInch of {INCH}"
        if DUMP.search(line) and place != JSON_TEXT:
            yield f"{place}:{number}: dump() is json_text::written() of {JSON_TEXT}"
        if place == HOME or not place.startswith("host_tools/"):
            continue
        if not place.startswith(ELEMENTARY) and ANALYSIS.search(line):
            yield f"{place}:{number}: {ANALYSIS.search(line).group()}) is not the same on every machine: {ELEMENTARY}elementary.hpp"
        if "constexpr" not in line and HUGE.search(line):
            yield f"{place}:{number}: {HUGE.search(line).group()} is kUnbounded or a std::optional, or needs a name"
        if "constexpr" in line and ALIAS.search(line):
            yield f"{place}:{number}: a second name of a constant of {HOME}"
        if LIMITS.search(line) and not place.startswith(LACK):
            yield f"{place}:{number}: {LIMITS.search(line).group()} is kInfinite, kUnbounded or kNoValue of {HOME}"


def main(arguments):
    top = pathlib.Path(arguments[1])
    files = [file for folder in ("firmware", "host_tools") for file in sorted((top / folder).rglob("*.[hc]pp"))]
    if not files:
        print(f"constants: no sources below {top}", file=sys.stderr)
        return 2
    found = [text for file in files for text in complaints(file.read_text(), file.relative_to(top).as_posix())]
    print("\n".join(found) if found else f"constants: {len(files)} files with one name for nothing, one for the inch, and functions of analysis that are the same everywhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
