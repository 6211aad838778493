#!/bin/bash
# dem-clump --exports: every format of a grain, or of a batch, into a folder.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77
few="-n 4 --effort fast --moments free -q"
run 0 dem-grain -q --triangles 80 --seed 1 -o sand.obj
run 0 dem-grain -q --triangles 80 --seed 2 -o flat.obj
grain=sand.obj

# files FOLDER NAME...: just these are there
files() {
    local folder=$1
    shift
    [ "$(ls "$folder" | tr '\n' ' ')" = "$* " ] || fail "$ran: wrote $(ls "$folder" | tr '\n' ' '), not $*"
}

engines="sand.clu sand.deme.csv sand.edem.txt sand.liggghts sand.mercury sand.mfix.csv sand.mol sand.p3dat sand.yade.py"
run 0 dem-clump "$grain" $few --exports engines -o out.d
files out.d $engines
run 0 dem-clump "$grain" $few --exports pfc,liggghts,pfc,json -o some/
files some sand.json sand.liggghts sand.p3dat

# a batch, and its table beside
run 0 dem-clump "$grain" flat.obj $few --exports lammps,deme -o both -o table.csv
files both flat.deme.csv flat.mol sand.deme.csv sand.mol
[ "$(wc -l <table.csv)" = 3 ] || fail "the table has $(wc -l <table.csv) lines"

# without -o: here
mkdir here
cd here || exit 1
run 0 dem-clump ../sand.obj $few --exports xyzr,yade
rm out err
files . sand.xyzr sand.yade.py
cd ..

# every format there is, into a folder that is there; a picture may not be had, and takes minutes under a sanitizer
if [ -z "${DEM_SANITIZE:-}" ]; then
    run 0 dem-clump "$grain" $few --exports all -o out.d
    [ "$(ls out.d | wc -l)" = $((13 + ${DEM_EMBREE:-1})) ] || fail "$ran: wrote $(ls out.d)"
    if [ "${DEM_EMBREE:-1}" != 1 ]; then
        run 0 dem-clump "$grain" ${few/-q/} --exports all -o out.d
        mentions 'warning: .*no png: '
    fi
fi

# names that tell the format
run 0 dem-clump "$grain" $few -o a.mol -o b.lammps -o c.yade.py -o d.deme.csv -o e.mercury
diff <(sed 's/a\.mol/b.lammps/' a.mol) b.lammps >/dev/null || fail "a.mol and b.lammps differ"
[ -s c.yade.py ] && [ -s d.deme.csv ] && [ -s e.mercury/Inertia/TOI.txt ] || fail "$ran: wrote $(ls)"
run 0 dem-clump "$grain" $few -o - --format edem
[ "$(grep -vc '^#' out)" = 4 ] || fail "$ran: $(cat out)"

# without packing again
run 0 dem-clump convert some/sand.json --exports engines -o again
files again $engines
diff some/sand.p3dat again/sand.p3dat >/dev/null || fail "a clump that was read gives another file"

# what does not go together
run 2 dem-clump "$grain" --exports pfc,magic -o x
mentions "unknown format 'magic'"
run 2 dem-clump "$grain" --exports '' -o x
run 2 dem-clump "$grain" --exports pfc -o x.p3dat
mentions 'name a folder'
run 2 dem-clump "$grain" --exports pfc -o -
run 2 dem-clump "$grain" -o - --format mercury
mentions 'folder'
[ -e x ] && fail "a folder was made for nothing"
run 4 dem-clump "$grain" $few --exports pfc -o /dev/null/x
finish
