# SPDX-License-Identifier: Apache-2.0
# Completion of trim3r in fish. The program itself says which commands and options it has.
function __trim3r_options
    set -l words (commandline -opc)
    $words[1] $words[2] --complete 2>/dev/null | string replace -r '\t[a-z0-9|]*\t' '\t'
end
function __trim3r_values
    set -l words (commandline -opc)
    $words[1] $words[2] --complete 2>/dev/null | string replace -rf -- "^$words[-1]\t([a-z0-9]+\|[a-z0-9|]+)\t.*" '$1' | string split '|'
end
complete -c trim3r -n 'test (count (commandline -opc)) -eq 1' -f -a '(trim3r --commands)'
complete -c trim3r -n 'test (count (commandline -opc)) -gt 1; and string match -q -- "-*" (commandline -ct)' -f -a '(__trim3r_options)'
complete -c trim3r -n 'test (count (commandline -opc)) -gt 2; and __trim3r_values | string length -q' -f -a '(__trim3r_values)'
