# Read by the benchmarks: one figure out of the table of a one-grain run.

tool=${BUILD:-build}/dem-clump
grain=${BUILD:-build}/dem-grain
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# column TABLE NAME
column() {
    awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i } NR == 2 { print $c }' "$1"
}

# timed COMMAND...: runs it; sets `user` [s] and `peak` [MB]
timed() {
    /usr/bin/time -f '%U %M' -o "$work/time" "$@" >"$work/out" 2>"$work/err" || { cat "$work/err"; return 1; }
    user=$(cut -d' ' -f1 "$work/time")
    peak=$(awk '{ printf "%.0f", $2 / 1024 }' "$work/time")
}
