#!/bin/sh
# A file of lib/ includes only its own floor or lower ones; an outside library stands behind one file.
cd "$1" || exit 2
awk '
BEGIN {
    n = split("base 0 math 1 geom 2 ray 2 mesh 3 clump 4 sim 5 out 6 study 7", a, " ")
    for (i = 1; i < n; i += 2) floor[a[i]] = a[i + 1]
    pub["dem/base.h"] = 0; pub["dem/mesh.h"] = 3; pub["dem/clump.h"] = 4; pub["dem/scene.h"] = 5
    pub["dem/world.h"] = 5; pub["dem/picture.h"] = 6; pub["dem/export.h"] = 6; pub["dem/law.h"] = 5; pub["dem/dem.h"] = 7
    only["assimp"] = "lib/mesh/import_assimp.c"; only["embree"] = "lib/ray/ray.c"
    only["jansson"] = "lib/base/json.c"; only["png"] = "lib/out/png.c"; only["nettle"] = "lib/base/hash.c"
    only["CGAL"] = "lib/mesh/cgal"
}
/^[ \t]*#[ \t]*include/ {
    split(FILENAME, part, "/"); here = part[2]
    if (!(here in floor)) { print FILENAME ": lib/" here " is not a floor of the house"; bad = 1; nextfile }
    if (match($0, /"[^"]+"/)) {
        name = substr($0, RSTART + 1, RLENGTH - 2); split(name, p, "/")
        if (name in pub) f = pub[name]
        else if (p[1] in floor && p[2] != "") f = floor[p[1]]
        else { print FILENAME ":" FNR ": \"" name "\": name the folder of the header"; bad = 1; next }
        if (f > floor[here]) { print FILENAME ":" FNR ": " here " (floor " floor[here] ") includes " name " (floor " f ")"; bad = 1 }
    } else if (match($0, /<[^>]+>/)) {
        name = substr($0, RSTART + 1, RLENGTH - 2)
        for (l in only) if (name ~ "^" l "[0-9]*[/.]" && index(FILENAME, only[l]) != 1) {
            print FILENAME ":" FNR ": <" name "> belongs behind " only[l]; bad = 1 }
    }
    seen++
}
END { if (!seen) { print "no includes found"; bad = 1 } exit bad }
' $(find lib -path lib/include -prune -o \( -name '*.c' -o -name '*.h' -o -name '*.cpp' \) -print | sort)
