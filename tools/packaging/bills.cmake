# SPDX-License-Identifier: Apache-2.0
# Bills of materials, one a package, as SPDX 2.3: what the package is, the heads in it, and the libraries that its files
# load. CMAKE_READELF tells which those are; versions are those that the configuration found.
if(NOT CMAKE_READELF)
  message(STATUS "No bills of materials: they need readelf")
  return()
endif()

# FILE|NAME|VERSION of each library that may be loaded
set(known "libtrim3r|trim3r|${PROJECT_VERSION}")
foreach(found CJSON JPEG LZ4 OPENEXR PNG T3R_LIBCAMERA_LIB WEBP ZIP ZLIB ZSTD)
  foreach(library ${${found}_LIBRARIES})
    list(APPEND known "lib${library}|${${found}_MODULE_NAME}|${${found}_VERSION}")
  endforeach()
endforeach()
if(T3R_OPENCV_INCLUDE)
  file(STRINGS ${T3R_OPENCV_INCLUDE}/opencv2/core/version.hpp numbers REGEX "#define CV_VERSION_(MAJOR|MINOR|REVISION) ")
  list(TRANSFORM numbers REPLACE "^.* " "")
  list(JOIN numbers "." version)
  foreach(part core videoio features2d calib3d)
    list(APPEND known "libopencv_${part}|opencv|${version}")
  endforeach()
endif()
execute_process(COMMAND ${CMAKE_C_COMPILER} -E -dM -include stdlib.h -x c /dev/null OUTPUT_VARIABLE macros ERROR_QUIET)
if(macros MATCHES "#define __GLIBC__ ([0-9]+)")
  set(version ${CMAKE_MATCH_1})
  string(REGEX MATCH "#define __GLIBC_MINOR__ ([0-9]+)" minor "${macros}")
  string(APPEND version .${CMAKE_MATCH_1})
  list(APPEND known "libc|glibc|${version}" "libm|glibc|${version}")
endif()
if(CMAKE_C_COMPILER_ID STREQUAL GNU) # the libraries of its C++
  foreach(library libstdc++ libgcc_s)
    list(APPEND known "${library}|gcc|${CMAKE_C_COMPILER_VERSION}")
  endforeach()
endif()

# t3r_bill(COMPONENT PACKAGE [HEADS heads...] [TARGETS targets...] [NEEDS names...]): share/sbom/PACKAGE.spdx.json.
# NEEDS: besides the libraries that the targets load. Packages contain the
# runtime, except those of the host library and of modules.
set(bills)
function(t3r_bill component package)
  cmake_parse_arguments(B "" "" "HEADS;TARGETS;NEEDS" ${ARGN})
  set(files)
  foreach(target ${B_TARGETS})
    list(APPEND files $<TARGET_FILE:${target}>)
  endforeach()
  set(heads ${B_HEADS})
  list(TRANSFORM heads REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/quant/heads/\\1.c")
  set(bill ${CMAKE_CURRENT_BINARY_DIR}/${package}.spdx.json)
  add_custom_command(
    OUTPUT ${bill}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${bill} -DPACKAGE=${package} -DCOMPONENT=${component} -DVERSION=${PROJECT_VERSION}
            "-DFILES=${files}" "-DHEADS=${heads}" "-DNEEDS=${B_NEEDS}" "-DKNOWN=${known}" -DREADELF=${CMAKE_READELF}
            -P ${CMAKE_CURRENT_SOURCE_DIR}/write_bill.cmake
    DEPENDS ${B_TARGETS} ${heads} write_bill.cmake
    VERBATIM)
  install(FILES ${bill} DESTINATION ${CMAKE_INSTALL_DATADIR}/sbom COMPONENT ${component})
  set(bills ${bills} ${bill} PARENT_SCOPE)
endfunction()

set(heads tiny small)
t3r_bill(dev libtrim3r-dev HEADS ${heads} TARGETS trim3r_runtime trim3r_heads)
if(TARGET trim3r_shared)
  t3r_bill(shared ${shared_package} TARGETS trim3r_shared)
endif()
if(TARGET trim3r_host)
  t3r_bill(host_dev libtrim3r-host-dev TARGETS trim3r_host)
endif()
if(TARGET trim3r_host_shared)
  t3r_bill(host ${host_package} TARGETS trim3r_host_shared)
endif()
if(TARGET trim3r)
  if(HEIF_FOUND)
    set(loaded_later libheif)
  endif()
  t3r_bill(program trim3r HEADS ${heads} TARGETS trim3r NEEDS ${loaded_later})
endif()
foreach(component ${module_components})
  get_property(modules GLOBAL PROPERTY T3R_MODULES_OF_${component})
  t3r_bill(${component} trim3r-${component} TARGETS ${modules})
endforeach()
if(TARGET trim3r_python)
  t3r_bill(python python3-trim3r HEADS ${heads} TARGETS trim3r_python NEEDS python3 cffi numpy)
endif()
add_custom_target(trim3r_bills ALL DEPENDS ${bills})
