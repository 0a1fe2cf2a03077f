// Uncovered spots of a layer: found where a line is missing, none where lines and outlines are
// complete.
#include "host_tools/cam/hull_rough/layer_coverage.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/hull_rough/layer_clearing.hpp"

using namespace cusp;
using namespace cusp::clearing;
using namespace cusp::hull_rough;

namespace {

const Rectangle kStock{0, 0, 40, 30};

LayerClearing cleared(const std::vector<Rectangle>& boxes, bool contour)
{
    LayerSettings settings;
    settings.step = 5.9;
    settings.clears = 3;
    settings.tolerance = 0.01;
    settings.contour = contour;
    return clear_layer(boxes, kStock, 3, settings);
}

}  // namespace

TEST_GROUP(LayerCoverage){};

TEST(LayerCoverage, LinesAndOutlinesLeaveNothing)
{
    const LayerClearing layer = cleared({{10, 10, 15, 18}, {22, 4, 30, 9}}, false);
    CHECK(uncovered_spots(layer.runs, *layer.centres, 3, kStock).squares.empty());
    DOUBLES_EQUAL(0, layer.left.area, 0);
}

TEST(LayerCoverage, ContoursLeaveNothingOncePatched)
{
    const LayerClearing layer = cleared({{10, 10, 15, 18}, {22, 4, 30, 9}, {31, 20, 33, 29}}, true);
    CHECK(layer.by_contours);
    DOUBLES_EQUAL(0, layer.left.area, 0);
}

TEST(LayerCoverage, AMissingRunIsFoundAndItsPartsCloseIt)
{
    const LayerClearing layer = cleared({}, false);
    std::vector<LayerRun> some = layer.runs;
    LayerRun shorter = some.front();
    shorter.edges.resize(shorter.edges.size() / 2);
    some.front() = shorter;
    const UncoveredSpots uncovered = uncovered_spots(some, *layer.centres, 3, kStock);
    CHECK(uncovered.area > 100);
    CHECK(uncovered.area < 40 * 30);
    for (const LayerRun& run : runs_near(layer.runs, uncovered, 3)) {
        some.push_back(run);
    }
    DOUBLES_EQUAL(0, uncovered_spots(some, *layer.centres, 3, kStock).area, 0);
}
