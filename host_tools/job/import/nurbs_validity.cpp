// Checks of degree, counts, knots, weights and coordinates.
#include "host_tools/job/import/nurbs_validity.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/nurbs/spline_basis.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;
using nurbs::distinct_knots;
using nurbs::kMaximumDegree;
using nurbs::multiplicity;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

// One parameter direction: names are "" for a curve, "_u" or "_v" for a surface.
struct Direction {
    const char* suffix;
    int degree;
    std::size_t count;
    const std::vector<double>& knots;
};

void check_knots(const Direction& d, const std::string& place)
{
    for (std::size_t i = 0; i < d.knots.size(); ++i) {
        if (!std::isfinite(d.knots[i])) {
            throw InputError(
                fmt::format("{}: knotvector{}[{}] is not a finite number", place, d.suffix, i));
        }
        if (i > 0 && d.knots[i] < d.knots[i - 1]) {
            throw InputError(fmt::format("{}: knotvector{}[{}] is {}, below the {} before it",
                                         place, d.suffix, i, d.knots[i], d.knots[i - 1]));
        }
    }
    const auto p = static_cast<std::size_t>(d.degree);
    if (!(d.knots[p] < d.knots[d.count])) {
        throw InputError(fmt::format("{}: knotvector{} leaves no domain: it begins and ends at {}",
                                     place, d.suffix, d.knots[p]));
    }
    const double domain = d.knots[d.count] - d.knots[p];
    if (!(domain <= kLargestDomain && domain >= 1 / kLargestDomain)) {
        throw InputError(fmt::format("{}: knotvector{} is {} long, it must be {} to {}", place,
                                     d.suffix, domain, 1 / kLargestDomain, kLargestDomain));
    }
    for (const double u : distinct_knots(d.knots, d.degree, d.count)) {
        const std::size_t times = multiplicity(d.knots, u);
        const bool inside = u > d.knots[p] && u < d.knots[d.count];
        if (inside && times > p) {
            throw InputError(
                fmt::format("{}: knotvector{} holds {} {} times inside the domain, "
                            "at most {} (the degree) keep it in one piece",
                            place, d.suffix, u, times, d.degree));
        }
        if (times > p + 1) {
            throw InputError(
                fmt::format("{}: knotvector{} holds {} {} times, at most {} (the "
                            "degree and one) leave every control point some of it",
                            place, d.suffix, u, times, p + 1));
        }
    }
}

void check_direction(const Direction& d, const std::string& place)
{
    if (d.degree < 1 || d.degree > kMaximumDegree) {
        throw InputError(fmt::format("{}: degree{} is {}, allowed are 1 to {}", place, d.suffix,
                                     d.degree, kMaximumDegree));
    }
    const auto needed = static_cast<std::size_t>(d.degree) + 1;
    if (d.count < needed) {
        throw InputError(fmt::format("{}: {} control points{}, degree {} needs at least {}", place,
                                     d.count, d.suffix, d.degree, needed));
    }
    if (d.knots.size() != d.count + needed) {
        throw InputError(
            fmt::format("{}: knotvector{} holds {} numbers, {} control points of "
                        "degree {} need {}",
                        place, d.suffix, d.knots.size(), d.count, d.degree, d.count + needed));
    }
    check_knots(d, place);
}

void check_weight_ratio(const std::vector<double>& weights, const std::string& place)
{
    const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
    if (*most > kLargestWeightRatio * *least) {
        throw InputError(
            fmt::format("{}: weight {} is {}, weight {} is {}: the larger may be {} "
                        "times the smaller at most",
                        place, least - weights.begin(), *least, most - weights.begin(), *most,
                        kLargestWeightRatio));
    }
}

void check_points(const std::vector<Vec3d>& points,
                  const std::vector<double>& weights,
                  const std::string& place,
                  double largest)
{
    if (weights.size() != points.size()) {
        throw InputError(fmt::format("{}: {} weights for {} control points", place, weights.size(),
                                     points.size()));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            const double value = points[i][axis];
            if (!(std::abs(value) <= largest)) {
                throw InputError(fmt::format("{}: control point {} has {} = {} mm, the limit is {}",
                                             place, i, "xyz"[axis], value, largest));
            }
        }
        if (!(weights[i] > 0) || !std::isfinite(weights[i])) {
            throw InputError(
                fmt::format("{}: weight {} is {}, it must be above 0", place, i, weights[i]));
        }
    }
    check_weight_ratio(weights, place);
}

bool has_area(const Surface& surface)
{
    constexpr int kSamples = 9;
    for (int i = 1; i < kSamples; ++i) {
        for (int j = 1; j < kSamples; ++j) {
            const double a = static_cast<double>(i) / kSamples;
            const double b = static_cast<double>(j) / kSamples;
            const SurfacePoint s =
                derivatives_at(surface, surface.u_begin() * (1 - a) + surface.u_end() * a,
                               surface.v_begin() * (1 - b) + surface.v_end() * b);
            if (norm(upward_normal(s)) > 0) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace

void merge_close_knots(std::vector<double>& knots)
{
    if (knots.empty()) {
        return;
    }
    const double close = 1e-15 * (knots.back() - knots.front());
    for (std::size_t i = 1; i < knots.size(); ++i) {
        if (knots[i] > knots[i - 1] && knots[i] <= knots[i - 1] + close) {
            knots[i] = knots[i - 1];
        }
    }
}

void check_curve(const Curve& curve, const std::string& place, double largest)
{
    check_direction({"", curve.degree, curve.points.size(), curve.knots}, place);
    check_points(curve.points, curve.weights, place, largest);
}

void check_surface(const Surface& surface, const std::string& place)
{
    if (surface.size_u < 0 || surface.size_v < 0) {
        throw InputError(fmt::format("{}: size_u is {}, size_v {}; neither may be negative", place,
                                     surface.size_u, surface.size_v));
    }
    const auto size_u = static_cast<std::size_t>(surface.size_u);
    const auto size_v = static_cast<std::size_t>(surface.size_v);
    if (surface.points.size() != size_u * size_v) {
        throw InputError(fmt::format("{}: {} control points, size_u x size_v = {} x {} needs {}",
                                     place, surface.points.size(), size_u, size_v,
                                     size_u * size_v));
    }
    check_direction({"_u", surface.degree_u, size_u, surface.knots_u}, place);
    check_direction({"_v", surface.degree_v, size_v, surface.knots_v}, place);
    check_points(surface.points, surface.weights, place, kLargestCoordinate);
    if (!has_area(surface)) {
        throw InputError(place + ": the surface has no area: its control points lie on a line");
    }
}

}  // namespace cusp::import
