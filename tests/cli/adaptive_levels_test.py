#!/usr/bin/env python3
"""Roughing of whole parts at a bounded engagement: beside the same job without it nothing stays that was cut, no cut is
deeper, and `cusp verify` finds the angle that was asked for.

usage: adaptive_levels_test.py CUSP [PARTS]
"""
import json
import pathlib
import sys
import unittest

from cusp_case import CuspCase, share_of

PARTS = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else pathlib.Path(__file__).parents[2] / "examples/parts").resolve()
JOB = """
{tools}
[cutting]
feed = 1000
[stock]
top = {top}
[[operation]]
strategy = "{strategy}"
floor = ["{part}"]
max_depth = {depth}
allowance = 0.3
output = "arcs"
{keys}
"""
FLAT12 = '[[tool]]\nshape = "flat"\ndiameter = 12\n'
BULL12 = '[[tool]]\nshape = "bull"\ndiameter = 12\ncorner_radius = 2\n'
BALL10 = '[[tool]]\nshape = "ball"\ndiameter = 10\n'
FLAT5 = '[[tool]]\nnumber = 2\nshape = "flat"\ndiameter = 5\n'
ANGLE = 70


class AdaptiveLevels(CuspCase):
    def job(self, **about):
        part = PARTS / "chuang-pan-tap.json"
        (self.folder / "job.toml").write_text(JOB.format(part=part, top=18.66666667, **about))

    def planned(self, **about):
        self.job(**about)
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        self.cusp(0, "verify", "job.toml", "p.ngc", "--grid", "0.3", "--stats", "v.json")
        plan, verified = (json.loads((self.folder / f).read_text()) for f in ("p.json", "v.json"))
        return plan["operations"], verified

    def judge(self, strategy, tools, depth, keys="", measured=True):
        _, plain = self.planned(strategy=strategy, tools=tools, depth=depth, keys=keys)
        adaptive = keys + f'\nclearing = "adaptive"\nmax_engagement = {ANGLE}'
        operations, found = self.planned(strategy=strategy, tools=tools, depth=depth, keys=adaptive)
        self.assertGreater(found["removed_mm3"], 0.997 * plain["removed_mm3"])
        self.assertLess(found["cut_depth_max_mm"], depth + 0.02)
        roughing = [o for o in operations if "engagement_bound_deg" in o]
        self.assertTrue(roughing)
        for operation in roughing:
            self.assertLessEqual(operation["engagement_bound_deg"], ANGLE + 1e-6)
            self.assertLessEqual(operation["over_engagement_mm"], 1e-3 * operation["cut_length_mm"])
            self.assertGreater(operation["mean_removal_mm3_per_min"], 0)
        if measured:
            # The first level turns of entries are part of these here, and cuts there.
            entries = sum(o["entries"] for o in roughing) * 0.15 * 12
            self.assertLess(found["over_engagement_mm"] - entries, 0.002 * plain["cut_length_mm"])

    def test_hull_rough_by_each_end_and_by_two_tools(self):
        for tools, depth, keys, measured in share_of([(FLAT12, 9.4, "", True), (BULL12, 9.4, "", True), (FLAT12, 6.3, "", True),
                                                      (FLAT12 + FLAT5, 9.4, "\ntools = [1, 2]", True), (BALL10, 9.4, "", False)]):
            with self.subTest(tools=tools, depth=depth):
                self.judge("hull_rough", tools, depth, "extra_subdivision = 2" + keys, measured)

    def test_isocurves(self):
        self.judge("adaptive_isocurve", FLAT12 + BALL10.replace("shape", "number = 3\nshape"), 9.4,
                   "roughing = true\ntool = 3\ntools = [1]\nscallop = 0.5", measured=False)

    # Its finish has no bound: it is counted.
    def test_grid_pocket(self):
        def planned(keys):
            tool = 'units = "inch"\n[[tool]]\nshape = "flat"\ndiameter = 0.25\n'
            (self.folder / "job.toml").write_text(JOB.format(
                tools=tool, top=0, strategy="grid_pocket", part=PARTS / "choi-polygon-floor.json", depth=0.15,
                keys=f'boundary = "{PARTS / "choi-polygon-boundary.json"}"\ngrid = [0.125, 0.0625]\n' + keys)
                .replace("allowance = 0.3", "").replace("feed = 1000", "feed = 40"))
            self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
            self.cusp(0, "verify", "job.toml", "p.ngc", "--max-engagement", str(ANGLE), "--stats", "v.json")
            return [json.loads((self.folder / f).read_text()) for f in ("p.json", "v.json")]
        _, cells = planned("")
        plan, found = planned(f'clearing = "adaptive"\nmax_engagement = {ANGLE}')
        operation = plan["operations"][0]
        self.assertLessEqual(operation["engagement_bound_deg"], ANGLE + 1e-6)
        self.assertLess(operation["over_engagement_mm"], 5)
        self.assertGreater(found["over_engagement_mm"], 100 * operation["over_engagement_mm"])
        self.assertLess(found["over_engagement_mm"], 0.5 * cells["over_engagement_mm"])
        # The height map of the plan is not looked at again where trochoids are.
        self.assertGreater(operation["found_over_engagement_mm"], 0.95 * found["over_engagement_mm"])
        self.assertLess(operation["found_over_engagement_mm"], 1.5 * found["over_engagement_mm"])
        self.assertLess(found["cut_depth_max_mm"], 0.15 * 25.4)
        self.assertEqual(found["rapid_cut_max_mm"], 0)
        self.assertGreater(found["removed_mm3"], 0.997 * cells["removed_mm3"])

    # The demo's pocket. Steps stay where the ball does not reach, beside walls.
    def test_a_pocket_over_a_curved_floor(self):
        def planned(keys):
            boundary = f'boundary = "{PARTS / "suh-lee-boundary.json"}"\n'
            self.write("job.toml", JOB.format(
                tools=FLAT12 + BALL10.replace("shape", "number = 3\nshape"), top=0, strategy="contour_pocket",
                part=PARTS / "suh-lee-floor.json", depth=12,
                keys=f'{boundary}islands = ["{PARTS / "suh-lee-island.json"}"]\nscallop = 0.2\nfloor_tolerance = 0.05\n'
                     f'tool = 3\ntools = [1]\n' + keys))
            self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
            said = self.cusp(0, "verify", "job.toml", "p.ngc", "--max-engagement", str(ANGLE), "--stats", "v.json")
            self.assertIn("all bounds hold", said)
            return [json.loads((self.folder / f).read_text()) for f in ("p.json", "v.json")]
        _, loops = planned("")
        plan, found = planned(f'clearing = "adaptive"\nmax_engagement = {ANGLE}')
        roughing = plan["operations"][0]
        self.assertLessEqual(roughing["engagement_bound_deg"], ANGLE + 1e-6)
        self.assertLess(roughing["over_engagement_mm"], 1e-3 * roughing["cut_length_mm"])
        self.assertLess(found["over_engagement_mm"], 0.1 * loops["over_engagement_mm"])
        self.assertLess(found["cut_depth_max_mm"], 12.02)
        self.assertEqual(found["rapid_cut_max_mm"], 0)
        self.assertGreater(found["removed_mm3"], 0.997 * loops["removed_mm3"])

    def test_what_has_no_meaning_is_refused(self):
        def refused(strategy, keys):
            self.job(strategy=strategy, tools=FLAT12, depth=4, keys=keys)
            return self.cusp(2, "plan", "job.toml", "-o", "p.ngc")
        adaptive = 'clearing = "adaptive"\n'
        curved = f'boundary = "{PARTS / "suh-lee-boundary.json"}"\nscallop = 0.2\n'
        self.job(strategy="contour_pocket", tools=FLAT12, depth=4, keys=adaptive + curved)
        text = (self.folder / "job.toml").read_text().replace("chuang-pan-tap", "suh-lee-floor")
        self.write("job.toml", text.replace("max_depth = 4\nallowance = 0.3\n", ""))
        self.assertIn('clearing: "adaptive" needs max_depth or layers: the floor is not level',
                      self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))
        self.assertIn("overlap: does not go with", refused("hull_rough", adaptive + "overlap = 1"))
        grid = f'boundary = "{PARTS / "choi-polygon-boundary.json"}"\ngrid = [1, 1]\n'
        self.job(strategy="grid_pocket", tools=FLAT12, depth=4, keys=adaptive + grid)
        job = self.folder / "job.toml"
        job.write_text(job.read_text().replace("max_depth = 4", "").replace("allowance = 0.3", ""))
        self.assertIn("needs max_depth or layers", self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))
        self.assertIn('clearing: "adaptive" needs roughing = true',
                      refused("adaptive_isocurve", adaptive + "scallop = 0.1"))
        self.assertIn("allowance: is no key of parallel_planes", refused("parallel_planes", "scallop = 0.1"))
        self.assertIn("max_engagement: needs clearing", refused("hull_rough", "max_engagement = 60"))
        self.assertIn("max_engagement", refused("hull_rough", adaptive + "max_engagement = 170"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
