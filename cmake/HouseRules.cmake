# SPDX-License-Identifier: MIT
# Compiler settings shared by every target, and the one way a library of this house is made.
include(CheckLinkerFlag)

# -ffp-contract=off keeps gcc and clang on the same bits wherever only + - * / sqrt are used.
add_library(house_rules INTERFACE)
target_compile_options(house_rules INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes> $<$<COMPILE_LANGUAGE:C>:-Wmissing-prototypes>
  -ffp-contract=off -fno-math-errno)

# Sums and products that carry their own rounding (Knuth, Dekker) need doubles that are rounded to double: the x87 registers of 32-bit x86
# round to 64 bits, and again when they are stored.
include(CheckCSourceCompiles)
check_c_source_compiles("#include <float.h>
#if FLT_EVAL_METHOD == 2 || FLT_EVAL_METHOD < 0
#error wider
#endif
int main(void) { return 0; }" HOUSE_DOUBLES_ARE_DOUBLE)
if(NOT HOUSE_DOUBLES_ARE_DOUBLE)
  message(FATAL_ERROR "This compiler computes doubles in wider registers; on 32-bit x86 add -msse2 -mfpmath=sse to CMAKE_C_FLAGS")
endif()

# Each function of an archive stands in a section of its own, so that a program takes those that it calls (--gc-sections).
add_library(house_sections INTERFACE)
if(CMAKE_C_COMPILER_ID MATCHES "GNU|Clang" AND NOT APPLE)
  target_compile_options(house_sections INTERFACE -ffunction-sections -fdata-sections)
endif()
check_linker_flag(C -Wl,--gc-sections HOUSE_HAS_GC_SECTIONS)

# No file of a release holds the folder it was built in: two builds of one commit are equal, byte for byte.
include(CheckCCompilerFlag)
check_c_compiler_flag(-ffile-prefix-map=a=b HOUSE_HAS_PREFIX_MAP)
if(HOUSE_HAS_PREFIX_MAP)
  target_compile_options(house_rules INTERFACE
    $<$<CONFIG:Release>:-ffile-prefix-map=${PROJECT_BINARY_DIR}=build>
    $<$<CONFIG:Release>:-ffile-prefix-map=${PROJECT_SOURCE_DIR}=.>)
endif()

# A shared library names as needed only what it calls, so that loading the algebra loads libm and nothing else.
check_linker_flag(C -Wl,--as-needed HOUSE_HAS_AS_NEEDED)

if(APPLE)
  set(house_origin @loader_path)
else()
  set(house_origin $ORIGIN)
endif()

# While 0.x breaks, each minor version is an interface of its own: a program of one does not load another.
set(HOUSE_SOVERSION ${PROJECT_VERSION_MAJOR})
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(HOUSE_SOVERSION 0.${PROJECT_VERSION_MINOR})
endif()

# check_version_macros(HEADER PREFIX): PREFIX_VERSION_MAJOR, _MINOR and _PATCH of the header are the project's.
function(check_version_macros header prefix)
  foreach(part MAJOR MINOR PATCH)
    file(STRINGS ${header} line REGEX "^#define ${prefix}_VERSION_${part} ")
    if(NOT line STREQUAL "#define ${prefix}_VERSION_${part} ${PROJECT_VERSION_${part}}")
      message(FATAL_ERROR "${header}: '${line}', but the project's version is ${PROJECT_VERSION}")
    endif()
  endforeach()
endfunction()

# add_house_library(NAME [PACKAGE PACKAGE] SOURCES ... [HOUSE ...] [LIBRARIES ...] [DEFINITIONS ...])
# compiles the sources once and links them twice: PACKAGE::NAME (shared) and PACKAGE::NAME_static; PACKAGE is NAME unless given.
# With BUILD_SHARED_LIBS said, once: ON leaves the static one to those of this project that link it, OFF makes PACKAGE::NAME another
# name of it.
# HOUSE: this house's own libraries (quat), linked in the matching kind and shown to users; LIBRARIES: all others, kept private.
# Exports NAME-targets and NAME_static-targets, apart, because only the static one asks a user to have LIBRARIES at hand.
function(add_house_library name)
  cmake_parse_arguments(LIB "" "PACKAGE" "SOURCES;HOUSE;LIBRARIES;DEFINITIONS" ${ARGN})
  if(NOT LIB_PACKAGE)
    set(LIB_PACKAGE ${name})
  endif()
  string(TOUPPER ${LIB_PACKAGE} upper)
  add_library(${name}_objects OBJECT ${LIB_SOURCES})
  set_target_properties(${name}_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_definitions(${name}_objects PRIVATE ${upper}_BUILDING ${LIB_DEFINITIONS})
  target_include_directories(${name}_objects PUBLIC include PRIVATE src)
  target_link_libraries(${name}_objects PRIVATE house_rules house_sections ${LIB_LIBRARIES} ${LIB_HOUSE})

  set(kinds SHARED STATIC)
  if(DEFINED BUILD_SHARED_LIBS AND NOT BUILD_SHARED_LIBS)
    set(kinds STATIC)
  elseif(DEFINED BUILD_SHARED_LIBS AND NOT IMPACT_BUILD_LUA AND NOT IMPACT_BUILD_TESTS AND NOT IMPACT_BUILD_BENCH)
    set(kinds SHARED)
  endif()
  foreach(kind ${kinds})
    set(target ${name})
    set(suffix "")
    if(kind STREQUAL STATIC)
      set(target ${name}_static)
      set(suffix _static)
    endif()
    add_library(${target} ${kind} $<TARGET_OBJECTS:${name}_objects>)
    add_library(${LIB_PACKAGE}::${target} ALIAS ${target})
    set_target_properties(${target} PROPERTIES
      OUTPUT_NAME ${name} VERSION ${PROJECT_VERSION} SOVERSION ${HOUSE_SOVERSION}
      LINKER_LANGUAGE C INSTALL_RPATH ${house_origin}
      # installing writes the one over the other, which is as long as the folder's name unless it is relative
      BUILD_RPATH_USE_ORIGIN ON)
    if(EMSCRIPTEN) # has no shared libraries: both are static ones, which need two names
      set_target_properties(${target} PROPERTIES OUTPUT_NAME ${target})
    endif()
    target_include_directories(${target} PUBLIC
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    foreach(house ${LIB_HOUSE})
      target_link_libraries(${target} PUBLIC ${house}${suffix})
    endforeach()
    target_link_libraries(${target} PRIVATE ${LIB_LIBRARIES})
    if(kind STREQUAL STATIC AND HOUSE_HAS_GC_SECTIONS)
      target_link_options(${target} INTERFACE LINKER:--gc-sections)
    endif()
    # Inline functions in the headers call libm too.
    target_link_libraries(${target} PUBLIC m)
    if(kind STREQUAL STATIC AND BUILD_SHARED_LIBS)
      continue()
    endif()
    install(TARGETS ${target} EXPORT ${target}-targets
      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
      RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
    install(EXPORT ${target}-targets NAMESPACE ${LIB_PACKAGE}::
      DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/${LIB_PACKAGE} COMPONENT development)
  endforeach()
  if(NOT SHARED IN_LIST kinds)
    add_library(${name} ALIAS ${name}_static)
    add_library(${LIB_PACKAGE}::${name} ALIAS ${name}_static)
  elseif(HOUSE_HAS_AS_NEEDED)
    target_link_options(${name} PRIVATE -Wl,--as-needed)
  endif()
endfunction()

# add_house_part(NAME PART LIBRARIES ...): libNAME_PART, which the shared NAME loads when it first needs it: the objects NAME_PART_objects,
# what they call of NAME's archive, and LIBRARIES. It shows the entry that the objects define, and nothing of the archive.
function(add_house_part name part)
  set(target ${name}_${part})
  add_library(${target} SHARED $<TARGET_OBJECTS:${target}_objects>)
  set_target_properties(${target} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${HOUSE_SOVERSION} LINKER_LANGUAGE C SKIP_BUILD_RPATH ON IMPACT_LEAN ON)
  target_link_libraries(${target} PRIVATE house_rules ${name}_static ${ARGN})
  target_link_options(${target} PRIVATE LINKER:--exclude-libs,ALL -Wl,--as-needed)
  set_target_properties(${name} PROPERTIES BUILD_RPATH "${house_origin}") # where it looks for its parts
  add_dependencies(${name} ${target})
  install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_SKIP)
endfunction()

# install_house_package(NAME): cmake/NAME-config.cmake.in, so that find_package(NAME) finds what was built.
function(install_house_package name)
  set(directory ${CMAKE_INSTALL_LIBDIR}/cmake/${name})
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/${name}-config.cmake.in ${name}-config.cmake
    INSTALL_DESTINATION ${directory} NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file(${name}-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/${name}-config-version.cmake
    DESTINATION ${directory} COMPONENT development)
endfunction()

# The flags that link the libraries given as paths: -lNAME, and -LDIRECTORY where the linker would not look by itself.
function(link_flags output)
  set(flags "")
  foreach(library ${ARGN})
    if(library MATCHES "/")
      get_filename_component(directory ${library} DIRECTORY)
      get_filename_component(name ${library} NAME_WE)
      string(REGEX REPLACE "^lib" "" name ${name})
      if(NOT directory IN_LIST CMAKE_C_IMPLICIT_LINK_DIRECTORIES)
        list(APPEND flags -L${directory})
      endif()
      list(APPEND flags -l${name})
    elseif(library MATCHES "^-")
      list(APPEND flags ${library})
    else()
      list(APPEND flags -l${library})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES flags)
  string(JOIN " " flags ${flags})
  set(${output} ${flags} PARENT_SCOPE)
endfunction()

# install_pkg_config(NAME DESCRIPTION text LICENSE licence [REQUIRES package] [LIBRARIES path or name ...]):
# LIBRARIES are what a static link needs besides. The prefix is found from the file's own place, so that the tree can be moved.
function(install_pkg_config name)
  cmake_parse_arguments(PC "" "DESCRIPTION;LICENSE;REQUIRES" "LIBRARIES" ${ARGN})
  file(RELATIVE_PATH PC_UP ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  string(REGEX REPLACE "/$" "" PC_UP ${PC_UP})
  link_flags(PC_PRIVATE ${PC_LIBRARIES})
  set(PC_NAME ${name})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/house.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endfunction()
