# Read by run.sh: the scenes that are timed. Grains are of glass, ellipsoids of 10 x 7 x 6 mm unless said otherwise, under
# the linear law of a spring, a dashpot and friction that LAMMPS has, too.

density=2500 stiffness=1e4 friction=0.5 damping_rate=2598.99303 step=1e-5
slide_stiffness=2857.14286 slide_damping_rate=1299.49651

# spheres_of ellipsoid|rod|plate|ball K: lines x y z r of a grain [m]
spheres_of() {
    awk -v kind="$1" -v k="$2" 'BEGIN {
        a = 5e-3; b = 3.5e-3; c = 3e-3; pi = atan2(0, -1); rod = 1e-3
        r = k < 4 ? 3e-3 : k < 8 ? 2.4e-3 : k < 20 ? 2e-3 : k < 50 ? 1.5e-3 : k < 100 ? 1e-3 : 8e-3 / sqrt(k)
        if (kind == "rod")
            for (i = 0; i < k; i++) printf "%.9g 0 0 %.9g\n", 18 * rod * ((i + 0.5) / k - 0.5), rod
        else if (kind == "plate")
            for (i = 0; i < k; i++) printf "%.9g %.9g 0 %.9g\n", 2 * rod * (i % 5 - 2), 2 * rod * (int(i / 5) - 2), rod
        else if (kind == "ball" || k == 1)
            printf "0 0 0 %.9g\n", exp(log(a * b * c) / 3)
        else  # on a spiral, each with its outside on the ellipsoid
            for (i = 0; i < k; i++) {
                z = 1 - 2 * (i + 0.5) / k; s = sqrt(1 - z * z); t = pi * (1 + sqrt(5)) * (i + 0.5)
                printf "%.9g %.9g %.9g %.9g\n", z * (a - r), s * cos(t) * (b - r), s * sin(t) * (c - r), r
            }
    }'
}

# body_of ellipsoid|rod|plate|ball K: mass and principal moments [kg, kg m^2]
body_of() {
    awk -v kind="$1" -v k="$2" -v density="$density" 'BEGIN {
        a = 5e-3; b = 3.5e-3; c = 3e-3; pi = atan2(0, -1)
        if (kind == "rod") { a = 1e-2 * sqrt(5 / 3); b = c = 1e-3 * sqrt(5 / 2) }
        if (kind == "plate") { a = b = 1e-2 * sqrt(5 / 12); c = 2e-3 * sqrt(5 / 12) }
        m = kind == "plate" ? density * 2e-7 : kind == "rod" ? density * pi * 1e-6 * 2e-2 : density * 4 / 3 * pi * a * b * c
        if (k == 1) a = b = c = exp(log(a * b * c) / 3)
        printf "%.9g %.9g %.9g %.9g\n", m, m / 5 * (b * b + c * c), m / 5 * (a * a + c * c), m / 5 * (a * a + b * b)
    }'
}

# shape_of KIND K: the grain as a shape of a scene; a name of shapes/clumps in place of KIND takes that, k is its own
shape_of() {
    case $1 in
    ellipsoid | rod | plate | ball)
        spheres_of "$1" "$2" | awk -v body="$(body_of "$1" "$2")" '
            BEGIN { split(body, m) }
            { s = s (NR > 1 ? ", " : "") sprintf("[%s, %s, %s, %s]", $1, $2, $3, $4) }
            END { printf "{ \"spheres\": [%s], \"mass\": %s, \"inertia\": [%s, %s, %s], \"material\": \"glass\" }", s,
                  m[1], m[2], m[3], m[4] }' ;;
    *) printf '{ "clump": "%s/shapes/clumps/%s.json", "material": "glass" }' "$root" "$1" ;;
    esac
}

linear() {
    printf '"effective_mass": "body", "normal": { "stiffness": %s, "damping_rate": %s,
        "restitution_mode": "tension_allowed" }, "friction": { "stiffness": %s, "damping_rate": %s, "coefficient": %s }' \
        $stiffness $damping_rate $slide_stiffness $slide_damping_rate $friction
}

hertz() { printf '"normal": { "law": "hertz", "restitution": 0.5 }, "friction": { "coefficient": %s }' $friction; }

plane() { printf '"%s": { "plane": { "point": [%s], "normal": [%s] }, "material": "glass" }' "$1" "$2" "$3"; }

# box WIDTH DEPTH: a floor and four sides
box() {
    plane floor "0, 0, 0" "0, 0, 1"
    printf ', '; plane x0 "0, 0, 0" "1, 0, 0"; printf ', '; plane x1 "$1, 0, 0" "-1, 0, 0"
    printf ', '; plane y0 "0, 0, 0" "0, 1, 0"; printf ', '; plane y1 "0, $2, 0" "0, -1, 0"
}

# periodic WIDTH DEPTH [HEIGHT]: repeats itself in the plane, or with a height everywhere
periodic() {
    printf '{ "min": [0, 0, %s], "max": [%s, %s, %s], "periodic": [true, true, %s] }' \
        "$([ "${3-}" ] && echo 0 || echo null)" "$1" "$2" "${3:-null}" "$([ "${3-}" ] && echo true || echo false)"
}

# write_scene FILE SHAPE BODIES WALLS [LAW [DOMAIN [GRAVITY]]]; `step`: its time step
write_scene() {
    cat >"$1" <<END
{ "schema": "dem-scene/1", "gravity": [0, 0, ${7:--9.81}], "time": { "step": $step },
  "domain": ${6:-{\}},
  "materials": { "glass": { "density": $density, "young": "${young:-1e7}", "poisson": 0.25 } },
  "contacts": [ { "between": ["glass", "glass"], ${5:-$(linear)} } ],
  "shapes": { "grain": $2 },
  "bodies": [ $3 ],
  "walls": { $4 },
  "output": { "frames": 0, "series": 0 } }
END
}

# fill COUNT LOW HIGH [MORE]: grains without overlap in a box, its corners as "x, y, z"; MORE: members of the mix
fill() {
    printf '{ "fill": { "mix": [ { "shape": "grain"%s } ], "box": [[%s], [%s]], "count": %s, "seed": 1%s } }' \
        "${4-}" "$2" "$3" "$1" "${5-}"
}

# tile FILE NX NY WIDTH DEPTH: bodies repeated
tile() {
    awk -F, -v OFS=, -v nx="$2" -v ny="$3" -v w="$4" -v d="$5" '
        NR == 1 { print; next }
        { for (i = 0; i < nx; i++) for (j = 0; j < ny; j++) {
              line = $1 "," sprintf("%.12g,%.12g", $2 + i * w, $3 + j * d)
              for (k = 4; k <= NF; k++) line = line "," $k
              print line
          } }' "$1"
}

# funnel: the triangles of a closed cone with a cylinder on it, as STL: 120 sectors, 10 and 20 rows, 7320 triangles
funnel() {
    awk -v r0=0.02 -v r1=0.05 -v h=0.04 -v top=0.3 'BEGIN {
        n = 120; pi = atan2(0, -1); print "solid funnel"
        for (row = -1; row < 30; row++) for (i = 0; i < n; i++) {
            for (e = 0; e < 2; e++) {
                k = row + e
                z[e] = k <= 0 ? 0 : k <= 10 ? h * k / 10 : h + (top - h) * (k - 10) / 20
                r[e] = k < 0 ? 0 : k <= 10 ? r0 + (r1 - r0) * k / 10 : r1
            }
            c0 = cos(2 * pi * i / n); s0 = sin(2 * pi * i / n); c1 = cos(2 * pi * (i + 1) / n); s1 = sin(2 * pi * (i + 1) / n)
            if (row >= 0) corner3(r[0] * c0, r[0] * s0, z[0], r[0] * c1, r[0] * s1, z[0], r[1] * c1, r[1] * s1, z[1])
            corner3(r[0] * c0, r[0] * s0, z[0], r[1] * c1, r[1] * s1, z[1], r[1] * c0, r[1] * s0, z[1])
        }
        print "endsolid"
    }
    function corner3(a, b, c, d, e, f, g, h, i) {
        printf "facet normal 0 0 0\nouter loop\nvertex %.9g %.9g %.9g\nvertex %.9g %.9g %.9g\nvertex %.9g %.9g %.9g\nendloop\nendfacet\n",
            a, b, c, d, e, f, g, h, i
    }'
}

# the same as a cone and a cylinder
smooth_funnel() {
    plane floor "0, 0, 0" "0, 0, 1"
    printf ', "cone": { "cone": { "point": [0, 0, 0], "axis": [0, 0, 1], "radii": [0.02, 0.05], "length": 0.04 }, "material": "glass" }'
    printf ', "pipe": { "cylinder": { "point": [0, 0, 0], "axis": [0, 0, 1], "radius": 0.05 }, "material": "glass" }'
}
