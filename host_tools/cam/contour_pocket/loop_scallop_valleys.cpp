// The height left in valleys of the floor that are too narrow for the tool.
#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/contour_pocket/loop_scallop.hpp"

namespace cusp::contour_pocket {

using offset::distance;
using toolpath::Tool;

// The position in which the tool touches both sides of a valley: where the linear continuations of
// its heights intersect, below both probes; else the lower probe.
LoopScallop::Lowest LoopScallop::where_sides_meet(const Probe& a, const Probe& b)
{
    const Vec2d move = b.at - a.at;
    const double fall = -dot(a.gradient, move);
    const double rise = dot(b.gradient, move);
    const double share = (a.tip - b.tip + rise) / (fall + rise);
    if (fall > 0.0 && rise > 0.0 && share > 0.0 && share < 1.0) {
        return {a.at + move * share, a.tip - fall * share};
    }
    return a.tip < b.tip ? Lowest{a.at, a.tip} : Lowest{b.at, b.tip};
}

// Between the contacts of two neighbouring probes, where a ball does not reach the floor: height
// left above the lowest possible cut.
double LoopScallop::left_under(const Probe& a, const Probe& b) const
{
    constexpr int kPieces = 4;
    constexpr double kFar = 0.1;  // of the tool's radius: closer contacts hide nothing
    const Tool& tool = floor_.tool();
    const double apart = distance(a.touched, b.touched);
    const bool known = a.floor && b.floor;
    if (!known || apart < std::max(kFar * tool.radius, 3.0 * distance(a.at, b.at))) {
        return 0.0;
    }
    const Lowest lowest = where_sides_meet(a, b);
    double largest = 0.0;
    for (int i = 1; i < kPieces; ++i) {
        const double share = static_cast<double>(i) / kPieces;
        const Vec2d p = a.touched + (b.touched - a.touched) * share;
        const double best =
            std::min({a.tip + profile_height(tool, distance(a.at, p)),
                      b.tip + profile_height(tool, distance(b.at, p)),
                      lowest.height + profile_height(tool, distance(lowest.at, p))});
        // Only beside its sides is the floor of a valley as steep as they are.
        const Vec2d slope = a.gradient * (1.0 - share) + b.gradient * share;
        const double secant = std::sqrt(1.0 + dot(slope, slope));
        const double left = std::min({left_at(p, a.at), left_at(p, lowest.at), left_at(p, b.at)});
        largest = std::max(largest, (left - best) / (secant * scallop_share_ * allowed(secant)));
    }
    return largest;
}

// Over a valley too narrow for a flat end: height left above the middle and the rim of the flat at
// its lowest position between two neighbouring probes. Downward along the valley the rim cuts
// steps.
double LoopScallop::left_under_flat(const Probe& a, const Probe& b) const
{
    constexpr double kTurned = 0.1;  // change of slope that counts as a valley
    constexpr int kRound = 12;       // places along the rim
    constexpr double kInside = 0.9999;
    const bool known = a.floor && b.floor;
    const Vec2d move = b.at - a.at;
    if (!known || dot(b.gradient - a.gradient, move) <= kTurned * std::sqrt(dot(move, move))) {
        return 0.0;
    }
    const Lowest lowest = where_sides_meet(a, b);
    const Tool& tool = floor_.tool();
    const double foot = kInside * (tool.radius - tool.corner_radius);
    double highest = lowest.height;
    for (int i = 0; i <= kRound; ++i) {
        const double angle = 2 * kPi * i / kRound;
        const Vec2d way{elementary::cos(angle), elementary::sin(angle)};
        const Vec2d p = i < kRound ? lowest.at + way * foot : lowest.at;
        const double left =
            std::min({left_at(p, lowest.at), left_at(p, (lowest.at + p) * 0.5), left_at(p, p)});
        highest = left < kUnbounded ? std::max(highest, left) : highest;  // else beyond both rings
    }
    // A step is highest just before the next pass, up to one probe beyond those examined.
    const double unseen = static_cast<double>(places_) / (places_ - 1);
    return unseen * (highest - lowest.height) / (scallop_share_ * allowed(1.0));
}

// The two sides of a valley that the tool touches are found by different cross lines.
double LoopScallop::left_beside(const CrossLine& a, const CrossLine& b) const
{
    double largest = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::min(a.count, b.count)); ++i) {
        largest = std::max(largest, left_between(a.probes[i], b.probes[i]));
    }
    return largest;
}

}  // namespace cusp::contour_pocket
