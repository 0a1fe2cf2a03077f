// Where a piece ends with its surface: the box of a piece that lies askew stands out of it, and the
// tool would rest on what is not there.
#include <algorithm>
#include <cmath>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::host {

namespace {

constexpr double kEven = 1e-9;  // of a unit vector: along an axis

Vec2d seen_from_above(Vec3d p) { return {p.x, p.y}; }

}  // namespace

// Where the outer lines of two sides meet; anywhere where they do not.
Vec2d TipFloor::corner_of(const Side& a, const Side& b)
{
    const double bend = cross(a.across, b.across);
    const double safe = std::abs(bend) > kEven ? bend : kEven;
    return {(a.outer * b.across.y - b.outer * a.across.y) / safe,
            (a.across.x * b.outer - b.across.x * a.outer) / safe};
}

// Each outer line as far as the lines before and behind it, all of it where they are no convex
// loop.
void TipFloor::end_sides(Outline& outline)
{
    constexpr double kConvex = 0.05;  // sine of the turn at a corner
    const auto after = [&](std::size_t i) -> const Side& {
        return outline.sides[(i + 1) % 4];
    };
    double least = 1e300;
    double most = -1e300;
    for (std::size_t i = 0; i < 4; ++i) {
        const double turn = cross(outline.sides[i].across, after(i).across);
        least = std::min(least, turn);
        most = std::max(most, turn);
    }
    const bool convex = least > kConvex || most < -kConvex;
    for (std::size_t i = 0; i < 4; ++i) {
        Side& side = outline.sides[i];
        const Vec2d along = left_normal(side.across);
        const double one = dot(along, corner_of(side, outline.sides[(i + 3) % 4]));
        const double other = dot(along, corner_of(side, after(i)));
        side.begin = convex ? std::min(one, other) : -1e300;
        side.end = convex ? std::max(one, other) : 1e300;
    }
}

void TipFloor::measure_outline(Piece& piece, const std::vector<Vec3d>& points) const
{
    piece.outline = 0;
    piece.outlined = false;
    if (piece.border == 0) {
        return;
    }
    const Patch& patch = patches_[piece.patch];
    const std::size_t rows = patch.rows;
    const std::size_t columns = patch.columns;
    const std::size_t last = (rows - 1) * columns;
    struct Row {
        std::size_t first, step, count;
    };
    // One after the other round the piece.
    const std::array<Row, 4> all{Row{0, 1, columns}, Row{columns - 1, columns, rows},
                                 Row{last, 1, columns}, Row{0, columns, rows}};
    const Vec2d middle = (seen_from_above(points[0]) + seen_from_above(points[columns - 1]) +
                          seen_from_above(points[last]) + seen_from_above(points.back())) *
                         0.25;
    Outline outline{};
    bool even = true;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Row& row = all[i];
        const Vec2d a = seen_from_above(points[row.first]);
        const Vec2d b = seen_from_above(points[row.first + row.step * (row.count - 1)]);
        if (distance(a, b) == 0.0) {
            return;
        }
        const Vec2d left = left_normal(unit(b - a));
        const Vec2d across = dot(middle - a, left) > 0.0 ? left * -1.0 : left;
        Side side{across, 1e300, -1e300, 1e300, -1e300, 0.0, 0.0};
        for (const Vec3d& p : points) {
            const double out = dot(across, seen_from_above(p));
            const double forth = dot(left_normal(across), seen_from_above(p));
            side.inner = std::min(side.inner, out);
            side.outer = std::max(side.outer, out);
            side.low = std::min(side.low, forth);
            side.high = std::max(side.high, forth);
        }
        double bow = 0.0;
        for (std::size_t k = 0; k < row.count; ++k) {
            const Vec2d p = seen_from_above(points[row.first + row.step * k]);
            bow = std::max(bow, side.outer - dot(across, p));
        }
        // Beside even sides the box is right.
        even = even && bow < kEven && std::min(std::abs(across.x), std::abs(across.y)) < kEven;
        outline.bow = std::max(outline.bow, bow);
        outline.sides[i] = side;
    }
    piece.outlined = true;
    if (even) {
        return;
    }
    end_sides(outline);
    piece.outline = static_cast<std::uint32_t>(outlines_.size());
    outlines_.push_back(outline);
}

// How far a place lies outside of the outline at least, mm; 0 or less inside.
double TipFloor::beyond_outline(const Piece& piece, Vec2d at) const
{
    double most = -1e300;
    for (const Side& side : outlines_[piece.outline].sides) {
        most = std::max(most, dot(side.across, at) - side.outer);
    }
    return most;
}

// The highest rest of the tool on the piece's plane inside the outline, where the place at which it
// touches the plane lies outside: then the best place is on a side that faces it.
double TipFloor::on_outline(const Piece& piece, Vec2d at) const
{
    const Vec2d g = piece.gradient;
    const double here = piece.level + dot(g, at);
    const Vec2d contact = at + g * piece.contact;
    double best = kNothing;
    for (const Side& side : outlines_[piece.outline].sides) {
        if (dot(contact, side.across) > side.outer) {
            const Vec2d along = left_normal(side.across);
            const double away = side.outer - dot(at, side.across);
            const double forth = dot(at, along);
            best = std::max(best,
                            here + dot(g, side.across) * away +
                                on_edge(dot(g, along), away, side.begin - forth, side.end - forth));
        }
    }
    return best;
}

// The place of the piece nearest to where the tool touches its plane.
Vec2d TipFloor::on_piece(const Piece& piece, Vec2d contact) const
{
    Vec2d place{std::clamp(contact.x, piece.x0, piece.x1),
                std::clamp(contact.y, piece.y0, piece.y1)};
    if (piece.outline == 0) {
        return place;
    }
    for (const Side& side : outlines_[piece.outline].sides) {
        place = place - side.across * std::max(0.0, dot(place, side.across) - side.outer);
    }
    return place;
}

// How far a straight way from a to b passes by the box that is turned with the outline, in plan and
// in height, at least, mm.
double TipFloor::apart_from_outline(const Piece& piece, Vec3d a, Vec3d b) const
{
    const auto apart = [](double low, double high, double p, double q) {
        return std::max({low - std::max(p, q), 0.0, std::min(p, q) - high});
    };
    const double uz = apart(piece.z0, piece.z1, a.z, b.z);
    double square = 0.0;
    for (const Side& side : outlines_[piece.outline].sides) {
        const auto out = [&](Vec3d p) {
            return dot(side.across, seen_from_above(p));
        };
        const auto forth = [&](Vec3d p) {
            return dot(left_normal(side.across), seen_from_above(p));
        };
        const double ux = apart(side.inner, side.outer, out(a), out(b));
        const double uy = apart(side.low, side.high, forth(a), forth(b));
        square = std::max(square, ux * ux + uy * uy + uz * uz);
    }
    return std::sqrt(square);
}

}  // namespace cusp::host
