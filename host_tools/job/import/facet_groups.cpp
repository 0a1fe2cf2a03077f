// Welds corners by position and joins facets along common edges.
#include "host_tools/job/import/facet_groups.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::import {

using job::crossing_of;
using job::signed_area;

namespace {

using Triangle = std::array<Vec3d, 3>;

constexpr double kSamePlace = 1e-5;  // mm
constexpr double kUpright = 1e-4;    // z of a unit normal: 0.01 mm over a wall of 100 mm
constexpr double kThin = 5e-4;       // mm, width in plan: narrower facets count as vertical
constexpr double kCrease = 0.82;     // cosine of 35 degrees
constexpr std::size_t kMostGroups = 200;

struct Corners {
    std::array<std::uint32_t, 3> of;
};

// Facets as indices of welded corners; facets that welding makes degenerate are dropped.
class Mesh {
public:
    explicit Mesh(const Facets& facets)
    {
        for (const Triangle& t : facets.triangles) {
            const Corners c{{number(t[0]), number(t[1]), number(t[2])}};
            const Vec3d n =
                cross(places_[c.of[1]] - places_[c.of[0]], places_[c.of[2]] - places_[c.of[0]]);
            if (norm(n) > 0 && c.of[0] != c.of[1] && c.of[1] != c.of[2] && c.of[2] != c.of[0]) {
                facets_.push_back(c);
                normals_.push_back(n / norm(n));
            }
        }
    }

    std::size_t size() const { return facets_.size(); }
    const Corners& corners(std::size_t facet) const { return facets_[facet]; }
    Vec3d normal(std::size_t facet) const { return normals_[facet]; }
    Vec3d place(std::uint32_t corner) const { return places_[corner]; }
    Triangle triangle(std::size_t facet) const
    {
        const auto& c = facets_[facet].of;
        return {places_[c[0]], places_[c[1]], places_[c[2]]};
    }

    void turn_over()
    {
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            std::swap(facets_[f].of[1], facets_[f].of[2]);
            normals_[f] = normals_[f] * -1.0;
        }
    }

    bool looks_up(std::size_t facet) const
    {
        const double up = normals_[facet].z;
        if (up < kUpright) {
            return false;
        }
        // The least width of the facet in plan.
        const Triangle t = triangle(facet);
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d side = t[(k + 1) % 3] - t[k];
            longest = std::max(longest, elementary::hypot(side.x, side.y));
        }
        const double area = norm(cross(t[1] - t[0], t[2] - t[0])) * up;
        constexpr double kSteep = 0.02;
        return up > kSteep || area > kThin * longest;
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    struct CellHash {
        std::size_t operator()(const Cell& c) const
        {
            std::uint64_t h = 0;
            for (const std::int64_t k : c) {
                h = (h ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15ULL;
                h ^= h >> 29U;
            }
            return static_cast<std::size_t>(h);
        }
    };

    std::uint32_t number(Vec3d p)
    {
        const Cell cell{std::llround(p.x / kSamePlace), std::llround(p.y / kSamePlace),
                        std::llround(p.z / kSamePlace)};
        const auto [at, added] = numbers_.emplace(cell, static_cast<std::uint32_t>(places_.size()));
        if (added) {
            places_.push_back(p);
        }
        return at->second;
    }

    std::unordered_map<Cell, std::uint32_t, CellHash> numbers_;
    std::vector<Vec3d> places_;
    std::vector<Corners> facets_;
    std::vector<Vec3d> normals_;
};

// A side of a facet, from its lower corner to its higher one.
struct FacetSide {
    std::uint32_t low, high;
    std::uint32_t facet;
    bool forth;  // the facet runs along it from low to high
};

std::vector<FacetSide> sides_of(const Mesh& mesh, const std::vector<std::size_t>& facets)
{
    std::vector<FacetSide> out;
    out.reserve(3 * facets.size());
    for (const std::size_t f : facets) {
        const auto& c = mesh.corners(f).of;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = c[k];
            const std::uint32_t b = c[(k + 1) % 3];
            out.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(f), a < b});
        }
    }
    std::sort(out.begin(), out.end(), [](const FacetSide& a, const FacetSide& b) {
        return std::pair{a.low, a.high} < std::pair{b.low, b.high};
    });
    return out;
}

// Calls `use(first, last)` for the sides between each two corners.
template <typename Use>
void for_each_edge(const std::vector<FacetSide>& sides, Use use)
{
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low &&
               sides[end].high == sides[i].high) {
            ++end;
        }
        use(i, end);
        i = end;
    }
}

class Groups {
public:
    explicit Groups(std::size_t count) : parent_(count)
    {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }
    std::size_t of(std::size_t k)
    {
        while (parent_[k] != k) {
            parent_[k] = parent_[parent_[k]];
            k = parent_[k];
        }
        return k;
    }
    void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }

private:
    std::vector<std::size_t> parent_;
};

// Groups in the order of their first facets. No value where two facets traverse an edge in the same
// direction.
std::optional<std::vector<std::vector<std::size_t>>> joined(const Mesh& mesh,
                                                            const std::vector<std::size_t>& up,
                                                            double crease)
{
    const std::vector<FacetSide> sides = sides_of(mesh, up);
    Groups groups{mesh.size()};
    bool against = false;
    for_each_edge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first != 2) {
            return;
        }
        const FacetSide& a = sides[first];
        const FacetSide& b = sides[first + 1];
        against = against || a.forth == b.forth;
        if (dot(mesh.normal(a.facet), mesh.normal(b.facet)) > crease) {
            groups.join(a.facet, b.facet);
        }
    });
    if (against) {
        return std::nullopt;
    }
    std::map<std::size_t, std::size_t> numbers;
    std::vector<std::vector<std::size_t>> out;
    for (const std::size_t f : up) {
        const auto [at, added] = numbers.emplace(groups.of(f), out.size());
        if (added) {
            out.emplace_back();
        }
        out[at->second].push_back(f);
    }
    return out;
}

double turn_left(Vec3d in, Vec3d out)
{
    return elementary::atan2(in.x * out.y - in.y * out.x, in.x * out.x + in.y * out.y);
}

// Closed loops of the group's boundary edges. If several edges continue from a corner, the leftmost
// one is taken, so that loops may touch but do not cross.
std::vector<std::vector<Vec3d>> outline(const Mesh& mesh, const std::vector<std::size_t>& group)
{
    const std::vector<FacetSide> sides = sides_of(mesh, group);
    std::multimap<std::uint32_t, std::uint32_t> ways;
    for_each_edge(sides, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; last - first != 2 && k < last; ++k) {
            ways.emplace(sides[k].forth ? sides[k].low : sides[k].high,
                         sides[k].forth ? sides[k].high : sides[k].low);
        }
    });
    std::vector<std::vector<Vec3d>> out;
    while (!ways.empty()) {
        const std::uint32_t begin = ways.begin()->first;
        std::uint32_t at = ways.begin()->second;
        ways.erase(ways.begin());
        std::vector<Vec3d> loop{mesh.place(begin), mesh.place(at)};
        while (at != begin) {
            auto [next, end] = ways.equal_range(at);
            if (next == end) {
                return {};
            }
            const Vec3d in = loop.back() - loop[loop.size() - 2];
            for (auto k = next; k != end; ++k) {
                if (turn_left(in, mesh.place(k->second) - loop.back()) >
                    turn_left(in, mesh.place(next->second) - loop.back())) {
                    next = k;
                }
            }
            at = next->second;
            ways.erase(next);
            loop.push_back(mesh.place(at));
        }
        out.push_back(std::move(loop));
    }
    return out;
}

// Removes collinear corners; the last point equals the first.
std::vector<Vec3d> straightened(const std::vector<Vec3d>& loop)
{
    const std::size_t n = loop.size() - 1;
    std::vector<Vec3d> out;
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3d before = out.empty() ? loop[n - 1] : out.back();
        const Vec3d a = loop[k] - before;
        const Vec3d b = loop[k + 1] - loop[k];
        const double chord = norm(loop[k + 1] - before);
        if (norm(cross(a, b)) > 0.5 * kSamePlace * chord || dot(a, b) < 0) {
            out.push_back(loop[k]);
        }
    }
    if (!out.empty()) {
        out.push_back(out.front());
    }
    return out;
}

std::vector<Vec2d> plan_of(const std::vector<Vec3d>& loop)
{
    std::vector<Vec2d> out;
    for (const Vec3d& p : loop) {
        out.push_back({p.x, p.y});
    }
    return out;
}

bool simple(const std::vector<std::vector<Vec3d>>& loops)
{
    std::vector<std::vector<Vec2d>> plan;
    for (const auto& loop : loops) {
        plan.push_back(plan_of(loop));
    }
    return !loops.empty() && !crossing_of(plan);
}

// False where the group is too narrow in plan to be distinguished from a vertical wall.
bool has_width(const std::vector<std::vector<Vec3d>>& loops)
{
    double area = 0;
    double length = 0;
    for (const auto& loop : loops) {
        const std::vector<Vec2d> plan = plan_of(loop);
        area += signed_area(plan);
        for (std::size_t k = 1; k < plan.size(); ++k) {
            length += norm(plan[k] - plan[k - 1]);
        }
    }
    return area > kThin * length;
}

std::vector<std::size_t> facets_up(const Mesh& mesh)
{
    std::vector<std::size_t> out;
    for (std::size_t f = 0; f < mesh.size(); ++f) {
        if (mesh.looks_up(f)) {
            out.push_back(f);
        }
    }
    return out;
}

}  // namespace

std::optional<std::vector<FacetGroup>> facet_groups(const Facets& facets)
{
    Mesh mesh{facets};
    std::vector<std::size_t> up = facets_up(mesh);
    if (up.empty()) {
        mesh.turn_over();
        up = facets_up(mesh);
    }
    constexpr double kNoCrease = -2.0;
    auto groups = joined(mesh, up, kCrease);
    if (groups && groups->size() > kMostGroups) {
        groups = joined(mesh, up, kNoCrease);
    }
    if (!groups || groups->empty() || groups->size() > kMostGroups) {
        return std::nullopt;
    }
    std::vector<FacetGroup> out;
    for (const auto& group : *groups) {
        FacetGroup made;
        for (const std::size_t f : group) {
            made.facets.triangles.push_back(mesh.triangle(f));
        }
        for (const auto& loop : outline(mesh, group)) {
            made.loops.push_back(straightened(loop));
            if (made.loops.back().size() < 4) {
                made.loops.pop_back();
            }
        }
        if (!simple(made.loops)) {
            return std::nullopt;
        }
        if (has_width(made.loops)) {
            out.push_back(std::move(made));
        }
    }
    if (out.empty()) {
        return std::nullopt;
    }
    return out;
}

}  // namespace cusp::import
