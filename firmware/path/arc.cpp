// Arcs from centre offsets or a radius, and the length of a move.
#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/base/math.hpp"
#include "firmware/path/move.hpp"

namespace cusp::path {
namespace {

// The axes of a plane: first and second span it, right-handed; normal is square to both.
struct PlaneAxes {
    unsigned first;
    unsigned second;
    unsigned normal;
};

constexpr PlaneAxes axes_of(Plane plane) noexcept
{
    switch (plane) {
        case Plane::kZX:
            return {2, 0, 1};
        case Plane::kYZ:
            return {1, 2, 0};
        case Plane::kXY:
            break;
    }
    return {0, 1, 2};
}

// LinuxCNC's rule, 2 sqrt(2) of the last digit of 2 decimals in millimetres and 3 in inches: such a
// difference is accepted whatever the radius; 100 of them are refused whatever the radius.
constexpr double kRadiusTolerance = 0.028284271247461903;        // mm
constexpr double kRadiusToleranceOfInches = 0.0718420489685532;  // mm
constexpr double kRefusedTolerances = 100;
constexpr double kChordTolerance = 0.005;  // mm: of the diameter that a radius word gives
constexpr double kRadiusDifferenceRatio = 0.001;

double millimetres(std::int64_t nm) noexcept
{
    return static_cast<double>(nm) / kNanometresPerMillimetre;
}

bool radii_agree(double start, double end, bool inches) noexcept
{
    const double difference = std::fabs(end - start);
    const double tolerance = inches ? kRadiusToleranceOfInches : kRadiusTolerance;
    return difference <= tolerance || (difference <= kRefusedTolerances * tolerance &&
                                       difference <= kRadiusDifferenceRatio * std::max(start, end));
}

// Angle from the start radius to the end radius in the sense of motion: in (0, 2 pi], the full turn
// where they point the same way exactly.
double sweep_between(double x0, double y0, double x1, double y1, bool clockwise) noexcept
{
    const double across = x0 * y1 - y0 * x1;
    const double along = x0 * x1 + y0 * y1;
    const double angle = atan2(clockwise ? -across : across, along);
    return angle > 0 ? angle : angle + 2 * kPi;
}

// A control point times its weight, and the weight.
struct Homogeneous {
    AxisVecd point;
    double weight;
};

double speed_at(const BezierPiece& piece, double t) noexcept
{
    const unsigned degree = piece.order - 1U;
    std::array<Homogeneous, kMaxOrder> net{};
    for (unsigned i = 0; i <= degree; ++i) {
        const double w = static_cast<double>(piece.weights[i]);
        const AxisVecf p = piece.points[i];
        net[i] = {to_double(p) * w, w};
    }
    for (unsigned level = degree; level > 1; --level) {
        for (unsigned i = 0; i < level; ++i) {
            net[i].point = net[i].point * (1 - t) + net[i + 1].point * t;
            net[i].weight = net[i].weight * (1 - t) + net[i + 1].weight * t;
        }
    }
    const double weight = net[0].weight * (1 - t) + net[1].weight * t;
    const AxisVecd a = net[0].point / net[0].weight;
    const AxisVecd b = net[1].point / net[1].weight;
    // dP/dt = p w0 w1 / w^2 (P1 - P0) of the last two points of de Casteljau's scheme.
    return degree * net[0].weight * net[1].weight / (weight * weight) * norm(b - a);
}

// The integral of f over [0, 1] by Gauss and Legendre's rule of 5 points on each of `intervals`.
template <class Function>
double integral(unsigned intervals, const Function& f) noexcept
{
    constexpr double kInner = 0.538469310105683091036314;
    constexpr double kOuter = 0.906179845938663992797627;
    constexpr std::array<double, 5> kNode = {-kOuter, -kInner, 0, kInner, kOuter};
    constexpr double kInnerWeight = 0.478628670499366468041292;
    constexpr double kOuterWeight = 0.236926885056189087514264;
    constexpr std::array<double, 5> kWeight = {
        kOuterWeight, kInnerWeight, 0.568888888888888888888889, kInnerWeight, kOuterWeight};
    double sum = 0;
    for (unsigned i = 0; i < intervals; ++i) {
        for (unsigned k = 0; k < kNode.size(); ++k) {
            sum += kWeight[k] * f((i + 0.5 + 0.5 * kNode[k]) / intervals);
        }
    }
    return sum / (2 * intervals);
}

double bezier_length(const BezierPiece& piece) noexcept
{
    constexpr unsigned kIntervals = 64;
    return integral(kIntervals, [&piece](double t) { return speed_at(piece, t); });
}

double arc_length(const Arc& arc) noexcept
{
    const double constant = arc.radius_change * arc.radius_change + dot(arc.axial, arc.axial);
    const auto speed = [&arc, constant](double t) {
        const double turning = arc.sweep * (arc.radius + t * arc.radius_change);
        return std::sqrt(constant + turning * turning);
    };
    if (arc.radius_change == 0) {
        return speed(0);
    }
    // The radius changes by 0.1 %, or by 0.03 mm, in inches 0.07 mm, on a small arc.
    constexpr unsigned kIntervals = 8;
    return integral(kIntervals, speed);
}

}  // namespace

Result<Arc> make_arc(const ArcWords& words) noexcept
{
    const PlaneAxes axes = axes_of(words.plane);
    const Position travel = words.end - words.start;
    const double x0 = -millimetres(words.first_offset_nm);
    const double y0 = -millimetres(words.second_offset_nm);
    const double x1 = millimetres(travel[axes.first] - words.first_offset_nm);
    const double y1 = millimetres(travel[axes.second] - words.second_offset_nm);
    const double radius = std::sqrt(x0 * x0 + y0 * y0);
    const double end_radius = std::sqrt(x1 * x1 + y1 * y1);
    if (words.turns < 1 || radius <= 0 || end_radius <= 0 ||
        !radii_agree(radius, end_radius, words.inches)) {
        return Error::kGcodeInvalidTarget;
    }
    const double turn = words.clockwise ? -1.0 : 1.0;
    Arc arc{};
    arc.centre[axes.first] = -x0;
    arc.centre[axes.second] = -y0;
    arc.u[axes.first] = x0 / radius;
    arc.u[axes.second] = y0 / radius;
    arc.v[axes.first] = -turn * arc.u[axes.second];
    arc.v[axes.second] = turn * arc.u[axes.first];
    arc.axial[axes.normal] = millimetres(travel[axes.normal]);
    for (unsigned axis = kLinearAxes; axis < kAxisCount; ++axis) {
        arc.axial[axis] = millimetres(travel[axis]);
    }
    arc.radius = radius;
    arc.radius_change = end_radius - radius;
    const bool same = travel[axes.first] == 0 && travel[axes.second] == 0;
    arc.sweep = same ? 2 * kPi : sweep_between(x0, y0, x1, y1, words.clockwise);
    arc.sweep += 2 * kPi * (words.turns - 1);
    return arc;
}

Result<ArcWords> with_radius(ArcWords words, std::int64_t radius_nm) noexcept
{
    const PlaneAxes axes = axes_of(words.plane);
    const Position travel = words.end - words.start;
    const double dx = static_cast<double>(travel[axes.first]);
    const double dy = static_cast<double>(travel[axes.second]);
    const double chord = std::sqrt(dx * dx + dy * dy);
    if (chord <= 0) {
        return Error::kGcodeInvalidTarget;
    }
    const double radius = std::fabs(static_cast<double>(radius_nm));
    constexpr double kFreeNm = kChordTolerance * kNanometresPerMillimetre;
    if (radius + kFreeNm < 0.5 * chord) {
        return Error::kGcodeArcRadiusError;
    }
    // Height of the centre over the chord, as a fraction of the chord. (r - c/2)(r + c/2) keeps its
    // digits where the arc is nearly a half turn.
    const double height =
        std::sqrt(std::max(0.0, (radius - 0.5 * chord) * (radius + 0.5 * chord))) / chord;
    const bool left = words.clockwise == (radius_nm < 0);
    const double side = left ? height : -height;
    const auto rounded = [](double nm) {
        return static_cast<std::int64_t>(std::floor(nm + 0.5));
    };
    words.first_offset_nm = rounded(0.5 * dx - side * dy);
    words.second_offset_nm = rounded(0.5 * dy + side * dx);
    return words;
}

double fed_length(const Move& move) noexcept
{
    if constexpr (kHasRotaryAxis) {
        Move linear = move;
        linear.end[kLinearAxes] = move.start[kLinearAxes];
        if (auto* arc = std::get_if<Arc>(&linear.path)) {
            arc->axial[kLinearAxes] = 0;
        }
        const double part = length(linear);
        return part > 0 ? part : length(move);
    }
    return length(move);
}

double length(const Move& move) noexcept
{
    if (const auto* arc = std::get_if<Arc>(&move.path)) {
        return arc_length(*arc);
    }
    if (const auto* piece = std::get_if<BezierPiece>(&move.path)) {
        return bezier_length(*piece);
    }
    if (const auto* quintic = std::get_if<Quintic>(&move.path)) {
        return static_cast<double>(quintic->length);
    }
    return norm(to_millimetres(move.end - move.start));
}

}  // namespace cusp::path
