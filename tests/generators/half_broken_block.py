"""Random blocks with a lower step beside them: some upper edges of both are broken, others not, and no edge goes all around."""
import random

from step_solid import step_solid


class HalfBrokenBlock:
    """40 x 28 mm: 12 high up to x = 27, then a step. `upper` and `lower` are the sides whose upper edges are broken."""
    WIDE, DEEP, HIGH, STEP_AT = 40.0, 28.0, 12.0, 27.0

    def __init__(self, seed):
        r = random.Random(seed)
        self.step_z = r.choice((8.5, 6.0))
        self.width = r.choice((0.5, 1.0, 1.5))
        self.upper = {side for side in ("front", "step", "back", "left") if r.random() < 0.5}
        self.lower = {side for side in ("front", "right", "back") if r.random() < 0.6}
        if len(self.upper) == 4 or not self.upper | self.lower:
            self.upper = {"front"}

    def sides(self):
        """Of each broken edge: its ends in plan, the way to the material, z of its upper side."""
        w, d, s = self.WIDE, self.DEEP, self.STEP_AT
        upper = {"front": ((0, 0), (s, 0), (0, 1)), "back": ((0, d), (s, d), (0, -1)),
                 "left": ((0, 0), (0, d), (1, 0)), "step": ((s, 0), (s, d), (-1, 0))}
        lower = {"front": ((s, 0), (w, 0), (0, 1)), "back": ((s, d), (w, d), (0, -1)), "right": ((w, 0), (w, d), (-1, 0))}
        return [(*upper[side], self.HIGH) for side in sorted(self.upper)] + \
               [(*lower[side], self.step_z) for side in sorted(self.lower)]

    def height(self, x, y):
        """z of the part's surface; of nothing -infinity."""
        w, d, s = self.WIDE, self.DEEP, self.STEP_AT
        if not (0 <= x <= w and 0 <= y <= d):
            return float("-inf")
        broken, top = (self.upper, self.HIGH) if x <= s else (self.lower, self.step_z)
        away = {"front": y, "back": d - y, "left": x, "step": s - x, "right": w - x}
        return top - max([0.0] + [self.width - away[side] for side in broken])

    def step(self):
        w, d, s, c = self.WIDE, self.DEEP, self.STEP_AT, self.width
        high, low = self.HIGH, self.step_z
        up = {side: c if side in self.upper else 0.0 for side in ("front", "step", "back", "left")}
        down = {side: c if side in self.lower else 0.0 for side in ("front", "right", "back")}
        faces = [[(up["left"], up["front"], high), (s - up["step"], up["front"], high),
                  (s - up["step"], d - up["back"], high), (up["left"], d - up["back"], high)],
                 [(s, down["front"], low), (w - down["right"], down["front"], low),
                  (w - down["right"], d - down["back"], low), (s, d - down["back"], low)],
                 [(0, d, 0), (w, d, 0), (w, 0, 0), (0, 0, 0)]]

        def corner(x, y, z, here, beside, inward):
            """Upper corners at the end of a wall, the last at its end: broken here, or on the side beside it alone."""
            if here or not beside:
                return [(x, y, z - here)]
            return [(x + beside * inward[0], y + beside * inward[1], z), (x, y, z - beside)]
        u, v = up, down
        # walls, their upper corners from one end to the other
        front = [(0, 0, 0), (w, 0, 0)] + corner(w, 0, low, v["front"], v["right"], (-1, 0))[::-1] + \
            [(s, 0, low - v["front"])] + corner(s, 0, high, u["front"], u["step"], (-1, 0))[::-1] + \
            corner(0, 0, high, u["front"], u["left"], (1, 0))
        back = [(w, d, 0), (0, d, 0)] + corner(0, d, high, u["back"], u["left"], (1, 0))[::-1] + \
            corner(s, d, high, u["back"], u["step"], (-1, 0)) + [(s, d, low - v["back"])] + \
            corner(w, d, low, v["back"], v["right"], (-1, 0))
        left = [(0, d, 0), (0, 0, 0)] + corner(0, 0, high, u["left"], u["front"], (0, 1))[::-1] + \
            corner(0, d, high, u["left"], u["back"], (0, -1))
        right = [(w, 0, 0), (w, d, 0)] + corner(w, d, low, v["right"], v["back"], (0, -1))[::-1] + \
            corner(w, 0, low, v["right"], v["front"], (0, 1))
        foot = ([(s, 0, low - c), (s, c, low)] if v["front"] else [(s, 0, low)]) + \
            ([(s, d - c, low), (s, d, low - c)] if v["back"] else [(s, d, low)])
        step = corner(s, d, high, u["step"], u["back"], (0, -1))[::-1] + \
            corner(s, 0, high, u["step"], u["front"], (0, 1)) + foot
        faces += [front, back, left, right, step]
        inset_high = faces[0]
        inset_low = faces[1]
        if u["front"]:
            faces.append([(0, 0, high - c), (s, 0, high - c), inset_high[1], inset_high[0]])
        if u["back"]:
            faces.append([(s, d, high - c), (0, d, high - c), inset_high[3], inset_high[2]])
        if u["left"]:
            faces.append([(0, d, high - c), (0, 0, high - c), inset_high[0], inset_high[3]])
        if u["step"]:
            faces.append([(s, 0, high - c), (s, d, high - c), inset_high[2], inset_high[1]])
        if v["front"]:
            faces.append([(s, 0, low - c), (w, 0, low - c), inset_low[1], inset_low[0]])
        if v["back"]:
            faces.append([(w, d, low - c), (s, d, low - c), inset_low[3], inset_low[2]])
        if v["right"]:
            faces.append([(w, 0, low - c), (w, d, low - c), inset_low[2], inset_low[1]])
        return step_solid(faces)
