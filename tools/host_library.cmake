# SPDX-License-Identifier: Apache-2.0
# The host library: what trim3r_host.h and trim3r_capture.h declare, out of platform/ and the areas of scenes. All of its
# code is one object, in which only these names are visible: it clashes with no name of a program.
set(host_headers trim3r_host.h trim3r_capture.h trim3r_program.h)
set(host_names)
file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/host_headers)
foreach(header ${host_headers})
  set(path ${PROJECT_SOURCE_DIR}/platform/${header})
  file(CREATE_LINK ${path} ${CMAKE_CURRENT_BINARY_DIR}/host_headers/${header} SYMBOLIC)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
  file(STRINGS ${path} lines REGEX "^[a-z].*[ *]t3r_[a-z0-9_]+\\(")
  list(FILTER lines EXCLUDE REGEX "^(static|typedef) |^ *$")
  list(TRANSFORM lines REPLACE "^[^(]*[ *](t3r_[a-z0-9_]+)\\(.*" "\\1")
  list(APPEND host_names ${lines})
endforeach()

if(NOT CMAKE_OBJCOPY)
  message(FATAL_ERROR "The host library needs objcopy (Debian: binutils); -DT3R_TOOLS=OFF goes without")
endif()
t3r_with_all_below(parts tools_scene tools_geometry)
if(T3R_SHARED)
  set_target_properties(${parts} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endif()
list(TRANSFORM host_names PREPEND "-Wl,-u," OUTPUT_VARIABLE wanted)
list(TRANSFORM host_names PREPEND "--keep-global-symbol=" OUTPUT_VARIABLE kept)
list(TRANSFORM parts REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE archives)
# what scenes use of the runtime and trim3r.h does not declare
set(inside "$<FILTER:$<TARGET_OBJECTS:trim3r_runtime>,INCLUDE,/(api/checks|core/scene_frame|core/camera|core/fixed)[.]c>")
set(object ${CMAKE_CURRENT_BINARY_DIR}/trim3r_host.o)
separate_arguments(flags NATIVE_COMMAND "${CMAKE_C_FLAGS}")
add_custom_command(
  OUTPUT ${object}
  COMMAND ${CMAKE_C_COMPILER} ${flags} -r -nostdlib ${wanted} ${inside} -Wl,--start-group ${archives} -Wl,--end-group
          -o ${object}
  COMMAND ${CMAKE_OBJCOPY} ${kept} ${object}
  DEPENDS ${parts} trim3r_runtime
  COMMAND_EXPAND_LISTS VERBATIM)
add_custom_target(trim3r_host_object DEPENDS ${object})

set(host_libraries PkgConfig::CJSON PkgConfig::LZ4 PkgConfig::ZIP PkgConfig::ZLIB PkgConfig::ZSTD ${T3R_ADAPTER_LIBS})
if(WEBP_FOUND)
  list(APPEND host_libraries PkgConfig::WEBP)
endif()

# t3r_host(NAME KIND RUNTIME): the library of that kind.
function(t3r_host name kind runtime)
  add_library(${name} ${kind} ${object})
  add_dependencies(${name} trim3r_host_object)
  set_target_properties(${name} PROPERTIES OUTPUT_NAME trim3r_host LINKER_LANGUAGE C)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}/host_headers>
                                            $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${name} PUBLIC ${runtime} PRIVATE ${host_libraries} Threads::Threads ${CMAKE_DL_LIBS} m)
endfunction()
set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
t3r_host(trim3r_host STATIC trim3r_runtime)
add_library(trim3r::host ALIAS trim3r_host)
if(T3R_SHARED)
  t3r_host(trim3r_host_shared SHARED trim3r_shared)
  set_target_properties(trim3r_host_shared PROPERTIES VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  target_link_options(trim3r_host_shared PRIVATE -Wl,--as-needed -Wl,--no-undefined)
  add_library(trim3r::host_shared ALIAS trim3r_host_shared)
endif()
