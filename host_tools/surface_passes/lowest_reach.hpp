// How low a ball gets over a place that it can't touch: the best position of the tool in valleys,
// concave edges and under overhangs.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/clearing/reach_search.hpp"
#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/surface_passes/certified_pass.hpp"

namespace cusp::host {

// `ReachSearch` for passes: its drops are bounds from above, a little high; the answer's is
// exact. A search, not a proof.
class LowestReach {
public:
    // surfaces  of the model that the passes are certified on; none: it is a mesh
    // pitch     mm, of the grid
    // accuracy  mm: how high drops may be
    LowestReach(const std::vector<Surface>& surfaces,
                const CertifiedPasses& certified,
                double pitch,
                double accuracy);
    LowestReach(const LowestReach&) = delete;
    LowestReach& operator=(const LowestReach&) = delete;

    struct Answer {
        Vec3d tip;
        double height;  // mm: what this tip leaves straight above or below the place
    };
    // worth  mm: heights above this are not told apart, nor are their tips exact; a low one saves
    //        most of the time
    //
    // None where the tool can't stand over the place.
    std::optional<Answer> over(Vec3d place, double worth);

    // The same for a tool that keeps off guarded edges as passes do; none where no tip is found
    // that leaves less than `worth`.
    //
    // near  `over`'s answer, that does not
    std::optional<Answer> kept_off_edges(Vec3d place, const Answer& near, double worth);

private:
    // Of the tool that keeps off guarded edges, or does not.
    enum class Edges : std::uint8_t { kMet, kKeptOff };

    ReachSearch::Rest dropped(double x, double y, Edges edges);
    std::optional<Answer> exact_over(Vec3d place, double x, double y, Edges edges) const;
    std::optional<Answer> beside(Vec3d place, Vec3d brink, double worth, Edges edges);
    std::optional<Answer> exactly(const ReachSearch::Answer& found,
                                  Vec3d place,
                                  double worth,
                                  Edges edges);

    const std::vector<Surface>& surfaces_;
    const CertifiedPasses& certified_;
    std::optional<TipFloor> floor_;
    double accuracy_;
    double radius_;
    double contact_radius_;  // mm: of a ball that touches what the tool stays `lift` off
    ReachSearch search_;
    ReachSearch kept_off_;
};

}  // namespace cusp::host
