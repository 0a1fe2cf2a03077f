// Ways of a tool that meet at their ends, such as the branches of a medial axis: which to cut next, and how to get there
// through what is cut already.
//
//     WayGraph graph{ways};
//     graph.mark_cut(0);
//     if (auto link = graph.link_to_uncut(0, true, 10.0)) { link->steps; link->way; }
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::prismatic {

// mm: ends as near as this are one place, at which the tool continues without a retract.
inline constexpr double kEndsMeet = 1e-3;

class WayGraph {
public:
    struct Way {
        Vec3d start;
        Vec3d end;
        double length;  // mm
    };
    struct Step {
        std::size_t way;
        bool backward;
    };
    struct Link {
        std::vector<Step>
            steps;        // along ways that are cut, one after the other; none: the way begins here
        std::size_t way;  // that is not cut
        bool backward;
        double length;  // mm, of the steps
    };

    // Ends within kEndsMeet of each other are one.
    explicit WayGraph(std::vector<Way> ways);

    void mark_cut(std::size_t way) { cut_[way] = true; }
    bool is_cut(std::size_t way) const { return cut_[way]; }

    // The nearest way that is not cut, along ways that are; none within `limit` mm. If several
    // begin at one place, those that end in nothing come first, the shortest of them first, so that
    // the tool need not come back.
    //
    // way, at_end  where the tool is: at an end of a way that is cut
    std::optional<Link> link_to_uncut(std::size_t way, bool at_end, double limit) const;

private:
    std::optional<Step> best_at(std::size_t node) const;

    std::vector<Way> ways_;
    std::vector<std::array<std::size_t, 2>> nodes_of_;
    std::vector<std::vector<std::size_t>> at_node_;
    std::vector<bool> cut_;
};

}  // namespace cusp::prismatic
