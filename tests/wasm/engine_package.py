#!/usr/bin/env python3
"""Packs cusp-engine, installs the tarball in an empty folder, runs its tests and its example there under node, and
compares it with the program: all jobs of examples/ without STEP have the same G-code to the byte, and the same figures
of `cusp verify` and `cusp sim`, edges_crc32 among them.

usage: engine_package.py --modules NODE_MODULES --engine FOLDER --cusp CUSP [--only WORD] [--no-figures]
FOLDER holds engine.mjs and engine.wasm.
Exit status: 0 all pass and all is equal, 1 not.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parents[1]
SOURCES = TOP / "host_tools/cam/engine/npm"
NAMED = re.compile(r'"([\w./-]+\.\w+)(?:#[^"]*)?"')
CAD = (".step", ".stp", ".iges", ".igs", ".brep")
TIMES = {"planning_s", "wall_s", "seconds"}


def call(*words, folder, **more):
    # Nothing is fetched: the package has no dependencies.
    environment = {**os.environ, "npm_config_offline": "true", "npm_config_update_notifier": "false"}
    return subprocess.run([str(w) for w in words], cwd=folder, check=True, env=environment, **more)


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(each) for key, each in value.items() if key not in TIMES}
    return [without_times(each) for each in value] if isinstance(value, list) else value


def differences(a, b, place=""):
    """The places at which two values of JSON differ."""
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        return [found for key in a for found in differences(a[key], b[key], f"{place}.{key}")]
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return [found for k, pair in enumerate(zip(a, b)) for found in differences(*pair, f"{place}[{k}]")]
    return [] if a == b else [f"{place}: {a} and {b}"]


def jobs(only):
    for job in sorted((TOP / "examples").rglob("*.toml")):
        text = job.read_text()
        files = [name for name in dict.fromkeys(NAMED.findall(text)) if (job.parent / name).is_file()]
        if "[[operation]]" in text and not any(name.lower().endswith(CAD) for name in files) and only in str(job):
            yield job, files


def native(cusp, job, folder, figures):
    """The programs and figures of the program, by the names of their files."""
    out = folder / "native"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir()
    call(cusp, "plan", job.name, "-o", out / "part.ngc", folder=job.parent, stdout=subprocess.DEVNULL)
    programs = sorted(out.glob("*.ngc"), key=lambda file: file.stat().st_mtime_ns)
    found = {}
    for k, file in enumerate(programs):
        found[file.name] = {"gcode": file.read_text()}
        if figures:
            after = ["--after", *programs[:k]] if k else []
            call(cusp, "verify", job.name, file, "--stats", out / "verify.json", *after, folder=job.parent, stdout=subprocess.DEVNULL)
            call(cusp, "sim", file, "--stats", out / "sim.json", folder=job.parent, stdout=subprocess.DEVNULL)
            found[file.name]["verify"] = json.loads((out / "verify.json").read_text())
            found[file.name]["sim"] = json.loads((out / "sim.json").read_text())
    return found


def compare(options, user, folder):
    different = 0
    count = 0
    for job, files in jobs(options.only):
        ours = native(options.cusp, job, folder, not options.no_figures)
        request = {"folder": str(job.parent), "job": job.name, "files": files, "figures": not options.no_figures}
        said = call("node", "engine_job.mjs", folder=user, input=json.dumps(request).encode(), stdout=subprocess.PIPE)
        theirs = json.loads(said.stdout)
        wrong = [] if ours.keys() == theirs.keys() else [f"programs {list(ours)} and {list(theirs)}"]
        for name in ours.keys() & theirs.keys():
            a = ours[name].pop("gcode").splitlines()
            b = theirs[name].pop("gcode").splitlines()
            lines = sum(x != y for x, y in zip(a, b)) + abs(len(a) - len(b))
            wrong += [f"{name}: {lines} of {len(a)} lines of G-code differ"] if lines else []
            wrong += differences(without_times(ours[name]), without_times(theirs[name]), name)
        count += len(ours)
        different += bool(wrong)
        print(f"{job.relative_to(TOP)}: {'; '.join(wrong[:5]) or 'equal'}", flush=True)
    print(f"{count} programs, {different} jobs differ")
    return different == 0 and count > 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--modules", required=True)
    parser.add_argument("--engine", required=True)
    parser.add_argument("--cusp", required=True, type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--no-figures", action="store_true")
    options = parser.parse_args()
    options.cusp = options.cusp.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        user = folder / "user"
        user.mkdir()
        try:
            call("node", SOURCES / "build.mjs", "--out", folder / "package", "--engine", options.engine, "--modules",
                 options.modules, folder=folder)
            call("npm", "pack", "--ignore-scripts", "--pack-destination", folder, folder=folder / "package", stdout=subprocess.DEVNULL)
            tarball, = folder.glob("cusp-engine-*.tgz")
            call("npm", "install", "--no-audit", "--no-fund", "--prefix", user, tarball, folder=user)
            for file in (HERE / "engine.test.mjs", HERE / "engine_job.mjs", SOURCES / "example.mjs"):
                shutil.copy(file, user)
            passed = subprocess.run(["node", "--test", "engine.test.mjs"], cwd=user, check=False).returncode == 0
            return 0 if compare(options, user, folder) and passed else 1
        except subprocess.CalledProcessError as failed:
            print(f"engine_package: {failed}", file=sys.stderr)
            return 1


if __name__ == "__main__":
    sys.exit(main())
