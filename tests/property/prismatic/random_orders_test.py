#!/usr/bin/env python3
"""Operations in random orders, at random tops and depths, in one set-up or two, beside fixtures: each job is planned with no
rapid move in stock, by a judge of its own, and `cusp verify` finds that its bounds hold; or it is refused with the operation
and a place. Cuts of two sides that meet are warned of, and broken.

usage: random_orders_test.py CUSP [CASES [FIRST_SEED]]

CUSP_PROPERTY_CASES and CUSP_PROPERTY_FIRST count too. Jobs and programs of cases that fail are kept, and named.
"""
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

for folder in ("judges", "support"):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / folder))
from property_cases import property_cases, property_seed  # noqa: E402
from stock_walk import StockWalk, rapid_in_stock  # noqa: E402

CUSP = pathlib.Path(sys.argv[1]).resolve()
CASES = property_cases(int(sys.argv[2]) if len(sys.argv) > 2 else 6)
FIRST = property_seed(sys.argv[3] if len(sys.argv) > 3 else 4100)
KNOWN = (5013, 5081)  # a drill whose axis stands between two bands of columns; a chamfer below standing stock
X, Y, BOTTOM = (-25, 25), (-18, 18), -8


def polyline(layer, points, closed=1):
    return f"0\nLWPOLYLINE\n8\n{layer}\n90\n{len(points)}\n70\n{closed}\n" + "".join(
        f"10\n{x:.4f}\n20\n{y:.4f}\n" for x, y in points)


def rectangle(layer, x, y, w, h):
    return polyline(layer, [(x, y), (x + w, y), (x + w, y + h), (x, y + h)])


class RandomOrder:
    def __init__(self, seed):
        r = self.random = random.Random(seed)
        self.two = r.random() < 0.25
        kinds = r.choices(("face", "pocket", "pocket", "drill", "drill", "profile", "engrave", "chamfer", "slot"),
                          k=r.randint(2, 5))
        self.operations = [self.operation(kind) for kind in kinds]
        if self.two:
            self.operations.append('setup = "back"\n' + self.operation(r.choice(("pocket", "drill", "face"))))
        self.fixture = r.random() < 0.2
        self.kinds = ", ".join(kinds) + (", two set-ups" if self.two else "") + (", a fixture" if self.fixture else "")

    def operation(self, kind):
        r = self.random
        top = 0.0 if r.random() < 0.4 else -round(r.uniform(0.5, 5), 2)
        depth = round(r.uniform(0.5, min(4.0, -BOTTOM - 0.5 + top)), 2)
        text = f'strategy = "{kind}"\ntop = {top}\n'
        if kind == "face":
            return text + f"depth = {depth}\ntool = {r.choice((1, 2))}\n"
        if kind == "drill":
            return text + f'boundary = "part.dxf#{r.choice(("h", "k"))}"\ndepth = {depth}\ntool = 3\n' + \
                r.choice(("", f"peck = {round(r.uniform(0.5, 2), 2)}\n"))
        if kind == "slot":
            return text + f'boundary = "part.dxf#e"\ndepth = {depth}\ntool = 1\n'
        if kind == "engrave":
            return text + f'boundary = "part.dxf#e"\ndepth = {min(depth, 1)}\ntool = 4\n'
        if kind == "chamfer":
            top = 0.0 if r.random() < 0.6 else top  # below standing stock it is refused
            return f'strategy = "chamfer"\ntop = {top}\n' + f'boundary = "part.dxf#{r.choice("ap")}"\nwidth = {round(r.uniform(0.3, 1), 2)}\ntool = 4\n'
        layer = r.choice("ap") if kind == "pocket" else "o"
        text += f'boundary = "part.dxf#{layer}"\ndepth = {depth}\ntool = {r.choice((1, 2))}\n'
        text += r.choice(("", f"max_depth = {round(r.uniform(0.5, 2), 2)}\n"))
        text += r.choice(("", 'output = "arcs"\n', 'entry = "plunge"\n', 'entry = "ramp"\n'))
        if kind == "profile":
            return text + f'side = "{r.choice(("inside", "outside"))}"\n' + r.choice(("", "lead_in = 2\n"))
        return text + r.choice(("", "", 'clearing = "adaptive"\n'))

    def write(self, folder):
        holes = "".join(f"0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n1.5\n" for layer, x, y in (
            ("h", -12, 0), ("h", -5, 3), ("h", 21, 14), ("k", 10, -5), ("k", -12, -8)))
        part = rectangle("a", -16, -10, 20, 16) + rectangle("p", 2, -10, 12, 12) + rectangle("o", -19, -13, 38, 26) + holes
        part += polyline("e", [(-17, 8), (0, -4), (17, 8)], 0)
        (folder / "part.dxf").write_text(f"0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
                                         f"{part}0\nENDSEC\n0\nEOF\n")
        tools = 'flat"\ndiameter = 4', 'flat"\ndiameter = 6', 'drill"\ndiameter = 3', 'vee"\ndiameter = 6\ntip_angle = 90'
        fixture = '[[fixture]]\nx = [-30, -20]\ny = [12, 22]\ntop = 3\n' if self.fixture else ""
        (folder / "job.toml").write_text(
            'post = "linuxcnc"\n' + "".join(f'[[tool]]\nshape = "{tool}\n' for tool in tools) +
            f"[cutting]\nfeed = 800\n[stock]\ntop = 0\nbottom = {BOTTOM}\nx = {list(X)}\ny = {list(Y)}\n" + fixture +
            ('[[setup]]\nname = "front"\n[[setup]]\nname = "back"\nflip = "x"\n' if self.two else "") +
            "".join(f"[[operation]]\n{text}" for text in self.operations))


def fault(folder, two):
    """None of a job that is refused as it should be, "" of one that is planned soundly."""
    done = subprocess.run([str(CUSP), "plan", "--estimate-times", "job.toml", "-o", "p.ngc"], cwd=folder, capture_output=True, text=True,
                          timeout=600, check=False)
    if done.returncode == 2:
        named = re.search(r"operation \d|\[\[operation\]\]|boundary", done.stderr)
        if "rapid" in done.stderr:
            return f"an order is refused: {done.stderr[-400:]}"
        return None if named else f"a refusal without its operation: {done.stderr[-300:]}"
    if done.returncode:
        return f"plan: {done.returncode} {done.stderr[-300:]}"
    stock = StockWalk(X, Y, 0, BOTTOM)
    for name in ("p-front.ngc", "p-back.ngc") if two else ("p.ngc",):
        if name == "p-back.ngc":
            stock.turned_over()
        if not (folder / name).exists():
            return f"{name}: not written: {done.stdout[-200:]}"
        program = (folder / name).read_text()
        found = rapid_in_stock(stock, program)
        if found:
            return f"{name}, {found}"
        judged = subprocess.run([str(CUSP), "verify", "job.toml", name, *(["--after", "p-front.ngc"] if name == "p-back.ngc" else [])],
                                cwd=folder, capture_output=True, text=True, timeout=600, check=False).stdout
        broken = [line for line in judged.splitlines() if line.startswith("broken") and not (
            "of both sides" in line and "of both sides" in done.stderr)]
        if broken or ("broken" not in judged and "all bounds hold" not in judged):
            return f"{name}: {'; '.join(broken) or judged[-200:]}"
        if name != "p-back.ngc" and not rapid_in_stock(StockWalk(X, Y, 0, BOTTOM), planted(program)):
            return f"{name}: the judge misses a planted rapid"
    return ""


def planted(program):
    """A rapid into the stock before anything is cut."""
    first = re.search(r"^G0 X", program, re.MULTILINE).start()
    return program[:first] + "G0 X0 Y0\nG0 Z-2\nG0 Z5\n" + program[first:]


def main():
    faults = planned = 0
    for seed in (*KNOWN, *range(FIRST, FIRST + CASES)):
        folder = pathlib.Path(tempfile.mkdtemp(prefix=f"order-{seed}-"))
        order = RandomOrder(seed)
        order.write(folder)
        found = fault(folder, order.two)
        planned += found == ""
        print(f"seed {seed}: {order.kinds}: {'refused' if found is None else found or 'sound'}", flush=True)
        if found:
            faults += 1
            print(f"  kept in {folder}")
        else:
            shutil.rmtree(folder)
    print(f"{CASES + len(KNOWN)} jobs, {planned} planned soundly, {faults} with a fault")
    return 1 if faults or planned * 2 < CASES else 0


if __name__ == "__main__":
    sys.exit(main())
