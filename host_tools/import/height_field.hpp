// A mesh seen from above as one smooth surface that never lies below it.
#pragma once

#include "host_tools/import/stl_facets.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

struct HeightField {
    // Bicubic over the mesh's box in x and y; u runs along x, v along y, both in mm. Nowhere below
    // the mesh, so what clears it clears the mesh.
    nurbs::Surface surface;
    double cell{};           // mm between knots
    double lift{};           // mm: bound of what was added to the smooth fit, anywhere
    double loose_share{};    // of the cells, where more than the tolerance was added: steps, edges
    double overhang_area{};  // mm^2, seen from below: facets that look down over the mesh's base
    double open_share{};     // of the box, where no facet lies: taken as the mesh's lowest height
};

// One smooth surface lets passes run across it without a break, is bounded by its control points,
// and suits every strategy. Cells are halved until nothing is added beyond `tolerance`, down to a
// 192nd of the box (a 96th where finer cells do not follow steps in the mesh any closer).
//
// tolerance  mm, > 0: how far the surface may lie above the mesh where the mesh is smooth
//
// Proof (HeightField tests): each part of a cell lies above a plane less the spread of its Bezier
// points; facets are clipped to the part and compared with that plane at their corners; what is
// missing is added to every control point that acts there, and B-splines add up to 1.
HeightField height_field(const Facets& facets, double tolerance);

// As height_field(), for facets that do not fill their box: beyond them the surface continues
// smoothly, to be trimmed away; `lift` and `loose_share` count along the facets' normals.
HeightField height_patch(const Facets& facets, double tolerance);

// mm^2, seen from below: facets that look down over the mesh's base.
double overhang_area(const Facets& facets);

}  // namespace cusp::import
