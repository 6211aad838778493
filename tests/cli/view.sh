#!/bin/bash
# dem-view: runs, frames, sequences, clumps, meshes, sheets, and what is said when things are wrong.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-view" ] && [ -x "$tools/dem-run" ] || exit 77
grains=$source/shapes/grains
clumps=$source/shapes/clumps

# width and height of a PNG file
size_of() { od -An -tu1 -j16 -N8 "$1" | awk '{ print $1 * 16777216 + $2 * 65536 + $3 * 256 + $4 "x" $5 * 16777216 + $6 * 65536 + $7 * 256 + $8 }'; }
is_png() { # FILE WIDTHxHEIGHT
    [ "$(head -c 4 "$1" 2>/dev/null | tail -c 3)" = PNG ] || { fail "$ran: $1 is no PNG file"; return; }
    [ "$(size_of "$1")" = "$2" ] || fail "$ran: $1 is $(size_of "$1"), not $2"
}

cat >scene.json <<'END'
{ "schema": "dem-scene/1", "gravity": [0, 0, -9.81], "time": { "end": "20 ms", "step": "50 us" },
  "materials": { "stone": { "density": 2500 } },
  "contacts": [ { "between": ["stone", "stone"], "normal": { "law": "linear", "stiffness": 2e4, "restitution": 0.5 } } ],
  "shapes": { "ball": { "sphere": { "radius": "8 mm" }, "material": "stone" },
              "pair": { "spheres": [[-0.003, 0, 0, 0.006], [0.003, 0, 0, 0.006]], "material": "stone" } },
  "bodies": [ { "shape": "ball", "position": [0.02, 0.03, 0.05], "velocity": [0.1, 0, 0] },
              { "shape": "pair", "position": [0.05, 0.03, 0.03] }, { "shape": "pair", "position": [0.07, 0.05, 0.06] } ],
  "walls": { "box": { "box": { "min": [0, 0, 0], "max": [0.1, 0.08, 0.1] }, "material": "stone" },
             "lid": { "plane": { "point": [0, 0, 0.12], "normal": [0, 0, -1] }, "material": "stone",
                      "motion": { "translate": { "velocity": [0, 0, "-0.5 m/s"] } } } },
  "output": { "directory": "results", "frames": "5 ms" } }
END
run 0 dem-run scene.json -q

run 0 dem-view --help
[ "$(awk '{ if (length > n) n = length } END { print n }' out)" -le 100 ] || fail "help wider than 100 columns"

# ---- wrong usage is found without drawing anything
usage() { run 2 dem-view "${@:2}"; one_line; mentions "$1"; }
usage 'name the output directory of a run, or clumps or meshes'
usage 'name the file to write' out
usage 'both want standard output' results -o - --json
usage "did you mean speed\?" results -o a.png --colour sped
usage "take one of: size speed" results -o a.png --colour quartz-content
usage "'velocity' has 3 components, ':w' is none of them; write velocity:0" results -o a.png --colour velocity:w --frame 0
usage 'is no range; write LOW..HIGH' results -o a.png --colour speed --range 3
usage 'ends before it begins' results -o a.png --colour speed --range 3..1
usage "'mm' is not a unit of velocity" results -o a.png --colour speed --range '0..3 mm'
usage '-range needs numbers to show' results -o a.png --range 0..3
usage 'is no condition; write FIELD<VALUE' results -o a.png --clip x=3
usage "'Pa' is not a unit of length" results -o a.png --clip 'x<3Pa'
usage 'is no list of numbers' results -o a.png --bodies 1,b
usage 'write WIDTHxHEIGHT' results -o a.png --size 300
usage 'take white, black, grey' results -o a.png --background pink
usage '-up must be x, y, z' results -o a.png --up w
usage 'is no point; write' results -o a.png --look-at 1,2
usage 'give one of them' results -o a.png --time 0.01 --frame 2
usage "no frame '9'; the run has 5, counted from 0" results -o a.png --frame 9
usage 'no frame near 0.1 s; take a time from 0 s to 0.02 s' results -o a.png --time 0.1
usage '5 pictures need names with a number' results -o a.png --frames all
usage 'the run has only 5 frames' results -o a%d.png --frames 2-7
usage 'tells no frames' results -o a%d.png --frames some
usage 'a sequence shows one run' results results -o a%d.png --frames all
usage 'only the directory of a run has frames' "$clumps/sand.json" -o a.png --frame 1
usage 'are for runs' "$clumps/sand.json" -o a.png --colour speed
usage 'contacts are those of a run' "$clumps/sand.json" -o a.png --contacts
usage 'leave --colour, --clip and --bodies out' results -o a.png --contacts --colour speed
usage "'parsec' is not a unit of length" "$grains/sand.obj" -o a.png --unit parsec
[ ! -e a.png ] || fail "a picture in spite of wrong usage"

# ---- bad input
bad() { run 3 dem-view "${@:2}" -o a.png; one_line; mentions "$1"; }
bad 'nowhere: no such file' nowhere
bad 'nowhere.json: no such file' nowhere.json
mkdir -p empty broken/frames
bad 'holds neither a run \(run.json\) nor clumps or meshes' empty
echo '{}' >broken/run.json
bad 'holds no scene; name the output directory of dem-run' broken
head -c 1000 results/frames/000001.vtp >broken/frames/cut.vtp
bad 'cut.vtp: is (cut short by|not a VTP file)' broken/frames/cut.vtp
cp results/frames/000001.vtp alone.vtp
bad 'leave it in the folder frames beside run.json' alone.vtp
echo '{"schema": "dem-clump/1"}' >wrong.json
bad 'wrong.json: ' wrong.json
sed 's/<Points>/<points>/' results/frames/000001.vtp >broken/frames/other.vtp
bad 'is not a VTP file as these tools write it \(byte [0-9]+\)' broken/frames/other.vtp
[ ! -e a.png ] || fail "a picture of bad input"

if [ "$DEM_EMBREE" = 0 ]; then
    run 3 dem-view results -o a.png
    one_line
    mentions 'Embree'
    finish
fi

# ---- runs
small="--size 160x120"
run 0 dem-view results -o last.png $small
prints '^last.png: 3 bodies at t = 20 ms$'
is_png last.png 160x120
run 0 dem-view results -o default.png -q --samples 1 --width 300
silent
is_png default.png 300x1600
run 0 dem-view results -o - $small
is_png out 160x120
cmp -s out last.png || fail "$ran: another picture on standard output"
run 0 dem-view results/ -j 1 -q -o one.png $small
cmp -s one.png last.png || fail "the picture depends on the number of threads"

run 0 dem-view results -o a.png $small --json --colour velocity:z --frame 2
prints '"file": "a.png", "frame": 2, "time": 0.01'
prints '"colour": "velocity z", "unit": "m/s", "range": \['
prints '"warnings": \[\]'
run 0 dem-view results/frames/000002.vtp -o b.png $small --colour velocity:z
cmp -s a.png b.png || fail "a frame and its file give different pictures"
run 0 dem-view results -o b.png $small --colour velocity:z --time 0.011
cmp -s a.png b.png || fail "the frame nearest to 11 ms is not that of 10 ms"
run 0 dem-view results -o b.png $small --frame last --colour coordination --range 0..3
prints 'coordination from 0 to 3$'
run 0 dem-view results -o b.png $small --colour speed --range '0..200 mm/s' --frame 0
prints '3 bodies at t = 0 s, speed from 0 mm/s to 200 mm/s$'

# clips remove, lists keep; both can leave nothing
run 0 dem-view results -o b.png $small --clip 'x<30mm' --frame 1
prints '^b.png: 2 bodies'
run 0 dem-view results -o b.png $small --clip 'x<30mm' --clip 'velocity:x >= 0 m/s' --frame 1
prints '^b.png: 0 bodies'
run 0 dem-view results -o b.png $small --bodies 0,2-
prints '^b.png: 2 bodies'
run 0 dem-view results -o b.png $small --bodies 1 --clip 'mass<1 kg' --colour size
prints '^b.png: 0 bodies'

# everything that changes a picture does
run 0 dem-view results -o plain.png $small --frame 1 -q
for option in --spheres --no-walls --no-labels --orthographic "--zoom 2" "--azimuth 10" "--elevation 60" "--up x" \
    "--look-at 0,0,50mm" "--background #203040" "--label-size 12" "--samples 1" "--colour shape" "--frame 3" "--bodies 0,1"; do
    case $option in
    --frame*) run 0 dem-view results -o b.png $small -q $option ;;
    --spheres) continue ;;  # these clumps keep no surfaces
    *) run 0 dem-view results -o b.png $small --frame 1 -q $option ;;
    esac
    cmp -s plain.png b.png && fail "$option changes nothing"
    is_png b.png 160x120
done

# ---- sequences
run 0 dem-view results -o 'frames/deep/%03d.png' $small --frames all --colour speed
[ "$(ls frames/deep)" = "$(printf '%03d.png\n' 0 1 2 3 4)" ] || fail "$ran: wrote $(ls frames/deep)"
[ "$(sed 's/.*speed //' out | sort -u | wc -l)" = 1 ] || fail "$ran: several ranges: $(cat out)"
run 0 dem-view results -o 'f%d.png' $small --frames '1-4 every 2' -q
[ "$(ls f?.png | tr '\n' ' ')" = 'f1.png f3.png ' ] || fail "$ran: wrote $(ls f?.png)"

# ---- a run that was stopped has no last state but its last frame
cp -r results stopped
rm stopped/final.csv
run 0 dem-view stopped -o b.png $small
prints 'at t = 20 ms$'

# ---- clumps and meshes
run 0 dem-view "$clumps/sand.json" -o both.png --size 200x100
prints '^both.png: 1 picture$'
is_png both.png 200x100
run 0 dem-view "$clumps/sand.json" -o spheres.png --size 200x100 --spheres
run 0 dem-view "$clumps/sand.json" -o surface.png --size 200x100 --surface
cmp -s both.png spheres.png || cmp -s both.png surface.png || cmp -s spheres.png surface.png && fail "spheres, surface and both are the same"
run 0 dem-view "$grains/sand.obj" -o bare.png --size 100x100
run 0 dem-view "$grains/sand.obj" -o a.png --size 100x100 --unit mm
cmp -s bare.png a.png && fail "no scale bar with --unit"
run 0 dem-view "$grains/sand.obj" -o a.png --size 100x100 --azimuth 30
cmp -s bare.png a.png && fail "--azimuth changes no mesh"
run 0 dem-view "$grains/sand.obj" -o a.png --size 100x100 --perspective
cmp -s bare.png a.png && fail "--perspective changes no mesh"
run 0 dem-view results/shapes/pair.vtp -o a.png --size 100x100
if [ -x "$tools/dem-clump" ]; then
    run 0 dem-clump "$grains/sand.obj" -n 8 -o s.vtp -o s.json -q
    run 0 dem-view s.vtp -o a.png --size 100x100 --no-labels
    run 0 dem-view s.json -o b.png --size 100x100 --no-labels --spheres
    cmp -s a.png b.png || fail "the spheres of a .vtp are not those of the .json"
fi

# ---- sheets
files=("$clumps"/*.json)
count=${#files[@]}
run 0 dem-view "$clumps" -o sheet.png --size 240x90
prints "^sheet.png: $count pictures\$"
is_png sheet.png 240x90
run 0 dem-view "$clumps" "$grains/sand.obj" results -o sheet.png --size 240x200 --columns 2 --same-scale
prints "$((count + 2)) pictures"
run 0 dem-view "$clumps" -o a.png --size 240x90 --no-names
cmp -s a.png sheet.png && fail "--no-names changes nothing"
run 2 dem-view "$clumps" -o a.png --size 20x20
mentions 'do not fit into 20 x 20 pixels; give a larger --size'

# ---- wear
run 2 dem-view results -o a.png --colour wear
mentions 'there is no wear to show; give a wall "wear"'
sed 's|"normal": \[0, 0, -1\] }, "material": "stone",|"normal": [0, 0, -1], "radius": "0.2 m" }, "material": "stone",\
         "wear": { "law": "finnie", "pressure": "1 GPa", "constant": 2 },|' scene.json >worn.json
run 0 dem-run worn.json -q -o worn -D time.end=0.1 -D 'bodies.0.velocity=[1, 0, 1]'
run 0 dem-view worn -o worn.png $small --colour wear
prints '^worn.png: [0-9]+ bodies at t = '
run 0 dem-view worn -o fresh.png $small --colour wear --frame 0 --range 0..1nm
cmp -s worn.png fresh.png && fail "wear does not show"

# ---- contacts
run 3 dem-view results -o a.png --contacts
mentions 'has no network of contacts; give the scene an interval of contacts'
run 0 dem-run scene.json -q -o net -D output.contacts=1ms -D time.end=60ms -D contacts.0.normal.restitution=0.1
run 0 dem-view net -o chains.png $small --contacts
prints '^chains.png: [0-9]+ contacts at t = 60 ms, force from '
is_png chains.png 160x120
run 0 dem-view net -o many%d.png $small --contacts --frames all --range 0..2 -q
cmp -s many12.png many11.png && fail "all times have the same contacts"
echo junk >net/frames/contacts_000060.vtp
run 3 dem-view net -o a.png $small --contacts
mentions 'net/frames/contacts_000060.vtp: is not a VTP file'

# ---- nowhere to write
run 4 dem-view results -o /proc/nowhere/a.png $small
one_line
finish
