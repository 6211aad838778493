#!/bin/bash
# dem-clump: outputs, formats, batches, and that seed, threads and a resumed thought give the same bits.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77
grains=$source/shapes/grains

# figure NAME: a number of the --json object
figure() { tr ',{}' '\n\n\n' <out | awk -v k="\"$1\":" '$1 == k { print $2; exit }'; }
at_most() { awk -v a="$(figure "$1")" -v b="$2" 'BEGIN { exit !(a != "" && a <= b && -a <= b) }' || fail "$ran: $1 is $(figure "$1"), not within $2"; }

# the default: NAME.json here, a screen of text
run 0 dem-clump "$grains/angular.obj" -n 20
prints 'IoU gap'
prints 'wrote angular.json'
[ -s angular.json ] || fail "no angular.json"
[ "$(wc -l <out)" -le 40 ] || fail "more than a screen"

# exact moments, one piece, a sane gap; also as JSON, with the mesh's mass
run 0 dem-clump "$grains/concave.obj" -n 30 --json -o c.json
at_most volume_error 1e-6
at_most centre_offset 1e-6
at_most inertia_error 1e-6
at_most iou_gap 0.2
[ "$(figure pieces)" = 1 ] || fail "not one piece"
prints '"moments": "exact"'
run 0 dem-clump "$grains/concave.obj" -n 30 --moments free --json -o c.json
prints '"moments": "free"'

# units, size, density
run 0 dem-clump "$grains/sand.obj" -n 5 --effort fast --json -o c.json
mass=$(figure mass)
run 0 dem-clump "$grains/sand.obj" -n 5 --effort fast --unit mm --density "1.325 g/cm3" --json -o c.json
awk -v a="$(figure mass)" -v b="$mass" 'BEGIN { exit !(a / b > 0.4999999e-9 && a / b < 0.5000001e-9) }' || fail "units: mass $(figure mass) of $mass"
run 0 dem-clump "$grains/sand.obj" -n 5 --effort fast --size 2mm --json -o c.json
at_most equivalent_diameter 0.002000000001
run 0 dem-clump "$grains/sand.obj" -n 5 --effort fast --mass-from union --moments free --json -o c.json
prints '"mass_from": "union"'

# the same bits for any number of threads, another seed is another clump
for threads in 1 2 3; do
    run 0 dem-clump "$grains/flat.obj" -n 25 --effort fast -j $threads -q -o "$threads.xyzr" --frame mesh
done
cmp -s 1.xyzr 2.xyzr && cmp -s 1.xyzr 3.xyzr || fail "threads change the clump"
run 0 dem-clump "$grains/flat.obj" -n 25 --effort fast --seed 2 -q -o other.xyzr --frame mesh
cmp -s 1.xyzr other.xyzr && fail "the seed changes nothing"

# every format; standard output; standard input
formats="json xyzr vtp stl"
# a picture takes seconds, under a sanitizer minutes; test_picture covers it there
[ "${DEM_EMBREE:-1}" = 1 ] && [ -z "${DEM_SANITIZE:-}" ] && formats="$formats png"
for format in $formats; do
    run 0 dem-clump "$grains/sand.obj" -n 5 --effort fast -q -o "grain.$format"
    [ -s "grain.$format" ] || fail "no grain.$format"
    run 0 dem-clump "$grains/sand.obj" -n 5 --effort fast -q -o - --format "$format"
    # the time a packing took is the only thing that may differ
    diff <(grep -av seconds "grain.$format") <(grep -av seconds out) >/dev/null || fail "$format on standard output differs"
done
[ "$(grep -vc '^#' grain.xyzr)" = 5 ] || fail "grain.xyzr has not 5 lines"
"$tools/dem-clump" - -n 5 --effort fast -q -o piped.xyzr <"$grains/sand.obj" || fail "a mesh from a pipe"
diff <(grep -v '^#' grain.xyzr) <(grep -v '^#' piped.xyzr) >/dev/null || fail "the pipe changes the clump"

# -e: as few spheres as needed, or the best and a warning
run 0 dem-clump "$grains/rounded.obj" -e 5 --json -o c.json
at_most iou_gap 0.05
prints '"reached": true'
run 0 dem-clump "$grains/angular.obj" -e 1 --max-spheres 10 --json -o c.json
prints '"reached": false'
mentions 'warning'

# a side
run 0 dem-clump "$grains/rounded.obj" -n 10 --effort fast --inscribed --json -o c.json
at_most protrusion 1e-3
run 0 dem-clump "$grains/rounded.obj" -n 10 --effort fast --outer --json -o c.json

# a batch: the rest is finished, the table tells, the status too
printf 'v 0 0 0\n' >broken.obj
run 3 dem-clump "$grains/sand.obj" broken.obj "$grains/flat.obj" "$grains/sand.obj" -n 5 --effort fast -o many/ -o many.csv
mentions 'error: broken.obj'
ls many | tr '\n' ' ' | grep -qx 'flat.json sand.json sand_4.json \|flat.json sand.json sand_2.json ' || fail "batch wrote $(ls many)"
[ "$(wc -l <many.csv)" = 5 ] || fail "the table has $(wc -l <many.csv) lines"
[ "$(grep -c ',failed,' many.csv)" = 1 ] || fail "the table does not tell the failure"

# outputs that cannot be had
run 4 dem-clump "$grains/sand.obj" -n 1 -q -o /dev/full --format json
mentions 'error: /dev/full: cannot write'
run 4 dem-clump "$grains/sand.obj" -n 1 -q -o no/such/folder.json
mentions 'cannot write'
run 2 dem-clump "$grains/sand.obj" -o grain.unknown
mentions 'format'
run 2 dem-clump
run 2 dem-clump "$grains/sand.obj" -n 0
run 2 dem-clump "$grains/sand.obj" --efort fast
mentions 'did you mean'
run 2 dem-clump "$grains/sand.obj" --density -3
run 2 dem-clump "$grains/sand.obj" --unit parsec
run 2 dem-clump "$grains/sand.obj" --method magic
mentions 'methods'

# interrupted: status 130 and no half file
"$tools/dem-clump" "$grains/concave.obj" -n 1000 --effort best -q -o interrupted.json 2>err &
child=$!
sleep 1
kill -INT $child 2>/dev/null
wait $child
status=$?
[ $status = 130 ] || fail "interrupted: status $status"
ls | grep -q '^interrupted' && fail "interrupted: left $(ls | grep ^interrupted)"
finish
