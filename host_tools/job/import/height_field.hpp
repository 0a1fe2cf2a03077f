// A mesh seen from above as one smooth surface that never lies below it.
#pragma once

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/stl_facets.hpp"

namespace cusp::import {

struct HeightField {
    // Bicubic over the mesh's box in x and y; u runs along x, v along y, both in mm. Nowhere below
    // the mesh: a tool that does not gouge the surface does not gouge the mesh.
    nurbs::Surface surface;
    double cell{};           // mm between knots
    double lift{};           // mm: bound of what was added to the smooth fit, anywhere
    double loose_share{};    // fraction of cells raised by more than the tolerance: steps, creases
    double overhang_area{};  // mm^2, in plan, of downward facets above the mesh's base
    double open_share{};     // fraction of the box without facets: has the mesh's lowest height
};

// Passes cross one smooth surface without interruption, its control points bound it, and every
// strategy accepts it. Cells are halved until the surface is raised by at most `tolerance`, down to
// 1/192 of the box (1/96 where finer cells do not reduce the error at steps of the mesh).
//
// tolerance  mm, > 0: how far the surface may lie above the mesh where the mesh is smooth
//
// Proof (HeightField tests): a plane through the Bezier points of each part of a cell, lowered by
// their spread, is below the surface. Facets are clipped to the part and compared with the plane at
// their corners. The deficit is added to every control point that influences the part; B-splines
// sum to 1, so the surface rises by at least that.
HeightField height_field(const Facets& facets, double tolerance);

// As height_field(), for facets that do not fill their box: beyond them the surface is extrapolated
// smoothly, to be trimmed. `lift` and `loose_share` are measured along the facets' normals.
HeightField height_patch(const Facets& facets, double tolerance);

// mm^2, in plan, of downward facets above the mesh's base.
double overhang_area(const Facets& facets);

}  // namespace cusp::import
