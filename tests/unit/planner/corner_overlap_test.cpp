// Overlaps at corners, played with full acceleration and filtered in long double.
#include "firmware/planner/corner_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kSeed = 9120;
constexpr int kTicks = 400;
constexpr int kStop = 200;  // the tick after the last step before the corner
constexpr AxisFilter kFilter{10, 2};
constexpr int kPathFilter = 20;

using Track = std::vector<double>;

Track box(const Track& in, int n)
{
    Track out(in.size());
    double sum = 0;
    for (std::size_t k = 0; k < in.size(); ++k) {
        sum += in[k] - (k >= static_cast<std::size_t>(n) ? in[k - static_cast<std::size_t>(n)] : 0);
        out[k] = sum / n;
    }
    return out;
}

struct Worst {
    double jerk_share;
    double distance;  // of the corner from the path
};

// Positions relative to the corner: the end of the stretch before, braked at once from 100 ticks
// away, plus the start of the one after.
Worst play(Vec3f t0, Vec3f t1, const CornerOverlap& overlap, const MachineLimits& limits)
{
    Track before(kTicks);
    Track after(kTicks);
    const int start = kStop + kPathFilter + 1 - overlap.ticks;
    for (int k = 0; k < kTicks; ++k) {
        if (k < kStop) {
            before[static_cast<std::size_t>(k)] =
                static_cast<double>(overlap.braking) * 1e-6 * (kStop - k);
        }
        if (k >= start) {
            after[static_cast<std::size_t>(k)] =
                static_cast<double>(overlap.speeding) * 1e-6 * (k - start + 1);
        }
    }
    before = box(before, kPathFilter);
    after = box(after, kPathFilter);
    std::array<Track, 3> axes;
    for (unsigned i = 0; i < 3; ++i) {
        Track steps(kTicks);
        for (std::size_t k = 0; k < kTicks; ++k) {
            steps[k] =
                static_cast<double>(t0[i]) * before[k] + static_cast<double>(t1[i]) * after[k];
        }
        steps = box(box(steps, kFilter.first), kFilter.second);
        axes[i] = steps;
    }
    Worst worst{0, 1e9};
    Vec3d left{};  // from the start to the corner
    for (unsigned i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < kTicks; ++k) {
            left[i] += static_cast<double>(t0[i]) * before[k];
        }
    }
    Vec3d at = left * -1.0;
    for (std::size_t k = 0; k + 60 < kTicks; ++k) {
        const Vec3d step{axes[0][k], axes[1][k], axes[2][k]};
        const double square = dot(step, step);
        const double part = square > 0 ? std::clamp(-dot(at, step) / square, 0.0, 1.0) : 0.0;
        const double distance = norm(at + step * part);
        at = at + step;
        if (k < 90) {
            continue;  // the start from nothing at full speed
        }
        worst.distance = std::min(worst.distance, distance);
        for (unsigned i = 0; i < 3; ++i) {
            const double jerk = (axes[i][k + 1] - 2 * axes[i][k] + axes[i][k - 1]) * 1e9;
            worst.jerk_share =
                std::max(worst.jerk_share, std::fabs(jerk) / static_cast<double>(limits.jerk[i]));
        }
    }
    return worst;
}

Vec3f any_direction(std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    const Vec3d v{normal(random), normal(random), normal(random)};
    const Vec3d unit = v / norm(v);
    return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
}

CornerOverlap overlap_of(Vec3f t0, Vec3f t1, float deviation)
{
    return corner_overlap({{t0, {}}, 10.0F}, {{t1, {}}, 10.0F}, MachineLimits{}, kPathFilter,
                          kFilter, deviation);
}

}  // namespace

TEST_GROUP(CornerOverlaps){};

TEST(CornerOverlaps, KeepJerkAndDeviationAtAnyCorner)
{
    std::mt19937_64 random{kSeed};
    int overlapping = 0;
    for (int k = 0; k < 3000; ++k) {
        const Vec3f t0 = any_direction(random);
        const Vec3f t1 = any_direction(random);
        const float deviation =
            0.0005F * static_cast<float>(1 + std::uniform_int_distribution<int>{0, 60}(random));
        const CornerOverlap overlap = overlap_of(t0, t1, deviation);
        if (overlap.ticks == 0) {
            continue;
        }
        ++overlapping;
        const Worst worst = play(t0, t1, overlap, MachineLimits{});
        const std::string which = "case " + std::to_string(k) + ": " +
                                  std::to_string(worst.distance) + " of " +
                                  std::to_string(static_cast<double>(deviation)) + " mm";
        CHECK_TEXT(worst.jerk_share <= 1.0005, which.c_str());
        CHECK_TEXT(worst.distance <= static_cast<double>(deviation), which.c_str());
    }
    CHECK(overlapping > 1000);
}

TEST(CornerOverlaps, ARightAngleIsCutAlmostByWhatIsAllowed)
{
    const CornerOverlap overlap = overlap_of({1, 0, 0}, {0, 1, 0}, 0.01F);
    LONGS_EQUAL(17, overlap.ticks);
    DOUBLES_EQUAL(1000.0, static_cast<double>(overlap.braking), 0.01);
    const Worst worst = play({1, 0, 0}, {0, 1, 0}, overlap, MachineLimits{});
    CHECK(worst.distance > 0.008);
}

TEST(CornerOverlaps, StraightOnThereIsNothingToGain)
{
    LONGS_EQUAL(0, overlap_of({1, 0, 0}, {1, 0, 0}, 0.01F).ticks);
}

TEST(CornerOverlaps, NoneWhereAStretchIsShorterThanItsFirstTicks)
{
    const CornerSide side{{{1, 0, 0}, {}}, 10.0F};
    const CornerSide tiny{{{0, 1, 0}, {}}, 0.001F};
    LONGS_EQUAL(0, corner_overlap(side, tiny, MachineLimits{}, kPathFilter, kFilter, 0.01F).ticks);
}
