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

void TipFloor::measure_outline(Piece& piece, const std::vector<Vec3d>& points) const
{
    piece.outline = 0;
    if (piece.border == 0) {
        return;
    }
    const Patch& patch = patches_[piece.patch];
    const std::size_t rows = patch.rows;
    const std::size_t columns = patch.columns;
    const std::size_t last = (rows - 1) * columns;
    struct Row {
        std::uint8_t bit;
        std::size_t first, step, count;
    };
    const std::array<Row, 4> all{Row{kFirstRow, 0, 1, columns}, Row{kLastRow, last, 1, columns},
                                 Row{kFirstColumn, 0, columns, rows},
                                 Row{kLastColumn, columns - 1, columns, rows}};
    const Vec2d middle = (seen_from_above(points[0]) + seen_from_above(points[columns - 1]) +
                          seen_from_above(points[last]) + seen_from_above(points.back())) *
                         0.25;
    Outline outline{};
    for (const Row& row : all) {
        const Vec2d a = seen_from_above(points[row.first]);
        const Vec2d b = seen_from_above(points[row.first + row.step * (row.count - 1)]);
        if ((piece.border & row.bit) == 0 || distance(a, b) == 0.0) {
            continue;
        }
        const Vec2d along = unit(b - a);
        const Vec2d left = left_normal(along);
        const Vec2d across = dot(middle - a, left) > 0.0 ? left * -1.0 : left;
        Side side{across, 1e300, -1e300, 1e300, -1e300};
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
        // Beside an even side the box is right.
        if (bow > kEven || (std::abs(across.x) > kEven && std::abs(across.y) > kEven)) {
            // Between two sides the tool may rest on neither.
            outline.bow = outline.count > 0 ? 1e300 : std::max(outline.bow, bow);
            outline.sides[static_cast<std::size_t>(outline.count++)] = side;
        }
    }
    if (outline.count > 0) {
        piece.outline = static_cast<std::uint32_t>(outlines_.size());
        outlines_.push_back(outline);
    }
}

// How far a place lies outside of the outline at least, mm; 0 or less inside.
double TipFloor::beyond_outline(const Piece& piece, Vec2d at) const
{
    const Outline& outline = outlines_[piece.outline];
    double most = -1e300;
    for (int i = 0; i < outline.count; ++i) {
        const Side& side = outline.sides[static_cast<std::size_t>(i)];
        most = std::max(most, dot(side.across, at) - side.outer);
    }
    return most;
}

double TipFloor::least_on_outline(const Piece& piece, Vec2d at) const
{
    const Outline& outline = outlines_[piece.outline];
    const Vec2d g = piece.gradient;
    const double here = piece.level + dot(g, at);
    const Vec2d contact = at + g * piece.contact;
    double least = 1e300;
    for (int i = 0; i < outline.count; ++i) {
        const Side& side = outline.sides[static_cast<std::size_t>(i)];
        const Vec2d along = left_normal(side.across);
        if (dot(contact, side.across) > side.outer) {
            const auto turned = [&](Vec2d p) {
                return Vec2d{dot(p, side.across), dot(p, along)};
            };
            least = std::min(least, on_edges({side.inner, side.outer, side.low, side.high},
                                             turned(g), here, piece.contact, turned(at)));
        }
    }
    return least;
}

// The place of the piece nearest to where the tool touches its plane.
Vec2d TipFloor::on_piece(const Piece& piece, Vec2d contact) const
{
    Vec2d place{std::clamp(contact.x, piece.x0, piece.x1),
                std::clamp(contact.y, piece.y0, piece.y1)};
    const Outline& outline = outlines_[piece.outline];
    for (int i = 0; i < outline.count; ++i) {
        const Side& side = outline.sides[static_cast<std::size_t>(i)];
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
    const Outline& outline = outlines_[piece.outline];
    const double uz = apart(piece.z0, piece.z1, a.z, b.z);
    double square = 0.0;
    for (int i = 0; i < outline.count; ++i) {
        const Side& side = outline.sides[static_cast<std::size_t>(i)];
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
