# SPDX-License-Identifier: Apache-2.0
# The page of `trim3r view`, and in it two WebAssembly modules: the runtime, which needs no C library, and the readers and
# writers of scene files, with wasi-libc. Without the compiler for these they are empty, and the command says so.
option(T3R_VIEWER "Compile the modules of the page of trim3r view, where clang, wasm-ld and wasi-libc are found" ON)
find_program(T3R_WASM_CLANG clang)
find_program(T3R_WASM_LD NAMES wasm-ld wasm-ld-14)
set(viewer ${CMAKE_CURRENT_SOURCE_DIR}/viewer)
set(wasm_found FALSE)
if(T3R_VIEWER AND T3R_WASM_CLANG AND T3R_WASM_LD)
  set(wasi ${T3R_WASM_CLANG} --target=wasm32-wasi)
  execute_process(COMMAND ${wasi} -print-file-name=libc.a OUTPUT_VARIABLE wasi_libc OUTPUT_STRIP_TRAILING_WHITESPACE)
  execute_process(COMMAND ${wasi} -print-libgcc-file-name OUTPUT_VARIABLE wasi_builtins OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(EXISTS ${wasi_libc} AND EXISTS ${wasi_builtins})
    set(wasm_found TRUE)
  endif()
endif()

# Compiles sources by a command, and appends the objects to a list.
function(t3r_wasm_objects list)
  cmake_parse_arguments(PARSE_ARGV 1 with "" "" "BY;SOURCES")
  set(objects ${${list}})
  foreach(source ${with_SOURCES})
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${source})
    string(REPLACE "/" "-" name ${name})
    set(object wasm/${name}.o)
    add_custom_command(
      OUTPUT ${object}
      COMMAND ${with_BY} -ffunction-sections -fdata-sections -Wall -Wextra -Werror -I${PROJECT_SOURCE_DIR}/runtime
              -I${PROJECT_SOURCE_DIR}/runtime/include -I${PROJECT_SOURCE_DIR}/platform -I${PROJECT_SOURCE_DIR}/tools
              -I${PROJECT_SOURCE_DIR}/tools/viewer -MD -MF ${object}.d -c ${source} -o ${object}
      DEPENDS ${source}
      DEPFILE ${object}.d
      VERBATIM)
    list(APPEND objects ${object})
  endforeach()
  set(${list} ${objects} PARENT_SCOPE)
endfunction()

if(wasm_found)
  file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/wasm)
  get_target_property(runtime_sources trim3r_runtime SOURCES)
  list(FILTER runtime_sources EXCLUDE REGEX "/kernels/(x86|arm)/")
  file(GLOB module_sources CONFIGURE_DEPENDS viewer/module/*.c scene/seen_gaussian.c geometry/view_frame.c)
  set(freestanding ${T3R_WASM_CLANG} --target=wasm32 -std=c11 -O3 -mbulk-memory -matomics -mmutable-globals -msimd128
                   -ffreestanding)
  t3r_wasm_objects(runtime_objects BY ${freestanding} SOURCES ${runtime_sources})
  t3r_wasm_objects(module_objects BY ${freestanding} SOURCES ${module_sources})
  # The module with threads has memory that workers share; a page in a file may not have any.
  set(link ${T3R_WASM_CLANG} --target=wasm32 -nostdlib -Wl,--no-entry,--gc-sections,--strip-all,--export=__heap_base)
  set(shared -Wl,--import-memory,--shared-memory,--initial-memory=16777216,--max-memory=2147483648,--export=__stack_pointer)
  add_custom_command(
    OUTPUT viewer.wasm viewer_threads.wasm
    COMMAND ${link} ${runtime_objects} ${module_objects} -o viewer.wasm
    COMMAND ${link} ${shared} ${runtime_objects} ${module_objects} -o viewer_threads.wasm
    DEPENDS ${runtime_objects} ${module_objects}
    VERBATIM)
  # Readers and writers that need no other library. The page parses JSON for them.
  file(GLOB file_sources CONFIGURE_DEPENDS viewer/module/files/*.c scene/*.c scene/formats/ply/*.c)
  list(FILTER file_sources EXCLUDE REGEX "/(scene_options|scene_append|seen_gaussian|splat_camera|tile_lists)[.]c$")
  foreach(name viewer/bundle viewer/start_view scene/summary/scene_box scene/formats/splat scene/formats/spz/spz_read
               scene/formats/sog/sog_read scene/formats/glb/glb_read scene/formats/glb/glb_nodes
               scene/formats/glb/glb_attributes cli/tables/json_array scene/store/scene_formats scene/store/scene_read
               scene/store/scene_remark scene/store/scene_write import/viewpoint_angle geometry/quaternion
               viewer/viewpoints viewer/camera_path cli/files/recorded_frame reconstruction/developed_frame
               reconstruction/reconstruction_error reconstruction/context/context_choice
               reconstruction/context/view_surface geometry/pinhole)
    list(APPEND file_sources ${CMAKE_CURRENT_SOURCE_DIR}/${name}.c)
  endforeach()
  # The reader of recordings, and the head that builds from them.
  foreach(name host/reason host/text host/cpu host/fixed_text mcap/crc32 mcap/mcap_reader mcap/mcap_records messages/cdr
               messages/fixed_camera messages/fixed_double messages/message_frame messages/pixel_layout
               messages/ros_messages messages/ros_schemas recording/recording_choice recording/recording_frame
               recording/recording_info recording/recording_inspect recording/recording_names recording/recording_note
               recording/recording_pairing recording/recording_reader)
    list(APPEND file_sources ${PROJECT_SOURCE_DIR}/platform/${name}.c)
  endforeach()
  list(APPEND file_sources ${PROJECT_SOURCE_DIR}/quant/heads/small.c)
  t3r_wasm_objects(file_objects BY ${wasi} -std=gnu11 -O2 -mbulk-memory -DT3R_BARE_FORMATS -ftls-model=local-exec
                  -I${viewer}/module/files -I${PROJECT_SOURCE_DIR}/quant/heads
                  SOURCES ${file_sources})
  add_custom_command(
    OUTPUT viewer_files.wasm
    COMMAND ${wasi} -mexec-model=reactor -Wl,--gc-sections,--strip-all,-z,stack-size=1048576 ${file_objects}
            ${runtime_objects} -o viewer_files.wasm
    DEPENDS ${file_objects} ${runtime_objects}
    VERBATIM)
else()
  if(T3R_VIEWER)
    message(STATUS "trim3r view: no clang with wasm-ld and wasi-libc (tools/setup --viewer), so the page is left out")
  endif()
  foreach(name viewer viewer_threads viewer_files)
    file(TOUCH ${CMAKE_CURRENT_BINARY_DIR}/${name}.wasm)
  endforeach()
endif()

set(scripts vectors camera runtime picture scene controls crop path files recording input start)
list(TRANSFORM scripts REPLACE "(.+)" "${viewer}/page/view/\\1.js")
string(REPLACE ";" "|" script "${scripts}")
set(files_scripts fzstd/fzstd files_json files_archive files_chunks files_worker)
list(TRANSFORM files_scripts REPLACE "(.+)" "${viewer}/page/\\1.js")
string(REPLACE ";" "|" files_script "${files_scripts}")
set(names viewer_html viewer_css viewer_js viewer_follow_js viewer_worker_js viewer_files_js viewer_wasm
          viewer_threads_wasm viewer_files_wasm)
set(files ${viewer}/page/view.html ${viewer}/page/view.css ${script} ${viewer}/page/follow.js ${viewer}/page/worker.js
          "${files_script}")
foreach(name viewer viewer_threads viewer_files)
  list(APPEND files ${CMAKE_CURRENT_BINARY_DIR}/${name}.wasm)
endforeach()
string(REPLACE "|" ";" embedded "${files}")
add_custom_command(
  OUTPUT viewer_page.c
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=viewer_page.c "-DNAMES=${names}" "-DFILES=${files}"
          -P ${CMAKE_CURRENT_SOURCE_DIR}/embed.cmake
  DEPENDS ${embedded} embed.cmake
  VERBATIM)
target_sources(tools_viewer PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/viewer_page.c)
