// Contacts of a ball: at a point of a surface, or under a point in plan.
#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/nearest_search.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::part_model {

using nurbs::SurfacePoint;

namespace {

constexpr int kUnderSteps = 8;         // of Newton's method
constexpr double kUnderSlack = 1e-10;  // mm in plan
constexpr double kLeastLean = 1e-9;    // sine: below it the offset is degenerate in plan

bool is_same(Vec3d a, Vec3d b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

bool is_same(const CcPoint& a, const CcPoint& b)
{
    return a.u == b.u && a.v == b.v && a.surface == b.surface && a.distance == b.distance &&
           is_same(a.point, b.point) && is_same(a.normal, b.normal);
}

}  // namespace

PartModel::State::KnownContact PartModel::State::known(const CcPoint& contact) const
{
    for (const std::optional<KnownContact>& known : history().known_contacts) {
        if (known && is_same(known->at, contact)) {
            return *known;
        }
    }
    return {contact};
}

void PartModel::State::remember(const KnownContact& contact) const
{
    History& last = history();
    for (std::optional<KnownContact>& known : last.known_contacts) {
        if (known && is_same(known->at, contact.at)) {
            known->cell = contact.cell;
            known->margin = std::max(known->margin, contact.margin);
            return;
        }
    }
    last.known_contacts[last.oldest_contact] = contact;
    last.oldest_contact = (last.oldest_contact + 1) % last.known_contacts.size();
}

std::pair<Vec3d, Vec3d> centre_slopes(const SurfacePoint& p, Vec3d normal, double distance)
{
    const Vec3d n = cross(p.du, p.dv);
    const double length = dot(n, normal);  // negative where the normal is turned
    const auto slope = [&](Vec3d first, Vec3d n_slope) {
        return first + (n_slope - normal * dot(n_slope, normal)) * (distance / length);
    };
    return {slope(p.du, cross(p.duu, p.dv) + cross(p.du, p.duv)),
            slope(p.dv, cross(p.duv, p.dv) + cross(p.du, p.dvv))};
}

CcPoint PartModel::cc_point(int surface, double u, double v, double distance) const
{
    constexpr double kNearPole = 1e-6;
    SurfacePoint p = tangents(surface, u, v);
    const double square_u = dot(p.du, p.du);
    const double square_v = dot(p.dv, p.dv);
    if (std::min(square_u, square_v) < kNearPole * kNearPole * std::max(square_u, square_v)) {
        p = evaluate(surface, u, v);  // at a pole the normal is in the second derivatives
    }
    return {surface, u, v, p.point, facing_up(surface, u, v, p), distance};
}

Vec3d PartModel::facing_up(int surface, double u, double v, const SurfacePoint& p) const
{
    constexpr double kLevel = 1e-7;   // z of a normal: rounding decides its sign
    constexpr double kBeside = 1e-4;  // of the domain
    const Vec3d normal = upward_normal(p);
    if (std::abs(normal.z) > kLevel || dot(normal, normal) == 0) {
        return normal;
    }
    const State::Grid& grid = state_->grids[static_cast<std::size_t>(surface)];
    const auto [u0, u1] = std::pair{grid.creases_u.front(), grid.creases_u.back()};
    const auto [v0, v1] = std::pair{grid.creases_v.front(), grid.creases_v.back()};
    // The highest neighbouring point that faces up decides: a bulge is touched from outside.
    std::optional<SurfacePoint> best;
    for (const auto& [du, dv] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const double at_u = std::clamp(u + kBeside * (u1 - u0) * du, u0, u1);
        const double at_v = std::clamp(v + kBeside * (v1 - v0) * dv, v0, v1);
        const SurfacePoint beside = evaluate(surface, at_u, at_v);
        if (upward_normal(beside).z > kLevel && inside_trims(surface, at_u, at_v) &&
            (!best || beside.point.z > best->point.z)) {
            best = beside;
        }
    }
    if (best) {
        return dot(upward_normal(*best), normal) < 0 ? -normal : normal;
    }
    // Else one side of the surface throughout, so that tips along a vertical line are on one side.
    const double leftward = normal.y * p.du.x - normal.x * p.du.y;
    const bool du_is_vertical = std::abs(leftward) <= kLevel * norm(p.du);
    return (du_is_vertical ? dot(normal, cross(p.du, p.dv)) : leftward) < 0 ? -normal : normal;
}

std::optional<CcPoint> PartModel::cc_point_under(
    double x, double y, int surface, Vec2d near, double distance) const
{
    const State::Grid& grid = state_->grids[static_cast<std::size_t>(surface)];
    CcPoint at{surface, near.x, near.y, {}, {}, distance};
    for (int step = 0; step < kUnderSteps; ++step) {
        if (!(at.u >= grid.creases_u.front() && at.u <= grid.creases_u.back() &&
              at.v >= grid.creases_v.front() && at.v <= grid.creases_v.back())) {
            return std::nullopt;
        }
        const SurfacePoint p = evaluate(surface, at.u, at.v);
        at.point = p.point;
        at.normal = facing_up(surface, at.u, at.v, p);
        const Vec3d miss = at.centre() - Vec3d{x, y, 0};
        if (elementary::hypot(miss.x, miss.y) < kUnderSlack) {
            return at;
        }
        const auto [by_u, by_v] = centre_slopes(p, at.normal, distance);
        const double det = by_u.x * by_v.y - by_u.y * by_v.x;
        const double size = elementary::hypot(by_u.x, by_u.y) * elementary::hypot(by_v.x, by_v.y);
        if (!(std::abs(det) > kLeastLean * size)) {
            return std::nullopt;
        }
        at.u -= (miss.x * by_v.y - miss.y * by_v.x) / det;
        at.v -= (miss.y * by_u.x - miss.x * by_u.y) / det;
    }
    return std::nullopt;
}

}  // namespace cusp::part_model
