// The lowest position of a ball beside a rim over a floor, touching it or kept off it, compared
// with all positions across the rim.
#include "host_tools/cam/finishing/reachable_height.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/base/math.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::toolpath;

namespace {

constexpr double kToolRadius = 2;
constexpr double kReachTolerance = 0.02;
constexpr double kFloor = -1;
constexpr double kAccuracy = 1e-4;
constexpr double kClose = 2e-3;  // mm: allowed error of a search

Surface plate(Vec3d low, Vec3d high, Vec3d along)
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.size_u = s.size_v = 2;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    s.points = {low, low + along, high, high + along};
    s.weights.assign(4, 1.0);
    return s;
}

// A level floor, and over it a face that rises from its rim along x = z = 0.
struct Step {
    explicit Step(double slope)
        : upright{std::cos(slope)},
          leaning{std::sin(slope)},
          surfaces{plate({-30, -30, kFloor}, {30, -30, kFloor}, {0, 60, 0}),
                   plate({0, -30, 0}, {6, -30, 6 * leaning / upright}, {0, 60, 0})}
    {
        path_fitter.check_edge_gouges(surfaces);
    }

    // z of the ball's centre on the model and, if requested, clear of the rim by the face's allowed
    // depth, along its normal.
    double middle(double x, bool clear_of_rim) const
    {
        double z = kFloor + kToolRadius;
        const double on_face = (kToolRadius + x * leaning) / upright;
        if (x * upright + on_face * leaning >= 0) {
            z = std::max(z, on_face);
        } else if (std::abs(x) < kToolRadius) {
            z = std::max(z, std::sqrt(kToolRadius * kToolRadius - x * x));
        }
        const auto free = [&](double at) {
            const double away = std::hypot(x, at);
            const double up = std::max(1e-3, at / away);
            return away + band.max_gouge * up / upright >= kToolRadius + 1.05 * band.half_width;
        };
        if (!clear_of_rim || free(z)) {
            return z;
        }
        double low = z;
        double high = 2 * kToolRadius;
        while (high - low > 1e-9) {
            (free(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
        }
        return high;
    }

    double lowest_over(Vec3d place, bool clear_of_rim) const
    {
        double least = std::numeric_limits<double>::infinity();
        constexpr double kStep = 1e-4;
        for (double off = -kToolRadius; off < kToolRadius; off += kStep) {
            const double x = place.x + off;
            least = std::min(
                least, middle(x, clear_of_rim) - std::sqrt(kToolRadius * kToolRadius - off * off));
        }
        return least;
    }

    double upright;
    double leaning;
    std::vector<Surface> surfaces;
    Tool tool{1, ToolShape::kBall, kToolRadius, kToolRadius};
    ToleranceBand band{make_tolerance_band(kReachTolerance, false)};
    PartModel model{surfaces};
    GougeFreePathFitter path_fitter{model, tool, band};
};

}  // namespace

TEST_GROUP(ReachableHeight){};

TEST(ReachableHeight, GetsAsLowBesideARimAsAnyPlaceAcrossIt)
{
    for (const double degrees : {0.0, 20.0, 45.0, 70.0, 85.0}) {
        const Step step{degrees * kPi / 180};
        ReachableHeight reach{step.surfaces, step.path_fitter, 0.25, kAccuracy};
        for (const double x : {-1.7, -1.2, -0.6, -0.2, -0.01}) {
            const Vec3d place{x, 0.1, kFloor};
            const double met = step.lowest_over(place, false);
            const double kept = step.lowest_over(place, true);
            CHECK(!reach.lowest_over(place, met - kClose) ||
                  reach.lowest_over(place, met - kClose)->height > met - kClose);
            const auto near = reach.lowest_over(place, met + kClose);
            CHECK(near && near->height <= met + kClose);
            CHECK(!reach.lowest_clear_of_edges(place, *near, kept - kClose));
            const auto answer = reach.lowest_clear_of_edges(place, *near, kept + kClose);
            CHECK(answer && answer->height <= kept + kClose);
            // Passes may go there.
            CHECK(norm(step.path_fitter.moved_clear_of_edges({answer->tip}).front() - answer->tip) <
                  1e-6);
        }
    }
}
