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
refuses 'hollowed out to its centre; lower d2 or d8' --d2 0.4 --d8 0.1 --exponent 2 --form -1
run 2 dem-grain -o grain.xyz
mentions "'grain.xyz' names no known format; end it in .obj, .stl, .ply or .off"
run 2 dem-grain --json
mentions 'name a file with -o'

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
