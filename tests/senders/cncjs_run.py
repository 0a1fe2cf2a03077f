#!/usr/bin/env python3
"""CNCjs's own server against a virtual mill, its whole line tapped.

usage: cncjs_run.py CUSP NODE_MODULES

NODE_MODULES is what `npm i cncjs` made. Exit status: 0 all steps and the tap's counts are right, 1 not.
"""
import os
import pathlib
import subprocess
import sys

from virtual_mill import VirtualMill, free_port, say

HERE = pathlib.Path(__file__).parent
SECRET = "headless"


def main():
    cusp, modules = sys.argv[1], str(pathlib.Path(sys.argv[2]).resolve())
    environment = dict(os.environ, NODE_PATH=modules)
    with VirtualMill(cusp) as mill:
        server_port = str(free_port())
        config = mill.folder / "cncrc"
        config.write_text('{"secret": "' + SECRET + '"}')
        environment["HOME"] = str(mill.folder)
        with open(mill.folder / "cncjs.log", "w", encoding="utf-8") as log:
            server = subprocess.Popen(
                ["node", f"{modules}/cncjs/bin/cncjs", "-H", "127.0.0.1", "-p", server_port, "-c",
                 str(config)], env=environment, stdout=log, stderr=subprocess.STDOUT)
            try:
                client = subprocess.run(
                    ["node", str(HERE / "cncjs_headless.js"), mill.port, server_port, SECRET],
                    env=environment, timeout=420, check=False)
            finally:
                server.terminate()
                server.wait(10)
        if client.returncode != 0:
            say((mill.folder / "cncjs.log").read_text()[-2000:])
        wrong = mill.account.verdict()
        say(mill.account.summary())
        for fault in wrong:
            say(f"tap: {fault}")
    return 0 if client.returncode == 0 and not wrong else 1


if __name__ == "__main__":
    sys.exit(main())
