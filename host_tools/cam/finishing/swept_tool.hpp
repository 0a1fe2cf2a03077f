// The stock that straight moves of any end remove: the moves near a place, and whether one of them removes a point.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host_tools/geometry/part_model/facet_drop.hpp"
#include "host_tools/geometry/part_model/grid_square.hpp"

namespace cusp::finishing {

// A window beside a place: there the end of a tool's core removes the stock over places of one normal without
// cutting into them.
struct ToolWindow {
    Vec3d off;      // mm: from the place to the end of the core that touches it
    Vec3d middle;   // mm: from the place to the middle of the window
    double around;  // mm, in plan
    double low;     // mm: z over the place; -kInfinite where a flank removes it too
    double high;    // mm: z over the place
};

// Queries change nothing: several threads may ask at once while none adds.
class SweptTool {
public:
    // height  mm: of the stock that may stay
    SweptTool(const toolpath::Tool& tool, double height);

    const part_model::ToolProfile& profile() const { return profile_; }

    // Adds straight moves through tips of the tool.
    void add(const std::vector<Vec3d>& tips);
    std::size_t moves() const { return moves_.size(); }

    // offset  mm: of the tips from the surface
    ToolWindow window(Vec3d normal, double offset) const;

    // Calls visit(number) for the moves through the window of a place, some repeatedly, until it returns
    // true. Returns whether it did.
    template <class Visit>
    bool any_through(const ToolWindow& window, Vec3d place, const Visit& visit) const
    {
        const Vec3d middle = place + window.middle;
        const std::int64_t i_end = cell(middle.x + window.around);
        const std::int64_t j_end = cell(middle.y + window.around);
        for (std::int64_t i = cell(middle.x - window.around); i <= i_end; ++i) {
            for (std::int64_t j = cell(middle.y - window.around); j <= j_end; ++j) {
                const auto found = squares_.find(part_model::square_key(i, j));
                if (found == squares_.end()) {
                    continue;
                }
                for (const std::uint32_t number : found->second) {
                    const Move& move = moves_[number];
                    if (std::max(move.from.z, move.to.z) >= place.z + window.low &&
                        std::min(move.from.z, move.to.z) <= place.z + window.high &&
                        visit(number)) {
                        return true;
                    }
                }
            }
        }
        return false;
    }

    // True if the move removes the point, with a tool smaller by `shrink` (mm) all round.
    bool removes(std::uint32_t move, Vec3d point, double shrink) const;

    // mm: the distance of a point from what the moves remove.
    //
    // most    mm: greater distances are returned as this
    // enough  mm: less may be returned as something up to this
    double distance(Vec3d point, double most, double enough = 0) const;

private:
    struct Move {
        Vec3d from;  // end of the core
        Vec3d to;
    };
    using Key = std::uint64_t;
    std::int64_t cell(double at) const;
    // mm from the core along the move to a point; exact between `enough` and `far`.
    static double point_apart(const Move& move, Vec3d point);
    static double core_apart(
        const Move& move, const part_model::ToolCore& core, Vec3d point, double enough, double far);

    part_model::ToolProfile profile_;
    double height_;
    double pitch_;
    std::vector<Move> moves_;
    std::unordered_map<Key, std::vector<std::uint32_t>> squares_;
};

}  // namespace cusp::finishing
