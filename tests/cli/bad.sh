#!/bin/bash
# dem-clump and malformed meshes: each class is refused with one clear line and status 3, or repaired with a warning
# and the right volume; never a crash, a hang, a NaN or a silently wrong mass.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77

# volume_of FILE [options]: packs one sphere, leaves the mesh's volume in $volume
volume_of() {
    local file=$1
    shift
    run 0 dem-clump "$file" -n 4 --effort fast --moments free --json -o c.json "$@"
    volume=$(awk '/"solid"/ { gsub(/[,{}]/, " "); for (i = 1; i < NF; i++) if ($i == "\"volume\":") print $(i + 1) }' out)
    grep -qiE '\b(nan|inf)' out c.json && fail "$file: a number that is none"
}
# ok FILE VOLUME TOLERANCE: read silently
ok() {
    volume_of "$1" "${@:4}"
    near "$1" "$2" "$3"
    [ -s err ] && fail "$1: not silent but: $(cat err)"
}
# repaired FILE VOLUME TOLERANCE WARNING
repaired() {
    volume_of "$1" "${@:5}"
    near "$1" "$2" "$3"
    mentions "^dem-clump: warning: $1: .*$4"
}
near() {
    awk -v a="$volume" -v b="$2" -v t="$3" 'BEGIN { exit !(a - b <= t * b && b - a <= t * b) }' ||
        fail "$1: volume $volume, not $2 within $3"
}
# refused FILE MESSAGE: one line, nothing written
refused() {
    rm -f c.json
    run 3 dem-clump "$1" -n 1 --effort fast --moments free -o c.json "${@:3}"
    mentions "^dem-clump: error: $1(:[0-9]+)?: .*$2"
    [ "$(grep -c error: err)" = 1 ] || fail "$1: not one error line: $(cat err)"
    [ -e c.json ] && fail "$1: an output was written"
}

# the control: a grain of 320 triangles; V is its volume
run 0 dem-grain -q --triangles 320 --size 1.6 -o control.obj
grep -v '^#' control.obj >plain.obj
volume_of plain.obj
V=$volume
n=$(grep -c '^v' plain.obj)
ok control.obj "$V" 1e-12

# readers: what cannot be read
: >empty.obj
refused empty.obj 'empty'
: >empty.stl
refused empty.stl 'empty'
refused missing.obj 'no such file'
mkdir folder.obj
refused folder.obj 'no mesh in this folder'
ln -s nowhere.obj link.obj
refused link.obj 'link'
head -c 2000 plain.obj >vertices_cut.obj
refused vertices_cut.obj ''
printf 'Dear colleague,\nplease find the grain attached.\n' >prose.obj
refused prose.obj ''
printf '\211PNG\r\n\032\n%01000d' 0 >png.stl
refused png.stl ''
grep '^v' plain.obj >points.obj
refused points.obj 'face'
awk '/^v/ { print $2, $3, $4 }' plain.obj >cloud.xyz
refused cloud.xyz ''
awk '/^v/ && !k++ { $3 = "nan" } { print }' plain.obj >nan.obj
refused nan.obj 'finite'
mentions 'nan.obj:1: '
awk '/^v/ && ++k == 10 { $3 = "1e400" } { print }' plain.obj >huge_number.obj
refused huge_number.obj 'finite'
mentions 'huge_number.obj:10: '
{ cat plain.obj; echo 'f 1 2 2000000000'; } >index.obj
refused index.obj '2000000000'
mentions "index.obj:$(wc -l <index.obj): "
{ cat plain.obj; echo 'f 0 1 2'; } >zero.obj
refused zero.obj ''
{ cat plain.obj; echo 'f 1 2'; } >two.obj
refused two.obj ''
sed 's/\./,/g' plain.obj >comma.obj
refused comma.obj 'comma|point'

# readers: what is unusual but right
sed 's/ /\t/g; s/$/\r/' plain.obj >crlf.obj
ok crlf.obj "$V" 1e-12
printf '\357\273\277' | cat - plain.obj >bom.obj
ok bom.obj "$V" 1e-12
{ echo 'v 1e3 1e3 1e3'; sed -n '/^v/p' plain.obj; awk '/^f/ { print "f", $2 + 1, $3 + 1, $4 + 1 }' plain.obj; } >unused.obj
volume_of unused.obj
near unused.obj "$V" 1e-9
awk -v n="$n" '/^f/ { print "f", $2 - n - 1, $3 - n - 1, $4 - n - 1; next } { print }' plain.obj >negative.obj
ok negative.obj "$V" 1e-12
awk '/^v/ { print $0, ".5 .5 .5"; next } /^f/ { print "f", $2 "/1/1", $3 "//2", $4 "/3"; next }' plain.obj >slashes.obj
ok slashes.obj "$V" 1e-12
awk '/^v/ { x[++n] = $0 } /^f/ { print x[$2]; print x[$3]; print x[$4]; t++ } END { for (i = 1; i <= 3 * t; i += 3) print "f", i, i + 1, i + 2 }' plain.obj >soup.obj
ok soup.obj "$V" 1e-12
printf 'v 0 0 0\nv 3 0 0\nv 3 2 0\nv 0 2 0\nv 0 0 1\nv 3 0 1\nv 3 2 1\nv 0 2 1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n' >box.obj
ok box.obj 6 1e-12
# an L of 5 squares 2 high: its two hexagons need ears cut
printf 'v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nv 0 0 2\nv 3 0 2\nv 3 1 2\nv 1 1 2\nv 1 3 2\nv 0 3 2\nf 6 5 4 3 2 1\nf 7 8 9 10 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n' >ell.obj
volume_of ell.obj
near ell.obj 10 1e-9

# formats: all give the control's volume (STL stores 32 bits)
for format in stl ply off; do
    run 0 dem-grain -q --triangles 320 --size 1.6 -o "control.$format"
    volume_of "control.$format"
    near "control.$format" "$V" 1e-5
done
head -c 8000 control.stl >cut.stl
refused cut.stl '[0-9]+ triangles'
cp control.stl long.stl
printf '%0100d' 0 >>long.stl
refused long.stl ''
cp plain.obj obj.stl
repaired obj.stl "$V" 1e-9 'OBJ'

# repairs
awk '/^f/ && !k++ { next } { print }' plain.obj >hole.obj
repaired hole.obj "$V" 3e-3 'hole'
awk '/^f/ { print "f", $2, $4, $3; next } { print }' plain.obj >inside_out.obj
repaired inside_out.obj "$V" 1e-9 'inside'
awk '/^f/ && ++k % 2 { print "f", $2, $4, $3; next } { print }' plain.obj >half.obj
repaired half.obj "$V" 1e-9 '1[0-9][0-9]'
{ cat plain.obj; grep '^f' plain.obj | head -40; } >twice.obj
repaired twice.obj "$V" 1e-9 '40'
{ cat plain.obj; echo 'f 1 1 2'; echo 'f 3 3 3'; } >flat_faces.obj
repaired flat_faces.obj "$V" 1e-9 '2'
# unwelded and shaken by 1e-7
awk 'BEGIN { srand(1) } /^v/ { for (i = 2; i < 5; i++) x[n * 3 + i] = $i; n++ }
     /^f/ { for (k = 2; k < 5; k++) { printf "v"; for (i = 2; i < 5; i++) printf " %.9f", x[($k - 1) * 3 + i] + 2e-7 * (rand() - .5); print "" } t++ }
     END { for (i = 1; i <= 3 * t; i += 3) print "f", i, i + 1, i + 2 }' plain.obj >shaken.obj
repaired shaken.obj "$V" 1e-5 'weld'
# a copy of the grain, moved by d and scaled by s, behind the first: shells FILE d s flip
shells() {
    awk -v d="$2" -v s="$3" -v flip="$4" '/^v/ { print; v[++n] = sprintf("v %.9g %.9g %.9g", s * $2 + d, s * $3, s * $4) }
        /^f/ { print; f[++m] = flip ? "f " $2 + 0 " " $4 + 0 " " $3 + 0 : $0 }
        END { for (i = 1; i <= n; i++) print v[i]; for (i = 1; i <= m; i++) { split(f[i], a, " "); print "f", a[2] + n, a[3] + n, a[4] + n } }' \
        plain.obj | awk '/^v/ { print > "v" } /^f/ { print > "f" }'
    cat v f >"$1"
}
shells apart.obj 5 0.5 0
refused apart.obj 'bod(y|ies).*keep'
volume_of apart.obj --keep largest
near apart.obj "$V" 1e-9
volume_of apart.obj --keep all
near apart.obj "$(awk -v v="$V" 'BEGIN { printf "%.15g", 1.125 * v }')" 1e-9
run 0 dem-clump apart.obj --split -n 1 --effort fast -q -o part.json
[ -e part-1.json ] && [ -e part-2.json ] || fail "--split wrote $(ls part*)"
shells nested.obj 0 0.5 0
repaired nested.obj "$V" 1e-9 'inside'
shells overlapping.obj 0.7 0.9 0
if [ "${DEM_CGAL:-1}" = 0 ]; then
    refused overlapping.obj 'CGAL'
else
    volume_of overlapping.obj
    awk -v a="$volume" -v v="$V" 'BEGIN { exit !(a > 1.05 * v && a < 1.7 * v) }' || fail "overlapping.obj: volume $volume"
fi

# no solid
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >triangle.obj
refused triangle.obj ''
printf 'v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 3 2 1\nf 4 3 1\n' >plate.obj
refused plate.obj 'volume'
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3\nf 2 3 4\nf 1 2 4\n' >line.obj
refused line.obj ''
awk '/^v/ { z[++n] = $4 } /^f/ && z[$2] > 0.3 { next } { print }' plain.obj >open.obj
refused open.obj 'open'
refused hole.obj '' --repair strict
ok plain.obj "$V" 1e-9 --repair strict

# scales and offsets: the same shape numbers
for factor in 1e-9 1e9; do
    awk -v s=$factor '/^v/ { printf "v %.12g %.12g %.12g\n", s * $2, s * $3, s * $4; next } { print }' plain.obj >scaled.obj
    volume_of scaled.obj -n 5
    near "scaled by $factor" "$(awk -v v="$V" -v s=$factor 'BEGIN { printf "%.12g", v * s ^ 3 }')" 1e-6
    awk '/"sphericity"|"roundness"/ { print }' out | tr ',' '\n' | grep -E 'elongation|flatness|sphericity|convexity|roundness' |
        awk '{ printf "%s %.6f\n", $1, $2 }' >shape.$factor
done
cmp -s shape.1e-9 shape.1e9 || fail "shape depends on scale: $(cat shape.1e-9 shape.1e9)"
awk '/^v/ { printf "v %.17g %.17g %.17g\n", $2 + 1e6, $3 - 1e6, $4 + 1e6; next } { print }' plain.obj >far.obj
volume_of far.obj
near far.obj "$V" 1e-6

# needle and plate end, and say that the fit is poor
awk '/^v/ { print "v", 100 * $2, $3, $4; next } { print }' plain.obj >needle.obj
volume_of needle.obj -n 20
awk '/^v/ { print "v", 100 * $2, 100 * $3, $4; next } { print }' plain.obj >thin.obj
volume_of thin.obj -n 20

# the maker of malformed meshes beside the project, where there is one
bad=$source/../shared/bad/mkbad.py
if [ -e "$bad" ] && command -v python3 >/dev/null; then
    python3 "$bad" corpus
    for file in corpus/*; do
        case "$file" in *make_huge* | *60_unreadable*) continue ;; esac
        timeout 120 "$tools/dem-clump" "$file" -n 5 --effort fast --json -o c.json >out 2>err </dev/null
        status=$?
        wanted=0
        case "$file" in
        */0[1-35-8]_* | */1[0-5]_* | */18_* | */2[1-3]_* | */28_* | */4[678]_* | */51_* | */59_* | */61_*) wanted=3 ;;
        */04_* | */34_* | */49_*) wanted=either ;;
        */37_* | */38_*) [ "${DEM_CGAL:-1}" = 0 ] && wanted=3 ;;
        esac
        case "$status/$wanted" in
        0/0 | 3/3 | 0/either | 3/either) ;;
        *) fail "$file: status $status, not $wanted: $(cat err)" ;;
        esac
        [ $status = 3 ] && [ "$(grep -c '^dem-clump: error: ' err)" != 1 ] && fail "$file: not one error line: $(cat err)"
        [ $status = 0 ] && grep -qiE '\b(nan|inf)' out && fail "$file: a number that is none"
    done
fi
finish
