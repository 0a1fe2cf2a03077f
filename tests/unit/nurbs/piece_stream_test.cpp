// Streamed pieces against de Boor's algorithm in long double.
#include "firmware/nurbs/piece_stream.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/nurbs/arc_length_table.hpp"

using namespace cusp;
using namespace cusp::nurbs;

namespace {

struct Reference {
    unsigned order;
    std::vector<ControlPoint> points;
    std::vector<double> knots;
};

// Cox and de Boor in long double, mm.
AxisVecd reference_at(const Reference& curve, long double u)
{
    const std::size_t p = curve.order - 1;
    std::size_t span = p;
    while (span + 1 < curve.points.size() && u >= static_cast<long double>(curve.knots[span + 1])) {
        ++span;
    }
    std::vector<std::array<long double, 4>> d;
    for (std::size_t j = span - p; j <= span; ++j) {
        const ControlPoint& c = curve.points[j];
        const long double w = c.weight;
        d.push_back({w * static_cast<long double>(c.position.x) / 1e6L,
                     w * static_cast<long double>(c.position.y) / 1e6L,
                     w * static_cast<long double>(c.position.z) / 1e6L, w});
    }
    for (std::size_t r = 1; r <= p; ++r) {
        for (std::size_t j = p; j >= r; --j) {
            const long double low = curve.knots[span - p + j];
            const long double high = curve.knots[span + 1 + j - r];
            const long double t = (u - low) / (high - low);
            for (std::size_t k = 0; k < 4; ++k) {
                d[j][k] = (1 - t) * d[j - 1][k] + t * d[j][k];
            }
        }
    }
    return {static_cast<double>(d[p][0] / d[p][3]), static_cast<double>(d[p][1] / d[p][3]),
            static_cast<double>(d[p][2] / d[p][3])};
}

void take(PieceStream& stream, std::vector<Piece>& pieces)
{
    Piece piece{};
    while (stream.next(piece)) {
        pieces.push_back(piece);
    }
}

std::vector<Piece> stream_of(const Reference& curve, KnotSource source)
{
    PieceStream stream;
    std::vector<Piece> pieces;
    stream.open(source, curve.order, curve.points[0]);
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
        if (i > 0) {
            stream.add_point(curve.points[i]);
        }
        if (source == KnotSource::kExplicit) {
            CHECK(static_cast<bool>(stream.add_knot(curve.knots[i])));
        }
        take(stream, pieces);
    }
    for (std::size_t i = curve.points.size(); i < curve.knots.size(); ++i) {
        if (source == KnotSource::kExplicit) {
            CHECK(static_cast<bool>(stream.add_knot(curve.knots[i])));
        }
    }
    if (source == KnotSource::kUniform) {
        CHECK(static_cast<bool>(stream.close()));
    }
    take(stream, pieces);
    CHECK(!stream.is_open());
    return pieces;
}

Reference random_curve(std::mt19937_64& random, bool uniform)
{
    std::uniform_int_distribution<unsigned> orders{2, 5};
    std::uniform_int_distribution<unsigned> counts{0, 12};
    std::uniform_int_distribution<std::int64_t> coordinate{-60000000, 60000000};
    std::uniform_real_distribution<double> weights{0.3, 3};
    std::uniform_real_distribution<double> steps{0.2, 3};
    Reference curve{};
    curve.order = orders(random);
    const unsigned n = curve.order + counts(random);
    double knot = 0;
    unsigned same = curve.order;
    for (unsigned i = 0; i < n + curve.order; ++i) {
        if (i < n) {
            curve.points.push_back(
                {{coordinate(random), coordinate(random), coordinate(random)}, weights(random)});
        }
        const bool step = i == n || (i >= curve.order && i < n &&
                                     (same + 1 >= curve.order || uniform || random() % 3 != 0));
        knot += step ? (uniform ? 1 : steps(random)) : 0;
        same = step ? 1 : same + 1;
        curve.knots.push_back(knot);
    }
    return curve;
}

// Largest distance of points of the pieces from the curve, both ways parametrised in order.
double largest_deviation(const Reference& curve, const std::vector<Piece>& pieces)
{
    constexpr int kSamples = 1000;  // of each span, so that corners are among them
    std::vector<AxisVecd> dense{to_millimetres(curve.points[0].position)};
    for (std::size_t k = 0; k + 1 < curve.knots.size(); ++k) {
        const long double from = curve.knots[k];
        const long double step = (static_cast<long double>(curve.knots[k + 1]) - from) / kSamples;
        for (int i = 1; i <= kSamples && step > 0; ++i) {
            // The last sample is on the near side of the knot.
            const long double u = from + step * (i == kSamples ? i - 1e-12L : i);
            dense.push_back(reference_at(curve, u));
        }
    }
    constexpr std::size_t kWindow = 1200;
    double worst = 0;
    std::size_t near = 0;
    Position start = curve.points[0].position;
    for (const Piece& piece : pieces) {
        for (int i = 0; i <= 8; ++i) {
            const AxisVecf relative = point_at(piece.bezier, static_cast<float>(i) / 8);
            const AxisVecd p = to_millimetres(start) + AxisVecd{static_cast<double>(relative.x),
                                                                static_cast<double>(relative.y),
                                                                static_cast<double>(relative.z)};
            double best = 1e9;
            std::size_t best_at = near;
            const std::size_t first = near > kWindow ? near - kWindow : 0;
            for (std::size_t k = first; k + 1 < dense.size() && k < near + kWindow; ++k) {
                const AxisVecd chord = dense[k + 1] - dense[k];
                const AxisVecd off = p - dense[k];
                const double t =
                    std::clamp(dot(chord, off) / std::max(1e-30, dot(chord, chord)), 0.0, 1.0);
                const double distance = norm(off - chord * t);
                if (distance < best) {
                    best = distance;
                    best_at = k;
                }
            }
            near = best_at;
            worst = std::max(worst, best);
        }
        start = piece.end;
    }
    return worst;
}

}  // namespace

TEST_GROUP(PieceStream) { std::mt19937_64 random{11}; };

TEST(PieceStream, FollowsRandomCurvesOfAllOrders)
{
    for (int i = 0; i < 30; ++i) {
        const bool uniform = i % 2 == 0;
        const Reference curve = random_curve(random, uniform);
        const std::vector<Piece> pieces =
            stream_of(curve, uniform ? KnotSource::kUniform : KnotSource::kExplicit);
        CHECK(!pieces.empty());
        CHECK(pieces.back().end == curve.points.back().position);
        // The samples' chords are within some 0.4 um of the curve, points of a piece within 2 nm.
        const double worst = largest_deviation(curve, pieces);
        CHECK_TEXT(worst < 5e-4, std::to_string(worst).c_str());
    }
}

TEST(PieceStream, GivesUniformAndExplicitKnotsTheSamePieces)
{
    const Reference curve = random_curve(random, true);
    const std::vector<Piece> a = stream_of(curve, KnotSource::kUniform);
    const std::vector<Piece> b = stream_of(curve, KnotSource::kExplicit);
    LONGS_EQUAL(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(a[i].end == b[i].end);
    }
}

TEST(PieceStream, MakesNoPieceLongerThanItsBoundAndAlwaysATable)
{
    const Reference curve{
        4,
        {{{0, 0, 0}, 1}, {{900000000, 0, 0}, 1}, {{0, 900000000, 0}, 1}, {{100000000, 0, 0}, 2}},
        {0, 0, 0, 0, 1, 1, 1, 1}};
    const std::vector<Piece> pieces = stream_of(curve, KnotSource::kExplicit);
    CHECK(pieces.size() > 50);
    for (const Piece& piece : pieces) {
        ArcLengthTable table;
        CHECK(make_arc_length_table(piece.bezier, table));
        CHECK(static_cast<double>(table.length()) <= kMaxPieceLength * (1 + 1e-6));
    }
}

TEST(PieceStream, PassesCuspsAndRepeatedPoints)
{
    // A cusp of the cubic (0,0) (10,10) (0,10) (10,0), and a curve that starts at a standstill.
    const Reference cusp{4,
                         {{{0, 0, 0}, 1},
                          {{10000000, 10000000, 0}, 1},
                          {{0, 10000000, 0}, 1},
                          {{10000000, 0, 0}, 1}},
                         {0, 0, 0, 0, 1, 1, 1, 1}};
    const Reference still{4,
                          {{{0, 0, 0}, 1},
                           {{0, 0, 0}, 1},
                           {{10000000, 10000000, 0}, 1},
                           {{20000000, 0, 0}, 1},
                           {{20000000, 0, 0}, 1}},
                          {0, 0, 0, 0, 1, 2, 2, 2, 2}};
    const Reference back{
        3, {{{0, 0, 0}, 1}, {{10000000, 0, 0}, 1}, {{0, 0, 0}, 1}}, {0, 0, 0, 1, 1, 1}};
    for (const Reference& curve : {cusp, still, back}) {
        const std::vector<Piece> pieces = stream_of(curve, KnotSource::kExplicit);
        CHECK(pieces.size() < 60);
        CHECK(pieces.back().end == curve.points.back().position);
        CHECK(largest_deviation(curve, pieces) < 0.0006);
        for (const Piece& piece : pieces) {
            ArcLengthTable table;
            CHECK(make_arc_length_table(piece.bezier, table));
        }
    }
}

TEST(PieceStream, LeavesOutPartsWithoutLength)
{
    const Reference curve{2,
                          {{{5, 5, 5}, 1}, {{5, 5, 5}, 1}, {{5, 5, 5}, 1}, {{1000005, 5, 5}, 1}},
                          {0, 0, 1, 2, 3, 3}};
    LONGS_EQUAL(1, stream_of(curve, KnotSource::kExplicit).size());
}

TEST(PieceStream, RefusesKnotsThatMakeNoCurve)
{
    const std::vector<std::vector<double>> bad = {
        {0, 1}, {0, 0, 0, 0}, {0, 0, 0, -1}, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 0.5}};
    for (const std::vector<double>& knots : bad) {
        PieceStream stream;
        stream.open(KnotSource::kExplicit, 3, {{0, 0, 0}, 1});
        for (std::size_t i = 0; i < knots.size(); ++i) {
            if (i > 0) {
                stream.add_point({{static_cast<std::int64_t>(i) * 1000000, 0, 0}, 1});
            }
            CHECK(static_cast<bool>(stream.add_knot(knots[i])) == (i + 1 < knots.size()));
        }
        CHECK(!stream.is_open());
    }
}

TEST(PieceStream, RefusesAnEndThatIsNotClamped)
{
    PieceStream stream;
    stream.open(KnotSource::kExplicit, 3, {{0, 0, 0}, 1});
    CHECK(static_cast<bool>(stream.add_knot(0)));
    for (int i = 1; i < 4; ++i) {
        stream.add_point({{i * 1000000, i * i * 1000000, 0}, 1});
        CHECK(static_cast<bool>(stream.add_knot(i == 3 ? 1 : 0)));
    }
    CHECK(static_cast<bool>(stream.add_knot(2)));
    CHECK(!stream.accepts_points());
    CHECK(Error::kGcodeInvalidTarget == stream.add_knot(3).error());
    CHECK(!stream.is_open());
}
