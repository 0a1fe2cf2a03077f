// The centres of a fillet's sections are one point each; beyond both of its sides the part goes on along the tangent.
#include "host_tools/job/import/cad_fillets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::import {

using job::PartFillets;
using nurbs::Surface;

namespace {

using Triangle = std::array<Vec3d, 3>;

constexpr int kAlong = 25;               // sections
constexpr int kAcross = 9;               // samples of a section
constexpr double kOneRadius = 1e-3;      // of it
constexpr double kSameRadius = 1e-3;     // mm
constexpr double kUprightFillet = 1e-5;  // z of a unit normal
constexpr double kLeastTurn = 5;         // degrees
constexpr double kMostTurn = 175;

struct Fillet {
    double radius;
    bool concave;
    double length;
    double turn;  // radians across
    bool is_upright;
    Vec3d centre;     // of the middle section
    Vec3d direction;  // of the way of the centres there, unit
    // Beyond both sides of the middle section, on its tangents.
    std::array<Vec3d, 2> beyond;
    double step;  // mm: how far
};

struct Look {
    Vec3d point;
    Vec3d normal;  // unit, out of the solid; 0 at a pole
};

// along   of its parameters from 0 to 1, and the other one
// by_u    sections run along u
Look look_at(const Surface& surface, double outwards, bool by_u, double along, double across)
{
    const double u = by_u ? across : along;
    const double v = by_u ? along : across;
    const nurbs::SurfacePoint p =
        derivatives_at(surface, surface.u_begin() + u * (surface.u_end() - surface.u_begin()),
                       surface.v_begin() + v * (surface.v_end() - surface.v_begin()));
    const Vec3d n = cross(p.du, p.dv);
    constexpr double kPole = 1e-9;
    const double sides = norm(p.du) + norm(p.dv);
    return {p.point, norm(n) > kPole * sides * sides ? n * (outwards / norm(n)) : Vec3d{}};
}

struct Section {
    double radius;  // below 0: concave
    Vec3d centre;
    double turn;  // radians
};

std::optional<Section> section_of(const std::vector<Look>& looks)
{
    const Vec3d turned = looks.back().normal - looks.front().normal;
    Section section{0, {}, 0};
    for (std::size_t k = 0; k + 1 < looks.size(); ++k) {
        if (norm(looks[k].normal) == 0 || norm(looks[k + 1].normal) == 0) {
            return std::nullopt;
        }
        section.turn +=
            2 * elementary::asin(std::min(1.0, norm(looks[k + 1].normal - looks[k].normal) / 2));
    }
    if (section.turn < kLeastTurn * kPi / 180 || section.turn > kMostTurn * kPi / 180) {
        return std::nullopt;
    }
    section.radius = dot(looks.back().point - looks.front().point, turned) / dot(turned, turned);
    section.centre = looks.front().point - looks.front().normal * section.radius;
    const double off = std::max(kSameRadius, kOneRadius * std::abs(section.radius));
    for (const Look& look : looks) {
        if (norm(look.point - look.normal * section.radius - section.centre) > off) {
            return std::nullopt;
        }
    }
    return section;
}

std::optional<Fillet> fillet_of(const Surface& surface, double outwards, bool by_u)
{
    Fillet fillet{0, false, 0, 0, true, {}, {}, {}, 0};
    Vec3d before{};
    std::vector<Vec3d> centres;
    for (int i = 0; i < kAlong; ++i) {
        const double along = static_cast<double>(i) / (kAlong - 1);
        std::vector<Look> looks;
        for (int k = 0; k < kAcross; ++k) {
            looks.push_back(
                look_at(surface, outwards, by_u, along, static_cast<double>(k) / (kAcross - 1)));
            fillet.is_upright =
                fillet.is_upright && std::abs(looks.back().normal.z) <= kUprightFillet;
        }
        const std::optional<Section> section = section_of(looks);
        if (!section) {
            return std::nullopt;
        }
        const double radius = std::abs(section->radius);
        if (i > 0 &&
            std::abs(radius - fillet.radius) > std::max(kSameRadius, kOneRadius * radius)) {
            return std::nullopt;
        }
        const Vec3d middle = looks[kAcross / 2].point;
        fillet.length += i > 0 ? norm(middle - before) : 0.0;
        before = middle;
        centres.push_back(section->centre);
        fillet.radius = radius;
        fillet.concave = section->radius < 0;
        fillet.turn = std::max(fillet.turn, section->turn);
        if (i == kAlong / 2) {
            constexpr double kBeyond = 0.1;  // of the radius
            fillet.step = std::max(kBeyond * radius, 0.05);
            fillet.centre = section->centre;
            const Vec3d axis = cross(looks.front().normal, looks[1].normal);
            const auto on_tangent = [&](const Look& look, double sign) {
                const Vec3d way = cross(axis, look.normal);  // towards the other samples, if convex
                const double turned = (fillet.concave ? -sign : sign) / norm(way);
                return look.point + way * (turned * fillet.step);
            };
            fillet.beyond = {on_tangent(looks.front(), -1), on_tangent(looks.back(), 1)};
        }
    }
    const Vec3d way = centres[kAlong / 2 + 1] - centres[kAlong / 2 - 1];
    if (!(norm(way) > fillet.radius * kOneRadius)) {
        return std::nullopt;  // a ball
    }
    fillet.direction = way * (1 / norm(way));
    return fillet;
}

double distance_to_triangle(Vec3d p, const Triangle& t)
{
    const Vec3d n = cross(t[1] - t[0], t[2] - t[0]);
    double least = kUnbounded;
    bool inside = norm(n) > 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d a = t[k];
        const Vec3d side = t[(k + 1) % 3] - a;
        const double size = dot(side, side);
        const double share = size > 0 ? std::clamp(dot(p - a, side) / size, 0.0, 1.0) : 0.0;
        least = std::min(least, norm(p - a - side * share));
        inside = inside && dot(cross(n, side), p - a) >= 0;
    }
    return inside ? std::min(least, std::abs(dot(n, p - t[0])) / norm(n)) : least;
}

bool is_near(Vec3d p, const std::vector<Triangle>& triangles, double reach)
{
    return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
        const auto beside = [&](double Vec3d::*axis) {
            return std::min({t[0].*axis, t[1].*axis, t[2].*axis}) > p.*axis + reach ||
                   std::max({t[0].*axis, t[1].*axis, t[2].*axis}) < p.*axis - reach;
        };
        return !beside(&Vec3d::x) && !beside(&Vec3d::y) && !beside(&Vec3d::z) &&
               distance_to_triangle(p, t) <= reach;
    });
}

// True if both are parts of one cylinder.
bool share_axis(const Fillet& a, const Fillet& b)
{
    const double off = std::max(kSameRadius, kOneRadius * a.radius);
    return a.concave == b.concave && std::abs(a.radius - b.radius) <= off &&
           norm(cross(a.direction, b.direction)) <= kOneRadius &&
           norm(cross(b.centre - a.centre, a.direction)) <= off;
}

}  // namespace

std::vector<PartFillets> fillets_of(const CadModel& model)
{
    std::vector<Fillet> all;
    for (std::size_t k = 0; k < model.faces.size(); ++k) {
        if (model.outwards[k] == 0) {
            continue;
        }
        const auto by_u = fillet_of(model.faces[k], model.outwards[k], true);
        const auto by_v = fillet_of(model.faces[k], model.outwards[k], false);
        if (by_u.has_value() != by_v.has_value()) {
            all.push_back(by_u ? *by_u : *by_v);
        }
    }
    std::vector<PartFillets> found;
    for (const Fillet& one : all) {
        double around = 0;
        for (const Fillet& other : all) {
            around += share_axis(one, other) ? other.turn : 0.0;
        }
        constexpr double kWhole = 1.9 * kPi;
        constexpr double kTangent = 0.2;  // of the step
        const auto goes_on = [&](Vec3d p) {
            return is_near(p, model.triangles, kTangent * one.step);
        };
        if ((one.concave && one.is_upright) || around > kWhole || !goes_on(one.beyond[0]) ||
            !goes_on(one.beyond[1])) {
            continue;
        }
        const auto kind = std::find_if(found.begin(), found.end(), [&](const PartFillets& other) {
            return other.concave == one.concave &&
                   std::abs(other.radius - one.radius) <= kSameRadius;
        });
        if (kind == found.end()) {
            found.push_back({one.radius, one.concave, 1, one.length});
        } else {
            ++kind->count;
            kind->length += one.length;
        }
    }
    std::sort(found.begin(), found.end(), [](const PartFillets& a, const PartFillets& b) {
        return std::tuple(!a.concave, a.radius) < std::tuple(!b.concave, b.radius);
    });
    return found;
}

}  // namespace cusp::import
