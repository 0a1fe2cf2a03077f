#!/usr/bin/env python3
"""Packs cusp-core, installs the tarball in an empty folder, and runs its tests there under node.

usage: npm_package.py --modules NODE_MODULES --core CORE.wasm
Exit status: 0 all pass, 1 not.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCES = HERE.parents[1] / "host_tools/judge/view/npm"


def call(*words, folder):
    # Nothing is fetched: the package has no dependencies.
    environment = {**os.environ, "npm_config_offline": "true", "npm_config_update_notifier": "false"}
    subprocess.run([str(w) for w in words], cwd=folder, check=True, env=environment)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--modules", required=True)
    parser.add_argument("--core", required=True)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        user = folder / "user"
        user.mkdir()
        try:
            call("node", SOURCES / "build.mjs", "--out", folder / "package", "--core", options.core, "--modules",
                 options.modules, folder=folder)
            call("npm", "pack", "--ignore-scripts", "--pack-destination", folder, folder=folder / "package")
            tarball, = folder.glob("cusp-core-*.tgz")
            call("npm", "install", "--no-audit", "--no-fund", "--prefix", user, tarball, folder=user)
            shutil.copy(HERE / "package.test.mjs", user)
            call("node", "--test", "package.test.mjs", folder=user)
        except subprocess.CalledProcessError as failed:
            print(f"npm_package: {failed}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
