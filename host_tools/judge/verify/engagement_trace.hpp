// The engagement along a run of one tool, looked up in the stock while it is cut.
//
//     EngagementTrace trace{grid, positions};
//     stock.cut(positions, spacing, progress, &trace);
//     const EngagementRun run = trace.finish();
//     run.angles[k];  // degrees of the circumference in stock on the way to position k
//
// On the way from a position to the next, places on the front half of the circle one pitch outside
// the tool are looked up in the stock that the first one leaves. A wall crosses that circle a
// little farther round than the tool's own; finish() takes this off as for a straight cut. Then it
// takes the mean over the way of 1.5 pitches before and after.
//
// The circumference is that of the whole radius: a ball or a cone that cuts less deep than its
// round or sloping part has no engagement.
//
// Accuracy, with a grid of shifted rows: in a straight cut the width R (1 - cos angle) is within
// 0.7 pitches of the true one. At 60 degrees that is 2.7 degrees with the default grid and R 3 mm,
// 0.8 with R 10 mm. The mean of a long cut is within 0.3 degrees. A change of the load is spread
// over three pitches; two walls at once read too much, a few degrees each. Random paths that cross
// each other: the mean is off by up to 1.7 degrees, the way over a limit by 3.5 % of all.
//
// In a hole of its own size the tool has no way at the side with less than half a turn in stock: what
// it does after an entry at most a twentieth of its radius from the foot is part of the entry.
//
// Air is the way on which no point of the grid is cut by over 0.003 mm: between two cuts if it is
// longer than three pitches. Thus cuts that are narrower than a third of a pitch may be air.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/judge/verify/bands.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

// The kind of the step that leads to a position.
enum class StepKind : std::uint8_t {
    kRapid,
    kAir,    // a feed move that removes nothing
    kEntry,  // it descends by over 2 % of its length: helix, ramp or plunge; or runs about its foot
    kCut,
};

// For each position of a run.
struct EngagementRun {
    std::vector<StepKind> kinds;
    std::vector<float> angles;       // degrees, 0 to 180; 0 but for kCut
    double counts_over{kUnbounded};  // degrees: more is over the limit
};

class EngagementTrace {
public:
    // Both have to outlive the trace.
    EngagementTrace(const HeightGrid& grid, const ToolPositions& positions);

    // Before position k cuts the heights of the columns [begin, end), which are those of `band`.
    void look(const std::vector<double>& heights,
              std::size_t k,
              std::size_t band,
              std::size_t begin,
              std::size_t end);

    // Position k has removed stock in the columns of `band`.
    void add_cut(std::size_t k, std::size_t band) { seen_[band][k].cuts = true; }

    EngagementRun finish() const;

private:
    struct Seen {
        std::uint8_t in_stock{};  // of the looked up places, those in this band
        bool cuts{};
    };

    double way(std::size_t k) const;
    bool descends(std::size_t k) const;
    bool enters(std::size_t k) const { return enters_[k]; }
    void find_entries();
    bool cuts(std::size_t k) const;
    double angle_seen(std::size_t k) const;  // radians
    std::vector<StepKind> kinds() const;

    const HeightGrid& grid_;
    const ToolPositions& positions_;
    std::vector<double> shifts_;  // mm, of rows and columns
    std::vector<bool> enters_;
    std::array<std::vector<Seen>, kBands> seen_;
};

}  // namespace cusp::verify
