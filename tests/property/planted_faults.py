#!/usr/bin/env python3
"""Plants faults in the host tools, one at a time, and says whether the named test finds each.

usage: planted_faults.py BUILD [-k PATTERN] [--control]      (BUILD: a finished build of the preset dev)

One source is compiled again with a changed line and linked into its test in place of the sound object; the test,
with ctest's arguments, has to fail. --control plants nothing: then each test has to pass.
Exit status: 0 each is found (control: each passes), 1 one is not, 2 something could not be built.
"""
import argparse
import concurrent.futures
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIMEOUT_S = 600  # a test that does not end has found the fault

# Each fault: its file, its text, the faulty text in its place, the test of ctest that has to fail.
FAULTS = {
    "windings without their sense": (
        "host_tools/geometry/offset/winding_border.cpp", "backwards ? -1 : 1;", "1;", "overlay_property_test"),
    "edges that lie on each other count once": (
        "host_tools/geometry/offset/winding_border.cpp", "side.step = sum(side.step, all[i].step, 1);", "",
        "overlay_property_test"),
    "a ball drops onto level edges alone": (
        "host_tools/geometry/drop_cutter/edge_contact.cpp", "std::sqrt(1.0 + slope * slope);", "1.0;", "drop_cutter_test"),
    "a flat end meets one end of an edge": (
        "host_tools/geometry/drop_cutter/edge_contact.cpp",
        "if (c == 0.0) {\n        return higher(contact_at(low), contact_at(high));",
        "if (c == 0.0) {\n        return contact_at(low);", "drop_cutter_test"),
    "pecks that come back into the metal": (
        "host_tools/geometry/toolpath/peck_moves.cpp", "z + kPeckClearance, hole.above)", "z - kPeckClearance, hole.above)",
        "prismatic_test"),
    "arcs' centres a step off": (
        "host_tools/geometry/toolpath/rounded_arc.cpp", "best = candidate;", "best = {candidate[0] + 3, candidate[1]};",
        "toolpath_test"),
    "chords where tangents belong": (
        "host_tools/cam/prismatic/contour_run.cpp", "(arc.turn > 0) != form.waste_on_left", "(arc.turn > 0) == form.waste_on_left",
        "prismatic_property_test"),
    "a scallop a fifth higher passes": (
        "host_tools/cam/finishing/scallop_at_point.cpp", ": point + normal * scallop;", ": point + normal * (1.2 * scallop);",
        "finishing_test"),
    "rapids are not proved": (
        "host_tools/cam/plan/prove_rapids.cpp", "by_path[rapid.path].push_back(rapid);", "", "random_orders"),
    "any plunge through standing stock is taken": (
        "host_tools/cam/plan/prove_rapids.cpp", "if (deepest->end_depth <= most) {", "if (true) {", "bad_operations"),
    "chamfers below standing stock are not proved": (
        "host_tools/cam/plan/prove_edges.cpp", "if (deepest != met.end() && deepest->path == k) {", "if (false) {", "random_orders"),
    "rapid moves on a slope are looked at at their end": (
        "host_tools/judge/verify/deep_rapids.cpp", "CutStock::way_of(runs[r].tool, piece.from, piece.to),",
        "CutStock::way_of(runs[r].tool, piece.from.z == piece.to.z ? piece.from : piece.to, piece.to),", "planted_rapids"),
    "a ramp cuts nothing between its ends": (
        "host_tools/judge/verify/tool_way.cpp", "return from_.z < to_.z ? passed.begin : passed.end;",
        "return from_.z < to_.z ? passed.end : passed.begin;", "planted_rapids"),
    "stock over a rapid move is as high as the highest cut that it touches": (
        "host_tools/judge/verify/cut_stock.cpp", "search.wider + corner, job_.stock_top)) {", "search.wider + corner, low)) {",
        "planted_rapids"),
    "walls thinner than a quarter of a millimetre are slivers": (
        "host_tools/judge/verify/cut_stock.cpp", "kWider = CutStock::kSliver / 2;", "kWider = 0.125;", "verify_test"),
    "squares end at a tenth of a millimetre": (
        "host_tools/judge/verify/cut_stock.cpp", "kLeastHalf = 0.001;", "kLeastHalf = 0.05;", "verify_test"),
    "a sinking ball cuts no farther back than a level one": (
        "host_tools/judge/verify/ahead.hpp", "2 * tool.radius * sunk", "0 * sunk", "verify_test"),
    "a sweep ends before its tool": (
        "host_tools/cam/rest_machining/tool_sweep.cpp", "radius{std::max(0.0, tool.radius - shrink)}",
        "radius{std::max(0.0, 0.9 * tool.radius - shrink)}", "rest_machining_test"),
    "verify forgives a hundred tolerances beside walls": (
        "host_tools/judge/verify/wall_gouge.cpp", "if (beyond <= limits_.plan_tolerance) {",
        "if (beyond <= 100 * limits_.plan_tolerance) {", "wall_verdicts"),
    "a finish excuses any cut beside its ground": (
        "host_tools/judge/verify/wall_gouge.cpp", "if (own_[n].empty() || own_[n][k] != 0) {", "if (true) {", "mixed_job"),
    "a tool that finishes anywhere is not judged at walls": (
        "host_tools/judge/verify/judge_surfaces.cpp", "&& !is_finished(k)", "&& !is_finished(k) && open.empty()", "mixed_job"),
    "verify looks at chamfers on the wall": (
        "host_tools/judge/verify/wall_stock.cpp", "? operation_.prismatic->width : 0.0;", "? 0.0 : 0.0;", "verdicts"),
    "a facing move breaks the edges at its height": (
        "host_tools/judge/verify/wall_stock.cpp", "? (z + judged_height(operation_, 0)) / 2", "? kUnbounded", "verdicts"),
    "holes in holes have walls": (
        "host_tools/judge/verify/wall_stock.cpp", "region_.around(place - kSpare * left).inside >= 0) {", "false) {", "bores"),
    "verify sees gouges in sound walls": (
        "host_tools/judge/verify/wall_gouge.cpp", "- here.inside;\n    }\n\n    void look_around",
        "- here.inside + 0.1;\n    }\n\n    void look_around", "wall_verdicts"),
    "verify counts no engagement": (
        "host_tools/judge/verify/engagement.cpp", "*figures.over_length += way;", "", "verify_test"),
    "the fit finds no arc off": (
        "host_tools/controller/program_fit/fit_check.cpp", "return norm(p - on_arc);", "return 0;", "fit_test"),
    "a centimetre is a millimetre": (
        "host_tools/job/import/dxf_units.cpp", '{"centimetres", 10}', '{"centimetres", 1}', "import_test"),
    "outer borders are taken for holes": (
        "host_tools/job/import/mesh_holes.cpp", "return votes > 0;", "return votes < 0;", "import_test"),
    "a line is resent from the next one on": (
        "host_tools/controller/stream/checked_window.cpp", "finish_before(*number);", "finish_before(*number + 1);",
        "stream_test"),
}


def commands_of(build, target):
    text = subprocess.run(["ninja", "-C", build, "-t", "commands", target], capture_output=True, text=True, check=True)
    return text.stdout.strip().splitlines()[-1]


class Planter:
    def __init__(self, build):
        self.build = pathlib.Path(build).resolve()
        self.compile = {pathlib.Path(one["file"]).resolve(): one["command"]
                        for one in json.loads((self.build / "compile_commands.json").read_text())}
        shown = subprocess.run(["ctest", "--show-only=json-v1"], cwd=self.build, capture_output=True, text=True, check=True)
        self.tests = {one["name"]: one for one in json.loads(shown.stdout)["tests"]}

    def run(self, name, control):
        """True: the test failed."""
        source, text, faulty, test = FAULTS[name]
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            sound = (ROOT / source).read_text()
            if sound.count(text) != 1:
                raise ValueError(f"{name}: {source} has {sound.count(text)} places of that text")
            planted = folder / pathlib.Path(source).name
            planted.write_text(sound if control else sound.replace(text, faulty))
            self.compiled(ROOT / source, planted, folder / "planted.o")
            command = self.tests[test]["command"]
            program = next(part for part in command if self.build in pathlib.Path(part).parents)
            linked = self.linked(program, folder)
            command = [str(linked) if part == program else part for part in command]
            values = {p["name"]: p["value"] for p in self.tests[test].get("properties", [])}
            environment = values.get("ENVIRONMENT", [])
            try:
                done = subprocess.run(["env", *environment, *command], cwd=values.get("WORKING_DIRECTORY", self.build),
                                      capture_output=True, timeout=TIMEOUT_S, check=False)
            except subprocess.TimeoutExpired:
                return True
            return done.returncode != 0

    def compiled(self, source, planted, out):
        words = shlex.split(self.compile[source.resolve()])
        words[words.index("-o") + 1] = str(out)
        words = [str(planted) if pathlib.Path(self.build, word).resolve() == source.resolve() else word for word in words]
        subprocess.run([*words, "-w"], cwd=self.build, check=True, capture_output=True)

    def linked(self, program, folder):
        """The program with the planted object before its libraries: the sound one is not taken from them."""
        target = pathlib.Path(program).resolve().relative_to(self.build)
        line = commands_of(self.build, str(target)).replace(": && ", "", 1).removesuffix(" && :")
        words = shlex.split(line.split(" && ")[0])
        (folder / "bin").mkdir()
        (folder / "lib").symlink_to(self.build / "lib")
        for data in ("materials", "posts", "tool_libraries"):
            (folder / data).symlink_to(ROOT / data)
        place = words.index("-o") + 1
        words[place] = str(folder / "bin" / pathlib.Path(program).name)
        subprocess.run([words[0], str(folder / "planted.o"), *words[1:]], cwd=self.build, check=True, capture_output=True)
        return words[place]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("build")
    options.add_argument("-k", metavar="PATTERN", default="", help="faults or tests with this text alone")
    options.add_argument("--control", action="store_true", help="plant nothing")
    options.add_argument("-j", type=int, default=2)
    given = options.parse_args()
    planter = Planter(given.build)
    wrong = 0
    chosen = [name for name, fault in FAULTS.items() if given.k in name or given.k in fault[3]]
    with concurrent.futures.ThreadPoolExecutor(given.j) as pool:
        for name, failed in zip(chosen, pool.map(lambda name: planter.run(name, given.control), chosen)):
            good = failed != given.control
            wrong += 0 if good else 1
            verdict = ("fails" if failed else "passes") if given.control else ("found" if failed else "NOT FOUND")
            print(f"{name:48} {FAULTS[name][3]:28} {verdict}", flush=True)
    print(f"{len(chosen) - wrong} of {len(chosen)} as they should be")
    return 1 if wrong else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (subprocess.CalledProcessError, ValueError, KeyError) as fault:
        print(f"planted_faults: {fault}: {getattr(fault, 'stderr', b'')!r}"[:4000], file=sys.stderr)
        sys.exit(2)
