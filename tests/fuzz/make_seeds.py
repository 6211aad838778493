#!/usr/bin/python3
"""Writes small valid files to start the fuzzers from: make_seeds.py FOLDER -> FOLDER/{stl,obj,ply,off,sniff,scene,csv,
checkpoint,clump_import}/"""
import hashlib
import os
import struct
import sys

corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
sides = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
triangles = [t for s in sides for t in ((s[0], s[1], s[2]), (s[0], s[2], s[3]))]
comb = [(0, 0), (5, 0), (5, 2), (4, 2), (4, 1), (3, 1), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)]


def stl_binary():
    data = b''.join(struct.pack('<12fH', 0, 0, 0, *[x for i in t for x in corners[i]], 0) for t in triangles)
    return bytes(80) + struct.pack('<I', len(triangles)) + data


def stl_text():
    facet = 'facet normal 0 0 1\n outer loop\n%s endloop\nendfacet\n'
    return 'solid a\n' + ''.join(facet % ''.join('  vertex %g %g %g\n' % corners[i] for i in t) for t in triangles) + \
        'endsolid a\n'


def ply(form, order, number, length):
    head = 'ply\nformat %s 1.0\ncomment c\nelement vertex 8\n' % form
    head += ''.join('property %s %s\n' % (number[0], axis) for axis in 'xyz') + 'property uchar red\n'
    head += 'element face 6\nproperty list %s int vertex_indices\nelement edge 1\nproperty int a\nend_header\n' % length[0]
    if form == 'ascii':
        body = ''.join('%g %g %g 9\n' % c for c in corners) + ''.join('4 %d %d %d %d\n' % s for s in sides) + '7\n'
        return (head + body).encode()
    body = b''.join(struct.pack(order + '3' + number[1] + 'B', *c, 9) for c in corners)
    return head.encode() + body + b''.join(struct.pack(order + length[1] + '4i', 4, *s) for s in sides) + \
        struct.pack(order + 'i', 7)


obj = ''.join('v %g %g %g\n' % c for c in corners)
seeds = {
    'stl': [stl_binary(), stl_text(), stl_text().replace('\n', '\r\n').upper()],
    'obj': [obj + ''.join('f %d %d %d %d\n' % tuple(i + 1 for i in s) for s in sides),
            '# c\nmtllib a\no b\n' + obj + 'vt 0 0\nvn 0 0 1\n' +
            ''.join('f %d/1/1 %d//1 %d/1 \\\n%d\n' % tuple(i - 8 for i in s) for s in sides) + 'l 1 2\n',
            ''.join('v %g %g 0\n' % c for c in comb) + 'f ' + ' '.join(str(i + 1) for i in range(len(comb)))],
    'ply': [ply('ascii', '', ('float', 'f'), ('uchar', 'B')), ply('binary_little_endian', '<', ('float', 'f'), ('uchar', 'B')),
            ply('binary_big_endian', '>', ('double', 'd'), ('int', 'i'))],
    'off': ['OFF\n8 6 12\n' + ''.join('%g %g %g\n' % c for c in corners) + ''.join('4 %d %d %d %d\n' % s for s in sides),
            '# c\nSTCNOFF 12 1 0\n' + ''.join('%g %g 0 1 1 1\n' % c for c in comb) + '12 0 1 2 3 4 5 6 7 8 9 10 11 255 0 0'],
}
seeds = {name: [s if isinstance(s, bytes) else s.encode() for s in some] for name, some in seeds.items()}
seeds['sniff'] = [b'd' + s for some in seeds.values() for s in some]
header = b'{"title": "t", "scene": "%s", "time": 0.5, "step": 7, "frames": 1, "rows": 2, "byte_order": "little"}' % (b'0f' * 32)
whole = b'dem-checkpoint/1\n%020d %020d\n%sstate' % (len(header), 5, header)
seeds['checkpoint'] = [b'1' + header, b'0' + whole + hashlib.sha256(whole).hexdigest().encode() + b'\n']
head = """{ "schema": "dem-scene/1", // a comment
"gravity": [0, 0, "-9.81 m/s2"], "time": {"end": 1, "step": "auto", "safety": 0.8, "contact_steps": 10},
"domain": {"min": [0, 0, null], "max": ["1 m", 1, null], "periodic": [true, false, false], "leaving": "ignore"},
"materials": {"a": {"density": 2500, "young": "1 GPa", "poisson": 0.2}},
"contacts": [{"between": ["a", "a"], "effective_mass": "body", "normal": {"law": "%s", %s "restitution": 0.5},
"friction": {"coefficient": 0.5}}], "damping": {"local": 0.1, "local_frame": "vector"}, """
tail = """"shapes": {"s": {"sphere": {"radius": 0.1}, "material": "a"}, "p": {"material": "a",
"spheres": [[0, 0, 0, 1], [1, 0, 0, 1]]}, "q": {"material": "a", "spheres": [[0, 0, 0, 1]], "mass": 1,
"inertia": [1, 1, 1]}}, "bodies": [{"shape": "s", "position": [0, 0, 1], "orientation": [1, 2, 3, 4], "size": "1 cm"},
{"fill": {"mix": [{"shape": "p", "share": 2, "size": {"law": "lognormal", "median": 1, "sigma": 0.1, "by": "mass"}},
{"shape": "s", "size": {"law": "table", "sizes": [1, 2], "passing": [0, 1]}}, {"shape": "q", "size": {"law": "uniform",
"min": 1, "max": 2}}], "box": [[0, 0, 0], [1, 1, 1]], "count": 5, "seed": 3, "gap": 1e-6}}],
"walls": {"w": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 1]}, "material": "a", "motion": {"rotate":
{"axis": [0, 1, 2], "rate": "10 rpm"}, "translate": {"velocity": [1, 0, 0]}}}, "b": {"box": {"min": [0, 0, 0],
"max": [1, 1, 1]}, "material": "a"}, "c": {"cylinder": {"point": [0, 0, 0], "axis": [0, 0, 1], "radius": 1,
"side": "outside"}, "material": "a"}}, /* and */ "output": {"frames": "5 ms", "checkpoint": "60 s wall",}}"""
scene = head % ('linear', '"stiffness": 1e4,') + tail
seeds['scene'] = [scene.encode(), (head % ('hertz', '') + tail).encode(), b'{"schema": "dem-scene/1"}',
                  b'\xfftime.end=5 ms\n' + scene.encode(), b'\xffbodies[0].scale=2\n{"schema": "dem-scene/1"}']
seeds['csv'] = [b'shape,x,y,z\nrock,1,2,3\n', b'\xef\xbb\xbf# c\r\nshape,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,scale,id\r\n'
                b'"a, ""b""",1.2345678901234567,-2e-3,3,1,2,3,4,5,6,7,8,9,10,0.5,"x"\r\n']
balls = [(-0.0023, -0.0008, -0.0003, 0.01), (0.0068, 0.0007, -0.0004, 0.008), (-0.0081, 0.0065, 0.0008, 0.006)]
rows = '\n'.join('%g %g %g %g' % b for b in balls) + '\n'
head = '# g: 3 spheres of dem-clump 0.1.0\n# frame: %s\n# unit of x y z r: m\n# density [kg/m^3]: 2650\n# mass [kg]: 0.015\n' \
    '# centre of mass [m]: 0 0 0\n# principal moments of inertia [kg m^2]: 6e-7 9e-7 1e-6\n' \
    '# principal to mesh frame, position [m]: 1 2 3\n# principal to mesh frame, quaternion w x y z: 0.6 0 0.8 0\n'
fix = 'fix p1 all particletemplate/multisphere 15485863 atom_type 1 density constant 2650 &\n nspheres 3 ntry 1000000 &\n' \
    'spheres %s type 1 scale 2 mass 0.015 inertia_tensor 6e-7 0 1e-8 9e-7 0 1e-6 use_density\n'
seeds['clump_import'] = [
    b'\0{"schema": "dem-clump/1", "density": 1, "mass": 1, "inertia": [1, 1, 1], "spheres": [[0, 0, 0, 1]]}',
    b'\1' + ('// g\nName\ng\nBegin centers_and_radii\n' + rows + 'End centers_and_radii\nParticle_center_and_diameter\n'
             '0 0 0 0.03\nSize\n0.03\nVolume\n5.8e-6\nInertia per unit mass\n4e-5\n6e-5\n7e-5\n').encode(),
    b'\2' + ('t\n\n3 atoms\n0.015 mass\n0 0 0 com\n6e-7 9e-7 1e-6 0 1e-8 0 inertia\n\nCoords\n\n' +
             ''.join('%d %g %g %g\n' % (i + 1, *b[:3]) for i, b in enumerate(balls)) + '\nTypes\n\n1 1\n2 1\n3 1\n\nDiameters\n\n' +
             ''.join('%d %g\n' % (i + 1, 2 * b[3]) for i, b in enumerate(balls)) + '\nMasses\n\n1 0.005\n2 0.005\n3 0.005\n').encode(),
    b'\4' + rows.encode(), b'\4' + (head % 'mesh').encode() + rows.replace(' ', ',').encode(),
    b'\4' + (head % 'principal').encode() + rows.replace('\n', '\r\n').encode(),
    b'\5' + (fix % rows.replace('\n', ' &\n')).encode(), b'\5' + (fix % 'file a').encode(),
    b'\5' + rows.replace('\n', ' 1\n').encode(), b'\3x,y,z,r\n' + rows.replace(' ', ',').encode()]
for name, some in seeds.items():
    os.makedirs(os.path.join(sys.argv[1], name), exist_ok=True)
    for i, seed in enumerate(some):
        with open(os.path.join(sys.argv[1], name, 'seed%d' % i), 'wb') as file:
            file.write(seed)
