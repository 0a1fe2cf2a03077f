// Tables u(s): the speed they give along random pieces, and the derivatives against differences.
#include "firmware/nurbs/arc_length_table.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::nurbs;

namespace {

path::BezierPiece random_piece(std::mt19937_64& random)
{
    std::uniform_int_distribution<int> orders{2, 5};
    std::uniform_real_distribution<float> coordinate{-3, 3};
    std::uniform_real_distribution<float> weights{0.5F, 1};
    path::BezierPiece piece{};
    piece.order = static_cast<std::uint8_t>(orders(random));
    for (unsigned i = 0; i < piece.order; ++i) {
        // Progress along x keeps cusps away.
        const AxisVecf p{4.0F * static_cast<float>(i) + 0.3F * coordinate(random),
                         coordinate(random), coordinate(random)};
        piece.points[i] = i == 0 ? AxisVecf{} : p;
        piece.weights[i] = weights(random);
    }
    return piece;
}

AxisVecd double_point_at(const path::BezierPiece& piece, double u)
{
    std::array<AxisVecd, path::kMaxOrder> a{};
    std::array<double, path::kMaxOrder> w{};
    for (unsigned i = 0; i < piece.order; ++i) {
        w[i] = static_cast<double>(piece.weights[i]);
        a[i] =
            AxisVecd{static_cast<double>(piece.points[i].x), static_cast<double>(piece.points[i].y),
                     static_cast<double>(piece.points[i].z)} *
            w[i];
    }
    for (unsigned n = piece.order; n > 1; --n) {
        for (unsigned i = 0; i + 1 < n; ++i) {
            a[i] = a[i] * (1 - u) + a[i + 1] * u;
            w[i] = w[i] * (1 - u) + w[i + 1] * u;
        }
    }
    return a[0] / w[0];
}

}  // namespace

TEST_GROUP(ArcLengthTable) { std::mt19937_64 random{5}; };

TEST(ArcLengthTable, KeepsTheSpeedWithin1e4)
{
    double worst = 0;
    int made = 0;
    for (int i = 0; i < 2000; ++i) {
        const path::BezierPiece piece = random_piece(random);
        ArcLengthTable table;
        if (!make_arc_length_table(piece, table)) {
            continue;
        }
        ++made;
        // Over steps of 1/300 of the piece, so that float rounding does not hide the quintic.
        constexpr int kSteps = 300;
        std::uint8_t interval = 0;
        const double step = static_cast<double>(table.length()) / kSteps;
        AxisVecd last{};
        for (int k = 1; k <= kSteps; ++k) {
            const auto s = static_cast<float>(step * k);
            const AxisVecd p =
                double_point_at(piece, static_cast<double>(parameter_at(table, s, interval)));
            // A chord of a curve is shorter than its arc by a 24th of (curvature times step)^2.
            const CurveState state = state_at(piece, parameter_at(table, s, interval));
            const double bend = static_cast<double>(norm(state.curvature)) * step;
            const double speed = norm(p - last) / step * (1 + bend * bend / 24);
            if (bend < 0.05) {
                worst = std::max(worst, std::fabs(speed - 1));
            }
            last = p;
        }
    }
    CHECK(made > 1950);
    CHECK_TEXT(worst < static_cast<double>(kMaxSpeedError), std::to_string(worst).c_str());
}

TEST(ArcLengthTable, EndsExactlyAtTheEnds)
{
    for (int i = 0; i < 200; ++i) {
        const path::BezierPiece piece = random_piece(random);
        ArcLengthTable table;
        if (!make_arc_length_table(piece, table)) {
            continue;
        }
        std::uint8_t interval = 0;
        CHECK(parameter_at(table, 0, interval) == 0.0F);
        CHECK(parameter_at(table, table.length(), interval) == 1.0F);
        CHECK(parameter_at(table, -1, interval) == 0.0F);
        CHECK(point_at(piece, 0) == piece.points[0]);
        CHECK(point_at(piece, 1) == piece.points[piece.order - 1]);
    }
}

TEST(ArcLengthTable, IsMonotonic)
{
    const path::BezierPiece piece = random_piece(random);
    ArcLengthTable table;
    CHECK(make_arc_length_table(piece, table));
    std::uint8_t interval = 0;
    float last = 0;
    for (int i = 1; i <= 10000; ++i) {
        const float u =
            parameter_at(table, table.length() * static_cast<float>(i) / 10000, interval);
        CHECK(u >= last);
        last = u;
    }
}

TEST(ArcLengthTable, DerivativesAgreeWithDifferences)
{
    for (int i = 0; i < 500; ++i) {
        const path::BezierPiece piece = random_piece(random);
        ArcLengthTable table;
        if (!make_arc_length_table(piece, table)) {
            continue;
        }
        const float u = 0.2F + 0.6F * static_cast<float>(i) / 500;
        const CurveState state = state_at(piece, u);
        DOUBLES_EQUAL(1, static_cast<double>(norm(state.tangent)), 1e-6);
        constexpr double kStep = 1e-4;
        const auto at = [&](double k) {
            const CurveState s = state_at(piece, u + static_cast<float>(k * kStep));
            return s;
        };
        const float scale = state.du / (2 * static_cast<float>(kStep));
        const AxisVecf curvature = (at(1).tangent - at(-1).tangent) * scale;
        DOUBLES_EQUAL(0, static_cast<double>(norm(curvature - state.curvature)),
                      2e-3 + 0.01 * static_cast<double>(norm(state.curvature)));
        constexpr int kWide = 20;
        const AxisVecf change = (at(kWide).curvature - at(-kWide).curvature) * (scale / kWide);
        DOUBLES_EQUAL(0, static_cast<double>(norm(change - state.change)),
                      2e-3 + 0.02 * static_cast<double>(norm(state.change)));
    }
}

TEST(ArcLengthTable, RefusesACusp)
{
    path::BezierPiece piece{};
    piece.order = 3;
    piece.points[1] = {1, 0, 0};
    for (float& weight : piece.weights) {
        weight = 1;
    }
    ArcLengthTable table;
    CHECK(!make_arc_length_table(piece, table));
}
