#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# reproducible.sh SOURCE WORK: the sources built in two folders, at two times, install the same bytes.
set -euo pipefail
source=$1 work=$2
export CCACHE_DISABLE=1
rm -rf "$work"
mkdir -p "$work/here" "$work/somewhere/else"
# each build of its own copy of the sources
for place in here somewhere/else; do
    (cd "$source" && tar cf - CMakeLists.txt README.md CHANGELOG.md LICENSE cmake libquat libimpact lua view examples tests/generators packaging) |
        tar xf - -C "$work/$place"
    cmake -S "$work/$place" -B "$work/$place/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTS=OFF >"$work/log" || { cat "$work/log"; exit 1; }
    cmake --build "$work/$place/build" --parallel "${JOBS:-2}" >"$work/log" || { cat "$work/log"; exit 1; }
    DESTDIR="$work/$place/tree" cmake --install "$work/$place/build" --prefix /usr >"$work/log"
done
diff -r "$work/here/tree" "$work/somewhere/else/tree"
! grep -rl "$work" "$work/here/tree" || { echo "these files name the folder that they were built in"; exit 1; }
echo "$(find "$work/here/tree" -type f | wc -l) files are equal"
