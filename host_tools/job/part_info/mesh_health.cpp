// Edges by sorting, shells by union-find with the orientation of each facet.
#include "host_tools/job/part_info/mesh_health.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "host_tools/geometry/part_model/corner_table.hpp"

namespace cusp::part_info {

using part_model::CornerTable;

namespace {

// Sets whose members are marked as oriented like their root, or against it.
class SidedSets {
public:
    explicit SidedSets(std::size_t count) : parent_(count), against_(count, 0)
    {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    // The root, and whether `k` runs against it.
    std::pair<std::uint32_t, bool> find(std::uint32_t k)
    {
        std::uint32_t root = k;
        bool turned = false;
        while (parent_[root] != root) {
            turned = turned != (against_[root] != 0);
            root = parent_[root];
        }
        for (bool left = turned; k != root;) {
            const bool own = against_[k] != 0;
            against_[k] = left ? 1 : 0;
            left = left != own;
            k = std::exchange(parent_[k], root);
        }
        return {root, turned};
    }

    void join(std::uint32_t a, std::uint32_t b, bool against)
    {
        const auto [root_a, turned_a] = find(a);
        const auto [root_b, turned_b] = find(b);
        if (root_a != root_b) {
            parent_[root_b] = root_a;
            against_[root_b] = (turned_a != turned_b) != against ? 1 : 0;
        }
    }

private:
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> against_;
};

// One side of a facet: both corners, the lower first, and the facet with its direction.
struct Side {
    std::uint32_t low, high;
    std::uint32_t facet;
    bool forward;  // from low to high
};

std::vector<Side> sides_of(const WeldedMesh& mesh)
{
    std::vector<Side> sides;
    sides.reserve(3 * mesh.facets.size());
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.facets[f][k];
            const std::uint32_t b = mesh.facets[f][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), f, a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
        return std::tie(s.low, s.high, s.facet) < std::tie(t.low, t.high, t.facet);
    });
    return sides;
}

// Properties of a shell, indexed by its root.
struct Shell {
    std::size_t facets{};
    std::size_t against{};
    double volume{};  // signed, with all facets oriented like the root
    bool open{};
};

class Welding {
public:
    explicit Welding(const std::vector<std::array<Vec3d, 3>>& triangles) : sets_{triangles.size()}
    {
        mesh_.facets.reserve(triangles.size());
        CornerTable table{3 * triangles.size(), mesh_.corners};
        for (const auto& t : triangles) {
            mesh_.facets.push_back(
                {table.number_of(t[0]), table.number_of(t[1]), table.number_of(t[2])});
        }
    }

    WeldedMesh finished()
    {
        look_at_edges();
        look_at_shells();
        return std::move(mesh_);
    }

private:
    Vec3d middle(const Side& side) const
    {
        return (mesh_.corners[side.low] + mesh_.corners[side.high]) / 2.0;
    }

    void look_at_edges()
    {
        MeshHealth& health = mesh_.health;
        const std::vector<Side> sides = sides_of(mesh_);
        std::vector<Side> borders;
        std::size_t end = 0;
        for (std::size_t begin = 0; begin < sides.size(); begin = end) {
            const Side& first = sides[begin];
            for (end = begin;
                 end < sides.size() && sides[end].low == first.low && sides[end].high == first.high;
                 ++end) {
                sets_.join(first.facet, sides[end].facet,
                           first.forward == sides[end].forward && end > begin);
            }
            if (end - begin == 1) {
                borders.push_back(first);
            } else if (end - begin == 2) {
                mesh_.edges.push_back(
                    {{first.low, first.high}, {first.facet, sides[end - 1].facet}});
            } else {
                ++health.non_manifold_edges;
                health.non_manifold_at = health.non_manifold_at.value_or(middle(first));
                borders_of_shells_.push_back(first.facet);
            }
        }
        health.open_edges = borders.size();
        if (!borders.empty()) {
            health.hole_at = middle(borders.front());
        }
        count_holes(borders);
    }

    void count_holes(const std::vector<Side>& borders)
    {
        SidedSets joined{borders.empty() ? 0 : mesh_.corners.size()};
        for (const Side& side : borders) {
            joined.join(side.low, side.high, false);
            borders_of_shells_.push_back(side.facet);
        }
        std::vector<std::uint32_t> roots;
        for (const Side& side : borders) {
            roots.push_back(joined.find(side.low).first);
        }
        std::sort(roots.begin(), roots.end());
        mesh_.health.holes =
            static_cast<std::size_t>(std::unique(roots.begin(), roots.end()) - roots.begin());
    }

    void look_at_shells()
    {
        MeshHealth& health = mesh_.health;
        std::vector<Shell> shells(mesh_.facets.size());
        const Vec3d origin = mesh_.corners.front();
        for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f) {
            const auto [root, against] = sets_.find(f);
            const auto& corners = mesh_.facets[f];
            const Vec3d a = mesh_.corners[corners[0]] - origin;
            const double six = dot(
                a, cross(mesh_.corners[corners[1]] - origin, mesh_.corners[corners[2]] - origin));
            ++shells[root].facets;
            shells[root].against += against ? 1 : 0;
            shells[root].volume += against ? -six : six;
        }
        for (const std::uint32_t facet : borders_of_shells_) {
            shells[sets_.find(facet).first].open = true;
        }
        for (const Shell& shell : shells) {
            const bool turned = 2 * shell.against > shell.facets;
            health.shells += shell.facets > 0 ? 1 : 0;
            health.inverted_facets += turned ? shell.facets - shell.against : shell.against;
            const double volume = turned ? -shell.volume : shell.volume;
            health.inside_out_shells += shell.facets > 0 && !shell.open && volume < 0 ? 1 : 0;
        }
        health.closed = borders_of_shells_.empty();
        mesh_.outwards.resize(mesh_.facets.size());
        for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f) {
            const auto [root, against] = sets_.find(f);
            const bool inwards = against != (shells[root].volume < 0);
            mesh_.outwards[f] = static_cast<std::int8_t>(shells[root].open ? 0 : inwards ? -1 : 1);
        }
    }

    WeldedMesh mesh_;
    SidedSets sets_;
    std::vector<std::uint32_t> borders_of_shells_;  // facets beside open and non-manifold edges
};

}  // namespace

WeldedMesh weld(const std::vector<std::array<Vec3d, 3>>& triangles)
{
    return Welding{triangles}.finished();
}

}  // namespace cusp::part_info
