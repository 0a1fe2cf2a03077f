// Open edges by sorting, corners merged and edges divided by a grid, loops by trails.
#include "host_tools/job/import/mesh_borders.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/part_model/corner_table.hpp"

namespace cusp::import {

using part_model::CornerTable;

namespace {

using Triangle = std::array<Vec3d, 3>;

// An edge of a facet, from corner `a` to corner `b` of the table.
struct OpenEdge {
    std::uint32_t a, b;
    std::uint32_t facet;
    std::uint8_t side;  // of the facet: from its corner of this number to the next
};

std::pair<std::uint32_t, std::uint32_t> ends_of(const OpenEdge& edge)
{
    return std::minmax(edge.a, edge.b);
}

// Edges with the same ends cancel in pairs; of an odd number the first stays.
std::vector<OpenEdge> odd_edges(std::vector<OpenEdge> edges)
{
    std::sort(edges.begin(), edges.end(), [](const OpenEdge& s, const OpenEdge& t) {
        return std::make_tuple(ends_of(s), s.facet, s.side) <
               std::make_tuple(ends_of(t), t.facet, t.side);
    });
    std::vector<OpenEdge> odd;
    std::size_t end = 0;
    for (std::size_t begin = 0; begin < edges.size(); begin = end) {
        for (end = begin; end < edges.size() && ends_of(edges[end]) == ends_of(edges[begin]);) {
            ++end;
        }
        if ((end - begin) % 2 == 1) {
            odd.push_back(edges[begin]);
        }
    }
    return odd;
}

// Points by cells of a cubic grid.
class PointGrid {
public:
    explicit PointGrid(double cell) : cell_{cell} {}

    void add(std::uint32_t number, Vec3d at) { cells_[key(cell_of(at))].push_back(number); }

    // Calls visit(number) for all points within a cell's size of `at`, and some others.
    template <typename Visit>
    void near(Vec3d at, const Visit& visit) const
    {
        const Cell middle = cell_of(at);
        for (int k = 0; k < 27; ++k) {
            const auto found = cells_.find(
                key({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1}));
            if (found != cells_.end()) {
                std::for_each(found->second.begin(), found->second.end(), visit);
            }
        }
    }

private:
    using Cell = std::array<std::int64_t, 3>;

    Cell cell_of(Vec3d at) const
    {
        const auto along = [&](double value) {
            return static_cast<std::int64_t>(std::floor(value / cell_));
        };
        return {along(at.x), along(at.y), along(at.z)};
    }
    static std::uint64_t key(const Cell& cell)
    {
        std::uint64_t sum = 0;
        for (const std::int64_t value : cell) {
            sum = (sum ^ static_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15U;
            sum ^= sum >> 31U;
        }
        return sum;
    }

    double cell_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

class Borders {
public:
    explicit Borders(const std::vector<Triangle>& triangles) : triangles_{triangles}
    {
        CornerTable table{3 * triangles.size(), corners_};
        edges_.reserve(3 * triangles.size());
        for (std::uint32_t f = 0; f < triangles.size(); ++f) {
            std::array<std::uint32_t, 3> numbers{};
            for (std::size_t k = 0; k < 3; ++k) {
                numbers[k] = table.number_of(triangles[f][k]);
            }
            for (std::uint8_t k = 0; k < 3; ++k) {
                edges_.push_back({numbers[k], numbers[(k + 1U) % 3], f, k});
            }
        }
        edges_ = odd_edges(std::move(edges_));
    }

    std::vector<BorderLoop> loops()
    {
        if (!edges_.empty()) {
            merge_corners();
            divide_edges();
            edges_ = odd_edges(std::move(edges_));
            trace();
        }
        return std::move(loops_);
    }

private:
    void merge_corners()
    {
        PointGrid kept{kSewn};
        std::unordered_map<std::uint32_t, std::uint32_t> merged;
        const auto one_for = [&](std::uint32_t corner) {
            const auto [found, is_new] = merged.try_emplace(corner, corner);
            if (is_new) {
                const Vec3d at = corners_[corner];
                std::uint32_t nearest = corner;
                double least = kSewn;
                kept.near(at, [&](std::uint32_t other) {
                    const double off = norm(corners_[other] - at);
                    std::tie(least, nearest) =
                        std::min(std::make_pair(off, other), std::make_pair(least, nearest));
                });
                if (nearest == corner) {
                    kept.add(corner, at);
                    kept_.push_back(corner);
                }
                found->second = nearest;
            }
            return found->second;
        };
        std::vector<OpenEdge> long_ones;
        for (const OpenEdge& edge : edges_) {
            const OpenEdge moved{one_for(edge.a), one_for(edge.b), edge.facet, edge.side};
            if (moved.a != moved.b) {
                long_ones.push_back(moved);
            }
        }
        edges_ = std::move(long_ones);
    }

    // At corners of others that lie on them.
    void divide_edges()
    {
        double sum = 0;
        for (const OpenEdge& edge : edges_) {
            sum += norm(corners_[edge.b] - corners_[edge.a]);
        }
        const double cell =
            std::max(4 * kSewn, edges_.empty() ? 0 : sum / static_cast<double>(edges_.size()));
        PointGrid grid{cell};
        for (const std::uint32_t corner : kept_) {
            grid.add(corner, corners_[corner]);
        }
        std::vector<OpenEdge> parts;
        for (const OpenEdge& edge : edges_) {
            OpenEdge part = edge;
            for (const auto& [share, corner] : corners_on(edge, grid, cell)) {
                part.b = corner;
                parts.push_back(part);
                part.a = corner;
            }
            part.b = edge.b;
            parts.push_back(part);
        }
        edges_ = std::move(parts);
    }

    // With their share of the way from a to b, in order.
    std::vector<std::pair<double, std::uint32_t>> corners_on(const OpenEdge& edge,
                                                             const PointGrid& grid,
                                                             double cell) const
    {
        const Vec3d a = corners_[edge.a];
        const Vec3d along = corners_[edge.b] - a;
        const double length = norm(along);
        std::vector<std::pair<double, std::uint32_t>> out;
        const auto look_at = [&](std::uint32_t corner) {
            const Vec3d from_a = corners_[corner] - a;
            const double share = dot(from_a, along) / (length * length);
            if (corner != edge.a && corner != edge.b && share > 0 && share < 1 &&
                norm(from_a - along * share) < kSewn) {
                out.emplace_back(share, corner);
            }
        };
        const int steps = static_cast<int>(std::ceil(length / cell));
        for (int k = 0; k <= steps; ++k) {
            grid.near(a + along * (static_cast<double>(k) / steps), look_at);
        }
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        return out;
    }

    void trace()
    {
        for (std::uint32_t e = 0; e < edges_.size(); ++e) {
            at_corner_[edges_[e].a].push_back(e);
            at_corner_[edges_[e].b].push_back(e);
        }
        used_.assign(edges_.size(), 0);
        for (std::uint32_t e = 0; e < edges_.size(); ++e) {
            if (used_[e] == 0) {
                trace_from(edges_[e].a);
            }
        }
    }

    // Walks until nothing is left at `start`; each corner that is met again closes a loop.
    void trace_from(std::uint32_t start)
    {
        std::vector<std::uint32_t> trail{start};  // corners
        std::vector<BorderEdge> ways;
        std::unordered_map<std::uint32_t, std::size_t> place{{start, 0}};
        while (true) {
            const auto edge = unused_at(trail.back(), ways);
            if (!edge) {
                return;
            }
            used_[*edge] = 1;
            const bool forward = edges_[*edge].a == trail.back();
            const std::uint32_t next = forward ? edges_[*edge].b : edges_[*edge].a;
            ways.push_back(way_of(edges_[*edge], forward));
            const auto [met, is_new] = place.try_emplace(next, trail.size());
            if (is_new) {
                trail.push_back(next);
                continue;
            }
            const auto first = static_cast<std::ptrdiff_t>(met->second);
            loops_.emplace_back(ways.begin() + first, ways.end());
            ways.resize(met->second);
            while (trail.size() > ways.size() + 1) {
                place.erase(trail.back());
                trail.pop_back();
            }
        }
    }

    // The next edge, if any is left. If borders meet at a corner, the one round the same opening.
    std::optional<std::uint32_t> unused_at(std::uint32_t corner,
                                           const std::vector<BorderEdge>& ways) const
    {
        std::optional<std::uint32_t> found;
        double least = kInfinite;
        for (const std::uint32_t e : at_corner_.at(corner)) {
            if (used_[e] == 0) {
                const bool forward = edges_[e].a == corner;
                const Vec3d next = corners_[forward ? edges_[e].b : edges_[e].a];
                const double turn =
                    ways.empty() ? (forward ? 0 : 1) : turn_through_opening(ways.back(), next);
                if (!found || turn < least) {
                    found = e;
                    least = turn;
                }
            }
        }
        return found;
    }

    // In plan, from the way back to the way on: the angle on the side without the facet, 0 to 2 pi.
    static double turn_through_opening(const BorderEdge& last, Vec3d next)
    {
        const Vec3d back = last.begin - last.end;
        const Vec3d on = next - last.end;
        const Vec3d facet = last.third - last.end;
        const double angle =
            elementary::atan2(back.x * on.y - back.y * on.x, back.x * on.x + back.y * on.y);
        const bool facet_is_left = back.y * facet.x - back.x * facet.y > 0;
        const double turn = facet_is_left ? angle : -angle;
        return turn > 0 ? turn : turn + 2 * kPi;
    }

    BorderEdge way_of(const OpenEdge& edge, bool forward) const
    {
        const Triangle& facet = triangles_[edge.facet];
        BorderEdge way{corners_[edge.a], corners_[edge.b], facet[(edge.side + 2U) % 3],
                       cross(facet[1] - facet[0], facet[2] - facet[0])};
        if (!forward) {
            std::swap(way.begin, way.end);
        }
        return way;
    }

    const std::vector<Triangle>& triangles_;
    std::vector<Vec3d> corners_;
    std::vector<OpenEdge> edges_;
    std::vector<std::uint32_t> kept_;  // corners of the open edges
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> at_corner_;
    std::vector<std::uint8_t> used_;
    std::vector<BorderLoop> loops_;
};

}  // namespace

std::vector<BorderLoop> border_loops(const std::vector<std::array<Vec3d, 3>>& triangles)
{
    return Borders{triangles}.loops();
}

}  // namespace cusp::import
