// Bounds of the derivatives over the stretches of curves, against places 16 times as dense.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

#include "firmware/planner/block.hpp"

using namespace cusp;
using namespace cusp::planner;

namespace {

// Control points that go on along x, or anywhere.
path::BezierPiece stretch_test_piece(std::mt19937_64& random)
{
    std::uniform_int_distribution<int> orders{3, 5};
    std::uniform_real_distribution<float> coordinate{-1, 1};
    std::uniform_real_distribution<float> exponent{-1, 0};
    std::uniform_real_distribution<float> weights{0.3F, 1};
    path::BezierPiece piece{};
    piece.order = static_cast<std::uint8_t>(orders(random));
    const float scale = 2.0F * std::pow(10.0F, exponent(random));
    const float along = random() % 2 == 0 ? 1.0F : 0.0F;
    for (unsigned i = 0; i < piece.order; ++i) {
        const AxisVecf p{along * static_cast<float>(i) + coordinate(random), coordinate(random),
                         coordinate(random)};
        piece.points[i] = i == 0 ? AxisVecf{} : p * scale;
        piece.weights[i] = weights(random);
    }
    return piece;
}

// By how much the largest of |f| exceeds the bound, as a part of the greatest bound of an axis.
float excess_over(const AxisVecf& f, const AxisVecf& bound)
{
    const float whole = std::max(bound.x, std::max(bound.y, bound.z));
    float most = 0;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        most = std::max(most, (std::fabs(f[i]) - bound[i]) / whole);
    }
    return most;
}

}  // namespace

TEST_GROUP(Stretches){};

TEST(Stretches, BoundTheDerivativesBetweenTheirPlaces)
{
    std::mt19937_64 random{7301};
    PathDerivatives worst{};
    unsigned curves = 0;
    for (int k = 0; k < 1200; ++k) {
        CurveBlock curve{};
        curve.piece = stretch_test_piece(random);
        if (!nurbs::make_arc_length_table(curve.piece, curve.table)) {
            continue;
        }
        ++curves;
        Block block{};
        block.shape = BlockShape::kCurve;
        block.curve = &curve;
        set_length(block,
                   static_cast<std::uint32_t>(curve.table.length() * kPathUnitsPerMillimetre));
        float from = 0;
        std::uint8_t interval = 0;
        for (unsigned i = 0; i < stretch_count(block); ++i) {
            const Stretch part = stretch(block, i);
            const float to = static_cast<float>(part.end) / kPathUnitsPerMillimetre;
            for (int n = 0; n <= 32; ++n) {
                const float s = from + (to - from) * static_cast<float>(n) / 32.0F;
                const nurbs::CurveState state =
                    nurbs::state_at(curve.piece, nurbs::parameter_at(curve.table, s, interval));
                const PathDerivatives bound = to_vec(part.derivatives);
                worst.first.x = std::max(worst.first.x, excess_over(state.tangent, bound.first));
                worst.second.x =
                    std::max(worst.second.x, excess_over(state.curvature, bound.second));
                worst.third.x = std::max(worst.third.x, excess_over(state.change, bound.third));
            }
            from = to;
        }
    }
    const std::string found = std::to_string(curves) + " " + std::to_string(worst.first.x) + " " +
                              std::to_string(worst.second.x) + " " + std::to_string(worst.third.x);
    CHECK(curves > 600);
    CHECK_TEXT(worst.first.x < 1e-4F && worst.second.x < 1e-4F && worst.third.x < 1e-3F,
               found.c_str());
}

TEST(Stretches, BoundTheDerivativesOfQuintics)
{
    std::mt19937_64 random{7302};
    std::uniform_real_distribution<float> coordinate{-1, 1};
    PathDerivatives worst{};
    for (int k = 0; k < 2000; ++k) {
        Block block;
        block.shape = BlockShape::kQuintic;
        block.displacement = {16'000'000, 0, 0};
        set_length(block, 16'000'000);
        for (AxisVecf& q : block.quintic.bulge) {
            q = AxisVecf{coordinate(random), coordinate(random), coordinate(random)} * 0.1F;
        }
        const auto& q = block.quintic.bulge;
        const AxisVecf a[] = {{},   AxisVecf{1, 0, 0} + q[0], q[1] - q[0], q[2] - q[1], q[3] - q[2],
                              -q[3]};
        float from = 0;
        for (unsigned i = 0; i < stretch_count(block); ++i) {
            const Stretch part = stretch(block, i);
            const float to = static_cast<float>(part.end) / kPathUnitsPerMillimetre;
            for (int n = 0; n <= 32; ++n) {
                const float x = from + (to - from) * static_cast<float>(n) / 32.0F;
                const AxisVecf first =
                    a[1] + (a[2] * 2 + (a[3] * 3 + (a[4] * 4 + a[5] * (5 * x)) * x) * x) * x;
                const AxisVecf second =
                    a[2] * 2 + (a[3] * 6 + (a[4] * 12 + a[5] * (20 * x)) * x) * x;
                const AxisVecf third = a[3] * 6 + (a[4] * 24 + a[5] * (60 * x)) * x;
                const PathDerivatives bound = to_vec(part.derivatives);
                worst.first.x = std::max(worst.first.x, excess_over(first, bound.first));
                worst.second.x = std::max(worst.second.x, excess_over(second, bound.second));
                worst.third.x = std::max(worst.third.x, excess_over(third, bound.third));
            }
            from = to;
        }
    }
    const std::string found = std::to_string(worst.first.x) + " " + std::to_string(worst.second.x) +
                              " " + std::to_string(worst.third.x);
    CHECK_TEXT(worst.first.x < 1e-5F && worst.second.x < 1e-5F && worst.third.x < 1e-5F,
               found.c_str());
}

// The end of one stretch begins the next: read alone, it computes that place itself.
TEST(Stretches, AreTheSameReadInOrderAndAlone)
{
    std::mt19937_64 random{7303};
    std::uniform_real_distribution<float> coordinate{-1, 1};
    for (int k = 0; k < 300; ++k) {
        Block block;
        CurveBlock curve{};
        curve.piece = stretch_test_piece(random);
        const bool is_curve = k % 3 == 0 && nurbs::make_arc_length_table(curve.piece, curve.table);
        if (is_curve) {
            block.shape = BlockShape::kCurve;
            block.curve = &curve;
        } else if (k % 3 == 1) {
            block.shape = BlockShape::kQuintic;
            block.displacement = {16'000'000, 0, 0};
            for (AxisVecf& q : block.quintic.bulge) {
                q = AxisVecf{coordinate(random), coordinate(random), coordinate(random)} * 0.1F;
            }
        } else {
            block.shape = BlockShape::kArc;
            block.arc = {{1, 0, 0}, {0, 1, 0}, {0, 0, coordinate(random)}, 1.0F, 0.1F, 9e-8F};
        }
        set_length(block, 16'000'000);
        StretchReader reader{block, 0};
        const unsigned count = stretch_count(block);
        CHECK(count > 1);
        for (unsigned i = 0; i < count; ++i) {
            const Stretch next = reader.next();
            const Stretch alone = stretch(block, i);
            const std::string where = "block " + std::to_string(k) + ", " + std::to_string(i);
            CHECK_TEXT(next.end == alone.end, where.c_str());
            CHECK_TEXT(to_vec(next.derivatives.first) == to_vec(alone.derivatives.first),
                       where.c_str());
            CHECK_TEXT(to_vec(next.derivatives.second) == to_vec(alone.derivatives.second),
                       where.c_str());
            CHECK_TEXT(to_vec(next.derivatives.third) == to_vec(alone.derivatives.third),
                       where.c_str());
        }
        UNSIGNED_LONGS_EQUAL(16'000'000, stretch(block, count - 1).end);
    }
}

// Each derivative is the difference of the one before, over a step as long as float allows.
TEST(Stretches, DerivativesAreThoseOfTheOnesBefore)
{
    std::mt19937_64 random{7302};
    std::uniform_real_distribution<float> coordinate{-1, 1};
    for (int k = 0; k < 400; ++k) {
        CurveBlock curve{};
        Block block{};
        if (k % 2 == 0) {
            curve.piece = stretch_test_piece(random);
            if (!nurbs::make_arc_length_table(curve.piece, curve.table)) {
                continue;
            }
            block.shape = BlockShape::kCurve;
            block.curve = &curve;
            set_length(block,
                       static_cast<std::uint32_t>(curve.table.length() * kPathUnitsPerMillimetre));
        } else {
            // A helix whose radius changes a little.
            const float radius = 1.5F + coordinate(random);
            block.shape = BlockShape::kArc;
            block.arc = {{1, 0, 0},
                         {0, 1, 0},
                         {0, 0, 0.2F * radius * coordinate(random)},
                         radius,
                         1e-3F * coordinate(random),
                         0.9F / (radius * kPathUnitsPerMillimetre)};
            set_length(block, static_cast<std::uint32_t>(radius * kPathUnitsPerMillimetre));
        }
        const float length = static_cast<float>(block.length) / kPathUnitsPerMillimetre;
        const float step = 0.01F * length;
        const LaneDerivatives a = derivatives_at(block, 0.4F * length);
        const LaneDerivatives m = derivatives_at(block, 0.4F * length + step);
        const LaneDerivatives b = derivatives_at(block, 0.4F * length + 2.0F * step);
        const float scale = 0.5F / step;
        const float second_off = norm((b.first - a.first) * scale - m.second);
        const float third_off = norm((b.second - a.second) * scale - m.third);
        // Of the next derivative over the step, and rounding.
        const float bound = norm(m.third) + norm(b.third - a.third) + 1.0F;
        CHECK_TEXT(second_off < 0.02F * bound * length + 1e-4F / step, std::to_string(k).c_str());
        CHECK_TEXT(third_off < norm(b.third - a.third) + 1e-3F * bound / step,
                   std::to_string(k).c_str());
    }
}
