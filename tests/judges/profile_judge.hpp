// Judges what moves of any end cut and leave, by brute force: the profile of the tool alone against all moves,
// and dense samples of a part.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/support/box_mesh.hpp"

namespace cusp::test {

constexpr double kFar = 1e9;
constexpr double kChordOfArcs = 1e-4;
constexpr int kThirds = 60;            // of a search along a move
constexpr double kSamplePitch = 0.05;  // mm: of the part

// The moves of a path that are no rapids.
class MovesOfEnd {
public:
    explicit MovesOfEnd(const toolpath::Toolpath& path) : tool_{path.tool}
    {
        Vec3d at = end_of(path.moves.front());
        for (const toolpath::ToolMove& move : path.moves) {
            for (const Vec3d& to : points_of(move, at, kChordOfArcs)) {
                if (move.kind != toolpath::MoveKind::kRapid) {
                    moves_.emplace_back(at, to);
                }
                at = to;
            }
        }
    }

    // z of the lowest cut straight over or under a place; kFar where no move comes.
    double lowest(Vec3d place) const
    {
        double least = kFar;
        for (const auto& [a, b] : moves_) {
            const double r = tool_.radius;
            if (std::min(a.x, b.x) - r <= place.x && place.x <= std::max(a.x, b.x) + r &&
                std::min(a.y, b.y) - r <= place.y && place.y <= std::max(a.y, b.y) + r &&
                std::min(a.z, b.z) < least) {
                least = std::min(least, lowest_of(a, b, place));
            }
        }
        return least;
    }

    bool removes(Vec3d point) const { return lowest(point) <= point.z; }

private:
    // The height of the end over the place is convex along the move.
    double lowest_of(Vec3d a, Vec3d b, Vec3d place) const
    {
        const double dx = b.x - a.x;
        const double dy = b.y - a.y;
        const double square = dx * dx + dy * dy;
        double low = 0;
        double high = 1;
        const double x = a.x - place.x;
        const double y = a.y - place.y;
        if (square > 0) {
            const double foot = -(x * dx + y * dy) / square;
            const double beside = x * x + y * y - foot * foot * square;
            const double way = tool_.radius * tool_.radius - beside;
            if (way < 0) {
                return kFar;
            }
            low = std::max(0.0, foot - std::sqrt(way / square));
            high = std::min(1.0, foot + std::sqrt(way / square));
        } else if (x * x + y * y > tool_.radius * tool_.radius) {
            return kFar;
        }
        if (low > high) {
            return kFar;
        }
        const auto height = [&](double t) {
            const double away = std::hypot(x + t * dx, y + t * dy);
            return a.z + t * (b.z - a.z) +
                   toolpath::profile_height(tool_, std::min(away, tool_.radius));
        };
        double least = std::min(height(low), height(high));
        for (int k = 0; k < kThirds && high - low > 1e-9; ++k) {
            const double one = low + (high - low) / 3;
            const double two = high - (high - low) / 3;
            const double first = height(one);
            const double second = height(two);
            least = std::min({least, first, second});
            (first < second ? high : low) = first < second ? two : one;
        }
        return least;
    }

    toolpath::Tool tool_;
    std::vector<std::pair<Vec3d, Vec3d>> moves_;
};

// True if a move removes some point so far from a place.
inline bool is_cut_within(const MovesOfEnd& moves, Vec3d place, double away)
{
    constexpr int kTurns = 12;
    for (int j = 0; j <= 6; ++j) {
        const double rise = kPi / 2 * j / 6;
        for (int k = 0; k < kTurns; ++k) {
            const double turn = 2 * kPi * k / kTurns;
            const Vec3d way{std::cos(turn) * std::cos(rise), std::sin(turn) * std::cos(rise),
                            std::sin(rise)};
            if (moves.removes(place + way * away)) {
                return true;
            }
        }
    }
    return false;
}

// The samples of a part by squares in plan.
class SampledPart {
public:
    explicit SampledPart(const Triangles& mesh)
    {
        for (const auto& t : mesh) {
            const double longest =
                std::max({norm(t[1] - t[0]), norm(t[2] - t[1]), norm(t[0] - t[2])});
            const int parts = 1 + static_cast<int>(longest / kSamplePitch);
            for (int i = 0; i <= parts; ++i) {
                for (int j = 0; i + j <= parts; ++j) {
                    const Vec3d p = t[0] + (t[1] - t[0]) * (1.0 * i / parts) +
                                    (t[2] - t[0]) * (1.0 * j / parts);
                    squares_[{cell(p.x), cell(p.y)}].push_back(p);
                }
            }
        }
    }

    // True if no sample is in the tool.
    bool is_clear(const toolpath::Tool& tool, Vec3d tip) const
    {
        for (int i = cell(tip.x - tool.radius); i <= cell(tip.x + tool.radius); ++i) {
            for (int j = cell(tip.y - tool.radius); j <= cell(tip.y + tool.radius); ++j) {
                const auto found = squares_.find({i, j});
                if (found == squares_.end()) {
                    continue;
                }
                for (const Vec3d& p : found->second) {
                    const double away = std::hypot(p.x - tip.x, p.y - tip.y);
                    if (away < tool.radius &&
                        p.z > tip.z + toolpath::profile_height(tool, away) + kRoundedTouch) {
                        return false;
                    }
                }
            }
        }
        return true;
    }

    // z of the tip of the tool dropped there; -kFar where it meets no sample.
    double drop(const toolpath::Tool& tool, double x, double y) const
    {
        double tip = -kFar;
        for (int i = cell(x - tool.radius); i <= cell(x + tool.radius); ++i) {
            for (int j = cell(y - tool.radius); j <= cell(y + tool.radius); ++j) {
                const auto found = squares_.find({i, j});
                if (found == squares_.end()) {
                    continue;
                }
                for (const Vec3d& p : found->second) {
                    const double away = std::hypot(p.x - x, p.y - y);
                    if (away < tool.radius && p.z > tip) {
                        tip = std::max(tip, p.z - toolpath::profile_height(tool, away));
                    }
                }
            }
        }
        return tip;
    }

    template <class Visit>
    void visit(const Visit& visit) const
    {
        for (const auto& [square, samples] : squares_) {
            for (const Vec3d& p : samples) {
                visit(p);
            }
        }
    }

private:
    static constexpr double kRoundedTouch = 1e-7;  // mm
    static int cell(double at) { return static_cast<int>(std::floor(at / 0.2)); }

    std::map<std::pair<int, int>, std::vector<Vec3d>> squares_;
};

// The tool that is thicker by `more` all round, and its tip that touches ground of this normal.
inline toolpath::Tool thicker(toolpath::Tool tool, double more)
{
    tool.radius += more;
    tool.corner_radius += more;
    return tool;
}

inline Vec3d touching_tip(const toolpath::Tool& tool, Vec3d place, Vec3d normal)
{
    const double level = std::hypot(normal.x, normal.y);
    const double flat =
        tool.shape == toolpath::ToolShape::kTaper ? 0.0 : tool.radius - tool.corner_radius;
    const Vec3d out = level > 1e-9 ? Vec3d{normal.x, normal.y, 0} * (flat / level) : Vec3d{};
    return place + normal * tool.corner_radius + out - Vec3d{0, 0, tool.corner_radius};
}

}  // namespace cusp::test
