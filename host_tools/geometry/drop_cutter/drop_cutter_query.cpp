// The drop: branch and bound for the highest tip that any piece requires.
#include <algorithm>
#include <cmath>

#include "host_tools/geometry/drop_cutter/drop_cutter_state.hpp"
#include "host_tools/geometry/drop_cutter/edge_contact.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::drop_cutter {

using offset::Box2d;
using offset::distance;

namespace {

constexpr double kOnPiece = 0.01;         // of the radius: how near a contact is on the piece
constexpr double kSteepestSide = 1000.0;  // slope

double square_of(double x) { return x * x; }

}  // namespace

// The highest contact of the tool with the edges of a rectangle cut out of a plane. None where the
// tool misses the edges, or touches the plane inside the rectangle: `reach` slopes from its axis.
// The tip's height is a concave function of the contact. If its maximum over the plane lies outside
// the rectangle, its maximum over the rectangle is on an edge that faces it.
//
//   here  height of the plane at the tool's axis
std::optional<DropCutter::State::PlaneContact> DropCutter::State::on_edges(
    const Rectangle& part, Vec2d slope, double here, double reach, Vec2d at) const
{
    const Vec2d contact = at + slope * reach;
    std::optional<PlaneContact> best;
    if (contact.x < part.x0 || contact.x > part.x1) {
        const double x = (contact.x < part.x0 ? part.x0 : part.x1) - at.x;
        if (const auto edge = drop_on_edge(tool_, {slope.y, x, part.y0 - at.y, part.y1 - at.y})) {
            best = {here + slope.x * x + edge->lift, at + Vec2d{x, edge->along}};
        }
    }
    if (contact.y < part.y0 || contact.y > part.y1) {
        const double y = (contact.y < part.y0 ? part.y0 : part.y1) - at.y;
        if (const auto edge = drop_on_edge(tool_, {slope.x, y, part.x0 - at.x, part.x1 - at.x})) {
            const double height = here + slope.y * y + edge->lift;
            if (!best || height > best->height) {
                best = {height, at + Vec2d{edge->along, y}};
            }
        }
    }
    return best;
}

std::optional<DropCutter::State::PlaneContact> DropCutter::State::on_edges(const Piece& piece,
                                                                           Vec2d at) const
{
    const double here = piece.z_at_origin + dot(piece.gradient, at);
    return on_edges({piece.x0, piece.x1, piece.y0, piece.y1}, piece.gradient, here, piece.contact,
                    at);
}

// Height of the tip on the piece's plane, taken as unlimited.
double DropCutter::State::over_plane(const Piece& piece, Vec2d at)
{
    const Vec2d g = piece.gradient;
    return piece.graph ? piece.z_at_origin + g.x * at.x + g.y * at.y + piece.rise : kUnbounded;
}

// From the tool's axis to the rectangle of the wall, in plan. The box of a wall at an angle to the
// axes reaches far beyond it: bounded by boxes alone, a wall was halved along its whole length under the tool.
double DropCutter::State::square_off_wall(const Piece& wall, Vec2d at)
{
    const Vec2d forth = wall.uphill;
    return square_of(excess(wall.lateral[0], wall.lateral[1], dot(forth, at))) +
           square_of(excess(wall.lateral[2], wall.lateral[3], forth.x * at.y - forth.y * at.x));
}

// Height of the tip on the plane over the wall, taken as unlimited.
double DropCutter::State::over_wall(const Piece& wall, Vec2d at) const
{
    // Steeper planes bound nothing that the rectangle does not, and rounding grows with the slope.
    constexpr double kLeastRise = 1e-3;
    if (wall.rise < kLeastRise) {
        return kUnbounded;
    }
    const double level = std::sqrt(1.0 - wall.rise * wall.rise);
    const double c = tool_.corner_radius;
    const double reach = level * (dot(wall.uphill, at) + tool_.radius - c) + c;
    return (wall.z_at_origin + reach) / wall.rise - c;
}

// Upper bound of the tip's height over this piece; -kUnbounded where the tool does not reach it, or
// where the bound is known not to exceed `best`.
//
// tight  set to whether halving the piece would lower the bound by its thickness at most
//
// Over 60 lines: cases in the order of their cost, each of which may decide.
double DropCutter::State::bound(const Piece& piece,
                                const Query& query,
                                double best,
                                bool& tight) const
{
    tight = false;
    const Vec2d at = query.at;
    const Vec2d g = piece.gradient;
    const double by_plane = over_plane(piece, at);
    const double r = tool_.radius;
    const double c = tool_.corner_radius;
    const double dx = excess(piece.x0, piece.x1, at.x);
    const double dy = excess(piece.y0, piece.y1, at.y);
    double square = dx * dx + dy * dy;
    if (square >= r * r) {
        return -kUnbounded;
    }
    if (piece.outline != 0) {
        const double beyond = beyond_outline(piece, at);
        square = std::max(square, beyond > 0.0 ? beyond * beyond : 0.0);
        if (square >= r * r) {
            return -kUnbounded;
        }
    }
    const bool wall = !piece.graph && dot(piece.uphill, piece.uphill) > 0.0;
    if (wall) {
        square = std::max(square, square_off_wall(piece, at));
        if (square >= r * r) {
            return -kUnbounded;
        }
    }
    const Vec2d contact = at + g * piece.contact;
    const bool in_box = contact.x >= piece.x0 && contact.x <= piece.x1 && contact.y >= piece.y0 &&
                        contact.y <= piece.y1;
    if (piece.graph && in_box && (piece.outline == 0 || beyond_outline(piece, contact) <= 0.0)) {
        const bool whole = !piece.cut || is_whole(piece, query.thin);
        tight = whole && piece.thickness <= query.thin;
        return std::min(by_plane, piece.z1);
    }
    const double far = c == r ? square : square_of(std::max(0.0, std::sqrt(square) - (r - c)));
    const double up = best - piece.z1 + c;
    const double room = std::max(c * c - far, 0.0);
    if (up >= 0.0 && room <= up * up) {
        return -kUnbounded;
    }
    const double by_box = piece.z1 - (c - std::sqrt(room));
    const bool whole = is_whole(piece, query.thin);
    if (!piece.graph) {
        tight = whole && piece.patch != kGroup &&
                std::max(piece.x1 - piece.x0, piece.y1 - piece.y0) < 5.0 * accuracy_;
        return wall ? std::min(by_box, over_wall(piece, at)) : by_box;
    }
    tight = whole && piece.thickness <= query.thin;
    double least = std::min(by_plane, by_box);
    if (!in_box) {
        const std::optional<PlaneContact> edge = on_edges(piece, at);
        if (!edge) {
            return -kUnbounded;
        }
        least = std::min(least, edge->height);
    }
    if (piece.outline != 0 && beyond_outline(piece, contact) > 0.0) {
        const std::optional<PlaneContact> edge = on_outline(piece, at);
        if (!edge) {
            return -kUnbounded;
        }
        least = std::min(least, edge->height);
        // The slopes of the tool's side and of the plane multiply an error in plan.
        const double steep =
            std::max(1.0, side_slope(distance(edge->place, at)) + std::sqrt(dot(g, g)));
        tight = tight && (!piece.cut || is_whole(piece, query.thin / steep));
    }
    return least;
}

// The smallest existing piece that holds the contact predicted by the slope of the last drop.
std::uint32_t DropCutter::State::guess(Vec2d at) const
{
    const Vec2d place = at + pieces_[last_].gradient * pieces_[last_].contact;
    const auto holds = [&](std::uint32_t index) {
        const Piece& piece = pieces_[index];
        return place.x >= piece.x0 && place.x <= piece.x1 && place.y >= piece.y0 &&
               place.y <= piece.y1;
    };
    std::uint32_t index = last_;
    while (index != kRoot && !holds(index)) {
        index = pieces_[index].parent;
    }
    while (const std::uint32_t child = pieces_[index].child) {
        if (!holds(child) && !holds(child + 1)) {
            break;
        }
        index = holds(child) ? child : child + 1;
    }
    return index;
}

// Over 60 lines: the steps of one search share its stack and the best height.
std::optional<DropCutter::ClPoint> DropCutter::State::drop(Vec2d at, double max_error)
{
    forget_many_halves();
    const Query query{at, std::max(accuracy_, max_error)};
    const double r = tool_.radius;
    const Box2d around{at.x - r, at.y - r, at.x + r, at.y + r};
    struct Entry {
        double height;
        std::uint32_t piece;
    };
    std::array<Entry, kStack> stack;
    std::size_t depth = 0;
    ClPoint best{-kUnbounded, {0.0, 0.0}, 0};
    const auto consider = [&](std::uint32_t index) {
        const Piece& piece = pieces_[index];
        const bool far = piece.x0 >= around.x1 || piece.x1 <= around.x0 || piece.y0 >= around.y1 ||
                         piece.y1 <= around.y0;
        if (far || piece.z1 <= best.z || over_plane(piece, at) <= best.z) {
            return;
        }
        bool tight = false;
        const double height = bound(piece, query, best.z, tight);
        if (height > best.z && (tight || depth == kStack)) {
            best = {height, piece.gradient, index};
        } else if (height > best.z) {
            stack[depth++] = {height, index};
        }
    };
    const auto search_below = [&](std::uint32_t piece) {
        consider(piece);
        while (depth > 0) {
            const Entry top = stack[--depth];
            if (top.height <= best.z) {
                continue;
            }
            if (pieces_[top.piece].child == 0) {
                halve(top.piece);
            }
            const std::uint32_t child = pieces_[top.piece].child;
            const std::size_t before = depth;
            consider(child);
            consider(child + 1);
            // The half with the higher bound is processed first.
            if (depth == before + 2 && stack[before].height > stack[before + 1].height) {
                std::swap(stack[before], stack[before + 1]);
            }
        }
    };
    // The search starts at the predicted contact and climbs to the root: a parent adds only the
    // sibling of the piece before. A tool with a flat touches with the flat's rim, which the slope
    // does not predict: its search starts at the last contact.
    const bool ball = tool_.corner_radius == r;
    const std::uint32_t first = ball ? guess(at) : last_;
    search_below(first);
    for (std::uint32_t piece = first; piece != kRoot; piece = pieces_[piece].parent) {
        search_below(sibling(piece));
    }
    if (best.z == -kUnbounded) {
        return std::nullopt;
    }
    last_ = best.piece;
    best.slope = slope_of(pieces_[best.piece], at);
    return best;
}

Vec2d DropCutter::State::cc_place(Vec2d at, const ClPoint& cl) const
{
    return on_piece(pieces_[cl.piece], at);
}

// The slope of the tip's height: that of the piece's plane, or of the tool's side where the tool
// touches an edge.
Vec2d DropCutter::State::slope_of(const Piece& piece, Vec2d at) const
{
    const Vec2d contact = at + piece.gradient * piece.contact;
    const Vec2d place = on_piece(piece, at);
    const Vec2d arm = place - at;
    const double away = std::sqrt(dot(arm, arm));
    const bool on_plane = piece.graph && distance(place, contact) < kOnPiece * tool_.radius;
    if (tool_.corner_radius == 0.0 || on_plane) {
        return piece.gradient;
    }
    const double slope = side_slope(away);
    return slope > 0.0 ? arm * (slope / away) : Vec2d{0.0, 0.0};
}

// Slope of the tool's profile at this distance from its axis.
double DropCutter::State::side_slope(double away) const
{
    const double c = tool_.corner_radius;
    const double out = away - (tool_.radius - c);
    if (out <= 0.0 || c == 0.0) {
        return 0.0;
    }
    const double side = std::sqrt(std::max(c * c - out * out, 0.0));
    return std::min(out / std::max(side, 1e-9 * tool_.radius), kSteepestSide);
}

}  // namespace cusp::drop_cutter
