// Chords stay in their band, at samples and between them.
#include "host_tools/grid_pocket/profile_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::grid_pocket;

namespace {

std::vector<BandPoint> random_band(std::mt19937& random, double width)
{
    std::uniform_real_distribution<double> phase{0, 6.28};
    std::uniform_real_distribution<double> wave{3, 12};
    const double p = phase(random);
    const double q = phase(random);
    const double l = wave(random);
    const double m = wave(random);
    std::vector<BandPoint> band;
    for (int i = 0; i <= 300; ++i) {
        const double s = 0.2 * i;
        const double z = 1.5 * std::sin(s / l + p) + 0.5 * std::cos(s / m + q);
        band.push_back({s, z, z + width});
    }
    return band;
}

}  // namespace

TEST_GROUP(ProfileFit){};

TEST(ProfileFit, TakesOneChordForAStraightRun)
{
    std::vector<BandPoint> band;
    for (int i = 0; i <= 50; ++i) {
        band.push_back({0.1 * i, 0.02 * i, 0.02 * i + 0.01});
    }
    LONGS_EQUAL(2, fit_chords(band, 0.005).size());
}

TEST(ProfileFit, StaysInTheBandOnRandomProfiles)
{
    constexpr unsigned kSeed = 99;
    std::printf("ProfileFit seed %u\n", kSeed);
    std::mt19937 random{kSeed};
    for (int round = 0; round < 300; ++round) {
        const auto band = random_band(random, 0.01 + 0.001 * round);
        const double z = (band[0].low + band[0].high) / 2;
        std::size_t i = 0;
        const auto chords = fit_chords(band, z);
        for (std::size_t k = 1; k < chords.size(); ++k) {
            for (; i < band.size() && band[i].s <= chords[k].s; ++i) {
                const double share =
                    (band[i].s - chords[k - 1].s) / (chords[k].s - chords[k - 1].s);
                const double at = chords[k - 1].z + (chords[k].z - chords[k - 1].z) * share;
                CHECK(at >= band[i].low - 1e-9 && at <= band[i].high + 1e-9);
            }
        }
        DOUBLES_EQUAL(60, chords.back().s, 1e-9);
    }
}
