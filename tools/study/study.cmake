# SPDX-License-Identifier: Apache-2.0
# What measures the product, and what made its heads: commands beside those of the product, and a main() of its own.
t3r_area(study/chart USES pictures)
t3r_area(study/rivals USES reconstruction)
t3r_area(study/ablation USES evaluation)
t3r_area(study/stress USES evaluation study/rivals)
t3r_area(study/troubles USES cli)
t3r_area(study/commands USES trim3r study/chart study/ablation study/stress study/troubles)
set(program study/main.c)
set(program_area tools_study_commands)

# The report of `trim3r chart`, as strings.
set(page_files page.html page.css page.js)
list(TRANSFORM page_files PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/study/chart/)
add_custom_command(
  OUTPUT chart_page.c
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=chart_page.c "-DNAMES=chart_page_html;chart_page_css;chart_page_js"
          "-DFILES=${page_files}" -P ${CMAKE_CURRENT_SOURCE_DIR}/embed.cmake
  DEPENDS ${page_files} embed.cmake
  VERBATIM)
target_sources(tools_study_chart PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/chart_page.c)

# gcc unrolls loops over eight columns before it recognises them as vectors; without this they are half as fast.
set_source_files_properties(study/rivals/splats/splat_differentiate.c study/rivals/splats/splat_draw.c study/rivals/tuning/photometric.c PROPERTIES
  COMPILE_OPTIONS "$<$<C_COMPILER_ID:GNU>:--param=max-completely-peel-times=4>;-ffp-contract=fast")
