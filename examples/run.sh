#!/bin/sh
# Plans an example, cuts it in memory and draws it: examples/run.sh grid_pocket/rectangle
# G-code, figures and pictures go to out/examples/<name>. Needs build/release/bin/cusp (demo.sh builds it).
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)
name=${1:?name an example, such as hull_rough/tap}
cusp=$top/build/release/bin/cusp
out=$top/out/examples/$name
mkdir -p "$out"
"$cusp" plan "$top/examples/$name.toml" -o "$out/program.ngc" --stats "$out/plan.json"
"$cusp" verify "$top/examples/$name.toml" "$out/program.ngc" --stats "$out/verify.json" \
    --path-picture "$out/path.svg" --left-picture "$out/left.svg"
echo "in $out: program.ngc plan.json verify.json path.svg left.svg"
