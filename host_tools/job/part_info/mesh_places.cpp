// The normal of an edge or corner is the mean of the normals of its facets.
#include "host_tools/job/part_info/mesh_places.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::part_info {
namespace {

constexpr double kFacetPlaces = 100000;
constexpr double kVerticalFacet = 1e-9;  // z of a unit normal

// Twice the facet's area times its normal, by the order of its corners.
Vec3d across_of(const WeldedMesh& mesh, std::size_t facet)
{
    const auto& c = mesh.facets[facet];
    return cross(mesh.corners[c[1]] - mesh.corners[c[0]], mesh.corners[c[2]] - mesh.corners[c[0]]);
}

// As above, but oriented out of the solid; upwards where there is none.
Vec3d facing(const WeldedMesh& mesh, std::size_t facet)
{
    const Vec3d across = across_of(mesh, facet);
    const int outwards = mesh.outwards[facet];
    const bool turned = outwards < 0 || (outwards == 0 && across.z < 0);
    return turned ? across * -1.0 : across;
}

GroundPlace place_at(Vec3d point, Vec3d direction, double area, bool of_solid)
{
    const Vec3d normal = direction / norm(direction);
    return {point, normal, area, !of_solid && std::abs(normal.z) < kVerticalFacet,
            of_solid && normal.z < -kVerticalFacet};
}

void add_facet(const WeldedMesh& mesh,
               std::size_t facet,
               double each,
               double stands_for,
               std::vector<GroundPlace>& places)
{
    constexpr int kMostParts = 64;
    const auto& c = mesh.facets[facet];
    const Vec3d a = mesh.corners[c[0]];
    const Vec3d along = mesh.corners[c[1]] - a;
    const Vec3d up = mesh.corners[c[2]] - a;
    const Vec3d direction = facing(mesh, facet);
    const double area = norm(direction) / 2;
    // n * n equal triangles
    const int n = std::clamp(static_cast<int>(std::ceil(std::sqrt(area / each))), 1, kMostParts);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < 2 * (n - i) - 1; ++j) {
            const int whole = j / 2;
            const double shift = j % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
            const Vec3d point = a + along * ((i + shift) / n) + up * ((whole + shift) / n);
            places.push_back(
                place_at(point, direction, stands_for * area / (n * n), mesh.outwards[facet] != 0));
        }
    }
}

struct Crease {
    double width_over_turn;  // mm: the radius of the fillet that this edge may approximate
    std::size_t edge;
};

std::size_t other_corner(const WeldedMesh& mesh, std::uint32_t facet, const MeshEdge& edge)
{
    for (const std::uint32_t corner : mesh.facets[facet]) {
        if (corner != edge.corners[0] && corner != edge.corners[1]) {
            return corner;
        }
    }
    return edge.corners[0];
}

std::vector<Crease> concave_edges(const WeldedMesh& mesh)
{
    constexpr double kLeastTurn = 1e-4;  // radians
    std::vector<Crease> creases;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        const MeshEdge& edge = mesh.edges[e];
        const Vec3d a = mesh.corners[edge.corners[0]];
        const Vec3d n0 = facing(mesh, edge.facets[0]);
        const Vec3d n1 = facing(mesh, edge.facets[1]);
        const Vec3d beyond = mesh.corners[other_corner(mesh, edge.facets[1], edge)] - a;
        const double turn = elementary::atan2(norm(cross(n0, n1)), dot(n0, n1));
        if (turn > kLeastTurn && dot(n0, beyond) > 0) {
            const double length = norm(mesh.corners[edge.corners[1]] - a);
            creases.push_back({(norm(n0) + norm(n1)) / (2 * length * turn), e});
        }
    }
    return creases;
}

}  // namespace

std::vector<GroundPlace> facet_places(const WeldedMesh& mesh)
{
    double area = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        area += norm(across_of(mesh, f)) / 2;
    }
    const auto step = std::max<std::size_t>(
        1, static_cast<std::size_t>(static_cast<double>(mesh.facets.size()) / kFacetPlaces));
    std::vector<GroundPlace> places;
    for (std::size_t f = 0; f < mesh.facets.size(); f += step) {
        add_facet(mesh, f, area / kFacetPlaces, static_cast<double>(step), places);
    }
    return places;
}

std::vector<GroundPlace> crease_places(const WeldedMesh& mesh, std::size_t max_count)
{
    std::vector<Crease> creases = concave_edges(mesh);
    const std::size_t kept = std::min(max_count, creases.size());
    std::partial_sort(creases.begin(), creases.begin() + static_cast<std::ptrdiff_t>(kept),
                      creases.end(), [](const Crease& a, const Crease& b) {
                          return std::tie(a.width_over_turn, a.edge) <
                                 std::tie(b.width_over_turn, b.edge);
                      });
    creases.resize(kept);
    std::vector<GroundPlace> places;
    for (const Crease& crease : creases) {
        const MeshEdge& edge = mesh.edges[crease.edge];
        const Vec3d n0 = facing(mesh, edge.facets[0]);
        const Vec3d n1 = facing(mesh, edge.facets[1]);
        const Vec3d direction = n0 / norm(n0) + n1 / norm(n1);
        const Vec3d middle = (mesh.corners[edge.corners[0]] + mesh.corners[edge.corners[1]]) / 2.0;
        if (norm(direction) > kVerticalFacet) {
            places.push_back(place_at(middle, direction, 0, mesh.outwards[edge.facets[0]] != 0));
        }
    }
    std::vector<Vec3d> sums(mesh.corners.size());
    std::vector<char> of_solid(mesh.corners.size(), 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        const Vec3d direction = facing(mesh, f);
        for (const std::uint32_t corner : mesh.facets[f]) {
            sums[corner] = sums[corner] + direction / norm(direction);
            of_solid[corner] = mesh.outwards[f] != 0 ? 1 : 0;
        }
    }
    const std::size_t step = std::max<std::size_t>(1, mesh.corners.size() / max_count);
    for (std::size_t k = 0; k < mesh.corners.size(); k += step) {
        if (norm(sums[k]) > kVerticalFacet) {
            places.push_back(place_at(mesh.corners[k], sums[k], 0, of_solid[k] != 0));
        }
    }
    return places;
}

}  // namespace cusp::part_info
