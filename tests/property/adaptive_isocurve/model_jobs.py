"""Shared by the random models of adaptive_isocurve: writes the job, plans it, cuts it in memory."""
import json
import subprocess

JOB = """units = "mm"
[tool]
shape = "ball"
diameter = {diameter}
[cutting]
feed = 1200
[stock]
top = {top}
[[operation]]
strategy = "adaptive_isocurve"
floor = ["floor.json"]
output = "{output}"
floor_tolerance = {tolerance}
tolerance_side = "{side}"
scallop = {scallop}
direction = "{direction}"
traversal = "{traversal}"
"""


def clamped(count, degree, breaks=None):
    """A clamped knot vector for `count` control points, with the inner knots given or even."""
    inner = count - degree - 1
    if breaks is None:
        breaks = [(k + 1) / (inner + 1) for k in range(inner)]
    return [0.0] * (degree + 1) + breaks + [1.0] * (degree + 1)


def highest(surfaces):
    return max(p[2] for s in surfaces for p in s["control_points"]["points"])


def write(folder, surfaces, case):
    """Writes the job and its floor."""
    shape = {"type": "surface", "count": len(surfaces), "data": surfaces}
    (folder / "floor.json").write_text(json.dumps({"shape": shape}))
    (folder / "job.toml").write_text(JOB.format(**case))


def run(arguments):
    return subprocess.run(arguments, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=400)


def judged(cusp, folder):
    """Plans the job and cuts it in memory. Returns the fault, or None, and the figures of `cusp verify`."""
    program = folder / "out.ngc"
    planned = run([cusp, "plan", "--estimate-times", folder / "job.toml", "-o", program, "--stats", folder / "plan.json"])
    if planned.returncode:
        return "plan failed: " + planned.stdout[-2000:], {}
    verdict = run([cusp, "verify", folder / "job.toml", program, "--stats", folder / "verify.json"])
    if verdict.returncode:
        return "verify failed: " + verdict.stdout[-2000:], {}
    return None, json.loads((folder / "verify.json").read_text())
