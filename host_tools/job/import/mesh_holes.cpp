// Each border loop is a hole where the facets beside it lie outside it in plan.
#include "host_tools/job/import/mesh_holes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/job/import/facets.hpp"
#include "host_tools/job/import/mesh_borders.hpp"
#include "host_tools/job/import/polygon_triangles.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using part_model::PartModel;

namespace {

using Triangle = std::array<Vec3d, 3>;

constexpr double kSame = 0.01;  // mm: heights that are one
constexpr double kWallReach =
    1e-3;  // mm in plan: a facet beside an edge that reaches no further is a wall
constexpr std::size_t kListed = 4;  // holes in the sentence

double cross_in_plan(Vec3d a, Vec3d b) { return a.x * b.y - a.y * b.x; }

double length_in_plan(Vec3d a) { return elementary::hypot(a.x, a.y); }

// Twice the area in plan; above 0 counter-clockwise.
double turned_area(const BorderLoop& loop)
{
    double sum = 0;
    for (const BorderEdge& edge : loop) {
        sum += cross_in_plan(edge.begin - loop.front().begin, edge.end - loop.front().begin);
    }
    return sum;
}

double length_of(const BorderLoop& loop)
{
    double sum = 0;
    for (const BorderEdge& edge : loop) {
        sum += norm(edge.end - edge.begin);
    }
    return sum;
}

// True if the edge asks for a cover of its loop: 1, or contradicts: -1. 0: of no length in plan.
//
// inside  unit vector in plan to the inside of the loop
int vote_of(const BorderEdge& edge, Vec3d inside)
{
    const double beside = dot(edge.third - edge.begin, inside);
    if (std::abs(beside) > kWallReach) {
        return beside < 0 ? 1 : -1;
    }
    const bool rises = edge.third.z > std::max(edge.begin.z, edge.end.z);
    const bool faces_inside = dot(edge.normal, inside) > 0;
    return rises == faces_inside ? 1 : -1;
}

// Seen from above, whether the facets beside the loop lie outside it along most of its length.
bool is_around_hole(const BorderLoop& loop)
{
    const double sense = turned_area(loop) > 0 ? 1 : -1;
    double votes = 0;
    for (const BorderEdge& edge : loop) {
        const Vec3d along = edge.end - edge.begin;
        const double length = length_in_plan(along);
        if (length > 0) {
            const Vec3d inside = Vec3d{-along.y, along.x, 0} * (sense / length);
            votes += length * vote_of(edge, inside);
        }
    }
    return votes > 0;
}

bool is_level_at(const BorderLoop& loop, double z)
{
    return std::all_of(loop.begin(), loop.end(),
                       [&](const BorderEdge& edge) { return edge.begin.z < z + kSame; });
}

double distance_to(Vec3d at, const BorderEdge& edge)
{
    const Vec3d along = edge.end - edge.begin;
    const double share = std::clamp(dot(at - edge.begin, along) / dot(along, along), 0.0, 1.0);
    return norm(at - edge.begin - along * share);
}

// True if the edge has a border beside it that a crack apart would be the same. Only edges of its
// own loop count that are far along it.
bool has_other_side(const std::vector<BorderLoop>& loops, std::size_t own, std::size_t at)
{
    constexpr double kFarAlong = 4 * kCrack;
    const Vec3d middle = (loops[own][at].begin + loops[own][at].end) / 2.0;
    const double whole = length_of(loops[own]);
    for (std::size_t k = 0; k < loops.size(); ++k) {
        double along = 0;
        double own_along = 0;
        for (std::size_t e = 0; k == own && e < at; ++e) {
            own_along += norm(loops[k][e].end - loops[k][e].begin);
        }
        for (std::size_t e = 0; e < loops[k].size(); ++e) {
            const double length = norm(loops[k][e].end - loops[k][e].begin);
            const double off = std::abs(along - own_along);
            const bool counts =
                k != own || (e != at && std::min(off, whole - off) > kFarAlong + length);
            if (counts && distance_to(middle, loops[k][e]) < kCrack) {
                return true;
            }
            along += length;
        }
    }
    return false;
}

bool is_crack(const std::vector<BorderLoop>& loops, std::size_t own)
{
    constexpr std::size_t kAsked = 64;  // edges
    const std::size_t step = std::max<std::size_t>(1, loops[own].size() / kAsked);
    double met = 0;
    double asked = 0;
    for (std::size_t e = 0; e < loops[own].size(); e += step) {
        const double length = norm(loops[own][e].end - loops[own][e].begin);
        asked += length;
        met += has_other_side(loops, own, e) ? length : 0;
    }
    return met > 0.5 * asked;
}

MeshHole hole_in(const BorderLoop& loop)
{
    std::vector<Vec3d> corners;
    Vec3d low = loop.front().begin;
    Vec3d high = low;
    for (const BorderEdge& edge : loop) {
        corners.push_back(edge.begin);
        low = {std::min(low.x, edge.begin.x), std::min(low.y, edge.begin.y),
               std::min(low.z, edge.begin.z)};
        high = {std::max(high.x, edge.begin.x), std::max(high.y, edge.begin.y),
                std::max(high.z, edge.begin.z)};
    }
    Facets cover;  // those with an area
    for (const Triangle& triangle : polygon_triangles(std::move(corners))) {
        add_facet(triangle, cover);
    }
    return {(low + high) / 2.0, high - low, std::move(cover.triangles)};
}

// The height of the triangle's plane at (x, y); no value outside it in plan.
std::optional<double> height_of(const Triangle& t, double x, double y)
{
    const double whole = cross_in_plan(t[1] - t[0], t[2] - t[0]);
    const Vec3d at{x, y, 0};
    const double b = cross_in_plan(at - t[0], t[2] - t[0]) / whole;
    const double c = cross_in_plan(t[1] - t[0], at - t[0]) / whole;
    if (!(b >= 0 && c >= 0 && b + c <= 1)) {
        return std::nullopt;
    }
    return t[0].z + b * (t[1].z - t[0].z) + c * (t[2].z - t[0].z);
}

// True if some place of the cover lies under nothing: neither the mesh nor the covers before.
bool is_seen(const MeshHole& hole, const PartModel& mesh, const std::vector<MeshHole>& before)
{
    const auto is_under = [&](Vec3d at, double height) {
        return height > at.z - kSame;
    };
    for (const Triangle& t : hole.cover) {
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3d middle = (t[0] + t[1] + t[2]) / 3.0;
            const Vec3d at = k == 3 ? middle : middle + (t[k] - middle) * 0.8;
            const auto top = mesh.height_at(at.x, at.y);
            bool hidden = top && is_under(at, top->point.z);
            for (const MeshHole& other : before) {
                for (const Triangle& over : other.cover) {
                    const auto height = height_of(over, at.x, at.y);
                    hidden = hidden || (height && is_under(at, *height));
                }
            }
            if (!hidden) {
                return true;
            }
        }
    }
    return false;
}

std::string words_of(const MeshHole& hole)
{
    return fmt::format("{:.4g} x {:.4g} mm at x {:.6g} y {:.6g} z {:.6g} mm", hole.size.x,
                       hole.size.y, hole.middle.x + 0.0, hole.middle.y + 0.0, hole.middle.z + 0.0);
}

}  // namespace

std::vector<MeshHole> holes_from_above(const std::vector<Triangle>& triangles)
{
    const std::vector<BorderLoop> loops = border_loops(triangles);
    std::vector<MeshHole> found;
    double lowest = kInfinite;
    for (const Triangle& t : triangles) {
        lowest = std::min({lowest, t[0].z, t[1].z, t[2].z});
    }
    for (std::size_t k = 0; k < loops.size(); ++k) {
        const BorderLoop& loop = loops[k];
        const bool has_room = std::abs(turned_area(loop)) > kCrack * length_of(loop);
        if (has_room && is_around_hole(loop) && !is_level_at(loop, lowest) && !is_crack(loops, k)) {
            found.push_back(hole_in(loop));
        }
    }
    if (found.empty()) {
        return found;
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const MeshHole& a, const MeshHole& b) { return a.middle.z > b.middle.z; });
    const PartModel mesh{triangles};
    std::vector<MeshHole> seen;
    for (MeshHole& hole : found) {
        if (is_seen(hole, mesh, seen)) {
            seen.push_back(std::move(hole));
        }
    }
    std::stable_sort(seen.begin(), seen.end(), [](const MeshHole& a, const MeshHole& b) {
        return a.size.x * a.size.y > b.size.x * b.size.y;
    });
    return seen;
}

std::vector<Triangle> covers_of_holes(const std::string& files,
                                      const char* what,
                                      const std::vector<Triangle>& triangles,
                                      std::vector<std::string>& notes)
{
    const std::vector<MeshHole> holes = holes_from_above(triangles);
    std::vector<Triangle> covers;
    std::vector<std::string> places;
    for (const MeshHole& hole : holes) {
        covers.insert(covers.end(), hole.cover.begin(), hole.cover.end());
        if (places.size() < kListed) {
            places.push_back(words_of(hole));
        }
    }
    if (holes.size() > kListed) {
        places.push_back(fmt::format("{} more", holes.size() - kListed));
    }
    if (!holes.empty()) {
        notes.push_back(fmt::format(
            "{}: {} are missing: {} of the part open above: {}; closed, so that nothing is "
            "milled through: an opening of the part needs walls in the model",
            files, what, counted(holes.size(), "hole"), fmt::join(places, "; ")));
    }
    return covers;
}

void cover_holes(const std::string& files,
                 std::vector<Triangle>& triangles,
                 std::vector<std::string>& notes)
{
    const std::vector<Triangle> covers = covers_of_holes(files, "facets", triangles, notes);
    triangles.insert(triangles.end(), covers.begin(), covers.end());
}

}  // namespace cusp::import
