#!/bin/bash
# Hundreds of grains: generated ones of every kind, 3000 triangles, in one batch: grains per minute, memory, none lost;
# and a part of them on one core and on two.
#   BUILD=build tests/bench/clump_bulk.sh [GRAINS [SPHERES]]     default 300 50
set -eu
. "$(dirname "$0")/lib.sh"
grains=${1:-300} spheres=${2:-50}

mkdir "$work/grains" "$work/part"
kinds=$("$grain" --list | grep -o '^[a-z]*:' | tr -d :)
seed=0
while [ $seed -lt "$grains" ]; do
    for kind in $kinds; do
        [ $seed -lt "$grains" ] || break
        seed=$((seed + 1))
        "$grain" --kind "$kind" --seed $seed --triangles 3000 -o "$work/grains/$(printf %s_%04d "$kind" $seed).stl" -q
    done
done
for file in $(ls "$work/grains" | awk -v n="$grains" 'NR % (n > 40 ? int(n / 20) : 2) == 1'); do
    ln "$work/grains/$file" "$work/part/"
done

# batch FOLDER CORES: sets `made`, `seconds`, `user`, `peak`
batch() {
    /usr/bin/time -f '%e %U %M' -o "$work/time" "$tool" "$1" -j "$2" -n "$spheres" -q -o "$work/out/" -o "$work/t.csv" \
        -o "$work/sheet.png" 2>"$work/err" || cat "$work/err"
    read -r seconds user peak <"$work/time"
    made=$(grep -c ',done,' "$work/t.csv")
    printf '%8d %6d %6d | %9.1f %9.1f %10.1f | %8.0f\n' "$(ls "$1" | wc -l)" "$2" "$made" "$seconds" "$user" \
        "$(awk -v n="$made" -v s="$seconds" 'BEGIN { print 60 * n / s }')" "$(awk -v k="$peak" 'BEGIN { print k / 1024 }')"
}
printf '%8s %6s %6s | %9s %9s %10s | %8s\n' grains cores made "wall s" "user s" "per minute" "peak MB"
batch "$work/part" 1
one=$seconds
batch "$work/part" 2
awk -v a="$one" -v b="$seconds" 'BEGIN { printf "two cores %.2f times one\n", a / b }'
batch "$work/grains" 2
