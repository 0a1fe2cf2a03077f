"""StockWalk: a height map of points, cut by what a program's feed moves pass, looked at by its rapid moves.

It reads what cusp plan writes for linuxcnc in millimetres: G0 to G3 in the plane, G81, G83, G80, G90, and the comments
that describe tools. Slow, small, and of nothing that cusp is made of.
"""
import math
import re

PITCH = 0.5  # mm between points
STEP = 0.25  # mm between positions
SLACK = 0.1  # mm: a rapid is looked at by a tool that is smaller by this
WORD = re.compile(r"([A-Z])([-+]?[\d.]+)")


class Tool:
    def __init__(self, comment):
        number = re.compile(r"(diameter|tip angle|corner radius) ([\d.]+)")
        self.words = {key: float(value) for key, value in number.findall(comment)}
        self.radius = self.words["diameter"] / 2
        self.ball = " ball " in comment
        self.rise = 1 / math.tan(math.radians(self.words["tip angle"] / 2)) if "tip angle" in self.words else 0.0

    def height(self, away):
        """Of the lower side over the tip, at a distance from the axis; None outside."""
        if away > self.radius:
            return None
        if self.ball:
            return self.radius - math.sqrt(self.radius ** 2 - away ** 2)
        return self.rise * away


class StockWalk:
    def __init__(self, x, y, top, bottom):
        self.x0, self.y0, self.top, self.bottom = x[0] + PITCH / 2, y[0] + PITCH / 2, top, bottom
        self.nx, self.ny = round((x[1] - x[0]) / PITCH), round((y[1] - y[0]) / PITCH)
        self.heights = [[top] * self.ny for _ in range(self.nx)]
        self.shapes = {}

    def turned_over(self):
        """The stock after a turn about a line along x: open where it was cut through, else whole."""
        for column in self.heights:
            column[:] = [-math.inf if z <= self.bottom else self.top for z in reversed(column)]

    def points(self, tool, x, y):
        for i in range(max(0, math.ceil((x - tool.radius - self.x0) / PITCH)),
                       min(self.nx, math.floor((x + tool.radius - self.x0) / PITCH) + 1)):
            dx = self.x0 + i * PITCH - x
            column, half = self.heights[i], math.sqrt(max(0.0, tool.radius ** 2 - dx * dx))
            for j in range(max(0, math.ceil((y - half - self.y0) / PITCH)),
                           min(self.ny, math.floor((y + half - self.y0) / PITCH) + 1)):
                yield column, j, math.hypot(dx, self.y0 + j * PITCH - y)

    def cut(self, tool, at):
        if at[2] < self.top:
            for column, j, away in self.points(tool, at[0], at[1]):
                z = at[2] + (tool.height(min(away, tool.radius)))
                if z < column[j]:
                    column[j] = z

    def depth(self, tool, at):
        """How deep a tool, smaller by SLACK, is in the stock."""
        if at[2] + SLACK >= self.top:
            return 0.0
        return max((column[j] - at[2] - SLACK - tool.height(away) for column, j, away in self.points(tool, at[0], at[1])
                    if away <= tool.radius - SLACK), default=0.0)


def positions(start, end, arc=None, apart=STEP):
    """Points from start to end, the end included, at most `apart`; arc: centre and whether clockwise."""
    if arc:
        (cx, cy), clockwise = arc
        begin, stop = (math.atan2(p[1] - cy, p[0] - cx) for p in (start, end))
        sweep = (begin - stop if clockwise else stop - begin) % (2 * math.pi)
        sweep = sweep if sweep > 1e-9 else 2 * math.pi
        radius = math.hypot(start[0] - cx, start[1] - cy)
        count = max(1, math.ceil(radius * sweep / apart))
        for k in range(1, count + 1):
            angle = begin + (-sweep if clockwise else sweep) * k / count
            yield (cx + radius * math.cos(angle), cy + radius * math.sin(angle),
                   start[2] + (end[2] - start[2]) * k / count)
        return
    count = max(1, math.ceil(math.dist(start, end) / apart))
    for k in range(1, count + 1):
        yield tuple(a + (b - a) * k / count for a, b in zip(start, end))


def moves(program):
    """(line, tool, rapid, start, end, arc) of each move."""
    at, mode, tool, tools, high, cycle = (0.0, 0.0, 1e3), 0, None, {}, 0.0, {}
    for number, line in enumerate(program.splitlines(), 1):
        described = re.match(r"\(tool (\d+) (.*)\)", line)
        if described:
            tools[int(described.group(1))] = Tool(" " + described.group(2) + " ")
        words = WORD.findall(re.sub(r"\(.*?\)", "", line))
        values = {a: float(b) for a, b in words if a != "G"}
        tool = tools[int(values["T"])] if "T" in values else tool
        for letter, code in words:
            if letter == "G" and float(code) in (0, 1, 2, 3, 80, 81, 83):
                mode = int(code)
                high, cycle = at[2], {}
        if not set(values) & set("XYZ"):
            continue
        end = tuple(values.get(a, b) for a, b in zip("XYZ", at))
        if mode in (81, 83):
            cycle.update(values)
            over, begin, bottom = (end[0], end[1], high), (end[0], end[1], cycle["R"]), (end[0], end[1], cycle["Z"])
            for rapid, a, b in ((True, at, over), (True, over, begin), (False, begin, bottom), (True, bottom, over)):
                yield number, tool, rapid, a, b, None
            at = over
            continue
        arc = ((at[0] + values.get("I", 0), at[1] + values.get("J", 0)), mode == 2) if mode in (2, 3) else None
        yield number, tool, mode == 0, at, end, arc
        at = end


def rapid_in_stock(stock, program):
    """Cuts the stock; what the first rapid move through it is, "" if there is none."""
    for number, tool, rapid, start, end, arc in moves(program):
        for at in positions(start, end, arc):
            if not rapid:
                stock.cut(tool, at)
            elif tool and stock.depth(tool, at) > 0.1:
                return (f"line {number}: a rapid {stock.depth(tool, at):.2f} mm deep in stock at "
                        f"{', '.join(f'{c:.3f}' for c in at)}")
    return ""
