// Stock as straight cuts leave it, without a grid: what stands under a tool's way, however thin.
//
//     CutStock stock{job, box, ways};           // all ways that it will be looked at
//     stock.cut(tool, from, to);                  // straight cuts, in order
//     if (const auto found = stock.under(ways[0], stock.cuts())) { found->depth; }
//
// Squares under the tool that lie in one cut as a whole are done with; the others are parted, down to 0.002 mm.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/part_heights.hpp"
#include "host_tools/judge/verify/tool_way.hpp"
#include "host_tools/judge/verify/wall_distance.hpp"

namespace cusp::verify {

// mm: rapid moves may cut as deep as slivers and rounding.
inline constexpr double kRapidCutAllowed = 0.005;

struct StandingPlace {
    double depth;  // mm along the tool's axis
    Vec3d tip;     // of the tool there
};

class CutStock {
public:
    // mm: walls up to this thickness are slivers.
    static constexpr double kSliver = 0.015;

    // mm: looked at is a tool of a radius that is smaller by this.
    static constexpr double kReduced = 0.01;

    // The way of a tool that is looked at; the tool lives longer.
    static ToolWay way_of(const toolpath::Tool& tool, Vec3d from, Vec3d to);

    // job    lives longer
    // stock  its box in plan
    // ways   that will be looked at
    CutStock(const job::Job& job, const PartBox& stock, const std::vector<ToolWay>& ways);

    // A straight way of a tool that lives longer.
    void cut(const toolpath::Tool& tool, Vec3d from, Vec3d to);

    // How many cuts were made: a mark for under().
    std::size_t cuts() const { return sweeps_.size(); }

    // The deepest that a tool meets on its way in what the first `cuts` cuts left. None: nothing is deeper than
    // kRapidCutAllowed.
    std::optional<StandingPlace> under(const ToolWay& way, std::size_t cuts) const;

private:
    using Sweeps = std::vector<std::uint32_t>;
    struct Square {
        Vec2d middle;
        double half;
    };
    struct Search;

    template <typename Visit>
    void visit_cells(const ToolWay& way, Visit visit) const;
    Sweeps near(const ToolWay& way, std::size_t cuts) const;
    double height_at(Vec2d place, const Sweeps& sweeps, double wider) const;
    double inside(Vec2d place) const;
    void look(const Square& square, const Sweeps& sweeps, Search& search) const;

    const job::Job& job_;
    Vec2d low_;  // of the stock
    Vec2d high_;
    std::vector<WallDistance> edges_;  // of its outline
    double pitch_{2.0};                // mm
    Vec2d corner_{};
    std::size_t nx_{0};
    std::size_t ny_{0};
    std::vector<char> looked_at_;  // cells
    std::vector<Sweeps> cells_;
    std::vector<ToolWay> sweeps_;
};

}  // namespace cusp::verify
