#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# unity.sh CC SOURCE FLAG...: each folder of libimpact/src compiles as one file, so that its static names are unique; and
# all headers, public and internal, can be included together, in either order. FLAG...: the build's parts, and where
# their headers are. A part that the build has not is left out.
set -euo pipefail
cc=$1 source=$2
shift 2
flags=(-std=gnu11 -D_GNU_SOURCE= -Wall -Wextra -Werror -fsyntax-only '-DIMPACT_VERSION="unity"'
    -I"$source/libquat/include" -I"$source/libimpact/include" -I"$source/libimpact/src" "$@")
cvode=0 ccd=0
case " $* " in *" -DIMPACT_WITH_CVODE "*) cvode=1 ;; esac
case " $* " in *" -DIMPACT_WITH_CCD "*) ccd=1 ;; esac
left_out() { # FILE: of another build, or a second compilation of sources that are here already
    case $1 in
    base/part_load.c) true ;; # the parts of this build are here
    base/ode_cvode.c | base/ode_pool.[ch]) [ "$cvode" = 0 ] ;;
    gap/gjk.c) [ "$ccd" = 0 ] ;;
    *_second.c) true ;;
    *) false ;;
    esac
}
includes() { # FILE...: as lines of C
    for file; do left_out "$file" || printf '#include "%s"\n' "$file"; done
}
bad=0 folders=0
cd "$source/libimpact/src"
for folder in */; do
    folders=$((folders + 1))
    "$cc" "${flags[@]}" -x c - <<<"$(includes "$folder"*.c)" || { echo "$folder does not compile as one file"; bad=1; }
done
listed() { (cd "$1" && printf '%s\n' */*.h); }
mapfile -t headers < <(listed . && listed ../include && listed ../../libquat/include)
# The list forwards, then backwards: of any two headers each comes first once.
for order in sort 'sort -r'; do
    mapfile -t ordered < <(printf '%s\n' "${headers[@]}" | $order)
    { includes "${ordered[@]}"; echo 'extern int not_empty;'; } | "$cc" "${flags[@]}" -x c - ||
        { echo "the headers cannot be included together ($order)"; bad=1; }
done
echo "$folders folders, ${#headers[@]} headers"
[ "$folders" -gt 5 ] && [ "${#headers[@]}" -gt 50 ] && [ "$bad" = 0 ]
