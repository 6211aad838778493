#!/bin/bash
# How the time and memory of dem-clump grow with spheres (10 to 2000) and with triangles (1k to 5M), on one core.
#   BUILD=build tests/bench/clump_scaling.sh [spheres|triangles]
set -eu
. "$(dirname "$0")/lib.sh"
what=${1:-both}

if [ "$what" != triangles ]; then
    "$grain" --kind harmonics --seed 7 --triangles 20000 -o "$work/grain.obj" -q
    printf '%8s %8s | %9s %9s %9s %9s | %8s\n' effort spheres "gap %" "pack s" "total s" "user s" "peak MB"
    for effort in fast default; do
        for n in 10 20 50 100 200 500 1000 2000; do
            timed "$tool" "$work/grain.obj" -j 1 -n $n --effort $effort -q -o "$work/c.json" -o "$work/t.csv"
            printf '%8s %8d | %9.3f %9.2f %9.2f %9.2f | %8d\n' $effort $n \
                "$(awk -v g="$(column "$work/t.csv" iou_gap)" 'BEGIN { print 100 * g }')" \
                "$(column "$work/t.csv" seconds_pack_s)" "$(column "$work/t.csv" seconds_total_s)" "$user" "$peak"
        done
    done
fi
if [ "$what" != spheres ]; then
    printf '\n%10s | %9s %9s %9s | %8s\n' triangles "pack s" "total s" "user s" "peak MB"
    for wanted in 1000 10000 100000 1000000 5000000; do
        "$grain" --kind harmonics --seed 7 --triangles $wanted -o "$work/grain.stl" -q
        timed "$tool" "$work/grain.stl" -j 1 -n 50 -q -o "$work/c.json" -o "$work/t.csv"
        printf '%10d | %9.2f %9.2f %9.2f | %8d\n' "$(column "$work/t.csv" triangles)" \
            "$(column "$work/t.csv" seconds_pack_s)" "$(column "$work/t.csv" seconds_total_s)" "$user" "$peak"
        rm "$work/grain.stl"
    done
fi
