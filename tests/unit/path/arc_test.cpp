// Arcs against long double, and the refusals of Grbl.
#include <cmath>
#include <random>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "firmware/path/move.hpp"

namespace {

using namespace cusp;
using namespace cusp::path;

constexpr std::int64_t kMm = 1000000;
constexpr unsigned kSeed = 7;

AxisVecd point_at(const Arc& arc, double t)
{
    const auto [sine, cosine] = sin_cos(t * arc.sweep);
    return arc.centre + (arc.radius + t * arc.radius_change) * (cosine * arc.u + sine * arc.v) +
           t * arc.axial;
}

ArcWords quarter(Plane plane, bool clockwise)
{
    // From 10 along the plane's first axis to 10 along its second, about the origin.
    constexpr unsigned kFirst[] = {0, 2, 1};
    constexpr unsigned kSecond[] = {1, 0, 2};
    ArcWords words{};
    words.plane = plane;
    words.clockwise = clockwise;
    words.start[kFirst[static_cast<unsigned>(plane)]] = 10 * kMm;
    words.end[kSecond[static_cast<unsigned>(plane)]] = 10 * kMm;
    words.first_offset_nm = -10 * kMm;
    words.turns = 1;
    return words;
}

}  // namespace

TEST_GROUP(Arc) { std::mt19937_64 random{kSeed}; };

TEST(Arc, EndsAtItsEndInEveryPlaneAndSense)
{
    for (const Plane plane : {Plane::kXY, Plane::kZX, Plane::kYZ}) {
        for (const bool clockwise : {false, true}) {
            const ArcWords words = quarter(plane, clockwise);
            const Result<Arc> arc = make_arc(words);
            CHECK(static_cast<bool>(arc));
            DOUBLES_EQUAL((clockwise ? 1.5 : 0.5) * kPi, arc->sweep, 1e-14);
            const AxisVecd off = point_at(*arc, 1) - to_millimetres(words.end - words.start);
            DOUBLES_EQUAL(0, norm(off), 1e-13);
        }
    }
}

TEST(Arc, IsAFullCircleWhereStartAndEndAgree)
{
    ArcWords words = quarter(Plane::kXY, true);
    words.end = words.start;
    DOUBLES_EQUAL(2 * kPi, make_arc(words)->sweep, 1e-15);
}

TEST(Arc, AddsWholeTurns)
{
    ArcWords words = quarter(Plane::kXY, false);
    words.turns = 3;
    words.end.z = 5 * kMm;
    const Result<Arc> arc = make_arc(words);
    DOUBLES_EQUAL(4.5 * kPi, arc->sweep, 1e-14);
    DOUBLES_EQUAL(5, arc->axial.z, 0);
}

TEST(Arc, RefusesRadiiThatDiffer)
{
    ArcWords words = quarter(Plane::kXY, false);
    const auto refused = [&words](std::int64_t by) {
        ArcWords off = words;
        off.end.y += by;
        const Result<Arc> arc = make_arc(off);
        return !arc && arc.error() == Error::kGcodeInvalidTarget;
    };
    // The limits of LinuxCNC's rs274, found by halving.
    CHECK(!refused(28280) && !refused(-28280));
    CHECK(refused(28290) && refused(-28290));
    words.inches = true;
    CHECK(!refused(71840) && !refused(-71840));
    CHECK(refused(71850) && refused(-71850));
    // 0.1 % of the greater radius, and 100 times as much as on a small one.
    words = {{1000 * kMm, 0, 0}, {0, 1000 * kMm, 0}, Plane::kXY, false, -1000 * kMm, 0, 1};
    CHECK(!refused(1'000'500) && !refused(-999'900));
    CHECK(refused(1'001'500) && refused(-1'000'500));
    words = {{5000 * kMm, 0, 0}, {0, 5000 * kMm, 0}, Plane::kXY, false, -5000 * kMm, 0, 1};
    CHECK(!refused(2'828'000) && !refused(-2'828'000));
    CHECK(refused(2'829'000) && refused(-2'829'000));
}

TEST(Arc, OfARadiusPassesThroughItsEndAndTurnsTheRightWay)
{
    std::uniform_int_distribution<std::int64_t> coordinate{-50 * kMm, 50 * kMm};
    std::uniform_real_distribution<double> ratio{0.5, 20};
    for (int i = 0; i < 20000; ++i) {
        ArcWords words{};
        words.start = {coordinate(random), coordinate(random), 0};
        words.end = {coordinate(random), coordinate(random), 0};
        words.clockwise = i % 2 == 0;
        words.turns = 1;
        const double chord = norm(to_millimetres(words.end - words.start));
        const std::int64_t radius = to_nanometres(chord * ratio(random)) + 1;
        const bool longer = i % 4 < 2;
        const Result<ArcWords> centred = with_radius(words, longer ? -radius : radius);
        CHECK(static_cast<bool>(centred));
        const Result<Arc> arc = make_arc(*centred);
        CHECK(static_cast<bool>(arc));
        CHECK(longer ? arc->sweep >= kPi - 1e-3 : arc->sweep <= kPi + 1e-3);
        const AxisVecd off = point_at(*arc, 1) - to_millimetres(words.end - words.start);
        DOUBLES_EQUAL(0, norm(off), 1e-10);
        DOUBLES_EQUAL(static_cast<double>(radius) / kMm, arc->radius, 0.0052);
    }
}

TEST(Arc, OfARadiusBelowHalfTheChordIsRefused)
{
    ArcWords words{};
    words.end = {10 * kMm, 0, 0};
    words.turns = 1;
    CHECK(static_cast<bool>(with_radius(words, 4996000)));
    CHECK(Error::kGcodeArcRadiusError == with_radius(words, 4990000).error());
    words.end = {};
    CHECK(Error::kGcodeInvalidTarget == with_radius(words, 10 * kMm).error());
}

TEST(Arc, SweepAgreesWithLongDouble)
{
    std::uniform_real_distribution<double> angles{0, 2 * kPi};
    for (int i = 0; i < 20000; ++i) {
        const double from = angles(random);
        const double to = angles(random);
        constexpr double kRadius = 20 * 1e6;
        ArcWords words{};
        words.turns = 1;
        words.start = {std::llround(kRadius * std::cos(from)),
                       std::llround(kRadius * std::sin(from)), 0};
        words.end = {std::llround(kRadius * std::cos(to)), std::llround(kRadius * std::sin(to)), 0};
        words.first_offset_nm = -words.start.x;
        words.second_offset_nm = -words.start.y;
        const long double a = atan2l(static_cast<long double>(words.start.y),
                                     static_cast<long double>(words.start.x));
        const long double b =
            atan2l(static_cast<long double>(words.end.y), static_cast<long double>(words.end.x));
        const long double sweep = b > a ? b - a : b - a + 2 * acosl(-1.0L);
        DOUBLES_EQUAL(static_cast<double>(sweep), make_arc(words)->sweep, 1e-14);
    }
}

TEST_GROUP(MoveLength){};

TEST(MoveLength, OfALineAndAHelixIsClosed)
{
    Move move;
    move.end = {3 * kMm, 4 * kMm, 0};
    DOUBLES_EQUAL(5, length(move), 1e-12);
    ArcWords words = quarter(Plane::kXY, false);
    words.end.z = 5 * kMm;
    move.path = *make_arc(words);
    DOUBLES_EQUAL(std::hypot(5 * kPi, 5), length(move), 1e-12);
}

TEST(MoveLength, OfAnArcWithAGrowingRadiusAgreesWithLongDouble)
{
    ArcWords words = quarter(Plane::kXY, false);
    words.start = {4000, 0, 0};
    words.end = {0, 8000, 0};
    words.first_offset_nm = -4000;
    Move move;
    const Arc arc = *make_arc(words);
    move.path = arc;
    long double sum = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
        const long double t = (i + 0.5L) / kSteps;
        const long double turning = arc.sweep * (arc.radius + t * arc.radius_change);
        sum += sqrtl(turning * turning +
                     static_cast<long double>(arc.radius_change) * arc.radius_change);
    }
    DOUBLES_EQUAL(1, length(move) / static_cast<double>(sum / kSteps), 1e-9);
}

TEST(MoveLength, OfARationalQuarterCircleIsThatOfTheCircle)
{
    BezierPiece piece{};
    piece.order = 3;
    piece.points[1] = {0, 10, 0};
    piece.points[2] = {-10, 10, 0};
    piece.weights[0] = 1;
    piece.weights[1] = 0.70710678F;
    piece.weights[2] = 1;
    Move move;
    move.path = piece;
    DOUBLES_EQUAL(5 * kPi, length(move), 1e-6 * 5 * kPi);
}
