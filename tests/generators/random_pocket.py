"""A random pocket as files of cusp: boundary, islands, floor, job. The same seed, the same pocket."""
import json
import math
import random

FLOORS = ("flat", "slope", "wavy", "steep", "valley", "slots", "dome", "rational", "crossing planes")


class RandomPocket:
    """Lengths in mm; the files may be in inches."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.inch = self.random.random() < 0.3
        self.unit = 25.4 if self.inch else 1.0
        self.size = self.random.uniform(30, 55)
        self.floor_kind = self.random.choice(FLOORS)
        self.radius = self.random.uniform(0.04, 0.09) * self.size
        self.scallop = 0.0

    def write(self, folder):
        """Writes the job and its parts; the job's path."""
        self.folder = folder
        islands = self.random.choice([0, 1, 1, 2, 3])
        self.write_loop("boundary", self.boundary())
        for k in range(islands):
            self.write_loop(f"island{k}", self.island(k, islands))
        surfaces = self.floor()
        self.write_shape("floor", "surface", surfaces)
        highest = max(p[2] for s in surfaces for p in s["control_points"]["points"])
        job = folder / "job.toml"
        job.write_text(self.job(islands, max(0.0, highest * self.unit) + 0.01))
        return job

    # Curves

    def curve(self, degree, points, weights=None, knots=None):
        inner = len(points) - degree
        if knots is None:
            knots = [0.0] * (degree + 1) + [i / inner for i in range(1, inner)] + [1.0] * (degree + 1)
        control = {"points": [[x / self.unit, y / self.unit] for x, y in points]}
        if weights:
            control["weights"] = weights
        return {"dimension": 2, "rational": weights is not None, "degree": degree,
                "knotvector": knots, "control_points": control}

    def edge(self, a, b):
        """A line, a cubic, a rational curve of degree 2 to 4 or an arc."""
        pick = self.random
        dx, dy = b[0] - a[0], b[1] - a[1]

        def beside(share, out):
            return (a[0] + dx * share + out * dy, a[1] + dy * share - out * dx)

        kind = pick.random()
        if kind < 0.4:
            return self.curve(1, [a, b])
        if kind < 0.65:
            bulges = pick.uniform(-0.15, 0.25), pick.uniform(-0.15, 0.25)
            return self.curve(3, [a, beside(1 / 3, bulges[0]), beside(2 / 3, bulges[1]), b])
        if kind < 0.75:
            middle = [beside(k / 5, pick.uniform(-0.1, 0.15)) for k in range(1, 5)]
            return self.curve(pick.choice([2, 3, 4]), [a, *middle, b],
                              [pick.uniform(0.7, 1.5) for _ in range(6)])
        half = pick.uniform(0.1, 0.5)
        side = pick.choice([1, 1, -1])
        return self.curve(2, [a, beside(0.5, side * math.tan(half) / 2), b], [1, math.cos(half), 1])

    def star(self, centre, radius, corners):
        points = []
        for i in range(corners):
            angle = 2 * math.pi * (i + self.random.uniform(0.1, 0.9)) / corners
            out = radius * self.random.uniform(0.6, 1)
            points.append((centre[0] + out * math.cos(angle), centre[1] + out * math.sin(angle)))
        return [self.edge(points[i], points[(i + 1) % corners]) for i in range(corners)]

    def circle(self, centre, radius):
        corner = math.sqrt(0.5)
        square = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
        points = [(centre[0] + radius * x, centre[1] + radius * y) for x, y in square]
        return [self.curve(2, points, [1, corner, 1, corner, 1, corner, 1, corner, 1],
                           [0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1])]

    def boundary(self):
        middle = (self.size / 2, self.size / 2)
        if self.random.random() < 0.15:
            return self.circle(middle, 0.45 * self.size)
        return self.star(middle, 0.48 * self.size, self.random.randint(4, 9))

    def island(self, k, of):
        angle = 2 * math.pi * (k + self.random.random() * 0.3) / of
        out = self.random.uniform(0.1, 0.18) * self.size
        centre = (self.size / 2 + out * math.cos(angle), self.size / 2 + out * math.sin(angle))
        radius = self.random.uniform(0.04, 0.07) * self.size
        if self.random.random() < 0.3:
            return self.circle(centre, radius)
        return self.star(centre, radius, self.random.randint(3, 6))

    # Floors

    def surface(self, count, degree, height, weighted=False):
        """A net of count[0] x count[1] points, evenly over the pocket and 15 % around it."""
        low, high = -0.15 * self.size, 1.15 * self.size

        def knots(n, d):
            return [0.0] * (d + 1) + [i / (n - d) for i in range(1, n - d)] + [1.0] * (d + 1)

        points = []
        for i in range(count[0]):
            for j in range(count[1]):
                u, v = i / (count[0] - 1), j / (count[1] - 1)
                points.append([(low + (high - low) * u) / self.unit,
                               (low + (high - low) * v) / self.unit, height(u, v) / self.unit])
        control = {"points": points}
        if weighted:
            control["weights"] = [self.random.uniform(0.6, 1.6) for _ in points]
        return {"dimension": 3, "rational": weighted, "degree_u": degree[0], "degree_v": degree[1],
                "size_u": count[0], "size_v": count[1], "knotvector_u": knots(count[0], degree[0]),
                "knotvector_v": knots(count[1], degree[1]), "control_points": control}

    def floor(self):
        pick = self.random
        depth = -pick.uniform(6, 14)
        if self.floor_kind == "flat":
            return [self.surface((2, 2), (1, 1), lambda u, v: depth)]
        if self.floor_kind == "slope":
            gx, gy = pick.uniform(-0.4, 0.4) * self.size, pick.uniform(-0.4, 0.4) * self.size
            low = depth - (abs(gx) + abs(gy)) / 2
            return [self.surface((2, 2), (1, 1), lambda u, v: low + gx * u + gy * v)]
        if self.floor_kind == "steep":
            rise, where = pick.uniform(10, 25), pick.uniform(0.5, 0.75)
            return [self.surface((8, 4), (3, 3), lambda u, v: depth - 5 + (rise if u > where else 0)
                                 + pick.uniform(-1, 1))]
        if self.floor_kind == "valley":
            deep = pick.uniform(4, 9)
            return [self.surface((14, 4), (3, 3), lambda u, v: depth
                                 - (deep if abs(u - 0.5) < 0.06 else 0) + pick.uniform(-0.5, 0.5))]
        if self.floor_kind == "slots":
            deep, places = pick.uniform(2, 8), [pick.uniform(0.2, 0.8) for _ in range(3)]
            return [self.surface((24, 5), (3, 3), lambda u, v: depth + pick.uniform(-0.3, 0.3)
                                 - (deep if min(abs(u - at) for at in places) < 0.03 else 0))]
        if self.floor_kind == "dome":
            high, narrow = pick.uniform(3, 12), pick.uniform(9, 18)
            return [self.surface((2, 2), (1, 1), lambda u, v: depth),
                    self.surface((9, 9), (3, 3), lambda u, v: depth - 3 + high
                                 * math.exp(-narrow * ((u - 0.5) ** 2 + (v - 0.4) ** 2)))]
        if self.floor_kind == "crossing planes":
            slope = pick.uniform(0.1, 0.5) * self.size
            return [self.surface((2, 2), (1, 1), lambda u, v: depth - slope / 2 + slope * u),
                    self.surface((2, 2), (1, 1), lambda u, v: depth + slope / 2 - slope * u)]
        n = pick.randint(4, 7)
        rational = self.floor_kind == "rational"
        return [self.surface((n, n), (pick.choice([2, 3]), 3),
                             lambda u, v: depth + pick.uniform(-4, 4), rational)]

    # The job

    def job(self, islands, top):
        pick = self.random
        shape = pick.choice(["ball", "ball", "flat", "bull"])
        tolerance = pick.choice([0.01, 0.02, 0.02, 0.05])
        self.scallop = min(max(pick.choice([0.05, 0.1, 0.2, 0.4]), 2 * tolerance), self.radius / 2)
        layered = pick.random() < 0.35
        rough_tool = layered and pick.random() < 0.5

        def length(mm):
            return f"{mm / self.unit:.7f}"

        lines = [f'units = "{"inch" if self.inch else "mm"}"', "[[tool]]", "number = 1",
                 f'shape = "{shape}"', f"diameter = {length(2 * self.radius)}"]
        if shape == "bull":
            lines.append(f"corner_radius = {length(self.radius * pick.uniform(0.2, 0.6))}")
        if rough_tool:
            lines += ["[[tool]]", "number = 2", f'shape = "{pick.choice(["flat", "ball"])}"',
                      f"diameter = {length(2 * self.radius * pick.uniform(1.1, 1.8))}"]
        names = [f"island{k}.json" for k in range(islands)]
        lines += ["[cutting]", f"feed = {length(1200)}", "[stock]", f"top = {length(top)}",
                  f"clearance = {length(5)}", "[[operation]]", 'strategy = "contour_pocket"',
                  'floor = "floor.json"', 'boundary = "boundary.json"',
                  f"islands = {json.dumps(names)}",
                  f'output = "{pick.choice(["lines", "arcs", "nurbs"])}"',
                  f"plan_tolerance = {length(tolerance)}", f"floor_tolerance = {length(tolerance)}",
                  f"scallop = {length(self.scallop)}",
                  f'direction_of_cut = "{pick.choice(["climb", "conventional"])}"',
                  f'entry = "{pick.choice(["auto", "helix", "ramp", "plunge"])}"']
        if layered:
            lines += [f"max_depth = {length(pick.uniform(2, 5))}",
                      f"allowance = {length(pick.uniform(0.1, 0.5))}"]
        if rough_tool:
            lines += ["tool = 1", "tools = [2, 1]"]
        return "\n".join(lines) + "\n"

    def write_loop(self, name, curves):
        self.write_shape(name, "curve", curves)

    def write_shape(self, name, kind, parts):
        shape = {"shape": {"type": kind, "count": len(parts), "data": parts}}
        (self.folder / f"{name}.json").write_text(json.dumps(shape))
