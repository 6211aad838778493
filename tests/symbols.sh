#!/bin/sh
# Every external symbol of the libraries carries the prefix and is defined once, so that one program can use both.
# Only names C could spell count: compilers add weak and dotted ones of their own, shared by whoever defines them.
command -v nm >/dev/null || exit 77
nm --defined-only "$@" | awk '
NF == 3 && $2 ~ /[TDBR]/ && $3 ~ /^[A-Za-z][A-Za-z0-9_]*$/ {
    if ($3 !~ /^dem_/) { print $3 ": without the prefix"; bad = 1 }
    if (seen[$3]++) { print $3 ": defined twice"; bad = 1 }
    count++
}
END { if (!count) { print "no symbols found"; bad = 1 } exit bad }
'
