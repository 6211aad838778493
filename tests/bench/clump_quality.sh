#!/bin/bash
# Error against spheres on grains of every kind, on one core; beside the packing prototype where it lies in
# ../shared (run in turn, judged by our own fidelity figures on both).
#   BUILD=build tests/bench/clump_quality.sh [COUNT...]     default 20 50 100
set -eu
. "$(dirname "$0")/lib.sh"
shared=$(dirname "$0")/../../../shared
counts=${*:-20 50 100}

printf 'OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n' >"$work/cube.off"
printf 'OFF\n6 8 0\n1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n' >"$work/octahedron.off"
meshes="$work/cube.off $work/octahedron.off $(ls "$(dirname "$0")"/../../shapes/grains/*.obj)"
for name in human_femur.stl castalia.obj flake1_thin.obj; do
    [ -e "$shared/meshes/$name" ] && meshes="$meshes $shared/meshes/$name"
done
prototype=""
if [ -e "$shared/prototypes/packing/pack2.cpp" ]; then
    g++ -O3 -march=native -ffast-math -fno-finite-math-only -std=c++17 -w -o "$work/pack2" "$shared/prototypes/packing/pack2.cpp"
    prototype="$work/pack2"
fi

printf '%-14s %7s | %8s %8s %6s %9s | %8s %8s\n' grain spheres "gap %" "pack s" pieces "inertia" "proto %" "proto s"
for mesh in $meshes; do
    for n in $counts; do
        timed "$tool" "$mesh" -j 1 -n $n -q -o "$work/c.json" -o "$work/t.csv"
        printf '%-14s %7d | %8.3f %8.2f %6d %9.1e |' "$(basename "$mesh" | cut -c1-14)" $n \
            "$(awk -v g="$(column "$work/t.csv" iou_gap)" 'BEGIN { print 100 * g }')" \
            "$(column "$work/t.csv" seconds_pack_s)" "$(column "$work/t.csv" pieces)" "$(column "$work/t.csv" inertia_error)"
        if [ -n "$prototype" ] && case "$mesh" in *.obj | *.stl | *.off) true ;; *) false ;; esac; then
            timed "$prototype" "$mesh" $n "$work/p.xyzr" -m 60 -lb 300 -mom -mt2 2
            printf ' %8.3f %8.2f' "$("${BUILD:-build}/tests/bench_fidelity" "$mesh" "$work/p.xyzr")" "$user"
        fi
        printf '\n'
    done
done
