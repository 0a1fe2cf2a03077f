"""A stranger's use of the installed module: plans, verifies, simulates, is refused."""
import pathlib
import re
import sys

import cusp

JOB = pathlib.Path(sys.argv[1]) / "hull_rough/tap.toml"

shares = []
program = cusp.plan(JOB, progress=lambda work, share: shares.append(share))[0]
assert program.gcode.rstrip().endswith("M30"), program.gcode[-40:]
assert len(program.moves) > 100 and set(program.moves["kind"]) <= set(range(len(cusp.KINDS)))
assert shares and max(shares) == 1.0
assert cusp.plan(JOB)[0].gcode == program.gcode
length = program.statistics["cut_length_mm"]
assert cusp.verify(JOB, program.gcode).broken == []
deeper = re.sub(r"Z(-?[0-9.]+)", lambda z: f"Z{float(z[1]) - 3:.4f}", program.gcode)
assert any("gouge" in broken for broken in cusp.verify(JOB, deeper).broken), cusp.verify(JOB, deeper).broken
run = cusp.simulate(program.gcode, settings="$110=3000")
assert run.good and abs(run.statistics["duration_s"] - run.samples["seconds"][-1]) < 60
text = JOB.read_text().replace("diameter = ", "diameter = -")
try:
    cusp.plan(cusp.Job.of_text(text, name="part.toml", folder=JOB.parent))
except cusp.Error as error:
    assert (error.file, error.key) == ("part.toml", "diameter"), (error.file, error.key)
    assert error.line == text[:text.index("diameter")].count("\n") + 1 and "at most" in error.limit, error.limit
else:
    sys.exit("a negative diameter was planned")


def stop(work, share):
    raise InterruptedError


try:
    cusp.plan(JOB, progress=stop)
except cusp.Cancelled:
    pass
else:
    sys.exit("the plan was not cancelled")
print(f"cusp {cusp.__version__}: {length:.0f} mm planned, verified and run")
