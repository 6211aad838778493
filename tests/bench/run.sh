#!/bin/sh
# run.sh [--quick] [-r OTHER] [-n REPEATS] [-o FILE.csv] [ROW...]: how fast clumps run, as one table with ratios.
#
# Makes its own scenes, settles them, and times each REPEATS times (3) on one core; the least counts, and runs of dem-run,
# of OTHER (a dem-run to compare with) and of LAMMPS (lmp, where installed) take turns. On one core only the seconds
# count for which a run had it, so that a busy machine disturbs less; with two threads the machine must be quiet.
# ROW: parts of names, for some rows only. BUILD: build folder with all kernels. --quick: two minutes, without the large
# scenes. FILE.csv has the same figures and more.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
BUILD=$(cd "${BUILD:-$root/build}" && pwd)
quick= other= repeats=3 csv=bench.csv wanted=
while [ $# -gt 0 ]; do
    case $1 in
    --quick) quick=yes repeats=2 ;;
    -r) other=$(cd "$(dirname "$2")" && pwd)/$(basename "$2"); shift ;;
    -n) repeats=$2; shift ;;
    -o) csv=$2; shift ;;
    -*) sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 2 ;;
    *) wanted="$wanted $1" ;;
    esac
    shift
done
csv=$(cd "$(dirname "$csv")" && pwd)/$(basename "$csv")
run=$BUILD/dem-run
lmp=$(command -v "${LMP:-lmp}" || true)
work=$(mktemp -d "${TMPDIR:-/tmp}/dem-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"
. "$root/tests/bench/scenes.sh"
. "$root/tests/bench/lammps.sh"
seconds=$([ "$quick" ] && echo 0.4 || echo 1.5)  # of a timed run

# number NAME FILE: the first of that name in what --json printed
number() { sed -n "s/^ *\"$1\": \([-0-9.e+]*\).*/\1/p" "$2" | head -1; }
pass() { sed -n "s/.*\"passes\".*\"$1\": \([-0-9.e+]*\).*/\1/p" "$2"; }
calc() { awk "BEGIN { print $1 }"; }
# seconds of the steps alone: a look for warnings takes 1 % of a long run, but may be all of a short one of a million bodies
seconds_of_steps() { calc "$(number loop_seconds "$1") - $(pass output "$1")"; }
form() { [ "$2" = - ] && printf "%s" - || printf "$1" "$2"; }
least() { sort -g "$1" | head -1; }

is_wanted() {
    [ -z "$wanted" ] && return 0
    for part in $wanted; do
        case $1 in *"$part"*) return 0 ;; esac
    done
    return 1
}

# once PROGRAM SCENE THREADS WARMUP STEPS: runs it; out.json, `peak` [KB], `busy`: how much of a core it had
once() {
    /usr/bin/time -f '%M %U %S %e' -o usage "$1" "$2" -q -j "$3" --warmup "$4" --steps "$5" -o out --json >out.json
    peak=$(cut -d ' ' -f 1 usage)
    busy=1
    [ "$3" != 1 ] || busy=$(awk '{ b = $4 > 0.2 ? ($2 + $3) / $4 : 1; print b < 1 ? b : 1 }' usage)
}

# settle SCENE BED STEPS [VISCOUS]: lets a scene come to rest; its bodies are then BED.csv
settle() {
    "$run" "$1" -q -j 1 --steps "$3" -D damping.viscous="${4:-5}" -o settled
    mv settled/final.csv "$2.csv"
}

heading() {
    printf '%-34s %5s %8s %10s %7s %8s %9s %9s %9s %8s %8s\n' scene k bodies 'us/clump' 'x k=8' 'x other' 'x lammps' contacts \
        "lammps's" 'walls' 'KB/clump'
    echo 'scene,spheres,bodies,threads,steps,us_per_clump_step,other_us,lammps_us,contacts,lammps_contacts,wall_contacts,walls_us,peak_kb,bytes_per_clump' >"$csv"
}

base= # us per clump-step of the row all others are compared with
floor_kb= # memory of a run of one body

# time_row NAME K SCENE [THREADS [WARMUP STEPS]]: one line of the table. `bed`: the state to give to LAMMPS, with `width`
# and `depth`; empty: without LAMMPS
time_row() {
    name=$1 k=$2 scene=$3 threads=${4:-1} warmup=${5:-100}
    once "$run" "$scene" "$threads" "$warmup" 100
    bodies=$(number clumps out.json)
    steps=${6:-$(calc "int($seconds / ($(number loop_seconds out.json) / 100) / 50 + 1) * 50")}
    : >own; : >others; : >theirs
    their_contacts=-
    if [ "$bed" ] && [ "$lmp" ]; then
        their_steps=${6:-$(calc "int($seconds / (1.2e-7 * $k * $bodies + 2e-5) + 20)")}
        spheres_of ellipsoid "$k" >spheres
        lammps_deck lammps spheres "$(body_of ellipsoid "$k")" "$bed.csv" "$warmup" "$their_steps" "$width" "$depth"
    fi
    # contacts are compared at the end of the warm-up
    once "$run" "$scene" "$threads" 0 "$warmup"
    contacts=$(number contacts out.json)
    for repeat in $(seq "$repeats"); do
        once "$run" "$scene" "$threads" "$warmup" "$steps"
        calc "$busy * $(seconds_of_steps out.json) / $steps / $bodies * 1e6" >>own
        walls=$(calc "$busy * $(pass walls out.json) / $steps / $bodies * 1e6")
        echo "$walls" >>walls.all
        own_peak=$peak
        cp out.json own.json
        if [ "$other" ]; then
            once "$other" "$scene" "$threads" "$warmup" "$steps"
            calc "$busy * $(seconds_of_steps out.json) / $steps / $bodies * 1e6" >>others
        fi
        if [ "$bed" ] && [ "$lmp" ]; then
            figures=$(lammps_time lammps) || { bed= their_contacts=failed; continue; }
            calc "${figures% *} / $bodies * 1e6" >>theirs
            their_contacts=${figures#* }
        fi
    done
    us=$(least own) walls=$(least walls.all); rm walls.all
    other_us=$(least others) lammps_us=$(least theirs)
    print_row
}

print_row() {
    printf '%-34s %5s %8s %10.4f %7s %8s %9s %9s %9s %8.4f %8s\n' "$name" "$k" "$bodies" "$us" \
        "$(form %.2f "$([ "$base" ] && calc "$us / $base" || echo -)")" \
        "$(form %.3f "$([ "$other_us" ] && calc "$us / $other_us" || echo -)")" \
        "$(form %.1f "$([ "$lammps_us" ] && calc "$lammps_us / $us" || echo -)")" "$contacts" "$their_contacts" "$walls" \
        "$(form %.2f "$([ "$floor_kb" ] && calc "($own_peak - $floor_kb) / $bodies" || echo -)")"
    echo "$name,$k,$bodies,$threads,$steps,$us,$other_us,$lammps_us,$contacts,$their_contacts,$(number wall_contacts own.json),$walls,$own_peak,$(number bytes_per_clump own.json)" >>"$csv"
}

# the bed of N ellipsoids of K spheres in a box; made once
width=0.084 depth=0.0525
bed_of() {
    bed=bed$1
    [ -f $bed.csv ] && return
    write_scene s.json "$(shape_of ellipsoid "$1")" "$(fill 1000 "0, 0, 0" "$width, $depth, 0.2")" "$(box $width $depth)"
    settle s.json $bed 30000
}

# row NAME COMMAND ARGUMENTS: calls COMMAND NAME ARGUMENTS where the row is wanted
row() {
    is_wanted "$1" || return 0
    bed= name=$1 command=$2
    shift 2
    "$command" "$name" "$@"
}

dense() {
    bed_of "$2"
    write_scene s.json "$(shape_of ellipsoid "$2")" "{ \"file\": \"$bed.csv\" }" "$(box $width $depth)"
    time_row "$1" "$2" s.json
    [ "$2" != 8 ] || base=$us
}

# 16 beds beside each other, at rest again
large_dense() {
    [ -f large.csv ] || {
        bed_of 8
        tile bed8.csv 4 4 $width $depth >tiled.csv
        write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "tiled.csv" }' "$(box 0.336 0.21)"
        settle s.json large 3000
    }
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "large.csv" }' "$(box 0.336 0.21)"
    bed=large width=0.336 depth=0.21
    [ "$2" = 1 ] || bed=
    time_row "$1" 8 s.json "$2"
    width=0.084 depth=0.0525
}

two_threads() {
    bed_of 8
    bed=
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "bed8.csv" }' "$(box $width $depth)"
    time_row "$1" 8 s.json 2
}

# grains that fall onto the floor and each other
settling() {
    write_scene s.json "$(shape_of ellipsoid "$2")" "$(fill 1000 "0, 0, 0.002" "$width, $depth, 0.25" "" ', "velocity": [0, 0, -1.5]')" \
        "$(box $width $depth)"
    once "$run" s.json 1 0 1
    mv out/final.csv falling.csv
    bed=falling
    write_scene s.json "$(shape_of ellipsoid "$2")" '{ "file": "falling.csv" }' "$(box $width $depth)"
    time_row "$1" "$2" s.json 1 500 2500
}

hertzian() {
    bed_of 8
    bed=
    young=2e7
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "bed8.csv" }' "$(box $width $depth)" "$(hertz)"
    settle s.json hertzian 3000
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "hertzian.csv" }' "$(box $width $depth)" "$(hertz)"
    young=
    time_row "$1" 8 s.json
}

in_funnel() {
    funnel >funnel.stl
    walls=$([ "$2" = mesh ] && echo '"funnel": { "mesh": "funnel.stl", "material": "glass" }' || smooth_funnel)
    [ -f poured.csv ] || {
        write_scene s.json "$(shape_of ellipsoid 8)" "$(fill 1000 "-0.035, -0.035, 0.04" "0.035, 0.035, 0.25")" "$(smooth_funnel)"
        settle s.json poured 30000
    }
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "poured.csv" }' "$walls"
    settle s.json "poured_$2" 3000
    write_scene s.json "$(shape_of ellipsoid 8)" "{ \"file\": \"poured_$2.csv\" }" "$walls"
    time_row "$1" 8 s.json
}

# scans of shapes/clumps, in the box scaled to 8 mm
scanned() {
    write_scene s.json "$(shape_of "$2" 0)" "$(fill 1000 "0, 0, 0" "$width, $depth, 0.25" ', "size": "8 mm"')" "$(box $width $depth)"
    settle s.json scanned 30000
    write_scene s.json "$(shape_of "$2" 0)" '{ "file": "scanned.csv" }' "$(box $width $depth)"
    time_row "$1" "${2#*-}" s.json
}

# slim NAME KIND K: rods or plates; what has fallen still turns for long
slim() {
    write_scene s.json "$(shape_of "$2" "$3")" "$(fill 1000 "0, 0, 0" "0.06, 0.06, 0.25")" "$(box 0.06 0.06)"
    settle s.json slim 20000
    write_scene s.json "$(shape_of "$2" "$3")" '{ "file": "slim.csv" }' "$(box 0.06 0.06)"
    settle s.json slim 20000 40
    time_row "$1" "$3" s.json
}

# a twentieth of the room is grains, at 1 m/s each
gas() {
    write_scene s.json "$(shape_of ellipsoid 8)" "$(fill 2000 "0, 0, 0" "0.206, 0.206, 0.206")" "" "$(linear)" "$(periodic 0.206 0.206 0.206)" 0
    once "$run" s.json 1 0 1
    awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; srand(1) }
        NR > 1 { for (c = 0; c < 3; c++) $(at["vx"] + c) = 3.46 * (rand() - 0.5) } { print }' out/final.csv >gas.csv
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "gas.csv" }' "" "$(linear)" "$(periodic 0.206 0.206 0.206)" 0
    time_row "$1" 8 s.json 1 500
}

# sizes NAME RATIO COUNT WIDTH HEIGHT WEIGHT STEPS: sizes down to a share of 40 mm, half of the mass below the middle of
# the logarithms, brought to rest by a strong weight
sizes() {
    young=1e8
    law='"normal": { "stiffness_from": "young", "restitution": 0.5 }, "friction": { "coefficient": 0.5 }'
    size='"size": { "law": "table", "sizes": ['$(calc "0.04 / $2 \", \" 0.04 / sqrt($2)")', 0.04], "passing": [0, 0.5, 1], "by": "mass" }'
    old=$step
    step='"auto"'
    write_scene s.json "$(shape_of ellipsoid 8)" "$(fill "$3" "0, 0, 0" "$4, $4, $5" ", $size")" "$(box "$4" "$4")" "$law" "" "$6"
    settle s.json sizes "$7"
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "sizes.csv" }' "$(box "$4" "$4")" "$law" "" "$6"
    young=
    time_row "$1" 8 s.json
    step=$old
}

# a bed without sides, repeated NX x NY times [WARMUP STEPS]
sweep() {
    [ -f endless.csv ] || {
        write_scene s.json "$(shape_of ellipsoid 8)" "$(fill 1000 "0, 0, 0" "$width, $depth, 0.2")" "$(plane floor "0, 0, 0" "0, 0, 1")" \
            "$(linear)" "$(periodic $width $depth)"
        settle s.json endless 30000
    }
    tile endless.csv "$2" "$3" $width $depth >tiled.csv
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "tiled.csv" }' "$(plane floor "0, 0, 0" "0, 0, 1")" "$(linear)" \
        "$(periodic "$(calc "$2 * $width")" "$(calc "$3 * $depth")")"
    time_row "$1" 8 s.json 1 "${4:-100}" "${5:-}"
    echo "$bodies $us" >>sweep
    rm tiled.csv
}

# the slope of log time over log bodies
exponent() {
    [ "$(wc -l <sweep)" -gt 1 ] || return 0
    awk '{ x = log($1); y = log($1 * $2); n++; a += x; b += y; c += x * x; d += x * y }
        END { printf "time of a step grows as bodies^%.3f\n", (n * d - a * b) / (n * c - a * a) }' sweep
}

# seconds COMMAND...: on the clock, least of `repeats`
seconds_of() {
    : >clock
    for repeat in $(seq "$repeats"); do
        begin=$(date +%s%N)
        "$@" >/dev/null
        echo $(($(date +%s%N) - begin)) >>clock
    done
    calc "$(least clock) / 1e9"
}

start_up() {
    mkdir -p start
    write_scene s.json "$(shape_of ellipsoid 8)" "$(fill 10 "0, 0, 0" "$width, $depth, 0.2")" "$(box $width $depth)"
    funnel >funnel.stl
    write_scene m.json "$(shape_of ellipsoid 8)" "$(fill 10 "-0.03, -0.03, 0.04" "0.03, 0.03, 0.2")" '"f": { "mesh": "funnel.stl", "material": "glass" }'
    plain=$(seconds_of "$run" s.json -q --steps 1 -o start)
    frames=$(seconds_of "$run" s.json -q --steps 1 -o start -D output.frames=1 -D output.series=1)
    mesh=$(seconds_of "$run" m.json -q --steps 1 -o start)
    printf 'start-up, 10 bodies and 1 step: %.0f ms; with frames and series %.0f ms; with a mesh wall %.0f ms\n' "$(calc "$plain * 1e3")" \
        "$(calc "$frames * 1e3")" "$(calc "$mesh * 1e3")"
    echo "start-up,,,,,,,,,,,,,
start_plain_s,$plain
start_frames_s,$frames
start_mesh_s,$mesh" >>"$csv"
}

# frames so often that a tenth of a second has several
writing() {
    bed_of 8
    write_scene s.json "$(shape_of ellipsoid 8)" '{ "file": "bed8.csv" }' "$(box $width $depth)"
    "$run" s.json -q -j 1 --warmup 100 --steps 2000 -o out --json >out.json
    without=$(number loop_seconds out.json)
    "$run" s.json -q -j 1 --warmup 100 --steps 2000 -o out -D output.frames=1e-3 --json >out.json
    printf 'a frame every 100 steps: run %.3f s in place of %.3f s, %.1f ms for a frame of 1000 clumps\n' \
        "$(number loop_seconds out.json)" "$without" "$(calc "$(pass output out.json) / 20 * 1e3")"
}

packing() {
    "$BUILD/dem-grain" --kind harmonics --seed 7 --triangles 20000 -o grain.obj -q
    for n in 50 500; do
        one=$(seconds_of "$BUILD/dem-clump" grain.obj -j 1 -n $n -q -o c.json)
        two=$(seconds_of "$BUILD/dem-clump" grain.obj -j 2 -n $n -q -o c.json)
        printf 'dem-clump, %d spheres, 20000 triangles: %.2f s, two cores %.2f s (x %.2f)\n' $n "$one" "$two" "$(calc "$one / $two")"
        echo "clump_${n}_s,$one
clump_${n}_two_cores_s,$two" >>"$csv"
    done
}

# memory that does not grow with the bodies
write_scene s.json "$(shape_of ellipsoid 8)" "$(fill 1 "0, 0, 0" "$width, $depth, 0.2")" "$(box $width $depth)"
once "$run" s.json 1 0 10
floor_kb=$peak
: >sweep

heading
row "dense k=8" dense 8
for k in 1 20 50 100; do row "dense k=$k" dense $k; done
[ "$quick" ] || row "dense k=1000" dense 1000
row "dense k=8, 2 threads" two_threads
row "settling k=8" settling 8
row "hertz-mindlin k=8" hertzian
row "smooth cone k=8" in_funnel smooth
row "mesh cone k=8" in_funnel mesh
row "dilute gas k=8" gas
row "rods of 20, 10 : 1" slim rod 20
row "plates of 25, 5 : 5 : 1" slim plate 25
row "scanned grain, 50 spheres" scanned worn-50
if [ -z "$quick" ]; then
    row "settling k=50" settling 50
    row "scanned grain, 200 spheres" scanned worn-200
    row "sizes 1 : 10" sizes 10 3000 0.12 0.4 -1000 12000
    row "sizes 1 : 100" sizes 100 10000 0.08 0.15 -10000 12000
    row "dense k=8" large_dense 1
    row "dense k=8, 2 threads" large_dense 2
    row "endless bed k=8" sweep 1 1
    row "endless bed k=8" sweep 2 5
    row "endless bed k=8" sweep 8 13
    row "endless bed k=8" sweep 25 40
    exponent
    # 12 million, 3 GB on disk and half an hour; only when asked for
    [ -z "$wanted" ] || row "largest k=8" sweep 86 140 10 20
fi
row "writing frames" writing
row "start-up" start_up
row "dem-clump" packing
echo "all figures: $csv"
