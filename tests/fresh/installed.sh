# Run in a bare root beside the two packages: installs them, makes the first picture, uses the rest.
set -eu
begun=$(date +%s)
apt-get update -qq
apt-get install -y -qq ./cusp_*.deb >/dev/null
cusp demo --out demo
seconds=$(($(date +%s) - begun))
echo "the first picture after $seconds s (goal 60, on an idle machine)"
grep -q '<svg' demo/path.svg
grep -q 'Content-Security-Policy' demo/RUN.html

# The examples, the images and the pages came along.
cusp plan /usr/share/cusp/examples/hull_rough/tap.toml -o tap.ngc
grep -q M30 tap.ngc
for board in mill3_f405 mill3_f405_qemu skr2_f407 octopus_f446 nucleo_f446_cnc_shield pico2_terminals; do
    [ -s /usr/share/cusp/boards/$board/$board.bin ]
    [ -s /usr/share/cusp/boards/$board/README.md ]
done
[ -s /usr/share/cusp/boards/pico2_terminals/pico2_terminals.uf2 ]
for page in cusp cusp-plan cusp-sim cusp-verify cusp-stream; do
    zcat /usr/share/man/man1/$page.1.gz | grep -q '^\.SH NAME'
done
bash -c '. /usr/share/bash-completion/completions/cusp
    COMP_WORDS=(cusp pl) COMP_CWORD=1; _cusp; [ "${COMPREPLY[*]}" = plan ]
    COMP_WORDS=(cusp plan --sta) COMP_CWORD=2; _cusp; [ "${COMPREPLY[*]}" = --stats ]'

# The core, for a board of one's own.
apt-get install -y -qq --no-install-recommends ./cusp-dev_*.deb g++ cmake make lib3mf-dev libfmt-dev libharfbuzz-dev libpugixml-dev libtbb-dev nlohmann-json3-dev >/dev/null
cmake -S cusp/tests/checks/installed -B board >/dev/null
cmake --build board >/dev/null
board/board
board/plan_example /usr/share/cusp/examples/hull_rough/tap.toml 2>/dev/null | grep -q M30

# Python: the package, and the wheel in an environment of its own.
apt-get install -y -qq --no-install-recommends ./python3-cusp_*.deb python3-venv >/dev/null
python3 cusp/tests/fresh/python_example.py /usr/share/cusp/examples
apt-get remove -y -qq python3-cusp >/dev/null
python3 -m venv --system-site-packages environment
environment/bin/pip install -q --no-index --no-deps ./cusp-*.whl
environment/bin/python cusp/tests/fresh/python_example.py /usr/share/cusp/examples
