#!/usr/bin/env python3
"""Runs programs on LinuxCNC's own motion, headless, and writes the table of time and limits used.

usage: linuxcnc.py [--velocity X,Y,Z] [--acceleration X,Y,Z] [--jerk X,Y,Z] [--tolerance P]
                   [--cusp CUSP] [--keep DIR] PROGRAM...

LinuxCNC (Debian: linuxcnc-uspace) is started once for each program with a display that is this script,
without real time; a sampler in its servo thread takes the joints' commanded positions each
millisecond. One judge, finite differences of those positions, reckons the time from the first to the
last motion and the greatest velocity, acceleration and jerk over their limits, for LinuxCNC and, with
--cusp, for `cusp sim` of the same program. mm, s. LinuxCNC knows no limit of jerk before 2.10, where
the S-curve planner is used too.
Wall time is the program's own. Exit status: 0 table written, 1 a program failed, 2 LinuxCNC can't run.
"""
import argparse
import os
import pathlib
import pwd
import re
import shutil
import subprocess
import sys
import tempfile
import time

INI = """[EMC]
VERSION = 1.1
MACHINE = peer
DEBUG = 0
[DISPLAY]
DISPLAY = {display}
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = peer.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 10.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.010
TOOL_TABLE = peer.tbl
[HAL]
HALFILE = peer.hal
[TRAJ]
COORDINATES = XYZ
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = {fastest}
MAX_LINEAR_VELOCITY = {fastest_of_all}
DEFAULT_LINEAR_ACCELERATION = {hardest_of_all}
MAX_LINEAR_ACCELERATION = {hardest_of_all}
NO_FORCE_HOMING = 1
PLANNER_TYPE = {planner}
MAX_LINEAR_JERK = {jerkiest}
[KINS]
KINEMATICS = trivkins coordinates=XYZ
JOINTS = 3
"""

AXIS = """[AXIS_{letter}]
MIN_LIMIT = -10000
MAX_LIMIT = 10000
MAX_VELOCITY = {v}
MAX_ACCELERATION = {a}
MAX_JERK = {j}
[JOINT_{number}]
TYPE = LINEAR
MIN_LIMIT = -10000
MAX_LIMIT = 10000
MAX_VELOCITY = {v}
MAX_ACCELERATION = {a}
MAX_JERK = {j}
FERROR = 1000
MIN_FERROR = 1000
HOME = 0
HOME_SEARCH_VEL = 0
HOME_LATCH_VEL = 0
HOME_SEQUENCE = 0
"""

HAL = """loadrt trivkins coordinates=XYZ
loadrt motmod base_period_nsec=0 servo_period_nsec=1000000 num_joints=3
loadrt sampler depth=16000 cfg=fff
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
net x joint.0.motor-pos-cmd joint.0.motor-pos-fb sampler.0.pin.0
net y joint.1.motor-pos-cmd joint.1.motor-pos-fb sampler.0.pin.1
net z joint.2.motor-pos-cmd joint.2.motor-pos-fb sampler.0.pin.2
net estop iocontrol.0.user-enable-out iocontrol.0.emc-enable-in
net tool-prepare iocontrol.0.tool-prepare iocontrol.0.tool-prepared
net tool-change iocontrol.0.tool-change iocontrol.0.tool-changed
net spindle-at-speed spindle.0.on spindle.0.at-speed
loadusr halsampler samples.txt
"""

TICK = 1e-3

def display():
    """The program that LinuxCNC starts as its display: runs the program of PEER_PROGRAM, then leaves."""
    # This file has the name of LinuxCNC's module.
    sys.path[:] = [part for part in sys.path if pathlib.Path(part) != pathlib.Path(__file__).parent]
    import linuxcnc
    command, status = linuxcnc.command(), linuxcnc.stat()
    errors = linuxcnc.error_channel()

    def until(what, done, ask=lambda: None, seconds=120):
        """Asks again and again: a command too early is lost."""
        deadline = time.time() + seconds
        while time.time() < deadline:
            status.poll()
            if done():
                return
            ask()
            command.wait_complete(1)
            time.sleep(0.05)
        said = errors.poll()
        pathlib.Path("errors.txt").write_text(f"{what}: not within {seconds} s; {said and said[1]}")
        sys.exit(1)

    def switch_on():
        """The emergency stop comes back where its pin, a loop in HAL, is read too early."""
        stopped = status.task_state == linuxcnc.STATE_ESTOP
        command.state(linuxcnc.STATE_ESTOP_RESET if stopped else linuxcnc.STATE_ON)

    until("power", lambda: status.task_state == linuxcnc.STATE_ON, switch_on)
    until("manual", lambda: status.task_mode == linuxcnc.MODE_MANUAL,
          lambda: command.mode(linuxcnc.MODE_MANUAL))
    until("home", lambda: sum(status.homed[:3]) == 3, lambda: command.home(-1))
    until("auto", lambda: status.task_mode == linuxcnc.MODE_AUTO,
          lambda: command.mode(linuxcnc.MODE_AUTO))
    while errors.poll():
        pass
    command.program_open(os.environ["PEER_PROGRAM"])
    command.wait_complete()
    command.auto(linuxcnc.AUTO_RUN, 0)
    until("start", lambda: status.interp_state != linuxcnc.INTERP_IDLE)
    still = 0
    while still < 10:
        status.poll()
        still = still + 1 if status.interp_state == linuxcnc.INTERP_IDLE and status.inpos else 0
        said = errors.poll()
        if said:
            with open("errors.txt", "a") as file:
                file.write(f"{said[1]}\n")
        time.sleep(0.05)
    time.sleep(0.5)
    return 0


def of_axes(text):
    values = [float(word) for word in text.split(",")]
    if len(values) != 3 or min(values) <= 0:
        raise argparse.ArgumentTypeError(f"'{text}' is not three values over 0, X,Y,Z")
    return values


def write_machine(folder, options, planner):
    most = lambda values: sum(x * x for x in values) ** 0.5
    text = INI.format(display=pathlib.Path(__file__).resolve(), planner=planner,
                      fastest=max(options.velocity), fastest_of_all=most(options.velocity),
                      hardest_of_all=most(options.acceleration), jerkiest=most(options.jerk))
    for number, letter in enumerate("XYZ"):
        text += AXIS.format(letter=letter, number=number, v=options.velocity[number],
                            a=options.acceleration[number], j=options.jerk[number])
    (folder / "peer.ini").write_text(text)
    (folder / "peer.hal").write_text(HAL)
    (folder / "peer.tbl").write_text("T1 P1 D6 ;\nT2 P2 D6 ;\n")
    (folder / "peer.var").write_text(
        "5161 0\n5162 0\n5163 0\n5181 0\n5182 0\n5183 0\n5211 0\n5212 0\n5213 0\n5220 1\n"
        + "".join(f"{5221 + 20 * i + k} 0\n" for i in range(9) for k in range(10)))


def prepared(program, tolerance):
    """The program, after the state that cusp starts with, and with an end."""
    body = "\n".join(line for line in program.read_text().splitlines() if line.strip() != "%")
    end = "" if re.search(r"^\s*(N\d+\s*)?M0?[23]0?\b", body, re.M | re.I) else "\nM2"
    return f"G21 G90 G17 G94 G64 P{tolerance}\n{body}{end}\n"


def linuxcnc_samples(program, options, planner):
    folder = pathlib.Path(tempfile.mkdtemp(prefix="peer"))
    try:
        write_machine(folder, options, planner)
        text = folder / "program.ngc"
        text.write_text(prepared(program, options.tolerance))
        environment = dict(os.environ, PEER_PROGRAM=str(text), PEER_DISPLAY="1")
        if os.geteuid() == 0:
            # LinuxCNC's thread refuses to be root's: it becomes nobody's.
            folder.chmod(0o777)
            environment.update(RTAPI_UID=str(pwd.getpwnam("nobody").pw_uid),
                               RTAPI_FIFO_PATH=str(folder / "fifo"))
        run = subprocess.run(["linuxcnc", str(folder / "peer.ini")], cwd=folder, env=environment,
                             capture_output=True, text=True, timeout=options.longest)
        samples = folder / "samples.txt"
        lines = samples.read_text().splitlines() if samples.exists() else []
        rows = [[float(word) for word in line.split()[-3:]] for line in lines
                if len(line.split()) >= 3 and "overrun" not in line]
        if "overrun" in "\n".join(lines):
            raise RuntimeError("the sampler has lost samples")
        said = folder / "errors.txt"
        if said.exists():
            raise RuntimeError(said.read_text().strip().splitlines()[0])
        if len(rows) < 10:
            raise RuntimeError((run.stderr + run.stdout).strip()[-600:])
        return rows
    finally:
        if options.keep:
            shutil.copytree(folder, pathlib.Path(options.keep) / program.stem, dirs_exist_ok=True)
        shutil.rmtree(folder, ignore_errors=True)


def patient_samples(program, options, planner):
    """LinuxCNC starts badly while another one ends, or on a busy machine."""
    for _ in range(2):
        try:
            return linuxcnc_samples(program, options, planner)
        except RuntimeError:
            time.sleep(10)
    return linuxcnc_samples(program, options, planner)


def cusp_samples(program, options):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        text, samples, settings = (folder / part for part in ("p.ngc", "s.csv", "settings"))
        text.write_text(prepared(program, options.tolerance))
        settings.write_text("".join(
            f"${110 + i}={60 * options.velocity[i]}\n${120 + i}={options.acceleration[i]}\n"
            f"${800 + i}={options.jerk[i]}\n" for i in range(3)))
        subprocess.run([options.cusp, "sim", text, "--settings", settings, "--samples", samples],
                       check=True, capture_output=True)
        return rows_of_csv(samples)


def rows_of_csv(file):
    lines = file.read_text().splitlines()
    names = lines[0].split(",")
    columns = [next(i for i, name in enumerate(names) if name == axis + "_nm")
               for axis in "xyz"]
    return [[1e-6 * float(line.split(",")[column]) for column in columns] for line in lines[1:] if line]


def judge(rows, options):
    """Time from the first to the last motion, s, and the greatest part of each limit, any axis."""
    moved = [i for i in range(1, len(rows)) if rows[i] != rows[i - 1]]
    if not moved:
        return 0.0, [0.0, 0.0, 0.0]
    first, last = moved[0], moved[-1]
    rows = [rows[first - 1]] * 3 + rows[first - 1:last + 1] + [rows[last]] * 3
    parts = []
    # Both give whole nanometres: 1, 2 and 4 of them in the first three differences are rounding.
    for order, limits in ((1, options.velocity), (2, options.acceleration), (3, options.jerk)):
        greatest = 0.0
        for axis in range(3):
            values = [row[axis] for row in rows]
            for _ in range(order):
                values = [(b - a) / TICK for a, b in zip(values, values[1:])]
            rounding = 2 ** (order - 1) * 1e-6 / TICK ** order
            greatest = max(greatest, (max(map(abs, values)) - rounding) / limits[axis])
        parts.append(greatest)
    return (last - first + 1) * TICK, parts


def version():
    """LinuxCNC's, as (2, 9); None where there is none."""
    tool = shutil.which("linuxcnc")
    if tool is None:
        return None
    run = subprocess.run(["linuxcnc_var", "LINUXCNCVERSION"], capture_output=True, text=True)
    found = re.match(r"(\d+)\.(\d+)", run.stdout.strip())
    return (int(found[1]), int(found[2])) if found else (0, 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--velocity", type=of_axes, default=[100, 100, 50])
    parser.add_argument("--acceleration", type=of_axes, default=[1000, 1000, 500])
    parser.add_argument("--jerk", type=of_axes, default=[50000, 50000, 25000])
    parser.add_argument("--tolerance", type=float, default=0.01)
    parser.add_argument("--cusp")
    parser.add_argument("--keep", help="folder for configurations and samples")
    parser.add_argument("--longest", type=float, default=900, help="s of wall time a program")
    parser.add_argument("programs", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    known = version()
    if known is None:
        print("linuxcnc: not installed (Debian: linuxcnc-uspace)", file=sys.stderr)
        return 2
    runs = [("LinuxCNC trapezoid", lambda program: patient_samples(program, options, 0))]
    if known >= (2, 10):
        runs.append(("LinuxCNC S-curve", lambda program: patient_samples(program, options, 1)))
    if options.cusp:
        runs.append(("cusp", lambda program: cusp_samples(program, options)))
    print("| program | planner | time, s | v / limit | a / limit | j / limit |")
    print("|---|---|---|---|---|---|")
    status = 0
    for program in options.programs:
        for name, run in runs:
            try:
                seconds, parts = judge(run(program), options)
                print(f"| {program.name} | {name} | {seconds:.3f} | "
                      + " | ".join(f"{part:.3f}" for part in parts) + " |", flush=True)
            except (RuntimeError, OSError, subprocess.SubprocessError) as error:
                print(f"| {program.name} | {name} | failed: {str(error)[-300:]} | | | |", flush=True)
                status = 1
    return status


if __name__ == "__main__":
    sys.exit(display() if "PEER_DISPLAY" in os.environ else main())
