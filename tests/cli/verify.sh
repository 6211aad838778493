#!/bin/bash
# dem-clump verify: programs that are not there, that fail, hang or use another mass; and those that are installed.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77
clump=$source/shapes/clumps/angular.json
mkdir fake temporary
export TMPDIR=$work/temporary

# with STATUS ARGUMENTS...: verify where only the programs in fake/ can be found
with() {
    local wanted=$1 got
    shift
    ran="verify $*"
    timeout 60 env PATH="$work/fake" "$tools/dem-clump" verify "$@" >out 2>err </dev/null
    got=$?
    [ "$got" = "$wanted" ] || fail "$ran: status $got, not $wanted: $(head -c 600 err)"
    [ -z "$(ls temporary)" ] || fail "$ran: left $(ls temporary)"
}
# program NAME: standard input is its script
program() {
    { echo '#!/bin/sh'; cat; } >"fake/$1"
    chmod +x "fake/$1"
}

# usage
run 2 dem-clump verify
mentions 'no clump given'
run 2 dem-clump verify a.json b.json
run 2 dem-clump verify "$clump" --engine pfc
mentions 'must be lammps'
run 3 dem-clump verify missing.json
mentions 'missing.json: no such file'
echo '{}' >empty.json
run 3 dem-clump verify empty.json
mentions 'is not a clump file'
run 0 dem-clump verify --help
prints 'Usage: dem-clump verify CLUMP'

# nothing installed
with 0 "$clump"
mentions 'warning: nothing was verified'
prints 'LAMMPS +skipped: not installed'
with 0 "$clump" --json
prints '"agree": false'
with 3 "$clump" --engine yade
mentions 'error: Yade is not in PATH; install it \(Debian: apt install yade\)'

# a program that fails, one that says nothing, one that hangs
program lmp <<'E2'
echo 'LAMMPS (1 Jan 2030)'
echo 'ERROR: Unknown atom style'
exit 1
E2
with 1 "$clump" --engine lammps
mentions 'fake/lmp left with status 1; its last words: .*Unknown atom style'
with 1 "$clump" --json
prints '"status": "failed".*Unknown atom style'
prints '"version": "1 Jan 2030"'
program liggghts <<'E2'
exit 0
E2
with 1 "$clump" --engine liggghts
mentions 'told no energy of motion 0'
program yade <<'E2'
while :; do :; done
E2
with 1 "$clump" --engine yade --time-limit 0.5
mentions 'took more than'
program yade <<'E2'
kill -SEGV $$
E2
with 1 "$clump" --engine yade
mentions 'crashed'

# the folder is kept where that is asked for, and nothing but the files asks for a shell
with 1 "$clump" --engine lammps --keep-files "kept ; \$(touch oops)"
[ -s "kept ; \$(touch oops)/lammps/in.rest" ] && [ -s "kept ; \$(touch oops)/lammps/clump.mol" ] || fail "no deck was kept"
[ -e oops ] && fail "a shell read the name of the folder"

# one that moves the spheres as asked but has another mass: E = m v^2 / 2 with v = 1
cat >two.json <<'E2'
{"schema": "dem-clump/1", "density": 1000, "mass": 2, "inertia": [0.25, 0.5, 0.5],
 "spheres": [[-0.5, 0, 0, 0.5], [0.5, 0, 0, 0.5]]}
E2
# moves E E1 E2 E3 [DISTANCE]: a Yade that tells these energies, with a sphere so far from the axis
moves() {
    program yade <<E2
echo 'Welcome to Yade 2030.01'
k=0
for figure in "$1" "$2" "$3" "$4"; do
    printf '\nmotion of the clump, number %d\n3 2 %s %s\nend of the motion\n' \$k \$figure
    k=\$((k + 1))
done
dump() { printf 'ITEM: ATOMS id x y z vx vy vz\n1 -.5 0 0 %s\n2 .5 0 0 %s\n' "\$2" "\$3" >motion\$1.dump; }
dump 0 '1 0 0' '1 0 0'
dump 1 '0 0 0' '0 0 0'
dump 2 '0 0 .5' '0 0 -.5'
dump 3 '0 -.5 0' '0 ${5:-.5} 0'
E2
}
moves '1 0' '0 .125' '0 .25' '0 .25'
with 0 two.json --engine yade
prints 'Yade 2030.01 +mass .* agrees'
prints 'centre m +0 +0 +0 +agrees'
moves '1 0' '0 .125' '0 .2500003' '0 .25'
with 1 two.json --engine yade
prints 'I2 .* 1.2e-06 +DIFFERS'
moves '1.00001 0' '0 .125' '0 .25' '0 .25'
with 1 two.json --engine yade
prints 'mass .* DIFFERS'
moves '1 0' '0 .125' '0 .25' '0 .25' .6
with 1 two.json --engine yade
prints 'centre m .* DIFFERS'
rm fake/liggghts
with 1 two.json --json
prints '"agree": false'

# interrupted: nothing is left
program yade <<'E2'
while :; do :; done
E2
env PATH="$work/fake" "$tools/dem-clump" verify two.json --engine yade -q 2>err >out &
child=$!
for i in 1 2 3 4 5 6 7 8 9 10; do
    [ -n "$(ls temporary)" ] && break
    sleep 0.2
done
kill -INT $child
wait $child
status=$?
[ $status = 130 ] || fail "interrupted: status $status"
[ -z "$(ls temporary)" ] || fail "interrupted: left $(ls temporary)"

# the real ones: a clump with the mass of its mesh, which its union has not
engines=""
for program in lmp liggghts yade; do
    command -v $program >/dev/null && engines="$engines $program"
done
if [ -n "$engines" ]; then
    run 0 dem-clump "$source/shapes/grains/angular.obj" -n 5 --effort fast --moments free --size 4mm -q -o real.json
    run 0 dem-clump verify real.json --json
    [ "$(grep -o '"status": "agrees"' out | wc -l)" = "$(echo $engines | wc -w)" ] || fail "$ran: $(cat out)"
    prints '"agree": true'
    run 0 dem-clump verify real.json
    [ "$(grep -c ' agrees$' out)" = $((5 * $(echo $engines | wc -w))) ] || fail "$ran: $(cat out)"
    # LAMMPS cannot be made to turn spheres that stand in a line
    if [ "${engines#* lmp}" != "$engines" ]; then
        run 0 dem-clump verify two.json --engine lammps
        prints 'I1 .* agrees, as it says'
    fi
else
    echo "no engine is installed: only stand-ins were verified"
fi
finish
