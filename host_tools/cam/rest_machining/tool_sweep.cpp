// The sweep's lower side at a point is the least over the way of the tool's own, which is convex
// along the way.
#include "host_tools/cam/rest_machining/tool_sweep.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::rest_machining {

using toolpath::Tool;

namespace {

constexpr double kShortest = 1e-9;  // mm
constexpr double kLevel = 1e-12;    // slope

}  // namespace

EndProfile::EndProfile(const Tool& tool, double shrink)
    : radius{std::max(0.0, tool.radius - shrink)},
      corner{std::max(0.0, tool.corner_radius - shrink)},
      raised{shrink}
{
    if (!is_conical(tool)) {
        flat = std::max(0.0, radius - corner);
        return;
    }
    const double half = tool.tip_angle / 2;
    rise = 1 / elementary::tan(half);
    if (corner > 0) {
        join = corner * elementary::cos(half);
        joined = corner * (1 - elementary::sin(half));
        return;
    }
    if (tool.corner_radius > 0) {  // of its ball nothing is left
        raised = tool.corner_radius + (shrink - tool.corner_radius) / elementary::sin(half);
        return;
    }
    // the flank moves inward by `shrink` square to itself
    flat = tool.tip_radius - shrink * (1 - elementary::sin(half)) / elementary::cos(half);
    if (flat < 0) {
        raised -= flat * rise;
        flat = 0;
    }
}

double EndProfile::height(double distance) const
{
    const double beyond = distance - flat;
    if (beyond <= 0) {
        return 0;
    }
    if (rise > 0 && beyond >= join) {
        return joined + rise * (beyond - join);
    }
    return corner - std::sqrt(std::max(0.0, corner * corner - beyond * beyond));
}

double EndProfile::slope(double distance) const
{
    const double beyond = distance - flat;
    if (beyond <= 0) {
        return 0;
    }
    if ((rise > 0 && beyond >= join) || corner <= 0) {
        return rise;
    }
    return beyond / std::sqrt(std::max(1e-12, corner * corner - beyond * beyond));
}

ToolSweep::ToolSweep(const EndProfile& end, Vec3d from, Vec3d to) : end_{end}, from_{from}, to_{to}
{
    from_.z += end.raised;
    to_.z += end.raised;
    const Vec2d way = in_plan(to) - in_plan(from);
    length_ = norm(way);
    if (length_ > kShortest) {
        way_ = way * (1 / length_);
        slope_ = (to.z - from.z) / length_;
    } else {
        length_ = 0;
        from_.z = to_.z = std::min(from_.z, to_.z);
    }
}

Vec2d ToolSweep::low() const
{
    return {std::min(from_.x, to_.x) - end_.radius, std::min(from_.y, to_.y) - end_.radius};
}

Vec2d ToolSweep::high() const
{
    return {std::max(from_.x, to_.x) + end_.radius, std::max(from_.y, to_.y) + end_.radius};
}

double ToolSweep::distance(Vec2d p) const
{
    const Vec2d d = p - in_plan(from_);
    return norm(p - axis(std::clamp(dot(d, way_), 0.0, length_)));
}

// Bisection on the slope along the way, which never falls.
double ToolSweep::numeric_place(double along, double away, double low, double high) const
{
    constexpr int kHalvings = 40;
    double begin = low;
    double end = high;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = (begin + end) / 2;
        const double distance = elementary::hypot(away, middle - along);
        const double climb =
            distance > kShortest ? end_.slope(distance) * (middle - along) / distance : 0.0;
        (slope_ + climb < 0 ? begin : end) = middle;
    }
    return (begin + end) / 2;
}

double ToolSweep::lowest_place(Vec2d p) const
{
    const Vec2d d = p - in_plan(from_);
    const double along = dot(d, way_);
    const double away = cross(way_, d);
    const double squared = end_.radius * end_.radius - away * away;
    if (squared < 0) {
        return -1;
    }
    const double half = std::sqrt(squared);
    const double low = std::max(0.0, along - half);
    const double high = std::min(length_, along + half);
    if (low > high) {
        return -1;
    }
    if (std::abs(slope_) < kLevel) {
        return std::clamp(along, low, high);
    }
    if (end_.corner <= 0 && end_.rise <= 0) {
        return slope_ > 0 ? low : high;
    }
    if (end_.corner > 0 && end_.flat <= 0 && end_.rise <= 0) {
        return std::clamp(along - slope_ * half / std::sqrt(1 + slope_ * slope_), low, high);
    }
    return numeric_place(along, away, low, high);
}

double ToolSweep::height(Vec2d p) const
{
    const double place = lowest_place(p);
    if (place < 0) {
        return kInfinite;
    }
    return from_.z + slope_ * place + end_.height(norm(p - axis(place)));
}

// With h(p, t) the lower side of the tool at t on the way, jointly convex: a subgradient of h at p
// and the lowest t, whose part along t is zero (or points out of the way's end), is one of the
// least over t.
SupportPlane ToolSweep::plane_below(Vec2d p) const
{
    constexpr double kInside = 0.98;  // of the radius: a ball's side is vertical at its rim
    const Vec2d foot = axis(std::clamp(dot(p - in_plan(from_), way_), 0.0, length_));
    const double off = norm(p - foot);
    const Vec2d q =
        off > kInside * end_.radius ? foot + (p - foot) * (kInside * end_.radius / off) : p;
    const double place = std::max(0.0, lowest_place(q));
    const Vec2d out = q - axis(place);
    const double distance = norm(out);
    const double z = from_.z + slope_ * place + end_.height(distance);
    const bool at_begin = place <= kShortest;
    const bool at_end = place >= length_ - kShortest;
    if (distance < kShortest) {
        const bool between = !at_begin && !at_end;
        return {q, z, between ? way_ * slope_ : Vec2d{0, 0}};
    }
    const Vec2d direction = out * (1 / distance);
    double steepness = end_.slope(distance);
    const double onward = dot(direction, way_);
    const double change = slope_ - steepness * onward;  // of h along t
    const bool is_least = (at_begin && change >= 0) || (at_end && change <= 0);
    if (!is_least && std::abs(slope_) >= kLevel && slope_ * onward > 0) {
        steepness = slope_ / onward;
    }
    return {q, z, direction * steepness};
}

// Both tools are level discs rounded by balls; the inner one with the corner of the sharper is no
// smaller than it was.
bool ToolSweep::holds_end(const ToolSweep& other, Vec3d tip) const
{
    const double place = std::clamp(dot(in_plan(tip) - in_plan(from_), way_), 0.0, length_);
    const Vec3d here{axis(place).x, axis(place).y, from_.z + slope_ * place};
    const double corner = std::min(end_.corner, other.end_.corner);
    const double flat = other.end_.radius - corner;
    const double beside = std::max(0.0, norm(in_plan(tip) - in_plan(here)) + flat - end_.flat);
    const double below = std::max(0.0, here.z + end_.corner - tip.z - corner);
    return elementary::hypot(beside, below) <= end_.corner - corner;
}

bool ToolSweep::contains(const ToolSweep& other) const
{
    return end_.rise <= 0 && other.end_.rise <= 0 && holds_end(other, other.from_) &&
           holds_end(other, other.to_);
}

}  // namespace cusp::rest_machining
