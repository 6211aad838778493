#!/bin/bash
# dem-clump --method: the field's classic methods, their parameters, and what does not go together.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-clump" ] || exit 77
grains=$source/shapes/grains

# the field's methods: listed from one table, parameters in the clump, what does not belong together is said
run 0 dem-clump --methods
for method in optimal bubble favier ferellec euclidean grid; do prints "$method:"; done
prints '--distance'
run 0 dem-clump --methods --json
prints '"name": "dmin"'
run 0 dem-clump --help
prints 'Method bubble'
for method in bubble favier ferellec euclidean grid; do
    run 0 dem-clump "$grains/sand.obj" -n 15 --method $method --json -o c.json
    awk '/"spheres":/ { exit !($2 + 0 >= 1 && $2 + 0 <= 15) }' out || fail "$method: $(grep spheres out)"
    prints '"moments": "free"'
    grep -q '"method": "'$method'"' c.json || fail "$method is not in its clump"
    grep -q warning err && fail "$method warns of what was not asked for: $(cat err)"
done
run 0 dem-clump "$grains/sand.obj" --method bubble --ratio 0.25 --distance 100 -q -o c.json
grep -q '"ratio": *0.25' c.json && grep -q '"distance": *100' c.json || fail "the parameters are not in the clump"
run 0 dem-clump "$grains/sand.obj" --method bubble --ratio 0.05 --distance 160 -n 12 -o c.json
mentions 'largest first, and'
run 0 dem-clump "$grains/sand.obj" --method grid -n 12 --moments exact -o c.json
mentions 'cannot give'
run 2 dem-clump "$grains/sand.obj" --method favier --dmin 0.1
mentions 'belongs to method ferellec, not to favier'
run 2 dem-clump "$grains/sand.obj" --ratio 0.1
mentions 'belongs to method bubble, not to optimal'
run 2 dem-clump "$grains/sand.obj" --method buble
mentions 'did you mean bubble'
run 2 dem-clump "$grains/sand.obj" --method bubble --ratio 2 -o c.json
mentions '0.001 to 0.999'
run 2 dem-clump "$grains/sand.obj" --method grid --outer -o c.json
mentions 'outer'
finish
