# Completion of trim3r in fish. The program itself says which commands and options it has.
function __trim3r_options
    set -l words (commandline -opc)
    $words[1] $words[2] --complete 2>/dev/null | string replace -r '\t[a-z]*\t' '\t'
end
complete -c trim3r -n 'test (count (commandline -opc)) -eq 1' -f -a '(trim3r --commands)'
complete -c trim3r -n 'test (count (commandline -opc)) -gt 1; and string match -q -- "-*" (commandline -ct)' -f -a '(__trim3r_options)'
