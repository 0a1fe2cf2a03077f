#!/usr/bin/env python3
"""Plans random pockets and cuts them in memory: no gouge, no rapid move through stock, no cut deeper
and no more stock left than the job allows, few retracts.

usage: random_pockets_test.py CUSP [CASES [FIRST_SEED]]

A case whose loops cross is refused with the place, as it should be, and does not count. The pockets
of cases that fail are kept, and named.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "generators"))
from random_pocket import RandomPocket  # noqa: E402

REFUSALS = ("crosses", "lies outside", "lies inside", "fits nowhere")
LEAST_GOUGE = 1e-3  # mm, what the judge's grid resolves
SLIVER = 0.02  # mm of depth


def call(*words):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)


def limit(job, key):
    """A length of the job in mm, None where it is not given."""
    text = job.read_text()
    found = re.search(rf"^{key} = ([0-9.]+)$", text, re.MULTILINE)
    return found and float(found.group(1)) * (25.4 if 'units = "inch"' in text else 1.0)


def fault(cusp, job, folder):
    """The fault of the planned pocket; "" if there is none, None if the pocket is refused."""
    program, figures = folder / "pocket.ngc", folder / "verify.json"
    planned = call(cusp, "plan", "--estimate-times", job, "-o", program, "--stats", folder / "plan.json")
    if planned.returncode == 2 and any(word in planned.stderr for word in REFUSALS):
        return None
    if planned.returncode != 0:
        return f"plan: {planned.returncode} {planned.stderr[-300:]}"
    for operation in json.loads((folder / "plan.json").read_text())["operations"]:
        most = (operation["leaves"] + operation["islands"]) * operation.get("layers", 1)
        if operation["retracts"] > most:
            return f"retracts {operation['retracts']}, leaves and islands {most}"
    verified = call(cusp, "verify", job, program, "--stats", figures)
    if verified.returncode != 0:
        return f"verify: {(verified.stdout + verified.stderr)[-300:]}"
    found = json.loads(figures.read_text())
    for name in ("gouge_max_mm", "wall_gouge_max_mm", "rapid_cut_max_mm"):
        if found.get(name, 0.0) > LEAST_GOUGE:
            return f"{name} {found[name]}"
    deepest = limit(job, "max_depth")
    if deepest and found["cut_depth_max_mm"] > deepest * 1.02 + SLIVER:
        return f"cut_depth_max_mm {found['cut_depth_max_mm']}, max_depth {deepest}"
    return ""


def main():
    cusp = pathlib.Path(sys.argv[1]).resolve()
    cases = int(sys.argv[2]) if len(sys.argv) > 2 else 6
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1990
    faults = 0
    judged = 0
    while judged < cases:
        folder = pathlib.Path(tempfile.mkdtemp(prefix=f"pocket-{seed}-"))
        pocket = RandomPocket(seed)
        found = fault(cusp, pocket.write(folder), folder)
        judged += found is not None
        words = "refused" if found is None else found or "whole"
        print(f"seed {seed}: {pocket.floor_kind}, R {pocket.radius:.2f}: {words}", flush=True)
        if found:
            faults += 1
            print(f"  kept in {folder}")
        else:
            shutil.rmtree(folder)
        seed += 1
    print(f"{judged} pockets, {faults} with a fault")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
