#!/bin/sh
# gate.sh [--renew]: does a step still cost what it did? Counts the instructions of a step of three small scenes by
# callgrind, which are the same at each repeat, and fails where one is more than 3 % above the number kept in
# instructions.csv. The numbers hold for one compiler, its options and the AVX2 kernels; others skip.
#
# Where more is meant, or less was won:  BUILD=build tests/bench/gate.sh --renew
# BUILD: build folder; COMPILER: a name for compiler and options, as the build knows it; EMBREE=0: no mesh walls.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
BUILD=$(cd "${BUILD:-$root/build}" && pwd)
run=$BUILD/dem-run
kept=$root/tests/bench/instructions.csv
compiler=${COMPILER:-$(cat "$BUILD/tests/compiler")}
most=3 # per cent
skip() { echo "skipped: $*"; exit 77; }
command -v valgrind >/dev/null || skip "valgrind is not installed"
[ "$compiler" != other ] || skip "numbers are kept for unchanged optimised builds only"
[ "${1-}" = --renew ] || grep -q "^$compiler," "$kept" || skip "no numbers are kept for $compiler"
work=$(mktemp -d "${TMPDIR:-/tmp}/dem-gate-XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"
. "$root/tests/bench/scenes.sh"

# settle SCENE STEPS [OPTION...]: its bodies as they are then, in NAME.csv
settle() {
    scene=$1 steps=$2
    shift 2
    "$run" "$scene.json" -q -j 1 --steps "$steps" -o settled "$@"
    mv settled/final.csv "$scene.csv"
}

shape=$(shape_of ellipsoid 8) sides=$(box 0.05 0.04) bodies='{ "file": "%s.csv" }'
write_scene friction.json "$shape" "$(fill 250 "0, 0, 0" "0.05, 0.04, 0.15")" "$sides"
settle friction 15000 -D damping.viscous=10
write_scene friction.json "$shape" "$(printf "$bodies" friction)" "$sides"

young=2e7
write_scene settling.json "$shape" "$(fill 250 "0, 0, 0.002" "0.05, 0.04, 0.15" "" ', "velocity": [0, 0, -1.5]')" "$sides" "$(hertz)"
settle settling 1000
write_scene settling.json "$shape" "$(printf "$bodies" settling)" "$sides" "$(hertz)"
young=

if [ "${EMBREE:-1}" != 0 ]; then
    funnel >funnel.stl
    walls='"funnel": { "mesh": "funnel.stl", "material": "glass" }'
    write_scene mesh.json "$shape" "$(fill 250 "-0.03, -0.03, 0.03" "0.03, 0.03, 0.15")" "$walls"
    settle mesh 15000 -D damping.viscous=10
    write_scene mesh.json "$shape" "$(printf "$bodies" mesh)" "$walls"
fi

"$run" friction.json -q --steps 1 -o level
valgrind -q --tool=none "$run" friction.json --explain 2>&1 | grep -q '^kernel: .*(AVX2)' || skip "no AVX2"
failed=
for scene in friction settling mesh; do
    [ -f $scene.json ] || continue
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect=dem_world_step "$run" $scene.json -q -j 1 --steps 100 \
        -o counted 2>log || { cat log; exit 1; }
    count=$(awk '/Collected :/ { printf "%.0f", $NF / 100 }' log)
    echo "$compiler,$scene,$count" >>counted.csv
    before=$(awk -F, -v c="$compiler" -v s=$scene '$1 == c && $2 == s { print $3 }' "$kept" 2>/dev/null || true)
    more=$(awk -v n="$count" -v b="${before:-0}" 'BEGIN { if (b > 0) printf "%+.2f", 100 * (n / b - 1) }')
    echo "$scene: $count instructions for a step${more:+, kept are $before: $more %}"
    [ -z "$more" ] || awk -v m="$more" -v most=$most 'BEGIN { exit !(m > most) }' && failed="$failed $scene"
done
if [ "${1-}" = --renew ]; then
    { grep -v "^$compiler," "$kept" 2>/dev/null || true; cat counted.csv; } | sort >renewed.csv
    cp renewed.csv "$kept"
    echo "kept for $compiler: $kept"
elif [ "$failed" ]; then
    echo "dearer by more than $most %:$failed. Find what costs it (callgrind_annotate), or say in the commit why it must be and run"
    echo "    BUILD=$BUILD tests/bench/gate.sh --renew"
    exit 1
fi
