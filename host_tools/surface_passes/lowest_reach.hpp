// How low a ball gets over a place that it can't touch: the best position of the tool in valleys,
// concave edges and under overhangs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/surface_passes/certified_pass.hpp"

namespace cusp::host {

// Drops of the tool on a grid, made where first asked for, say where to begin. From there the
// position is improved over all contacts found so far, which are the floor that the ball stands on,
// dropped, and so on until drop and contacts agree. These drops are bounds from above, micrometres
// high; the answer's is exact.
//
// A search, not a proof: a better position may hide between the places of the grid.
class LowestReach {
public:
    // surfaces  of the model that the passes are certified on; none: it is a mesh
    // pitch     mm, of the grid
    LowestReach(const std::vector<Surface>& surfaces,
                const CertifiedPasses& certified,
                double pitch);

    struct Answer {
        Vec3d tip;
        double height;  // mm: what this tip leaves straight above or below the place
    };
    // worth  mm: heights above this are not told apart, nor are their tips exact; a low one saves
    //        most of the time
    //
    // None where the tool can't stand over the place.
    std::optional<Answer> over(Vec3d place, double worth);

    // The same for a tool that keeps off guarded edges as passes do, starting from `over`'s answer
    // that does not; none where no tip is found that leaves less than `worth`.
    std::optional<Answer> kept_off_edges(Vec3d place, const Answer& from, double worth);

private:
    struct Node {
        Vec3d centre;  // of the ball; z is infinite where the tool misses the model
        Vec3d contact;
    };
    struct Start {
        double height;
        Vec3d centre;
    };

    const Node& node(std::int64_t i, std::int64_t j);
    Node dropped(double x, double y);
    std::vector<Start> starts_over(Vec3d place);
    double height_over(Vec3d place, double x, double y) const;
    std::array<double, 2> improved(Vec3d place, double x, double y);
    std::optional<Answer> raised_over(Vec3d place, double x, double y, bool exact);
    void improve_raised(Vec3d place, Answer& best);

    const std::vector<Surface>& surfaces_;
    const CertifiedPasses& certified_;
    std::optional<TipFloor> floor_;
    double radius_;
    double contact_radius_;  // mm: of a ball that touches what the tool stays `lift` off
    double pitch_;
    std::unordered_map<std::uint64_t, Node> nodes_;
    Points contacts_;  // near the place asked for
};

}  // namespace cusp::host
