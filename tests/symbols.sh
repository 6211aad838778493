#!/bin/sh
# symbols.sh LIBDEM.a LIBDEMSHAPE.a LIBDEM.so LIBDEMSHAPE.so HEADERS
# Every external symbol of the static libraries carries the prefix and is defined once, so that one program can use both.
# Only names C could spell count: compilers add weak and dotted ones of their own, shared by whoever defines them.
# The shared libraries show what the public headers mark DEM_API, each function once, and nothing else.
command -v nm >/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
nm --defined-only "$1" "$2" | awk '
NF == 3 && $2 ~ /[TDBR]/ && $3 ~ /^[A-Za-z][A-Za-z0-9_]*$/ {
    if ($3 !~ /^dem_/) { print $3 ": without the prefix"; bad = 1 }
    if (seen[$3]++) { print $3 ": defined twice"; bad = 1 }
    count++
}
END { if (!count) { print "no symbols found"; bad = 1 } exit bad }
' || exit 1
cat "$5"/*.h | tr '\n' ' ' | grep -o 'DEM_API [^(;]*(' | grep -o 'dem_[a-z0-9_]*($' | tr -d '(' | sort >"$work/declared"
nm -D --defined-only "$3" "$4" | awk 'NF == 3 && $2 != "A" { sub(/@.*/, "", $3); print $3 }' | sort >"$work/shown"
[ -s "$work/declared" ] || { echo "no DEM_API in $5"; exit 1; }
diff "$work/declared" "$work/shown" >"$work/difference" && exit 0
echo "public headers (<) and shared libraries (>) differ:"
cat "$work/difference"
exit 1
