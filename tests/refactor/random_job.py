"""Small random jobs of every strategy, tool, side and output. The same seed, the same files.

Seed modulo six chooses the strategy, so that a run of seeds has all of them in equal shares. Jobs are small: most plan
in a second. A job may be one that `cusp plan` refuses; its message is compared then.
"""
import json
import math
import pathlib
import random
import struct
import sys

sys.dont_write_bytecode = True
TESTS = pathlib.Path(__file__).resolve().parent.parent
sys.path += [str(TESTS / "generators"), str(TESTS / "property" / "adaptive_isocurve")]
import model_jobs
import random_models
from random_pocket import FLOORS, RandomPocket

STRATEGIES = ("contour_pocket", "adaptive_isocurve", "grid_pocket", "hull_rough", "complete_isocurves",
              "parallel_planes")
SECTIONS = ("parallel_planes", "waterline", "steep_shallow")  # take turns
SPARSE_FLOORS = ("flat", "slope", "wavy", "dome", "rational", "crossing planes")  # not cut in many stretches


class RandomJob:
    """Lengths in mm; the job's file may be in inches."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.strategy = STRATEGIES[seed % len(STRATEGIES)]
        if self.strategy in SECTIONS:
            self.strategy = SECTIONS[seed // len(STRATEGIES) % len(SECTIONS)]
        self.inch = self.random.random() < 0.3
        self.unit = 25.4 if self.inch else 1.0
        self.tolerance = self.random.choice([0.01, 0.02, 0.05])
        self.keys = {}
        self.floor = "floor.json"

    def write(self, folder):
        """Writes the job and its parts; the job's name."""
        pocket = self.strategy in ("contour_pocket", "grid_pocket")
        highest = self.write_pocket(folder) if pocket else self.write_model(folder)
        if self.strategy == "hull_rough":
            self.add_hull_keys()
        elif not pocket:
            self.add_isocurve_keys()
        (folder / "job.toml").write_text(self.text(highest))
        return "job.toml"

    def chance(self, share):
        return self.random.random() < share

    def length(self, mm):
        return round(mm / self.unit, 7)

    # Parts

    def write_pocket(self, folder):
        pocket = RandomPocket(self.random.randrange(1 << 30))
        pocket.inch, pocket.unit, pocket.folder = self.inch, self.unit, folder
        pocket.size = self.random.uniform(18, 32)
        pocket.floor_kind = self.random.choice(FLOORS if self.chance(0.3) else SPARSE_FLOORS)
        islands = self.random.choice([0, 0, 1, 1, 2])
        pocket.write_loop("boundary", pocket.boundary())
        for k in range(islands):
            pocket.write_loop(f"island{k}", pocket.island(k, islands))
        surfaces = pocket.floor()
        pocket.write_shape("floor", "surface", surfaces)
        self.keys.update(boundary="boundary.json", islands=[f"island{k}.json" for k in range(islands)])
        self.radius = pocket.size * self.random.uniform(0.05, 0.1)
        self.add_pocket_keys()
        return self.unit * model_jobs.highest(surfaces)

    def write_model(self, folder):
        self.radius = self.random.choice([1.5, 2.0, 3.0])
        if self.chance(0.2):
            return self.write_mesh(folder)
        surfaces = self.random.choice(random_models.KINDS)(self.random)
        for s in surfaces:
            s["control_points"]["points"] = [[x / self.unit for x in p] for p in s["control_points"]["points"]]
        shape = {"type": "surface", "count": len(surfaces), "data": surfaces}
        (folder / "floor.json").write_text(json.dumps({"shape": shape}))
        return self.unit * model_jobs.highest(surfaces)

    def write_mesh(self, folder):
        """Waves or steps as triangles, now and then bent into an overhang."""
        pick = self.random
        n, side, steps = pick.randint(4, 9), pick.uniform(10, 15), self.chance(0.3)
        high, phase, lean = pick.uniform(1, 4), pick.uniform(0, 6), pick.choice([0, 0, 0.4])

        def point(i, j):
            wave = math.sin(phase + 5 * i / n) * math.cos(phase + 4 * j / n)
            z = -high - 1 + high * (math.copysign(1, wave) if steps else wave)
            return [c / self.unit for c in (side * i / n + lean * z * (i in range(1, n)), side * j / n, z)]

        triangles = []
        for i in range(n):
            for j in range(n):
                a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
                triangles += [(a, b, c), (a, c, d)]
        data = b"".join(struct.pack("<12fH", 0, 0, 1, *a, *b, *c, 0) for a, b, c in triangles)
        self.floor = "floor.stl"
        (folder / self.floor).write_bytes(b"\0" * 80 + struct.pack("<I", len(triangles)) + data)
        return 0.0

    # Keys of the operation

    def add_layers(self, least, most):
        if self.chance(0.3):
            first = self.random.uniform(least, most)
            self.keys["layers"] = [self.length(first), self.length(first + self.random.uniform(least, most))]
        else:
            self.keys["max_depth"] = self.length(self.random.uniform(least, most))
            if self.chance(0.3):
                self.keys["min_depth"] = self.length(0.3 * least)
        self.keys["allowance"] = self.length(self.random.choice([0, 0.1, 0.3]))

    def add_pocket_keys(self):
        pick = self.random
        self.keys.update(plan_tolerance=self.length(self.tolerance),
                         direction_of_cut=pick.choice(["climb", "conventional"]),
                         entry=pick.choice(["auto", "helix", "ramp", "plunge"]))
        if self.chance(0.4):
            self.add_layers(2, 5)
        if self.strategy == "contour_pocket":
            self.keys["scallop"] = self.length(min(max(pick.choice([0.1, 0.2, 0.4]), 2 * self.tolerance),
                                                   self.radius / 2))
            if ("max_depth" in self.keys or "layers" in self.keys) and self.chance(0.4):
                self.keys["tools"] = [2, 1]
            return
        coarsest = 2 * self.radius / math.sqrt(2)
        self.keys["grid"] = [self.length(coarsest * pick.uniform(0.3, 1)) for _ in range(2)]
        self.keys["zigzag"] = pick.choice([[], ["x"], ["y"], ["x", "y"]])
        if self.chance(0.3):
            self.keys["arc_tolerance"] = self.length(2 * self.tolerance)
        if self.chance(0.2):
            self.keys["max_roughness"] = self.length(self.radius * pick.uniform(0.2, 1))

    def add_hull_keys(self):
        pick = self.random
        self.keys.update(max_depth=self.length(pick.uniform(1, 4)), allowance=self.length(pick.choice([0, 0.3])),
                         overlap=self.length(pick.choice([0, 0.1 * self.radius])),
                         extra_subdivision=pick.choice([0, 0, 1, 2]), clearing=pick.choice(["zigzag", "contour"]))
        if self.chance(0.4):
            self.keys["tools"] = [2, 1]
        if self.chance(0.3):
            self.keys["min_depth"] = self.length(0.5)

    def add_isocurve_keys(self):
        pick = self.random
        self.keys["traversal"] = pick.choice(["zigzag", "zigzag", "one_way"])
        if self.strategy != "waterline":
            self.keys["direction"] = pick.choice("uv")
        if self.strategy in ("waterline", "steep_shallow"):
            key = "scallop"
            self.keys["spiral"] = self.chance(0.5)
        elif self.strategy == "parallel_planes":
            key = pick.choice(["scallop", "step_over"])
        else:
            key = pick.choice(["scallop", "scallop", "iso_distance"])
            if key == "iso_distance":
                self.keys["iso_spacing"] = pick.choice(["halving", "even"])
        far = pick.choice([0.06, 0.1, 0.2]) if key == "scallop" else self.radius * pick.uniform(0.2, 0.6)
        self.keys[key] = self.length(far)
        if self.chance(0.3) and self.strategy not in ("parallel_planes", "waterline", "steep_shallow"):
            self.keys["roughing"] = True
            self.keys["max_depth"] = self.length(pick.uniform(1.5, 4))
            self.keys["allowance"] = self.length(pick.choice([0.1, 0.3]))
            if self.strategy in STRATEGIES[1:5] and self.chance(0.5):
                self.keys["tools"] = [2]

    # The job

    def tool(self, number, shape, radius):
        lines = ["[[tool]]", f"number = {number}", f'shape = "{shape}"', f"diameter = {self.length(2 * radius)}"]
        if shape == "bull":
            lines.append(f"corner_radius = {self.length(radius * self.random.uniform(0.2, 0.6))}")
        return lines

    def output(self):
        # hull_rough refuses "nurbs"
        few = self.strategy == "hull_rough" and not self.chance(0.1)
        return self.random.choice(["lines", "arcs"] if few else ["lines", "arcs", "nurbs"])

    def text(self, highest):
        pick = self.random
        # isocurves and planes finish with a ball; a few ask for what is refused
        ball = 0.95 if self.strategy in STRATEGIES[1::3] + SECTIONS else 0.4
        shape = "ball" if self.chance(ball) else pick.choice(["flat", "bull"])
        lines = [f'units = "{"inch" if self.inch else "mm"}"', *self.tool(1, shape, self.radius)]
        if 2 in self.keys.get("tools", []):
            lines += self.tool(2, pick.choice(["flat", "ball", "bull"]), self.radius * pick.uniform(1.1, 1.8))
        lines += ["[cutting]", f"feed = {self.length(6000)}", "[stock]", f"top = {self.length(max(highest, 0) + 0.5)}",
                  "[[operation]]", f'strategy = "{self.strategy}"', f'floor = ["{self.floor}"]', "tool = 1",
                  f'output = "{self.output()}"',
                  f"floor_tolerance = {self.length(self.tolerance)}",
                  f'tolerance_side = "{pick.choice(["outside", "outside", "both"])}"']
        lines += [f"{key} = {json.dumps(value)}" for key, value in self.keys.items()]
        return "\n".join(lines) + "\n"
