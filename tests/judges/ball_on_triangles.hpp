// Reach of a ball over triangles, and stock left by its moves, by brute force: closed forms over
// every triangle and every near move, without trees and proofs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/support/box_mesh.hpp"

namespace cusp::test {

constexpr double kNothing = std::numeric_limits<double>::infinity();

// A segment seen from a vertical axis: z(s) = z0 + slope * s over the plan distance s from the foot
// of the axis on its line, s in [low, high]; `beside` is the distance of the axis from the line.
struct SegmentFromAxis {
    SegmentFromAxis(Vec3d a, Vec3d b, double x, double y)
    {
        const double dx = b.x - a.x;
        const double dy = b.y - a.y;
        const double length = std::hypot(dx, dy);
        if (length < 1e-12) {
            beside = std::hypot(x - a.x, y - a.y);
            low = high = 0;
            z0 = std::max(a.z, b.z);
            bottom = std::min(a.z, b.z);
            return;
        }
        const double foot = ((x - a.x) * dx + (y - a.y) * dy) / length;
        beside = std::abs((x - a.x) * dy - (y - a.y) * dx) / length;
        low = -foot;
        high = length - foot;
        slope = (b.z - a.z) / length;
        z0 = a.z + slope * foot;
        bottom = kNothing;
    }
    double z(double s) const { return z0 + slope * s; }

    double beside{};
    double low{};
    double high{};
    double slope{};
    double z0{};
    double bottom{};  // of a vertical segment
};

// The centre of a ball that rests on the segment; -inf where it misses it.
inline double ball_on_segment(Vec3d a, Vec3d b, double x, double y, double radius)
{
    const SegmentFromAxis seen{a, b, x, y};
    const double square = radius * radius - seen.beside * seen.beside;
    if (square < 0) {
        return -kNothing;
    }
    const double reach = std::sqrt(square);
    const double low = std::max(seen.low, -reach);
    const double high = std::min(seen.high, reach);
    if (low > high) {
        return -kNothing;
    }
    const double best = seen.slope * reach / std::sqrt(1 + seen.slope * seen.slope);
    const double s = std::clamp(best, low, high);
    return seen.z(s) + std::sqrt(std::max(0.0, square - s * s));
}

// z over (x, y) that a ball leaves on its way from a to b (its centres); +inf where it misses.
inline double left_by_move(Vec3d a, Vec3d b, double x, double y, double radius)
{
    const Vec3d down_a{a.x, a.y, -a.z};
    const Vec3d down_b{b.x, b.y, -b.z};
    return -ball_on_segment(down_a, down_b, x, y, radius);
}

class BallOnTriangles {
public:
    explicit BallOnTriangles(const Triangles& triangles)
    {
        for (const auto& t : triangles) {
            const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
            const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
            parts_.push_back({t, normal(t), x0, x1, y0, y1, std::max({t[0].z, t[1].z, t[2].z})});
        }
    }

    // The lowest centre of a ball at (x, y) that cuts no triangle; -inf beside them all.
    double drop(double x, double y, double radius) const
    {
        double best = -kNothing;
        for (const Part& part : parts_) {
            if (part.misses(x, y, radius) || part.z1 + radius <= best) {
                continue;
            }
            const std::array<Vec3d, 3>& t = part.corners;
            best = std::max(best, on_plane(part, x, y, radius));
            for (std::size_t k = 0; k < 3; ++k) {
                best = std::max(best, ball_on_segment(t[k], t[(k + 1) % 3], x, y, radius));
            }
        }
        return best;
    }

    // The highest triangle over (x, y).
    double top(double x, double y) const
    {
        double best = -kNothing;
        for (const Part& part : parts_) {
            best = part.misses(x, y, 0) ? best : std::max(best, on_plane(part, x, y, 0));
        }
        return best;
    }

    static Vec3d normal(const std::array<Vec3d, 3>& t)
    {
        const Vec3d across = cross(t[1] - t[0], t[2] - t[0]);
        return across / (across.z < 0 ? -norm(across) : norm(across));
    }

private:
    struct Part {
        std::array<Vec3d, 3> corners;
        Vec3d normal;
        double x0, x1, y0, y1, z1;  // the box
        bool misses(double x, double y, double by) const
        {
            return x < x0 - by || x > x1 + by || y < y0 - by || y > y1 + by;
        }
    };

    static double on_plane(const Part& part, double x, double y, double radius)
    {
        const std::array<Vec3d, 3>& t = part.corners;
        const Vec3d n = part.normal;
        if (!(n.z > 1e-9)) {
            return -kNothing;
        }
        const double px = x - radius * n.x;
        const double py = y - radius * n.y;
        const auto side = [&](Vec3d a, Vec3d b) {
            return (b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x);
        };
        const double s0 = side(t[0], t[1]);
        const double s1 = side(t[1], t[2]);
        const double s2 = side(t[2], t[0]);
        const bool inside = (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
        const double z = t[0].z - (n.x * (px - t[0].x) + n.y * (py - t[0].y)) / n.z;
        return inside ? z + radius * n.z : -kNothing;
    }

    std::vector<Part> parts_;
};

// The feed moves of a program with a ball, as straight moves of its centre.
class CutMoves {
public:
    CutMoves(const toolpath::Toolpath& path, double chord) : radius_{path.tool.radius}
    {
        const Vec3d up{0, 0, radius_};
        Vec3d at = toolpath::end_of(path.moves.front());
        for (const toolpath::ToolMove& move : path.moves) {
            for (const Vec3d& to : toolpath::points_of(move, at, chord)) {
                if (move.kind != toolpath::MoveKind::kRapid) {
                    moves_.push_back({at + up, to + up});
                }
                at = to;
            }
        }
        sort_into_squares();
    }

    static constexpr double kDeepest = 0.5;

    const std::vector<std::array<Vec3d, 2>>& moves() const { return moves_; }

    // The top of the stock at (x, y); +inf where nothing is cut.
    double top(double x, double y) const
    {
        double best = kNothing;
        for (const int k : near(x, y)) {
            const auto& [a, b] = moves_[static_cast<std::size_t>(k)];
            best = std::min(best, left_by_move(a, b, x, y, radius_));
        }
        return best;
    }

    // mm from a place to the nearest one that some move, shank included, has cut away; kDeepest at
    // most.
    double depth(Vec3d place) const
    {
        double least = kDeepest;
        for (const int k : near(place.x, place.y)) {
            const auto& [a, b] = moves_[static_cast<std::size_t>(k)];
            least = std::min(least, distance_to_move(a, b, place) - radius_);
        }
        return std::max(0.0, least);
    }

private:
    // From a place to the strip straight above a segment.
    static double distance_to_move(Vec3d a, Vec3d b, Vec3d p)
    {
        const Vec3d d = b - a;
        const double level = d.x * d.x + d.y * d.y;
        const Vec3d off = p - a;
        const double t = level > 0 ? std::clamp((off.x * d.x + off.y * d.y) / level, 0.0, 1.0)
                                   : (d.z < 0 ? 1.0 : 0.0);
        if (p.z >= a.z + d.z * t) {
            return std::hypot(off.x - d.x * t, off.y - d.y * t);
        }
        const double square = dot(d, d);
        const double s = square > 0 ? std::clamp(dot(off, d) / square, 0.0, 1.0) : 0;
        return norm(off - d * s);
    }

    void sort_into_squares()
    {
        double x1 = -kNothing;
        double y1 = -kNothing;
        x0_ = y0_ = kNothing;
        for (const auto& move : moves_) {
            for (const Vec3d& p : move) {
                x0_ = std::min(x0_, p.x - 2 * radius_);
                y0_ = std::min(y0_, p.y - 2 * radius_);
                x1 = std::max(x1, p.x + 2 * radius_);
                y1 = std::max(y1, p.y + 2 * radius_);
            }
        }
        nx_ = 1 + static_cast<int>((x1 - x0_) / kSide);
        ny_ = 1 + static_cast<int>((y1 - y0_) / kSide);
        squares_.resize(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_));
        for (std::size_t k = 0; k < moves_.size(); ++k) {
            const auto& [a, b] = moves_[k];
            const double reach = radius_ + kDeepest;
            for (int i = row(std::min(a.x, b.x) - reach, x0_, nx_);
                 i <= row(std::max(a.x, b.x) + reach, x0_, nx_); ++i) {
                for (int j = row(std::min(a.y, b.y) - reach, y0_, ny_);
                     j <= row(std::max(a.y, b.y) + reach, y0_, ny_); ++j) {
                    squares_[static_cast<std::size_t>(i * ny_ + j)].push_back(static_cast<int>(k));
                }
            }
        }
    }
    const std::vector<int>& near(double x, double y) const
    {
        return squares_[static_cast<std::size_t>(row(x, x0_, nx_) * ny_ + row(y, y0_, ny_))];
    }
    static int row(double at, double first, int count)
    {
        return std::clamp(static_cast<int>((at - first) / kSide), 0, count - 1);
    }

    static constexpr double kSide = 0.5;  // mm
    double radius_;
    std::vector<std::array<Vec3d, 2>> moves_;
    std::vector<std::vector<int>> squares_;
    double x0_{};
    double y0_{};
    int nx_{};
    int ny_{};
};

}  // namespace cusp::test
