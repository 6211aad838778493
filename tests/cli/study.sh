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
finish
