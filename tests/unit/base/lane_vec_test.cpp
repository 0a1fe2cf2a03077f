// Vectors in lanes have the bits of vectors of three numbers.
#include "firmware/base/lane_vec.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

using namespace cusp;

TEST_GROUP(LaneVec){};

TEST(LaneVec, HasTheBitsOfAVec3f)
{
    constexpr unsigned kSeed = 4711;
    std::mt19937_64 random{kSeed};
    std::uniform_real_distribution<float> exponent{-20, 20};
    const auto number = [&] {
        const float size = std::exp2(exponent(random));
        return random() % 2 == 0 ? size : -size;
    };
    const auto vector = [&] {
        return Vec3f{number(), number(), number()};
    };
    for (unsigned i = 0; i < 20000; ++i) {
        const std::string where = "seed " + std::to_string(kSeed) + ", " + std::to_string(i);
        const Vec3f a = vector();
        const Vec3f b = vector();
        const float k = number();
        const LaneVec p = to_lanes(a);
        const LaneVec q = to_lanes(b);
        CHECK_TEXT(to_vec(p) == a, where.c_str());
        CHECK_TEXT(to_vec(p + q) == a + b, where.c_str());
        CHECK_TEXT(to_vec(p - q) == a - b, where.c_str());
        CHECK_TEXT(to_vec(p * k) == a * k, where.c_str());
        CHECK_TEXT(to_vec(p / k) == a / k, where.c_str());
        CHECK_TEXT(to_vec(magnitude(p)) == magnitude(a), where.c_str());
        const Vec3f most{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
        CHECK_TEXT(to_vec(larger(p, q)) == most, where.c_str());
        const Vec3f fewest{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
        CHECK_TEXT(to_vec(smaller(p, q)) == fewest, where.c_str());
        const Vec3f products{a.x * b.x, a.y * b.y, a.z * b.z};
        CHECK_TEXT(to_vec(product(p, q)) == products, where.c_str());
        const Vec3f quotients{a.x / b.x, a.y / b.y, a.z / b.z};
        CHECK_TEXT(to_vec(quotient(p, q)) == quotients, where.c_str());
        CHECK_TEXT(to_vec(all_lanes(k)) == (Vec3f{k, k, k}), where.c_str());
        CHECK_TEXT(least(k, p) == std::min({k, a.x, a.y, a.z}), where.c_str());
        CHECK_TEXT(dot(p, q) == dot(a, b), where.c_str());
        CHECK_TEXT(norm(p) == norm(a), where.c_str());
        const auto nanometres = [&] {
            return static_cast<std::int32_t>(random()) / 2;
        };
        const Vec3<std::int32_t> from{nanometres(), nanometres(), nanometres()};
        const Vec3<std::int32_t> to{nanometres(), nanometres(), nanometres()};
        const Vec3<std::int32_t> d = to - from;
        const Vec3f whole{static_cast<float>(d.x), static_cast<float>(d.y),
                          static_cast<float>(d.z)};
        CHECK_TEXT(to_vec(scaled_difference(to, from, 1e-6F)) == whole * 1e-6F, where.c_str());
    }
}
