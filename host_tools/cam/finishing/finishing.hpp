// Finishing: passes free of gouges, links between them, and the proof of the scallop.
//
//     const part_model::PartModel model{surfaces};
//     GougeFreePathFitter fitter{model, ball, make_tolerance_band(0.01, true)};
//     ScallopCheck check{surfaces, fitter, 0.02, 0.002};  // scallop, distance of path and tips: mm
//     std::vector<SurfacePass> passes;
//     const auto cut = [&](const Points& dense) {         // tips of a pass, densely sampled
//         passes.push_back({fitter.fit_lines(dense), {}, {}});
//         check.add(passes.back().points);
//     };
//     for (double y = 0; y <= 30; y += 0.5) {
//         cut(fitter.sample_dropped({0, y, 0}, {40, y, 0}));
//     }
//     check.check(0);                                     // surface 0: records uncovered cells
//     check.add_missing_passes(cut, [](double) {});       // passes there
//     const LinkedPasses path = link_passes(passes, {2.0, 10.0, 1.0}, fitter);
//     check.uncovered() == 0 && fitter.least_clearance() >= 0;  // proved: scallop and gouges
//
// Gouges. GougeFreePathFitter turns dense points of the tip into lines, arcs or one NURBS. For each
// move it proves a lower bound of the clearance from the model. ContactTracker drops the ball at
// neighbouring places. Passes are linked along the model, or over it (link_passes).
//
// Scallops. SweptVolume is what the moves of all passes of a ball remove, SweptTool those of any end.
// ScallopCheck divides surfaces into cells, a MeshCheck divides triangles, until one move proves each cell
// or the cell is known to be uncovered: MeshScallopCheck for a ball, EndScallopCheck for other ends.
// UncutWalls looks at vertical facets. ScallopAtPoint measures a single point for a ball, MeshGround for
// any end over a mesh. If the ball cannot touch a point, ReachableHeight searches for its lowest position
// there, LowerPositionProof proves that there is none lower, and VisibilityFromAbove excludes what other
// surfaces hide.
#pragma once

#include "host_tools/cam/finishing/contact_tracker.hpp"
#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"
#include "host_tools/cam/finishing/pass_links.hpp"
#include "host_tools/cam/finishing/scallop_check.hpp"
