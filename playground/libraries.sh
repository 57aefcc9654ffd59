#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# libraries.sh FOLDER: Lua, CVODE and libccd for WebAssembly, as the system's own packages have them: their sources come from
# Debian's source packages, through package lists of this folder's own, so that nothing of the system changes. None of it is ours,
# and none of it enters the tree.
set -euo pipefail

folder=$(mkdir -p "$1" && cd "$1" && pwd)
stamp=$folder/libraries-are-built
[ "$stamp" -nt "${BASH_SOURCE[0]}" ] && exit 0

# sources FOLDER: where the system itself gets its packages (those that its own keyring signs), asked for sources.
sources() {
    local file
    for file in /etc/apt/sources.list.d/*.sources; do
        [ -e "$file" ] && grep -q archive-keyring "$file" && sed 's/^Types:.*/Types: deb-src/' "$file" >"$1/$(basename "$file")"
    done
    if [ -s /etc/apt/sources.list ]; then grep -v signed-by /etc/apt/sources.list | sed -n 's/^deb /deb-src /p' >"$1/own.list"; fi
}

fetch() {
    local state=$folder/apt package
    local options=(-q -o "Dir::State::Lists=$state/lists" -o "Dir::Cache=$state/cache" -o Dir::Etc::SourceList=-
        -o "Dir::Etc::SourceParts=$state/parts" -o APT::Sandbox::User=)
    mkdir -p "$state/lists/partial" "$state/cache/archives/partial" "$state/parts" "$folder/sources"
    sources "$state/parts"
    apt-get "${options[@]}" update
    cd "$folder/sources"
    for package in lua5.4 sundials libccd; do
        ls -d "$package"-*/ >/dev/null 2>&1 || apt-get "${options[@]}" source "$package"
    done
}

# compile ARCHIVE FLAGS... -- SOURCES...
compile() {
    local archive=$1 flags=() objects=() source object
    shift
    while [ "$1" != -- ]; do flags+=("$1") && shift; done
    shift
    mkdir -p "$folder/objects/$archive"
    for source; do
        object=$folder/objects/$archive/$(basename "$source" .c).o
        emcc -O2 -w -c "${flags[@]}" "$source" -o "$object"
        objects+=("$object")
    done
    rm -f "$folder/lib$archive.a"
    emar rcs "$folder/lib$archive.a" "${objects[@]}"
}

fetch >"$folder/fetch.log" 2>&1 || { tail -n 5 "$folder/fetch.log" >&2; echo "libraries.sh: the sources could not be fetched" >&2; exit 3; }
cd "$folder/sources"
lua=$(echo "$PWD"/lua5.4-*/src) sundials=$(echo "$PWD"/sundials-*/) ccd=$(echo "$PWD"/libccd-*/src)
mkdir -p "$folder/include/sundials" "$folder/include/lua" "$folder/include/ccd"
cp "$lua"/{lua,luaconf,lualib,lauxlib}.h "$folder/include/lua/"
echo '#define DEB_HOST_MULTIARCH "wasm"' >"$folder/include/lua/lua5.4-deb-multiarch.h"
cp -r "$sundials"/include/* "$folder/include/"
sed 's/^#define SUNDIALS_MPI_ENABLED.*//' /usr/include/sundials/sundials_config.h >"$folder/include/sundials/sundials_config.h"
cp /usr/include/sundials/sundials_export.h "$folder/include/sundials/"
cp "$ccd"/ccd/*.h "$folder/include/ccd/"
cp /usr/include/ccd/config.h "$folder/include/ccd/"

mapfile -t files < <(find "$lua" -name '*.c' ! -name lua.c ! -name luac.c)
compile lua "-I$folder/include/lua" -- "${files[@]}"
mapfile -t files < <(ls "$sundials"src/sundials/sundials_{context,errors,futils,iterative,linearsolver,logger,math,matrix,memory,nonlinearsolver,nvector,nvector_senswrapper,version,dense,direct,hashmap,band}.c \
    "$sundials"src/cvode/cvode{,_io,_ls,_nls,_proj,_fused_stubs}.c "$sundials"src/{nvector/serial,sunmatrix/dense,sunmatrix/band,sunlinsol/dense,sunnonlinsol/newton,sunnonlinsol/fixedpoint}/[!f]*.c 2>/dev/null)
compile cvode "-I$folder/include" "-I${sundials}src/sundials" "-I${sundials}src/cvode" -- "${files[@]}"
mapfile -t files < <(find "$ccd" -maxdepth 1 -name '*.c')
compile ccd "-I$folder/include" "-I$ccd" -DNDEBUG -- "${files[@]}"
touch "$stamp"
