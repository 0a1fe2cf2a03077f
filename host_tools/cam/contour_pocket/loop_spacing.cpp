// Sections of the floor across every loop, and in all directions at corners.
#include "host_tools/cam/contour_pocket/loop_spacing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/contour_pocket/plan_stepover.hpp"

namespace cusp::contour_pocket {

using drop_cutter::DropCutter;
using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::left_normal;
using offset::Region2d;
using offset::unit;
using toolpath::Tool;

namespace {

constexpr double kSamplesApart = 0.3;  // of the tool's radius: between samples
constexpr double kLeastShare = 0.02;   // of the tool's radius: least stepover by a scallop

// Curvature of the tip's height for a ball, from the floor's curvature and slope.
double bend_of_tip(const Tool& tool, const DropCutter::Section& section)
{
    const double over = 1.0 + section.curvature * tool.corner_radius;
    const double secant = std::sqrt(1.0 + section.slope * section.slope);
    return over > 0.1 ? -section.curvature / over * secant * secant * secant : 1e3;
}

}  // namespace

double scallop_between(const Tool& tool, const std::vector<double>& heights, double apart)
{
    constexpr int kPlaces = 24;
    const auto n = static_cast<double>(heights.size() - 1);
    double highest = 0.0;
    for (int i = 1; i < kPlaces; ++i) {
        const double x = apart * i / kPlaces;
        const auto cut_from = [&](double t, double height) {
            return height + profile_height(tool, std::abs(x - t));
        };
        const double left =
            std::min(cut_from(0.0, heights.front()), cut_from(apart, heights.back()));
        double best = left;
        std::size_t at = 0;
        for (std::size_t k = 0; k < heights.size(); ++k) {
            const double cut = cut_from(apart * static_cast<double>(k) / n, heights[k]);
            if (cut < best) {
                best = cut;
                at = k;
            }
        }
        const std::size_t a = at > 0 ? at - 1 : 0;
        const std::size_t b = std::min(at + 1, heights.size() - 1);
        const double slope = (heights[b] - heights[a]) / (apart * static_cast<double>(b - a) / n);
        highest = std::max(highest, (left - best) / std::sqrt(1.0 + slope * slope));
    }
    return highest;
}

double least_stepover(const Tool& tool, const ToleranceSplit& tolerances)
{
    return std::max(0.5 * tolerances.scallop_height, 0.01 * tool.radius);
}

// Neighbouring moves may each deviate from their paths.
double LoopSpacing::within_limits(double interval) const
{
    const double stray = tolerances_.one_sided ? 2.0 * tolerances_.plan_tolerance : 0.0;
    return std::max(interval - stray, least_stepover(floor_.tool(), tolerances_));
}

double LoopSpacing::found() const { return within_limits(least_); }

double LoopSpacing::stepover_from(const Region2d& ring, double proven)
{
    constexpr double kWorthIt = 0.95;
    least_ = kUnbounded;
    const double apart = kSamplesApart * floor_.tool().radius;
    for (const Contour& contour : ring.contours) {
        std::optional<Vec2d> corner;
        Vec2d arriving = tangent_at_end(contour.back());
        since_ = kUnbounded;
        for (const Edge& edge : contour) {
            along(edge);
            if (proven > kWorthIt * found()) {
                return proven;
            }
            constexpr double kCorner = 0.995;  // cosine of some 6 degrees
            const bool turns = dot(arriving, tangent_at_start(edge)) < kCorner;
            if (corners_ && turns && (!corner || distance(*corner, edge.start) > apart)) {
                corner = edge.start;
                around(edge.start);
            }
            arriving = tangent_at_end(edge);
        }
    }
    return found();
}

double LoopSpacing::with_partial_loops(const Region2d& ring, double step) const
{
    constexpr double kUneven = 0.7;
    constexpr double kWorthIt = 0.85;
    constexpr double kApart = 0.5;  // of the tool's radius
    const Tool& tool = floor_.tool();
    const double flat = plan_stepover(tool, tolerances_.scallop_height, {});
    if (step > kUneven * flat) {
        return 0.0;
    }
    std::vector<double> intervals;
    for (const Contour& contour : ring.contours) {
        double next = 0.0;  // mm along the edge
        for (const Edge& edge : contour) {
            const double whole = length(edge);
            for (; next < whole; next += kApart * tool.radius) {
                const Vec2d at = point_on(edge, next / whole);
                const Vec2d inward = left_normal(tangent_on(edge, next / whole));
                const double first = allowed(contact(at), inward);
                const double half = allowed(contact(at + inward * (0.5 * first)), inward);
                intervals.push_back(within_limits(std::min(first, half)));
            }
            next -= whole;
        }
    }
    std::sort(intervals.begin(), intervals.end());
    double best = 0.0;
    double least_cost = kWorthIt / step;
    for (int tenth = 1; tenth < 10 && !intervals.empty(); ++tenth) {
        const double wide = intervals[intervals.size() * static_cast<std::size_t>(tenth) / 10];
        double passes = 0.0;
        for (const double interval : intervals) {
            int halvings =
                0;  // the smallest number after which `wide` is no more than the interval
            const double share = std::frexp(wide / interval, &halvings);
            halvings = std::max(0, share > 0.5 ? halvings : halvings - 1);
            passes += 1.0 + 2.0 * (std::ldexp(1.0, halvings) - 1.0);
        }
        const double cost = passes / (static_cast<double>(intervals.size()) * wide);
        if (cost < least_cost) {
            least_cost = cost;
            best = wide;
        }
    }
    return best;
}

// Accurate to a fiftieth of the scallop's height.
LoopSpacing::Contact LoopSpacing::contact(Vec2d at) const
{
    return floor_.cc_point(at, 0.02 * tolerances_.scallop_height);
}

// Without a contact as on a level floor.
double LoopSpacing::allowed(const Contact& contact, Vec2d direction) const
{
    const DropCutter::Section section =
        contact ? DropCutter::section(*contact, direction) : DropCutter::Section{};
    return plan_stepover(floor_.tool(), tolerances_.scallop_height, section);
}

// The scallop is half a stepover away, where the floor may have another curvature.
void LoopSpacing::across(Vec2d at, const Contact& here, Vec2d direction)
{
    const double first = allowed(here, direction);
    const Contact half = contact(at + direction * (0.5 * first));
    const double interval = std::min({least_, first, allowed(half, direction)});
    least_ = interval;
    if (!scallops_ || !here || !half) {
        return;
    }
    const Contact there = contact(at + direction * first);
    if (!as_expected(*here, *half, direction, 0.5 * first) ||
        (there && !as_expected(*half, *there, direction, 0.5 * first))) {
        least_ = by_scallop(at, direction, interval);
    }
}

// True if the tip's height and slope change between two places as predicted by the curvatures at
// both.
bool LoopSpacing::as_expected(const DropCutter::CcPoint& a,
                              const DropCutter::CcPoint& b,
                              Vec2d direction,
                              double apart) const
{
    const DropCutter::Section from = DropCutter::section(a, direction);
    const DropCutter::Section to = DropCutter::section(b, direction);
    const double rise = b.z - a.z;
    const double by_slopes = 0.5 * apart * (from.slope + to.slope);
    const double bend = 0.5 * (bend_of_tip(floor_.tool(), from) + bend_of_tip(floor_.tool(), to));
    const double turned = to.slope - from.slope - bend * apart;
    const double max_error = 0.1 * tolerances_.scallop_height;
    return std::abs(rise - by_slopes) < max_error && std::abs(turned) * apart < 4.0 * max_error;
}

double LoopSpacing::by_scallop(Vec2d at, Vec2d direction, double widest) const
{
    constexpr int kPlaces = 32;
    constexpr int kWindow = 4;  // places by which successive windows differ
    constexpr int kHalvings = 6;
    const auto low_enough = [&](double apart) {
        std::vector<double> heights;
        for (int i = 0; i <= kPlaces; ++i) {
            const auto cl = floor_.drop(at + direction * (apart * i / kPlaces));
            if (!cl) {
                return true;
            }
            heights.push_back(cl->z);
        }
        // The spacing may become smaller: a valley that this pass clears would then lie between two
        // passes.
        while (heights.size() > 2) {
            const double reach = apart * static_cast<double>(heights.size() - 1) / kPlaces;
            if (scallop_between(floor_.tool(), heights, reach) > tolerances_.scallop_height) {
                return false;
            }
            heights.resize(heights.size() - kWindow);
        }
        return true;
    };
    if (low_enough(widest)) {
        return widest;
    }
    double good = std::min(widest, kLeastShare * floor_.tool().radius);
    double bad = widest;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (good + bad);
        (low_enough(middle) ? good : bad) = middle;
    }
    return good;
}

// Samples are denser where the floor is uneven along the edge. In a chain of short edges only those
// that begin at least kSamplesApart after the last sample are examined.
void LoopSpacing::along(const Edge& edge)
{
    const double radius = floor_.tool().radius;
    const double whole = length(edge);
    since_ += whole;
    if (since_ < kSamplesApart * radius) {
        return;
    }
    const int n = 1 + static_cast<int>(whole / radius);
    Sample last{};
    for (int i = 0; i < n; ++i) {
        const Sample next = sample(edge, (i + 0.5) / n);
        if (i > 0) {
            refine(edge, whole, last, next);
        }
        last = next;
    }
    since_ = 0.5 * whole / n;
}

LoopSpacing::Sample LoopSpacing::sample(const Edge& edge, double share)
{
    const Vec2d at = point_on(edge, share);
    const Vec2d way = tangent_on(edge, share);
    const Sample result{share, way, contact(at)};
    across(at, result.contact, left_normal(way));
    return result;
}

void LoopSpacing::refine(const Edge& edge, double whole, const Sample& a, const Sample& b)
{
    const double apart = (b.share - a.share) * whole;
    const bool known = a.contact && b.contact;
    if (!scallops_ || apart < kSamplesApart * floor_.tool().radius ||
        (known && as_expected(*a.contact, *b.contact, unit(a.direction + b.direction), apart))) {
        return;
    }
    const Sample middle = sample(edge, 0.5 * (a.share + b.share));
    refine(edge, whole, a, middle);
    refine(edge, whole, middle, b);
}

void LoopSpacing::around(Vec2d at)
{
    constexpr int kDirections = 12;
    const Contact here = contact(at);
    for (int i = 0; i < kDirections; ++i) {
        const double angle = 2 * kPi * i / kDirections;
        across(at, here, {elementary::cos(angle), elementary::sin(angle)});
    }
}

}  // namespace cusp::contour_pocket
