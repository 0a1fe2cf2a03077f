// Faults put into a cube are counted; sound meshes have none.
#include "host_tools/job/part_info/mesh_health.hpp"

#include <algorithm>

#include "CppUTest/TestHarness.h"

#include "tests/support/box_mesh.hpp"

using namespace cusp;
using namespace cusp::part_info;
using namespace cusp::test;

namespace {

Triangles cube() { return box_mesh({0, 0, 0}, {10, 10, 10}); }

}  // namespace

TEST_GROUP(MeshHealth){};

TEST(MeshHealth, ACubeIsClosedAndLooksOutwards)
{
    const WeldedMesh mesh = weld(cube());
    UNSIGNED_LONGS_EQUAL(8, mesh.corners.size());
    UNSIGNED_LONGS_EQUAL(18, mesh.edges.size());
    UNSIGNED_LONGS_EQUAL(1, mesh.health.shells);
    UNSIGNED_LONGS_EQUAL(0, mesh.health.open_edges);
    UNSIGNED_LONGS_EQUAL(0, mesh.health.inverted_facets);
    UNSIGNED_LONGS_EQUAL(0, mesh.health.inside_out_shells);
    CHECK(mesh.health.closed);
    CHECK(std::all_of(mesh.outwards.begin(), mesh.outwards.end(),
                      [](int side) { return side == 1; }));
}

TEST(MeshHealth, AFacetLeftOutIsOneHoleOfThreeEdges)
{
    Triangles open = cube();
    open.erase(open.begin() + 4);
    const WeldedMesh mesh = weld(open);
    UNSIGNED_LONGS_EQUAL(3, mesh.health.open_edges);
    UNSIGNED_LONGS_EQUAL(1, mesh.health.holes);
    CHECK(!mesh.health.closed);
    CHECK(mesh.health.hole_at.has_value());
    CHECK(std::all_of(mesh.outwards.begin(), mesh.outwards.end(),
                      [](int side) { return side == 0; }));
}

TEST(MeshHealth, TwoHolesApartAreCountedApart)
{
    Triangles open = cube();
    // a facet of the top and one of the bottom that share no corner
    open.erase(open.begin() + 3);
    open.erase(open.begin() + 1);
    const WeldedMesh mesh = weld(open);
    UNSIGNED_LONGS_EQUAL(6, mesh.health.open_edges);
    UNSIGNED_LONGS_EQUAL(2, mesh.health.holes);
}

TEST(MeshHealth, TurnedFacetsAreCountedAndTheirOutsideIsKnown)
{
    Triangles turned = cube();
    std::swap(turned[0][1], turned[0][2]);
    std::swap(turned[7][1], turned[7][2]);
    const WeldedMesh mesh = weld(turned);
    UNSIGNED_LONGS_EQUAL(2, mesh.health.inverted_facets);
    CHECK(mesh.health.closed);
    LONGS_EQUAL(-1, mesh.outwards[0]);
    LONGS_EQUAL(1, mesh.outwards[1]);
    LONGS_EQUAL(-1, mesh.outwards[7]);
}

TEST(MeshHealth, ACubeInsideOutIsSaidToBe)
{
    Triangles turned = cube();
    for (auto& t : turned) {
        std::swap(t[1], t[2]);
    }
    const WeldedMesh mesh = weld(turned);
    UNSIGNED_LONGS_EQUAL(0, mesh.health.inverted_facets);
    UNSIGNED_LONGS_EQUAL(1, mesh.health.inside_out_shells);
    LONGS_EQUAL(-1, mesh.outwards[3]);
}

TEST(MeshHealth, AThirdFacetAtAnEdgeIsNoManifold)
{
    Triangles fin = cube();
    fin.push_back({Vec3d{0, 0, 10}, Vec3d{10, 0, 10}, Vec3d{5, -5, 15}});
    const WeldedMesh mesh = weld(fin);
    UNSIGNED_LONGS_EQUAL(1, mesh.health.non_manifold_edges);
    UNSIGNED_LONGS_EQUAL(2, mesh.health.open_edges);
    DOUBLES_EQUAL(5, mesh.health.non_manifold_at->x, 1e-12);
    DOUBLES_EQUAL(10, mesh.health.non_manifold_at->z, 1e-12);
}

TEST(MeshHealth, TwoCubesAreTwoShells)
{
    Triangles both = cube();
    const Triangles other = box_mesh({20, 0, 0}, {30, 10, 10});
    both.insert(both.end(), other.begin(), other.end());
    UNSIGNED_LONGS_EQUAL(2, weld(both).health.shells);
}
