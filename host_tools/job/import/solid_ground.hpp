// The parts of a solid that are cut from above: levels, walls, holes, slanted ground.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "host_tools/geometry/offset/shadow.hpp"
#include "host_tools/job/import/part_extent.hpp"
#include "host_tools/job/import/part_files.hpp"

namespace cusp::import {

// A stretch of heights.
struct SolidBand {
    double top;     // z, mm
    double bottom;  // of level ground or of the part; of walls their foot
    // Of walls: what stands above the bottom ends at the sides of the part's box alone.
    bool fills_box;
    double widest;  // mm: then, of walls, the radius of the largest disc beside them
};

struct SolidGround {
    PartExtent box;
    std::vector<SolidBand>
        openings;  // the highest first: down to the bottom something of the box is open beside the
                   // holes
    std::vector<SolidBand> walls;  // the highest first: upright walls begin at the bottom
    double wall{};                 // mm^2 of upright walls that begin elsewhere
    double slanted{};              // mm^2, seen from above: neither level nor upright
    Vec3d slanted_at;              // in its largest facet
};

// True if an operation of its own cuts the facet.
using IsCutApart = std::function<bool(const std::array<Vec3d, 3>& facet)>;

// Sides of the part's box are no walls, and nothing in the holes counts; what is cut apart is not slanted.
//
// facets  of the whole part
// holes   that are cut by themselves, with their mouths (mouths_of())
SolidGround ground_of_solid(const Triangles& facets,
                            const std::vector<job::Hole>& holes,
                            const std::vector<job::Hole>& mouths,
                            const IsCutApart& is_cut_apart);

}  // namespace cusp::import
