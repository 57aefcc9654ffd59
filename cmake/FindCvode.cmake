# SPDX-License-Identifier: MIT
# Cvode::cvode: SUNDIALS' CVODE with the serial vector and the dense solver, nothing else of SUNDIALS.
# SUNDIALS' own package file is not used: distributions ship it with targets whose files are absent.
find_path(Cvode_INCLUDE_DIR cvode/cvode.h)
set(Cvode_parts cvode nvecserial sunmatrixdense sunlinsoldense sunnonlinsolfixedpoint sunnonlinsolnewton)
set(Cvode_required Cvode_INCLUDE_DIR)
set(Cvode_LIBRARIES "")
foreach(part core ${Cvode_parts})
  find_library(Cvode_${part}_LIBRARY sundials_${part})
  mark_as_advanced(Cvode_${part}_LIBRARY)
  if(Cvode_${part}_LIBRARY)
    list(APPEND Cvode_LIBRARIES ${Cvode_${part}_LIBRARY})
  endif()
  if(NOT part STREQUAL core) # 7.x only
    list(APPEND Cvode_required Cvode_${part}_LIBRARY)
  endif()
endforeach()
mark_as_advanced(Cvode_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Cvode REQUIRED_VARS ${Cvode_required})
if(Cvode_FOUND AND NOT TARGET Cvode::cvode)
  add_library(Cvode::cvode INTERFACE IMPORTED)
  set_target_properties(Cvode::cvode PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${Cvode_INCLUDE_DIR}" INTERFACE_LINK_LIBRARIES "${Cvode_LIBRARIES}")
endif()
