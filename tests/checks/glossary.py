#!/usr/bin/env python3
"""Checks that the nouns of the host tools' classes are words of the glossary, or standard terms.

usage: glossary.py TOP
A class name of a public header in host_tools is split into words: ScallopCheck is "scallop" and "check". Each is to be a
word on the left of a row of docs/glossary.md, or one of STANDARD: terms of geometry, CAM, G-code and programming that
mean here what they mean everywhere. Plurals count as their singular.
Exit status: 0 all are, 1 some are not, 2 there is no glossary or no class.
"""
import pathlib
import re
import sys

STANDARD = set("""
    above access after and angle arc area at ball basis bend bernstein beside bezier bound box buffer by byte
    cad call chain check checksum choice cleanup clear clearing closed colour command comment cone contour control controller
    coolant count cross curve cutting dense descriptor diameter difference display distance domain drawing dxf edge effect end
    entity equal error executed extent face fact fault figure file fit fitted fitter flat flow follow form free from
    geometry graph grid group guess health hermite hit hole homogeneous info input inspect instrument job key keyboard kind lattice
    layout leading left length limit limiter line listener lost lower lowest machine measure mesh model motion
    name navigation nearest nesting number nurbs octant offer offset one open operation option outcome output page
    parameter partial picture piece place plan plane planned pocket position profile progress proof proved
    quadratic question queue range rate raw reach read reading record rectangle refusal refused repair replacement
    report request result resume rough row rule sample scripted search section segment selection serial serve solid sphere
    settings shape share side simulation source space spacing span spline split spot start stop stat statistic status
    step stream streamer surface table tangent task text thickest time to toolpath trace traversal tree trimmer under unit
    vcd vec verification verify version vertex vertices visibility volume way welded work worst writer
""".split())
TYPE = re.compile(r"^(?:struct|class|enum class) (?:alignas\(\d+\) )?(\w+)(?: final)?(?:\s*:(?!:)[^;{]*)?\s*\{", re.MULTILINE)
WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
ROW = re.compile(r"^\| ([^|]+) \|", re.MULTILINE)
# -ed and -s of words in either list are the same words
ENDINGS = ("", "s", "es", "d", "ed")


def known(word, terms):
    stems = {word, *(word[:-len(ending)] for ending in ENDINGS if ending and word.endswith(ending))}
    if word.endswith("ies"):
        stems.add(word[:-3] + "y")
    return bool(stems & terms)


def main(arguments):
    top = pathlib.Path(arguments[1])
    try:
        glossary = (top / "docs/glossary.md").read_text()
    except OSError as error:
        print(f"glossary: {error}", file=sys.stderr)
        return 2
    terms = STANDARD | {word.lower() for row in ROW.findall(glossary) for word in re.findall(r"[A-Za-z]+", row)}
    found, count = [], 0
    for header in sorted((top / "host_tools").rglob("*.hpp")):
        text = header.read_text()
        for match in TYPE.finditer(text):
            count += 1
            line = text.count("\n", 0, match.start()) + 1
            for word in WORD.findall(match[1]):
                if len(word) > 1 and not known(word.lower(), terms):
                    found.append(f"{header.relative_to(top)}:{line}: {match[1]}: define \"{word.lower()}\" in docs/glossary.md, "
                                 "rename the class, or add a standard term to tests/checks/glossary.py")
    if not count:
        print("glossary: no class found", file=sys.stderr)
        return 2
    print("\n".join(found) if found else f"glossary: the words of {count} classes are known")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
