#!/bin/bash
# dem-study: the studies, their tables, and what is said when things are wrong.
. "$(dirname "$0")/check.bash"

run 2 dem-study
mentions 'name a study, one of .*verify'
run 2 dem-study verfy
one_line
mentions "there is no study 'verfy'; there is .*verify"
run 0 dem-study --help

# ---- verify
run 0 dem-study verify --list
prints '^chung-ooi-1 .*(Chung & Ooi 2011, test 1)'
run 0 dem-study verify chung-ooi-7 'chung-ooi-1*'
prints '^passed +chung-ooi-1 '
prints '^passed +chung-ooi-7 '
prints '^2 cases, .* figures: 2 passed, 0 failed, 0 skipped$'
run 0 dem-study verify chung-ooi-1 --all
prints 'glass: largest force +10696\.9 +10696\.9 .* N'
run 0 dem-study verify chung-ooi-1 --json
python3 -c 'import json; d = json.load(open("out")); assert d["passed"] == 1 and d["failed"] == 0
f = d["cases"][0]["findings"][0]; assert abs(f["got"] - 10696.889) < 0.01 and f["unit"] == "N" and f["passed"]' ||
    fail 'JSON of verify'
run 0 dem-study verify chung-ooi-1 -q -o v.html -o v.csv
[ ! -s out ] || fail 'something is said though -q'
head -1 v.csv | grep -q '^case,what,unit,bound,expected,got,tolerance,verdict,source$' || fail 'head of v.csv'
grep -q '<h2>chung-ooi-1</h2>' v.html || fail 'no case in v.html'
python3 -c 'import xml.dom.minidom; xml.dom.minidom.parse("v.html")' || fail 'v.html is no XML'
run 2 dem-study verify nothing
says "dem-study verify: error: there is no case 'nothing'; --list shows all; see dem-study verify --help"
run 2 dem-study verify -o v.pdf
says "dem-study verify: error: 'v.pdf' names no form that can be written; end it in .html or .csv; see dem-study verify --help"
run 4 dem-study verify full-slip -q -o /nowhere/v.csv

# ---- mohr-coulomb: phi = 30 degrees, c = 5 kPa
cat >tests.csv <<'END'
# s1 = s3 (1 + sin) / (1 - sin) + 2 c cos / (1 - sin)
name, sigma3_kPa, sigma1_kPa
a, 0, 17.3205080757
b, 10, 47.3205080757
c, 50, 167.3205080757
END
run 0 dem-study mohr-coulomb tests.csv -o m.svg -o m.html -o m.csv
prints '^  friction angle  .* 30 deg$'
prints '^  cohesion  .* 5000 Pa$'
prints 'axial stress.* 17320\.508 Pa$'
prints 'shear stress.* 8660\.254 Pa$'
for file in m.svg m.html; do
    python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' $file || fail "$file is no XML"
done
[ "$(grep -c '<path' m.svg)" = 3 ] || fail 'not three circles'
head -1 m.csv | grep -q '^friction_angle_deg,' || fail 'head of m.csv'
run 0 dem-study mohr-coulomb tests.csv --json --unit kPa
prints '"cohesion_Pa": (5000|4999\.9|5000\.0)'
head -2 tests.csv >none.csv
run 3 dem-study mohr-coulomb none.csv
says 'dem-study mohr-coulomb: error: none.csv: a line needs two tests and should have three or more; there are 0'
printf 'sigma1,sigma2\n1,2\n' >none.csv
run 3 dem-study mohr-coulomb none.csv
mentions '^dem-study mohr-coulomb: error: none.csv:1: has no column sigma3; begin the table'
printf 'sigma1,sigma3\n3,2\n1,x\n' >none.csv
run 3 dem-study mohr-coulomb none.csv
mentions 'none.csv:3: sigma3 is no number'
run 2 dem-study mohr-coulomb tests.csv --unit mm
mentions '-unit: '

# ---- convergence
run 0 dem-study convergence --list
prints '^free-top '
run 0 dem-study convergence free-top --integrators lsym4,central+pcdm --levels 3 --error 1 -o top
prints '^central\+lsym +2\.00 '
prints '^central\+lsym4 +(3\.9|4\.0)'
prints '^  -D time\.step=0\.0714285714285714'
head -1 top/errors.csv | grep -q '^scheme,step_s,steps,steps_per_contact,processor_s,failed,state,state_doubt,' ||
    fail 'head of errors.csv'
[ "$(wc -l <top/errors.csv)" = 10 ] || fail 'not nine points'
grep -q '^central+pcdm,orientation,' top/orders.csv || fail 'orders.csv'
python3 -c 'import xml.dom.minidom; xml.dom.minidom.parse("top/convergence.html")' || fail 'convergence.html is no XML'
# what was there is taken; what an interruption has left is made up for, to the same pages but for the seconds
cp -r top again
run 0 dem-study convergence free-top --integrators lsym4,central+pcdm --levels 3 --error 1 -o top -q
[ ! -s out ] || fail 'something is said though -q'
for file in errors.csv orders.csv convergence.html; do
    cmp -s top/$file again/$file || fail "$file changes"
done
rm again/cells/000[257].json again/*.csv
run 0 dem-study convergence free-top --integrators lsym4,central+pcdm --levels 3 --error 1 -o again --json
cut -d, -f1-4,6- top/errors.csv >a && cut -d, -f1-4,6- again/errors.csv >b && cmp -s a b || fail 'gone on, errors differ'
python3 -c 'import json; d = json.load(open("out")); assert len(d["points"]) == 9 and not d["chaotic"]
assert d["override"].startswith("-D time.step=") and d["orders"][0]["points"] == 3' || fail 'JSON of convergence'
run 0 dem-study convergence free-top --levels 3 -o jobs --cell 1
prints '^1 of 6 cells are there'
run 2 dem-study convergence free-top --levels 3 -o jobs --cell 6
says 'dem-study convergence: error: there is no cell 6; there are 0 to 5'
run 1 dem-study convergence free-top --levels 2 --error 1e-9 -o top2
prints '^No setting of these'
run 2 dem-study convergence free-top --of heat -o top
mentions "the series has no column 'heat'"
run 2 dem-study convergence free-top --integrators rk4
mentions "there is no integrator 'rk4'"
run 3 dem-study convergence none.json
run 4 dem-study convergence free-top --levels 2 -o /dev/null/x
# ---- measured tests: as scenes, and done
run 0 dem-study scene --list
prints '^heap: .*angle of repose'
prints '^  friction .*default 0\.5'
run 0 dem-study scene pour -D bodies=60 -D diameter='2 mm' -o pour.json
run 0 dem-run pour.json --steps 5 -q -o poured
run 0 dem-study scene triaxial -D bodies=40 -D rate=0.01 -o tri.json
[ "$(wc -l <tri-bodies.csv)" -eq 41 ] || fail 'bodies of the sample'
run 0 dem-run tri.json --steps 5 -q -o tried
run 0 dem-study test pour -D bodies=40 -D overlap=0.02 --json
python3 -c 'import json; d = json.load(open("out")); assert 0.3 < d["figures"]["void_ratio"] < 1.5' || fail 'JSON of test'
run 0 dem-study test shear-box -D bodies=40 -D rate=0.05 -D displacement=0.05 -q -o box.html -o box.csv
head -1 box.csv | grep -q '^displacement_d,shear_stress_Pa,' || fail 'head of box.csv'
python3 -c 'import xml.dom.minidom; xml.dom.minidom.parse("box.html")' || fail 'box.html is no XML'
run 2 dem-study scene house
mentions "there is no test 'house'"
run 2 dem-study scene pour -D height
mentions 'has no value; write -D name=value'
run 2 dem-study test pour -D friction=20
mentions '-D friction=20 is out of range'
run 2 dem-study test pour -D colour=1
mentions "test pour has no 'colour'"
run 3 dem-study test pour --grain none.json

# ---- shape and dimers: cells that go on
run 0 dem-study shape --family clusters --tests pour --bodies 40 --seeds 1 -D overlap=0.02 --cells
[ "$(cat out)" = 4 ] || fail 'number of cells'
run 0 dem-study shape --family clusters --tests pour --bodies 40 --seeds 1 -D overlap=0.02 --cell 2 -o forms
prints '3 of 4 cells are not known yet'
run 0 dem-study shape --family clusters --tests pour --bodies 40 --seeds 1 -D overlap=0.02 --json -o forms
python3 -c 'import json; d = json.load(open("out")); assert d["missing"] == 0 and len(d["figures"][0]["mean"]) == 4' ||
    fail 'JSON of shape'
python3 -c 'import xml.dom.minidom; xml.dom.minidom.parse("forms/shape.html")' || fail 'shape.html is no XML'
grep -q '^tetrahedron,4,4,pour,void_ratio,-,1,0\.' forms/shape.csv || fail 'shape.csv'
run 2 dem-study shape
mentions 'name the mesh of a grain, or a --family'
run 2 dem-study shape --family clusters --tests walk
mentions "there is no test 'walk'"
run 2 dem-study shape grain.obj --spheres 1,x
mentions '--spheres is numbers with commas between'
run 3 dem-study shape none.obj -o forms
run 1 dem-study dimers --bodies 40 --growth 0.02 --steps 60 --aspects 1,1.5 --seeds 1 -o dense
prints '^off +largest solid fraction|^passed largest solid fraction'
grep -q '<svg' dense/dimers.html || fail 'no plot of dimers'
[ "$(wc -l <dense/dimers.csv)" -eq 3 ] || fail 'dimers.csv'
run 2 dem-study dimers --aspects 1,3
mentions '--aspects goes from 1 to 2, not to 3'

# ---- stability
run 0 dem-study stability --list
prints 'limit-single'
run 0 dem-study stability limit-single limit-sweep --all
prints 'blows up at, over the predicted limit'
run 0 dem-study stability limit-single -q -o stability.html -o stability.csv
grep -q '<svg' stability.html || fail 'no plot on the page'
[ "$(wc -l < stability.csv)" -eq 4 ] || fail 'figures in the CSV'
run 2 dem-study stability --slow
finish
