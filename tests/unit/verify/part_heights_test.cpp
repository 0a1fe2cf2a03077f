// Heights and slopes of parts with closed forms.
#include "host_tools/judge/verify/part_heights.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::nurbs;
using namespace cusp::verify;

namespace {

Surface tilted_square(double size, double rise)
{
    return {1,
            1,
            {0, 0, 1, 1},
            {0, 0, 1, 1},
            2,
            2,
            {{0, 0, 0}, {0, size, 0}, {size, 0, rise}, {size, size, rise}},
            {1, 1, 1, 1},
            {}};
}

}  // namespace

TEST_GROUP(PartHeights){};

TEST(PartHeights, OfATiltedPlaneAreExact)
{
    const HeightGrid grid{0.25, 0.25, 0.5, 20, 20, true};
    const PartHeights heights = part_heights({tilted_square(10, 5)}, {}, grid);
    for (std::size_t i = 0; i < grid.nx; ++i) {
        for (std::size_t j = 0; j < grid.ny; ++j) {
            DOUBLES_EQUAL(grid.x(i, j) / 2, heights.z[grid.index(i, j)], 1e-7);
            DOUBLES_EQUAL(1 / std::sqrt(1.25), heights.cosine[grid.index(i, j)], 1e-7);
        }
    }
}

TEST(PartHeights, AreTheUpperEnvelopeOfSeveralSurfaces)
{
    const HeightGrid grid{0.25, 0.25, 0.5, 20, 20, true};
    Surface level = tilted_square(10, 0);
    for (Vec3d& p : level.points) {
        p.z = 2;
    }
    const PartHeights heights = part_heights({tilted_square(10, 5), level}, {}, grid);
    DOUBLES_EQUAL(2, heights.z[grid.index(2, 5)], 1e-7);
    CHECK(heights.z[grid.index(15, 5)] > 3);
}

TEST(PartHeights, AreMissingOutsideAndInTrimmedHoles)
{
    const HeightGrid grid{0.25, 0.25, 0.5, 24, 20, true};
    Surface holed = tilted_square(10, 0);
    const auto loop = [](double low, double high, bool hole) {
        Curve curve{1,
                    {0, 0, 1, 2, 3, 4, 4},
                    {{low, low, 0}, {high, low, 0}, {high, high, 0}, {low, high, 0}, {low, low, 0}},
                    {1, 1, 1, 1, 1}};
        return std::vector<Curve>{hole ? reversed(curve) : curve};
    };
    holed.trims = {loop(0, 1, false), loop(0.4, 0.6, true)};
    const PartHeights heights = part_heights({holed}, {}, grid);
    CHECK(std::isnan(heights.z[grid.index(23, 5)]));
    CHECK(std::isnan(heights.z[grid.index(10, 10)]));
    CHECK(std::isfinite(heights.z[grid.index(5, 10)]));
}
