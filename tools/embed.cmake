# Text files as constants of C: cmake -DOUTPUT=x.c -DNAMES=a;b -DFILES=a.css;b.js -P embed.cmake
# A zero ends each, so that it is a string; bytes instead of a literal, whose length compilers bound.
set(source "/* Made by the build. */\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(APPEND source "extern const char ${name}[];\nconst char ${name}[] = {${bytes}0};\n")
endforeach()
file(WRITE ${OUTPUT} "${source}")
