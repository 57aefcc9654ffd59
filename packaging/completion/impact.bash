# SPDX-License-Identifier: MIT
# bash completion for impact(1)
_impact() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} options
    options='--out --record --report --seconds --tolerance --frame-rate --verify --pictures --save --checkpoint --resume --quiet --max-memory --max-time --max-disk --fence --trust --help --version'
    case ${COMP_WORDS[1]:-} in
    sweep) options+=' -j --shard --mpi --hdf5' ;;
    gather) options='--hdf5 --quiet' ;;
    esac
    COMPREPLY=()
    case $before in
    --out | gather)
        mapfile -t COMPREPLY < <(compgen -d -- "$word")
        return
        ;;
    --max-* | --seconds | --tolerance | --frame-rate | --checkpoint | --save | --shard | -j) return ;;
    esac
    if [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
    else
        [ "$COMP_CWORD" != 1 ] || mapfile -t COMPREPLY < <(compgen -W 'view gltf sweep gather' -- "$word")
        mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -X '!*.@(lua|run|save)' -- "$word"; compgen -d -- "$word")
    fi
}
complete -o filenames -F _impact impact
