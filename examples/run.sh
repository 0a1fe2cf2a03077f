#!/bin/sh
# Plans an example, cuts it in memory and draws it: examples/run.sh grid_pocket/rectangle
# Without a name: all of them, one after the other.
# G-code, figures and pictures go to out/examples/<name>. Needs build/release/bin/cusp (demo.sh builds it).
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)
if [ $# -eq 0 ]; then
    for job in "$top"/examples/*/*.toml; do
        name=${job#"$top/examples/"}
        echo "== ${name%.toml}"
        "$0" "${name%.toml}"
    done
    exit
fi
name=$1
cusp=$top/build/release/bin/cusp
out=$top/out/examples/$name
mkdir -p "$out"
"$cusp" plan "$top/examples/$name.toml" -o "$out/program.ngc" --stats "$out/plan.json"
"$cusp" verify "$top/examples/$name.toml" "$out/program.ngc" --stats "$out/verify.json" \
    --path-picture "$out/path.svg" --left-picture "$out/left.svg"
echo "in $out: program.ngc plan.json verify.json path.svg left.svg"
