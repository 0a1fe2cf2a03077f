// Cutting a closed polyline at all crossings, with each part's direction kept, leaves loops that do not cross.
#include "host_tools/job/import/trim_lobes.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::import {

using nurbs::Curve;
using nurbs::Surface;
using nurbs::SurfacePoint;
using Ring = std::vector<Vec2d>;  // closed; the last point equals the first

namespace {

constexpr double kLobeChord = 1e-6;  // of the domain's longer side; trim_loops() has 1e-5
constexpr std::size_t kMostRings = 64;
constexpr double kSliver = 1e-3;  // mm: narrower rings are no part of a face

// The place where two segments cross, if they do.
std::optional<Vec2d> crossing(Vec2d a, Vec2d b, Vec2d c, Vec2d d)
{
    const double from = cross(d - c, a - c);
    const double to = cross(d - c, b - c);
    if (!(from * to < 0) || !(cross(b - a, c - a) * cross(b - a, d - a) < 0)) {
        return std::nullopt;
    }
    return a + (b - a) * (from / (from - to));
}

// Cuts a ring in two at its first crossing. Returns false where it has none.
bool cut_once(Ring& ring, Ring& other)
{
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
        for (std::size_t j = i + 2; j + 1 < ring.size(); ++j) {
            const auto at = crossing(ring[i], ring[i + 1], ring[j], ring[j + 1]);
            if (at) {
                const auto first = ring.begin() + static_cast<std::ptrdiff_t>(i) + 1;
                const auto last = ring.begin() + static_cast<std::ptrdiff_t>(j) + 1;
                other = {*at};
                other.insert(other.end(), first, last);
                other.push_back(*at);
                *ring.erase(first, last - 1) = *at;
                return true;
            }
        }
    }
    return false;
}

// None where there are too many.
std::vector<Ring> rings_of(const Ring& ring)
{
    std::vector<Ring> rings{ring};
    for (std::size_t k = 0; k < rings.size(); ++k) {
        for (Ring other; cut_once(rings[k], other);) {
            rings.push_back(other);
            if (rings.size() > kMostRings) {
                return {};
            }
        }
    }
    return rings;
}

// mm on the surface: four times the area of a ring by the way round it.
double width_of(const Ring& ring, const Surface& surface)
{
    double length = 0;
    Vec2d middle{};
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
        const Vec2d next = ring[i + 1];
        length += norm(point_at(surface, next.x, next.y) - point_at(surface, ring[i].x, ring[i].y));
        middle = middle + next * (1.0 / static_cast<double>(ring.size() - 1));
    }
    const SurfacePoint at = derivatives_at(surface, middle.x, middle.y);
    const double area = std::abs(job::signed_area(ring)) * norm(cross(at.du, at.dv));
    return length > 0 ? 4 * area / length : 0;
}

Curve chords_of(const Ring& ring)
{
    Curve chords{1, {0}, {}, {}};
    for (const Vec2d p : ring) {
        chords.knots.push_back(static_cast<double>(chords.points.size()));
        chords.points.push_back({p.x, p.y, 0});
        chords.weights.push_back(1);
    }
    chords.knots.push_back(chords.knots.back());
    return chords;
}

}  // namespace

std::optional<LobeCut> cut_lobes(const std::vector<Curve>& loop,
                                 double width,
                                 const Surface& surface)
{
    const double size =
        std::max(surface.u_end() - surface.u_begin(), surface.v_end() - surface.v_begin());
    std::vector<Ring> rings = rings_of(job::loop_polyline(loop, kLobeChord * size));
    if (rings.size() < 2) {
        return std::nullopt;
    }
    std::sort(rings.begin(), rings.end(), [](const Ring& a, const Ring& b) {
        return std::abs(job::signed_area(a)) > std::abs(job::signed_area(b));
    });
    LobeCut cut{{}, 0};
    for (const Ring& ring : rings) {
        const bool same_way = job::signed_area(ring) * job::signed_area(rings[0]) > 0;
        const Vec2d middle = 0.5 * (ring[0] + ring[1]);
        const double wide = width_of(ring, surface);
        if (&ring == &rings[0] ||
            (same_way && wide > kSliver && !job::encloses(rings[0], middle))) {
            cut.loops.push_back({chords_of(ring)});
        } else if (wide > width) {
            return std::nullopt;
        } else {
            cut.widest = std::max(cut.widest, wide);
        }
    }
    return cut;
}

}  // namespace cusp::import
