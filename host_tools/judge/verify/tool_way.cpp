// The height over a place is a convex function of the tool's place on its way, since its profile is one of the distance.
#include "host_tools/judge/verify/tool_way.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::verify {

using toolpath::Tool;

ToolWay::ToolWay(const Tool& tool, double radius, Vec3d from, Vec3d to)
    : tool_{&tool},
      radius_{radius},
      from_{from},
      to_{to},
      squared_{dot(in_plan(to) - in_plan(from), in_plan(to) - in_plan(from))},
      is_cylinder_{flat_radius(tool) >= tool.radius && !is_conical(tool)}
{
    constexpr double kShortest = 1e-18;  // mm^2
    if (squared_ < kShortest) {
        squared_ = 0;
        from_.z = to_.z = std::min(from.z, to.z);
    }
}

Vec2d ToolWay::low() const
{
    return Vec2d{std::min(from_.x, to_.x), std::min(from_.y, to_.y)} - Vec2d{radius_, radius_};
}

Vec2d ToolWay::high() const
{
    return Vec2d{std::max(from_.x, to_.x), std::max(from_.y, to_.y)} + Vec2d{radius_, radius_};
}

double ToolWay::nearest(Vec2d place) const
{
    const Vec2d way = in_plan(to_) - in_plan(from_);
    return squared_ > 0 ? std::clamp(dot(place - in_plan(from_), way) / squared_, 0.0, 1.0) : 0.0;
}

double ToolWay::away(Vec2d place) const
{
    return norm(place - (in_plan(from_) + nearest(place) * (in_plan(to_) - in_plan(from_))));
}

ToolWay::Stretch ToolWay::stretch(Vec2d place, double reach) const
{
    const Vec2d way = in_plan(to_) - in_plan(from_);
    const Vec2d d = place - in_plan(from_);
    if (squared_ <= 0) {
        return reach >= 0 && dot(d, d) <= reach * reach ? Stretch{0, 0} : Stretch{1, 0};
    }
    const double along = dot(d, way) / squared_;
    const double across = cross(d, way);
    const double half = reach * reach * squared_ - across * across;
    if (reach < 0 || half < 0) {
        return {1, 0};
    }
    const double share = std::sqrt(half) / squared_;
    return {std::max(0.0, along - share), std::min(1.0, along + share)};
}

double ToolWay::height(Vec2d place, double wider, double share) const
{
    const Vec3d tip = from_ + share * (to_ - from_);
    const double away = norm(place - in_plan(tip)) - wider;
    return tip.z + profile_height(*tool_, std::clamp(away, 0.0, tool_->radius));
}

double ToolWay::share_of_lowest(Vec2d place, double wider, Stretch passed) const
{
    if (from_.z == to_.z) {
        return nearest(place);
    }
    if (is_cylinder_) {
        return from_.z < to_.z ? passed.begin : passed.end;
    }
    // Golden sections: 32 of them leave 1e-6 mm of a tool's width.
    constexpr int kSections = 32;
    constexpr double kGolden = 0.6180339887498949;
    double a = passed.begin;
    double b = passed.end;
    double left = b - kGolden * (b - a);
    double right = a + kGolden * (b - a);
    double at_left = height(place, wider, left);
    double at_right = height(place, wider, right);
    for (int k = 0; k < kSections; ++k) {
        if (at_left <= at_right) {
            b = right;
            right = left;
            at_right = at_left;
            left = b - kGolden * (b - a);
            at_left = height(place, wider, left);
        } else {
            a = left;
            left = right;
            at_left = at_right;
            right = a + kGolden * (b - a);
            at_right = height(place, wider, right);
        }
    }
    return 0.5 * (a + b);
}

double ToolWay::lowest(Vec2d place, double wider) const
{
    const Stretch passed = stretch(place, radius_ + wider);
    return passed.begin <= passed.end ? height(place, wider, share_of_lowest(place, wider, passed))
                                      : kUnbounded;
}

bool ToolWay::is_below(Vec2d place, double wider, double level) const
{
    const Stretch passed = stretch(place, radius_ + wider);
    if (passed.begin > passed.end) {
        return false;
    }
    const double near = std::clamp(nearest(place), passed.begin, passed.end);
    const double above_tip = height(place, wider, near) - (from_.z + near * (to_.z - from_.z));
    const double lowest_tip =
        from_.z + (from_.z < to_.z ? passed.begin : passed.end) * (to_.z - from_.z);
    if (lowest_tip + above_tip > level) {
        return false;
    }
    return from_.z == to_.z || height(place, wider, near) <= level ||
           height(place, wider, share_of_lowest(place, wider, passed)) <= level;
}

Vec3d ToolWay::tip_over(Vec2d place) const
{
    const double share = share_of_lowest(place, 0, stretch(place, radius_));
    return from_ + share * (to_ - from_);
}

}  // namespace cusp::verify
