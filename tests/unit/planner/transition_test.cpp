// Transitions between lines and arcs: within the deviation, and continuous with what they join.
#include "firmware/planner/transition.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/planner/quintic.hpp"

using namespace cusp;

namespace {

constexpr double kDeviation = 0.0045;

struct Meeting {
    path::Move before;
    path::Move after;
};

path::Move move_from(Position start)
{
    path::Move move;
    move.start = start;
    move.feed = 500;
    move.tolerance = 0.01F;
    return move;
}

// An arc or helix that leaves `start` along the unit vector `v`, towards the unit vector `side`.
path::Move arc_from(
    Position start, AxisVecd v, AxisVecd side, double radius, double sweep, double rise)
{
    path::Move move = move_from(start);
    path::Arc arc{};
    arc.centre = side * radius;
    arc.u = -side;
    arc.v = v;
    arc.axial = cross(xyz(v), xyz(side)) * rise;
    arc.radius = radius;
    arc.sweep = sweep;
    move.path = arc;
    move.end = start + to_position(arc.centre + arc.u * (radius * std::cos(sweep)) +
                                   arc.v * (radius * std::sin(sweep)) + arc.axial);
    return move;
}

AxisVecd point_of(const path::Move& move, double t)
{
    const AxisVecd start = to_millimetres(move.start);
    const AxisVecd chord = to_millimetres(move.end) - start;
    if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        return start + arc->centre + arc->u * (arc->radius * std::cos(t * arc->sweep)) +
               arc->v * (arc->radius * std::sin(t * arc->sweep)) + arc->axial * t;
    }
    if (const auto* quintic = std::get_if<path::Quintic>(&move.path)) {
        const planner::LaneQuintic lanes = planner::lane_quintic(quintic->bulge, to_float(chord));
        const AxisVecf at = to_vec(planner::point_at(lanes, static_cast<float>(t)));
        return start + AxisVecd{at.x, at.y, at.z};
    }
    return start + chord * t;
}

std::vector<AxisVecd> points_of(const path::Move& move, int count)
{
    std::vector<AxisVecd> points;
    for (int i = 0; i <= count; ++i) {
        points.push_back(point_of(move, static_cast<double>(i) / count));
    }
    return points;
}

double distance(AxisVecd p, const std::vector<AxisVecd>& points)
{
    double least = 1e9;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const AxisVecd along = points[i] - points[i - 1];
        const double t = std::clamp(dot(p - points[i - 1], along) / dot(along, along), 0.0, 1.0);
        least = std::min(least, norm(p - points[i - 1] - along * t));
    }
    return least;
}

// Line to arc, arc to line, or two arcs of any sense, with the kinks of rounded numbers.
Meeting random_joint(std::mt19937_64& random)
{
    std::uniform_real_distribution<double> part{0, 1};
    const double radius = 1 + 30 * part(random);
    const double sweep = 0.3 + 1.2 * part(random);
    const double rise = random() % 3 == 0 ? part(random) : 0.0;
    const double kink = random() % 2 == 0 ? 5e-4 * part(random) : 0.0;
    Meeting joint;
    AxisVecd tangent{1, 0, 0};
    if (random() % 2 == 0) {
        joint.before = move_from({});
        joint.before.end = {static_cast<std::int64_t>(1e6 + 2e7 * part(random)), 0, 0};
    } else {
        joint.before = arc_from({}, {1, 0, 0}, {0, 1, 0}, radius, sweep, rise);
        tangent = {std::cos(sweep), std::sin(sweep), rise / (radius * sweep)};
        tangent = tangent / norm(tangent);
    }
    tangent = tangent + AxisVecd{0, 0, kink};
    tangent = tangent / norm(tangent);
    if (std::holds_alternative<path::Arc>(joint.before.path) && random() % 2 == 0) {
        joint.after = move_from(joint.before.end);
        joint.after.end = joint.after.start + to_position(tangent * (1 + 20 * part(random)));
    } else {
        AxisVecd side = cross(Vec3d{0, 0, 1}, xyz(tangent));
        side = side / norm(side);
        const double turn = random() % 2 == 0 ? 1 : -1;
        joint.after = arc_from(joint.before.end, tangent, side * turn, 1 + 30 * part(random),
                               0.3 + 1.2 * part(random), 0);
    }
    return joint;
}

}  // namespace

TEST_GROUP(Transitions){};

TEST(Transitions, KeepToThePathAndMeetIt)
{
    std::mt19937_64 random{9101};
    unsigned made = 0;
    for (int k = 0; k < 300; ++k) {
        const Meeting joint = random_joint(random);
        path::Move before = joint.before;
        path::Move after = joint.after;
        path::Move piece;
        if (!planner::make_transition(before, after, piece, {}, 0.004F, kDeviation)) {
            CHECK(before.end == joint.before.end && after.start == joint.after.start);
            continue;
        }
        ++made;
        const std::string which = "joint " + std::to_string(k);
        CHECK(before.end == piece.start && piece.end == after.start);
        CHECK(after.end == joint.after.end);
        // The rest lies where it was.
        DOUBLES_EQUAL(0, norm(point_of(before, 1) - to_millimetres(before.end)), 2e-6);
        DOUBLES_EQUAL(0, norm(point_of(after, 0) - to_millimetres(after.start)), 2e-6);
        DOUBLES_EQUAL(0, norm(point_of(after, 1) - to_millimetres(after.end)), 3e-6);
        std::vector<AxisVecd> path = points_of(joint.before, 1000);
        for (const AxisVecd& place : points_of(joint.after, 1000)) {
            path.push_back(place + (place == path.back() ? AxisVecd{1e-9, 0, 0} : AxisVecd{}));
        }
        for (const AxisVecd& place : points_of(piece, 50)) {
            CHECK_TEXT(distance(place, path) <= kDeviation + 2e-5, which.c_str());
        }
        // Direction and curvature of both sides, by differences of 0.01 mm.
        const auto& quintic = std::get<path::Quintic>(piece.path);
        const double step = 0.01;
        const double dt = step / static_cast<double>(quintic.length);
        const double of_before = step / path::length(before);
        const double of_after = step / path::length(after);
        const AxisVecd at_start =
            point_of(piece, dt) - point_of(before, 1) * 2.0 + point_of(before, 1 - of_before);
        const AxisVecd at_end =
            point_of(piece, 1 - dt) - point_of(after, 0) * 2.0 + point_of(after, of_after);
        const auto bend = [](const path::Move& move) {
            const auto* arc = std::get_if<path::Arc>(&move.path);
            if (arc == nullptr) {
                return 0.0;
            }
            const double rise = norm(arc->axial) / arc->sweep;
            return arc->radius / (arc->radius * arc->radius + rise * rise);
        };
        // Float leaves 1e-7 mm of a second difference.
        DOUBLES_EQUAL(bend(before), norm(at_start) / (step * step), 0.02 + 0.05 * bend(before));
        DOUBLES_EQUAL(bend(after), norm(at_end) / (step * step), 0.02 + 0.05 * bend(after));
    }
    CHECK_TEXT(made > 150, std::to_string(made).c_str());
}

TEST(Transitions, AreNotMadeWhereTheFeedIsLower)
{
    path::Move before = move_from({});
    before.end = {20'000'000, 0, 0};
    path::Move after = arc_from(before.end, {1, 0, 0}, {0, 1, 0}, 10, 1.5, 0);
    before.feed = 20;
    after.feed = 20;
    path::Move piece;
    CHECK(!planner::make_transition(before, after, piece, {}, 0.010F, kDeviation));
    before.feed = 100;
    after.feed = 100;
    CHECK(planner::make_transition(before, after, piece, {}, 0.010F, kDeviation));
    CHECK(piece.feed < 100 && piece.feed > 99.7F);
}

TEST(Transitions, TakeFrontLeavesTheRest)
{
    const path::Move whole = arc_from({}, {1, 0, 0}, {0, 1, 0}, 10, 1.5, 2);
    path::Move rest = whole;
    const path::Move front = planner::take_front(rest, 5);
    CHECK(front.start == whole.start && front.end == rest.start && rest.end == whole.end);
    DOUBLES_EQUAL(path::length(whole), path::length(front) + path::length(rest), 1e-9);
    DOUBLES_EQUAL(0, norm(point_of(rest, 0.5) - point_of(whole, 0.5 + 2.5 / path::length(whole))),
                  2e-6);
}
