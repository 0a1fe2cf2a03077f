#!/usr/bin/env python3
"""One box as STL, OBJ and 3MF: cusp info and cusp plan give the same results for all three; broken 3MF files are refused.

usage: mesh_files_test.py CUSP [--without-3mf]
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

CUSP = str(pathlib.Path(sys.argv[1]).resolve())
HAS_3MF = "--without-3mf" not in sys.argv

CORNERS = [(0, 0, 0), (30, 0, 0), (30, 20, 0), (0, 20, 0), (0, 0, 8), (30, 0, 8), (30, 20, 4), (0, 20, 4)]
FACES = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6),
         (3, 0, 4), (3, 4, 7)]

TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>"""
RELATIONS = """<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0"
Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"""


def stl():
    facets = ""
    for face in FACES:
        corners = "".join("vertex %g %g %g\n" % CORNERS[k] for k in face)
        facets += f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n"
    return f"solid box\n{facets}endsolid box\n"


def obj():
    return ("".join("v %g %g %g\n" % c for c in CORNERS)
            + "".join("f %d %d %d\n" % tuple(k + 1 for k in face) for face in FACES))


def mesh(corners=CORNERS):
    vertices = "".join('<vertex x="%.9g" y="%.9g" z="%.9g"/>' % c for c in corners)
    triangles = "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % f for f in FACES)
    return f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"


def model(resources, items, unit="millimeter"):
    return (f'<?xml version="1.0" encoding="UTF-8"?><model unit="{unit}" xml:lang="en-US" '
            'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
            f"<resources>{resources}</resources><build>{items}</build></model>")


class MeshFiles(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="cusp_mesh_files_")
        self.addCleanup(self.folder.cleanup)

    def write(self, name, text):
        path = pathlib.Path(self.folder.name, name)
        if name.endswith(".3mf"):
            with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
                archive.writestr("[Content_Types].xml", TYPES)
                archive.writestr("_rels/.rels", RELATIONS)
                archive.writestr("3D/3dmodel.model", text)
        else:
            path.write_text(text)
        return name

    def run_cusp(self, *arguments):
        return subprocess.run([CUSP, *arguments], cwd=self.folder.name, capture_output=True, text=True, timeout=240,
                              check=False)

    def box_of(self, name):
        ran = self.run_cusp("info", name, "--stats", "info.json")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        facts = json.loads(pathlib.Path(self.folder.name, "info.json").read_text())["files"][0]
        return facts["format"], facts["box_low_mm"], facts["box_high_mm"]

    def gcode_of(self, name):
        ran = self.run_cusp("plan", name, "--tool", "ball:6", "--scallop", "0.1", "-o", "part.ngc")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        lines = pathlib.Path(self.folder.name, "part.ngc").read_text().splitlines()
        return [line for line in lines if name not in line]

    def test_obj_and_3mf_are_cut_as_stl_is(self):
        self.write("box.stl", stl())
        wanted = self.gcode_of("box.stl")
        names = [self.write("box.obj", obj())]
        if HAS_3MF:
            names.append(self.write("box.3mf", model(f'<object id="1" type="model">{mesh()}</object>',
                                                     '<item objectid="1"/>')))
        for name in names:
            self.assertEqual(self.box_of(name)[0], name[-3:].upper())
            self.assertEqual(self.gcode_of(name), wanted)

    def test_a_file_in_the_job_s_unit_or_its_own(self):
        self.write("box.obj", obj())
        ran = self.run_cusp("plan", "box.obj", "--units", "inch", "--tool", "ball:1", "--scallop", "0.1", "--print-job")
        self.assertIn("part: 30 x 20 inch from above", ran.stderr + ran.stdout)

    @unittest.skipUnless(HAS_3MF, "this build reads no 3MF")
    def test_3mf_items_are_placed_with_their_components(self):
        # A quarter turn about z and 10 cm along x; then the item raises it by 5 cm.
        name = self.write("box.3mf", model(
            f'<object id="1" type="model">{mesh([(x / 10, y / 10, z / 10) for x, y, z in CORNERS])}</object>'
            '<object id="2" type="model"><components>'
            '<component objectid="1" transform="0 1 0 -1 0 0 0 0 1 10 0 0"/></components></object>',
            '<item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 5"/>', "centimeter"))
        form, low, high = self.box_of(name)
        self.assertEqual(form, "3MF")
        for found, wanted in zip(low + high, [80, 0, 50, 100, 30, 58]):
            self.assertAlmostEqual(found, wanted, places=4)

    @unittest.skipUnless(HAS_3MF, "this build reads no 3MF")
    def test_broken_3mf_files_are_refused(self):
        whole = model(f'<object id="1" type="model">{mesh()}</object>', '<item objectid="1"/>')
        nested = "".join(f'<object id="{k}" type="model"><components><component objectid="{k - 1}"/>'
                         f'<component objectid="{k - 1}"/></components></object>' for k in range(2, 28))
        broken = {"cut.3mf": whole[:len(whole) // 2],
                  "none.3mf": model(f'<object id="1" type="model">{mesh()}</object>', ""),
                  "absent.3mf": model(f'<object id="1" type="model">{mesh()}</object>', '<item objectid="9"/>'),
                  "index.3mf": whole.replace('v1="0"', 'v1="800"'),
                  "nan.3mf": whole.replace('x="30"', 'x="nan"'),
                  "far.3mf": whole.replace('x="30"', 'x="3e9"'),
                  "bomb.3mf": model(f'<object id="1" type="model">{mesh()}</object>' + nested, '<item objectid="27"/>')}
        for name, text in broken.items():
            self.write(name, text)
        pathlib.Path(self.folder.name, "text.3mf").write_text("no archive")
        for name in [*broken, "text.3mf", "nowhere.3mf"]:
            for command in (["info", name], ["plan", name, "--tool", "ball:6", "--scallop", "0.1", "-o", "x.ngc"]):
                ran = self.run_cusp(*command)
                self.assertEqual(ran.returncode, 2, f"{name}: {ran.stdout}{ran.stderr}")
                self.assertIn(name, ran.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
