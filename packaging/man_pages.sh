#!/bin/sh
# Makes cusp.1 and a page of each command from --help.
# usage: man_pages.sh CUSP HELP2MAN VERSION FOLDER
set -eu
cusp=$1 help2man=$2 version=$3 folder=$4
mkdir -p "$folder"

# page NAME DESCRIPTION COMMAND...
page() {
    name=$1
    description=$2
    shift 2
    printf '#!/bin/sh\nexec %s "$@"\n' "$*" >"$folder/$name"
    chmod +x "$folder/$name"
    "$help2man" --no-info --no-discard-stderr --section=1 --manual="User Commands" --source="cusp $version" \
        --version-string="$version" --name="$description" -o "$folder/$name.1" "$folder/$name"
    rm "$folder/$name"
    gzip -9nf "$folder/$name.1"
}

page cusp "CNC tool paths, simulation and streaming" "$cusp"
# "  plan      plan the operations of a job" in the list of subcommands
"$cusp" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\{1,\}\) \{2,\}\(.*\)/\1 \2/p' |
    while read -r command description; do
        page "cusp-$command" "$description" "$cusp $command"
    done
