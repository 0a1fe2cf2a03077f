// Puts passes in an order and joins them: along the model where they are near, else over it.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/finishing/gouge_free_path.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::finishing {

// A pass as it will be written: the curve where there is one, else the moves from the first point
// where there are any, else lines through the points. The points stay near whichever it is.
struct SurfacePass {
    Points points;
    std::optional<nurbs::Curve> curve;
    std::vector<toolpath::ToolMove> moves;
};

struct LinkRules {
    double stay_down{};    // mm in plan: nearer passes are joined on the model
    double clearance_z{};  // height of rapids
    double plunge_from{};  // height from which the tool goes down at the plunge feed
    bool one_way{false};   // passes keep their order and their direction
};

struct LinkedPasses {
    std::vector<toolpath::ToolMove> moves;
    int retracts{};
    double cut_length{};   // mm, passes
    double link_length{};  // mm, at feed between passes
    int points{};
};

// Zigzag: nearest end first, from the first pass on; passes may be turned round. O(n^2).
LinkedPasses link_passes(std::vector<SurfacePass> passes,
                         const LinkRules& rules,
                         GougeFreePathFitter& path_fitter);

}  // namespace cusp::finishing
