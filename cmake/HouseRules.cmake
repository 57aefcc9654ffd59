# SPDX-License-Identifier: MIT
# Compiler settings shared by every target, and the one way a library of this house is made.

# -ffp-contract=off keeps gcc and clang on the same bits wherever only + - * / sqrt are used.
add_library(house_rules INTERFACE)
target_compile_options(house_rules INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes -ffp-contract=off)

# add_house_library(NAME SOURCES ... LIBRARIES ... DEFINITIONS ...)
# compiles the sources once and links them twice: NAME::NAME (shared) and NAME::NAME_static.
# LIBRARIES given as NAME::NAME of this house are linked in the matching kind.
function(add_house_library name)
  cmake_parse_arguments(LIB "" "" "SOURCES;HOUSE;LIBRARIES;DEFINITIONS" ${ARGN})
  string(TOUPPER ${name} upper)
  add_library(${name}_objects OBJECT ${LIB_SOURCES})
  set_target_properties(${name}_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_definitions(${name}_objects PRIVATE ${upper}_BUILDING ${LIB_DEFINITIONS})
  target_include_directories(${name}_objects PUBLIC include PRIVATE src)
  target_link_libraries(${name}_objects PRIVATE $<BUILD_INTERFACE:house_rules> ${LIB_LIBRARIES})
  foreach(house ${LIB_HOUSE})
    target_link_libraries(${name}_objects PRIVATE ${house})
  endforeach()

  foreach(kind shared static)
    string(TOUPPER ${kind} KIND)
    if(kind STREQUAL shared)
      set(target ${name})
      set(suffix "")
    else()
      set(target ${name}_static)
      set(suffix _static)
    endif()
    add_library(${target} ${KIND} $<TARGET_OBJECTS:${name}_objects>)
    add_library(${name}::${target} ALIAS ${target})
    set_target_properties(${target} PROPERTIES
      OUTPUT_NAME ${name} VERSION ${PROJECT_VERSION} SOVERSION 0 EXPORT_NAME ${target} LINKER_LANGUAGE C)
    target_include_directories(${target} PUBLIC
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    foreach(house ${LIB_HOUSE})
      target_link_libraries(${target} PUBLIC ${house}${suffix})
    endforeach()
    target_link_libraries(${target} PRIVATE ${LIB_LIBRARIES})
  endforeach()
endfunction()
