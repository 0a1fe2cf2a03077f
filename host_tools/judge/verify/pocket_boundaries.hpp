// Walls and islands of several pockets: a place is inside if it is inside one of the pockets.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/judge/verify/wall_distance.hpp"

namespace cusp::verify {

class PocketBoundaries {
public:
    // Islands of the same boundary belong together, whatever operation has them. An island without a
    // boundary is in every pocket.
    //
    // boundary  its name, empty for an island without one
    // wall      the boundary itself, or an island in it
    void add(const std::string& boundary, WallDistance wall)
    {
        if (boundary.empty()) {
            everywhere_.push_back(std::move(wall));
            return;
        }
        const auto found =
            std::find_if(pockets_.begin(), pockets_.end(),
                         [&](const Pocket& pocket) { return pocket.boundary == boundary; });
        Pocket& pocket =
            found == pockets_.end() ? pockets_.emplace_back(Pocket{boundary, {}}) : *found;
        pocket.walls.push_back(std::move(wall));
    }

    bool empty() const { return pockets_.empty() && everywhere_.empty(); }

    // mm from the nearest wall of the pocket that the place is deepest in, negative beyond the
    // walls of all. If pockets overlap it is at most the distance to the edge of their union.
    // Infinite without walls.
    double at(double x, double y) const
    {
        double inside = pockets_.empty() ? kInfinite : -kInfinite;
        for (const Pocket& pocket : pockets_) {
            inside = std::max(inside, least(pocket.walls, x, y));
        }
        return std::min(inside, least(everywhere_, x, y));
    }

private:
    struct Pocket {
        std::string boundary;
        std::vector<WallDistance> walls;
    };
    static double least(const std::vector<WallDistance>& walls, double x, double y)
    {
        double nearest = kInfinite;
        for (const WallDistance& wall : walls) {
            nearest = std::min(nearest, wall.at(x, y));
        }
        return nearest;
    }

    std::vector<Pocket> pockets_;
    std::vector<WallDistance> everywhere_;
};

}  // namespace cusp::verify
