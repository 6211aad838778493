#!/bin/bash
# dem-clump convert: clumps of other programs, told in full, written whole, refused with file and line.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77
grains=$source/shapes/grains

figure() { tr ',{}' '\n\n\n' <out | awk -v k="\"$1\":" '$1 == k { print $2; exit }'; }
is() { awk -v a="$(figure "$1")" -v b="$2" 'BEGIN { d = a - b; exit !(a != "" && d * d <= 1e-18 * b * b) }' || fail "$ran: $1 is $(figure "$1"), not $2"; }

cat >rock.mol <<'E'
rock

2 atoms
0.02 mass
0 0 0 com
4e-7 9e-7 9.5e-7 0 0 0 inertia

Coords

1 -0.005 0 0
2 0.005 0 0

Types

1 1
2 1

Diameters

1 0.02
2 0.02
E
printf '# two balls, mm\n-5 0 0 10\r\n5,0,0,10' >"two balls.txt"

# a molecule: its mass is kept and compared, a screen of text tells
run 0 dem-clump convert rock.mol -o rock.json
prints 'union of spheres'
prints 'wrote rock.json'
mentions "warning: rock.mol: line 6: its moments of inertia differ"
[ "$(wc -l <out)" -le 20 ] || fail "more than a screen"
run 0 dem-clump convert rock.mol -o rock.json --json
is mass 0.02
prints '"mass_from": "given"'
prints '"format": "lammps"'
prints '"warnings": \['
run 0 dem-clump convert rock.mol -o u.json --json --mass-from union --density "2.65 g/cm3"
prints '"mass_from": "union"'
is density 2650

# ours again: nothing changes, to the last byte; and with a wish, all of it
run 0 dem-clump convert rock.json -q -o again.json
cmp -s rock.json again.json || fail "a clump of ours changed on the way"
run 0 dem-clump convert rock.json --mass 40g --json -o heavy.json
is mass 0.04

# plain spheres in mm; a name; standard input and output. The union has 9 pi / 4 cm^3
run 0 dem-clump convert "two balls.txt" --unit mm --name pair --json -o two.json
prints '"name": "pair"'
is mass 0.018731746197
volume=$(figure volume)
"$tools/dem-clump" convert - --unit mm -o - --format xyzr <"two balls.txt" >piped.xyzr 2>err || fail "from a pipe: $(cat err)"
[ "$(grep -vc '^#' piped.xyzr)" = 2 ] || fail "a pipe loses spheres"
run 0 dem-clump convert piped.xyzr --json -o back.json
is volume "$volume"
run 3 dem-clump convert piped.xyzr --unit mm -o back.json
mentions 'error: piped.xyzr: says itself'

# a mesh beside it gives fidelity, shape and surface
run 0 dem-clump "$grains/sand.obj" -n 8 --effort fast -q -o sand.xyzr --frame mesh
run 0 dem-clump "$grains/sand.obj" -n 8 --effort fast -q -o sand.json
run 0 dem-clump convert sand.xyzr --mesh "$grains/sand.obj" -o measured.json --json
awk -v a="$(figure iou_gap)" 'BEGIN { exit !(a > 0.001 && a < 0.3) }' || fail "IoU gap $(figure iou_gap)"
grep -q '"surface"' measured.json || fail "no surface"
prints '"mesh": "sand.obj"'
run 0 dem-clump convert sand.json --mesh "$grains/sand.obj" -o measured.json --mass-from mesh --json
prints '"mass_from": "mesh"'
# in a unit of its own
run 0 dem-clump "$grains/sand.obj" --unit mm -n 8 --effort fast -q -o sand.xyzr --frame mesh
run 0 dem-clump convert sand.xyzr --mesh "$grains/sand.obj" --mesh-unit mm -o measured.json --json
awk -v a="$(figure iou_gap)" 'BEGIN { exit !(a > 0.001 && a < 0.3) }' || fail "--mesh-unit: IoU gap $(figure iou_gap)"
run 0 dem-clump convert sand.xyzr --mesh "$grains/sand.obj" -o measured.json
mentions 'little in common'
run 3 dem-clump convert sand.xyzr --mesh no.obj -o x.json
mentions 'error: no.obj: no such file'

# a run takes it
if [ -x "$tools/dem-run" ]; then
    cat >scene.json <<'E'
{ "schema": "dem-scene/1", "time": { "end": 1e-4, "step": 1e-5 }, "gravity": [0, 0, -9.81],
  "materials": { "m": { "density": 2650 } },
  "contacts": [ { "between": ["m", "m"], "normal": { "law": "linear", "stiffness": 1e4, "restitution": 0.5 } } ],
  "shapes": { "rock": { "clump": "rock.json", "material": "m" } },
  "bodies": [ { "shape": "rock", "position": [0, 0, 1] } ] }
E
    run 0 dem-run scene.json -q -o run
fi

# a batch: the rest is finished, the table tells, the status too
printf '0 0 0 1\n0 0 0 -1\n' >broken.xyzr
run 3 dem-clump convert rock.mol broken.xyzr "two balls.txt" -o many/ -o many.csv
mentions 'error: broken.xyzr:2: sphere 2: its radius is -1'
[ "$(ls many | tr '\n' ' ')" = "rock.json two balls.json " ] || fail "batch wrote $(ls many)"
[ "$(wc -l <many.csv)" = 4 ] || fail "the table has $(wc -l <many.csv) lines"
[ "$(grep -c ',failed,' many.csv)" = 1 ] || fail "the table does not tell the failure"
run 0 dem-clump convert rock.mol "two balls.txt" -o many/ --format xyzr --json
[ -s many/rock.xyzr ] || fail "no many/rock.xyzr"
prints '"failed": 0'

# what is wrong is said in one line
: >empty.xyzr
run 3 dem-clump convert empty.xyzr -o x.json
mentions 'error: empty.xyzr: file is empty'
one_line
head -c 3000 "$tools/dem-clump" >binary.xyzr
run 3 dem-clump convert binary.xyzr -o x.json
mentions 'error: binary.xyzr:1: is a binary file'
one_line
printf 'solid a\n' >a.stl
run 3 dem-clump convert a.stl -o x.json
mentions 'error: a.stl:1: is not a clump file of a kind that is known'
run 3 dem-clump convert rock.mol --from kratos -o x.json
run 3 dem-clump convert no.mol -o x.json
mentions 'error: no.mol: no such file'
[ ! -e x.json ] || fail "something was written"
run 2 dem-clump convert
run 2 dem-clump convert rock.mol
mentions '-o FILE'
run 2 dem-clump convert rock.mol -o x.json --from magic
mentions 'json kratos lammps'
run 2 dem-clump convert rock.mol -o x.json --mass 3m
mentions 'mass'
run 2 dem-clump convert rock.mol -o x.json --mass -1kg
run 2 dem-clump convert rock.mol -o x.json --unit parsec
run 2 dem-clump convert rock.mol -o x.json --mass-from mesh
mentions '--mesh FILE'
run 2 dem-clump convert rock.mol rock.mol -o many/ --name x
run 2 dem-clump convert rock.mol -o x.unknown
run 2 dem-clump convert rock.mol -o x.json --densty 3
mentions 'did you mean'
run 2 dem-clump convert rock.json --format json
mentions 'rock.json: would be overwritten'
run 4 dem-clump convert rock.mol -o /dev/full --format json
run 0 dem-clump convert --help
prints 'Formats read'
finish
