#!/bin/sh
# Plans a sculptured pocket, runs its G-code through the controller's own core, cuts it in memory,
# and leaves G-code, traces, figures and pictures in out/demo. Installs what is missing.
set -eu
cd "$(dirname "$0")"
. ./.ci/packages.sh

install_packages $host_packages

out=out/demo
job=examples/demo/pocket.toml
cusp=build/release/bin/cusp
mkdir -p build "$out"

echo "building"
{ cmake --preset release -DCUSP_TARGET_TESTS=OFF &&
    cmake --build --preset release --target cusp; } >build/demo.log 2>&1 || {
    tail -40 build/demo.log
    echo "demo: the build failed" >&2
    exit 1
}

$cusp plan "$job" -o "$out/pocket.ngc" --stats "$out/plan.json"
$cusp sim "$out/pocket.ngc" --vcd "$out/pocket.vcd" --samples "$out/samples.csv" --stats "$out/sim.json"
wrong=0
$cusp verify "$job" "$out/pocket.ngc" --stats "$out/verify.json" --path-picture "$out/path.svg" \
    --left-picture "$out/left.svg" >"$out/verify.txt" || wrong=$?
[ "$wrong" -le 1 ] || { cat "$out/verify.txt"; exit "$wrong"; }

# of FILE KEY: the number that follows the key, the first time it does
of() { sed -n "s/.*\"$2\": *\(-\{0,1\}[0-9.e+-]*\).*/\1/p" "$out/$1.json" | head -1; }
show() { printf '  %-22s %s\n' "$1" "$2"; }
minutes=$(of sim duration_s | awk '{ printf "%d min %02d s", $1 / 60, $1 % 60 }')
fixed() { of "$1" "$2" | awk -v decimals="$3" '{ printf "%.*f", decimals, $1 }'; }

echo
echo "Pocket with a curved floor and an island, ball end mill 12 mm, $(fixed plan cut_length_mm 0) mm of cut"
show "time on the machine" "$minutes"
show "cutting / rapid" "$(fixed verify cut_length_mm 0) mm / $(fixed verify rapid_length_mm 0) mm"
show "retracts" "$(of plan retracts)"
show "gouge, floor" "$(fixed verify ball_gouge_max_mm 4) mm (allowed 0.02)"
show "gouge, walls" "$(fixed verify wall_gouge_max_mm 4) mm (allowed 0.02)"
show "scallop, 99 % / most" "$(fixed verify scallop_p99_mm 3) mm / $(fixed verify scallop_max_mm 3) mm (allowed 0.4)"
show "rapids through metal" "$(fixed verify rapid_cut_max_mm 4) mm"
show "steps" "$(sed -n '/"steps"/,/]/p' "$out/sim.json" | tr -d '\n' | sed 's/.*\[\([^]]*\)\].*/\1/' | tr -s ' ')"
show "planned in" "$(fixed plan planning_s 2) s"
echo
echo "In $out: pocket.ngc (G-code), pocket.vcd (pulses, for GTKWave), samples.csv (set points),"
echo "plan.json sim.json verify.json (figures), path.svg left.svg (pictures)"
if [ "$wrong" -ne 0 ]; then
    grep '^broken' "$out/verify.txt"
    exit "$wrong"
fi
