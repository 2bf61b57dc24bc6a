# SPDX-License-Identifier: Apache-2.0
# Each area of tools/ is a library.

# t3r_area(FOLDER [USES areas...] [LIBS libraries...]): every source in the folder and below as one library. Its headers are found
# as FOLDER/NAME.h by those that use the area and by no other: each area has an include path of its own, with nothing in
# it but a link to the folder. An arrow back therefore doesn't compile.
set(tools_areas)
function(t3r_area folder)
  cmake_parse_arguments(A "" "" "USES;LIBS" ${ARGN})
  string(REPLACE "/" "_" name ${folder})
  set(root ${CMAKE_CURRENT_BINARY_DIR}/areas/${name})
  get_filename_component(parent ${root}/${folder} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)

  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.c)
  list(FILTER sources EXCLUDE REGEX "/main[.]c$|/module/")
  add_library(tools_${name} STATIC ${sources})
  target_include_directories(tools_${name} PUBLIC ${root} PRIVATE ${PROJECT_SOURCE_DIR}/runtime)
  # -ffp-contract=off: doubles become fixed point the same way everywhere
  target_compile_options(tools_${name} PRIVATE -ffp-contract=off)
  string(REPLACE "/" "_" uses "${A_USES}")
  list(TRANSFORM uses PREPEND tools_)
  target_link_libraries(tools_${name} PUBLIC ${uses} ${A_LIBS} m)
  set(tools_areas ${tools_areas} tools_${name} PARENT_SCOPE)
endfunction()

# t3r_with_all_below(RESULT TARGET...): these static libraries and all that they link, except the runtime, whose
# objects come from the shared library.
function(t3r_with_all_below result)
  set(found)
  foreach(target ${ARGN})
    get_target_property(linked ${target} INTERFACE_LINK_LIBRARIES)
    set(below)
    foreach(library ${linked})
      if(TARGET ${library} AND NOT library STREQUAL trim3r_runtime)
        get_target_property(kind ${library} TYPE)
        if(kind STREQUAL STATIC_LIBRARY)
          list(APPEND below ${library})
        endif()
      endif()
    endforeach()
    t3r_with_all_below(deeper ${below})
    list(APPEND found ${target} ${deeper})
  endforeach()
  list(REMOVE_DUPLICATES found)
  set(${result} ${found} PARENT_SCOPE)
endfunction()
