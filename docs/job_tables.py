#!/usr/bin/env python3
"""Writes the tables of docs/job_file.md from the keys that cusp knows, or compares them.

usage: job_tables.py CUSP PAGE [--write]
A table stands between <!-- keys: NAME --> and <!-- end of keys -->. NAME is a table of the job, `operation` (keys of all
operations), `strategies` (keys of some) or `tabs`.
Exit status: 0 page and keys agree, or the page is written; 1 they differ; 2 cusp has no schema, the page no tables.
"""
import difflib
import itertools
import json
import pathlib
import re
import subprocess
import sys

PLACE = re.compile(r"(?<=<!-- keys: )(\w+)( -->\n).*?(?=<!-- end of keys -->)", re.DOTALL)
HEAD = "| key | default | means |\n|---|---|---|\n"


def properties_of(form, definitions):
    """Of a table, or of one of several; None where the key is no table."""
    each = form.get("then", form)
    table = definitions[each["$ref"].split("/")[-1]] if "$ref" in each else each
    return table.get("properties")


def choices_of(form):
    return form.get("enum", [])


def default_of(form):
    default = form["x-default"]
    return f'`"{default}"`' if default in choices_of(form) else "" if default == "none" else default


def meaning_of(form):
    help_text = form["description"]
    left = [f'`"{choice}"`' for choice in choices_of(form)
            if f'"{choice}"' not in help_text and choice != form["x-default"]]
    return f"{help_text}; {', '.join(left)}" if left else help_text


def row(names, form, of=""):
    return f"| `{'`, `'.join(names)}` | {default_of(form)} | {of}{meaning_of(form)} |\n"


def rows(properties):
    """Neighbours that differ by their names alone share a row."""
    for form, pairs in itertools.groupby(properties.items(), key=lambda pair: json.dumps(pair[1])):
        yield row([name for name, _ in pairs], json.loads(form))


def table(properties):
    return HEAD + "".join(rows(properties))


def strategies_of(schema):
    """name -> properties, in order."""
    operation = schema["definitions"]["operation"]
    return {branch["if"]["properties"]["strategy"]["const"]: branch["then"]["properties"] for branch in operation["allOf"]}


def words_for(strategies, surfaces):
    """A list of strategies, shorter where all those on surfaces are among it."""
    others = [each for each in strategies if each not in surfaces]
    lists = ["surfaces"] if set(surfaces) <= set(strategies) else []
    lists += [f"`{each}`" for each in (others if lists else strategies)]
    return ", ".join(lists)


def told_apart(schema):
    """Keys of all operations; of the others a row for each meaning, with the strategies that have it."""
    strategies = strategies_of(schema)
    common, rows = {}, {}
    for strategy, properties in strategies.items():
        for name, form in properties.items():
            rows.setdefault((name, json.dumps(form)), []).append(strategy)
    names = {}
    for (name, form), of in rows.items():
        names.setdefault(name, []).append((json.loads(form), of))
    surfaces = [strategy for strategy, properties in strategies.items() if "intersect" in properties]
    text = HEAD
    for name, forms in names.items():
        most = max(forms, key=lambda each: len(each[1]))
        if sum(len(of) for _, of in forms) == len(strategies):
            common[name] = most[0]
            forms = [each for each in forms if each is not most]
        for form, of in forms:
            text += row([name], form, words_for(of, surfaces) + ": ")
    return table(common), text


def tables_of(schema):
    forms = {name: (form, properties_of(form, schema["definitions"])) for name, form in schema["properties"].items()}
    out = {name: table(properties) for name, (_, properties) in forms.items() if properties and name != "operation"}
    out["job"] = table({name: form for name, (form, properties) in forms.items() if not properties})
    out["tabs"] = table(strategies_of(schema)["profile"]["tabs"]["properties"])
    out["operation"], out["strategies"] = told_apart(schema)
    return out


def main(arguments):
    cusp, page = arguments[1], pathlib.Path(arguments[2])
    text = page.read_text()
    run = subprocess.run([cusp, "plan", "--schema"], capture_output=True, text=True)
    if run.returncode != 0 or not PLACE.search(text):
        print(f"job_tables: no schema, or no tables in {page}: {run.stderr}", file=sys.stderr)
        return 2
    tables = tables_of(json.loads(run.stdout))
    missing = set(tables) - {place[1] for place in PLACE.finditer(text)}
    made = PLACE.sub(lambda place: place[1] + place[2] + tables[place[1]], text)
    if "--write" in arguments:
        page.write_text(made)
    elif made != text:
        sys.stdout.writelines(difflib.unified_diff(text.splitlines(True), made.splitlines(True), str(page), "cusp plan --schema"))
    for name in sorted(missing):
        print(f"{page}: has no table of {name}")
    return 1 if missing or ("--write" not in arguments and made != text) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
