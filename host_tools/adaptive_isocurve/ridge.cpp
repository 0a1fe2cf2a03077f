// One pass leaves more the farther from it, the other less: the ridge is where both leave the same.
#include "host_tools/adaptive_isocurve/ridge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/adaptive_isocurve/scallop_width.hpp"

namespace cusp::host {
namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();
constexpr int kTurns = 8;
constexpr double kBeside = 0.01;  // of the way to the neighbour
constexpr double kLeastShare = 0.1;
constexpr double kToldApart = 0.995;

}  // namespace

Ridges::Sweep Ridges::sweep_at(CurvePlace place, double towards)
{
    const SurfacePoint p = cut_->at(place.v);
    Vec3d normal = upward_normal(p);
    // Rounding decides which side of a level normal is up: the surface beside it tells.
    if (normal.z < kLevelNormal &&
        dot(normal, upward_normal(cut_->at(place.v + kBeside * (towards - place.v)))) < 0) {
        normal = -normal;
    }
    const Vec3d along = p.du + p.dv * place.slope;
    return {place, p.point + normal * (tool_.radius + tool_.outward),
            along / std::max(1e-300, norm(along))};
}

// What it leaves over the point along its normal.
double Ridges::Sweep::left(Vec3d p, Vec3d normal, double radius) const
{
    Vec3d q = p - centre;
    q = q - tangent * dot(q, tangent);
    const Vec3d n = normal - tangent * dot(normal, tangent);
    const double a = dot(n, n);
    const double b = dot(q, n);
    const double square = b * b - a * (dot(q, q) - radius * radius);
    if (square < 0 || a == 0) {
        return kUnreached;
    }
    return (-b - std::sqrt(square)) / a;
}

double Ridges::between(double u, CurvePlace low_place, CurvePlace high_place, double enough)
{
    if (!cut_ || u != u_) {
        cut_.emplace(model_.cut_at(surface_, u));
        u_ = u;
        last_.reset();
    }
    const bool known =
        last_ && last_->place.v == low_place.v && last_->place.slope == low_place.slope;
    const Sweep low = known ? *last_ : sweep_at(low_place, high_place.v);
    const Sweep high = sweep_at(high_place, low_place.v);
    last_ = high;
    double from = low_place.v;
    double to = high_place.v;
    double bound = kUnreached;
    const double width = to - from;
    double v = from + share_ * width;
    for (int turn = 0; turn < kTurns; ++turn) {
        const SurfacePoint p = cut_->at(v);
        const Vec3d normal = upward_normal(p);
        const double by_low = low.left(p.point, normal, tool_.radius);
        const double by_high = high.left(p.point, normal, tool_.radius);
        bound = std::min(bound, std::max(by_low, by_high));
        const double excess = by_low - by_high;
        if (bound <= enough || excess == 0 || std::abs(excess) < 0.002 * bound) {
            if (width > 0) {
                share_ = std::clamp((v - low_place.v) / width, kLeastShare, 1 - kLeastShare);
            }
            break;
        }
        (excess > 0 ? to : from) = v;
        // The difference is nearly linear across, and as large at the ends as the step is wide.
        const double scale = std::isfinite(excess) ? 2 * std::max(by_low, by_high) : kUnreached;
        const double guess = v - 0.5 * width * excess / (2 * scale);
        v = std::isfinite(guess) && guess > from && guess < to ? guess : 0.5 * (from + to);
    }
    return bound;
}

Ridges::Highest Ridges::highest(
    const std::vector<DomainCurve>& curves, double u_begin, double u_end, int count, double allowed)
{
    const double enough = std::isfinite(allowed) ? kToldApart * allowed : 0;
    const double width = (u_end - u_begin) / count;
    Highest out{0, {}};
    for (int k = 0; k <= count; ++k) {
        const double u = u_begin + width * k;
        const std::vector<CurvePlace> across = places_at(curves, u);
        for (std::size_t j = 1; j < across.size(); ++j) {
            const CurvePlace low = across[j - 1];
            const CurvePlace high = across[j];
            const double ridge = between(u, low, high, enough);
            if (ridge <= allowed) {
                out.ridge = std::max(out.ridge, ridge);
            } else {
                out.open.push_back({std::max(u_begin, u - width), std::min(u_end, u + width),
                                    low.v - width * std::abs(low.slope),
                                    high.v + width * std::abs(high.slope)});
            }
        }
    }
    return out;
}

}  // namespace cusp::host
