"""An image of a board on models of its chip's registers (cosim_main.cpp), driven from Python.

The pins are those of the board's README: its wiring table is what a user wires by.
"""
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[3]
# Chip and crystal, as the boards' READMEs say in their first lines; "external": a clock in its place.
CHIPS = {"mill3_f405": ("stm32f405", 8000000), "black_pill_f411": ("stm32f411", 25000000),
         "nucleo_f446_cnc_shield": ("stm32f446", 8000000, "external"),
         "skr2_f407": ("stm32f407", 8000000), "octopus_f446": ("stm32f446", 12000000),
         "skr2_f429": ("stm32f429", 8000000), "octopus_f429": ("stm32f429", 8000000),
         "pico2_terminals": ("rp2350", 12000000)}
# An image behind the maker's boot loader, NAME_sd, is for the same board; its settings begin in this sector.
BEHIND_LOADER = "_sd"
SETTINGS_SECTOR = {"stm32f407": 10, "stm32f429": 10, "stm32f446": 6}
# Boards that are wired as another.
WIRED_AS = {"skr2_f429": "skr2_f407", "octopus_f429": "octopus_f446"}
# A core that stands still does not turn the wire round on which a drive answers: for 2 ms both drive it.
WITHOUT_CORE = ("driven from outside and from inside", "the wire is driven from both ends")
# Which USART has the pin as its transmitter.
USARTS = {"PA9": (), "PA2": ("usart2",), "GP0": ()}
# Which channel of its timer a pin of spindle pulses has.
SPINDLE_CHANNEL = {"PA6": 1, "PA7": 2, "PB0": 3, "PB1": 4, "GP10": 1}
USART_OF_SPINDLE = {"PA2": "2", "PD8": "3"}
# Contacts to ground that are closed where nothing is tripped.
CLOSED_AT_REST = ("probe", "door", "hold", "reset", "emergency stop", "motor fault")
# A drive in the wiring table whose module is in its socket.
DRIVES = ("X drive UART", "Y drive UART", "Z drive UART", "second drive UART")
BUS = ("drives SPI clock", "drives SPI out", "drives SPI in")  # of TMC5160 modules
DRIVES_UP = 400  # ms after the banner, until they are set
LINES = ("X step", "Y step", "Z step", "X direction", "Y direction", "Z direction")


class CosimFailed(Exception):
    """The co-simulation could not go on."""


def page_of(board):
    """The board's README; of a board outside the tree, its page takes the place of its name."""
    board = board.removesuffix(BEHIND_LOADER)
    is_page = board.endswith(".md")
    return (pathlib.Path(board) if is_page else ROOT / "boards" / WIRED_AS.get(board, board) / "README.md").read_text()


def chip_of(board):
    """As in CHIPS."""
    if not board.endswith(".md"):
        return CHIPS[board.removesuffix(BEHIND_LOADER)]
    chip, source, megahertz = re.search(r"^An (STM32F\d+) at \d+ MHz with a (crystal|clock from outside) of (\d+) MHz",
                                        page_of(board), re.M).groups()
    return (chip.lower(), int(megahertz) * 1000000, *(() if source == "crystal" else ("external",)))


def wiring(board):
    """signal -> pin, from the wiring table of the board's README."""
    pins = {}
    text = page_of(board)
    for signals, names in re.findall(r"^\| ([^|]+) \| ((?:P[A-I]|GP)\d+(?:, (?:P[A-I]|GP)\d+)*) \|", text, re.M):
        words = [re.sub(r"\(.*?\)", "", word).strip() for word in signals.split(",")]
        names = names.split(", ")
        if len(words) != len(names):
            continue
        # "limit X, Y, Z": the words after the first leave its first word out.
        head = words[0].split()[0]
        for word, name in zip(words, names):
            pins[word if " " in word or word == words[0] or head not in ("limit", "spindle", "serial")
                 else f"{head} {word}"] = name
    return pins


class Chip:
    """The image of a board from power-up on. A context manager: the end checks for violations."""

    def __init__(self, cosim, image, board, crystal=None, may_violate=(), quiet_inputs=True, spindle=None, on_bus=()):
        """`on_bus`: places of the sockets that have a TMC5160."""
        chip, nominal, *more = chip_of(board)
        if board.endswith(BEHIND_LOADER):
            loader = pathlib.Path(image).resolve().parents[1] / "test_loader.bin"
            more += ["loader", str(loader), str(SETTINGS_SECTOR[chip])]
        self.may_violate = may_violate
        self.page = page_of(board)
        self.pins = wiring(board)
        self.lines = [self.pins[line] for line in LINES]
        self.drives = [drive for drive in DRIVES if drive in self.pins]
        self.enables = [pin for signal, pin in self.pins.items() if signal.startswith("drives enable")]
        self.process = subprocess.Popen(
            [str(cosim), chip, str(nominal if crystal is None else crystal), str(image), *more,
             *USARTS[self.pins["serial transmit"]],
             *(word for place, drive in enumerate(self.drives)
               for word in (*(("bus_drive", self.pins[drive], *(self.pins[wire] for wire in BUS)) if place in on_bus
                            else ("drive", self.pins[drive])),)),
             *(("spindle", str(spindle), USART_OF_SPINDLE[self.pins["spindle transmit"]], self.pins["spindle sends"])
               if spindle else ())],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        if quiet_inputs:
            for signal, pin in self.pins.items():
                if signal.startswith("limit") or signal in CLOSED_AT_REST:
                    self.pin(pin, 0)

    def __enter__(self):
        return self

    def __exit__(self, kind, value, trace):
        try:
            if kind is None:
                self.check()
        finally:
            self.process.stdin.close()
            self.process.wait(10)
            self.process.stdout.close()

    def command(self, text):
        """The lines that answer a command."""
        if text.startswith("core "):
            self.may_violate = (*self.may_violate, *WITHOUT_CORE)
        try:
            self.process.stdin.write(text + "\n")
            self.process.stdin.flush()
        except OSError as error:
            raise CosimFailed(f"{text}: {error}") from error
        answer = []
        for line in self.process.stdout:
            if line == "done\n":
                return answer
            answer.append(line.rstrip("\n"))
        raise CosimFailed(f"{text}: the co-simulation ended: {answer}")

    def run(self, milliseconds, until=""):
        """The output of the chip in that time, or up to the text that is waited for."""
        wanted = until.encode("latin-1").hex()
        answer = self.command(f"run {milliseconds} {wanted}")
        return bytes.fromhex(answer[-1].partition(" ")[2]).decode("latin-1")

    def level_of(self, signal):
        """The level at which an input acts, as its row in the wiring table says."""
        return 0 if re.search(rf"^\| {signal} \| \w+ \| low = ", self.page, re.M) else 1

    def boot(self):
        return self.run(1000, "help]\r\n") + self.run(DRIVES_UP if self.drives else 20)

    def send(self, text):
        self.command(f"send {text.encode('latin-1').hex()}")

    def ask(self, line, milliseconds=3000):
        """A line and its answer."""
        self.send(line + "\n")
        heard = ""
        for _ in range(2 * milliseconds):
            heard += self.run(1)
            if re.search(r"(^|\n)(ok|error:\d+)\r\n", heard):
                return heard
        raise CosimFailed(f"{line}: not answered within {milliseconds} ms: {heard!r}")

    def status(self):
        self.send("?")
        heard = ""
        for _ in range(100):
            heard += self.run(1)
            match = re.search(r"<(\w+)(?::(\d))?[^|>]*\|MPos:([-\d.,]+)[^>]*>\r\n", heard)
            if match is not None:
                return match.group(1), tuple(float(part) for part in match.group(3).split(","))
        raise CosimFailed(f"no status report, but {heard!r}")

    def wait_for(self, state, milliseconds=20000):
        for _ in range(milliseconds // 50):
            now = self.status()
            if now[0] == state:
                return now
            self.run(40)
        raise CosimFailed(f"not {state} within {milliseconds} ms, but {now}")

    def pin(self, name, level):
        self.command(f"pin {name} {level}")

    def levels(self):
        """name -> level of the pins that the chip drives."""
        return self.answered("pin")

    def answered(self, kind):
        """name -> value, from one kind of line in the answer to `pins`: pin, function, spindle."""
        return {words[1]: int(words[2]) for words in map(str.split, self.command("pins"))
                if words[0] == kind}

    def changes(self):
        """(ns, port, driven, high) of each change since the last call."""
        return [(int(words[1]), words[2], int(words[3]), int(words[4]))
                for words in map(str.split, self.command("changes"))]

    def duties(self):
        """(ns, channel, ppm) of each change of the spindle's duty since the last call."""
        return [tuple(map(int, words[1:])) for words in map(str.split, self.command("duties"))]

    def edges_of(self, signal, changes):
        """(ns, level) of each change of one pin, where it is driven. `signal`: its name, or the pin's."""
        name = self.pins.get(signal, signal)
        bit = 1 << int(name[2:])
        edges = []
        for time, port, driven, high in changes:
            if port == name[1] and driven & bit:
                level = 1 if high & bit else 0
                if not edges or edges[-1][1] != level:
                    edges.append((time, level))
        return edges

    def steps(self, changes, axis="X"):
        """Number of rising edges of a step line."""
        edges = self.edges_of(f"{axis} step", changes)
        return sum(1 for (_, before), (_, after) in zip(edges, edges[1:]) if after > before)

    def steps_after_an_underrun(self):
        """The core halts amid a jog and resumes: the messages, and the steps of X Y Z in a jog after it."""
        self.ask("$J=G91 X30 Y30 Z30 F3000")
        self.run(200)
        self.command("core stop")
        self.run(50)
        self.command("core go")
        heard = self.run(200)
        self.send("\x18")
        heard += self.run(50)
        self.ask("$X")
        self.changes()
        self.ask("$J=G91 X1 Y1 Z1 F1200")
        self.wait_for("Idle")
        changes = self.changes()
        return heard, [self.steps(changes, axis) for axis in "XYZ"]

    def drive_registers(self, drive):
        """number or word -> value of what the drive's model holds."""
        return {int(words[2]) if words[2].isdigit() else words[2]: int(words[3])
                for words in map(str.split, self.command("drives")) if int(words[1]) == drive}

    def state(self):
        found = {"violations": []}
        for line in self.command("state"):
            name, _, value = line.partition(" ")
            if name == "violation":
                found["violations"].append(value)
            else:
                found[name] = int(value)
        return found

    def check(self):
        wrong = [text for text in self.state()["violations"]
                 if not any(allowed in text for allowed in self.may_violate)]
        if wrong:
            raise AssertionError("what the reference manual forbids:\n" + "\n".join(wrong))
