// Steep floors with valleys that a tool does not reach: stock left, by brute force.
#include <cstdio>

#include "tests/judges/pocket_judge.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace job;
using namespace nurbs;
using namespace offset;
using namespace toolpath;

namespace {

constexpr double kHalf = 12.0;   // mm, of the pocket
constexpr double kBeyond = 8.0;  // mm, of floor round it
constexpr double kPitch = 0.02;  // mm, of the section
constexpr int kPlaces = 400;

// A profile in x, the same at every y.
Surface drawn_out(Random& random, double height, double wave)
{
    const double side = 1.5 * kHalf + kBeyond;  // corners of a turned pocket
    const int count = static_cast<int>(2.0 * side / wave) + 4;
    Surface s;
    s.degree_u = 3;
    s.degree_v = 1;
    s.size_u = count;
    s.size_v = 2;
    s.knots_u.assign(4, 0.0);
    for (int i = 1; i < count - 3; ++i) {
        s.knots_u.push_back(i);
    }
    s.knots_u.insert(s.knots_u.end(), 4, count - 3.0);
    s.knots_v = {0.0, 0.0, 1.0, 1.0};
    for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double greville = (s.knots_u[k + 1] + s.knots_u[k + 2] + s.knots_u[k + 3]) / 3.0;
        const double x = side * (2.0 * greville / (count - 3.0) - 1.0);
        const double z = -12.0 + uniform(random, -height, height);
        s.points.push_back({x, -side, z});
        s.points.push_back({x, side, z});
    }
    s.weights.assign(s.points.size(), 1.0);
    return s;
}

// The section of such a floor, the lowest tip over it, and the lowest cut.
class Section {
public:
    Section(const Surface& s, const Tool& tool) : tool_{tool}
    {
        low_ = s.points.front().x;
        const double length = s.points.back().x - low_;
        const int count = static_cast<int>(length / kPitch) + 1;
        for (int i = 0; i < count; ++i) {
            // x is linear in u: control points are at the Greville abscissae.
            const double u = s.u_begin() + (s.u_end() - s.u_begin()) * kPitch * i / length;
            floor_.push_back(derivatives_at(s, u, 0.5).point.z);
        }
        tip_ = over(
            floor_, [](double z, double profile) { return z - profile; }, -1e300,
            [](double a, double b) { return std::max(a, b); });
        cut_ = over(
            tip_, [](double z, double profile) { return z + profile; }, 1e300,
            [](double a, double b) { return std::min(a, b); });
    }

    // From points of the floor only: a lower bound of the tip.
    double tip(double x) const
    {
        const auto count = static_cast<double>(floor_.size());
        const double first = std::max(0.0, std::ceil((x - tool_.radius - low_) / kPitch));
        const double last = std::min(count - 1.0, std::floor((x + tool_.radius - low_) / kPitch));
        double most = -1e300;
        for (auto k = static_cast<std::size_t>(first); k <= static_cast<std::size_t>(last); ++k) {
            const double apart = low_ + kPitch * static_cast<double>(k) - x;
            most = std::max(
                most, floor_[k] - profile_height(tool_, std::min(tool_.radius, std::abs(apart))));
        }
        return most;
    }

    double cut(double x) const { return at(cut_, x); }

    // Cosine of the slope of the stock left.
    double cosine(double x) const
    {
        return 1.0 / std::hypot(1.0, (cut(x + kPitch) - cut(x - kPitch)) / (2.0 * kPitch));
    }

private:
    template <class Shift, class Better>
    std::vector<double> over(const std::vector<double>& heights,
                             const Shift& shift,
                             double worst,
                             const Better& better) const
    {
        const int count = static_cast<int>(heights.size());
        const int reach = static_cast<int>(tool_.radius / kPitch);
        std::vector<double> out;
        for (int i = 0; i < count; ++i) {
            double best = worst;
            for (int k = std::max(0, i - reach); k <= std::min(count - 1, i + reach); ++k) {
                const double apart = kPitch * (k - i);
                const double profile = profile_height(tool_, std::abs(apart));
                best = better(best, shift(heights[static_cast<std::size_t>(k)], profile));
            }
            out.push_back(best);
        }
        return out;
    }

    double at(const std::vector<double>& heights, double x) const
    {
        const double place = (x - low_) / kPitch;
        const auto k = static_cast<std::size_t>(place);
        const double share = place - static_cast<double>(k);
        return heights[k] * (1.0 - share) + heights[k + 1] * share;
    }

    Tool tool_;
    double low_;
    std::vector<double> floor_;
    std::vector<double> tip_;
    std::vector<double> cut_;
};

struct Waves {
    double height;  // mm, of control points, up and down
    double length;  // mm between them
};

// Plans `count` pockets over such floors and checks each.
template <class NextWaves>
void check_floors(ToolShape shape, unsigned seed, int count, const NextWaves& next_waves)
{
    Random random{seed};
    for (int i = 0; i < count; ++i) {
        const Waves waves = next_waves(random);
        const double radius = uniform(random, 1.5, 3.0);
        const double angle = uniform(random, 0.0, 1.5);
        const Vec2d along = Vec2d{std::cos(angle), std::sin(angle)} * kHalf;
        const Vec2d across = left_normal(along);
        const Loop boundary =
            loop_of({(along + across) * -1.0, along - across, along + across, across - along});
        const Operation operation =
            random_pocket(random, {drawn_out(random, waves.height, waves.length)}, boundary,
                          {1, shape, radius, 0.0}, 0.3);
        const PlannedOperation planned = planned_pocket(operation);
        const std::vector<Vec3d> tips = tips_of(planned.path, 0.0, 0.03);
        const Section section{operation.part.floor.front(), operation.tool};
        double gouge = 0.0;
        for (const Vec3d tip : tips) {
            gouge = std::max(gouge, section.tip(tip.x) - tip.z);
        }
        double most = 0.0;
        const double inner = 1.0 - 2.0 * radius / kHalf;
        for (int k = 0; k < kPlaces; ++k) {
            const Vec2d p =
                along * uniform(random, -inner, inner) + across * uniform(random, -inner, inner);
            const double left = lowest_cut(operation.tool, tips, p) - section.cut(p.x);
            most = std::max(most, left * section.cosine(p.x));
        }
        std::printf("seed %u valley %d: tool %.2f/%.2f, gouge %.5f, left %.4f of %.4f\n", seed, i,
                    radius, operation.tool.corner_radius, gouge, most,
                    *operation.tolerance.scallop);
        CHECK(gouge <= 1e-6);
        CHECK(most <= *operation.tolerance.scallop + 2e-3);
        DOUBLES_EQUAL(0.0, planned.stats.gouge_bound_mm, 1e-9);
    }
}

TEST_GROUP(RandomValley){};

TEST(RandomValley, KeepsNoMoreThanTheScallopOverWhatABallReaches)
{
    check_floors(ToolShape::kBall, 4242, property_cases(8), [](Random& random) {
        return Waves{uniform(random, 2.0, 5.0), uniform(random, 2.0, 5.0)};
    });
}

TEST(RandomValley, KeepsNoMoreThanTheScallopOverWhatAFlatOrBullNoseEndReaches)
{
    const auto waves = [](Random& random) {
        return Waves{uniform(random, 1.0, 3.0), uniform(random, 3.0, 8.0)};
    };
    check_floors(ToolShape::kFlat, 77, property_cases(3), waves);
    check_floors(ToolShape::kBull, 78, property_cases(3), waves);
}

}  // namespace
}  // namespace cusp::test
