#!/bin/sh
# contact_cost.sh: what each law costs over the plain friction scene, in ns for each contact and step, one core.
# A bed of 1000 clumps is settled once; each variant then runs from it, REPEATS times in turn; the least time counts.
# BUILD: build folder (with all kernels); PLUGIN: law_linear.so, compiled as dem/law.h says (made here if not given).
# A last column tells the instructions of all for each contact and step, by callgrind (COUNT=0: left out).
set -e
root=$(cd "$(dirname "$0")/../.." && pwd)
run=$(cd "${BUILD:-$root/build}" && pwd)/dem-run
repeats=${REPEATS:-5} steps=${STEPS:-2000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
if [ -z "$PLUGIN" ]; then
    PLUGIN=$work/law_linear.so
    ${CC:-cc} -shared -fPIC -O3 -march=native -mprefer-vector-width=512 -fopenmp-simd -ffp-contract=off -fno-math-errno \
        -fno-trapping-math -Wno-psabi -I "$root/lib/include" -I "$root/lib" -o "$PLUGIN" "$root/tests/examples/law_linear.c"
fi

plane() { printf '"%s": { "plane": { "point": [%s], "normal": [%s] }, "material": "m" }' "$1" "$2" "$3"; }

# scene LAW [BODIES]
scene() {
    cat <<END
{ "schema": "dem-scene/1", "gravity": [0, 0, -9.81], "time": { "end": 1, "step": 2e-6 },
  "materials": { "m": { "density": 2500, "young": 1e7, "poisson": 0.25 } },
  "contacts": [ { "between": ["m", "m"], $1 } ],
  "shapes": { "grain": { "clump": "$root/shapes/clumps/sand.json", "material": "m" } },
  "bodies": [ $2 ],
  "walls": { $(plane floor "0, 0, 0" "0, 0, 1"), $(plane a "0, 0, 0" "1, 0, 0"), $(plane b "0.02, 0, 0" "-1, 0, 0"),
      $(plane c "0, 0, 0" "0, 1, 0"), $(plane d "0, 0.02, 0" "0, -1, 0") },
  "output": { "frames": 0, "series": 0 } }
END
}

linear='"normal": { "stiffness": 1e4, "restitution": 0.5 }'
hertz='"normal": { "law": "hertz", "restitution": 0.5 }'
friction='"friction": { "coefficient": 0.5 }'
variants='plain friction|'$linear', '$friction'
no friction|'$linear'
static coefficient|'$linear', "friction": { "coefficient": 0.5, "static_coefficient": 0.6 }
rolling bounded|'$linear', '$friction', "rolling": { "law": "bounded", "coefficient": 0.1 }
rolling epsd|'$linear', '$friction', "rolling": { "law": "epsd", "coefficient": 0.1 }
rolling constant|'$linear', '$friction', "rolling": { "law": "constant", "coefficient": 0.1 }
twisting marshall|'$linear', '$friction', "twisting": { "law": "marshall" }
twisting constant|'$linear', '$friction', "twisting": { "law": "constant", "coefficient": 0.1 }
sjkr|'$linear', '$friction', "cohesion": { "law": "sjkr", "energy_density": 10 }
breakable|'$linear', '$friction', "cohesion": { "law": "breakable", "tension": 0.1, "shear": 0.1 }
plug-in, the plain law|"normal": { "plugin": "'$PLUGIN'", "stiffness": 1e4, "damping_ratio": 0.2553, "slide_stiffness": 2857, "friction": 0.5 }
hertz|'$hertz', '$friction'
hertz, rolling epsd|'$hertz', '$friction', "rolling": { "law": "epsd", "coefficient": 0.1 }
dmt|"normal": { "law": "dmt", "restitution": 0.5, "work_of_adhesion": 1e-3 }, '$friction'
jkr|"normal": { "law": "jkr", "restitution": 0.5, "work_of_adhesion": 1e-3 }, '$friction

scene "$linear, $friction" '{ "fill": { "mix": [ { "shape": "grain", "size": { "law": "fixed", "value": "2 mm" } } ],
    "box": [[0, 0, 0], [0.02, 0.02, 0.03]], "count": 1000, "seed": 1 } }' >settle.json
"$run" settle.json -q -j 1 --steps 20000 -D time.step=1e-5 -D damping.viscous=5 -o bed

i=0
echo "$variants" | while IFS='|' read -r name law; do
    i=$((i + 1))
    echo "$name" >name.$i
    scene "$law" '{ "file": "bed/final.csv" }' >scene.$i.json
done
count=$(echo "$variants" | wc -l)
# number NAME TEXT, the first of that name
number() { printf '%s' "$2" | grep -o "\"$1\": *[0-9.e+-]*" | head -1 | sed 's/.*: *//'; }
# touching FILE: contacts of a run
touching() {
    text=$(tr -d '\n' <"$1" | sed 's/"passes": *{[^}]*}//')
    echo $(($(number contacts "$text") + $(number wall_contacts "$text")))
}
for repeat in $(seq "$repeats"); do
    for i in $(seq "$count"); do
        "$run" scene.$i.json -q -j 1 --warmup 100 --steps "$steps" -o out.$i --json >json.$i
        passes=$(tr -d '\n' <json.$i | sed 's/.*"passes": *{\([^}]*\)}.*/\1/')
        awk -v a="$(number contacts "$passes")" -v b="$(number walls "$passes")" -v steps="$steps" \
            -v n="$(touching json.$i)" 'BEGIN { printf "%.4f\n", (a + b) / steps / n * 1e9 }' >>ns.$i
    done
done
printf '%-24s %10s %10s %8s %14s\n' law 'ns/contact' over ratio instructions
base=$(sort -g ns.1 | head -1)
for i in $(seq "$count"); do
    least=$(sort -g ns.$i | head -1) instructions=-
    if [ "${COUNT:-1}" != 0 ] && command -v valgrind >/dev/null; then
        for n in 50 150; do
            valgrind --tool=callgrind --callgrind-out-file=cg "$run" scene.$i.json -q -j 1 --steps $n -o cg.out 2>&1 |
                sed -n 's/.*Collected : //p' >cg.$n
        done
        instructions=$(awk -v a="$(cat cg.50)" -v b="$(cat cg.150)" -v c="$(touching json.$i)" \
            'BEGIN { printf "%.0f", (b - a) / 100 / c }')
    fi
    awk -v name="$(cat name.$i)" -v t="$least" -v b="$base" -v n="$instructions" \
        'BEGIN { printf "%-24s %10.1f %10.1f %8.2f %14s\n", name, t, t - b, t / b, n }'
done
