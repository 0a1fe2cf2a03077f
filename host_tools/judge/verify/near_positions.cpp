// A lifted position has the line of the move that is left out, so that a move keeps its end.
#include "host_tools/judge/verify/near_positions.hpp"

#include <algorithm>

namespace cusp::verify {

NearPositions near_positions(const ToolPositions& run,
                             const std::vector<std::size_t>& places,
                             double high)
{
    NearPositions out{{run.tool, {}, {}, {}}, {}};
    const auto add = [&](Vec3d tip, bool rapid, std::uint32_t line, std::size_t place) {
        out.positions.tips.push_back(tip);
        out.positions.rapid.push_back(rapid);
        out.positions.lines.push_back(line);
        out.places.push_back(place);
    };
    std::size_t before = kNoPlace;
    const auto lift = [&] {
        const std::size_t next = std::min(before + 1, run.tips.size() - 1);
        add({run.tips[before].x, run.tips[before].y, high}, true, run.lines[next], kNoPlace);
    };
    for (const std::size_t k : places) {
        if (before == kNoPlace || before + 1 != k) {
            if (before != kNoPlace) {
                lift();
            }
            if (k > 0) {
                add({run.tips[k].x, run.tips[k].y, high}, true, run.lines[k], kNoPlace);
            }
        }
        add(run.tips[k], run.rapid[k], run.lines[k], k);
        before = k;
    }
    if (before != kNoPlace && before + 1 < run.tips.size()) {
        lift();
    }
    return out;
}

}  // namespace cusp::verify
