#!/bin/bash
# dem-clump on many grains: folders, lists, the growing table, resuming, the contact sheet.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77
fast="-n 1 --effort fast --moments free"

mkdir -p in/deeper/still
for seed in 1 2 3; do
    run 0 dem-grain -q --triangles 80 --seed $seed -o "in/b$seed.stl"
done
cp in/b1.stl in/deeper/b1.stl
cp in/b2.stl in/deeper/still/a.STL
echo 'no mesh' >in/broken.obj
echo 'of the folder' >in/README.txt
cp in/b1.stl in/.hidden.stl

# a folder: its meshes by name, nothing else; the failure is told again at the end
run 3 dem-clump in $fast -o clumps/ -o t.csv
ls clumps | tr '\n' ' ' | grep -qx 'b1.json b2.json b3.json ' || fail "a folder gave $(ls clumps)"
[ "$(cut -d, -f1 t.csv | tr '\n' ' ')" = 'input in/b1.stl in/b2.stl in/b3.stl in/broken.obj ' ] || fail "rows $(cut -d, -f1 t.csv)"
[ -e t.csv.part ] && fail "the table's part was left"
[ "$(tail -1 err | cut -c1-60)" = "dem-clump: 3 made, 1 failed: in/broken.obj: not a mesh; supp" ] || fail "last line: $(tail -1 err)"
run 3 dem-clump in/ $fast -o deep/ --recursive -q
ls deep | tr '\n' ' ' | grep -qx 'a.json b1.json b1_2.json b2.json b3.json ' || fail "--recursive gave $(ls deep)"
mkdir empty
run 3 dem-clump empty $fast -o clumps/
mentions 'empty: no mesh in this folder; --recursive'
run 2 dem-clump in $fast -o one.json

# a list: from its own folder, comments and blanks passed over; from a pipe: from here
printf '# grains\n\n  b3.stl \r\n%s\n' "$PWD/in/b1.stl" >in/list.txt
run 0 dem-clump --list in/list.txt $fast -o listed/
ls listed | tr '\n' ' ' | grep -qx 'b1.json b3.json ' || fail "--list gave $(ls listed)"
[ "$(sed 1d out | cut -d, -f2 | tr '\n' ' ')" = 'b3 b1 ' ] || fail "the list's order: $(cat out)"
printf 'in/b2.stl\n' | "$tools/dem-clump" --list - $fast -q -o piped/ || fail "a list from a pipe"
[ "$(ls piped)" = b2.json ] || fail "a list from a pipe gave $(ls piped)"
echo '# nothing' >none.txt
run 3 dem-clump --list none.txt
mentions 'none.txt: the list names no mesh'
run 3 dem-clump --list missing.txt
mentions 'missing.txt: no such file'

# resuming: what is there is kept with its row, what is not is made
cp t.csv before.csv
rm clumps/b2.json
run 3 dem-clump in $fast -o clumps/ -o t.csv --resume
mentions '1 made, 2 kept from before, 1 failed'
cmp -s <(grep '^in/b[13]' t.csv) <(grep '^in/b[13]' before.csv) || fail "kept rows differ"
rm t.csv
run 3 dem-clump in $fast -o clumps/ -o t.csv --resume
[ "$(grep -c ',kept,1,' t.csv)" = 3 ] || fail "rows from the clump files: $(cat t.csv)"

# JSON: the same grains
run 3 dem-clump in $fast -o clumps/ --json
[ "$(grep -c '"status": "done"' out)" = 3 ] || [ "$(grep -o '"status": "done"' out | wc -l)" = 3 ] || fail "--json: $(head -c 500 out)"
prints '"failed": 1'

# interrupted: what is done is told, the rest can be had later
for seed in 1 2 3 4 5 6 7 8 9; do cp in/b1.stl "in/deeper/c$seed.stl"; done
"$tools/dem-clump" in/deeper -n 60 --effort best -j 1 -o slow/ -o slow.csv >/dev/null 2>err &
child=$!
for _ in $(seq 300); do [ -e slow/b1.json ] && break; sleep 0.1; done
kill -INT $child
wait $child
status=$?
[ $status = 130 ] || fail "interrupted: status $status"
grep -Eq '^dem-clump: interrupted: [0-9] made, [0-9]+ not done; --resume' err || fail "interrupted: $(cat err)"
[ "$(grep -c ',done,' slow.csv)" = "$(ls slow | wc -l)" ] || fail "interrupted: $(ls slow), table $(cut -c1-60 slow.csv)"

# the sheet: one picture of all
if [ "${DEM_EMBREE:-1}" = 1 ] && [ -z "${DEM_SANITIZE:-}" ]; then
    run 3 dem-clump in $fast -o clumps/ -o sheet.png -q
    [ "$(od -An -tx1 -N4 sheet.png)" = ' 89 50 4e 47' ] || fail "no sheet"
    # four cells in a square of two
    [ "$(od -An -tu1 -j16 -N8 sheet.png | awk '{ print $3 * 256 + $4, $7 * 256 + $8 }')" = '504 324' ] || fail "the sheet's size"
fi
finish
