#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# subproject.sh CMAKE GENERATOR CC SOURCE WORK: as a part of another project the two libraries are built and nothing else, shared or static as
# BUILD_SHARED_LIBS says; the static install is found by find_package and linked.
set -euo pipefail
cmake=$1 generator=$2 cc=$3 source=$4 work=$5
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -rf "$work"
mkdir -p "$work/host"
cd "$work"
cat >host/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.22)
project(host C)
set(BUILD_TESTS ON) # the host's own business
add_subdirectory("$source" parts)
add_executable(host "$here/outside/with_impact.c")
target_link_libraries(host PRIVATE impact::impact)
install(TARGETS host)
END
# impact over libm alone: what this asks of has nothing to do with SUNDIALS
flags=(-G "$generator" -DCMAKE_C_COMPILER="$cc" -DCMAKE_BUILD_TYPE=Release -DIMPACT_WITH_CVODE=OFF -DIMPACT_WITH_CCD=OFF)
for shared in ON OFF; do
    "$cmake" -S host -B "$shared" "${flags[@]}" -DBUILD_SHARED_LIBS=$shared >"$shared.log" || { cat "$shared.log"; exit 1; }
    ! grep -iwE 'cmocka|lua|gsl|gnuplot|mpi|hdf5' "$shared.log" || { echo "a part of another project looks for these"; exit 1; }
    "$cmake" --build "$shared" >>"$shared.log" || { cat "$shared.log"; exit 1; }
    built=$(find "$shared" \( -name 'lib*.a' -o -name 'lib*.so' -o -name '*.dylib' -o -perm -u+x -type f -name 'embed*' \) -printf '%f ' | tr ' ' '\n' | sort | tr '\n' ' ')
    wanted='libimpact.so libquat.so '
    [ $shared = ON ] || wanted='libimpact.a libquat.a '
    [ "$built" = "$wanted" ] || { echo "BUILD_SHARED_LIBS=$shared: built '$built', wanted '$wanted'"; exit 1; }
    "$shared/host"
done

echo "-- a static install"
"$cmake" --install OFF --prefix "$work/tree" >install.log
mkdir user
cat >user/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.22)
project(user C)
find_package(impact 0.2 REQUIRED)
add_executable(user "$here/outside/with_impact.c")
target_link_libraries(user PRIVATE impact::impact)
END
"$cmake" -S user -B user/build -G "$generator" -DCMAKE_C_COMPILER="$cc" -DCMAKE_PREFIX_PATH="$work/tree" >user.log || { cat user.log; exit 1; }
"$cmake" --build user/build >>user.log || { cat user.log; exit 1; }
user/build/user

echo "-- components"
for component in runtime development; do
    "$cmake" --install ON --prefix "$work/$component" --component $component >install.log
done
[ -z "$(find runtime \( -name '*.h' -o -name '*.cmake' -o -name '*.pc' -o -name 'lib*.so' \))" ] || { echo "runtime holds what is for development"; exit 1; }
[ -n "$(find runtime -name 'libimpact.so.0.*')" ] && [ -n "$(find development -name 'libimpact.so')" ] && [ -n "$(find development -name 'scene.h')" ]
[ -z "$(find development -name 'lib*.so.*')" ] || { echo "development holds what runs"; exit 1; }
