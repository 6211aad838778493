#!/bin/bash
# The default packer beside the field's methods: for each grain and number of spheres the best of the classics (those
# parameters of it that fit best), ours, the ratio of the two IoU gaps, and the processor time of each, on one core.
#   BUILD=build tests/bench/clump_sweep.sh [GRAIN...]     default: our own grains and those in ../shared/meshes
#   COUNTS=10,20,50,100,200,500   KEEP=DIR: the reports of every grain too (csv, svg, html)
# A star: the clump is in more than one piece, so no rigid body.
set -u
. "$(dirname "$0")/lib.sh"
counts=${COUNTS:-10,20,50,100,200,500}
keep=${KEEP:-$work/reports}
if [ $# = 0 ]; then
    set -- "$(dirname "$0")"/../../shapes/grains/*.obj "$(dirname "$0")"/../../../shared/meshes/*.{obj,stl}
fi

printf '%-22s %7s | %-11s %9s %9s | %9s %9s | %6s\n' grain spheres "classic" "gap %" "s" "ours %" "s" "ratio"
for mesh in "$@"; do
    [ -e "$mesh" ] || continue
    name=$(basename "${mesh%.*}")
    if [ -n "${KEEP:-}" ]; then
        output=("$keep/")
    else
        mkdir -p "$keep"
        output=("$keep/$name.csv")
    fi
    "$tool" "$mesh" -j 1 --keep largest --sweep "$counts" --methods all -q -o "${output[@]}" || continue
    awk -F, -v grain="$name" '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["status"] != "done" { next }
        {
            n = $at["asked"]; gap = $at["iou_gap"]
            if (!(n in seen)) { seen[n] = 1; order[++many] = n }
            if ($at["method"] == "optimal") { ours[n] = gap; ours_s[n] = $at["seconds_s"] }
            else if (!(n in best) || gap < best[n]) {
                best[n] = gap; best_s[n] = $at["seconds_s"]; method[n] = $at["method"] ($at["pieces"] > 1 ? "*" : "")
            }
        }
        END {
            for (i = 1; i <= many; i++) for (k = i + 1; k <= many; k++)
                if (order[k] + 0 < order[i] + 0) { t = order[i]; order[i] = order[k]; order[k] = t }
            for (i = 1; i <= many; i++) {
                n = order[i]
                printf "%-22s %7d | %-11s %9.3f %9.2f | %9.3f %9.2f | %6.2f\n", substr(grain, 1, 22), n, method[n],
                    100 * best[n], best_s[n], 100 * ours[n], ours_s[n], (ours[n] > 0 ? best[n] / ours[n] : 0)
            }
        }' "$keep/$name.csv"
done
