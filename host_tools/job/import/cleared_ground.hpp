// Heights of what stands around a place of a solid once flat ends have cleared its levels.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/import/solid_ground.hpp"

namespace cusp::import {

class ClearedGround {
public:
    // radius  of the flat end, mm
    ClearedGround(const Triangles& facets,
                  const std::vector<job::Hole>& holes,
                  const SolidGround& ground,
                  double radius);

    // z, mm: the lowest cleared level at the height `top` or over it that reaches all around the hole; else the part's top.
    double around(const job::Hole& hole, double top) const;

    // True if no stock stands above `top` in the region, but for the part itself.
    bool is_open(const offset::Region2d& region, double top) const;

private:
    struct Level {
        double z;
        offset::Region2d cleared;
        offset::Region2d stands;  // of the part
    };
    double top_;
    std::vector<Level> levels_;  // the highest first
};

}  // namespace cusp::import
