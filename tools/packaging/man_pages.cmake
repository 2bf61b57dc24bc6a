# SPDX-License-Identifier: Apache-2.0
# Pages for man(1), of the texts that help prints: cmake -DPROGRAM=trim3r -DFOLDER=man1 -P man_pages.cmake
file(MAKE_DIRECTORY ${FOLDER})
execute_process(COMMAND ${PROGRAM} --commands OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n\t]+\t[^\n]+" rows "${listed}")
execute_process(COMMAND ${PROGRAM} --man-page OUTPUT_FILE ${FOLDER}/trim3r.1 COMMAND_ERROR_IS_FATAL ANY)
foreach(row ${rows})
  string(REGEX REPLACE "\t.*" "" command "${row}")
  execute_process(COMMAND ${PROGRAM} ${command} --man-page OUTPUT_FILE ${FOLDER}/trim3r-${command}.1
    COMMAND_ERROR_IS_FATAL ANY)
endforeach()
