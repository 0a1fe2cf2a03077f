#include "firmware/interpolator/shaper_filter.hpp"

#include <algorithm>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using cusp::interpolator::ShaperFilter;
using namespace cusp::planner;

namespace {

InputShaper random_shaper(std::mt19937& random)
{
    PerAxis<AxisVibration> axes{};
    for (AxisVibration& axis : axes) {
        axis.type = ShaperType(random() % 4);
        axis.frequency = 30.0F + float(random() % 17000) / 100.0F;
        axis.damping = float(random() % 300) / 1000.0F;
    }
    return make_input_shaper(axes);
}

}  // namespace

TEST_GROUP(ShaperFilters){};

// Whatever goes in, of any sign and size that the interpolator knows, comes out, none of it later
// than the shaper's length, and never more at once than went in.
TEST(ShaperFilters, GiveBackWhatTheyGetToTheLastUnit)
{
    for (unsigned seed = 1; seed < 400; ++seed) {
        std::mt19937 random{seed};
        const std::string which = "seed " + std::to_string(seed);
        const InputShaper shaper = random_shaper(random);
        if (!shaper.on() || shaper.ticks > kMostShaperTicks) {
            continue;
        }
        ShaperFilter filter{shaper};
        filter.reset();
        for (unsigned round = 0; round < 3; ++round) {
            const std::int32_t most = 1 << (random() % 31);
            AxisVec<std::int64_t> in{}, out{};
            const auto tell = [&](PathOffset value) {
                const PathOffset shaped = filter.add(value);
                for (unsigned i = 0; i < kAxisCount; ++i) {
                    in[i] += value[i];
                    out[i] += shaped[i];
                    CHECK_TEXT(std::abs(std::int64_t{shaped[i]}) <= most + 1, which.c_str());
                }
            };
            for (unsigned tick = 0; tick < 1 + random() % 300; ++tick) {
                const auto any = [&] {
                    return std::int32_t(std::int64_t(random()) % (2LL * most + 1) - most);
                };
                tell({any(), any(), random() % 2 == 0 ? 0 : any()});
            }
            tell({1, 0, 0});
            CHECK_TEXT(!filter.drained(), which.c_str());
            for (unsigned tick = 0; tick < shaper.ticks; ++tick) {
                tell({});
            }
            CHECK_TEXT(filter.drained(), which.c_str());
            for (unsigned i = 0; i < kAxisCount; ++i) {
                CHECK_TEXT(in[i] == out[i], which.c_str());
            }
            CHECK_TEXT((filter.add({}) == PathOffset{}), which.c_str());
        }
    }
}
