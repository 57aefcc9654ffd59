#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# outside.sh CMAKE GENERATOR CC BUILD WORK: installs BUILD, moves the tree, and builds strangers' programs against it:
# a CMake project and plain cc with pkg-config, shared and static.
set -euo pipefail
cmake=$1 generator=$2 cc=$3 build=$4 work=$5
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -rf "$work"
mkdir -p "$work"
cd "$work"

"$cmake" --install "$build" --prefix "$work/first" >install.log
mv first moved # an installed tree can be moved
prefix=$work/moved
libdir=$(dirname "$(find "$prefix" -name libquat.a)")
if grep -rl -e "$build" -e "$work/first" "$prefix"; then
    echo "these files name the place they were built or installed in"
    exit 1
fi

echo "-- CMake"
"$cmake" -S "$here/outside" -B project -G "$generator" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_C_COMPILER="$cc" >configure.log || { cat configure.log; exit 1; }
"$cmake" --build project >build.log || { cat build.log; exit 1; }
for program in project/with_*; do
    "$program"
done

echo "-- pkg-config"
export PKG_CONFIG_PATH=$libdir/pkgconfig
# pkg-config quotes for the shell, which matters when the path holds a space.
flags=()
ask() { eval "flags=($(pkg-config "$@"))"; }
names=(quat impact)
[ ! -f "$libdir/pkgconfig/quat_gsl.pc" ] || names+=(quat_gsl)
for name in "${names[@]}"; do
    ask --cflags --libs "$name"
    "$cc" -o "shared_$name" "$here/outside/with_$name.c" "${flags[@]}" -Wl,-rpath,"$libdir"
    "./shared_$name"
done
# Pay only for what is used.
if ldd shared_quat | grep -E '^\s*lib(gsl|sundials|ccd)'; then
    echo "a program of the algebra loads more than libquat and libm"
    exit 1
fi

if ldd shared_impact | grep -E '^\s*lib(sundials|ccd)'; then
    echo "a program loads SUNDIALS or libccd before any scene needs it"
    exit 1
fi

# With the shared libraries gone the same names find the archives.
cp -R moved static_only
find static_only -name 'lib*.so*' -delete
only=$(dirname "$(find "$work/static_only" -name libquat.a)")/pkgconfig
for name in "${names[@]}"; do
    PKG_CONFIG_PATH=$only ask --static --cflags --libs "$name"
    "$cc" -o "static_$name" "$here/outside/with_$name.c" "${flags[@]}"
    "./static_$name"
done
if ldd static_impact | grep -E '^\s*lib(quat|impact)'; then
    echo "a static program loads our shared libraries"
    exit 1
fi

if [ -x "$prefix/bin/impact" ]; then
    echo "-- runner"
    "$prefix/bin/impact" --version
fi

core=$(find "$prefix" -path '*quat/core.so')
lua=$(command -v lua5.4 || command -v lua || true)
if [ -n "$core" ] && [ -n "$lua" ]; then
    echo "-- stock Lua"
    LUA_PATH="$prefix/share/lua/5.4/?.lua" LUA_CPATH="$(dirname "$(dirname "$core")")/?.so" \
        "$lua" -e 'print(require "quat".new(1, 0, 0, 0), require "impact".sphere(0.3).volume)'
    if ldd "$core" | grep -E '^\s*lib(gsl|sundials|ccd)'; then
        echo "require \"quat\" loads more than libquat and libm"
        exit 1
    fi
fi

echo "-- examples of the first pages"
# example PAGE LANGUAGE: the page's one block in that language.
example() { awk -v fence="\`\`\`$2" '$0 == fence { on = 1; next } /^\`\`\`/ { on = 0 } on' "$here/../../$1"; }
for page in README.md docs/hello.md; do
    name=$(basename "$page" .md)
    example "$page" c >"$name.c"
    ask --cflags --libs impact
    "$cc" -std=c11 -Wall -Wextra -Wpedantic -Werror -o "$name" "$name.c" "${flags[@]}" -Wl,-rpath,"$libdir"
    "./$name"
    example "$page" lua >"$name.lua"
    [ ! -x "$prefix/bin/impact" ] || "$prefix/bin/impact" "$name.lua" --out "$name.out" --quiet
done
