#compdef trim3r
# SPDX-License-Identifier: Apache-2.0
# Completion of trim3r in zsh. The program itself says which commands and options it has.
_trim3r() {
    local -a rows names
    local row name kind about wanted others
    if ((CURRENT == 2)) || [[ $CURRENT == 3 && $words[2] == help ]]; then
        for row in ${(f)"$($words[1] --commands 2>/dev/null)"}; do names+=("${row//$'\t'/:}"); done
        _describe command names
        return
    fi
    for row in ${(f)"$($words[1] $words[2] --complete 2>/dev/null)"}; do
        rows=("${(@ps:\t:)row}")
        if [[ $rows[1] == $words[CURRENT-1] ]]; then wanted=$rows[2]; fi
        if [[ $rows[1] == '*' ]]; then others=$rows[2]; else names+=("$rows[1]:$rows[3]"); fi
    done
    if [[ -z $wanted && $words[CURRENT] == -* ]]; then
        _describe option names
        return
    fi
    wanted=${wanted:-$others}
    if [[ $wanted == files* ]]; then # the words before the last comma stay
        wanted=file${wanted#files}
        compset -P '*,'
    fi
    case $wanted in
    file:*)
        rows=("${(@s:|:)wanted#file:}")
        compadd -- ${rows:#.*}
        _files -g "*${(j: *:)${(M)rows:#.*}}"
        ;;
    file) _files ;;
    value) _message value ;;
    *) compadd -- "${(@s:|:)wanted}" ;;
    esac
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _trim3r "$@"; else compdef _trim3r trim3r; fi
