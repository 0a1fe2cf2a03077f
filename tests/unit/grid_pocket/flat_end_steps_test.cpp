// Steps of a flat end on slopes whose steps are known.
#include "host_tools/cam/grid_pocket/flat_end_steps.hpp"

#include <cmath>

#include "host_tools/geometry/offset/offset.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace grid_pocket;

namespace {

constexpr double kRadius = 3;
constexpr double kSlope = 0.4;
constexpr double kGridX = 2.5;
constexpr double kGridY = 1.5;

// A plane that rises along x, its tips as high as it is under the uphill end of the disc.
double slope_height(Vec2d p) { return kSlope * (p.x + kRadius); }

offset::Region2d room()
{
    const Vec2d a{0, 0};
    const Vec2d b{40, 0};
    const Vec2d c{40, 30};
    const Vec2d d{0, 30};
    return {{{offset::line_edge(a, b), offset::line_edge(b, c), offset::line_edge(c, d),
              offset::line_edge(d, a)}}};
}

struct Slope {
    offset::RegionOffset pocket{room()};
    CellGrid grid{pocket, kGridX, kGridY, kRadius};
    std::vector<double> heights = [this] {
        std::vector<double> out;
        for (std::size_t k = 0; k < grid.size(); ++k) {
            out.push_back(slope_height(grid.centre(grid.cell(k))));
        }
        return out;
    }();
    TipSurface surface{heights, [](Vec2d p) { return std::optional{slope_height(p)}; },
                       [this](Vec2d p) { return pocket.clearance(p) - kRadius; },
                       [](Vec2d p) {
                           return p;
                       }};

    double step(bool along_x)
    {
        Tracks tracks{grid};
        for (std::size_t k = 0; k < grid.size(); ++k) {
            const Cell c = grid.cell(k);
            const Cell next = along_x ? Cell{c.column + 1, c.row} : Cell{c.column, c.row + 1};
            if (grid.inside(c) && grid.inside(next)) {
                tracks.add(c, next);
            }
        }
        FlatEndSteps steps{grid, surface, tracks, kRadius};
        int evaluations = 0;
        const double found = steps.left_in(grid.nearest({20, 15}), evaluations);
        CHECK(evaluations > 0);
        return found;
    }
};

}  // namespace

TEST_GROUP(FlatEndSteps){};

// Level tracks: just out of reach of one, the next higher stays.
TEST(FlatEndSteps, AreAsHighAsTheSlopeBetweenTwoLevelTracks)
{
    const double step = Slope{}.step(false);
    CHECK(step >= kSlope * kGridX * 0.999);
    CHECK(step <= kSlope * (kGridX + 0.1 * kRadius));
}

// Tracks up the slope: between two the disc of one reaches less far downhill than one there.
TEST(FlatEndSteps, AreWhatDiscsBesideReachLessFarDownhill)
{
    const double beside = kGridY / 2;
    const double reach = kRadius - std::sqrt(kRadius * kRadius - beside * beside);
    const double step = Slope{}.step(true);
    CHECK(step >= kSlope * reach * 0.999);
    CHECK(step <= kSlope * (reach + 0.1 * kRadius));
}

}  // namespace cusp::test
