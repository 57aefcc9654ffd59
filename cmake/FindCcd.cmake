# SPDX-License-Identifier: MIT
# Ccd::ccd: libccd, built for double (checked where it is included). No version is asked for:
# Debian's package reports 2.0 for 2.1.
find_path(Ccd_INCLUDE_DIR ccd/ccd.h)
find_library(Ccd_LIBRARY ccd)
mark_as_advanced(Ccd_INCLUDE_DIR Ccd_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ccd REQUIRED_VARS Ccd_LIBRARY Ccd_INCLUDE_DIR)
if(Ccd_FOUND AND NOT TARGET Ccd::ccd)
  add_library(Ccd::ccd UNKNOWN IMPORTED)
  set_target_properties(Ccd::ccd PROPERTIES
    IMPORTED_LOCATION "${Ccd_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Ccd_INCLUDE_DIR}")
endif()
