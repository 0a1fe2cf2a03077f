"""cusp: tool paths with proven bounds, their verification, and the motion of the controller that runs them.

    import cusp

    program = cusp.plan("part.toml")[0]           # one for each set-up
    check = cusp.verify("part.toml", program.gcode)
    run = cusp.simulate(program.gcode, settings="$110=3000")
    print(check.broken, run.statistics["duration_s"], run.samples["x"].max())

Lengths are millimetres, angles degrees, times seconds, whatever the job's units. Input that can't be used raises
Error, whose file, line, key, value and limit say what is wrong, as far as they are known.
"""
import dataclasses as _dataclasses
import json as _json
import os as _os
import sys as _sys

import numpy as _numpy

# The reader of STEP and IGES is a library of its own, which calls this one.
_flags = _sys.getdlopenflags()
_sys.setdlopenflags(_flags | _os.RTLD_GLOBAL)
try:
    from cusp import _cusp
finally:
    _sys.setdlopenflags(_flags)

Error = _cusp.Error
Cancelled = _cusp.Cancelled
__version__ = _cusp.__version__
set_threads = _cusp.set_threads

KINDS = ("rapid", "plunge", "cut", "link", "plunging cut")
SHAPES = ("line", "arc", "nurbs")


class Job:
    """A job: a TOML file, or its text.

    Job("part.toml"), or Job.of_text(toml, folder="parts"): `folder` is where its relative paths begin.
    """

    def __init__(self, file):
        self._source = _cusp.JobSource("", _os.fspath(file), "")

    @classmethod
    def of_text(cls, toml, name="job", folder=""):
        job = cls.__new__(cls)
        job._source = _cusp.JobSource(toml, name, _os.fspath(folder))
        return job


@_dataclasses.dataclass(frozen=True)
class Program:
    """A planned program.

    setup       name of its set-up; "" for a job without set-ups
    gcode       the text
    statistics  the keys of `cusp plan --stats`
    warnings    sentences
    moves       one row a move: kind (index in KINDS), shape (index in SHAPES), operation, tool, x, y, z of its end, feed
    """

    setup: str
    gcode: str
    statistics: dict
    warnings: list
    moves: _numpy.ndarray


@_dataclasses.dataclass(frozen=True)
class Verification:
    """Verdict on a program that was cut in memory.

    broken   each bound that does not hold, in words; empty: all hold
    figures  the keys of `cusp verify --stats`
    left     mm of stock above the part on a grid [x, y]; nan outside the part, inf uncut
    gouge    mm cut below the part
    part     z of the part
    grid     x and y of the first point, and the pitch; rows and columns are shifted within half a pitch
    """

    broken: list
    figures: dict
    left: _numpy.ndarray
    gouge: _numpy.ndarray
    part: _numpy.ndarray
    grid: tuple


@_dataclasses.dataclass(frozen=True)
class Run:
    """A run of a program through the controller's motion core.

    good        whether it ran to its end
    errors      lines that were refused, alarms
    statistics  the keys of `cusp sim --stats`
    samples     one row a servo tick, 1 ms: seconds, x, y, z, line; empty unless asked for
    """

    good: bool
    errors: list
    statistics: dict
    samples: _numpy.ndarray


def _job(job):
    return (job if isinstance(job, Job) else Job(job))._source


def plan(job, blend=0.0, progress=None):
    """Plans a job (a Job, or the name of a file): a list of Program, one for each set-up.

    blend     G64 P, in the job's units; 0: the exact path
    progress  called with a text and a share from 0 to 1; an exception in it, and Ctrl-C, end the plan: Cancelled
    """
    return [Program(p["setup"], p["gcode"], _json.loads(p["statistics"]), p["warnings"], p["moves"])
            for p in _cusp.plan(_job(job), blend, progress)]


def verify(job, gcode, after=(), pitch=None, engagement=False):
    """Cuts the job's stock with a program and compares what is left with the part: a Verification.

    after       programs (texts) of other set-ups that were cut before
    pitch       mm between heights; default 0.173, or fine enough for the tools
    engagement  look for the tool's engagement, too
    """
    programs = [("program", gcode)] + [(f"program before, {k + 1}", text) for k, text in enumerate(after)]
    found = _cusp.verify(_job(job), programs, pitch, engagement)
    return Verification(found["broken"], _json.loads(found["figures"]), found["left"], found["gouge"], found["part"],
                        found["grid"])


def simulate(gcode, settings="", samples=True, dialect="cusp", name="program"):
    """Runs a program on the firmware's core: a Run.

    settings  lines such as "$110=3000"; default: the factory settings
    samples   keep every set point
    dialect   "grbl" refuses what stock Grbl 1.1 refuses
    """
    if dialect not in ("cusp", "grbl"):
        raise ValueError(f'dialect is "{dialect}", known are "cusp", "grbl"')
    run = _cusp.simulate(name, gcode, settings, samples, dialect == "grbl")
    return Run(run["good"], run["errors"], _json.loads(run["statistics"]), run["samples"])
