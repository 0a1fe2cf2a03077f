// Lines inward from the outer loops, compared with what the paths of both rings cut.
#include "host_tools/cam/contour_pocket/loop_scallop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/cam/cl_path/station_row.hpp"
#include "host_tools/cam/clearing/corner_cleanup.hpp"
#include "host_tools/cam/contour_pocket/loop_spacing.hpp"

namespace cusp::contour_pocket {

using cl_path::PathFloor;
using cl_path::Station;
using cl_path::StationRow;
using cl_path::stations_along;
using cl_path::StationSpacing;
using clearing::LoopStrip;
using clearing::starts_cleanup_spur;
using drop_cutter::DropCutter;
using nurbs::Surface;
using offset::Box2d;
using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::left_normal;
using offset::Region2d;
using toolpath::Tool;

namespace {

constexpr double kLinesApart =
    1.0 / 6.0;  // of the tool's radius: largest distance between cross lines
constexpr double kNearestWays = 1.0 / 48.0;  // of it: where the scallop changes
constexpr double kFine = 0.02;   // of the tool's radius: least distance between probes on a line
constexpr double kEnough = 4.0;  // larger relative scallops need not be exact

// Beside the rim of a flat bottom the scallop is low enough only over a crescent: as deep as the
// scallop on a steep floor, and as long as the chord there.
double cross_lines_apart(const Tool& tool, double scallop_height)
{
    constexpr double kShare = 0.3;
    const double chord = kShare * std::sqrt(2.0 * scallop_height * tool.radius);
    return std::min(kLinesApart * tool.radius, std::max(chord, kLinesApart * tool.corner_radius));
}

bool turns(const Edge& before, const Edge& after)
{
    constexpr double kCorner = 0.995;  // cosine of some 6 degrees
    return dot(tangent_at_end(before), tangent_at_start(after)) < kCorner;
}

}  // namespace

LoopScallop::LoopScallop(const DropCutter& floor,
                         const std::vector<Surface>& surfaces,
                         const ToleranceSplit& tolerances)
    : floor_{floor},
      tolerances_{tolerances},
      ball_{floor.tool().corner_radius >= floor.tool().radius},
      apart_{cross_lines_apart(floor.tool(), tolerances.scallop_height)},
      bounds_{ball_ ? surfaces : std::vector<Surface>{}, floor.tool().radius}
{
}

// mm: distance from a pass within which no scallop is too high.
double LoopScallop::proven(const part_model::BendBounds& bounds) const
{
    if (!ball_ || !std::isfinite(bounds.slope)) {
        return 0.0;
    }
    const double secant = std::sqrt(1.0 + bounds.slope * bounds.slope);
    return proven_reach(floor_.tool().radius, allowed(secant), bounds) - tolerances_.plan_tolerance;
}

// That distance for passes in the box, over the floor up to `step` (mm) beside it.
double LoopScallop::proven(const Box2d& passes, double step) const
{
    return proven(
        bounds_.near({passes.x0 - step, passes.y0 - step, passes.x1 + step, passes.y1 + step}));
}

double LoopScallop::proven_stepover(const Region2d& ring) const
{
    constexpr double kMargin = 0.9999;
    const Box2d box = box_of(ring);
    const double radius = floor_.tool().radius;
    const double flat =
        2.0 * std::sqrt(tolerances_.scallop_height * (2.0 * radius - tolerances_.scallop_height));
    const double step = 2.0 * kMargin * proven(box, flat);
    return step > flat ? std::min(step, 2.0 * kMargin * proven(box, step)) : step;
}

bool LoopScallop::reaches_floor(const Region2d& region) const
{
    return ball_ && bounds_.near(box_of(region)).up * floor_.tool().radius < 1.0;
}

// A cubic through heights and slopes a distance h apart has an error of at most w h^2 / 32, where w
// is the width of the range of the second derivative: the remainder is the integral of the second
// derivative with a kernel orthogonal to straight lines, of absolute integral h^2 / 16.
// proven_reach() gives the range for the tip's z.
double LoopScallop::lookup_spacing(const Region2d& region, double max_error) const
{
    const part_model::BendBounds bounds = bounds_.near(box_of(region));
    const double radius = floor_.tool().radius;
    if (!ball_ || !(bounds.up * radius < 1.0) || !std::isfinite(bounds.down)) {
        return 0.0;
    }
    const double width = bounds.up / (1.0 - bounds.up * radius) + bounds.down;
    return std::min(std::sqrt(32.0 * max_error / std::max(width, 1e-12)), 4.0 * radius);
}

double LoopScallop::relative_scallop(const LoopStrip& strip)
{
    constexpr double kWorthIt = 0.95;
    const double step = strip.to - strip.from;
    const double reach = proven(box_of(strip.outer), step);
    if (2.0 * reach > kWorthIt * step) {
        const double share = 0.5 * step / reach;
        return share * share;
    }
    if (step <= least_stepover(floor_.tool(), tolerances_)) {
        return 0.0;
    }
    const Search search{strip, 0.0, step, false};
    set_resolution(step);
    segments_.clear();
    set_paths(strip.outer, step);
    set_paths(strip.inner, step);
    sort_segments(step);
    double largest = 0.0;
    for (const Contour& contour : strip.outer.contours) {
        Contour loop;
        for (std::size_t e = 0; e < contour.size(); ++e) {
            // The second edge of a cleanup spur goes back over the first.
            if (!starts_cleanup_spur(contour, e) &&
                !(e > 0 && starts_cleanup_spur(contour, e - 1))) {
                loop.push_back(contour[e]);
            }
        }
        for (std::size_t e = 0; e < loop.size() && largest < kEnough; ++e) {
            const Edge& before = loop[(e + loop.size() - 1) % loop.size()];
            const Edge& after = loop[(e + 1) % loop.size()];
            const Corners corners{turns(before, loop[e]), turns(loop[e], after)};
            largest = std::max(largest, cross_lines_along(loop[e], corners, search));
        }
    }
    return largest;
}

// Neighbouring moves may each deviate from their paths; a scallop grows with the square of their
// distance.
void LoopScallop::set_resolution(double step)
{
    places_ = std::clamp(static_cast<int>(step / (kFine * floor_.tool().radius)), 3, kPlaces);
    const double strayed = step / (step + 2.0 * tolerances_.plan_tolerance);
    scallop_share_ = strayed * strayed;
}

// Places without floor are refused when the path is projected.
void LoopScallop::set_paths(const Region2d& ring, double step)
{
    const double height = 0.2 * tolerances_.scallop_height;
    const StationSpacing spacing{0.5 * step, 0.02 * step, height, false};
    const PathFloor floor{floor_};
    for (const Contour& contour : ring.contours) {
        const StationRow row = stations_along(contour, &floor, spacing);
        for (std::size_t i = 1; i < row.stations.size(); ++i) {
            const Station& a = row.stations[i - 1];
            const Station& b = row.stations[i];
            segments_.push_back({{a.at.x, a.at.y, a.height}, {b.at.x, b.at.y, b.height}});
        }
    }
}

void LoopScallop::sort_segments(double cell)
{
    field_ = {};
    for (const TipSegment& s : segments_) {
        field_ = {
            std::min({field_.x0, s.start.x, s.end.x}), std::min({field_.y0, s.start.y, s.end.y}),
            std::max({field_.x1, s.start.x, s.end.x}), std::max({field_.y1, s.start.y, s.end.y})};
    }
    constexpr double kMostCells = 250.0;  // a side
    const double longest = std::max(field_.x1 - field_.x0, field_.y1 - field_.y0);
    cell_ = std::max(cell, longest / kMostCells);
    columns_ = 1 + static_cast<int>((field_.x1 - field_.x0) / cell_);
    rows_ = 1 + static_cast<int>((field_.y1 - field_.y0) / cell_);
    cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
    for (std::size_t k = 0; k < segments_.size(); ++k) {
        const TipSegment& s = segments_[k];
        const auto column = [&](double x) {
            return static_cast<int>((x - field_.x0) / cell_);
        };
        const auto row = [&](double y) {
            return static_cast<int>((y - field_.y0) / cell_);
        };
        for (int i = column(std::min(s.start.x, s.end.x));
             i <= column(std::max(s.start.x, s.end.x)); ++i) {
            for (int j = row(std::min(s.start.y, s.end.y)); j <= row(std::max(s.start.y, s.end.y));
                 ++j) {
                cells_[static_cast<std::size_t>(j * columns_ + i)].push_back(
                    static_cast<std::uint32_t>(k));
            }
        }
    }
}

// A point on the rim itself is touched from one position only, so touched points are moved slightly
// inward.
Vec2d LoopScallop::inside_rim(Vec2d at, Vec2d touched) const
{
    constexpr double kInside = 0.9999;
    const double farthest = kInside * floor_.tool().radius;
    const double out = distance(at, touched);
    return out > farthest ? at + (touched - at) * (farthest / out) : touched;
}

// Beside the contact, the lower side of a ball follows the floor. Below the rim of a flat bottom
// the floor falls away, so the contact itself is needed.
LoopScallop::Probe LoopScallop::probe(Vec2d at) const
{
    const Tool& tool = floor_.tool();
    const double max_error = 0.02 * tolerances_.scallop_height;
    if (!ball_) {
        if (const auto contact = floor_.exact_cc_point(at, max_error)) {
            const Vec3d p = contact->surface.point;
            const Vec3d n = contact->normal;
            const Vec2d touched = inside_rim(at, {p.x, p.y});
            const double side = contact->z + profile_height(tool, distance(at, touched));
            if (std::abs(side - p.z) * n.z < 0.1 * tolerances_.scallop_height) {
                return {at, contact->z, touched, p.z, {-n.x / n.z, -n.y / n.z}, 1.0 / n.z};
            }
        }
    }
    const std::optional<DropCutter::ClPoint> cl = floor_.drop(at, max_error);
    if (!cl) {
        return {at, -kUnbounded, at, std::nullopt, {}, 1.0};
    }
    const Vec2d touched = inside_rim(at, floor_.cc_place(at, *cl));
    const double side = cl->z + profile_height(tool, distance(at, touched));
    const double secant = std::sqrt(1.0 + dot(cl->slope, cl->slope));
    return {at, cl->z, touched, side, cl->slope, secant};
}

// z left at `at` by the paths around `near`.
double LoopScallop::left_at(Vec2d at, Vec2d near) const
{
    const int i = static_cast<int>(std::floor((near.x - field_.x0) / cell_));
    const int j = static_cast<int>(std::floor((near.y - field_.y0) / cell_));
    double least = kUnbounded;
    for (int row = std::max(0, j - 1); row <= std::min(rows_ - 1, j + 1); ++row) {
        for (int column = std::max(0, i - 1); column <= std::min(columns_ - 1, i + 1); ++column) {
            for (const std::uint32_t k :
                 cells_[static_cast<std::size_t>(row * columns_ + column)]) {
                const TipSegment& s = segments_[k];
                if (std::min(s.start.z, s.end.z) < least) {
                    least = std::min(least, cut_over(floor_.tool(), s, at, least));
                }
            }
        }
    }
    return least;
}

// On a slope, a move beside its path is higher above the floor, or is raised where it would gouge:
// by at most 1.5 times its distance from the path, along the normal.
double LoopScallop::allowed(double secant) const
{
    constexpr double kRaised = 1.5;
    constexpr double kLeast = 0.3;  // of the height allowed on a level floor
    const double cosine = 1.0 / secant;
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double on_slope =
        tolerances_.height_tolerance * (1.0 - cosine) - kRaised * tolerances_.plan_tolerance * sine;
    return std::max(tolerances_.scallop_height + on_slope, kLeast * tolerances_.scallop_height);
}

// Height left at the contact, along the normal, as a share of the allowed height.
double LoopScallop::uncut(const Probe& probe, bool stretches) const
{
    if (!probe.floor) {
        return 0.0;
    }
    const double share = std::max(0.0, left_at(probe.touched, probe.at) - *probe.floor) /
                         (probe.secant * scallop_share_ * allowed(probe.secant));
    return stretches && ball_ && share > 1.0 && is_low_along_normal(probe) ? 1.0 : share;
}

// The highest ridge between the n + 1 probes of a cross line, from the heights left at them.
double LoopScallop::highest_between(const std::array<double, kPlaces + 1>& found,
                                    std::size_t n) const
{
    double highest = 0.0;
    // Between two probes the height left by one pass rises and that left by the other falls. The
    // ridge is no higher than the intersection of their linear continuations, except for curvature.
    for (std::size_t i = 2; i + 1 < n; ++i) {
        const double rise = found[i] - found[i - 1];
        const double fall = found[i + 1] - found[i + 2];
        const double meeting = (found[i + 1] - found[i] + fall) / (rise + fall);
        if (rise > 0.0 && fall > 0.0 && meeting >= 0.0 && meeting <= 1.0) {
            highest = std::max(highest, found[i] + rise * meeting);
        }
    }
    // The steps of a flat bottom rise up to the next pass and end there.
    for (std::size_t i = 1; !ball_ && i < n; ++i) {
        const double rise = found[i] - found[i - 1];
        const double fall = found[i] - found[i + 1];
        highest = std::max(highest, found[i] + std::min(std::max(0.0, rise), std::max(0.0, fall)));
    }
    return highest;
}

LoopScallop::CrossLine LoopScallop::cross_line(const Edge& edge,
                                               double along,
                                               const Search& search) const
{
    constexpr double kSlack = 1e-6;
    const double step = search.step;
    const Vec2d tangent = tangent_on(edge, along);
    const Vec2d inward = left_normal(tangent);
    const Vec2d foot = point_on(edge, along) + inward * search.foot;
    const auto place = [&](double t) {
        return foot + inward * t;
    };
    const Vec2d last = place(step);
    const Box2d around{std::min(foot.x, last.x) - step, std::min(foot.y, last.y) - step,
                       std::max(foot.x, last.x) + step, std::max(foot.y, last.y) + step};
    const auto nearest_here = [&](double t) {
        return !search.strip.walls.any_nearer(place(t),
                                              search.strip.from + search.foot + t - kSlack);
    };
    const bool part = search.foot > 0.0;
    if ((part && !nearest_here(0.0)) ||
        (ball_ && 2.0 * proven(bounds_.near(around)) >= step && (!part || nearest_here(step)))) {
        return {along, 0.0, 0.0};
    }
    double end = step;
    if (!nearest_here(step)) {
        double good = 0.0;
        for (int i = 0; i < 8; ++i) {
            const double middle = 0.5 * (good + end);
            (nearest_here(middle) ? good : end) = middle;
        }
        end = good;
    }
    std::array<double, kPlaces + 1> found{};
    double largest = 0.0;
    double climb = 0.0;
    CrossLine result{along, 0.0, 0.0};
    const int n = std::max(1, static_cast<int>(std::ceil(places_ * end / step)));
    for (int i = 0; i <= n && largest < kEnough; ++i) {
        const Probe here = probe(place(end * i / n));
        if (i > 0) {
            const Probe& before = result.probes[static_cast<std::size_t>(i) - 1];
            largest = std::max(largest, left_between(before, here));
        }
        result.probes[static_cast<std::size_t>(i)] = here;
        result.count = i + 1;
        climb = i == 0 ? dot(here.gradient, tangent) : climb;
        const double stock_beside = uncut(here, search.stretches);
        found[static_cast<std::size_t>(i)] = stock_beside;
        largest = std::max(largest, stock_beside);
    }
    largest = std::max(largest, highest_between(found, static_cast<std::size_t>(n)));
    result.share = largest;
    result.climb = climb;
    return result;
}

// Beside a corner cross lines end early, where they meet those from its other side.
std::vector<double> LoopScallop::places_along(const Edge& edge, Corners corners, double step) const
{
    const double whole = length(edge);
    const int n = 1 + static_cast<int>(whole / apart_);
    std::vector<double> places{1.0};
    for (int i = 0; i < n; ++i) {
        places.push_back(static_cast<double>(i) / n);
    }
    for (const double steps : {0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5}) {
        const double along = steps * step / whole;
        if (corners.before && along < 1.0) {
            places.push_back(along);
        }
        if (corners.after && along < 1.0) {
            places.push_back(1.0 - along);
        }
    }
    std::sort(places.begin(), places.end());
    return places;
}

double LoopScallop::cross_lines_along(const Edge& edge, Corners corners, const Search& search) const
{
    const std::vector<double> places = places_along(edge, corners, search.step);
    CrossLine last = cross_line(edge, 0.0, search);
    double largest = last.share;
    for (std::size_t i = 1; i < places.size() && largest < kEnough; ++i) {
        const CrossLine next = cross_line(edge, places[i], search);
        largest = std::max(
            {largest, next.share, left_beside(last, next), between(edge, last, next, search)});
        last = next;
    }
    return largest;
}

double LoopScallop::between(const Edge& edge,
                            const CrossLine& a,
                            const CrossLine& b,
                            const Search& search) const
{
    constexpr double kNear = 0.6;
    constexpr double kEven = 0.1;
    const double apart = (b.along - a.along) * length(edge);
    const double largest = std::max(a.share, b.share);
    const bool uneven = largest > kNear && std::abs(a.share - b.share) > kEven;
    const bool turns_level = !ball_ && a.climb * b.climb < 0.0;
    if (apart < kNearestWays * floor_.tool().radius || largest > kEnough ||
        (!uneven && !turns_level)) {
        return 0.0;
    }
    const CrossLine middle = cross_line(edge, 0.5 * (a.along + b.along), search);
    return std::max(
        {middle.share, between(edge, a, middle, search), between(edge, middle, b, search)});
}

}  // namespace cusp::contour_pocket
