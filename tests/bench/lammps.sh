# Read by run.sh: the same scene for LAMMPS (atom style sphere, fix rigid/small with our mass and moments).

# lammps_deck DIR SPHERES BODY STATE WARMUP STEPS WIDTH DEPTH: writes data, bodies and in; SPHERES lines x y z r, BODY mass and
# moments, STATE a final.csv; a floor and, with a width and depth, four sides
lammps_deck() {
    mkdir -p "$1"
    awk -F, -v dir="$1" -v spheres="$2" -v body="$3" -v width="$7" -v depth="$8" '
        BEGIN {
            split(body, m, " ")
            while ((getline line < spheres) > 0) { k++; split(line, s, " "); for (i = 1; i <= 4; i++) c[k, i] = s[i]; if (!least || s[4] < least) least = s[4] }
            while ((getline line < ARGV[1]) > 0) n++
            n--; pi = atan2(0, -1)
            atoms = dir "/data"; speeds = dir "/speeds"; bodies = dir "/bodies"; names = dir "/names"
            print n > bodies
            printf "grains\n\n%d atoms\n1 atom types\n%g %g xlo xhi\n%g %g ylo yhi\n-0.005 0.5 zlo zhi\n\nAtoms # sphere\n\n", n * k,
                -0.005, width + 0.005, -0.005, depth + 0.005 > atoms
            print "\nVelocities\n" > speeds
            print "\nMolecules\n" > names
        }
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        {
            number++
            q0 = $at["qw"]; q1 = $at["qx"]; q2 = $at["qy"]; q3 = $at["qz"]
            w[1] = $at["wx"]; w[2] = $at["wy"]; w[3] = $at["wz"]; v[1] = $at["vx"]; v[2] = $at["vy"]; v[3] = $at["vz"]
            R[1,1] = 1-2*(q2*q2+q3*q3); R[1,2] = 2*(q1*q2-q0*q3); R[1,3] = 2*(q1*q3+q0*q2)
            R[2,1] = 2*(q1*q2+q0*q3); R[2,2] = 1-2*(q1*q1+q3*q3); R[2,3] = 2*(q2*q3-q0*q1)
            R[3,1] = 2*(q1*q3-q0*q2); R[3,2] = 2*(q2*q3+q0*q1); R[3,3] = 1-2*(q1*q1+q2*q2)
            for (i = 1; i <= 3; i++) for (j = 1; j <= 3; j++) {
                I[i, j] = 0
                for (l = 1; l <= 3; l++) I[i, j] += R[i, l] * m[1 + l] * R[j, l]
            }
            for (i = 1; i <= 3; i++) L[i] = I[i, 1] * w[1] + I[i, 2] * w[2] + I[i, 3] * w[3]
            printf "%d %s %.12g %.12g %.12g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g 0 0 0\n", number, m[1], $at["x"],
                $at["y"], $at["z"], I[1,1], I[2,2], I[3,3], I[1,2], I[1,3], I[2,3], v[1], v[2], v[3], L[1], L[2], L[3] > bodies
            for (j = 1; j <= k; j++) {
                atom++
                for (i = 1; i <= 3; i++) a[i] = R[i,1] * c[j,1] + R[i,2] * c[j,2] + R[i,3] * c[j,3]
                r = c[j, 4]
                printf "%d 1 %.9g %.9g %.12g %.12g %.12g\n", atom, 2 * r, m[1] / k / (4 / 3 * pi * r * r * r), $at["x"] + a[1],
                    $at["y"] + a[2], $at["z"] + a[3] > atoms
                printf "%d %.9g %.9g %.9g %.9g %.9g %.9g\n", atom, v[1] + w[2]*a[3] - w[3]*a[2], v[2] + w[3]*a[1] - w[1]*a[3],
                    v[3] + w[1]*a[2] - w[2]*a[1], w[1], w[2], w[3] > speeds
                printf "%d %d\n", atom, number > names
            }
        }
        END { printf "%.9g\n", least > (dir "/least") }' "$4"
    cat "$1/speeds" "$1/names" >>"$1/data"
    skin=$(awk '{ print 0.3 * $1 }' "$1/least")
    law="hooke/history $stiffness $slide_stiffness $damping_rate $slide_damping_rate $friction 1"
    many=$(awk 'END { print (NR > 1) }' "$2")
    {
        printf 'units si\natom_style sphere\natom_modify map array\nnewton off\ncomm_modify vel yes cutoff 0.012\n'
        printf 'boundary f f f\nfix names all property/atom mol ghost yes\nread_data data fix names NULL Molecules\n'
        printf 'neighbor %s bin\nneigh_modify delay 0 every 1 check yes %s\n' "$skin" \
            "$([ "$many" = 1 ] && echo exclude molecule/intra all)"
        printf 'pair_style gran/%s\npair_coeff * *\n' "$law"
        # left on, gravity would act once on the spheres and once on the bodies
        printf 'fix weight all gravity 9.81 vector 0 0 -1 %s\n' "$([ "$many" = 1 ] && echo disable)"
        if [ "$many" = 1 ]; then
            echo 'fix move all rigid/small molecule infile bodies gravity weight'
        else
            echo 'fix move all nve/sphere'
        fi
        printf 'fix floor all wall/gran %s zplane 0 NULL\n' "$law"
        printf 'fix sides all wall/gran %s xplane 0 %s\nfix ends all wall/gran %s yplane 0 %s\n' "$law" "$7" "$law" "$8"
        printf 'timestep %s\ncompute touching all contact/atom\ncompute sum all reduce sum c_touching\n' $step
        printf 'variable contacts equal c_sum/2\nthermo_style custom step cpu v_contacts\nthermo_modify lost error norm no\n'
        printf 'thermo %d\nrun %d\nthermo %d\nrun %d\n' "$5" "$5" "$6" "$6"
    } >"$1/in"
}

# lammps_time DIR: seconds of a core for a timed step, and the contacts at the end of the warm-up
lammps_time() {
    (cd "$1" && OMP_NUM_THREADS=1 "$lmp" -in in >out 2>&1) || { tail -3 "$1/out" >&2; return 1; }
    awk '/^Loop time of/ { t = $4 / $9; runs++ } /% CPU use/ { busy = $1 } $1 ~ /^[0-9]+$/ && NF == 3 && !runs { contacts = $3 }
        END { print t * busy / 100, contacts }' "$1/out"
}
