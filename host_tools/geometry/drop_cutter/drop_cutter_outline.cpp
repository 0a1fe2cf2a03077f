// Outlines of pieces at the border of a surface: without them a tool would rest on the corners of
// the box of a rotated piece, where there is no surface.
#include <algorithm>
#include <cmath>

#include "host_tools/geometry/drop_cutter/drop_cutter_state.hpp"
#include "host_tools/geometry/drop_cutter/edge_contact.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::drop_cutter {

using offset::distance;
using offset::left_normal;
using offset::unit;

namespace {

constexpr double kEven = 1e-9;  // of a unit vector: along an axis

}  // namespace

// Cuts each outer line at the lines of the other sides, a nanometre outside. If a line lies
// outside the others its end is less than its begin.
void DropCutter::State::end_sides(Outline& outline)
{
    constexpr double kOver = 1e-9;  // mm
    for (std::size_t i = 0; i < outline.count; ++i) {
        Side& side = outline.sides[i];
        const Vec2d along = left_normal(side.across);
        side.begin = -kUnbounded;
        side.end = kUnbounded;
        for (std::size_t k = 0; k < outline.count; ++k) {
            const Side& other = outline.sides[k];
            const double bend = dot(other.across, along);
            const double room = other.outer - dot(other.across, side.across) * side.outer + kOver;
            if (bend > kEven) {
                side.end = std::min(side.end, room / bend);
            } else if (bend < -kEven) {
                side.begin = std::max(side.begin, room / bend);
            } else if (room < 0.0) {
                side.end = -kUnbounded;
            }
        }
    }
}

// The four sides of a piece, in order; false where one has no length.
bool DropCutter::State::set_sides(const Piece& piece, Outline& outline) const
{
    const Vec3d* const points = points_of(piece);
    const Patch& patch = patch_of(piece);
    const std::size_t rows = patch.rows;
    const std::size_t columns = patch.columns;
    const std::size_t last = (rows - 1) * columns;
    struct Row {
        std::size_t first, step, count;
        std::uint8_t border;
    };
    const std::array<Row, 4> all{
        Row{0, 1, columns, kFirstRow}, Row{columns - 1, columns, rows, kLastColumn},
        Row{last, 1, columns, kLastRow}, Row{0, columns, rows, kFirstColumn}};
    const Vec2d middle = (in_plan(points[0]) + in_plan(points[columns - 1]) +
                          in_plan(points[last]) + in_plan(points[last + columns - 1])) *
                         0.25;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Row& row = all[i];
        const Vec2d a = in_plan(points[row.first]);
        const Vec2d b = in_plan(points[row.first + row.step * (row.count - 1)]);
        if (distance(a, b) == 0.0) {
            return false;
        }
        const Vec2d left = left_normal(unit(b - a));
        const Vec2d across = dot(middle - a, left) > 0.0 ? left * -1.0 : left;
        Side side = Side::none(across);
        for (std::size_t k = 0; k < last + columns; ++k) {
            widen(side, in_plan(points[k]));
        }
        // At a piece cut by an edge, the surface continues beyond sides that are not its border.
        for (std::size_t k = 0; k < row.count && (!piece.cut || (piece.border & row.border) != 0);
             ++k) {
            const Vec2d p = in_plan(points[row.first + row.step * k]);
            outline.bow = std::max(outline.bow, side.outer - dot(across, p));
        }
        outline.sides[i] = side;
    }
    return true;
}

void DropCutter::State::widen(Side& side, Vec2d p)
{
    const double out = dot(side.across, p);
    const double forth = dot(left_normal(side.across), p);
    side.inner = std::min(side.inner, out);
    side.outer = std::max(side.outer, out);
    side.low = std::min(side.low, forth);
    side.high = std::max(side.high, forth);
}

void DropCutter::State::measure_outline(Piece& piece)
{
    piece.outline = 0;
    piece.outlined = false;
    Outline outline{};
    if (piece.border == 0 || !set_sides(piece, outline)) {
        return;
    }
    piece.outlined = true;
    end_sides(outline);
    piece.outline = add_outline(outline);
}

// Lower bound of the distance of a point outside the outline, mm; 0 or less inside.
double DropCutter::State::beyond_outline(const Piece& piece, Vec2d at) const
{
    double most = -kUnbounded;
    for (const Side& side : outlines_[piece.outline]) {
        most = std::max(most, dot(side.across, at) - side.outer);
    }
    return most;
}

// The highest contact of the tool with the sides of the outline that face it, where it touches the
// piece's plane outside the outline. None where it reaches no such side.
std::optional<DropCutter::State::PlaneContact> DropCutter::State::on_outline(const Piece& piece,
                                                                             Vec2d at) const
{
    const Vec2d g = piece.gradient;
    const double here = piece.z_at_origin + dot(g, at);
    const Vec2d contact = at + g * piece.contact;
    std::optional<PlaneContact> best;
    for (const Side& side : outlines_[piece.outline]) {
        if (dot(contact, side.across) > side.outer) {
            const Vec2d along = left_normal(side.across);
            const double away = side.outer - dot(at, side.across);
            const double forth = dot(at, along);
            const auto edge =
                drop_on_edge(tool_, {dot(g, along), away, side.begin - forth, side.end - forth});
            if (!edge) {
                continue;
            }
            const double height = here + dot(g, side.across) * away + edge->lift;
            if (!best || height > best->height) {
                best = {height, at + side.across * away + along * edge->along};
            }
        }
    }
    return best;
}

// The place where the tool over `at` touches the piece's plane, or the edge of the piece.
Vec2d DropCutter::State::on_piece(const Piece& piece, Vec2d at) const
{
    const Vec2d contact = at + piece.gradient * piece.contact;
    const Vec2d place{std::clamp(contact.x, piece.x0, piece.x1),
                      std::clamp(contact.y, piece.y0, piece.y1)};
    if (!piece.graph) {
        return place;
    }
    if (piece.outline != 0 && beyond_outline(piece, contact) <= 0.0) {
        return contact;
    }
    const auto edge = piece.outline != 0 ? on_outline(piece, at) : on_edges(piece, at);
    return edge ? edge->place : place;
}

// Lower bound (mm) of the distance between segment ab and the boxes turned with the outline, with
// everything below them.
double DropCutter::State::apart_from_outline(const Piece& piece, Vec3d a, Vec3d b) const
{
    const auto apart = [](double low, double high, double p, double q) {
        return std::max(0.0, std::max(low - std::max(p, q), std::min(p, q) - high));
    };
    const double uz = std::max(0.0, std::min(a.z, b.z) - piece.z1);
    double square = 0.0;
    for (const Side& side : outlines_[piece.outline]) {
        const auto out = [&](Vec3d p) {
            return dot(side.across, in_plan(p));
        };
        const auto forth = [&](Vec3d p) {
            return dot(left_normal(side.across), in_plan(p));
        };
        const double ux = apart(side.inner, side.outer, out(a), out(b));
        const double uy = apart(side.low, side.high, forth(a), forth(b));
        square = std::max(square, ux * ux + uy * uy + uz * uz);
    }
    return std::sqrt(square);
}

}  // namespace cusp::drop_cutter
