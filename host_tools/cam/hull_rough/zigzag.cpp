// Chains grow line by line: each is extended by at most one interval of the next line, the first
// that it can reach.
#include "host_tools/cam/hull_rough/zigzag.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace cusp::hull_rough {
namespace {

struct OpenChain {
    Chain points;
    bool towards_plus;  // the last interval was cut towards +x
};

// The points that lead from the chain's end to `start` inside the zone: directly, or along either
// line first. None where no such path is clear.
std::optional<Chain> way(const ClearZone& zone, Vec2d end, Vec2d start)
{
    if (zone.clear(end, start)) {
        return Chain{start};
    }
    for (const Vec2d bend : {Vec2d{start.x, end.y}, Vec2d{end.x, start.y}}) {
        if (zone.clear(end, bend) && zone.clear(bend, start)) {
            return Chain{bend, start};
        }
    }
    return std::nullopt;
}

class ChainBuilder {
public:
    explicit ChainBuilder(const ClearZone& zone) : zone_{zone} {}

    // Adds the intervals of one line.
    void add_line(double y)
    {
        std::vector<Interval> stretches = zone_.on_line(y);
        std::vector<OpenChain> next;
        for (OpenChain& chain : open_) {
            const auto taken = std::find_if(stretches.begin(), stretches.end(),
                                            [&](Interval s) { return try_extend(chain, s, y); });
            if (taken == stretches.end()) {
                done_.push_back(std::move(chain.points));
            } else {
                stretches.erase(taken);
                next.push_back(std::move(chain));
            }
        }
        for (const Interval& s : stretches) {
            next.push_back({{{s.begin, y}, {s.end, y}}, true});
        }
        open_ = std::move(next);
    }

    std::vector<Chain> take()
    {
        for (OpenChain& chain : open_) {
            done_.push_back(std::move(chain.points));
        }
        open_.clear();
        return std::move(done_);
    }

private:
    const ClearZone& zone_;
    std::vector<OpenChain> open_;
    std::vector<Chain> done_;

    bool try_extend(OpenChain& chain, Interval s, double y) const
    {
        const bool plus = !chain.towards_plus;
        const Vec2d start{plus ? s.begin : s.end, y};
        const auto steps = way(zone_, chain.points.back(), start);
        if (!steps) {
            return false;
        }
        chain.points.insert(chain.points.end(), steps->begin(), steps->end());
        chain.points.push_back({plus ? s.end : s.begin, y});
        chain.towards_plus = plus;
        return true;
    }
};

}  // namespace

ZigzagLayout zigzag_layout(double y_min, double y_max, double step)
{
    const int lines = std::max(1, static_cast<int>(std::ceil((y_max - y_min) / step - 1e-9)));
    const double spacing = (y_max - y_min) / lines;
    return {y_min + spacing / 2, spacing, lines, false};
}

std::vector<Chain> zigzag_chains(const ClearZone& zone, const ZigzagLayout& layout)
{
    if (layout.one_way) {
        std::vector<Chain> out;
        for (int i = 0; i < layout.lines; ++i) {
            const double y = layout.first_line + i * layout.spacing;
            for (const Interval& s : zone.on_line(y)) {
                out.push_back({{s.begin, y}, {s.end, y}});
            }
        }
        return out;
    }
    ChainBuilder builder{zone};
    for (int i = 0; i < layout.lines; ++i) {
        builder.add_line(layout.first_line + i * layout.spacing);
    }
    return builder.take();
}

}  // namespace cusp::hull_rough
