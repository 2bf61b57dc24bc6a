# SPDX-License-Identifier: Apache-2.0
# Completion of trim3r in bash. The program itself says which commands and options it has.
_trim3r() {
    local program=${COMP_WORDS[0]} command=${COMP_WORDS[1]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}
    local IFS=$'\n' name kind about names=() wanted=
    if ((COMP_CWORD == 1)); then
        while IFS=$'\t' read -r name about; do names+=("$name"); done < <("$program" --commands 2>/dev/null)
        COMPREPLY=($(compgen -W "${names[*]}" -- "$word"))
        return
    fi
    while IFS=$'\t' read -r name kind about; do
        names+=("$name")
        if [[ $name == "$before" ]]; then wanted=$kind; fi
    done < <("$program" "$command" --complete 2>/dev/null)
    case $wanted in
    file) compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -f -- "$word")) ;;
    value) COMPREPLY=() ;;
    *'|'*) COMPREPLY=($(compgen -W "${wanted//|/$IFS}" -- "$word")) ;;
    *)
        if [[ $word == -* ]]; then
            COMPREPLY=($(compgen -W "${names[*]}" -- "$word"))
        else
            compopt -o filenames 2>/dev/null
            COMPREPLY=($(compgen -f -- "$word"))
        fi
        ;;
    esac
}
complete -F _trim3r trim3r
