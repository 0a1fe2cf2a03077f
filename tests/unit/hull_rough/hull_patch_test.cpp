// The hull property, on random rational patches.
#include "host_tools/cam/hull_rough/hull_patch.hpp"

#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

#include "tests/support/loops.hpp"
#include "tests/support/tap.hpp"

using namespace cusp::hull_rough;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::test;
using cusp::Vec3d;

namespace {

Surface random_surface(std::mt19937& random)
{
    std::uniform_real_distribution<double> shift{-4, 4};
    std::uniform_real_distribution<double> height{-10, 10};
    std::uniform_real_distribution<double> weight{0.3, 3};
    std::vector<Vec3d> net;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 5; ++j) {
            net.push_back({10.0 * i + shift(random), 10.0 * j + shift(random), height(random)});
        }
    }
    Surface surface = bicubic(6, 5, std::move(net));
    for (double& w : surface.weights) {
        w = weight(random);
    }
    return surface;
}

bool covered(const std::vector<Rectangle>& boxes, Vec3d p)
{
    for (const Rectangle& b : boxes) {
        if (p.x >= b.x_min - 1e-9 && p.x <= b.x_max + 1e-9 && p.y >= b.y_min - 1e-9 &&
            p.y <= b.y_max + 1e-9) {
            return true;
        }
    }
    return false;
}

}  // namespace

TEST_GROUP(HullPatch){};

TEST(HullPatch, OfTheTapAreThirtyFive) { LONGS_EQUAL(35, hull_patches({tap()}).size()); }

TEST(HullPatch, BoxesCoverEverySurfacePointAboveThePlane)
{
    constexpr unsigned kSeed = 31;
    std::printf("HullPatch seed %u\n", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> parameter{0, 1};
    std::uniform_real_distribution<double> height{-8, 8};
    for (int round = 0; round < 60; ++round) {
        const Surface surface = random_surface(random);
        const auto patches = hull_patches({surface});
        const double plane = height(random);
        for (int levels = 0; levels <= 4; ++levels) {
            const auto boxes = boxes_above(patches, plane, levels);
            for (int k = 0; k < 200; ++k) {
                const Vec3d p = point_at(surface, parameter(random), parameter(random));
                CHECK(p.z <= plane || covered(boxes, p));
            }
        }
    }
}

TEST(HullPatch, FinerBoxesCoverLessAndLowerPlanesMore)
{
    const auto patches = hull_patches({tap()});
    const Rectangle all{-100, -100, 200, 100};
    double coarser = 1e300;
    for (int levels = 0; levels <= 5; ++levels) {
        const double area = union_area(boxes_above(patches, 7, levels), all);
        CHECK(area <= coarser);
        CHECK(area <= union_area(boxes_above(patches, 5, levels), all));
        coarser = area;
    }
}

TEST(HullPatch, CountsAPartThatOnlyTouchesThePlaneFromAbove)
{
    // The rim lies in the plane itself: the hull above the plane reaches down to it.
    const auto boxes = boxes_above(hull_patches({tap()}), 0, 3);
    CHECK(covered(boxes, {26, -23.9, 0}));
}

TEST(HullPatch, OfATrimmedSurfaceCoverWhatIsLeftAndNotMuchMore)
{
    constexpr unsigned kSeed = 32;
    std::printf("HullPatch seed %u\n", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> parameter{0, 1};
    for (int round = 0; round < 20; ++round) {
        Surface surface = random_surface(random);
        surface.trims = {loop_of({{0.3, 0.2}, {0.9, 0.2}, {0.9, 0.8}, {0.3, 0.8}}),
                         loop_of({{0.6, 0.4}, {0.5, 0.5}, {0.6, 0.6}, {0.7, 0.5}})};
        const TrimRegion trims{surface, 1e-4};
        const auto patches = hull_patches({surface});
        for (int levels = 0; levels <= 3; ++levels) {
            const auto boxes = boxes_above(patches, -1e3, levels);
            for (int k = 0; k < 200; ++k) {
                const double u = parameter(random);
                const double v = parameter(random);
                CHECK(!trims.inside(u, v) || covered(boxes, point_at(surface, u, v)));
            }
            CHECK_FALSE(covered(boxes, point_at(surface, 0.05, 0.05)));
        }
    }
}
