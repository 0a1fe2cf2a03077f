// What the floor is like under the tool: covered or not, slopes and curvatures.
#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::host {

namespace {

double excess(double low, double high, double x) { return std::max({low - x, 0.0, x - high}); }

}  // namespace

bool TipFloor::covers(Vec2d at) const
{
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
        if (std::max(piece.x1 - piece.x0, piece.y1 - piece.y0) < 0.1 * tool_.radius) {
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

TipFloor::Contact TipFloor::contact(Vec2d at, double slack) const
{
    const Rest rest = drop(at, slack);
    if (rest.height == kNothing) {
        return {kNothing, {}, {}, false};
    }
    const Piece& piece = pieces_[rest.piece];
    const Patch& patch = patches_[piece.patch];
    const auto middle = [](std::array<float, 2> ends) {
        return 0.5 * static_cast<double>(ends[0] + ends[1]);
    };
    const SurfacePoint s =
        derivatives_at(surfaces_[patch.surface], patch.u0 + (patch.u1 - patch.u0) * middle(piece.u),
                       patch.v0 + (patch.v1 - patch.v0) * middle(piece.v));
    const Vec3d n = upward_normal(s);
    const double bend = s.du.x * s.dv.y - s.du.y * s.dv.x;
    return {rest.height, s, n, std::abs(bend) >= 1e-12 && n.z >= 1e-3};
}

TipFloor::Section TipFloor::section(const Contact& contact, Vec2d along)
{
    if (!contact.found) {
        return {0.0, 0.0, 0.0, false};
    }
    const SurfacePoint& s = contact.surface;
    const Vec3d n = contact.normal;
    // du : dv of the plan direction: along = x_u du + x_v dv in plan.
    const double bend = s.du.x * s.dv.y - s.du.y * s.dv.x;
    const double du = (along.x * s.dv.y - along.y * s.dv.x) / bend;
    const double dv = (s.du.x * along.y - s.du.y * along.x) / bend;
    const Vec3d tangent = s.du * du + s.dv * dv;
    const Vec3d second = s.duu * (du * du) + s.duv * (2.0 * du * dv) + s.dvv * (dv * dv);
    const Vec2d gradient{-n.x / n.z, -n.y / n.z};
    return {-dot(second, n) / dot(tangent, tangent), tangent.z, dot(gradient, left_normal(along)),
            true};
}

}  // namespace cusp::host
