# SPDX-License-Identifier: MIT
# Cvode::cvode: SUNDIALS' CVODE with the serial vector and the dense solver, nothing else of SUNDIALS.
# Cvode_VERSION is SUNDIALS' version; Cvode_LIBRARIES are the paths linked.
# SUNDIALS' own package file is not used: distributions ship it with targets whose files are absent.
find_path(Cvode_INCLUDE_DIR cvode/cvode.h)
set(Cvode_required Cvode_INCLUDE_DIR)
set(Cvode_LIBRARIES "")
foreach(part core cvode nvecserial sunmatrixdense sunlinsoldense sunnonlinsolfixedpoint sunnonlinsolnewton)
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

set(Cvode_config "")
if(EXISTS "${Cvode_INCLUDE_DIR}/sundials/sundials_config.h")
  file(STRINGS "${Cvode_INCLUDE_DIR}/sundials/sundials_config.h" Cvode_config
    REGEX "^#define SUNDIALS_(VERSION \"|MPI_ENABLED 1)")
  if(Cvode_config MATCHES "SUNDIALS_VERSION \"([0-9.]+)")
    set(Cvode_VERSION ${CMAKE_MATCH_1})
  endif()
endif()

# From 7 on, a SUNDIALS built with MPI names it in the header of every program.
set(Cvode_link ${Cvode_LIBRARIES})
if(Cvode_config MATCHES "MPI_ENABLED 1" AND Cvode_VERSION VERSION_GREATER_EQUAL 7)
  find_package(MPI QUIET COMPONENTS C)
  list(APPEND Cvode_required MPI_C_FOUND)
  list(APPEND Cvode_LIBRARIES ${MPI_C_LIBRARIES})
  list(APPEND Cvode_link MPI::MPI_C)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Cvode REQUIRED_VARS ${Cvode_required} VERSION_VAR Cvode_VERSION HANDLE_VERSION_RANGE)
if(Cvode_FOUND AND NOT TARGET Cvode::cvode)
  add_library(Cvode::cvode INTERFACE IMPORTED)
  set_target_properties(Cvode::cvode PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${Cvode_INCLUDE_DIR}" INTERFACE_LINK_LIBRARIES "${Cvode_link}")
endif()
