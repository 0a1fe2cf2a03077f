"""Random blocks with holes, a shelf and chamfered edges: as STEP files, and as the height of each point."""
import math
import random

from step_solid import HoleWall, Level, step_solid

TIP = math.tan(math.radians(31))  # height over radius of a drill's point of 118 degrees


class RoundHole:
    """Radii and heights of its wall from the mouth down; the last radius is 0 at a tip, any other one of a floor."""
    def __init__(self, x, y, profile, kind):
        self.x, self.y, self.profile, self.kind = x, y, profile, kind

    @property
    def through(self):
        return self.profile[-1][1] == 0

    @property
    def radius(self):
        """Of its narrowest cylinder."""
        return min(a for (a, _), (b, _) in zip(self.profile, self.profile[1:]) if a == b)

    def height(self, away):
        """z of its wall or floor at a distance from the axis; None outside."""
        if away >= self.profile[0][0]:
            return None
        for (a, p), (b, q) in zip(self.profile, self.profile[1:]):
            if b <= away < a:
                return q if p == q else p + (q - p) * (a - away) / (a - b)
        return self.profile[-1][1]

    def faces(self):
        walls = zip(self.profile, self.profile[1:])
        faces = [HoleWall(self.x, self.y, q, b, p, a) if p != q else
                 Level([], [(self.x, self.y, a), (self.x, self.y, b)], p, True) for (a, p), (b, q) in walls]
        radius, z = self.profile[-1]
        if radius > 0 and not self.through:
            faces.append(Level([], [(self.x, self.y, radius)], z, True))
        return faces


class FeaturedBlock:
    """40 x 28 mm, its top at z = 0 or 12; beyond `edge` a shelf. `chamfer` is that of all edges of its top."""
    def __init__(self, seed, diameters, chamfered=False):
        r = random.Random(seed)
        self.wide, self.deep, self.high = 40.0, 28.0, 12.0
        self.edge = r.choice((None, 27.0))
        self.shelf = r.choice((7.0, 5.5))
        self.chamfer = r.choice((0.5, 1.0, 1.5)) if chamfered else 0.0
        kinds = ["plain", "blind", "tipped", "counterbored", "countersunk", "plain"]
        r.shuffle(kinds)
        self.holes = [self.hole(r, kind, place, r.choice(diameters))
                      for kind, place in zip(kinds, ((7, 7.5), (7, 20.5), (20, 7.5), (20, 20.5), (33.5, 7), (33.5, 20.5)))]

    def ground(self, x):
        return self.shelf if self.edge is not None and x > self.edge else self.high

    def hole(self, r, kind, place, diameter):
        x, y = place[0] + r.uniform(-0.4, 0.4), place[1] + r.uniform(-0.4, 0.4)
        top, radius = self.ground(x), diameter / 2
        end = r.choice((0.0, 1.0, 2.0))
        wide, deep = radius + r.choice((1.0, 1.6)), r.choice((1.5, 2.5))
        profile = {"plain": [(radius, top), (radius, 0.0)],
                   "blind": [(radius, top), (radius, max(1.0, end))],
                   "tipped": [(radius, top), (radius, 1.0 + radius * TIP), (0.0, 1.0)],
                   "counterbored": [(wide, top), (wide, top - deep), (radius, top - deep), (radius, end)],
                   "countersunk": [(wide, top), (radius, top - wide + radius), (radius, end)]}[kind]
        return RoundHole(x, y, profile, kind)

    def height(self, x, y):
        """z of the part's surface; of nothing -infinity."""
        for hole in self.holes:
            z = hole.height(math.hypot(x - hole.x, y - hole.y))
            if z is not None:
                return -math.inf if z == 0 else z
        ground = self.ground(x)
        right = self.edge if self.edge is not None else self.wide
        if x < right:
            ground = self.high - max(0.0, self.chamfer - min(x, right - x, y, self.deep - y))
        return ground

    def step(self):
        wide, deep, high, c = self.wide, self.deep, self.high, self.chamfer
        right = self.edge if self.edge is not None else wide
        low = high - c

        def ring(inset, z):
            return [(inset, inset, z), (right - inset, inset, z), (right - inset, deep - inset, z), (inset, deep - inset, z)]

        def circles(z, x0, x1, last=0):
            return [(h.x, h.y, h.profile[last][0]) for h in self.holes if x0 < h.x < x1 and h.profile[last][1] == z]
        faces = [Level([p[:2] for p in ring(c, high)], circles(high, 0, right), high, True)]
        if c > 0:
            for (a, b), (d, e) in zip(zip(ring(c, high), ring(0.0, low)), zip(*[r[1:] + r[:1] for r in (ring(c, high), ring(0.0, low))])):
                faces.append([b, e, d, a])
        if self.edge is None:
            sides = [(wide, 0.0), (wide, deep)]
            faces.append([(wide, 0.0, 0.0), (wide, deep, 0.0), (wide, deep, low), (wide, 0.0, low)])
            faces.append([(0.0, 0.0, 0.0), (wide, 0.0, 0.0), (wide, 0.0, low), (0.0, 0.0, low)])
            faces.append([(wide, deep, 0.0), (0.0, deep, 0.0), (0.0, deep, low), (wide, deep, low)])
        else:
            z = self.shelf
            sides = [(wide, 0.0), (wide, deep)]
            faces.append(Level([(right, 0.0), (wide, 0.0), (wide, deep), (right, deep)], circles(z, right, wide), z, True))
            faces.append([(right, 0.0, z), (right, deep, z), (right, deep, low), (right, 0.0, low)])
            faces.append([(wide, 0.0, 0.0), (wide, deep, 0.0), (wide, deep, z), (wide, 0.0, z)])
            faces.append([(0.0, 0.0, 0.0), (wide, 0.0, 0.0), (wide, 0.0, z), (right, 0.0, z), (right, 0.0, low), (0.0, 0.0, low)])
            faces.append([(wide, deep, 0.0), (0.0, deep, 0.0), (0.0, deep, low), (right, deep, low), (right, deep, z), (wide, deep, z)])
        faces.append([(0.0, deep, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, low), (0.0, deep, low)])
        faces.append(Level([(0.0, 0.0), sides[0], sides[1], (0.0, deep)], circles(0.0, 0, wide, -1), 0.0, False))
        return step_solid(faces + [face for hole in self.holes for face in hole.faces()])
