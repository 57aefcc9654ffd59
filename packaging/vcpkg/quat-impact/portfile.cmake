# SPDX-License-Identifier: MIT
# vcpkg install quat-impact --overlay-ports=packaging/vcpkg: of this tree, both libraries over libm alone unless features are asked for.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS FEATURE_OPTIONS
  FEATURES
    cvode IMPACT_WITH_CVODE
    ccd   IMPACT_WITH_CCD
    gsl   QUAT_WITH_GSL)

vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${FEATURE_OPTIONS} -DIMPACT_BUILD_LUA=OFF -DIMPACT_BUILD_TESTS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME quat CONFIG_PATH lib/cmake/quat DO_NOT_DELETE_PARENT_CONFIG_PATH)
vcpkg_cmake_config_fixup(PACKAGE_NAME impact CONFIG_PATH lib/cmake/impact)
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
