# SPDX-License-Identifier: Apache-2.0
# Completion of trim3r in fish. The program itself says which commands and options it has.
function __trim3r_rows
    set -l words (commandline -opc)
    $words[1] $words[2] --complete 2>/dev/null
end
function __trim3r_options
    __trim3r_rows | string match -v '\**' | string replace -r '\t[^\t]*\t' '\t'
end
# The kind of the word that is being typed: of the option before it, else of the other arguments.
function __trim3r_kind
    set -l words (commandline -opc)
    set -l kind (__trim3r_rows | string replace -rf -- "^$words[-1]\t([^\t]+)\t.*" '$1')
    test -n "$kind"; or set kind (__trim3r_rows | string replace -rf -- '^\*\t([^\t]+)\t.*' '$1')
    echo $kind
end
function __trim3r_values
    set -l kind (__trim3r_kind)
    set -l word (commandline -ct)
    set -l before ''
    if string match -q 'files*' -- $kind
        # the words before the last comma stay
        set kind (string replace files file -- $kind)
        set before (string replace -r '[^,]*$' '' -- $word)
        set word (string replace -r '.*,' '' -- $word)
    end
    if string match -q 'file:*' -- $kind
        for ending in (string split '|' -- (string replace 'file:' '' -- $kind))
            if string match -q '.*' -- $ending
                complete -C "__fish_command_without_completions $word" | string match -- "*$ending" | string replace -r '^' -- "$before"
            else
                echo $before$ending
            end
        end
        __fish_complete_directories $word | string replace -r '^' -- "$before"
    else if test "$kind" = file
        __fish_complete_path $word | string replace -r '^' -- "$before"
    else if test "$kind" != value
        string split '|' -- $kind
    end
end
complete -c trim3r -f
complete -c trim3r -n 'test (count (commandline -opc)) -eq 1' -a '(trim3r --commands)'
complete -c trim3r -n 'test (count (commandline -opc)) -eq 2; and __fish_seen_subcommand_from help' -a '(trim3r --commands)'
complete -c trim3r -n 'test (count (commandline -opc)) -gt 1; and string match -q -- "-*" (commandline -ct)' -a '(__trim3r_options)'
complete -c trim3r -n 'test (count (commandline -opc)) -gt 1; and not string match -q -- "-*" (commandline -ct)' -a '(__trim3r_values)'
