// Vectors in lanes have the bits of vectors of three numbers.
#include "firmware/base/lane_vec.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

using namespace cusp;

TEST_GROUP(LaneVec){};

TEST(LaneVec, HasTheBitsOfAVector)
{
    constexpr unsigned kSeed = 4711;
    std::mt19937_64 random{kSeed};
    std::uniform_real_distribution<float> exponent{-20, 20};
    const auto number = [&] {
        const float size = std::exp2(exponent(random));
        return random() % 2 == 0 ? size : -size;
    };
    const auto vector = [&] {
        AxisVecf v{};
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            v[axis] = number();
        }
        return v;
    };
    // A vector of what a function makes of each axis.
    const auto of_each = [](auto f) {
        AxisVecf v{};
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            v[axis] = f(axis);
        }
        return v;
    };
    for (unsigned i = 0; i < 20000; ++i) {
        const std::string where = "seed " + std::to_string(kSeed) + ", " + std::to_string(i);
        const AxisVecf a = vector();
        const AxisVecf b = vector();
        const float k = number();
        const LaneVec p = to_lanes(a);
        const LaneVec q = to_lanes(b);
        CHECK_TEXT(to_vec(p) == a, where.c_str());
        CHECK_TEXT(to_vec(p + q) == a + b, where.c_str());
        CHECK_TEXT(to_vec(p - q) == a - b, where.c_str());
        CHECK_TEXT(to_vec(p * k) == a * k, where.c_str());
        CHECK_TEXT(to_vec(p / k) == a / k, where.c_str());
        CHECK_TEXT(to_vec(magnitude(p)) == magnitude(a), where.c_str());
        const AxisVecf most = of_each([&](unsigned axis) { return std::max(a[axis], b[axis]); });
        CHECK_TEXT(to_vec(larger(p, q)) == most, where.c_str());
        const AxisVecf fewest = of_each([&](unsigned axis) { return std::min(a[axis], b[axis]); });
        CHECK_TEXT(to_vec(smaller(p, q)) == fewest, where.c_str());
        const AxisVecf products = of_each([&](unsigned axis) { return a[axis] * b[axis]; });
        CHECK_TEXT(to_vec(product(p, q)) == products, where.c_str());
        const AxisVecf quotients = of_each([&](unsigned axis) { return a[axis] / b[axis]; });
        CHECK_TEXT(to_vec(quotient(p, q)) == quotients, where.c_str());
        CHECK_TEXT(to_vec(all_lanes(k)) == of_each([k](unsigned) { return k; }), where.c_str());
        float fewest_of_all = k;
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            fewest_of_all = std::min(fewest_of_all, a[axis]);
        }
        CHECK_TEXT(least(k, p) == fewest_of_all, where.c_str());
        CHECK_TEXT(dot(p, q) == dot(a, b), where.c_str());
        CHECK_TEXT(norm(p) == norm(a), where.c_str());
        AxisVec<std::int32_t> from{};
        AxisVec<std::int32_t> to{};
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            from[axis] = static_cast<std::int32_t>(random()) / 2;
            to[axis] = static_cast<std::int32_t>(random()) / 2;
        }
        const AxisVecf whole =
            of_each([&](unsigned axis) { return static_cast<float>(to[axis] - from[axis]); });
        CHECK_TEXT(to_vec(scaled_difference(to, from, 1e-6F)) == whole * 1e-6F, where.c_str());
    }
}
