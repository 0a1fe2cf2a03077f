// Pieces at the edge of a trimmed surface: what the edge leaves of a piece is bounded by one line
// along the edge, which becomes a side of the piece's outline.
#include <algorithm>
#include <cmath>

#include "host_tools/geometry/drop_cutter/drop_cutter_state.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::drop_cutter {

using offset::distance;
using offset::left_normal;
using offset::unit;
using part_model::TrimRegion;

namespace {

constexpr std::size_t kMostPoints = 200;  // of an edge: with more of them it is no line
constexpr double kRounding = 1e-9;        // mm

}  // namespace

// The extent of the remnant, with its error.
DropCutter::State::Side DropCutter::State::side_of(const Remnant& left, Vec2d across)
{
    Side side = Side::none(across);
    for (const Vec3d& p : left.points) {
        widen(side, in_plan(p));
    }
    const double by = left.error;
    return {across, side.inner - by, side.outer + by, side.low - by, side.high + by, 0.0, 0.0};
}

DropCutter::State::Domain DropCutter::State::domain_of(const Piece& piece) const
{
    const Patch& patch = patch_of(piece);
    const auto share = [](double from, double to, float at) {
        return from + (to - from) * static_cast<double>(at);
    };
    return {share(patch.u0, patch.u1, piece.u[0]), share(patch.u0, patch.u1, piece.u[1]),
            share(patch.v0, patch.v1, piece.v[0]), share(patch.v0, patch.v1, piece.v[1])};
}

// Updates whether an edge cuts the piece. A piece trimmed away becomes an empty box.
void DropCutter::State::trim(Piece& piece)
{
    if (!piece.cut) {
        return;
    }
    const Domain domain = domain_of(piece);
    const TrimRegion::Part part = floor_->trims[patch_of(piece).surface].remnant(
        domain.u0, domain.u1, domain.v0, domain.v1, in_domain_);
    piece.cut = part == TrimRegion::Part::kCut;
    if (part == TrimRegion::Part::kInside) {
        // The surface beside it may be trimmed away.
        piece.border = kAllSides;
        measure_outline(piece);
    }
    if (part == TrimRegion::Part::kCut) {
        measure_remnant(piece);
    }
    if (part == TrimRegion::Part::kOutside) {
        piece.graph = false;
        piece.x0 = piece.y0 = piece.z0 = kUnbounded;
        piece.x1 = piece.y1 = piece.z1 = -kUnbounded;
    }
}

// The piece differs from the parallelogram A(s, t) of its corners, s and t from 0 to 1 over its
// domain, by no more than its control points differ from A at their own s and t. Weights that
// differ shift s and t by a bound from their ratio.
void DropCutter::State::find_remnant(const Piece& piece)
{
    const Patch& patch = patch_of(piece);
    const std::size_t rows = patch.rows;
    const std::size_t columns = patch.columns;
    const Vec3d* const points = points_of(piece);
    const std::size_t size = rows * columns;
    const Vec3d c00 = points[0];
    const Vec3d c01 = points[columns - 1];
    const Vec3d c10 = points[(rows - 1) * columns];
    const Vec3d c11 = points[size - 1];
    const Vec3d by_s = ((c10 - c00) + (c11 - c01)) * 0.5;
    const Vec3d by_t = ((c01 - c00) + (c11 - c10)) * 0.5;
    const Vec3d middle = (c00 + c01 + c10 + c11) * 0.25;
    const auto on_plane = [&](double s, double t) {
        return middle + by_s * (s - 0.5) + by_t * (t - 0.5);
    };
    Remnant& left = remnant_;
    left.points.clear();
    left.error = 0.0;
    double least = kUnbounded;
    double most = 0.0;
    for (std::size_t k = 0; k < size; ++k) {
        const double s = static_cast<double>(k / columns) / static_cast<double>(rows - 1);
        const double t = static_cast<double>(k % columns) / static_cast<double>(columns - 1);
        left.error = std::max(left.error, norm(points[k] - on_plane(s, t)));
        const double weight = patch.weighted ? weights_[piece.net + k] : 1.0;
        least = std::min(least, weight);
        most = std::max(most, weight);
    }
    left.error += (most / least - 1.0) * (norm(by_s) + norm(by_t)) + kRounding;
    const Domain d = domain_of(piece);
    const auto place = [&](Vec2d at) {
        return on_plane((at.x - d.u0) / (d.u1 - d.u0), (at.y - d.v0) / (d.v1 - d.v0));
    };
    for (const Vec2d at : in_domain_.corners) {
        left.points.push_back(place(at));
    }
    left.edge = left.points.size();
    for (const Vec2d at : in_domain_.edge) {
        left.points.push_back(place(at));
    }
}

// The line along the edge's two ends, on the side beyond which less of the edge lies.
//
//   bow  set to how far the edge lies inside the side, mm
std::optional<DropCutter::State::Side> DropCutter::State::side_along(const Remnant& left,
                                                                     double& bow)
{
    const auto from = left.points.begin() + static_cast<std::ptrdiff_t>(left.edge);
    const auto farthest = [&](Vec2d p) {
        Vec2d most = in_plan(*from);
        double away = distance(most, p);
        for (auto at = from + 1; at != left.points.end(); ++at) {
            const double there = distance(in_plan(*at), p);
            if (away < there) {
                most = in_plan(*at);
                away = there;
            }
        }
        return most;
    };
    const Vec2d one = farthest(in_plan(*from));
    const Vec2d other = farthest(one);
    bow = 0.0;
    if (distance(one, other) < kRounding) {
        return std::nullopt;
    }
    std::optional<Side> best;
    bow = kUnbounded;
    const Vec2d normal = left_normal(unit(other - one));
    for (const Vec2d across : {normal, normal * -1.0}) {
        Side side = Side::none(across);
        for (const Vec3d& p : left.points) {
            widen(side, in_plan(p));
        }
        double least = kUnbounded;
        std::for_each(from, left.points.end(),
                      [&](Vec3d p) { least = std::min(least, dot(across, in_plan(p))); });
        if (side.outer - least < bow) {
            bow = side.outer - least;
            best = side;
        }
    }
    return best;
}

// Adds the side along the edge, or ends the outline at both edges of a sliver. Returns how far the
// edge lies inside, mm.
double DropCutter::State::end_at_edge(const Remnant& left, Outline& outline)
{
    double bow = 0.0;
    const std::optional<Side> along = side_along(left, bow);
    if (!along) {
        return bow;
    }
    const Vec2d across = along->across;
    const Vec2d forth = left_normal(across);
    const double width = along->outer - along->inner;
    // The sides of the piece's parallelogram, at an angle to a sliver, would leave too much of the
    // plane.
    if (bow > width - kRounding && width < along->high - along->low) {
        outline.count = 4;
        outline.sides = {side_of(left, across), side_of(left, across * -1.0), side_of(left, forth),
                         side_of(left, forth * -1.0)};
    } else {
        outline.sides[outline.count++] = side_of(left, across);
    }
    return bow;
}

void DropCutter::State::measure_remnant(Piece& piece)
{
    const bool measured = piece.outline != 0;
    Outline outline{};
    piece.outlined = false;
    if (!set_sides(piece, outline)) {
        piece.outline = 0;
        return;
    }
    find_remnant(piece);
    const Remnant& left = remnant_;
    if (left.edge == left.points.size() || left.points.size() > kMostPoints) {
        piece.outline = 0;
        return;
    }
    Vec3d low = left.points.front();
    Vec3d high = low;
    for (const Vec3d& p : left.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    piece.x0 = std::max(piece.x0, low.x - left.error);
    piece.y0 = std::max(piece.y0, low.y - left.error);
    piece.z0 = std::max(piece.z0, low.z - left.error);
    piece.x1 = std::min(piece.x1, high.x + left.error);
    piece.y1 = std::min(piece.y1, high.y + left.error);
    piece.z1 = std::min(piece.z1, high.z + left.error);
    for (std::size_t i = 0; i < outline.count; ++i) {
        Side& side = outline.sides[i];
        Side within = Side::none(side.across);
        for (const Vec3d& p : left.points) {
            widen(within, in_plan(p));
        }
        side.inner = std::max(side.inner, within.inner - left.error);
        side.outer = std::min(side.outer, within.outer + left.error);
        side.low = std::max(side.low, within.low - left.error);
        side.high = std::min(side.high, within.high + left.error);
    }
    const double bow = end_at_edge(left, outline);
    outline.bow = std::max(outline.bow, bow + 2.0 * left.error);
    end_sides(outline);
    piece.outlined = true;
    if (measured) {
        outlines_[piece.outline] = outline;
    } else {
        piece.outline = add_outline(outline);
    }
}

}  // namespace cusp::drop_cutter
