#!/bin/sh
# The packages have what a user expects, and lintian finds no error in them.
# usage: lint.sh FOLDER-OF-PACKAGES
set -eu
cd "$1"
lintian --allow-root --fail-on error --no-tag-display-limit cusp*.deb
for file in usr/bin/cusp usr/share/man/man1/cusp.1.gz usr/share/cusp/examples/demo/pocket.toml \
    usr/share/cusp/boards/mill3_f405/mill3_f405.bin usr/share/bash-completion/completions/cusp \
    usr/share/doc/cusp/docs/job_file.md; do
    dpkg-deb -c cusp_*.deb | grep -q " \./$file\$" || { echo "lint: $file is not in the package"; exit 1; }
done
