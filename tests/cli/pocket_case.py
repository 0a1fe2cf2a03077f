"""PocketCase: a pocket over a curved floor by two tools, planned in a folder of its own."""
import json

from cusp_case import CuspCase


def floor(x, y):
    return {"shape": {"type": "surface", "count": 1, "data": [{
        "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2, "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
        "control_points": {"points": [[-x / 4, -y / 4, -x / 12], [-x / 4, 5 * y / 4, -x / 9], [5 * x / 4, -y / 4, -x / 12],
                                      [5 * x / 4, 5 * y / 4, -x / 9]]}}]}}


def loop(x, y):
    return {"shape": {"type": "curve", "count": 1, "data": [{
        "degree": 1, "knotvector": [0, 0, 1, 2, 3, 4, 4], "control_points": {"points": [[0, 0], [x, 0], [x, y], [0, y], [0, 0]]}}]}}


JOB = """
units = "{units}"
{more}
[[tool]]
name = "8mm flat"
shape = "flat"
diameter = 8
feed = 1500
spindle = 9000
coolant = "flood"
[[tool]]
name = "6mm ball"
shape = "ball"
diameter = 6
[cutting]
feed = 1000
spindle = 12000
[stock]
top = 0
[[operation]]
strategy = "contour_pocket"
floor = "floor.json"
boundary = "boundary.json"
scallop = 0.3
tool = "6mm ball"
tools = ["8mm flat", "6mm ball"]
max_depth = 2
allowance = 0.2
output = "{output}"
"""


class PocketCase(CuspCase):
    SIZE = (40, 30)

    def setUp(self):
        super().setUp()
        self.job()

    def job(self, output="arcs", more="", units="mm", coolant=True):
        text = JOB.format(output=output, more=more, units=units)
        x, y = (side / (25.4 if units == "inch" else 1) for side in self.SIZE)
        self.write("floor.json", json.dumps(floor(x, y)))
        self.write("boundary.json", json.dumps(loop(x, y)))
        if units == "inch":  # about the same part
            for key, length in (("diameter = 8", "0.3"), ("diameter = 6", "0.24"), ("scallop = 0.3", "0.012"), ("max_depth = 2", "0.08"),
                                ("allowance = 0.2", "0.008"), ("feed = 1000", "40"), ("feed = 1500", "60")):
                text = text.replace(key, key.split("=")[0] + "= " + length)
        self.write("job.toml", text if coolant else text.replace('coolant = "flood"\n', ""))

    def planned(self, *options):
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json", *options)
        return (self.folder / "p.ngc").read_text()
