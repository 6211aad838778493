#!/bin/bash
# dem-run: results, restarts, interruptions, threads, and what is said when things are wrong.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-run" ] || exit 77

# a box of dumbbells and spheres that fall; 600 bodies, so that threads have something to share
bodies() {
    echo "shape,x,y,z,qw,qx,qy,qz,vx,vy,vz"
    awk 'BEGIN { srand(1); for (i = 0; i < 600; i++) {
        printf "%s,%.6f,%.6f,%.6f,%.3f,%.3f,%.3f,0.5,%.3f,%.3f,-0.5\n", i % 3 ? "pair" : "ball", 0.011 + 0.02 * (i % 10),
        0.011 + 0.02 * (int(i / 10) % 10), 0.011 + 0.02 * int(i / 100), rand(), rand(), rand(), rand() - 0.5, rand() - 0.5 } }'
}
bodies >bodies.csv
cat >box.json <<'END'
{ "schema": "dem-scene/1", "title": "a box",  // comments are allowed
  "gravity": [0, 0, -9.81],
  "time": { "end": "20 ms", "step": "20 us" },
  "materials": { "stone": { "density": 2500 } },
  "contacts": [ { "between": ["stone", "stone"],
      "normal": { "law": "linear", "stiffness": 2e4, "restitution": 0.5 },
      "friction": { "law": "linear", "coefficient": 0.5 } } ],
  "shapes": { "ball": { "sphere": { "radius": "8 mm" }, "material": "stone" },
              "pair": { "spheres": [[-0.003, 0, 0, 0.006], [0.003, 0, 0, 0.006]], "material": "stone" } },
  "bodies": [ { "file": "bodies.csv" } ],
  "walls": { "box": { "box": { "min": [0, 0, 0], "max": [0.2, 0.2, 1] }, "material": "stone" } },
  "output": { "directory": "results", "frames": "5 ms", "series": "1 ms", "checkpoint": "10 ms" } }
END

# ---- results
run 0 dem-run box.json --json
for key in steps time step loop_seconds setup_seconds clumps spheres contacts wall_contacts kinetic_energy potential_energy \
    energy_error max_overlap_ratio critical_step bytes_per_clump passes warnings; do
    prints "\"$key\": "
done
prints '"steps": 1000,'
prints '"clumps": 600,'
prints '"spheres": 1000,'
[ "$(ls results/frames | wc -l)" = 5 ] || fail "not 5 frames: $(ls results/frames)"
[ "$(grep -c '<DataSet' results/run.pvd)" = 5 ] || fail "not 5 frames in run.pvd"
[ "$(wc -l <results/series.csv)" = 22 ] || fail "not 21 rows in series.csv"
[ "$(wc -l <results/final.csv)" = 601 ] || fail "not 600 bodies in final.csv"
[ -s results/run.json ] && [ -s results/shapes/pair.vtp ] || fail "no run.json or shape"
cp -r results straight
run 0 dem-run box.json --steps 5 -o again
prints '600 clumps of 1000 spheres, 5 steps'
[ -s again/final.csv ] || fail "-o made no folder"

# the last state is a bodies file
sed 's/"bodies.csv"/"straight\/final.csv"/' box.json >next.json
run 0 dem-run next.json --steps 5 -o next -q
silent

# ---- the same bits for any number of threads
for threads in 1 2 3; do
    run 0 dem-run box.json -j $threads -q -o "threads$threads"
    cmp -s "threads$threads/final.csv" straight/final.csv || fail "$threads threads give another final.csv"
    cmp -s "threads$threads/series.csv" straight/series.csv || fail "$threads threads give another series.csv"
done

# ---- restarts: as if nothing had happened
run 0 dem-run box.json --steps 500 -o half -q
run 0 dem-run box.json -o half --resume half/checkpoint-500.dem -q
for file in final.csv series.csv run.pvd frames/000004.vtp; do
    cmp -s "half/$file" "straight/$file" || fail "a resumed run gives another $file"
done
# results behind the checkpoint are cut off first
run 0 dem-run box.json -o half --resume straight/checkpoint-500.dem --steps 750 -q
[ "$(wc -l <half/series.csv)" = 17 ] || fail "rows behind the checkpoint were kept"
# longer than the scene says
run 0 dem-run box.json -o half --resume straight/checkpoint-1000.dem --until "25 ms" --json
prints '"time": 0.025'

# ---- interrupted: a checkpoint, status 130, nothing lost
sed 's/"20 ms", "step"/"100 s", "step"/' box.json >long.json
timeout --foreground 60 "$tools/dem-run" long.json -o broken -q >out.txt 2>err &
pid=$!
for _ in $(seq 100); do ls broken/checkpoint-*.dem >/dev/null 2>&1 && break; sleep 0.1; done
kill -INT $pid
wait $pid
got=$?
ran="dem-run, interrupted"
[ "$got" = 130 ] || fail "$ran: status $got"
mentions 'interrupted at step [0-9]+; go on with --resume broken/checkpoint-[0-9]+.dem'
checkpoint=$(grep -o 'broken/checkpoint-[0-9]*.dem' err)
step=$(echo "$checkpoint" | grep -o '[0-9]*\.dem' | grep -o '[0-9]*')
steps=$((step + 200))
run 0 dem-run long.json -o broken --resume "$checkpoint" --steps $steps -q
run 0 dem-run long.json -o whole --steps $steps -q
cmp -s broken/final.csv whole/final.csv || fail "an interrupted run ends elsewhere"
cmp -s broken/series.csv whole/series.csv || fail "an interrupted run has another series"

# ---- broken checkpoints
head -c 5000 straight/checkpoint-1000.dem >cut.dem
run 3 dem-run box.json --resume cut.dem -q -o x
one_line
mentions '^dem-run: error: cut.dem: '
{ head -c 20000 straight/checkpoint-1000.dem; printf X; tail -c +20002 straight/checkpoint-1000.dem; } >altered.dem
run 3 dem-run box.json --resume altered.dem -q -o x
one_line
run 3 dem-run box.json --resume straight/checkpoint-1000.dem -D contacts.0.friction.coefficient=0.4 -q -o x
one_line
mentions 'another scene'
run 3 dem-run box.json --resume nowhere.dem -q -o x
mentions 'no such file'

# ---- looking
run 0 dem-run box.json --check
prints '^box.json: good: 600 bodies of 1000 spheres'
run 0 dem-run box.json --explain
prints 'spring\[2\]'
prints 'Embree is not started'
run 0 dem-run box.json --explain -D contacts.0.friction=null
grep -q spring out && fail "$ran: a history without friction"
run 0 dem-run --defaults
cp out defaults.json
run 0 dem-run defaults.json --check

# ---- overrides
run 0 dem-run box.json -D time.step=1e-5 -D gravity.2=0 -D 'title=no weight' --steps 3 --json -o x
prints '"step": 1.0000000000000001e-05,'
run 2 dem-run box.json -D nonsense --check
one_line
run 3 dem-run box.json -D time.stepp=1 --check
mentions 'did you mean "step"'

# ---- an unstable run says who, when, and from where to go on
run 1 dem-run box.json -D time.step=2e-3 -D time.end=5 -D output.checkpoint=4e-3 -o x -q
mentions 'body [0-9]+ \((ball|pair)\)'
mentions 'step [0-9]+'
mentions 'checkpoint'

# ---- wrong usage, bad input, no place to write
run 2 dem-run
mentions 'name the scene'
run 2 dem-run box.json --stepps 5
mentions 'did you mean --steps'
sed 's/"end": "20 ms", //' box.json >endless.json
run 2 dem-run endless.json -q
mentions 'give time.end in the scene, --until or --steps'
run 3 dem-run nowhere.json
mentions 'nowhere.json: no such file'
sed 's/"stiffness"/"stifness"/' box.json >typo.json
run 3 dem-run typo.json
says 'dem-run: error: typo.json:6: unknown key "stifness" (column 36); did you mean "stiffness"?'
run 4 dem-run box.json --steps 5 -q -o /proc/nowhere
one_line
# ---- what else can be measured and written
run 0 dem-run box.json -q -o net -D output.contacts=10ms -D 'measures={"foot": {"box": [[0, 0, 0], [0.2, 0.2, "5 cm"]]}}'
silent
[ "$(ls net/frames/contacts_*.vtp | wc -l)" = 3 ] && [ "$(ls net/frames/0*.vtp | wc -l)" = 5 ] || fail "$(ls net/frames)"
[ "$(grep -c 'file="frames/contacts_' net/contacts.pvd)" = 3 ] || fail "not 3 files in contacts.pvd"
head -1 net/series.csv | grep -q ',foot_stress_xx_Pa,.*,foot_void_ratio,' || fail "no columns of the region"
cut -d, -f1-20 net/series.csv | cmp -s - <(cut -d, -f1-20 straight/series.csv) || fail "measuring changes the run"
run 0 dem-run box.json --explain -D 'measures={"all": {"whole": true}}'
prints '^measures: stress, fabric and packing of 1 region with every row of the series, nothing in a step$'
run 3 dem-run box.json --check -D 'measures={"a": {"ball": {"centre": [0, 0, 0], "radius": -1}}}'
mentions 'must be above 0'
finish
