#!/bin/sh
# Makes the index of the public headers; fails on any warning of Doxygen.
# usage: docs/api.sh [FOLDER]    (out/api; open FOLDER/html/index.html)
set -eu
folder=$(mkdir -p "${1:-out/api}" && cd "${1:-out/api}" && pwd)
cd "$(dirname "$0")/.."
command -v doxygen >/dev/null || {
    echo "docs/api.sh: doxygen is missing (apt-get install doxygen)" >&2
    exit 2
}
headers=$(mktemp -d)
trap 'rm -rf "$headers"' EXIT
python3 docs/api_filter.py . "$headers"
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $folder"; } >"$headers/Doxyfile"
if ! (cd "$headers" && doxygen Doxyfile) >"$headers/said" 2>&1; then
    sed "s|$headers/||" "$headers/said" >&2
    exit 1
fi
echo "$folder/html/index.html: $(find "$folder/html" -name '*.html' | wc -l) pages"
