// Edges are cut where they cross a plane. In an octant, cut edges and quarter circles in turn are the
// loops, after Weiler and Atherton: where an edge leaves, the way along the octant's boundary, which runs
// counter-clockwise, leads to the next edge that enters.
#include "host_tools/import/sphere_octants.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/nurbs/plan_vector.hpp"

namespace cusp::import {

namespace {

constexpr int kChords = 64;  // of an edge, to find its crossings and what is nearest

double parameter(const SphereEdge& edge, int chord)
{
    return edge.from + (edge.to - edge.from) * chord / kChords;
}

// An edge within one octant.
struct Piece {
    SphereEdge edge;
    bool enters;  // begins in a plane
    bool leaves;  // ends in a plane
    bool used;
};

// Where the edge crosses the plane of an axis between two parameters; the signs at these differ.
double crossing(const SphereEdge& edge, unsigned axis, double a, double b)
{
    constexpr int kHalvings = 60;
    const bool above = edge.at(a).point[axis] > 0;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (a + b);
        ((edge.at(middle).point[axis] > 0) == above ? a : b) = middle;
    }
    return 0.5 * (a + b);
}

std::vector<Piece> cut(const SphereEdge& edge)
{
    std::vector<double> cuts;
    for (int k = 0; k < kChords; ++k) {
        const double a = parameter(edge, k);
        const double b = parameter(edge, k + 1);
        const Vec3d p = edge.at(a).point;
        const Vec3d q = edge.at(b).point;
        for (unsigned axis = 0; axis < 3; ++axis) {
            if ((p[axis] > 0) != (q[axis] > 0)) {
                cuts.push_back(crossing(edge, axis, a, b));
            }
        }
    }
    std::sort(cuts.begin(), cuts.end());
    if (edge.to < edge.from) {
        std::reverse(cuts.begin(), cuts.end());
    }
    cuts.push_back(edge.to);
    std::vector<Piece> pieces;
    double from = edge.from;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        pieces.push_back({{edge.at, from, cuts[i]}, i > 0, i + 1 < cuts.size(), false});
        from = cuts[i];
    }
    return pieces;
}

std::size_t octant_of(const SphereEdge& piece)
{
    const Vec3d middle = piece.at(0.5 * (piece.from + piece.to)).point;
    return (middle.x > 0 ? 1U : 0U) + (middle.y > 0 ? 2U : 0U) + (middle.z > 0 ? 4U : 0U);
}

// The boundary of an octant, counter-clockwise from outside: quarter circles from corner to corner.
class Boundary {
public:
    explicit Boundary(Vec3d signs)
    {
        const bool straight = signs.x * signs.y * signs.z > 0;
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned axis = straight ? k : 2 - k;
            corners_[k][axis] = signs[axis];
        }
    }

    // 0 to 3, in quarter circles, of a point in one of the planes.
    double place_of(Vec3d p) const
    {
        unsigned arc = 0;
        double least = 2;
        for (unsigned k = 0; k < 3; ++k) {
            const double off = std::abs(dot(p, corners_[(k + 2) % 3]));
            if (off < least) {
                least = off;
                arc = k;
            }
        }
        const double angle = std::atan2(dot(p, corners_[(arc + 1) % 3]), dot(p, corners_[arc]));
        return arc + std::clamp(angle / (0.5 * kPi), 0.0, 1.0);
    }

    // The arcs from one place counter-clockwise to another one; once round where these are equal.
    SphereLoop between(double from, double to) const
    {
        to += to <= from ? 3 : 0;
        SphereLoop arcs;
        for (double at = from; at < to;) {
            const double corner = std::floor(at) + 1;
            const double end = std::min(corner, to);
            arcs.push_back(
                arc(static_cast<unsigned>(corner - 1) % 3, at - (corner - 1), end - (corner - 1)));
            at = end;
        }
        return arcs;
    }

    Vec3d corner(unsigned k) const { return corners_[k]; }
    Vec3d middle(unsigned k) const
    {
        return (corners_[k] + corners_[(k + 1) % 3]) * std::sqrt(0.5);
    }

private:
    SphereEdge arc(unsigned k, double from, double to) const
    {
        const Vec3d a = corners_[k];
        const Vec3d b = corners_[(k + 1) % 3];
        return {[a, b](double t) {
                    const double angle = 0.5 * kPi * t;
                    return PointAndTangent{
                        a * std::cos(angle) + b * std::sin(angle),
                        (b * std::cos(angle) - a * std::sin(angle)) * (0.5 * kPi)};
                },
                from, to};
    }

    std::array<Vec3d, 3> corners_{};
};

// The unused piece that begins nearest to a point, among those that enter or those that do not.
Piece* nearest(std::vector<Piece>& pieces, Vec3d point, bool enters)
{
    Piece* best = nullptr;
    double least = kInfinite;
    for (Piece& piece : pieces) {
        const double apart = norm(piece.edge.begin() - point);
        if (!piece.used && piece.enters == enters && apart < least) {
            least = apart;
            best = &piece;
        }
    }
    return best;
}

// The pieces in an octant, and its boundary.
class OctantLoops {
public:
    OctantLoops(std::vector<Piece>& pieces, Vec3d signs, double gap, const std::string& place)
        : pieces_{pieces}, boundary_{signs}, gap_{gap}, place_{place}
    {
    }

    // boundary_inside  whether the boundary belongs to the face, where no edge meets it
    std::vector<SphereLoop> loops(bool boundary_inside)
    {
        std::vector<SphereLoop> out;
        if (boundary_inside) {
            out.push_back(boundary_.between(0, 3));
        }
        for (const bool enters : {true, false}) {
            for (Piece& piece : pieces_) {
                if (!piece.used && piece.enters == enters) {
                    out.push_back(loop_from(piece));
                }
            }
        }
        return out;
    }

private:
    SphereLoop loop_from(Piece& first)
    {
        SphereLoop loop;
        for (Piece* at = &first; at != nullptr;) {
            at->used = true;
            loop.push_back(at->edge);
            at = at->leaves ? along_boundary(*at, first, loop) : next_of(*at, first);
        }
        return loop;
    }

    // The piece that begins where this one ends inside the octant; none where the loop is closed.
    Piece* next_of(const Piece& piece, const Piece& first)
    {
        const Vec3d end = piece.edge.end();
        Piece* next = nearest(pieces_, end, false);
        const double to_next = next != nullptr ? norm(next->edge.begin() - end) : kInfinite;
        const double to_first = first.enters ? kInfinite : norm(first.edge.begin() - end);
        if (std::min(to_next, to_first) > gap_) {
            throw InputError(place_ + ": the edges on a sphere do not close");
        }
        return to_next < to_first ? next : nullptr;
    }

    // Follows the boundary to the next piece that enters; none where that is the first.
    Piece* along_boundary(const Piece& piece, const Piece& first, SphereLoop& loop)
    {
        const double from = boundary_.place_of(piece.edge.end());
        Piece* next = nullptr;
        double least = kInfinite;
        double to = from;
        for (Piece& other : pieces_) {
            const double there = other.enters ? boundary_.place_of(other.edge.begin()) : 0;
            const double ahead = std::fmod(there - from + 3, 3);
            if (other.enters && ahead < least) {
                least = ahead;
                next = &other;
                to = there;
            }
        }
        if (next == nullptr || (next->used && next != &first)) {
            throw InputError(place_ + ": the edges on a sphere do not bound a face");
        }
        const SphereLoop arcs = boundary_.between(from, to);
        loop.insert(loop.end(), arcs.begin(), arcs.end());
        return next == &first ? nullptr : next;
    }

    std::vector<Piece>& pieces_;
    Boundary boundary_;
    double gap_;
    const std::string& place_;
};

// Whether a point lies on the left of what is nearest to it of all edges.
bool is_left(const std::vector<SphereEdge>& edges, Vec3d p)
{
    constexpr double kSame = 1e-9;
    double least = kInfinite;
    double side = 0;
    for (const SphereEdge& edge : edges) {
        Vec3d a = edge.begin();
        for (int k = 1; k <= kChords; ++k) {
            const Vec3d b = edge.at(parameter(edge, k)).point;
            const Vec3d along = b - a;
            const double t = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
            const Vec3d apart = p - (a + along * t);
            const Vec3d left = cross(a, along) / norm(along);
            const double distance = norm(apart);
            // where two chords are equally near, at the point between them, both count
            if (distance < least - kSame) {
                side = 0;
            }
            if (distance < least + kSame) {
                side += dot(left, apart);
                least = std::min(least, distance);
            }
            a = b;
        }
    }
    return side > 0;
}

// Of an octant whose boundary no edge meets.
bool is_boundary_inside(const std::vector<SphereEdge>& edges,
                        const Boundary& boundary,
                        const std::string& place)
{
    if (edges.empty()) {
        return true;
    }
    const bool inside = is_left(edges, boundary.corner(0));
    for (unsigned k = 0; k < 3; ++k) {
        if (is_left(edges, boundary.corner(k)) != inside ||
            is_left(edges, boundary.middle(k)) != inside) {
            throw InputError(place + ": the edges on a sphere have the face on both sides");
        }
    }
    return inside;
}

}  // namespace

double cut_quality(const std::vector<SphereEdge>& edges)
{
    double least = 1;
    for (const SphereEdge& edge : edges) {
        for (int k = 0; k <= kChords; ++k) {
            const auto [p, tangent] = edge.at(parameter(edge, k));
            const Vec3d along = tangent / norm(tangent);
            for (unsigned axis = 0; axis < 3; ++axis) {
                const double off = std::abs(p[axis]);
                const bool is_end = k == 0 || k == kChords;
                least = std::min(least, is_end ? off : std::hypot(off, along[axis]));
                least = std::min(least, std::max(off, std::abs(p[(axis + 1) % 3])));
            }
        }
    }
    return least;
}

std::array<SphereOctant, 8> sphere_octants(const std::vector<SphereEdge>& edges,
                                           double gap,
                                           const std::string& place)
{
    std::array<std::vector<Piece>, 8> pieces;
    for (const SphereEdge& edge : edges) {
        for (const Piece& piece : cut(edge)) {
            pieces[octant_of(piece.edge)].push_back(piece);
        }
    }
    std::array<SphereOctant, 8> octants;
    for (std::size_t i = 0; i < octants.size(); ++i) {
        octants[i].signs = {(i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                            (i & 4U) != 0 ? 1.0 : -1.0};
        const bool is_met = std::any_of(pieces[i].begin(), pieces[i].end(),
                                        [](const Piece& piece) { return piece.enters; });
        const bool inside = !is_met && is_boundary_inside(edges, Boundary{octants[i].signs}, place);
        octants[i].loops = OctantLoops{pieces[i], octants[i].signs, gap, place}.loops(inside);
    }
    return octants;
}

}  // namespace cusp::import
