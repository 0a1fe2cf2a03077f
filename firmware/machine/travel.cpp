// The box of a path against the travel of the axes.
#include "firmware/machine/travel.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::machine {
namespace {

void include(Extent& extent, Position at) noexcept
{
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        extent.least[axis] = std::min(extent.least[axis], at[axis]);
        extent.most[axis] = std::max(extent.most[axis], at[axis]);
    }
}

AxisVecd point_at(const path::Arc& arc, double angle) noexcept
{
    const SinCos<double> turn = sin_cos(angle);
    const double part = angle / arc.sweep;
    const double radius = arc.radius + part * arc.radius_change;
    return arc.centre + (arc.u * turn.cos + arc.v * turn.sin) * radius + arc.axial * part;
}

// The two angles where the circle turns back along an axis: u cos + v sin is extreme there.
void include_turns(Extent& extent, const path::Arc& arc, unsigned axis, Position start) noexcept
{
    constexpr double kTurn = 2.0 * kPi;
    const double extreme = atan2(arc.v[axis], arc.u[axis]);
    for (double first : {extreme, extreme + kPi}) {
        first += first < 0 ? kTurn : 0.0;
        first -= first >= kTurn ? kTurn : 0.0;
        if (first <= arc.sweep) {
            include(extent, start + to_position(point_at(arc, first)));
        }
        // Among several turns the last is the outermost where the radius grows.
        const double last = first + kTurn * std::floor((arc.sweep - first) / kTurn);
        if (last > first) {
            include(extent, start + to_position(point_at(arc, last)));
        }
    }
}

// A control point in float may lie a rounding outside.
constexpr std::int64_t kRounding = 10;

// True if it lies between -travel and 0, or not beyond `edge`, on each axis that has ends.
bool holds(const Extent& extent, const Extent& edge, const Settings& settings) noexcept
{
    for (unsigned axis = 0; axis < settings.axes(); ++axis) {
        if (!settings.has_ends(axis)) {
            continue;
        }
        const std::int64_t travel =
            to_nanometres(static_cast<double>(settings.value(Setting::kTravel, axis)));
        const std::int64_t least = std::min(-travel - kRounding, edge.least[axis]);
        const std::int64_t most = std::max(kRounding, edge.most[axis]);
        if (extent.most[axis] > most || extent.least[axis] < least) {
            return false;
        }
    }
    return true;
}

}  // namespace

Extent extent_of(const path::Move& move) noexcept
{
    Extent extent{move.start, move.start};
    include(extent, move.end);
    if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
            include_turns(extent, *arc, axis, move.start);
        }
    }
    if (const auto* curve = std::get_if<path::BezierPiece>(&move.path)) {
        for (unsigned i = 0; i < curve->order; ++i) {
            const AxisVecf point = curve->points[i];
            include(extent, move.start + to_position(to_double(point)));
        }
    }
    return extent;
}

bool within_travel(const path::Move& move, const Settings& settings) noexcept
{
    return holds(extent_of(move), {}, settings);
}

bool may_travel(const path::Move& move, const Settings& settings) noexcept
{
    const bool line = std::holds_alternative<path::Line>(move.path);
    return holds(extent_of(move), line ? Extent{move.start, move.start} : Extent{}, settings);
}

}  // namespace cusp::machine
