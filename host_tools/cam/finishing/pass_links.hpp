// Order and links of passes: along the model between near ends, else over it at clearance height.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::finishing {

// A pass as it will be written: the curve if there is one, else the moves from the first point if
// there are any, else lines through the points. The points always lie within the band of the path.
struct SurfacePass {
    Points points;
    std::optional<nurbs::Curve> curve;
    std::vector<toolpath::ToolMove> moves;
};

struct LinkRules {
    double stay_down{};    // mm in plan: ends nearer than this are linked on the model
    double clearance_z{};  // mm: height of rapids
    double plunge_from{};  // mm: height from which the tool descends at the plunge feed
    bool one_way{false};   // passes keep their order and their direction
    double
        lead_in{};  // mm, radius: entries and exits are level quarter turns where these are clear
};

struct LinkedPasses {
    std::vector<toolpath::ToolMove> moves;
    int retracts{};
    double cut_length{};   // mm, of all passes
    double link_length{};  // mm, of links at feed
    int points{};          // end points of moves
};

// Links the passes in order, or without `one_way` always to the nearest end, reversing passes where
// that is nearer. O(n^2) for n passes.
LinkedPasses link_passes(std::vector<SurfacePass> passes,
                         const LinkRules& rules,
                         GougeFreePathFitter& path_fitter);

}  // namespace cusp::finishing
