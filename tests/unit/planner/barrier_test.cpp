// Every iterate of the barrier holds every limit, judged in long double from speed and acceleration.
#include "firmware/planner/barrier.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/generators/random_stations.hpp"
#include "tests/judges/law_judge.hpp"

using namespace cusp;
using namespace cusp::planner;
using namespace cusp::test;

namespace {

constexpr std::uint64_t kBarrierSeed = 5150;
constexpr int kBarrierCases = 300;

struct Case {
    LawSpline spline{};
    LawWindow window{};
    std::uint32_t cells{0};
};

// A window in a crawl, of any size; with the start, the end, both or neither of a stretch.
Case any_case(RandomStations& random)
{
    Case made;
    LawSpline& spline = made.spline;
    spline.ratio = quotient(to_lanes(random.limits.jerk), to_lanes(random.limits.acceleration));
    made.cells = 6 + static_cast<std::uint32_t>(random.number() % 34);
    float least_cap = kUnlimited;
    for (std::uint32_t k = 0; k < made.cells; ++k) {
        spline.station(k) = random.next();
        least_cap = std::min(least_cap, spline.station(k).cap);
    }
    spline.station(made.cells).length = spline.station(made.cells - 1).length;
    const std::uint64_t ends = random.number();
    made.window = {2, made.cells, 0.0F, 0.0F};
    if (ends % 2 == 0) {
        made.window.begin = 1;
        made.window.start_factor = 0.3F;
    }
    if (ends / 2 % 2 == 0) {
        made.window.end = made.cells + 1;
        made.window.end_factor = 0.4F;
    }
    float crawl = 0.5F * least_cap;
    for (int i = 0; i < 100; ++i) {
        for (std::uint32_t j = 0; j < made.cells + 2; ++j) {
            spline.coefficient(j) = crawl;
            spline.cap(j) = least_cap * static_cast<float>(1 + j % 3);
        }
        tie_ends(spline, made.window);
        if (largest_law_use(spline, made.cells) < 0.9L) {
            break;
        }
        crawl *= 0.5F;
    }
    return made;
}

float time_of(const LawSpline& spline, std::uint32_t cells)
{
    float time = 0;
    for (std::uint32_t k = 0; k < cells; ++k) {
        const auto x = static_cast<float>(law_at(spline, k, 0.5L).value);
        time += spline.station(k).length / std::sqrt(x);
    }
    return time;
}

}  // namespace

TEST_GROUP(Barrier){};

TEST(Barrier, every_iterate_holds_every_row)
{
    for (int n = 0; n < kBarrierCases; ++n) {
        const std::uint64_t seed = kBarrierSeed + static_cast<std::uint64_t>(n);
        RandomStations random{seed};
        Case one = any_case(random);
        const int steps = 1 + static_cast<int>(random.number() % 40);
        float mu = 0.1F;
        for (int i = 0; i < steps; ++i) {
            newton_step(one.spline, one.window, {mu, 0.2F * mu, 0.15F, 200.0F});
            mu = std::max(0.7F * mu, 0.002F);
            const long double use = largest_law_use(one.spline, one.cells);
            const std::string which = "seed " + std::to_string(seed) + ", step " +
                                      std::to_string(i) + ": " +
                                      std::to_string(static_cast<double>(use));
            CHECK_TEXT(use < 1 + kLawRounding, which.c_str());
            for (std::uint32_t j = one.window.begin; j < one.window.end; ++j) {
                const float c = one.spline.coefficient(j);
                CHECK_TEXT(c > 0 && c <= one.spline.cap(j), which.c_str());
            }
        }
    }
}

TEST(Barrier, its_use_is_that_of_the_judge)
{
    for (int n = 0; n < kBarrierCases; ++n) {
        RandomStations random{kBarrierSeed + 1000 + static_cast<std::uint64_t>(n)};
        Case one = any_case(random);
        for (int i = 0; i < 5; ++i) {
            newton_step(one.spline, one.window, {0.05F, 0.01F, 1.0F, 200.0F});
        }
        DOUBLES_EQUAL(static_cast<double>(largest_law_use(one.spline, one.cells)),
                      static_cast<double>(greatest_use(one.spline, one.window)), 1e-4);
    }
}

TEST(Barrier, fifteen_steps_come_within_a_hundredth_of_sixty)
{
    int slower = 0;
    for (int n = 0; n < kBarrierCases; ++n) {
        RandomStations random{kBarrierSeed + 2000 + static_cast<std::uint64_t>(n)};
        Case one = any_case(random);
        const auto go = [&one](int steps) {
            float mu = 0.1F;
            for (int i = 0; i < steps; ++i) {
                const bool first = mu > 0.01F;
                newton_step(one.spline, one.window,
                            {mu, mu > 0.002F ? mu : 0.2F * mu, first ? 0.15F : 1.0F, 200.0F});
                mu = std::max(0.7F * mu, 0.002F);
            }
            return time_of(one.spline, one.cells);
        };
        const float soon = go(15);
        const float late = go(45);
        slower += soon > 1.01F * late ? 1 : 0;
    }
    CHECK_TEXT(slower < kBarrierCases / 20, std::to_string(slower).c_str());
}

// A value that has overflowed holds no limit.
TEST(Barrier, a_coefficient_that_is_no_number_is_over_the_limits)
{
    RandomStations random{kBarrierSeed + 3000};
    Case one = any_case(random);
    newton_step(one.spline, one.window, {0.05F, 0.01F, 1.0F, 200.0F});
    CHECK(greatest_use(one.spline, one.window) < 1);
    for (std::uint32_t j = one.window.begin; j < one.window.end; ++j) {
        const float before = one.spline.coefficient(j);
        one.spline.coefficient(j) = std::sqrt(-1.0F);
        CHECK(greatest_use(one.spline, one.window) >= 1);
        one.spline.coefficient(j) = before;
    }
}
