# SPDX-License-Identifier: Apache-2.0
# Files as constants of C: cmake -DOUTPUT=x.c -DNAMES=a;b -DFILES=a.css;b.js -P embed.cmake
# A zero ends each, so that a text is a string; NAME_bytes counts without it. Files joined by | make one constant. Bytes
# instead of a literal, whose length compilers bound.
set(source "/* Made by the build. */\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
  set(bytes)
  string(REPLACE "|" ";" parts ${file})
  foreach(part ${parts})
    file(READ ${part} more HEX)
    string(APPEND bytes ${more})
  endforeach()
  string(LENGTH "${bytes}" count)
  math(EXPR count "${count} / 2")
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND source "extern const char ${name}[];\nconst char ${name}[] = {${bytes}0};\n"
                       "extern const unsigned ${name}_bytes;\nconst unsigned ${name}_bytes = ${count};\n")
endforeach()
file(WRITE ${OUTPUT} "${source}")
