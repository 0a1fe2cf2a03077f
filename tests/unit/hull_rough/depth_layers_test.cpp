// Layers between tops of boxes: split, merged, chosen.
#include "host_tools/cam/hull_rough/depth_layers.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/tap.hpp"

using namespace cusp::hull_rough;
using namespace cusp::nurbs;
using namespace cusp::test;

namespace {

struct Thickness {
    double least{1e300};
    double most{};
};

Thickness thickness(const std::vector<double>& planes)
{
    Thickness t;
    for (std::size_t i = 1; i < planes.size(); ++i) {
        t.least = std::min(t.least, planes[i - 1] - planes[i]);
        t.most = std::max(t.most, planes[i - 1] - planes[i]);
    }
    return t;
}

Surface flat_at(double z)
{
    std::vector<cusp::Vec3d> net;
    for (int i = 0; i < 16; ++i) {
        net.push_back({10.0 * (i / 4), 10.0 * (i % 4), z});
    }
    return bicubic(4, 4, std::move(net));
}

}  // namespace

TEST_GROUP(DepthLayers){};

TEST(DepthLayers, OfTheTapAreThePapersFifteen)
{
    const auto patches = hull_patches({tap()});
    double top = 0;
    for (const HullPatch& patch : patches) {
        top = std::max(top, patch.top);
    }
    const LayerPlan plan = depth_layers(patches, top, 0, {2, 1});
    LONGS_EQUAL(21, plan.raw_layers);
    LONGS_EQUAL(33, plan.split_layers);
    LONGS_EQUAL(59, plan.patches.size());
    LONGS_EQUAL(15, plan.planes.size() - 1);
    DOUBLES_EQUAL(1.012, thickness(plan.planes).least, 5e-4);
    DOUBLES_EQUAL(1.838, thickness(plan.planes).most, 5e-4);
}

TEST(DepthLayers, AreDividedEquallyWhereNoBoxDoes)
{
    const LayerPlan plan = depth_layers(hull_patches({flat_at(0)}), 10, 0, {3, 1});
    LONGS_EQUAL(4, plan.planes.size() - 1);
    DOUBLES_EQUAL(2.5, thickness(plan.planes).most, 1e-12);
}

TEST(DepthLayers, NeverExceedTheGreatestDepth)
{
    for (const double most : {0.3, 0.7, 1.1, 2.9, 30.0}) {
        const LayerPlan plan = depth_layers(hull_patches({tap()}), 20, 0, {most, most / 2});
        CHECK(thickness(plan.planes).most <= most + 2e-6);
        DOUBLES_EQUAL(20, plan.planes.front(), 0);
        DOUBLES_EQUAL(0, plan.planes.back(), 0);
        const auto better = least_leftover_planes(plan, {most, most / 2});
        CHECK(thickness(better).most <= most + 2e-6);
        CHECK(better.size() <= plan.planes.size());
    }
}

TEST(DepthLayers, ChosenForLeastLeftoverKeepBothLimits)
{
    const LayerPlan plan = depth_layers(hull_patches({tap()}), 18.7, 0, {2, 1});
    const auto planes = least_leftover_planes(plan, {2, 1});
    CHECK(thickness(planes).least >= 1 - 2e-6);
    CHECK(thickness(planes).most <= 2 + 2e-6);
}
