#!/bin/bash
# dem-grain: the shipped grains, every format, refusals, and what happens when the output cannot be had.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-grain" ] || exit 77

# the same but for the last digit, where another mathematics library may round otherwise
same_grain() {
    awk 'NR == FNR { line[NR] = $0; n = NR; next }
         { m = split(line[FNR], a, " "); if (m != NF) exit 1
           for (i = 1; i <= NF; i++) if ($1 == "v" && i > 1 ? (a[i] - $i) ^ 2 > 1e-16 : a[i] != $i) exit 1 }
         END { if (n != FNR) exit 1 }' "$1" "$2"
}
count=0
while read -r tool arguments; do
    [ "$tool" = dem-grain ] || continue
    run 0 dem-grain -q $arguments
    name=${arguments##* }
    same_grain "$name" "$source/shapes/grains/$name" || fail "$name is not what its line of origin makes"
    [ "$(stat -c %s "$name")" -lt 250000 ] || fail "$name is larger than 250 kB"
    run 0 dem-clump "$name" --repair strict -n 1 --effort fast -o c.json
    rm "$name"
    count=$((count + 1))
done <"$source/shapes/grains/README.md"
[ "$count" = "$(ls "$source"/shapes/grains/*.obj | wc -l)" ] || fail "README.md has $count grains, the folder has not"

# reports
run 0 dem-grain --kind facets --size 20mm -o a.obj
prints '^a.obj: facets, seed 1$'
prints 'equivalent diameter  20 mm$'
run 0 dem-grain --kind facets --size 20mm --dents 1 --json -o b.obj
prints '"equivalent_diameter": 0.0(2|1999999999|2000000000)'
prints '"command": "dem-grain --kind facets --seed 1 --triangles 3000 --dents 1 --size 0.02"'
command=$(sed -n 's/.*"command": "dem-grain \(.*\)",/\1/p' out)
run 0 dem-grain $command -q -o again.obj
cmp -s b.obj again.obj || fail "the command in the report makes another grain"
grep -q "^# dem-grain $command\$" b.obj || fail "the file does not say where it comes from"
run 0 dem-grain --list
prints '^harmonics: '
prints '^facets: '
prints '^ellipsoid: '
prints '^superquadric: '
prints '^polyhedron: '
prints '^rock: '
prints '--d2 '
run 0 dem-grain --list --json
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys; k = json.load(open("out"))["kinds"]; sys.exit(len(k) < 3)' || fail "--list --json"
fi

# formats, and standard output
run 0 dem-grain -q --triangles 720 -o a.stl
[ "$(stat -c %s a.stl)" = $((84 + 50 * 720)) ] || fail "a.stl has the wrong size"
run 0 dem-grain -q --triangles 500 -o a.PLY
head -c 4 a.PLY | grep -q '^ply' || fail "a.PLY is no PLY"
run 0 dem-grain -q --triangles 500 -o a.off
head -n 1 a.off | grep -q '^OFF$' || fail "a.off is no OFF"
run 0 dem-grain -q --triangles 500 -o a.obj
run 0 dem-grain --triangles 500
cmp -s out a.obj || fail "standard output differs from the file"
run 0 dem-grain --triangles 500 -o -
cmp -s out a.obj || fail "-o - differs from the file"

# the same grain on any number of threads, another one for another seed
run 0 dem-grain -q -j1 --triangles 100000 -o 1.obj
run 0 dem-grain -q -j3 --triangles 100000 -o 3.obj
cmp -s 1.obj 3.obj || fail "the number of threads changes the grain"
run 0 dem-grain -q --triangles 500 --seed 2 -o 2.obj
cmp -s 2.obj a.obj && fail "the seed does not matter"

# refusals
refuses() { run 2 dem-grain "${@:2}" -o x.obj; mentions "$1"; one_line; [ ! -e x.obj ] || fail "$ran: wrote"; }
refuses "unknown kind 'harmonic'; did you mean harmonics\?$" --kind harmonic
refuses "unknown kind 'potato'; --list shows all" --kind potato
refuses '--faces belongs to kind facets, not to harmonics' --faces 12
refuses 'd2 must be a number from 0 to 0.4, not 2$' --d2 2
refuses 'faces must be a whole number from 8 to 100, not 12.5$' --kind facets --faces 12.5
refuses 'n1 must be a number from 2 to 50, not 1$' --kind superquadric --n1 1
refuses 'there is no regular solid of 5 faces' --kind polyhedron --solid 5
refuses '--roughness and --roughness-scale need each other; see' --roughness 1um
refuses 'roughness of that scale takes .* triangles; raise --roughness-scale' --roughness 1nm --roughness-scale 10nm
refuses 'roughness must be a number from 0 to 5e-05, not 0.0001$' --roughness 0.1mm --roughness-scale 0.1mm
refuses '--cells breaks a block of kind rock; add --kind rock' --cells 3
refuses '--dents does not go together with --cells' --kind rock --cells 3 --dents 1
refuses '--block is broken into --cells; say how many' --block 1mm
refuses '--siblings are those of a scan; name it with --fit' --siblings 3
refuses '--d2 is what --fit finds out; leave it out' --fit a.obj --d2 0.1
refuses '--fit makes harmonics; leave --kind out' --fit a.obj --kind rock
refuses '--elongation does not go together with --fit' --fit a.obj --elongation 0.5
refuses '--same-volume and --size are two sizes' --fit a.obj --same-volume --size 1mm
refuses '--kept-degrees 8 leaves nothing to draw' --fit a.obj --siblings 2 --kept-degrees 8 --degree 8
refuses "'x.obj' names a file, but there is to be a folder" --count 2
refuses 'hollowed out to its centre; lower d2 or d8' --d2 0.4 --d8 0.1 --exponent 2 --form -1
run 2 dem-grain -o grain.xyz
mentions "'grain.xyz' names no known format; end it in .obj, .stl, .ply or .off"
run 2 dem-grain --json
mentions 'name a file with -o'

for block in 1mm,2mm 1mm,2mm,3mm,4mm 0 2kg 1mm,,1mm; do
    run 2 dem-grain --kind rock --cells 3 --block "$block" -o b/
    mentions '--block'
    one_line
    [ ! -e b ] || fail "--block $block: wrote"
done
run 2 dem-grain --count 3
mentions 'name the folder to write to'
run 2 dem-grain --count 3 -o -
mentions 'do not fit on standard output'

# families: seeds in the names, each file with the command that makes it again
for kind in harmonics facets ellipsoid superquadric polyhedron rock; do
    run 0 dem-grain --kind $kind --count 3 --seed 9 --triangles 300 --roughness 2um --roughness-scale 0.2mm -j 2 -o f-$kind
    prints "^f-$kind: 3 of $kind, family.csv lists them"
    [ "$(ls f-$kind | wc -l)" = 4 ] || fail "f-$kind has $(ls f-$kind)"
    [ "$(wc -l <f-$kind/family.csv)" = 4 ] || fail "f-$kind/family.csv has $(wc -l <f-$kind/family.csv) lines"
    command=$(sed -n '1s/^# dem-grain //p' f-$kind/$kind-10.obj)
    run 0 dem-grain $command -q -j 1 -o again.obj
    cmp -s f-$kind/$kind-10.obj again.obj || fail "$kind-10.obj is not what its header makes"
    cmp -s f-$kind/$kind-09.obj f-$kind/$kind-11.obj && fail "the seed does not matter to $kind"
done
run 0 dem-grain --count 2 --triangles 300 --format stl --json -o fam/
prints '"count": 2'
prints '"file": "harmonics-2.stl"'
[ "$(stat -c %s fam/harmonics-1.stl)" = $((84 + 50 * 320)) ] || fail "fam/harmonics-1.stl has the wrong size"
# a seed that makes no grain is named and left out
run 1 dem-grain --d2 0.25 --d8 0.03 --count 12 --triangles 200 -o bare/
mentions 'warning: seed [0-9]+ left out: the grain of these descriptors and this seed is hollowed out'
[ "$(($(ls bare | wc -l) - 1 + $(grep -c 'left out' err)))" = 12 ] || fail "bare/ has $(ls bare)"
run 2 dem-grain --kind superquadric --a 1m --b 1mm --c 1um --count 50 -o worse/
mentions 'error: the half axes differ by a factor of 1e\+06'
[ "$(wc -l <err)" = 3 ] || fail "fifty times the same words"

# a block in pieces: read back from the files they fill it
run 0 dem-grain --kind rock --cells 30 --block 4mm,2mm,1mm --triangles 200 --json -o block/
prints '"command": "dem-grain --kind rock --seed 1 --triangles 200 --cells 30 --block 0.004,0.002,0.001"'
awk -F, 'NR > 1 { sum += $4 } END { exit !(NR == 31 && (sum / 8e-9 - 1) ^ 2 < 1e-20) }' block/family.csv ||
    fail "the cells do not fill the block"
awk 'FNR == 1 { n = 0 } $1 == "v" { x[++n] = $2; y[n] = $3; z[n] = $4 }
     $1 == "f" { a = $2; b = $3; c = $4; sum += x[a] * (y[b] * z[c] - z[b] * y[c]) / 6
                 sum += (y[a] * (z[b] * x[c] - x[b] * z[c]) + z[a] * (x[b] * y[c] - y[b] * x[c])) / 6 }
     END { exit !((sum / 8e-9 - 1) ^ 2 < 1e-20) }' block/cell-*.obj || fail "the files do not fill the block"

# twins and siblings of a scan
run 0 dem-grain -q --triangles 20000 --d2 0.12 --d8 0.008 --degree 8 --seed 5 --size 2mm -o scan.stl
run 0 dem-grain --fit scan.stl --degree 8 --json -o twin.obj
prints '"spectrum": \[0.0'
awk '/"fit"/ { match($0, /"distance_rms": [0-9.e-]+/); v = substr($0, RSTART + 16, RLENGTH - 16); ok = v > 0 && v < 1e-3 }
     /"spectrum"/ { gsub(/[^0-9.e, -]/, ""); split($0, d, ","); for (i in d) if (d[i] + 0 > 0.119 && d[i] < 0.121) found = 1 }
     END { exit !(ok && found) }' out || fail "the fit misses D_2 or the scan: $(cat out)"
run 0 dem-grain --fit scan.stl --degree 8 --siblings 3 --seed 4 --same-volume -o sib/
prints 'twin off the scan .* RMS, .* at most'
prints 'spectrum D_1'
volume=$(awk -F, 'NR > 1 { print $4 }' sib/family.csv | cut -c 1-12 | sort -u | wc -l)
[ "$volume" = 1 ] || fail "siblings differ in volume: $(cat sib/family.csv)"
command=$(sed -n '1s/^# dem-grain //p' sib/sibling-5.obj)
run 0 dem-grain $command -q -o alone/
cmp -s alone/sibling-5.obj sib/sibling-5.obj || fail "sibling-5.obj is not what its header makes"
run 0 dem-grain --fit scan.stl --unit mm --degree 4 --size 3mm -o small.obj
prints 'equivalent diameter  3 mm'
run 3 dem-grain --fit nowhere.stl -o x.obj
mentions 'nowhere.stl: no such file'
one_line
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >flat.obj
run 3 dem-grain --fit flat.obj -o x.obj
mentions 'flat.obj: '
[ ! -e x.obj ] || fail "a fit of nothing was written"

# output that cannot be written leaves what was there
echo old >old.obj
chmod -w . && [ ! -w . ] && { run 4 dem-grain -o old.obj; one_line; }
chmod +w .
[ "$(cat old.obj)" = old ] || fail "a failed run touched the old file"
run 4 dem-grain -o nowhere/a.obj
mentions '^dem-grain: error: nowhere/a.obj: cannot write: No such file'
one_line
if [ -c /dev/full ]; then
    "$tools/dem-grain" >/dev/full 2>err
    [ $? = 4 ] || fail "a full disk is not status 4"
fi

# interrupted: status 130, nothing left behind
mkdir stop
"$tools/dem-grain" --triangles 8000000 --degree 30 -o stop/a.obj 2>err >out &
pid=$!
sleep 0.4
kill -TERM $pid
wait $pid
got=$?
[ "$got" = 130 ] || fail "interrupted with status $got"
[ -z "$(ls -A stop)" ] || fail "interrupted, but left $(ls stop)"
ran='dem-grain interrupted' one_line
finish
