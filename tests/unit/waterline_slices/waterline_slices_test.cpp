// Slices of offsets: they keep their distance everywhere, are nested, and are no smaller than
// necessary.
#include "host_tools/geometry/waterline_slices/waterline_slices.hpp"

#include <cmath>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"
// it needs the harness before it
#include "CppUTest/MemoryLeakWarningPlugin.h"

using namespace cusp;
using namespace cusp::waterline_slices;
using namespace cusp::nurbs;
using namespace cusp::offset;
using namespace cusp::part_model;
using namespace cusp::toolpath;

namespace {

// A dome of radius 10 about the z axis, its top at z = 10: a rational quarter turned round.
Surface dome()
{
    const double half = std::sqrt(0.5);
    Surface s;
    s.degree_u = s.degree_v = 2;
    s.size_u = 3;
    s.size_v = 9;
    s.knots_u = {0, 0, 0, 1, 1, 1};
    s.knots_v = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    const double ring[9][3]{{1, 0, 1},      {1, 1, half}, {0, 1, 1},     {-1, 1, half}, {-1, 0, 1},
                            {-1, -1, half}, {0, -1, 1},   {1, -1, half}, {1, 0, 1}};
    const double profile[3][3]{{10, 0, 1}, {10, 10, half}, {0, 10, 1}};
    for (const auto& [r, z, w] : profile) {
        for (const auto& [x, y, v] : ring) {
            s.points.push_back({r * x, r * y, z});
            s.weights.push_back(w * v);
        }
    }
    return s;
}

// 27 x 27 patches of 3 mm, from z = -11 to -1.
Surface many_hills()
{
    constexpr int kSide = 30;
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.size_u = s.size_v = kSide;
    s.knots_u = {0, 0, 0, 0};
    for (int k = 1; k < kSide - 3; ++k) {
        s.knots_u.push_back(k);
    }
    s.knots_u.insert(s.knots_u.end(), 4, kSide - 3);
    s.knots_v = s.knots_u;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            s.points.push_back({3.0 * i, 3.0 * j, -6 + 5 * std::sin(0.9 * i) * std::cos(0.8 * j)});
            s.weights.push_back(1);
        }
    }
    return s;
}

SliceSettings settings(double keep) { return {keep, 0.005, 0.15, {-20, -20, 20, 20}}; }

}  // namespace

TEST_GROUP(WaterlineSlices){
    // The model has many cells: counting allocations would take nearly all the time.
    void setup() override{MemoryLeakWarningPlugin::turnOffNewDeleteOverloads();
}
void teardown() override { MemoryLeakWarningPlugin::turnOffNewDeleteOverloads(); }
}
;

// A slice made all the cells it needed before any was released: gigabytes for many faces.
TEST(WaterlineSlices, OfManyFacesKeepFewCells)
{
    const PartModel model{{many_hills()}};
    const WaterlineSlices slices{
        model, {1, ToolShape::kFlat, 4, 0}, {0.3, 0.005, 0.1, {-10, -10, 97, 97}}};
    const PartModel::SharedQueries keeps{model};  // what the slice made, as in a loop over levels
    CHECK(!slices.at(-6, 0).contours.empty());
    std::printf("%zu cells\n", model.kept_cells());
    CHECK(model.kept_cells() > 10'000);
    CHECK(model.kept_cells() < 150'000);
}

TEST(WaterlineSlices, OfADomeAreCircles)
{
    const PartModel model{{dome()}};
    for (const Tool& tool : {Tool{1, ToolShape::kBall, 3, 3}, Tool{1, ToolShape::kBull, 3, 1}}) {
        const WaterlineSlices slices{model, tool, settings(0.5)};
        for (const double z : {6.0, 2.0}) {
            const double sum = 10 + tool.corner_radius + 0.5;
            const double up = z + tool.corner_radius;
            const double radius = std::sqrt(sum * sum - up * up) + tool.radius - tool.corner_radius;
            const Region2d region = slices.at(z, 0);
            CHECK_EQUAL(2U, region.contours.size());
            for (const Contour& contour : region.contours) {
                if (area(contour) > 0) {
                    continue;
                }
                for (const Edge& edge : contour) {
                    const double away = norm(edge.start);
                    CHECK(away >= radius - 1e-6);
                    CHECK(away <= radius + 0.05);
                }
            }
        }
    }
}

TEST(WaterlineSlices, KeepTheirDistanceEverywhereAndLieInEachOther)
{
    const PartModel model{{dome()}};
    std::mt19937 random{11};
    std::uniform_real_distribution<double> place{-19, 19};
    for (const Tool& tool : {Tool{1, ToolShape::kBall, 2, 2}, Tool{1, ToolShape::kFlat, 2, 0},
                             Tool{1, ToolShape::kBull, 3, 1}}) {
        const WaterlineSlices slices{model, tool, settings(0.2)};
        Region2d above = slices.at(9.0, 0);
        for (const double z : {7.5, 4.0, 0.3}) {
            const Region2d here = slices.at(z, 0);
            for (int k = 0; k < 1000; ++k) {
                const Vec2d p{place(random), place(random)};
                if (contains(here, p)) {
                    CHECK(contains(above, p));
                    CHECK(model.distance(tool, {p.x, p.y, z}, 1).distance >= 0.2 - 1e-7);
                } else if (std::abs(p.x) < 19 && std::abs(p.y) < 19) {
                    // Omitted points are near to points that may not be entered.
                    CHECK(model.distance(tool, {p.x, p.y, z}, 1).distance <= 0.2 + 0.3);
                }
            }
            above = here;
        }
    }
}

TEST(WaterlineSlices, AreEmptyWhereTheToolFitsNowhere)
{
    Surface plane;
    plane.degree_u = plane.degree_v = 1;
    plane.size_u = plane.size_v = 2;
    plane.knots_u = plane.knots_v = {0, 0, 1, 1};
    plane.points = {{-30, -30, 0}, {-30, 30, 0}, {30, -30, 0}, {30, 30, 0}};
    plane.weights.assign(4, 1.0);
    const PartModel model{{plane}};
    const WaterlineSlices slices{model, {1, ToolShape::kFlat, 2, 0}, settings(0.2)};
    CHECK(slices.at(-1, 0).contours.empty());
    CHECK_EQUAL(1U, slices.at(1, 0).contours.size());
}
