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

// Why one smooth surface: passes run across it without a break, its bounds come from its control
// points, and every strategy takes it. Cells are halved until nothing is added beyond `tolerance`,
// at most down to a 192nd of the box (a 96th where steps in the mesh get no closer by it).
//
// tolerance  mm, > 0: how far the surface may lie above the mesh where the mesh is smooth
//
// Proof (HeightField tests): each part of a cell lies above a plane less the spread of its Bezier
// points; facets are clipped to the part and compared with that plane at their corners; what is
// missing is added to every control point that acts there, and B-splines add up to 1.
HeightField height_field(const Facets& facets, double tolerance);

// The same for facets that do not fill their box: beyond them the surface goes on as smoothly as it
// can and is to be trimmed away; `lift` and `loose_share` count along the facets' normals.
HeightField height_patch(const Facets& facets, double tolerance);

// mm^2, seen from below: facets that look down over the mesh's base.
double overhang_area(const Facets& facets);

}  // namespace cusp::import
