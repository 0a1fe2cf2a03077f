// The clearance of a straight move: branch and bound over pieces of the surfaces and of the move.
#include <algorithm>
#include <cmath>

#include "host_tools/geometry/drop_cutter/drop_cutter_state.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::drop_cutter {

using nurbs::crease_knots;
using nurbs::Surface;
using offset::Box2d;
using offset::left_normal;

namespace {

constexpr double kDeepShare = 0.1;  // how accurate the depth of a deep gouge is

// The vector from segment cd to segment ab at their closest points.
// Source: Ericson, Real-Time Collision Detection, 5.1.9.
Vec3d between_segments(Vec3d a, Vec3d b, Vec3d c, Vec3d d)
{
    const Vec3d u = b - a;
    const Vec3d v = d - c;
    const Vec3d w = a - c;
    const double uu = dot(u, u);
    const double vv = dot(v, v);
    const double uv = dot(u, v);
    const double uw = dot(u, w);
    const double vw = dot(v, w);
    const auto share = [](double up, double down) {
        return down > 0.0 ? std::clamp(up / down, 0.0, 1.0) : 0.0;
    };
    double s = share(uv * vw - uw * vv, uu * vv - uv * uv);
    double t = uv * s + vw;
    if (t < 0.0 || vv == 0.0) {
        t = 0.0;
        s = share(-uw, uu);
    } else if (t > vv) {
        t = 1.0;
        s = share(uv - uw, uu);
    } else {
        t /= vv;
    }
    return w + u * s - v * t;
}

// The distance of segment ab from segment cd and everything straight below it.
double above_edge(Vec3d a, Vec3d b, Vec3d c, Vec3d d)
{
    const Vec3d apart = between_segments(a, b, c, d);
    if (apart.z >= 0.0) {
        return norm(apart);
    }
    a.z = b.z = c.z = d.z = 0.0;
    return norm(between_segments(a, b, c, d));
}

}  // namespace

// Distance in plan of the piece's box from the line through a and b, mm. For a long diagonal move
// this bound is better than that of the move's box.
double DropCutter::State::beside_line(const Piece& piece, const Vec3d& a, const Vec3d& b) const
{
    const Vec2d move{b.x - a.x, b.y - a.y};
    const double along = std::sqrt(dot(move, move));
    if (along == 0.0) {
        return 0.0;
    }
    const Vec2d side = left_normal(move) * (1.0 / along);
    const Vec2d middle{0.5 * (piece.x0 + piece.x1) - a.x, 0.5 * (piece.y0 + piece.y1) - a.y};
    const double half =
        0.5 * (std::abs(side.x) * (piece.x1 - piece.x0) + std::abs(side.y) * (piece.y1 - piece.y0));
    return std::max(0.0, std::abs(dot(side, middle)) - half);
}

// True if the space below a piece counts as solid. A tool could otherwise pass below the border of
// a surface. Small pieces of vertical walls need no such space.
bool DropCutter::State::overhangs(const Piece& piece) const
{
    constexpr double kSmall = 0.1;  // of the radius
    const bool ends = piece.patch == kGroup || piece.border != 0 || piece.cut;
    return ends && (piece.graph || extent(piece) > kSmall * tool_.radius);
}

// Lower bound of the clearance of a ball whose centre moves from a to b: the largest of its
// distances from the piece's axis-aligned box and from the boxes and the plate turned with the piece,
// less its radius. 0 where that is not negative.
double DropCutter::State::ball_clearance(const Piece& piece,
                                         const Vec3d& a,
                                         const Vec3d& b,
                                         double margin) const
{
    const auto apart = [](double low, double high, double p, double q) {
        return std::max(0.0, std::max(low - std::max(p, q), std::min(p, q) - high));
    };
    const double reach = tool_.radius + margin;
    const double ux = apart(piece.x0, piece.x1, a.x, b.x);
    const double uy = apart(piece.y0, piece.y1, a.y, b.y);
    const bool below = overhangs(piece);
    const double uz = apart(below ? -kUnbounded : piece.z0, piece.z1, a.z, b.z);
    double square = ux * ux + uy * uy + uz * uz;
    if (square >= reach * reach) {
        return 0.0;
    }
    if (piece.graph) {
        const Vec2d g = piece.gradient;
        const auto over = [&](const Vec3d& p) {
            return p.z - g.x * p.x - g.y * p.y - piece.z_at_origin;
        };
        const double cos_slope = 1.0 / piece.secant;
        const double tz =
            apart(below ? -kUnbounded : -piece.thickness, 0.0, over(a), over(b)) * cos_slope;
        if (tz >= reach) {
            return 0.0;
        }
        const double run = 1.0 + g.x * g.x;
        const double along = 1.0 / std::sqrt(run);
        const double aside = along * cos_slope;
        const auto first = [&](const Vec3d& p) {
            return along * (p.x + g.x * p.z);
        };
        const auto second = [&](const Vec3d& p) {
            return aside * (run * p.y + g.y * (p.z - g.x * p.x));
        };
        const double tx = apart(piece.lateral[0], piece.lateral[1], first(a), first(b));
        const double ty = apart(piece.lateral[2], piece.lateral[3], second(a), second(b));
        square = std::max(square, tz * tz + (below ? 0.0 : tx * tx + ty * ty));
    }
    if (square < reach * reach) {
        const double beside = beside_line(piece, a, b);
        square = std::max(square, beside * beside + uz * uz);
    }
    if (piece.outline != 0 && square < reach * reach) {
        const double aside = apart_from_outline(piece, a, b);
        square = std::max(square, aside * aside);
    }
    if (piece.outline != 0 && piece.graph && square < reach * reach) {
        const double apart_from_it = apart_from_plate(piece, a, b);
        square = std::max(square, apart_from_it * apart_from_it);
    }
    return square < reach * reach ? std::sqrt(square) - reach : 0.0;
}

// Lower bound (mm) of the distance between segment ab and the plate of a piece that is a graph: the
// polygon that the outline cuts out of the middle plane of the slab, and half the slab's thickness
// above and below it.
double DropCutter::State::apart_from_plate(const Piece& piece, Vec3d a, Vec3d b) const
{
    const Outline& outline = outlines_[piece.outline];
    const Vec2d g = piece.gradient;
    const double cos_slope = 1.0 / piece.secant;
    const double plane = piece.z_at_origin - 0.5 * piece.thickness;
    const auto over = [&](Vec3d p) {
        return p.z - plane - g.x * p.x - g.y * p.y;
    };
    const auto holds = [&](Vec2d p) {
        return std::all_of(outline.begin(), outline.end(),
                           [p](const Side& side) { return dot(side.across, p) <= side.outer; });
    };
    const auto above = [&](Vec3d p) {
        const double height = over(p);
        if (height < 0.0) {
            return holds({p.x, p.y}) ? 0.0 : kUnbounded;
        }
        return holds(in_plan(p) + g * (height * cos_slope * cos_slope)) ? height * cos_slope
                                                                        : kUnbounded;
    };
    const double from = over(a);
    const double to = over(b);
    if (from * to < 0.0) {
        const Vec3d met = a + (b - a) * (from / (from - to));
        if (holds({met.x, met.y})) {
            return 0.0;
        }
    }
    const double over_a = above(a);
    const double over_b = above(b);
    double least = std::min(over_a, over_b);
    // With both ends over the polygon the plane is nearer than any edge.
    if (std::max(over_a, over_b) < kUnbounded) {
        return std::max(0.0, least - 0.5 * piece.thickness);
    }
    for (const Side& side : outline) {
        if (side.begin > side.end) {
            continue;
        }
        if (side.begin == -kUnbounded || side.end == kUnbounded) {
            return 0.0;
        }
        const auto place = [&](double forth) {
            const Vec2d p = side.across * side.outer + left_normal(side.across) * forth;
            return Vec3d{p.x, p.y, plane + dot(g, p)};
        };
        least = std::min(least, above_edge(a, b, place(side.begin), place(side.end)));
    }
    return least < kUnbounded ? std::max(0.0, least - 0.5 * piece.thickness) : 0.0;
}

// Lower bound of the clearance along the axis while the tip moves from a to b. Over the plane the
// clearance is linear along the move, so its ends decide; for the box the nearest position does.
double DropCutter::State::axial_clearance(const Piece& piece, Vec3d a, Vec3d b, double margin) const
{
    const auto apart = [](double low, double high, double p, double q) {
        return std::max(0.0, std::max(low - std::max(p, q), std::min(p, q) - high));
    };
    const double dx = apart(piece.x0, piece.x1, a.x, b.x);
    const double dy = apart(piece.y0, piece.y1, a.y, b.y);
    const double r = tool_.radius;
    const double c = tool_.corner_radius;
    const double reach = tool_.radius + margin;
    double apart_in_plan = std::sqrt(dx * dx + dy * dy);
    if (apart_in_plan < reach) {
        apart_in_plan = std::max(apart_in_plan, beside_line(piece, a, b));
    }
    if (apart_in_plan < reach && piece.outline != 0) {
        const double z = piece.z0;
        apart_in_plan =
            std::max(apart_in_plan, apart_from_outline(piece, {a.x, a.y, z}, {b.x, b.y, z}));
    }
    const double away = std::max(0.0, apart_in_plan - margin);
    if (away >= r) {
        return kUnbounded;
    }
    const double out = std::max(0.0, away - (r - c));
    const double profile = c - std::sqrt(std::max(c * c - out * out, 0.0));
    const double over_box = std::min(a.z, b.z) + profile - piece.z1;
    if (!piece.graph) {
        return over_box;
    }
    const Vec2d g = piece.gradient;
    const auto over_plane = [&](Vec3d p) {
        return p.z - (piece.z_at_origin + g.x * p.x + g.y * p.y + piece.rise) -
               margin * std::sqrt(dot(g, g));
    };
    return std::max(over_box, std::min(over_plane(a), over_plane(b)));
}

// Decides whether to halve the piece or the part of the move whose clearance is at least `here`.
//
//   length  of the part, mm
//   tilt    mm: how much the part rises over the piece's plane
DropCutter::State::NextStep DropCutter::State::next_step(const Piece& piece,
                                                         double here,
                                                         double length,
                                                         double tilt) const
{
    const bool ball = tool_.corner_radius == tool_.radius;
    const double size = std::max(piece.x1 - piece.x0, piece.y1 - piece.y0);
    // A plate ends where its piece does: only its thickness is uncertain.
    const bool plate = ball && piece.graph && piece.outline != 0;
    const double thin = plate         ? piece.thickness
                        : piece.graph ? piece.thickness / piece.secant
                                      : size;
    const double turned = piece.graph ? std::abs(tilt) / piece.secant : length;
    const bool small = length < accuracy_ && size < accuracy_;
    // The plane extends beyond the piece. Only the turned boxes of a ball bound the piece there;
    // for other tools pieces have to be small. The box of a long move reaches beyond the piece as
    // well, so a gouge is accepted for short moves only.
    const bool clear = plate || here >= -accuracy_ || length + size < 0.1 * tool_.radius;
    const bool flat = thin < accuracy_ && (plate || turned < accuracy_);
    const bool settled =
        ball ? flat && clear
             : thin < 0.5 * accuracy_ && size * piece.secant < 0.05 && length < 0.05;
    const bool whole =
        is_whole(piece, accuracy_) && (ball || !piece.cut || extent(piece) < accuracy_);
    const bool deep =
        whole && here < -accuracy_ && std::max(extent(piece), length) < kDeepShare * -here;
    if ((settled && whole) || deep || small) {
        return NextStep::kNone;
    }
    // A piece cut by an edge may be missing as far as it is large.
    const bool halve_move = plate           ? false
                            : !whole        ? length > extent(piece)
                            : settled       ? false
                            : ball && !flat ? turned > thin
                                            : length > size;
    return halve_move ? NextStep::kHalveMove : NextStep::kHalvePiece;
}

// Over 60 lines: the steps of one search share its stack and its bound.
double DropCutter::State::move_clearance(Vec3d a, Vec3d b, double margin)
{
    forget_many_halves();
    struct Entry {
        std::uint32_t piece;
        double from, to;  // shares of the move
        double here;
    };
    const double reach = tool_.radius + margin;
    const Box2d around{std::min(a.x, b.x) - reach, std::min(a.y, b.y) - reach,
                       std::max(a.x, b.x) + reach, std::max(a.y, b.y) + reach};
    const bool ball = tool_.corner_radius == tool_.radius;
    const Vec3d start = a + Vec3d{0.0, 0.0, ball ? tool_.radius : 0.0};
    const Vec3d move = b - a;
    const double whole_length = norm(move);
    double least = 0.0;
    double smallest = kUnbounded;
    std::array<Entry, kStack> stack;
    std::size_t depth = 0;
    // The depth of a deep gouge is accurate to a tenth of it.
    const auto matters = [&](double here) {
        return here < (least < -accuracy_ ? (1.0 + kDeepShare) * least : least);
    };
    const auto consider = [&](std::uint32_t index, double from, double to) {
        const Piece& piece = pieces_[index];
        if (piece.x0 > around.x1 || piece.x1 < around.x0 || piece.y0 > around.y1 ||
            piece.y1 < around.y0) {
            return;
        }
        const Vec3d begin = start + move * from;
        const Vec3d end = start + move * to;
        const double here = ball ? ball_clearance(piece, begin, end, margin)
                                 : axial_clearance(piece, begin, end, margin);
        if (matters(here)) {
            stack[depth++] = {index, from, to, here};
        }
    };
    const auto halve_and_consider = [&](const Entry& top, NextStep step) {
        const std::size_t before = depth;
        if (step == NextStep::kHalveMove) {
            const double middle = 0.5 * (top.from + top.to);
            consider(top.piece, top.from, middle);
            consider(top.piece, middle, top.to);
        } else {
            if (pieces_[top.piece].child == 0) {
                halve(top.piece);
            }
            const std::uint32_t child = pieces_[top.piece].child;
            consider(child, top.from, top.to);
            consider(child + 1, top.from, top.to);
        }
        // The deeper half is processed first.
        if (depth == before + 2 && stack[before].here < stack[before + 1].here) {
            std::swap(stack[before], stack[before + 1]);
        }
    };
    const auto search_below = [&](std::uint32_t index) {
        consider(index, 0.0, 1.0);
        while (depth > 0) {
            const Entry top = stack[--depth];
            if (!matters(top.here)) {
                continue;
            }
            const Piece& piece = pieces_[top.piece];
            const double size = std::max(piece.x1 - piece.x0, piece.y1 - piece.y0);
            if (size < smallest) {
                smallest = size;
                beside_ = top.piece;
            }
            const double part = top.to - top.from;
            const double tilt = part * (move.z - dot(piece.gradient, in_plan(move)));
            const NextStep step = next_step(piece, top.here, part * whole_length, tilt);
            if (step == NextStep::kNone || depth + 2 > kStack) {
                least = std::min(least, top.here);
            } else {
                halve_and_consider(top, step);
            }
        }
    };
    // From the piece that the last move came near to, up to the root, as in drop().
    const std::uint32_t first = beside_;
    search_below(first);
    for (std::uint32_t piece = first; piece != kRoot; piece = pieces_[piece].parent) {
        search_below(sibling(piece));
    }
    least = least < -accuracy_ ? (1.0 + kDeepShare) * least : least;
    return least < 0.0 && edges_ ? std::min(least, -edges_->cut(a, b, margin)) : least;
}

// A single smooth surface has no crease, and its border lies beyond the walls of the region.
void DropCutter::State::check_edge_gouges(double allowed)
{
    const auto smooth = [](const Surface& s) {
        const auto whole = [](const std::vector<double>& knots, int degree, int count) {
            return crease_knots(knots, degree, static_cast<std::size_t>(count)).size() == 2;
        };
        return s.trims.empty() && whole(s.knots_u, s.degree_u, s.size_u) &&
               whole(s.knots_v, s.degree_v, s.size_v);
    };
    const bool ball = tool_.corner_radius == tool_.radius;
    if (ball && !(floor_->surfaces.size() == 1 && smooth(floor_->surfaces.front()))) {
        edges_.emplace(floor_->surfaces, tool_.radius, allowed);
    }
}

}  // namespace cusp::drop_cutter
