#!/usr/bin/env python3
"""Copies the public headers with their plain comments turned into Doxygen's, for docs/api.sh.

usage: api_filter.py TOP FOLDER
The opening comment documents the file. A comment above a declaration documents it, one behind it on its line too.
Lines `//   name  meaning` below an empty comment line are parameters: a name that the function lacks is a warning.
"""
import pathlib
import re
import sys

FOLDERS = ("firmware", "hal", "boards/sim", "host_tools")

COMMENT = re.compile(r"^(\s*)//(?!/)( ?)(.*)$")
TRAILING = re.compile(r"^(\s*[^\s/].*?;|\s*\w+(?:\{[^}]*\})?(?: = [^,]+)?,|\s*\w+)(\s+)// (.*)$")
ITEM = re.compile(r"^ {0,4}([a-z_][a-z0-9_]*(?:, [a-z_][a-z0-9_]*)*)  +(\S.*)$")
CODE = 4  # blanks before it, as Markdown counts


def plain(text):
    """Text without anything that Doxygen or Markdown would take for a command."""
    return re.sub(r"([\\@<>#%\"*_`~|\[\]-])", r"\\\1", text).replace("\\-", "-").replace("\\`", "`").replace("\\_", "_")


def escaped(text):
    """As plain(), but text in backquotes stays code."""
    parts = text.split("`")
    if len(parts) % 2 == 0:
        return plain(text).replace("`", "'")
    return "".join(plain(part) if i % 2 == 0 else f"<tt>{plain(part)}</tt>" for i, part in enumerate(parts))


def names_after(lines, end):
    """The names between the brackets of the declaration that begins at a line."""
    text = ""
    for line in lines[end:end + 20]:
        text += line + " "
        if ";" in line or "{" in line:
            break
    return set(re.findall(r"\w+", text[text.find("("):])) if "(" in text else set()


def block(indent, body, has_parameters, is_file):
    out = [f"{indent}/// \\file"] if is_file else []
    empty, code = True, False
    for text in body:
        item = ITEM.match(text)
        if not text.strip():
            empty, code = True, False
            out.append(f"{indent}///")
            continue
        blanks = len(text) - len(text.lstrip())
        if item and has_parameters:
            out.append(f"{indent}/// \\param {item[1].replace(', ', ',')} {escaped(item[2])}")
        elif blanks >= CODE - 1 and (empty or code) and not has_parameters:
            code = True
            out.append(f"{indent}///     {text.strip() if blanks < CODE else text[CODE - 1:]}")
        else:
            out.append(f"{indent}/// {escaped(text.strip())}")
        empty = False
    return out


def filtered(lines):
    out, i, is_first = [], 0, True
    while i < len(lines):
        match = COMMENT.match(lines[i])
        if match and not lines[i].strip().startswith("// NOLINT"):
            indent, body = match[1], []
            while i < len(lines) and COMMENT.match(lines[i]):
                body.append(COMMENT.match(lines[i])[3])
                i += 1
            below = lines[i] if i < len(lines) else ""
            if is_first or (below.strip() and below.strip() not in ("}", "};") and not below.strip().startswith(("#", "}"))):
                out += block(indent, body, bool(names_after(lines, i)) and not is_first, is_first)
            else:
                out += [f"{indent}//"] * len(body)
        else:
            trailing = TRAILING.match(lines[i])
            out.append(f"{trailing[1]}{trailing[2]}///< {escaped(trailing[3])}" if trailing else lines[i])
            i += 1
        is_first = False
    return out


def main(top, folder):
    for place in FOLDERS:
        (folder / place).mkdir(parents=True, exist_ok=True)
        for header in sorted((top / place).rglob("*.hpp")):
            copy = folder / header.relative_to(top)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text("\n".join(filtered(header.read_text().splitlines())) + "\n")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
