#!/bin/bash
# dem-clump --target and --sweep: what is promised holds, and the reports are whole, valid and self-contained.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77
grain=$source/shapes/grains/sand.obj

# ---- targets: the fewest spheres for which all hold
run 0 dem-clump "$grain" --effort fast --target gap=40% --target pieces=1 --target inertia=0.1% --json -o c.json
prints '"reached": true'
prints '"iou_gap": \{"at_most": 0.4[0-9]*, "is": 0.[0-3][0-9]*, "reached": true\}'
grep -q '"targets": *{ *"iou_gap"' c.json || fail "the clump does not tell its targets: $(grep parameters c.json)"
run 0 dem-clump "$grain" --effort fast --moments free --max-spheres 4 --target hausdorff=1% -o c.json
mentions 'warning: .*spheres come to Hausdorff distance of .* %, not the 1 % asked for'
prints 'Hausdorff distance .* %: NOT reached'
run 0 dem-clump "$grain" --method bubble --max-spheres 3 --target gap=1 --json -o c.json
prints '"reached": false'

usage() { run 2 dem-clump "$grain" "${@:2}"; mentions "$1"; one_line; }
usage "did you mean inertia\?" --target inertai=1%
usage 'no measure .quality.; use one of: gap' --target quality=1
usage 'normal must be an angle' --target normal=8%
usage 'inertia must be a percentage' --target inertia=zero
usage 'has no value' --target inertia
usage 'needs a value' --target

# ---- a sweep: the table, and all reports
# pictures take seconds, under a sanitizer minutes
page=(--sweep 9,4 --methods bubble,optimal:fast)
pictures=6
[ -n "${DEM_SANITIZE:-}" ] && page=(--sweep 9 --methods bubble) && pictures=3
run 0 dem-clump "$grain" "${page[@]}" -q -o s.html
silent
run 0 dem-clump "$grain" --sweep 9,4 --methods bubble,optimal:fast -o s.csv -o s.svg
prints '^  bubble +4 +[1-4] '
prints '^  optimal:fast +9 +9 '
[ "$(head -1 s.csv)" = "grain,method,asked,status,spheres,iou_gap,volume_error,distance_mean,distance_max,protrusion,centre_offset,inertia_error,normal_deviation_deg,overlap_ratio,pieces,mesh_volume_m3,union_volume_m3,inertia1_error,inertia2_error,inertia3_error,seconds_s,wall_seconds_s,moments,message" ] ||
    fail "columns: $(head -1 s.csv)"
[ "$(wc -l <s.csv)" = 5 ] || fail "$(wc -l <s.csv) lines of CSV"
[ "$(cut -d, -f2,3 s.csv | tr '\n' ' ')" = "method,asked bubble,4 bubble,9 optimal:fast,4 optimal:fast,9 " ] || fail "rows: $(cut -d, -f2,3 s.csv)"
awk -F, 'NR > 1 && ($4 != "done" || $5 > $3 || $6 <= 0 || $6 >= 1 || $21 <= 0) { exit 1 }' s.csv || fail "figures: $(cat s.csv)"
# the union has the moments of the mesh where it is said to
awk -F, '$2 == "optimal:fast" && $23 == "exact" && ($7 * $7 > 1e-12 || $18 * $18 > 1e-12) { exit 1 }' s.csv || fail "moments: $(cat s.csv)"

# self-contained: nothing from outside but the names of the two languages
for file in s.svg s.html; do
    grep -o 'http[s]*://[^"<> ]*' $file | grep -vx 'http://www.w3.org/\(2000/svg\|1999/xhtml\)' && fail "$file: an address"
    sed 's/base64,[^"]*//' $file | grep -iE '<script|@import|src="[^d]|[^a-z](nan|inf)[^a-z]' >odd && fail "$file: $(head -c 300 odd)"
    if command -v xmllint >/dev/null; then
        xmllint --noout $file 2>err || fail "$file: $(head -3 err)"
    fi
done
grep -q 'sand: error against' s.svg || fail "no title"
for text in 'Clumps of sand' 'IoU gap' 'Mass properties' '<svg' 'dem-clump sand.obj --sweep 9' 'Nothing had to be repaired'; do
    grep -q -- "$text" s.html || fail "the page has no '$text'"
done
if [ "${DEM_EMBREE:-1}" = 1 ]; then
    [ "$(grep -o 'src="data:image/png;base64,iVBORw0KGgo' s.html | wc -l)" = $pictures ] || fail "not $pictures pictures"
else
    grep -q 'without Embree' s.html || fail "the page does not say why it has no pictures"
fi

# the same figures as JSON, in every locale
run 0 dem-clump "$grain" --sweep=4 --methods=bubble --json
prints '"method": "bubble", "asked": 4, "status": "done"'
for locale in C de_DE.UTF-8; do
    LC_ALL=$locale "$tools/dem-clump" "$grain" --sweep 4 --methods bubble -q -o $locale.csv -o $locale.svg 2>err || fail "$locale: $(cat err)"
    cut -d, -f1-20,23- $locale.csv >$locale.cut
done
cmp -s C.cut de_DE.UTF-8.cut || fail "the locale changes the table"
grep -qE '[a-z0-9]="[-0-9]+,[0-9]+"' de_DE.UTF-8.svg && fail "commas in the plots"

# several grains: a report of each; one that cannot be read does not stop the rest
printf 'v 0 0 0\n' >broken.obj
run 3 dem-clump broken.obj "$grain" --sweep 3 --methods bubble -o many/ --json
mentions 'error: broken.obj'
prints '"failed": 1'
[ "$(ls many | tr '\n' ' ')" = "sand.csv sand.html sand.svg " ] || fail "wrote $(ls many)"
usage 'several grains cannot all go to .x.html.; name a folder' "$grain" --sweep 3 -o x.html

# a method that cannot is a row
run 0 dem-clump "$grain" --sweep 3 --methods favier,optimal:fast --outer -o f.csv
prints '^  favier +3  failed: the method favier cannot'
[ "$(cut -d, -f4 f.csv | tr '\n' ' ')" = "status failed done " ] || fail "rows: $(cat f.csv)"

# --methods alone lists; its value may be left out or stand behind
run 0 dem-clump --methods
prints '^optimal: '
usage 'goes with --sweep' --methods bubble
usage 'did you mean optimal\?' --sweep 3 --methods optmal
usage 'no effort' --sweep 3 --methods optimal:quick
usage 'no list of at most' --sweep 3,x
usage 'no list of at most' --sweep 0
usage 'needs a value' --sweep
usage 'leave out -n, -e and --target' --sweep 3 -n 5
usage 'leave out -n, -e and --target' --sweep 3 -e 5
usage 'leave out -n, -e and --target' --sweep 3 --target gap=3
usage 'none of --split' --sweep 3 --split
usage 'a sweep writes .csv, .svg and .html' --sweep 3 -o x.json
usage '--ratio belongs to method bubble' --sweep 3 --methods grid --ratio 0.5
run 4 dem-clump "$grain" --sweep 3 --methods bubble -q -o no/such/folder.csv
mentions 'cannot write'

# stopped: what is there is written, status 130; a slow machine needs longer until there is something
# stop_after SECONDS ARGUMENTS...
stop_after() {
    "$tools/dem-clump" "$grain" "${@:2}" -q 2>err &
    local child=$!
    sleep "$1"
    kill -INT $child 2>/dev/null
    wait $child
    status=$?
    [ $status = 130 ] || fail "interrupted: status $status: $(cat err)"
}
for seconds in 4 15 60 200; do
    stop_after $seconds --sweep 3,20000 --methods bubble,optimal -o i.csv -o i.html
    [ -e i.csv ] && break
done
grep -q ',done,' i.csv || fail "an interrupted sweep left nothing"
grep -q 'Interrupted before the pictures' i.html || [ "${DEM_EMBREE:-1}" = 0 ] || fail "interrupted: pictures"

# a search leaves the best so far
for seconds in 3 12 40 120; do
    stop_after $seconds --effort fast --target gap=0.05% --max-spheres 20000 -o t.json
    [ -s t.json ] && break
done
grep -q '"spheres"' t.json || fail "the interrupted search left nothing"
finish
