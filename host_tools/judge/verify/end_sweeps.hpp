// Lowest height that the end of a moving tool cuts over a point: profiles by the distance from the
// axis, and the sweeps of a flat bottom and of a cone along a straight way.
#pragma once

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::verify {

// The tool's lower side above its tip, by the squared distance from the axis.
struct Profile {
    double flat;    // radius of the flat bottom
    double corner;  // radius of the corner
    double reach;   // squared radius of the whole tool
    double rise;    // of a cone, mm a mm outward; 0: none
    double join;    // mm: from the flat to where the corner ends
    double joined;  // mm: the height there

    explicit Profile(const toolpath::Tool& tool, double shrink)
        : flat{},
          corner{std::max(0.0, tool.corner_radius - shrink)},
          reach{},
          rise{},
          join{corner},
          joined{corner}
    {
        const double radius = std::max(0.0, tool.radius - shrink);
        flat = std::max(0.0, radius - corner);
        reach = radius * radius;
        if (is_conical(tool)) {
            flat = std::max(0.0, tool.tip_radius - shrink);
            rise = 1 / elementary::tan(tool.tip_angle / 2);
            join = corner * elementary::cos(tool.tip_angle / 2);
            joined = corner * (1 - elementary::sin(tool.tip_angle / 2));
        }
    }
    double at(double squared) const
    {
        const double beyond = std::max(0.0, std::sqrt(squared) - flat);
        const double round = corner - std::sqrt(std::max(0.0, corner * corner - beyond * beyond));
        return beyond <= join ? round : joined + rise * (beyond - join);
    }
    // A lower bound of at(squared) is steepness() * squared: a ball lies above its parabola.
    double steepness() const
    {
        return flat > 0 || corner <= 0 || rise > 0 ? 0.0 : 1 / (2 * corner);
    }
};

// Half of the chord that a line cuts from a circle at a distance from its middle; 0 outside.
inline double half_chord(double squared_radius, double distance)
{
    return std::sqrt(std::max(0.0, squared_radius - distance * distance));
}

// The flat bottom of a tool moving from one position to the next: on a slope its rim cuts lower
// between the positions too.
class FlatSweep {
public:
    FlatSweep(Vec3d from, Vec3d to, double radius) : from_{from}, square_{radius * radius}
    {
        const double x = to.x - from.x;
        const double y = to.y - from.y;
        length_ = std::sqrt(x * x + y * y);
        constexpr double kShortest = 1e-9;
        if (length_ < kShortest) {
            length_ = 0.0;
            from_.z = std::min(from.z, to.z);
            return;
        }
        way_ = {x / length_, y / length_};
        slope_ = (to.z - from.z) / length_;
    }

    // z; kUnbounded where the flat bottom does not pass.
    double lowest(double x, double y) const
    {
        const double dx = x - from_.x;
        const double dy = y - from_.y;
        const double along = dx * way_.x + dy * way_.y;
        const double away = dy * way_.x - dx * way_.y;
        const double half = std::sqrt(std::max(0.0, square_ - away * away));
        const double begin = std::max(0.0, along - half);
        const double end = std::min(length_, along + half);
        const double height = from_.z + slope_ * (slope_ > 0.0 ? begin : end);
        return away * away <= square_ && begin <= end ? height : kUnbounded;
    }

private:
    Vec3d from_;
    Vec2d way_{1.0, 0.0};
    double square_;
    double length_{};
    double slope_{0.0};
};

// A cone, with a flat or a ball at its tip, moving from one position to the next. The height over a point is a convex
// function of the position, since the tool's profile is one of the distance: the lowest is where its slope is 0.
class ConeSweep {
public:
    ConeSweep(const toolpath::Tool& tool, Vec3d from, Vec3d to)
        : from_{from}, profile_{tool, 0}, square_{tool.radius * tool.radius}
    {
        constexpr double kShortest = 1e-9;
        const Vec2d along = in_plan(to) - in_plan(from);
        length_ = norm(along);
        if (length_ < kShortest) {
            length_ = 0;
            from_.z = std::min(from.z, to.z);
            return;
        }
        way_ = along * (1.0 / length_);
        slope_ = (to.z - from.z) / length_;
    }

    // z; kUnbounded where the tool does not pass.
    double lowest(double x, double y) const
    {
        const Vec2d d{x - from_.x, y - from_.y};
        const double along = dot(d, way_);
        const double away = d.y * way_.x - d.x * way_.y;
        const double half = half_chord(square_, away);
        const double begin = std::max(0.0, along - half);
        const double end = std::min(length_, along + half);
        if (away * away > square_ || begin > end) {
            return kUnbounded;
        }
        const double at = std::clamp(along - behind(std::abs(away)), begin, end);
        const double squared = (along - at) * (along - at) + away * away;
        return from_.z + slope_ * at + profile_.at(squared);
    }

private:
    // mm along the way, from the position that cuts a point lowest to the point: where the profile is as steep as the
    // way. The first of flat, ball and flank on which it is.
    double behind(double away) const
    {
        if (slope_ == 0.0) {
            return 0.0;
        }
        const double steep = std::abs(slope_);
        const double side = slope_ > 0 ? 1.0 : -1.0;
        const double ball = steep * half_chord(profile_.corner * profile_.corner, away) /
                            std::sqrt(1 + steep * steep);
        if (profile_.corner > 0 && ball * ball + away * away <= profile_.join * profile_.join) {
            return side * ball;
        }
        if (steep >= profile_.rise) {
            return side * kUnbounded;
        }
        const double q = steep / profile_.rise;
        const double flank = q * away / std::sqrt(1 - q * q);
        return side * std::max(flank, half_chord(profile_.flat * profile_.flat, away));
    }

    Vec3d from_;
    Profile profile_;
    double square_;
    Vec2d way_{1.0, 0.0};
    double length_{};
    double slope_{0.0};
};

}  // namespace cusp::verify
