# SPDX-License-Identifier: Apache-2.0
# Pages for man(1), of the texts that help prints: cmake -DPROGRAM=trim3r -DFOLDER=man1 -P man_pages.cmake
cmake_minimum_required(VERSION 3.25)

function(said variable)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_VARIABLE text OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

# Help as it stands, without filling: headings become sections, and options are bold.
function(write_page name summary others)
  said(help ${ARGN} --help)
  string(REPLACE "\\" "\\e" help "${help}")
  string(REPLACE "-" "\\-" help "${help}")
  string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" help "${help}")
  string(REGEX REPLACE "\n( +)((\\\\-[a-z?], )?\\\\-\\\\-[^ =[]+)" "\n\\1\\\\fB\\2\\\\fR" help "${help}")
  string(REGEX REPLACE "\n?\n ([A-Z][^\n]*):\n" "\n.fi\n.SS \\1\n.nf\n" help "${help}")
  string(REGEX REPLACE "\n?\nExamples:\n" "\n.fi\n.SH EXAMPLES\n.nf\n" help "${help}")
  string(REGEX MATCH "^Usage:[^\n]*\n(  or:[^\n]*\n)*" usage "${help}")
  string(LENGTH "${usage}" usage_length)
  string(SUBSTRING "${help}" ${usage_length} -1 help)
  string(REGEX REPLACE "(Usage:|  or: ) " "" usage "${usage}")
  string(TIMESTAMP date "%Y-%m-%d" UTC) # SOURCE_DATE_EPOCH, where it is set
  string(REPLACE "-" "\\-" title "${name}")
  file(WRITE ${FOLDER}/${name}.1 ".TH \"${title}\" 1 \"${date}\" \"${version}\" trim3r
.SH NAME
${title} \\- ${summary}
.SH SYNOPSIS
.nf
${usage}.fi
.SH DESCRIPTION
.nf
${help}
.fi
.SH \"EXIT STATUS\"
0 done, 1 bad input or a difference that was found, 2 bad usage, 3 the budget or the arena is too small
.SH \"SEE ALSO\"
${others}
")
endfunction()

said(version --version)
said(listed --commands)
string(REGEX MATCHALL "[^\n\t]+\t[^\n]+" rows "${listed}")
foreach(row ${rows})
  string(REGEX MATCH "^([^\t]+)\t(.*)" row "${row}")
  set(command ${CMAKE_MATCH_1})
  string(REPLACE "-" "\\-" page trim3r-${command})
  string(APPEND pages ".BR ${page} (1)\n")
  write_page(trim3r-${command} "${CMAKE_MATCH_2}" ".BR trim3r (1)" ${command})
endforeach()
write_page(trim3r "turn a few camera frames into a budgeted set of 3\\-D Gaussians" "${pages}")
