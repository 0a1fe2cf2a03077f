#!/usr/bin/env python3
"""Random STEP parts, planned from their faces and judged against Open CASCADE's mesh of the same part.

usage: random_parts.py CUSP RANDOM_PART [--first SEED] [--count N] [--swept] [--keep FOLDER]

RANDOM_PART (random_part.cpp) makes a part and its mesh, which never goes through the reading of STEP. The part is
finished by a random strategy with a random ball, and the program is verified over the mesh. Exit status 1 where a
part is refused, the program gouges the mesh, or cusp verify finds a bound broken over it. Where the part's own
tolerances are over the job's, or its mesh is farther beside it, that judges nothing: such a part need only be read
and planned.
"""
import argparse
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time

TOLERANCE = 0.01  # mm, of the job
MESH = 0.004  # mm, of the mesh

JOB = """[tool]
shape = "ball"
diameter = {diameter}
[cutting]
feed = 1000.0
[stock]
top = 0.0
clearance = 5.0
margin = 2.0
[[operation]]
strategy = "{strategy}"
floor = ["{floor}"]
scallop = {scallop}
floor_tolerance = {tolerance}
"""


def run(*words):
    return subprocess.run([str(w) for w in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def judge(cusp, maker, seed, kind, folder):
    """True if the part of a seed is read, and its program holds; says what it found."""
    rng = random.Random(seed)
    words = {
        "strategy": rng.choice(["adaptive_isocurve", "parallel_planes"]),
        "diameter": 2 * rng.choice([1.0, 1.5, 2.0, 3.0]),
        "scallop": rng.choice([0.05, 0.1]),
        "tolerance": TOLERANCE
    }
    what = f"seed {seed}{' swept' if kind else ''} {words['strategy']} R {words['diameter'] / 2} scallop {words['scallop']}"
    made = run(maker, seed, folder / "part.step", folder / "mesh.stl", *kind)
    if made.returncode != 0:
        print(f"{what}: Open CASCADE makes no part, status {made.returncode}")
        return True
    loose = float(re.search(r"tolerance (\S+) mm", made.stdout).group(1))
    mesh_off = float(re.search(r"mesh off (\S+) mm", made.stdout).group(1))
    (folder / "part.toml").write_text(JOB.format(floor="part.step", **words))
    (folder / "mesh.toml").write_text(JOB.format(floor="mesh.stl", **words))
    begin = time.time()
    plan = run(cusp, "plan", "--estimate-times", folder / "part.toml", "-o", folder / "part.ngc", "--stats", folder / "plan.json")
    seconds = time.time() - begin
    if plan.returncode != 0:
        print(f"{what}: {plan.stdout.strip()}  BROKEN")
        return False
    if loose > TOLERANCE:
        print(f"{what}: planned; tolerances of {loose:.3g} mm, so not judged; {seconds:.1f} s")
        return True
    if mesh_off > TOLERANCE + MESH:
        print(f"{what}: planned; the mesh is {mesh_off:.3g} mm off, so not judged; {seconds:.1f} s")
        return True
    verify = run(cusp, "verify", folder / "mesh.toml", folder / "part.ngc", "--stats", folder / "verify.json")
    seen = json.loads((folder / "verify.json").read_text())
    claimed = json.loads((folder / "plan.json").read_text())["operations"][0]["scallop_bound_mm"]
    gouge = max(seen["gouge_max_mm"], seen["ball_gouge_max_mm"])
    most = claimed + TOLERANCE + MESH
    holds = verify.returncode == 0 and gouge <= TOLERANCE + MESH and seen["scallop_max_mm"] <= most
    print(f"{what}: gouge {gouge:.4f}, scallop {seen['scallop_p99_mm']:.3f} (99 of 100), {seen['scallop_max_mm']:.3f} at "
          f"most, claimed {claimed:.3f}, verify {verify.returncode}; {seconds:.1f} s{'' if holds else '  BROKEN'}")
    return holds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cusp")
    parser.add_argument("maker")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--count", type=int, default=4)
    parser.add_argument("--swept", action="store_true", help="bodies that are swept, lofted or free")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the cases, instead of a temporary one")
    options = parser.parse_args()
    good = True
    for seed in range(options.first, options.first + options.count):
        with tempfile.TemporaryDirectory() as name:
            folder = options.keep / str(seed) if options.keep else pathlib.Path(name)
            folder.mkdir(parents=True, exist_ok=True)
            good = judge(options.cusp, options.maker, seed, ['swept'] if options.swept else [], folder) and good
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
