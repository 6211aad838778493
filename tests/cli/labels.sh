#!/bin/bash
# dem-clump on images of labels: one clump per label, where it lies; what is left out is told, what is broken refused.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77
fast="-n 4 --effort fast --moments free"

# voxels: labels of two touching ellipsoids (3 and 12), a speck (5) and a ball at the border (40), as text
voxels() {
    awk 'BEGIN { for (z = 0; z < 14; z++) for (y = 0; y < 16; y++) { line = ""; for (x = 0; x < 30; x++) {
        l = 0
        if (((x - 8) / 7) ^ 2 + ((y - 8) / 5.5) ^ 2 + ((z - 7) / 5) ^ 2 <= 1) l = 3
        else if (((x - 20) / 5.5) ^ 2 + ((y - 8) / 5.5) ^ 2 + ((z - 7) / 5) ^ 2 <= 1) l = 12
        if (x == 1 && y < 3 && z == 1) l = 5
        if ((x - 29) ^ 2 + (y - 1) ^ 2 + (z - 1) ^ 2 <= 25) l = 40
        line = line (x ? " " : "") l }
        print line } }'
}
header() { printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 30 16 14\nencoding: ascii\n%b\n' "$1"; }
{ header 'spacings: 5 5 5\nspace units: "um" "um" "um"\n'; voxels; } >scan.nrrd

# column NAME LABEL of the table t.csv
column() { awk -F, -v name="$1" -v grain="$2" 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i } NR > 1 && $c["label"] == grain { print $c[name] }' t.csv; }
near() { awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { exit !(a - b <= t && b - a <= t) }' || fail "$ran: $1, not $2 within $3"; }

run 0 dem-clump scan.nrrd $fast -o clumps/ -o t.csv
ls clumps | tr '\n' ' ' | grep -qx 'scan_12.json scan_3.json scan_bodies.csv scan_scene.json ' || fail "clumps: $(ls clumps)"
mentions 'warning: scan.nrrd: left out 2 labels of fewer than 500 voxels'
mentions '^dem-clump: 2 made$'
# in metres, the surface with the volume of the voxels, the centre where it lies in the image
near "$(column volume_m3 3)" "$(column voxel_volume_m3 3)" 2e-17
near "$(column voxel_volume_m3 3)" "$(awk -v n="$(column voxels 3)" 'BEGIN { print n * 125e-18 }')" 1e-22
near "$(column centre_x_m 3)" 40e-6 1e-6
near "$(column centre_x_m 12)" 100e-6 3e-6
near "$(column centre_z_m 12)" 35e-6 1e-6
grep -q '"position"' clumps/scan_3.json || fail "the clump does not tell where it lies"
# and as a scene
[ "$(wc -l <clumps/scan_bodies.csv)" = 3 ] || fail "bodies: $(cat clumps/scan_bodies.csv)"
if [ -x "$tools/dem-run" ]; then
    run 0 dem-run --check clumps/scan_scene.json
    prints '2 bodies of 8 spheres'
fi

# what is asked for
run 3 dem-clump scan.nrrd $fast -o border/ --min-voxels 20 --labels 40 --drop-border
mentions 'none of 4 labels is left'
run 2 dem-clump scan.nrrd --labels 3-
run 2 dem-clump scan.nrrd --labels 0
run 2 dem-clump scan.nrrd -o one.json
mentions 'several grains'

# units: of the header, of the command line, none
{ header ''; voxels; } >plain.nrrd
run 0 dem-clump plain.nrrd $fast -o some/ -o t.csv --labels 1-4,99 --unit um
[ "$(ls some/*[0-9].json)" = some/plain_3.json ] || fail "--labels: $(ls some)"
near "$(column volume_m3 3)" "$(awk -v n="$(column voxels 3)" 'BEGIN { print n * 1e-18 }')" 2e-19
run 0 dem-clump plain.nrrd $fast -o c/ -o t.csv --labels 3 --voxel-size 5um,5um,10um
near "$(column volume_m3 3)" "$(awk -v n="$(column voxels 3)" 'BEGIN { print n * 250e-18 }')" 4e-17
run 0 dem-clump plain.nrrd $fast -o border/ -o t.csv --min-voxels 20 --labels 40
mentions 'cut flat by the border'
[ "$(column status 40)" = done ] || fail "a grain at the border"
mentions 'tells no unit'
mentions 'tells no size'
run 2 dem-clump plain.nrrd --voxel-size 5um,5um
run 2 dem-clump plain.nrrd --voxel-size -5um

# the same voxels raw and packed give the same clump
voxels | tr ' ' '\n' | awk '{ printf "\\%03o", $1 }' >octal
printf "$(cat octal)" >scan.raw
[ "$(wc -c <scan.raw)" = $((30 * 16 * 14)) ] || fail "the test's own raw file"
run 0 dem-clump scan.raw --raw '30x16x14 uint8' --voxel-size 5um $fast -q -o raw/ --format xyzr --labels 12
{ printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 30 16 14\nencoding: gzip\nspacings: 5 5 5\ndata file: scan.raw.gz\n'; } >packed.nhdr
run 3 dem-clump packed.nhdr $fast -q -o raw/
mentions 'error: packed.nhdr: .*scan.raw.gz.*cannot be read'
gzip -k scan.raw
run 0 dem-clump packed.nhdr --voxel-size 5um $fast -q -o raw/ --format xyzr --labels 12
printf 'NDims = 3\nDimSize = 30 16 14\nElementSpacing = 5 5 5\nElementType = MET_UCHAR\nElementDataFile = scan.raw\n' >meta.mhd
run 0 dem-clump meta.mhd --voxel-size 5um $fast -q -o raw/ --format xyzr --labels 12
for other in packed meta; do
    diff <(grep -v '^#' raw/scan_12.xyzr) <(grep -v '^#' raw/${other}_12.xyzr) >d || fail "$other differs: $(head -c 300 d)"
done
run 3 dem-clump scan.raw --raw '30x16x15 uint8' -o raw/
mentions 'scan.raw: 30 x 16 x 15 voxels of uint8 are 7200 bytes, but the file holds 6720'

# a label in pieces
{ header 'spacings: 1 1 1\n'; voxels | sed 's/\b12\b/3/g; s/\b5\b/3/g'; } >joined.nrrd
run 0 dem-clump joined.nrrd --unit um $fast -o c/ --labels 3
mentions 'dropped 1 piece'
{ header 'spacings: 1 1 1\n'; voxels | awk '{ for (i = 1; i <= NF; i++) $i = $i == 12 && i > 16 || $i == 3 && i < 13 ? 3 : 0; print }'; } >apart.nrrd
run 3 dem-clump apart.nrrd --unit um $fast -o c/ --labels 3
mentions 'label 3: .*in 2 pieces.*--keep'
run 0 dem-clump apart.nrrd --unit um $fast -q -o c/ --labels 3 --keep largest
run 0 dem-clump apart.nrrd --unit um $fast -q -o split/ --labels 3 --split
[ "$(ls split/*3-[12].json | wc -l)" = 2 ] || fail "--split of a label: $(ls split)"

# refused with one line, and the others of the batch go on
{ header 'spacings: 1 0 1\n'; voxels; } >spacing.nrrd
{ header ''; voxels | head -c 5000; } >cut.nrrd 2>/dev/null
{ header ''; voxels | tr '1-9' '0'; } >empty.nrrd
header '' | sed '$d' >unended.nrrd
for file in spacing cut empty unended; do
    run 3 dem-clump $file.nrrd $fast -o c/
    [ "$(grep -c 'error:' err)" = 1 ] || fail "$file: $(cat err)"
done
run 3 dem-clump spacing.nrrd scan.nrrd empty.nrrd "$source/shapes/grains/sand.obj" $fast -o mixed/ -o t.csv --labels 3
ls mixed | tr '\n' ' ' | grep -qx 'sand.json scan_3.json scan_bodies.csv scan_scene.json ' || fail "mixed: $(ls mixed)"
mentions '2 made, 2 failed: spacing.nrrd: .*; empty.nrrd: '
finish
