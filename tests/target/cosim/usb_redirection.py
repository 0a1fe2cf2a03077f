"""The plug of a board in the co-simulation, as QEMU's `-device usb-redir` wants it: the protocol usbredir 0.7.

Control transfers go whole, as the host model makes them; of the other endpoints each packet. Addresses are QEMU's own matter.
"""
import collections
import select
import socket
import struct

HELLO, CONNECT, RESET, INTERFACES, ENDPOINTS = 0, 1, 3, 4, 5
SET_CONFIGURATION, GET_CONFIGURATION, CONFIGURATION, SET_ALTERNATE, GET_ALTERNATE, ALTERNATE = 6, 7, 8, 9, 10, 11
START_INTERRUPTS, STOP_INTERRUPTS, INTERRUPTS, CANCEL, DISCONNECT_ACK = 15, 16, 17, 21, 24
CONTROL, BULK, INTERRUPT = 100, 101, 103
# What QEMU's controller wants: versions of the device, endpoints with the size of their packets, numbers of requests of 64 bits,
# but for that of the first message, lengths of bulk transfers of 32.
CAPABILITIES = 1 << 1 | 1 << 4 | 1 << 5 | 1 << 6
SHORT_HEAD, HEAD = "<III", "<IIQ"
DONE, CANCELLED, FAILED, STALLED = 0, 1, 3, 4
STATUS = {"ack": DONE, "stall": STALLED, "late": FAILED, "none": FAILED}
FULL_SPEED, NO_ENDPOINT = 1, 255
PACKET, MOST = 64, 32


class Redirection:
    """`plug`: a usb.Usb that is plugged in. The socket is that of QEMU's character device."""

    def __init__(self, plug, path):
        self.plug = plug
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(str(path))
        self.heard = b""
        self.head = SHORT_HEAD
        self.given = collections.deque()  # (id, endpoint, bytes still to go, length)
        self.fetching = {}  # endpoint -> deque of [id, length, bytes so far]
        self.reports = None  # the endpoint whose interrupt packets are asked for, and the next one's number
        self.count = collections.Counter()  # of bytes and requests: that there was something to judge
        self.requests = {CONTROL: self.control, BULK: self.bulk, RESET: self.reset, SET_CONFIGURATION: self.configure,
                         GET_CONFIGURATION: self.tell_configuration, SET_ALTERNATE: self.alternate, GET_ALTERNATE: self.alternate,
                         START_INTERRUPTS: self.interrupts, STOP_INTERRUPTS: self.interrupts, CANCEL: self.cancel}
        self.send(HELLO, 0, b"co-simulation".ljust(64, b"\0") + struct.pack("<I", CAPABILITIES))

    def send(self, kind, number, body):
        self.socket.sendall(struct.pack(self.head, kind, len(body), number) + body)

    def connect(self):
        self.tell_interfaces()
        device = self.plug.device
        vendor, product, version = struct.unpack("<HHH", device[8:14])
        self.send(CONNECT, 0, struct.pack("<BBBBHHH", FULL_SPEED, *device[4:7], vendor, product, version))

    def tell_interfaces(self):
        interfaces = [piece for piece in self.plug.pieces() if piece[1] == 4]
        columns = [[piece[place] for piece in interfaces] for place in (2, 5, 6, 7)]
        self.send(INTERFACES, 0, struct.pack("<I", len(interfaces)) +
                  b"".join(bytes(column).ljust(MOST, b"\0") for column in columns))
        kinds, intervals, owners, sizes = [NO_ENDPOINT] * MOST, [0] * MOST, [0] * MOST, [0] * MOST
        kinds[0] = kinds[16] = 0
        sizes[0] = sizes[16] = PACKET
        owner = 0
        for piece in self.plug.pieces():
            owner = piece[2] if piece[1] == 4 else owner
            if piece[1] == 5:
                place = (piece[2] & 0x80) >> 3 | piece[2] & 15
                kinds[place], owners[place], intervals[place] = piece[3] & 3, owner, piece[6]
                sizes[place] = struct.unpack("<H", piece[4:6])[0]
        self.send(ENDPOINTS, 0, bytes(kinds) + bytes(intervals) + bytes(owners) + struct.pack("<32H", *sizes))

    def reset(self, number, body):
        self.count["resets"] += 1
        self.plug.command("plug")
        self.plug.chip.run(10)
        self.plug.command("address 0")
        self.plug.ask(0x00, 5, 7)
        self.plug.command("address 7")

    def configure(self, number, body):
        stage, _ = self.plug.raw(0x00, 9, body[0])
        self.tell_interfaces()
        self.send(CONFIGURATION, number, bytes((STATUS[stage], body[0])))

    def tell_configuration(self, number, body):
        stage, answer = self.plug.raw(0x80, 8, length=1)
        self.send(CONFIGURATION, number, bytes((STATUS[stage], answer[0] if answer else 0)))

    def alternate(self, number, body):
        stage, _ = self.plug.raw(0x01, 11, body[1], body[0]) if len(body) > 1 else self.plug.raw(0x81, 10, 0, body[0], 1)
        self.send(ALTERNATE, number, bytes((STATUS[stage], body[0], body[1] if len(body) > 1 else 0)))

    def control(self, number, body):
        self.count["requests"] += 1
        endpoint, request, kind, _, value, index, length = struct.unpack("<BBBBHHH", body[:10])
        stage, answer = self.plug.raw(kind, request, value, index, length, body[10:])
        moved = len(answer) if kind & 0x80 else length
        self.send(CONTROL, number, struct.pack("<BBBBHHH", endpoint, request, kind, STATUS[stage], value, index, moved) + answer)

    def bulk(self, number, body):
        endpoint, _, length, _, high = struct.unpack("<BBHIH", body[:10])
        length |= high << 16
        if endpoint & 0x80:
            self.fetching.setdefault(endpoint, collections.deque()).append([number, length, b""])
        else:
            self.given.append((number, endpoint, body[10:], length))

    def interrupts(self, number, body):
        self.reports = None if self.reports else [body[0], 0]
        self.send(INTERRUPTS, number, bytes((DONE, body[0])))

    def cancel(self, number, body):
        for endpoint, waiting in self.fetching.items():
            for transfer in [transfer for transfer in waiting if transfer[0] == number]:
                waiting.remove(transfer)
                self.end_bulk(number, endpoint, CANCELLED, 0, b"")
        for transfer in [transfer for transfer in self.given if transfer[0] == number]:
            self.given.remove(transfer)
            self.end_bulk(number, transfer[1], CANCELLED, 0, b"")

    def end_bulk(self, number, endpoint, status, length, data):
        self.send(BULK, number, struct.pack("<BBHIH", endpoint, status, length & 0xFFFF, 0, length >> 16) + data)

    def packet(self, text):
        words = self.plug.command(text)[-1].split(" ")
        return words[1], bytes.fromhex(words[2])

    def give(self):
        """Packets to the device, until it takes none."""
        while self.given:
            number, endpoint, rest, length = self.given[0]
            stage, _ = self.packet(f"give {endpoint} {rest[:PACKET].hex()}")
            if stage == "late":
                return
            self.given.popleft()
            if stage == "ack" and len(rest) > PACKET:
                self.given.appendleft((number, endpoint, rest[PACKET:], length))
                continue
            self.count["to the device"] += length if stage == "ack" else 0
            self.end_bulk(number, endpoint, STATUS[stage], length if stage == "ack" else 0, b"")

    def fetch(self):
        """Packets of the device, as long as someone waits for them: a transfer ends with a short one."""
        for endpoint, waiting in self.fetching.items():
            while waiting:
                number, length, so_far = waiting[0]
                stage, data = self.packet(f"fetch {endpoint & 15}")
                if stage == "late":
                    break
                waiting[0][2] = so_far = so_far + data
                if stage != "ack" or len(data) < PACKET or len(so_far) >= length:
                    waiting.popleft()
                    self.count["to the host"] += len(so_far)
                    self.end_bulk(number, endpoint, STATUS[stage], len(so_far), so_far)
        if self.reports:
            endpoint, number = self.reports
            stage, data = self.packet(f"fetch {endpoint & 15}")
            if stage == "ack":
                self.reports[1] += 1
                self.send(INTERRUPT, number, struct.pack("<BBH", endpoint, DONE, len(data)) + data)

    def serve(self, seconds):
        """What QEMU has asked for, and packets both ways; waits so long for a question."""
        while select.select([self.socket], [], [], seconds)[0]:
            more = self.socket.recv(1 << 16)
            if not more:
                raise OSError("QEMU has closed the redirection")
            self.heard += more
            seconds = 0
            self.take()
        self.give()
        self.fetch()

    def take(self):
        while len(self.heard) >= struct.calcsize(self.head):
            size = struct.calcsize(self.head)
            kind, length, number = struct.unpack(self.head, self.heard[:size])
            if len(self.heard) < size + length:
                return
            body, self.heard = self.heard[size:size + length], self.heard[size + length:]
            if kind == HELLO:
                self.head = HEAD
                self.connect()
            elif kind in self.requests:
                self.requests[kind](number, body)
            elif kind != DISCONNECT_ACK:
                raise OSError(f"QEMU asks for what no serial port has, message {kind}")
