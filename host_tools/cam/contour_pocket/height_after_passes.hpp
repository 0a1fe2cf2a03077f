// Height of the stock that passes leave.
#pragma once

#include <vector>

#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::contour_pocket {

class HeightAfterPasses {
public:
    // The passes are sampled every `share` of the tool's radius, at their CL height.
    HeightAfterPasses(const clearing::ClearedRegion& cleared,
                      const drop_cutter::DropCutter& floor,
                      double share = 0.08);

    // z; kUnbounded where no pass comes within the tool's radius.
    double height(Vec2d place);

private:
    const drop_cutter::DropCutter& floor_;
    double apart_;
    std::vector<offset::Edge> edges_;
    offset::EdgeTree tree_;
    std::vector<std::vector<Vec3d>> tips_;  // along each edge; empty until first needed
};

}  // namespace cusp::contour_pocket
