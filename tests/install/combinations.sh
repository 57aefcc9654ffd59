#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# combinations.sh SOURCE WORK: every combination of the options builds, tests and installs. Slow: 16 builds.
set -euo pipefail
source=$1 work=$2
failed=0
mkdir -p "$work"
jobs=${JOBS:-2}
for bits in {0..1}{0..1}{0..1}{0..1}; do
    build=$work/$bits
    log=$work/$bits.log
    flags=(-DQUAT_WITH_GSL="${bits:0:1}" -DIMPACT_WITH_CVODE="${bits:1:1}" -DIMPACT_WITH_CCD="${bits:2:1}" -DBUILD_LUA="${bits:3:1}")
    rm -rf "$build"
    result=ok
    {
        cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_FLAGS=-Werror "${flags[@]}" &&
            cmake --build "$build" --parallel "$jobs" &&
            ctest --test-dir "$build" --output-on-failure -LE slow -j "$jobs" &&
            cmake --install "$build" --prefix "$build/tree"
    } >"$log" 2>&1 || result="failed, see $log"
    echo "${flags[*]#-D}: $(grep -o '[0-9]*% tests passed.*' "$log" || true); $result"
    if [ "$result" = ok ]; then rm -rf "$build"; else failed=1; fi
done
exit "$failed"
