# SPDX-License-Identifier: Apache-2.0
# An overlay port: `vcpkg install trim3r --overlay-ports=tools/packaging/vcpkg` in the tree builds the tree itself.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS FEATURE_OPTIONS
  FEATURES
    comparison T3R_WITH_COMPARISON
    stereo T3R_WITH_STEREO
    streams T3R_WITH_STREAMS
    learned T3R_WITH_LEARNED
    refinement T3R_WITH_REFINEMENT
    extras T3R_WITH_EXTRAS
    backdrop T3R_WITH_BACKDROP)
string(COMPARE EQUAL "${VCPKG_LIBRARY_LINKAGE}" "dynamic" WITH_SHARED)

vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${FEATURE_OPTIONS} -DT3R_TOOLS=OFF -DT3R_SHARED=${WITH_SHARED})
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/trim3r)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
