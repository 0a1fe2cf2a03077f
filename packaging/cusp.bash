# Completion of cusp's commands and options in bash, read from --help, so that it never lags behind the program.

_cusp_options() { "$@" --help 2>/dev/null | grep -oE '^ +-[-a-zA-Z,]+' | tr ', ' '\n\n' | grep '^-'; }

_cusp_commands() { cusp --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p'; }

# What the files are that an argument of COMMAND may name, as a pattern of endings.
_cusp_endings() {
    case $1 in
    plan) echo 'toml|json|step|stp|iges|igs|brep|brp|stl|obj|3mf|dxf|svg|gbr|ger|gtl|gbl|gko|gm1|drl|xln|STEP|STP|IGES|IGS|STL|DXF|SVG' ;;
    info) echo 'json|step|stp|iges|igs|brep|brp|stl|obj|3mf|dxf|svg|gbr|ger|gtl|gbl|gko|gm1|drl|xln|STEP|STP|IGES|IGS|STL|DXF|SVG' ;;
    verify | view) echo 'toml|ngc|nc|gcode|tap' ;;
    sim | fit | stream) echo 'ngc|nc|gcode|tap' ;;
    *) echo '.*' ;;
    esac
}

_cusp() {
    local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} name
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_cusp_commands) $(_cusp_options cusp)" -- "$word")
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_cusp_options cusp "$command")" -- "$word")
    else
        compopt -o filenames 2>/dev/null
        while IFS= read -r name; do
            if [ -d "$name" ] || [[ $command == stream || $name =~ \.($(_cusp_endings "$command"))$ ]]; then
                COMPREPLY+=("$name")
            fi
        done < <(compgen -f -- "$word")
    fi
}

complete -F _cusp cusp
