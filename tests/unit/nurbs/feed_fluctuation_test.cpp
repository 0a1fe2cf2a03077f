// Evenness of float points along a curve when the arc length grows evenly: the advance of each tick
// along the true curve, in double.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/nurbs/arc_length_table.hpp"
#include "firmware/nurbs/piece_stream.hpp"

using namespace cusp;
using namespace cusp::nurbs;

namespace {

struct PointAndSpeed {
    AxisVecd point;
    AxisVecd derivative;
};

PointAndSpeed exact_at(const path::BezierPiece& piece, double u)
{
    std::array<AxisVecd, path::kMaxOrder> a{};
    std::array<double, path::kMaxOrder> w{};
    for (unsigned i = 0; i < piece.order; ++i) {
        w[i] = static_cast<double>(piece.weights[i]);
        a[i] = to_double(piece.points[i]) * w[i];
    }
    for (unsigned n = piece.order; n > 2; --n) {
        for (unsigned i = 0; i + 1 < n; ++i) {
            a[i] = a[i] * (1 - u) + a[i + 1] * u;
            w[i] = w[i] * (1 - u) + w[i + 1] * u;
        }
    }
    const double weight = w[0] * (1 - u) + w[1] * u;
    return {(a[0] * (1 - u) + a[1] * u) / weight,
            (a[1] * w[0] - a[0] * w[1]) * ((piece.order - 1) / (weight * weight))};
}

double exact_length(const path::BezierPiece& piece, double to)
{
    constexpr int kSteps = 400;  // Simpson
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double factor = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
        sum += factor * norm(exact_at(piece, to * i / kSteps).derivative);
    }
    return sum * to / (3 * kSteps);
}

// Arc length up to the point of the curve nearest to p.
double station_of(const path::BezierPiece& piece, AxisVecd p, double u)
{
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const PointAndSpeed at = exact_at(piece, u);
        u += dot(p - at.point, at.derivative) / dot(at.derivative, at.derivative);
    }
    return exact_length(piece, u);
}

// A closed wavy curve of degree 4 in space, with weights, about 50 mm across.
std::vector<Piece> pieces_of_a_curve(unsigned seed)
{
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> radius{15, 30};
    std::uniform_real_distribution<double> weight{0.5, 2};
    PieceStream stream;
    std::vector<Piece> pieces;
    Piece piece{};
    stream.open(KnotSource::kUniform, 5, {{20000000, 0, 0}, 1});
    for (int i = 1; i < 24; ++i) {
        const double angle = i * 0.27;
        const double r = radius(random);
        stream.add_point(
            {to_position({r * std::cos(angle), r * std::sin(angle), 0.1 * r}), weight(random)});
        while (stream.next(piece)) {
            pieces.push_back(piece);
        }
    }
    CHECK(static_cast<bool>(stream.close()));
    while (stream.next(piece)) {
        pieces.push_back(piece);
    }
    return pieces;
}

// The largest relative difference of the advance of a tick from `step`, within pieces.
double largest_fluctuation(const std::vector<Piece>& pieces, double step)
{
    double largest = 0;
    for (const Piece& piece : pieces) {
        ArcLengthTable table;
        CHECK(make_arc_length_table(piece.bezier, table));
        std::uint8_t interval = 0;
        double last = 0;
        for (int k = 1; k * step < static_cast<double>(table.length()); ++k) {
            const float u = parameter_at(table, static_cast<float>(k * step), interval);
            const double station = station_of(piece.bezier, to_double(point_at(piece.bezier, u)),
                                              static_cast<double>(u));
            largest = std::max(largest, std::fabs((station - last) / step - 1));
            last = station;
        }
    }
    return largest;
}

}  // namespace

TEST_GROUP(FeedFluctuation){};

TEST(FeedFluctuation, StaysBelow2In10000At20And100MillimetresASecond)
{
    const std::vector<Piece> pieces = pieces_of_a_curve(3);
    for (const double step : {0.02, 0.1}) {  // mm in a tick of 1 ms
        const double largest = largest_fluctuation(pieces, step);
        CHECK_TEXT(largest <= 2e-4, std::to_string(largest).c_str());
    }
}
