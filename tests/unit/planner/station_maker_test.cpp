// The speed at which filters and shaper leave a turn by no more than they may, against the filters
// themselves.
#include "firmware/planner/station_maker.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kTurnSeed = 9091;
constexpr int kTurnCases = 400;

// A mean of the last `ticks` values, applied to all of them.
std::vector<double> mean(const std::vector<double>& values, unsigned ticks)
{
    std::vector<double> means;
    for (std::size_t i = ticks - 1; i < values.size(); ++i) {
        double sum = 0;
        for (unsigned k = 0; k < ticks; ++k) {
            sum += values[i - k];
        }
        means.push_back(sum / ticks);
    }
    return means;
}

// By how much a turn that is passed at a speed is cut, mm: the way across one side, |s| times half of
// the turn, behind both filters.
double cut(double turned, double speed, AxisFilter filter)
{
    std::vector<double> across;
    const int half = 200;
    for (int tick = -half; tick <= half; ++tick) {
        across.push_back(0.5 * turned * speed * 1e-3 * std::abs(tick));
    }
    const std::vector<double> smooth = mean(mean(across, filter.first), filter.second);
    return *std::min_element(smooth.begin(), smooth.end());
}

// Jerk behind both filters of an acceleration that jumps, over the jerk of the axis: its greatest
// magnitude, at a constant speed. The filters in twentieths of a tick.
double felt_jerk(const std::vector<LawJoint>& joints, double speed, AxisFilter filter)
{
    constexpr double kStep = 5e-5;  // s
    constexpr unsigned kStepsATick = 20;
    std::vector<double> acceleration;
    for (double way = -1; way < 6; way += speed * kStep) {
        double sum = 0;
        for (const LawJoint& joint : joints) {
            const double at = static_cast<double>(joint.at) / 16e6;
            // Over the height of the kernel, 1/first.
            sum += at <= way ? static_cast<double>(to_vec(joint.jump).y) : 0.0;
        }
        acceleration.push_back(sum * speed * speed * filter.first * 1e-3);
    }
    const std::vector<double> smooth =
        mean(mean(acceleration, kStepsATick * filter.first), kStepsATick * filter.second);
    double most = 0;
    for (std::size_t i = 1; i < smooth.size(); ++i) {
        most = std::max(most, std::fabs(smooth[i] - smooth[i - 1]) / kStep);
    }
    return most;
}

}  // namespace

TEST_GROUP(StationMaker){};

// Jumps of curvature to and fro within the filters' reach: what is kept is no less than what the axis
// feels, and of many it is far less than the sum of magnitudes.
TEST(StationMaker, jumps_that_cancel_are_kept_by_their_net_change)
{
    std::mt19937_64 random{kTurnSeed + 1};
    std::uniform_real_distribution<float> part{0, 1};
    double kept_of_all = 0;
    double magnitudes_of_all = 0;
    for (int n = 0; n < 60; ++n) {
        Block block{};
        block.filter = {4, 2};
        set_length(block, 160'000'000);
        block.displacement = {160'000'000, 0, 0};
        block.feed = 1e4F;
        block.centripetal = 1e6F;
        LawPath path;
        path.append(block);
        path.close();
        StationMaker maker;
        maker.set_limits(MachineLimits{});
        std::vector<LawJoint> joints;
        const LaneVec none = all_lanes(0.0F);
        const float speed = 15.0F + 60.0F * part(random);
        double magnitudes = 0;
        for (float at = 4.8F; at < 5.2F; at += 0.02F + 0.06F * part(random)) {
            const float size = 1e-5F * (0.2F + part(random));
            const float jump = joints.size() % 2 == 0 ? size : -size;
            const auto place = static_cast<std::int64_t>(at * 16e6F);
            joints.push_back({place, place, none, to_lanes(AxisVecf{0, jump, 0}), none, none, none,
                              0.006F, kUnlimited, 0.0F});
            magnitudes += static_cast<double>(size);
        }
        PathCursor cursor;
        const Station station =
            maker.make(path, cursor, 79'200'000, 80'800'000, {joints.data(), joints.size()}, speed);
        const auto v = static_cast<double>(speed);
        const double kept = static_cast<double>(to_vec(station.kept.jump).y) * v * v +
                            static_cast<double>(to_vec(station.kept.turn).y) * v;
        CHECK(felt_jerk(joints, v, block.filter) <= 1.001 * kept);
        kept_of_all += kept / (v * v);
        magnitudes_of_all += magnitudes;
    }
    CHECK(kept_of_all < 0.5 * magnitudes_of_all);
}

TEST(StationMaker, a_turn_is_cut_by_no_more_than_the_filters_may)
{
    std::mt19937_64 random{kTurnSeed};
    std::uniform_real_distribution<float> part{0, 1};
    for (int n = 0; n < kTurnCases; ++n) {
        Block block{};
        block.filter = {static_cast<std::uint8_t>(2 + random() % 20), 2};
        const auto first = static_cast<float>(block.filter.first);
        // The filters shrink a circle by their deviation.
        const float square = (first * first + 4.0F - 2.0F) * kServoTick * kServoTick / 24.0F;
        const float deviation = 0.001F + 0.02F * part(random);
        const float turned = 0.0001F + 0.01F * part(random);
        StationMaker maker;
        maker.set_limits(MachineLimits{});
        const LawBlock law_block{&block, 1e8F, deviation / square};
        const double speed =
            std::sqrt(static_cast<double>(maker.cap_of_turn(law_block, turned, 0.0F)));
        const double left = cut(static_cast<double>(turned), speed, block.filter);
        CHECK(left <= 1.001 * static_cast<double>(deviation));
        CHECK(left >= 0.6 * static_cast<double>(deviation));
        // A bend beside it leaves less for the turn, and a shaper leaves less for both.
        CHECK(maker.cap_of_turn(law_block, turned, 0.1F) <
              maker.cap_of_turn(law_block, turned, 0.0F));
        InputShaper shaper;
        shaper.length = 0.02F;
        shaper.square = 1e-4F;
        shaper.mean_time = 0.01F;
        maker.set_shaper(shaper);
        const LawBlock shaped{&block, 1e8F, deviation / (square + 0.5F * shaper.square)};
        CHECK(std::sqrt(static_cast<double>(maker.cap_of_turn(shaped, turned, 0.0F))) < speed);
    }
}
