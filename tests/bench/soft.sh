#!/bin/bash
# Does what a grain does depend on how many spheres describe it? The same rock and the same ellipsoid at 10 to 1000
# spheres, with the sum of all contacts and with soft ones: stiffness against a wall and a twin, restitution, work around
# closed paths and jumps, an oblique impact against that of a perfect ellipsoid, cost.
#   BUILD=build tests/bench/soft.sh [COUNT...]          default 10 50 200 1000
#   GRAINS=1 BUILD=build tests/bench/soft.sh [COUNT...] also beds and heaps of such rocks: void ratio, repose, for SEEDS
set -eu
. "$(dirname "$0")/lib.sh"
counts=${*:-10 50 200 1000}
bench=${BUILD:-build}/tests/bench_soft
tau=0.0012 # a fourth of the overlap of .005 diameters that the cases have

"$grain" --kind ellipsoid --longest "1.26 m" --intermediate "1 m" --shortest "0.7937 m" --triangles 20000 -q -o "$work/ellipsoid.obj"
rocks="" ellipsoids=""
for n in $counts; do
    "$tool" "$(dirname "$0")/../../shapes/grains/worn.obj" --size "1 m" -n "$n" -q -o "$work/rock-$n.json"
    "$tool" "$work/ellipsoid.obj" --size "1 m" -n "$n" -q -o "$work/ellipsoid-$n.json"
    rocks="$rocks $work/rock-$n.json"
    ellipsoids="$ellipsoids $work/ellipsoid-$n.json"
done
for case in wall twin bounce paths cost; do
    for mode in sum mean merge soft; do
        echo "rock, $case, $mode"
        # shellcheck disable=SC2086
        "$bench" "$case" "$mode" $tau $rocks
    done
done
for case in wall oblique twins; do
    for mode in sum mean merge soft; do
        echo "ellipsoid, $case, $mode"
        # shellcheck disable=SC2086
        "$bench" "$case" "$mode" $tau $ellipsoids
    done
done

# mean and standard error over the seeds
study() {
    for seed in ${SEEDS:-1 2 3 4}; do
        nice "${BUILD:-build}/dem-study" test "$1" -D bodies="$3" --grain "$work/rock-$4.json" --contacts "$5" --seed "$seed" \
            -j 1 --json | grep -o "\"$2\": *[0-9.eE+-]*" | grep -o '[0-9.eE+-]*$'
    done | awk '{ n++; s += $1; q += $1 * $1 } END { m = s / n; printf "%.4g +- %.2g (%d)\n", m, sqrt((q / n - m * m) / (n - 1)), n }'
}
if [ -n "${GRAINS:-}" ]; then
    for n in $counts; do
        for mode in sum soft; do
            echo "$n spheres, $mode: void ratio $(study pour void_ratio 200 "$n" "$mode"), repose $(study heap repose 300 "$n" "$mode")"
        done
    done
fi
