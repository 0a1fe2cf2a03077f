// Starts of windows: nearly all on lines hold every row and lose little time, most on any path do, and what is
// kept stays.
#include "firmware/planner/law_start.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/generators/line_stretch.hpp"
#include "tests/generators/random_stations.hpp"
#include "tests/judges/law_judge.hpp"

using namespace cusp;
using namespace cusp::planner;
using namespace cusp::test;

namespace {

constexpr std::uint64_t kStartSeed = 8270;
constexpr int kStartCases = 400;

// A stretch as one window, coefficients in a crawl.
struct Whole {
    LawSpline spline{};
    LawWindow window{};
    std::uint32_t cells{0};
};

float factor_beyond(const StopElement& element, float h)
{
    const float part = 2.0F * h / (3.0F * element.length);
    return (1.0F - part) / (1.0F + part);
}

Whole whole(const Stretch& stretch, const MachineLimits& limits)
{
    Whole made;
    LawSpline& spline = made.spline;
    made.cells = static_cast<std::uint32_t>(stretch.stations.size());
    spline.ratio = quotient(to_lanes(limits.jerk), to_lanes(limits.acceleration));
    for (std::uint32_t k = 0; k < made.cells; ++k) {
        spline.station(k) = stretch.stations[k];
        for (std::uint32_t j = k; j <= k + 2; ++j) {
            spline.cap(j) = stretch.stations[k].cap;
        }
    }
    spline.station(made.cells).length = spline.station(made.cells - 1).length;
    made.window = {1, made.cells + 1, factor_beyond(stretch.start, spline.station(0).length),
                   factor_beyond(stretch.stop, spline.station(made.cells).length)};
    spline.cap(1) = 2.0F * stretch.start.cap / (1.0F + made.window.start_factor);
    spline.cap(made.cells) = 2.0F * stretch.stop.cap / (1.0F + made.window.end_factor);
    return made;
}

// The travel time, by what each coefficient stands for.
double time_of(const Whole& law)
{
    double time = 0;
    for (std::uint32_t j = law.window.begin; j < law.window.end; ++j) {
        const double span =
            static_cast<double>(law.spline.length_before(j) + law.spline.station(j).length +
                                law.spline.station(j < 2 ? 0 : j - 2).length) /
            3;
        time += span / std::sqrt(static_cast<double>(law.spline.coefficient(j)));
    }
    return time;
}

}  // namespace

TEST_GROUP(LawStart){};

TEST(LawStart, lines_start_within_their_limits_and_near_the_least_time)
{
    double worst = 1;
    int lines = 0;
    int held = 0;
    for (int n = 0; n < kStartCases; ++n) {
        RandomStations random{kStartSeed + static_cast<std::uint64_t>(n)};
        const MachineLimits& limits = random.limits;
        const float feed = static_cast<float>(random.between(0.05, 1)) * limits.velocity.x;
        const float length = feed * static_cast<float>(random.between(0.003, 1.6));
        const float dt = std::min(0.25F * limits.acceleration.x / limits.jerk.x, 0.02F);
        const Stretch stretch = line(limits, length, feed, dt);
        if (stretch.stations.size() > kMostWindow - 2) {
            continue;
        }
        ++lines;
        Whole law = whole(stretch, limits);
        start_by_ramps(law.spline, law.window, law.window.begin);
        if (largest_law_use(law.spline, law.cells) >= 1.0L) {
            continue;
        }
        ++held;
        const double start = time_of(law);
        for (int i = 0; i < 40; ++i) {
            newton_step(law.spline, law.window, {1e-3F, 1e-5F, 1.0F, 1.0F / dt});
        }
        worst = std::max(worst, start / time_of(law));
    }
    CHECK_TEXT(lines > kStartCases / 4, std::to_string(lines).c_str());
    CHECK_TEXT(held == lines, (std::to_string(held) + " of " + std::to_string(lines)).c_str());
    CHECK_TEXT(worst < 1.1, std::to_string(worst).c_str());
}

TEST(LawStart, most_windows_on_any_path_start_within_their_limits)
{
    int held = 0;
    for (int n = 0; n < kStartCases; ++n) {
        RandomStations random{kStartSeed + static_cast<std::uint64_t>(n)};
        Stretch stretch;
        const std::size_t count = 6 + random.number() % 40;
        for (std::size_t k = 0; k < count; ++k) {
            stretch.stations.push_back(random.next());
        }
        stretch.start = element_for(stretch.stations.front(), 1.0F);
        stretch.stop = element_for(stretch.stations.back(), 1.0F);
        Whole law = whole(stretch, random.limits);
        start_by_ramps(law.spline, law.window, law.window.begin);
        held += largest_law_use(law.spline, law.cells) < 1.0L ? 1 : 0;
        for (std::uint32_t j = law.window.begin; j < law.window.end; ++j) {
            CHECK(law.spline.coefficient(j) > 0 && law.spline.coefficient(j) <= law.spline.cap(j));
        }
    }
    CHECK_TEXT(2 * held > kStartCases, std::to_string(held).c_str());
}

TEST(LawStart, what_the_last_plan_did_before_its_fall_stays)
{
    const MachineLimits limits;
    Whole law = whole(line(limits, 6.0F, 60.0F, 0.005F), limits);
    start_by_ramps(law.spline, law.window, law.window.begin);
    const LawSpline before = law.spline;
    const LawWindow window{2, law.window.end, 0.0F, law.window.end_factor};
    const std::uint32_t from = end_of_kept(law.spline, window, law.cells + 2);
    CHECK(from > 10 && from + 5 < window.end);
    start_by_ramps(law.spline, window, from);
    for (std::uint32_t j = 0; j < from; ++j) {
        DOUBLES_EQUAL(static_cast<double>(before.coefficient(j)),
                      static_cast<double>(law.spline.coefficient(j)), 0.0);
    }
    CHECK(largest_law_use(law.spline, law.cells) < 1.0L);
    UNSIGNED_LONGS_EQUAL(window.begin, end_of_kept(law.spline, window, 0));
}
