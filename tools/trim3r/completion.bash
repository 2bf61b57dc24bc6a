# SPDX-License-Identifier: Apache-2.0
# Completion of trim3r in bash. The program itself says which commands and options it has.
_trim3r() {
    local program=${COMP_WORDS[0]} command=${COMP_WORDS[1]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}
    local IFS=$'\n' name kind about names=() wanted= others= ending head=
    if ((COMP_CWORD == 1)) || { ((COMP_CWORD == 2)) && [[ $command == help ]]; }; then
        while IFS=$'\t' read -r name about; do names+=("$name"); done < <("$program" --commands 2>/dev/null)
        COMPREPLY=($(compgen -W "${names[*]}" -- "$word"))
        return
    fi
    while IFS=$'\t' read -r name kind about; do
        if [[ $name == "$before" ]]; then wanted=$kind; fi
        if [[ $name == '*' ]]; then others=$kind; else names+=("$name"); fi
    done < <("$program" "$command" --complete 2>/dev/null)
    if [[ -z $wanted && $word == -* ]]; then
        COMPREPLY=($(compgen -W "${names[*]}" -- "$word"))
        return
    fi
    wanted=${wanted:-$others} COMPREPLY=()
    if [[ $wanted == files* ]]; then # the words before the last comma stay
        wanted=file${wanted#files}
        if [[ $word == *,* ]]; then head=${word%,*}, word=${word##*,}; fi
    fi
    case $wanted in
    file:*)
        compopt -o filenames 2>/dev/null
        wanted=${wanted#file:}
        for ending in ${wanted//|/$IFS}; do
            if [[ $ending == .* ]]; then COMPREPLY+=($(compgen -P "$head" -f -X "!*$ending" -- "$word"))
            else COMPREPLY+=($(compgen -P "$head" -W "$ending" -- "$word")); fi
        done
        COMPREPLY+=($(compgen -P "$head" -d -- "$word"))
        ;;
    file) compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -P "$head" -f -- "$word")) ;;
    value) ;;
    *) COMPREPLY=($(compgen -W "${wanted//|/$IFS}" -- "$word")) ;;
    esac
}
complete -F _trim3r trim3r
