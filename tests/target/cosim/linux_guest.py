"""A guest in QEMU with Debian's kernel and busybox, whose second serial port and USB port are sockets here.

The guest loads the modules, opens /dev/ttyACM0 and passes bytes between it and its second serial port.
"""
import os
import pathlib
import select
import shutil
import socket
import stat
import subprocess
import time

MODULES = ("usb-common", "usbcore", "xhci-hcd", "xhci-pci", "cdc-acm")
READY = b"ready\n"
INIT = f"""#!/bin/busybox sh
busybox mount -t devtmpfs dev /dev
for module in {" ".join(MODULES)}; do busybox insmod /$module.ko || echo "no module $module"; done
exec 4<>/dev/ttyS1
busybox stty -F /dev/ttyS1 raw -echo 115200
until [ -c /dev/ttyACM0 ]; do busybox sleep 0.1; done
exec 3<>/dev/ttyACM0
busybox stty -F /dev/ttyACM0 raw -echo
busybox cat <&3 >&4 &
busybox cat <&4 >&3 &
echo ready >&4
wait
"""


class Missing(Exception):
    """A program or a package that is not here."""


def find():
    """QEMU, busybox, and kernel and folder of modules: of the machine, or of the packages unpacked at CUSP_GUEST."""
    roots = [pathlib.Path(root) for root in (os.environ.get("CUSP_GUEST"), "/") if root]
    kernels = [kernel for root in roots for kernel in sorted(root.glob("boot/vmlinuz-*-amd64"), reverse=True)
               if "cloud" not in kernel.name]
    boxes = [root / "bin/busybox" for root in roots if (root / "bin/busybox").exists()]
    qemu = shutil.which("qemu-system-x86_64")
    for thing, name in ((qemu, "qemu-system-x86"), (kernels, "linux-image-amd64"), (boxes, "busybox-static")):
        if not thing:
            raise Missing(f"{name} is not installed")
    kernel = kernels[0]
    return qemu, boxes[0], kernel, kernel.parents[1] / "lib/modules" / kernel.name.partition("-")[2]


def archive(files):
    """An initial file system, in cpio's newc format. `files`: name -> (mode, bytes, device)."""
    out = b""
    for number, (name, (mode, data, device)) in enumerate([*files.items(), ("TRAILER!!!", (0, b"", (0, 0)))], 1):
        fields = (number, mode, 0, 0, 1, 0, len(data), 0, 0, *device, len(name) + 1, 0)
        head = b"070701" + "".join(f"{field:08X}" for field in fields).encode() + name.encode() + b"\0"
        out += head + b"\0" * (-len(head) % 4) + data + b"\0" * (-len(data) % 4)
    return out


class Guest:
    """A context manager. `port` sends and `heard` has what came of the guest's second serial port."""

    def __init__(self, folder):
        qemu, box, kernel, modules = find()
        folder = pathlib.Path(folder)
        program = stat.S_IFREG | 0o755
        files = {"dev": (stat.S_IFDIR | 0o755, b"", (0, 0)), "dev/console": (stat.S_IFCHR | 0o600, b"", (5, 1)),
                 "bin": (stat.S_IFDIR | 0o755, b"", (0, 0)), "bin/busybox": (program, box.read_bytes(), (0, 0)),
                 "init": (program, INIT.encode(), (0, 0))}
        for module in MODULES:
            found, = modules.rglob(f"{module}.ko")
            files[f"{module}.ko"] = (program, found.read_bytes(), (0, 0))
        (folder / "initial").write_bytes(archive(files))
        self.console = folder / "console"
        self.plug, port = folder / "plug", folder / "port"
        self.process = subprocess.Popen(
            [qemu, "-accel", "tcg", "-m", "256", "-nodefaults", "-display", "none", "-no-reboot", "-kernel", kernel,
             "-initrd", folder / "initial", "-append", "console=ttyS0 panic=-1", "-serial", f"file:{self.console}",
             "-chardev", f"socket,id=port,path={port},server=on,wait=off", "-serial", "chardev:port", "-device", "qemu-xhci",
             "-chardev", f"socket,id=plug,path={self.plug},server=on,wait=off", "-device", "usb-redir,chardev=plug"])
        self.heard = b""
        self.port = socket.socket(socket.AF_UNIX)
        for _ in range(100):
            if port.exists() and self.plug.exists():
                break
            time.sleep(0.1)
        self.port.connect(str(port))

    def listen(self):
        while select.select([self.port], [], [], 0)[0]:
            more = self.port.recv(1 << 16)
            if not more:
                raise OSError("the guest has ended: " + self.console.read_text(errors="replace")[-500:])
            self.heard += more

    def send(self, data):
        self.port.sendall(data)

    def __enter__(self):
        return self

    def __exit__(self, kind, value, trace):
        self.process.terminate()
        self.process.wait(10)
        self.port.close()
