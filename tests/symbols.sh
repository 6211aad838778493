#!/bin/sh
# Every external symbol of the libraries carries the prefix and is defined once, so that one program can use both.
command -v nm >/dev/null || exit 77
nm --defined-only "$@" | awk '
NF == 3 && $2 ~ /[A-Z]/ && $3 !~ /^_/ {
    if ($3 !~ /^dem_/) { print $3 ": without the prefix"; bad = 1 }
    if (seen[$3]++) { print $3 ": defined twice"; bad = 1 }
    count++
}
END { if (!count) { print "no symbols found"; bad = 1 } exit bad }
'
