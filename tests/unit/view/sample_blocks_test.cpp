// Every set point comes back exactly, whatever it is.
#include "host_tools/view/sample_blocks.hpp"

#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/view/inflated.hpp"

using namespace cusp;
using namespace cusp::view;

namespace {

std::int64_t unzigzag(std::uint64_t value)
{
    const auto half = static_cast<std::int64_t>(value >> 1U);
    return (value & 1U) != 0 ? -half - 1 : half;
}

std::vector<Position> unpacked(const std::string& bytes)
{
    ByteReader reader{bytes};
    const std::size_t ticks = reader.whole(4);
    const std::size_t block = reader.whole(4);
    std::vector<Position> out(ticks);
    for (std::size_t begin = 0; begin < ticks; begin += block) {
        const std::size_t count = std::min(ticks, begin + block) - begin - 1;
        std::array<std::array<std::int64_t, 3>, 3> seeds{};
        std::array<unsigned, 3> planes{};
        for (unsigned axis = 0; axis < 3; ++axis) {
            for (std::int64_t& seed : seeds[axis]) {
                seed = static_cast<std::int64_t>(reader.f64());
            }
            planes[axis] = static_cast<unsigned>(reader.whole(1));
        }
        const std::string raw = inflated(reader.take(reader.whole(4)));
        std::size_t at = 0;
        for (unsigned axis = 0; axis < 3; ++axis) {
            auto [place, velocity, acceleration] = seeds[axis];
            out[begin][axis] = place;
            for (std::size_t k = 0; k < count; ++k) {
                std::uint64_t value = 0;
                for (unsigned plane = 0; plane < planes[axis]; ++plane) {
                    value |= std::uint64_t{static_cast<unsigned char>(raw[at + plane * count + k])}
                             << 8U * plane;
                }
                acceleration += unzigzag(value);
                velocity += acceleration;
                place += velocity;
                out[begin + 1 + k][axis] = place;
            }
            at += planes[axis] * count;
        }
        CHECK_EQUAL(raw.size(), at);
    }
    CHECK(reader.done());
    return out;
}

void check_round_trip(const std::vector<Position>& points)
{
    SampleBlocks blocks;
    for (const Position& point : points) {
        blocks.add(point);
    }
    CHECK(unpacked(blocks.finish().text()) == points);
}

}  // namespace

TEST_GROUP(SampleBlocks){};

TEST(SampleBlocks, OfNoneAndFewSetPointsComeBack)
{
    check_round_trip({});
    check_round_trip({{5, -6, 7}});
    check_round_trip({{5, -6, 7}, {-1000000000000, 0, 1}, {0, 0, 0}});
}

TEST(SampleBlocks, OfTwoBlocksAndOneTickComeBack)
{
    std::vector<Position> points;
    std::mt19937 random{7};
    std::uniform_int_distribution<std::int64_t> jerk{-60, 60};
    Position at{1234567890123, -5, 0};
    Position velocity{};
    Position acceleration{};
    for (std::size_t k = 0; k < 2 * SampleBlocks::kBlock + 1; ++k) {
        acceleration = acceleration + Position{jerk(random), jerk(random), 0};
        velocity = velocity + acceleration;
        at = at + velocity;
        points.push_back(at);
    }
    check_round_trip(points);
}

TEST(SampleBlocks, ThatJumpAcrossTheMachineComeBack)
{
    std::vector<Position> points;
    std::mt19937_64 random{9};
    std::uniform_int_distribution<std::int64_t> place{-1000000000000, 1000000000000};
    for (int k = 0; k < 3000; ++k) {
        points.push_back({place(random), place(random), place(random)});
    }
    check_round_trip(points);
}

TEST(SampleBlocks, OfASteadyMoveTakeAlmostNothing)
{
    SampleBlocks blocks;
    for (std::int64_t k = 0; k < 100000; ++k) {
        blocks.add({20000 * k, 0, 0});
    }
    CHECK(blocks.finish().size() < 1000);
}
