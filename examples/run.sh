#!/bin/sh
# Plans an example, cuts it in memory and draws it: examples/run.sh grid_pocket/rectangle
# Without a name: all of them, one after the other.
# G-code, figures and pictures go to out/examples/<name>. Needs the preset release, built.
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
rm -f "$out"/program*.ngc
"$cusp" plan "$top/examples/$name.toml" -o "$out/program.ngc" --stats "$out/plan.json"
after=
# a program for each set-up, in the order in which they were written
for program in $(ls -tr "$out"/program*.ngc); do
    of=$(basename "$program" .ngc | sed s/program//)
    "$cusp" verify "$top/examples/$name.toml" "$program" ${after:+--after $after} --stats "$out/verify$of.json" \
        --path-picture "$out/path$of.svg" --left-picture "$out/left$of.svg" --engagement-picture "$out/engagement$of.svg"
    after="$after $program"
done
echo "in $out: program.ngc plan.json verify.json path.svg left.svg engagement.svg, of each set-up"
