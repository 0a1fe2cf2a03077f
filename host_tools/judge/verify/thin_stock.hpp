// Stock that cuts have left standing under a tool, however thin: walls that pass between the points of a grid.
//
//     ThinStock stock{job, places};              // boxes in which it will be looked for
//     stock.cut(tool, from, to);                 // straight cuts, in order
//     if (const auto found = stock.under(tool, from, to)) { found->depth; }
//
// Squares under the tool that lie in one cut as a whole are done with; the others are parted, down to 0.002 mm.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/wall_distance.hpp"

namespace cusp::verify {

struct StandingPlace {
    double depth;  // mm along the tool's axis
    Vec3d tip;     // of the tool there
};

// Not for use by two threads at once, const members included.
class ThinStock {
public:
    // mm: walls up to this thickness are slivers.
    static constexpr double kSliver = 0.015;
    // mm: lower stock is left to grids.
    static constexpr double kLeastDepth = 0.05;

    struct Place {
        Vec2d low;
        Vec2d high;
    };

    // stock   its box
    // places  boxes of the tools that will be looked at
    ThinStock(const job::Job& job, Place stock, const std::vector<Place>& places);

    // A slope counts by what its higher end cuts along it, and by both ends.
    void cut(const toolpath::Tool& tool, Vec3d from, Vec3d to);

    // The deepest that a tool meets that goes level from `from` to `to`, or stands there.
    std::optional<StandingPlace> under(const toolpath::Tool& tool, Vec3d from, Vec3d to) const;

private:
    struct Sweep {
        const toolpath::Tool* tool;
        Vec2d from;
        Vec2d to;
        double z;
    };
    using Sweeps = std::vector<std::uint32_t>;
    struct Square {
        Vec2d middle;
        double half;
    };
    struct Search;

    template <typename Visit>
    void visit_cells(Vec2d low, Vec2d high, Visit visit) const;
    void add(const Sweep& sweep);
    Sweeps near(Vec2d low, Vec2d high) const;
    double height_at(Vec2d place, const Sweeps& sweeps) const;
    double inside(Vec2d place) const;
    void look(const Square& square, const Sweeps& sweeps, Search& search) const;

    const job::Job& job_;
    Place stock_;
    std::vector<WallDistance> edges_;  // of its outline
    double pitch_{2.0};                // mm
    Vec2d corner_{};
    std::size_t nx_{0};
    std::size_t ny_{0};
    std::vector<char> looked_at_;  // cells
    std::vector<Sweeps> cells_;
    std::vector<Sweep> sweeps_;
    // Scratch of near(): sweeps already visited.
    mutable std::vector<std::uint32_t> last_query_;
    mutable std::uint32_t query_{0};
};

}  // namespace cusp::verify
