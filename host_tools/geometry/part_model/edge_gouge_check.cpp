// Pieces of edges are sorted into squares in plan.
#include "host_tools/geometry/part_model/edge_gouge_check.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/part_model/grid_square.hpp"

namespace cusp::part_model {

using nurbs::crease_knots;
using nurbs::distinct_knots;
using nurbs::Surface;

namespace {

constexpr double kPiece = 0.02;      // radii
constexpr double kSquare = 0.5;      // radii
constexpr int kLengthSamples = 8;    // between knots
constexpr int kMostPieces = 4000;    // between knots
constexpr double kAside = 1e-6;      // of the domain: offset to one side of a crease
constexpr double kLeastUp = 1e-3;    // z of the unit direction to the centre
constexpr double kStepShare = 0.2;   // of the depth: between the checked points of a move
constexpr double kTrimShare = 0.05;  // of the depth: between the edge of a trim and its polyline
constexpr int kMostPoints = 2000;    // of a move
constexpr int kMostPushes = 3;       // off edges that meet
constexpr double kRaised = 1e-7;     // mm: accuracy of a raised tip
constexpr double kBeyond = 0.4;      // of kRaised: how far steps aim beyond the root
constexpr int kHalved = 4;           // every fourth step bisects

Vec3d nearest_on(Vec3d p, Vec3d a, Vec3d b)
{
    const Vec3d d = b - a;
    const double square = dot(d, d);
    return a + d * (square > 0 ? std::clamp(dot(p - a, d) / square, 0.0, 1.0) : 0.0);
}

// The vector from the nearest point of a short piece to the core of a ball with its shank: its
// centre and everything straight above. Horizontal for points above the centre.
Vec3d vector_to_core(Vec3d centre, Vec3d a, Vec3d b)
{
    Vec3d way = centre - nearest_on(centre, a, b);
    if (way.z < 0) {
        way = centre - nearest_on({centre.x, centre.y, 0}, {a.x, a.y, 0}, {b.x, b.y, 0});
        way.z = 0;
    }
    return way;
}

// Lowest height that a ball reaches at the point p in plan while its centre moves straight from a
// to b; kInfinite if it misses p.
double lowest_over(Vec3d a, Vec3d b, double radius, Vec3d p)
{
    const double length = elementary::hypot(b.x - a.x, b.y - a.y);
    const Vec2d arm{p.x - a.x, p.y - a.y};
    const Vec2d way = length > 0 ? Vec2d{b.x - a.x, b.y - a.y} * (1 / length) : Vec2d{1, 0};
    const double along = dot(arm, way);
    const double square = radius * radius - dot(arm, arm) + along * along;
    const double half = std::sqrt(std::max(0.0, square));
    const double low = std::max(0.0, along - half);
    const double high = std::min(length, along + half);
    if (square <= 0 || low > high) {
        return kInfinite;
    }
    if (length == 0) {
        return std::min(a.z, b.z) - std::sqrt(std::max(0.0, square - along * along));
    }
    const double slope = (b.z - a.z) / length;
    const double best = std::clamp(along - slope * half / std::sqrt(1 + slope * slope), low, high);
    return a.z + slope * best - std::sqrt(std::max(0.0, square - (best - along) * (best - along)));
}

}  // namespace

EdgeGougeCheck::EdgeGougeCheck(const std::vector<Surface>& surfaces, double radius, double deepest)
    : radius_{radius}, max_gouge_{deepest}, step_{std::sqrt(8 * radius * kStepShare * deepest)}
{
    for (const Surface& s : surfaces) {
        const TrimRegion trims{s, kTrimShare * deepest};
        edge_error_ = trims.trimmed() ? kTrimShare * deepest : edge_error_;
        add_borders(s, trims);
        for (const std::vector<Vec2d>& loop : trims.loops()) {
            for (std::size_t k = 0; k < loop.size(); ++k) {
                add_edge(s, trims, loop[k], loop[(k + 1) % loop.size()], {});
            }
        }
    }
}

// Borders and creases inside the trims.
void EdgeGougeCheck::add_borders(const Surface& s, const TrimRegion& trims)
{
    const double aside_u = kAside * (s.u_end() - s.u_begin());
    const double aside_v = kAside * (s.v_end() - s.v_begin());
    const auto size_u = static_cast<std::size_t>(s.size_u);
    const auto size_v = static_cast<std::size_t>(s.size_v);
    const std::vector<double> us = distinct_knots(s.knots_u, s.degree_u, size_u);
    const std::vector<double> vs = distinct_knots(s.knots_v, s.degree_v, size_v);
    const auto along_v = [&](double u, double aside) {
        for (std::size_t k = 1; k < vs.size(); ++k) {
            add_edge(s, trims, {u, vs[k - 1]}, {u, vs[k]}, {aside, 0});
        }
    };
    const auto along_u = [&](double v, double aside) {
        for (std::size_t k = 1; k < us.size(); ++k) {
            add_edge(s, trims, {us[k - 1], v}, {us[k], v}, {0, aside});
        }
    };
    // Both sides of a crease; of a border the inner side.
    for (const double u : crease_knots(s.knots_u, s.degree_u, size_u)) {
        if (u < s.u_end()) {
            along_v(u, aside_u);
        }
        if (u > s.u_begin()) {
            along_v(u, -aside_u);
        }
    }
    for (const double v : crease_knots(s.knots_v, s.degree_v, size_v)) {
        if (v < s.v_end()) {
            along_u(v, aside_v);
        }
        if (v > s.v_begin()) {
            along_u(v, -aside_v);
        }
    }
}

// aside  from the edge into the face, in (u, v); zero along the edge of a trim
void EdgeGougeCheck::add_edge(
    const Surface& surface, const TrimRegion& trims, Vec2d from, Vec2d to, Vec2d aside)
{
    double length = 0;
    Vec3d last = point_at(surface, from.x, from.y);
    for (int k = 1; k <= kLengthSamples; ++k) {
        const Vec2d at = from + (to - from) * (static_cast<double>(k) / kLengthSamples);
        const Vec3d next = point_at(surface, at.x, at.y);
        length += norm(next - last);
        last = next;
    }
    const int parts = std::clamp(static_cast<int>(length / (kPiece * radius_)) + 1, 1, kMostPieces);
    Vec3d at = point_at(surface, from.x, from.y);
    double normal_z = 0;
    for (int k = 0; k <= parts; ++k) {
        const Vec2d place = from + (to - from) * (static_cast<double>(k) / parts);
        const Vec3d next = point_at(surface, place.x, place.y);
        const Vec2d inside = place + aside;
        const double up = upward_normal(derivatives_at(surface, inside.x, inside.y)).z;
        const Vec2d middle = place + (from - to) * (0.5 / parts) + aside;
        const bool is_inside = norm(aside) == 0 || trims.inside(middle.x, middle.y);
        if (k > 0 && is_inside && norm(next - at) > 0) {
            add({at, next, std::max(normal_z, up)});
        }
        normal_z = up;
        at = next;
    }
}

void EdgeGougeCheck::add(const Piece& piece)
{
    const std::uint32_t number = static_cast<std::uint32_t>(pieces_.size());
    pieces_.push_back(piece);
    longest_ = std::max(longest_, 0.5 * norm(piece.to - piece.from));
    const Vec3d middle = (piece.from + piece.to) * 0.5;
    cells_[square_key(cell(middle.x), cell(middle.y))].push_back(number);
}

std::int64_t EdgeGougeCheck::cell(double at) const
{
    return static_cast<std::int64_t>(std::floor(at / (kSquare * radius_)));
}

// Calls visit(piece) for the pieces that may be nearer than `around` in plan.
template <class Visit>
void EdgeGougeCheck::visit_around(Vec3d centre, double around, const Visit& visit) const
{
    around += longest_;
    const std::int64_t j_end = cell(centre.y + around);
    for (std::int64_t i = cell(centre.x - around); i <= cell(centre.x + around); ++i) {
        for (std::int64_t j = cell(centre.y - around); j <= j_end; ++j) {
            const auto found = cells_.find(square_key(i, j));
            if (found == cells_.end()) {
                continue;
            }
            for (const std::uint32_t number : found->second) {
                visit(pieces_[number]);
            }
        }
    }
}

// None where the ball is farther than `margin` from the piece.
std::optional<EdgeGougeCheck::EdgeViolation> EdgeGougeCheck::violation_at(const Piece& piece,
                                                                          Vec3d centre,
                                                                          double margin) const
{
    const double limit = radius_ + margin;
    const double x = centre.x - piece.from.x;
    const double y = centre.y - piece.from.y;
    const double far = limit + 2 * longest_;
    if (x * x + y * y > far * far || centre.z - piece.from.z > far) {
        return std::nullopt;
    }
    const Vec3d way = vector_to_core(centre, piece.from, piece.to);
    const double distance = norm(way);
    if (distance >= limit || distance <= 0) {
        return std::nullopt;
    }
    const double faster = max_gouge_ / std::max(kLeastUp, piece.normal_z);
    const double depth = faster * std::max(kLeastUp, way.z / distance);
    return EdgeViolation{limit - depth - distance, way, distance, faster};
}

// The vector that moves the centre off the edge with the largest violation; zero without violation.
Vec3d EdgeGougeCheck::missing_clearance(Vec3d centre, double margin) const
{
    double largest = 0;
    Vec3d out;
    visit_around(centre, radius_ + margin, [&](const Piece& piece) {
        const std::optional<EdgeViolation> violation = violation_at(piece, centre, margin);
        if (violation && violation->amount > largest) {
            largest = violation->amount;
            out = violation->direction * (largest / violation->distance);
        }
    });
    return out;
}

// The z of a centre from which the violation is gone: Newton's method, aimed a little beyond the
// root so that both bounds converge.
double EdgeGougeCheck::clear_height(const Piece& piece,
                                    Vec3d centre,
                                    EdgeViolation violation,
                                    double margin) const
{
    double low = centre.z;
    double free = std::max(piece.from.z, piece.to.z) + radius_ + margin;
    for (int k = 1; free - low > kRaised; ++k) {
        const double up = violation.direction.z / violation.distance;
        const double depth =
            up > kLeastUp ? violation.faster * (1 - up * up) / violation.distance : 0.0;
        const double beyond = violation.amount > 0 ? kBeyond * kRaised : -kBeyond * kRaised;
        const double next = centre.z + violation.amount / (up + depth) + beyond;
        const bool aimed = k % kHalved != 0 && low < next && next < free;
        centre.z = aimed ? next : 0.5 * (low + free);
        const std::optional<EdgeViolation> there = violation_at(piece, centre, margin);
        (there && there->amount > 0 ? low : free) = centre.z;
        violation = there.value_or(
            EdgeViolation{0, violation.direction, violation.distance, violation.faster});
    }
    return free;
}

// At the border of what an edge blocks, distance plus allowed depth is constant. The tangent ball
// there is the barrier.
EdgeGougeCheck::RaisedTip EdgeGougeCheck::raised_clear(Vec3d tip, double band) const
{
    const Vec3d up{0, 0, 1};
    Vec3d centre = tip + up * radius_;
    const Piece* last = nullptr;
    visit_around(centre, radius_ + band, [&](const Piece& piece) {
        const std::optional<EdgeViolation> violation = violation_at(piece, centre, band);
        if (violation && violation->amount > 0) {
            centre.z = clear_height(piece, centre, *violation, band);
            last = &piece;
        }
    });
    if (last == nullptr) {
        return {tip, std::nullopt};
    }
    Vec3d out = vector_to_core(centre, last->from, last->to);
    const double distance = norm(out);
    const double share = out.z / distance;
    const double faster = max_gouge_ / std::max(kLeastUp, last->normal_z);
    out = out / distance;
    if (share > kLeastUp) {
        out = out * (1 - faster * share / distance) + up * (faster / distance);
    }
    return {centre - up * radius_, centre - out * (radius_ / norm(out))};
}

Vec3d EdgeGougeCheck::moved_clear_of(Vec3d tip, double band) const
{
    for (int k = 0; k < kMostPushes; ++k) {
        const Vec3d shift = missing_clearance(tip + Vec3d{0, 0, radius_}, band);
        if (shift == Vec3d{}) {
            break;
        }
        tip = tip + shift;
    }
    return tip;
}

// Moves the points of a segment, inserting middles while some point of it may have to move: none is
// farther from the middle than half the length.
bool EdgeGougeCheck::append_moved(Vec3d from, Vec3d to, double band, std::vector<Vec3d>& out) const
{
    const double length = norm(to - from);
    const Vec3d middle = (from + to) * 0.5;
    if (length > step_ &&
        !(missing_clearance(middle + Vec3d{0, 0, radius_}, band + 0.5 * length) == Vec3d{})) {
        const bool first = append_moved(from, middle, band, out);
        const bool second = append_moved(middle, to, band, out);
        return first || second;
    }
    out.push_back(moved_clear_of(to, band));
    return !(out.back() == to);
}

std::vector<Vec3d> EdgeGougeCheck::moved_clear(const std::vector<Vec3d>& tips, double band) const
{
    std::vector<Vec3d> out{moved_clear_of(tips.front(), band)};
    bool moved = !(out.front() == tips.front());
    for (std::size_t k = 1; k < tips.size(); ++k) {
        moved = append_moved(tips[k - 1], tips[k], band, out) || moved;
    }
    return moved ? out : tips;
}

bool EdgeGougeCheck::clears(Vec3d from, Vec3d to) const
{
    const int points =
        std::clamp(static_cast<int>(std::ceil(norm(to - from) / step_)), 1, kMostPoints);
    for (int k = 0; k <= points; ++k) {
        const Vec3d tip = from + (to - from) * (static_cast<double>(k) / points);
        if (!(missing_clearance(tip + Vec3d{0, 0, radius_}, 0) == Vec3d{})) {
            return false;
        }
    }
    return true;
}

double EdgeGougeCheck::cut(Vec3d from, Vec3d to, double margin) const
{
    const Vec3d way = to - from;
    // Squares are searched around a point, so a long move is divided.
    const double length = elementary::hypot(way.x, way.y);
    const int parts = std::max(1, static_cast<int>(std::ceil(length / radius_)));
    // Between the ends of a piece the ball may reach lower: as low as one larger by this sagitta.
    const double round = radius_ * (1 + 0.125 * kPiece * kPiece) + edge_error_ + margin;
    double deepest = 0;
    for (int k = 0; k < parts; ++k) {
        const Vec3d a = from + way * (static_cast<double>(k) / parts);
        const Vec3d b = from + way * (static_cast<double>(k + 1) / parts);
        visit_around((a + b) * 0.5, round + 0.5 * length / parts, [&](const Piece& piece) {
            for (const Vec3d p : {piece.from, piece.to}) {
                const Vec3d up{0, 0, radius_};
                deepest = std::max(deepest,
                                   piece.normal_z * (p.z - lowest_over(a + up, b + up, round, p)));
            }
        });
    }
    return deepest;
}

}  // namespace cusp::part_model
