"""Grbl 1.1's documents on states, realtime bytes and lines, as a program: a table, and a state of six fields.

A driver of a controller, on the virtual mill or on a chip, is put into each state of states(), given each byte and
each line, and compared with the model (all_trials, walk). What a driver does:

    fresh()             Idle, nothing on, the door closed, 4 s or more until the spindle is up, after PASSES_M1,
                        NO_LASER and NO_SETTER
    say(text)           sends lines that lead to a state, and waits for their answers where they come at once
    send(text)          sends
    door(opened)
    wait(seconds)
    observe()           (report's state, outputs that are on, whether it moves, whether it reports spindle speed)
    heard()             what it said since the last call
    heard_until(answer) as above, up to that answer; for a while where it is None
    patience            observations until it must be as the model says
"""
import random

RESET, HOLD, START, DOOR, CANCEL = "\x18", "!", "~", "\x84", "\x85"
STOP_SPINDLE, FLOOD, MIST = "\x9e", "\xa0", "\xa1"
OVERRIDES = "\x90\x91\x92\x93\x94\x95\x96\x97\x99\x9a\x9b\x9c\x9d"
BYTES = ("?", HOLD, START, RESET, DOOR, CANCEL, STOP_SPINDLE, FLOOD, MIST, OVERRIDES)
OUTPUTS = frozenset("SFM")
SPEED_UP = "faster"
STOPS_AT_M1, PASSES_M1 = "$795=1\n", "$795=0\n"
LASER, NO_LASER = "$32=1\n", "$32=0\n"
# Tool setter: on a homed machine, with a slow way down to it.
SETTER = "$341=3\n$343=10\n$344=10\n"
HOMING = "$120=500\n$121=500\n$122=500\n$24=300\n$25=3000\n"
NO_SETTER = "$120=10\n$121=10\n$122=10\n$25=30\n$341=0\n"
# States of a homed machine, whose switches close where it comes to them.
HOMED = ("Tool setter", "Tool setter, held")
# States that end by themselves, or that hide what a walk would see.
UNSTEADY = ("Dwell", "Probe", "Tool setter", "Tool setter, held", "Spindle comes up", "Hold:1", "Door:2")
# Lines that lead to a state, and are answered after it.
UNANSWERED = ("G4P60", "$H", "G91G38.3", "M4", "T1M6")

# A line's answer in each state. A dash: none, for as long as the state lasts. In Hold, Door, Home and Sleep, and while
# a line waits (dwell, spindle), no line is answered. An arrow: the state behind it.
ANSWERS = """
line              Idle      Run      Jog      Alarm     Check
                  ok        ok       ok       ok        ok
$                 ok        ok       ok       ok        ok
$G                ok        ok       ok       ok        ok
$$                ok        error:8  ok       ok        ok
$#                ok        error:8  error:8  ok        error:8
$N                ok        error:8  error:8  ok        error:8
$I                ok        error:8  error:8  ok        error:8
$X                ok        ok       ok       ok>Idle   ok
$C                ok>Check  error:8  error:8  ok>Check  ok>Idle
$SLP              ok>Sleep  error:8  error:8  ok>Sleep  error:8
$J=G91X0.02F600   ok        error:8  ok       error:8   error:8
$H                ->Home    error:8  error:8  ->Home    error:8
G4P0              ok        -        error:9  error:9   ok
M5                ok        -        error:9  error:9   ok
M9                ok        -        error:9  error:9   ok
M8                ok        -        error:9  error:9   ok
M0                ok>Hold   -        error:9  error:9   ok
M1                ok        ok       error:9  error:9   ok
G91G1X0F600       ok        ok       error:9  error:9   ok
"""


def answers():
    """line -> state -> (answer, state behind it or None)."""
    head, *rows = ANSWERS.strip("\n").split("\n")
    states = head.split()[1:]
    table = {}
    for row in rows:
        line, cells = row[:18].strip(), row[18:].split()
        table[line] = {state: (cell.partition(">")[0], cell.partition(">")[2] or None)
                       for state, cell in zip(states, cells)}
    return table


class Model:
    """The controller as its documents tell of it."""

    def __init__(self, state="Idle", wanted="", behind="Idle", stopped="", up=True, opened=False, starting=False,
                 waits=False, braking=False, laser=False, changing=False):
        self.state = state
        self.wanted = set(wanted)    # outputs that the program has on
        self.stopped = set(stopped)  # of them those that a hold or the door has off
        self.behind = behind         # the state that a cycle start returns to
        self.up = up                 # what was switched on is up
        self.opened = opened         # the door
        self.starting = starting     # a cycle start waits for it
        self.waits = waits           # a line does: a dwell, or the spindle after M3
        self.braking = braking       # towards the stop of a hold or a door
        self.laser = laser           # it is up at once, and off at rest
        self.changing = changing     # the tool: spindle and coolant wait
        self.alarm = None            # the last number

    def report(self):
        if self.state == "Hold":
            return "Hold:1" if self.braking else "Hold:0"
        if self.state == "Door":
            return "Door:2" if self.braking else "Door:" + ("3" if self.starting else "1" if self.opened else "0")
        return self.state

    def outputs(self):
        dark = {"S"} if self.laser and not self.moves() else set()
        return frozenset(set() if self.changing else self.wanted - self.stopped - dark)

    def moves(self):
        return self.braking or self.state in ("Run", "Jog", "Home")

    def byte(self, byte):
        """The machine has come to rest after it."""
        self.alarm = None
        ignored = self.braking and byte in (START, STOP_SPINDLE)
        if self.braking and byte == RESET:
            self.raise_alarm(3)
        elif not ignored:
            self.act(byte)
        self.braking = False

    def act(self, byte):
        action = {HOLD: self.hold, START: self.start, RESET: self.reset, DOOR: self.door,
                  STOP_SPINDLE: self.stop_spindle}.get(byte)
        if action:
            action()
        elif byte == CANCEL and self.state == "Jog":
            self.state = "Idle"
        elif byte in (FLOOD, MIST) and self.state in ("Idle", "Run", "Hold", "Jog"):
            self.wanted ^= {"F" if byte == FLOOD else "M"}

    def hold(self):
        if self.state in ("Idle", "Run", "Home"):
            self.behind, self.state = self.state, "Hold"
        elif self.state == "Jog":
            self.state = "Idle"
        elif self.starting:
            self.starting, self.state = False, "Hold"

    def start(self):
        if self.state not in ("Hold", "Door") or self.opened or self.starting:
            return
        if "S" in self.stopped & self.wanted:
            self.up = self.laser
        self.stopped = set()
        if self.up or "S" not in self.wanted:
            self.state = self.behind
        else:
            self.starting = True

    def door(self):
        if self.state in ("Alarm", "Check", "Sleep"):
            return
        if "Home" in (self.state, self.behind if self.state == "Hold" else ""):
            self.raise_alarm(7)
            return
        if self.state != "Hold" and self.state != "Door":
            self.behind = "Run" if self.state == "Run" else "Idle"
        self.state, self.starting, self.stopped = "Door", False, set(OUTPUTS)

    def stop_spindle(self):
        if self.state == "Hold" and "S" in self.wanted:
            self.stopped ^= {"S"}
            if self.stopped:
                self.starting = False
            else:
                self.up = False

    def raise_alarm(self, number):
        self.__init__("Alarm", opened=self.opened)
        self.alarm = number

    def reset(self):
        homing = "Home" in (self.state, self.behind if self.state == "Hold" else "")
        if homing or self.moves():
            self.raise_alarm(6 if homing else 3)
            return
        locked = self.state in ("Alarm", "Sleep")
        self.__init__("Alarm" if locked else "Idle", opened=self.opened)
        if self.opened and not locked:
            self.door()

    def line(self, line):
        """The answer; None: none comes."""
        self.alarm, self.braking = None, False
        cells = answers()[line]
        if self.state not in cells or self.waits:
            return None
        answer, behind = cells[self.state]
        checks = self.state == "Check"
        if answer == "ok" and not checks:
            self.wanted -= {"M5": {"S"}, "M9": {"F", "M"}}.get(line, set())
            self.wanted |= {"M8": {"F"}}.get(line, set())
        if behind == "Sleep" or checks and behind == "Idle":
            self.__init__()
        if behind:
            self.state, self.behind = behind, "Idle"
        return None if answer == "-" else answer


def states():
    """name -> (model, what leads there from a fresh Idle with nothing on: lines, bytes, and reports to wait for)."""
    on = "M3S1000\nM8\n"
    run, jog, home = [on + "G91G1X{}90F200\n", "=Run"], ["$J=G91X{}90F200\n", "=Jog"], ["$H\n", "=Home"]
    fast = [on + "G91G1X{}90F1200\n", "=Run", SPEED_UP]
    setter = [HOMING + "$H\n", "=Idle", SETTER + "G10L2P9X-20Y-20Z-15\n" + on + "T1M6\n", "=Hold:0", START, "=Run"]
    held, closed = run + [HOLD, "=Hold:0"], run + [DOOR, "=Door:0"]
    return {
        "Idle": (Model("Idle", "SF"), [on]),
        "Run": (Model("Run", "SF"), run),
        "Hold": (Model("Hold", "SF", "Run"), held),
        "Hold:1": (Model("Hold", "SF", "Run", braking=True), fast + [HOLD]),
        "Hold at rest": (Model("Hold", "SF", "Idle"), [on, HOLD]),
        "Hold, spindle stopped": (Model("Hold", "SF", "Run", "S"), held + [STOP_SPINDLE]),
        "Hold, starting": (Model("Hold", "SF", "Run", up=False, starting=True), held + [STOP_SPINDLE, START]),
        "M0": (Model("Hold", "SF", "Idle"), [on + "M0\n"]),
        "M1, switched on": (Model("Hold", "SF", "Idle"), [on + STOPS_AT_M1 + "M1\n"]),
        "M6": (Model("Hold", "SF", "Idle"), [on + "T1M6\n"]),
        "Tool setter": (Model("Run", "SF", waits=True, changing=True), setter),
        "Tool setter, held": (Model("Hold", "SF", "Run", waits=True, changing=True), setter + [HOLD, "=Hold:0"]),
        "Laser": (Model("Run", "SF", laser=True), [LASER] + run),
        "Laser, held": (Model("Hold", "SF", "Run", laser=True), [LASER] + held),
        "Jog": (Model("Jog", "SF"), [on] + jog),
        "Alarm": (Model("Alarm"), jog + [RESET]),
        "Door:0": (Model("Door", "SF", "Run", "SFM"), closed),
        "Door:0 at rest": (Model("Door", "SF", "Idle", "SFM"), [on, DOOR]),
        "Door:1": (Model("Door", "SF", "Run", "SFM", opened=True), run + ["open"]),
        "Door:2": (Model("Door", "SF", "Run", "SFM", braking=True), fast + [DOOR]),
        "Door:3": (Model("Door", "SF", "Run", up=False, starting=True), closed + [START]),
        "Check": (Model("Check"), ["$C\n"]),
        "Home": (Model("Home"), home),
        "Home, held": (Model("Hold", "", "Home"), home + [HOLD]),
        "Sleep": (Model("Sleep"), [on, "$SLP\n"]),
        "Dwell": (Model("Idle", "SF", waits=True), [on + "G4P60\n"]),
        "Probe": (Model("Run", "SF", waits=True), [on + "G91G38.3Z-60F100\n", "=Run"]),
        "Spindle comes up": (Model("Idle", "SF", up=False, waits=True), [on + "$394=30\nM4S1000\n"]),
    }


class Differs(Exception):
    """The controller is not as the model says."""


def compare(driver, model, where):
    """The controller comes to be as the model, and stays so."""
    wanted = (model.report(), model.outputs(), model.moves(), "S" in model.outputs())
    for _ in range(driver.patience):
        found = driver.observe()
        if found == wanted:
            break
    else:
        raise Differs(f"{where}: {found} where the model has {wanted}")
    if model.moves():
        return
    found = driver.observe()
    if found != wanted:
        raise Differs(f"{where}: {found} after the model's {wanted}")


def wait_for(driver, report):
    """The report; where the machine moves in that state, it does."""
    moves = report in ("Run", "Jog", "Home", "Hold:1", "Door:2")
    for _ in range(driver.patience):
        found = driver.observe()
        if found[0] == report and found[2] == moves:
            return
    raise Differs(f"no {report}, but {found}")


def enter(driver, name):
    """A fresh controller in a state, and the model of it."""
    model, steps = states()[name]
    driver.fresh()
    for step in steps:
        if step == "open":
            driver.door(True)
        elif step == SPEED_UP:
            driver.wait(1.5)
        elif step[0] == "=":
            wait_for(driver, step[1:])
        else:
            driver.say(step)
    if model.braking:
        wait_for(driver, model.report())
    else:
        compare(driver, model, name)
    driver.heard()
    return model


def try_byte(driver, name, byte):
    model = enter(driver, name)
    driver.send(byte)
    where = f"{name}, 0x{ord(byte[0]):02X}"
    for one in byte:
        model.byte(one)
    compare(driver, model, where)
    heard = driver.heard()
    told = f"ALARM:{model.alarm}\r\n" in heard if model.alarm else "ALARM:" not in heard
    if not told:
        raise Differs(f"{where}: {heard!r} where the alarm is {model.alarm}")


def try_line(driver, name, line):
    model = enter(driver, name)
    driver.send(line + "\n")
    answer = model.line(line)
    where = f"{name}, line '{line}'"
    heard = driver.heard_until(answer)
    ends = [text for text in heard.split("\r\n") if text == "ok" or text.startswith("error:")]
    if ends != ([answer] if answer else []):
        raise Differs(f"{where}: {ends} where the model has {answer}")
    compare(driver, model, where)


def walk(driver, seed, length):
    """Random bytes from a random state on."""
    chance = random.Random(seed)
    name = chance.choice([name for name in states() if name not in UNSTEADY])
    model = enter(driver, name)
    where = f"seed {seed}: {name}"
    for _ in range(length):
        byte = chance.choice(BYTES[1:9])
        driver.send(byte)
        model.byte(byte)
        where += f", 0x{ord(byte):02X}"
        compare(driver, model, where)


def all_trials():
    """(function, state, stimulus) of every cell."""
    return [(try_byte, name, byte) for name in states() for byte in BYTES] + \
           [(try_line, name, line) for name in states() for line in answers()]
