#!/bin/sh
# Says which sources differ from .clang-format; --fix rewrites them. usage: format.sh TOP [--fix]
top=$1
tool=$(command -v clang-format-14 || command -v clang-format) || {
    echo "format: clang-format is not installed" >&2
    exit 2
}
cd "$top" || exit 2
[ -s .clang-format ] || { echo "format: no .clang-format in $top" >&2; exit 2; }
list=$(find firmware hal boards host_tools tests \( -name '*.hpp' -o -name '*.cpp' \) 2>/dev/null)
[ -n "$list" ] || { echo "format: no sources below $top" >&2; exit 2; }
if [ "$2" = --fix ]; then
    echo "$list" | xargs -n 20 -P "$(nproc)" "$tool" -i
    exit
fi
bad=$(echo "$list" | xargs -n 20 -P "$(nproc)" "$tool" --dry-run 2>&1 | sed -n 's/:\([0-9]*\):.*clang-format-violations.*/:\1/p' | sort -u -t: -k1,1)
[ -z "$bad" ] && exit 0
echo "format: differ from .clang-format (first line of each; tests/checks/format.sh . --fix rewrites):"
echo "$bad"
exit 1
