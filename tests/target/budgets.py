#!/usr/bin/env python3
"""Holds the instruction counts of the hot paths, counted under QEMU, to those on record.

usage: budgets.py IMAGE RECORD [--update]
A count more than 2 % over the record fails; one more than 2 % under it asks for --update. Counts over
the goal (the third column of the record) are named.
Exit status: 0 within, 1 not, 2 the image or the record can't be used.
"""
import sys

from qemu import RunFailed, run_image

ALLOWED = 0.02


def read_record(path):
    """name -> (mean, most, goal), and the lines that are comments."""
    counts, comments = {}, []
    for line in open(path):
        if line.startswith("#"):
            comments.append(line)
        elif line.strip():
            name, mean, most, goal = line.split()
            counts[name] = (int(mean), int(most), goal)
    return counts, comments


def count(image):
    status, text = run_image(image)
    counts = {}
    for line in text.splitlines():
        words = line.split()
        if len(words) == 4 and all(word.isdigit() for word in words[1:]):
            counts[words[0]] = (int(words[1]), int(words[2]))
    if status != 0 or not counts:
        raise RunFailed(f"{image}: status {status}: {text[-300:]}")
    return counts


def compare(counted, record):
    for name in sorted(record.keys() - counted.keys()):
        yield f"{name}: on record, not counted"
    for name, now in counted.items():
        if name not in record:
            yield f"{name}: counted, not on record"
            continue
        for what, value, allowed in zip(("mean", "most"), now, record[name]):
            if abs(value - allowed) > ALLOWED * allowed + 1:
                direction = "over" if value > allowed else "under"
                yield f"{name}: {what} {value} is {direction} the {allowed} on record"


def write_record(path, counted, record, comments):
    with open(path, "w") as file:
        file.writelines(comments)
        for name, (mean, most) in counted.items():
            goal = record[name][2] if name in record else "-"
            file.write(f"{name:24}{mean:8}{most:8}{goal:>8}\n")


def main(arguments):
    if len(arguments) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        record, comments = read_record(arguments[2])
        counted = count(arguments[1])
    except (OSError, ValueError, RunFailed) as error:
        print(f"budgets: {error}", file=sys.stderr)
        return 2
    for name, (mean, most) in counted.items():
        goal = record.get(name, (0, 0, "-"))[2]
        over = goal.isdigit() and mean > int(goal)
        print(f"{name:24}{mean:8}{most:8}" + (f"   over the goal of {goal}" if over else ""))
    if "--update" in arguments:
        write_record(arguments[2], counted, record, comments)
        return 0
    found = list(compare(counted, record))
    if found:
        print("\n".join(found) + "\nif this is meant: budgets.py IMAGE RECORD --update, and say why")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
