// The ridge between two passes is the point over which both leave the same height.
#include "host_tools/cam/adaptive_isocurve/isocurve_scallop.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/adaptive_isocurve/cross_section.hpp"

namespace cusp::adaptive_isocurve {

using nurbs::SurfacePoint;
using part_model::centre_slopes;

namespace {

constexpr int kTurns = 8;
constexpr double kBeside = 0.01;  // of the distance to the neighbour
constexpr double kLeastShare = 0.1;
constexpr double kResolution = 0.995;
constexpr int kFollowed = 4;  // steps along a pass
// Share of radius times height left: a pass as tightly curved as the ball, so far along (squared),
// deviates from its tangent by a hundredth of the height.
constexpr double kStraight = 0.02;

// The parameter at which the line from `q` along `n` enters a ball around the origin.
double entry(Vec3d q, Vec3d n, double radius)
{
    const double a = dot(n, n);
    const double b = dot(q, n);
    const double square = b * b - a * (dot(q, q) - radius * radius);
    return square < 0 || a == 0 ? kInfinite : (-b - std::sqrt(square)) / a;
}

}  // namespace

IsocurveScallop::Sweep IsocurveScallop::sweep_at(double u, CurvePlace place, double towards)
{
    const SurfacePoint p =
        u == u_ ? cut_->bends_at(place.v) : model_.evaluate(surface_, u, place.v);
    Vec3d normal = upward_normal(p);
    // Rounding decides the sign of a horizontal normal: the surface beside it is used instead.
    if (normal.z < kLevelNormal &&
        dot(normal, upward_normal(model_.tangents(surface_, u,
                                                  place.v + kBeside * (towards - place.v)))) < 0) {
        normal = -normal;
    }
    // On a twisted surface the centre does not move along the surface's tangent.
    const double distance = tool_.radius + tool_.outward;
    const auto [by_u, by_v] = centre_slopes(p, normal, distance);
    Vec3d along = by_u + by_v * place.slope;
    if (!std::isfinite(norm(along))) {
        along = p.du + p.dv * place.slope;  // at a pole
    }
    const double rate = std::max(1e-300, norm(along));
    return {place, u, p.point + normal * distance, along / rate, rate};
}

IsocurveScallop::Uncut IsocurveScallop::uncut_by(const Sweep& sweep, Vec3d p, Vec3d normal) const
{
    const Vec3d arm = p - sweep.centre;
    const double along = dot(arm, sweep.tangent);
    const double rise = dot(normal, sweep.tangent);
    const double height =
        entry(arm - sweep.tangent * along, normal - sweep.tangent * rise, tool_.radius);
    return {height, along + (std::isfinite(height) ? height * rise : 0.0)};
}

bool IsocurveScallop::counts_as_straight(const Uncut& left) const
{
    const double height = std::isfinite(left.height) ? left.height : tool_.radius;
    return left.ahead * left.ahead <= kStraight * tool_.radius * height;
}

// Moves the sweep along its pass to the nearest point, or to the end. If that does not converge,
// in bends, the least height left by the balls on the way.
double IsocurveScallop::uncut_by_pass(Sweep& sweep, double towards, Vec3d p, Vec3d normal)
{
    const DomainCurve& curve = *sweep.place.curve;
    double least = kInfinite;
    for (int k = 0; k <= kFollowed; ++k) {
        const Uncut left = uncut_by(sweep, p, normal);
        if (counts_as_straight(left)) {
            return std::min(least, left.height);
        }
        least = std::min(least, entry(p - sweep.centre, normal, tool_.radius));
        const double u =
            std::clamp(sweep.u + left.ahead / sweep.rate, curve.u.front(), curve.u.back());
        if (u == sweep.u) {
            break;
        }
        CurvePlace place = curve.place_at(u);
        place.curve = &curve;
        sweep = sweep_at(u, place, towards);
    }
    return least;
}

double IsocurveScallop::between(double u,
                                CurvePlace low_place,
                                CurvePlace high_place,
                                double sufficient)
{
    if (!cut_ || u != u_) {
        cut_.emplace(model_.cut_at(surface_, u));
        u_ = u;
        last_.reset();
    }
    const bool known =
        last_ && last_->place.v == low_place.v && last_->place.slope == low_place.slope;
    const Sweep low = known ? *last_ : sweep_at(u, low_place, high_place.v);
    const Sweep high = sweep_at(u, high_place, low_place.v);
    last_ = high;
    const double straight = balanced(low, high, sufficient, false);
    if (low_place.curve == nullptr || high_place.curve == nullptr) {
        return straight;
    }
    const SurfacePoint p = cut_->at(low_place.v + share_ * (high_place.v - low_place.v));
    const Vec3d normal = upward_normal(p);
    const bool alike = counts_as_straight(uncut_by(low, p.point, normal)) &&
                       counts_as_straight(uncut_by(high, p.point, normal));
    return alike ? straight : balanced(low, high, sufficient, true);
}

// The scallop height where both passes leave the same.
double IsocurveScallop::balanced(Sweep low, Sweep high, double sufficient, bool follow)
{
    const double begin = low.place.v;
    const double end = high.place.v;
    const double width = end - begin;
    double from = begin;
    double to = end;
    double bound = kInfinite;
    double v = from + share_ * width;
    for (int turn = 0; turn < kTurns; ++turn) {
        const SurfacePoint p = cut_->at(v);
        const Vec3d normal = upward_normal(p);
        const double by_low = follow ? uncut_by_pass(low, end, p.point, normal)
                                     : uncut_by(low, p.point, normal).height;
        const double by_high = follow ? uncut_by_pass(high, begin, p.point, normal)
                                      : uncut_by(high, p.point, normal).height;
        bound = std::min(bound, std::max(by_low, by_high));
        const double excess = by_low - by_high;
        if (bound <= sufficient || excess == 0 || std::abs(excess) < 0.002 * bound) {
            if (width > 0) {
                share_ = std::clamp((v - begin) / width, kLeastShare, 1 - kLeastShare);
            }
            break;
        }
        (excess > 0 ? to : from) = v;
        // The difference is nearly linear across; its size at the ends is about the stepover.
        const double scale = std::isfinite(excess) ? 2 * std::max(by_low, by_high) : kInfinite;
        const double guess = v - 0.5 * width * excess / (2 * scale);
        v = std::isfinite(guess) && guess > from && guess < to ? guess : 0.5 * (from + to);
    }
    return bound;
}

IsocurveScallop::Highest IsocurveScallop::highest(
    const std::vector<DomainCurve>& curves, double u_begin, double u_end, int count, double allowed)
{
    const double sufficient = std::isfinite(allowed) ? kResolution * allowed : 0;
    const double width = (u_end - u_begin) / count;
    Highest out{0, {}};
    for (int k = 0; k <= count; ++k) {
        const double u = u_begin + width * k;
        const std::vector<CurvePlace> across = places_at(curves, u);
        for (std::size_t j = 1; j < across.size(); ++j) {
            const CurvePlace low = across[j - 1];
            const CurvePlace high = across[j];
            const double scallop_height = between(u, low, high, sufficient);
            if (scallop_height <= allowed) {
                out.scallop_height = std::max(out.scallop_height, scallop_height);
            } else {
                out.open.push_back({std::max(u_begin, u - width), std::min(u_end, u + width),
                                    low.v - width * std::abs(low.slope),
                                    high.v + width * std::abs(high.slope)});
            }
        }
    }
    return out;
}

}  // namespace cusp::adaptive_isocurve
