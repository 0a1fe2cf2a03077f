// The surface under the tool: whether there is one, and its contact, slopes and curvatures.
#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter_state.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::drop_cutter {

using nurbs::SurfacePoint;
using offset::left_normal;

namespace {

double middle_of(std::array<float, 2> ends) { return 0.5 * static_cast<double>(ends[0] + ends[1]); }

}  // namespace

// A piece without a known outline counts once its box is small.
bool DropCutter::State::covers(Vec2d at)
{
    const double fine = 0.1 * tool_.radius;
    std::vector<std::uint32_t> stack{kRoot};
    while (!stack.empty()) {
        const std::uint32_t index = stack.back();
        stack.pop_back();
        const Piece& piece = pieces_[index];
        if (excess(piece.x0, piece.x1, at.x) > 0.0 || excess(piece.y0, piece.y1, at.y) > 0.0) {
            continue;
        }
        if (piece.outline != 0 && beyond_outline(piece, at) > 0.0) {
            continue;
        }
        if ((piece.outlined && is_whole(piece, fine)) ||
            std::max(piece.x1 - piece.x0, piece.y1 - piece.y0) < fine) {
            return true;
        }
        if (piece.child == 0) {
            halve(index);
        }
        stack.push_back(pieces_[index].child);
        stack.push_back(pieces_[index].child + 1);
    }
    return false;
}

// u, v  of the piece's patch, 0 to 1
std::optional<DropCutter::CcPoint> DropCutter::State::cc_point_on(const Piece& piece,
                                                                  double height,
                                                                  double u,
                                                                  double v) const
{
    const Patch& patch = patch_of(piece);
    const SurfacePoint s =
        derivatives_at(floor_->surfaces[patch.surface], patch.u0 + (patch.u1 - patch.u0) * u,
                       patch.v0 + (patch.v1 - patch.v0) * v);
    const Vec3d n = upward_normal(s);
    const double bend = s.du.x * s.dv.y - s.du.y * s.dv.x;
    if (!(std::abs(bend) >= 1e-12 && n.z >= 1e-3)) {
        return std::nullopt;
    }
    return CcPoint{height, s, n};
}

std::optional<DropCutter::CcPoint> DropCutter::State::cc_point(Vec2d at, double max_error)
{
    const std::optional<ClPoint> cl = drop(at, max_error);
    if (!cl) {
        return std::nullopt;
    }
    const Piece& piece = pieces_[cl->piece];
    return cc_point_on(piece, cl->z, middle_of(piece.u), middle_of(piece.v));
}

// Two steps of Newton's method, from the middle of the piece, towards the place whose normal leads
// to the tool.
std::optional<DropCutter::CcPoint> DropCutter::State::exact_cc_point(Vec2d at, double max_error)
{
    const std::optional<ClPoint> cl = drop(at, max_error);
    if (!cl) {
        return std::nullopt;
    }
    constexpr int kSteps = 2;
    const Piece& piece = pieces_[cl->piece];
    const Patch& patch = patch_of(piece);
    const double corner = tool_.corner_radius;
    double u = middle_of(piece.u);
    double v = middle_of(piece.v);
    std::optional<CcPoint> contact = cc_point_on(piece, cl->z, u, v);
    for (int i = 0; i < kSteps && contact; ++i) {
        const SurfacePoint& s = contact->surface;
        const Vec3d n = contact->normal;
        const double steep = elementary::hypot(n.x, n.y);
        const double out = steep > 0.0 ? (tool_.radius - corner) / steep + corner : corner;
        const Vec2d aside = at - in_plan(n) * out - in_plan(s.point);
        const double bend = s.du.x * s.dv.y - s.du.y * s.dv.x;
        u += (aside.x * s.dv.y - aside.y * s.dv.x) / (bend * (patch.u1 - patch.u0));
        v += (s.du.x * aside.y - s.du.y * aside.x) / (bend * (patch.v1 - patch.v0));
        u = std::clamp(u, static_cast<double>(piece.u[0]), static_cast<double>(piece.u[1]));
        v = std::clamp(v, static_cast<double>(piece.v[0]), static_cast<double>(piece.v[1]));
        contact = cc_point_on(piece, cl->z, u, v);
    }
    return contact;
}

DropCutter::Section DropCutter::section(const CcPoint& contact, Vec2d direction)
{
    const SurfacePoint& s = contact.surface;
    const Vec3d n = contact.normal;
    // du : dv of the direction, which is x_u du + x_v dv in plan.
    const double bend = s.du.x * s.dv.y - s.du.y * s.dv.x;
    const double du = (direction.x * s.dv.y - direction.y * s.dv.x) / bend;
    const double dv = (s.du.x * direction.y - s.du.y * direction.x) / bend;
    const Vec3d tangent = s.du * du + s.dv * dv;
    const Vec3d second = s.duu * (du * du) + s.duv * (2.0 * du * dv) + s.dvv * (dv * dv);
    const Vec2d gradient{-n.x / n.z, -n.y / n.z};
    return {-dot(second, n) / dot(tangent, tangent), tangent.z,
            dot(gradient, left_normal(direction))};
}

}  // namespace cusp::drop_cutter
