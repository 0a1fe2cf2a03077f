// Seven places of a cell: three have rows, four tell what those do not see.
#include "firmware/planner/station_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::planner {
namespace {

constexpr unsigned kPlaces = 7;
constexpr unsigned kRowEach = (kPlaces - 1) / (kPlacesOfCell - 1);  // every third has rows
// Part of what the path leaves the chord of two rows by that is kept of the limits.
constexpr float kKeptAcceleration = 0.3F;
constexpr float kKeptJerk = 0.1F;
constexpr float kReach = 1.1F;                // of the filters' window in travel
constexpr float kElementAcceleration = 0.8F;  // of what the axes allow
constexpr unsigned kElementBlocks = 16;       // that it may span
constexpr float kMostAlways = 0.5F;           // of the jerk
constexpr unsigned kShortenings = 30;
constexpr float kShorter = 0.8F;
constexpr float kFeltJoint = 0.01F;      // share of the jerk
constexpr unsigned kElementPlaces = 40;  // of an element that are judged, closer near rest
constexpr float kNearerRest = 0.9F;      // from one to the next
constexpr unsigned kReachTicks = 3;      // on top of it

// Greatest |f| between three places: a parabola exceeds them by an eighth of their second difference.
LaneVec largest_near(const LaneVec& a, const LaneVec& m, const LaneVec& b) noexcept
{
    return larger(larger(magnitude(a), magnitude(m)), magnitude(b)) +
           magnitude(a - m * 2.0F + b) * 0.125F;
}

using CellPlaces = std::array<LaneDerivatives, kPlaces>;

// By how much the derivatives leave the chord of both ends.
struct Kinks {
    LaneVec second;
    LaneVec third;
};

Kinks kinks_of(const CellPlaces& q) noexcept
{
    Kinks kinks{all_lanes(0.0F), all_lanes(0.0F)};
    for (unsigned i = 1; i + 1 < kPlaces; ++i) {
        const float part = static_cast<float>(i) / (kPlaces - 1);
        const auto left = [part](const LaneVec& a, const LaneVec& m, const LaneVec& b) {
            return magnitude(m - (a * (1.0F - part) + b * part));
        };
        kinks.second = larger(kinks.second, left(q[0].second, q[i].second, q[kPlaces - 1].second));
        kinks.third = larger(kinks.third, left(q[0].third, q[i].third, q[kPlaces - 1].third));
    }
    return kinks;
}

}  // namespace

void StationMaker::set_limits(const MachineLimits& limits) noexcept
{
    limits_ = limits;
    const LaneVec one = all_lanes(1.0F);
    inverse_jerk_ = quotient(one, to_lanes(limits.jerk));
    inverse_acceleration_ = quotient(one, to_lanes(limits.acceleration));
}

LawJoint StationMaker::joint(const LawPath& path, const PathCursor& before) const noexcept
{
    const Block& last = *path[before.block].block;
    const Block& next = *path[before.block + 1].block;
    const LaneDerivatives a =
        derivatives_at(last, static_cast<float>(last.length) / kPathUnitsPerMillimetre);
    const LaneDerivatives b = derivatives_at(next, 0.0F);
    const float first = static_cast<float>(last.filter.first) * kServoTick;
    const float second = static_cast<float>(last.filter.second) * kServoTick;
    const LaneVec bend = magnitude(b.second - a.second) / first;
    const LaneVec turn = magnitude(b.first - a.first) / first;
    const std::int64_t at = before.begin + last.length;
    // The greatest acceleration along the path that the axes allow on both sides.
    const LaneVec along = larger(larger(magnitude(a.first), magnitude(b.first)), all_lanes(1e-9F));
    const float acceleration = least(kUnlimited, quotient(to_lanes(limits_.acceleration), along));
    const LaneVec always = product(turn, inverse_jerk_) * acceleration;
    return {at,
            at,
            smaller(always, all_lanes(kMostAlways)),
            product(bend, inverse_jerk_),
            product(turn, inverse_jerk_) / second,
            product(turn, inverse_acceleration_),
            product(magnitude(b.third - a.third), inverse_jerk_),
            first + second};
}

Station StationMaker::make(const LawPath& path,
                           PathCursor& cursor,
                           std::int64_t from,
                           std::int64_t to,
                           Span<const LawJoint> joints,
                           float speed) const noexcept
{
    Station station{};
    station.begin = from;
    station.travel = static_cast<std::uint32_t>(to - from);
    station.length = to_mm(to - from);
    CellPlaces q;
    float cap = kUnlimited;
    for (unsigned i = 0; i < kPlaces; ++i) {
        const std::int64_t at = from + (to - from) * i / (kPlaces - 1);
        path.seek(cursor, at, i + 1 == kPlaces);
        q[i] = path.derivatives(cursor, at);
        const LawBlock& block = path[cursor.block];
        const float bend = std::max(norm(q[i].second), 1e-20F);
        cap = std::min(cap, std::min(block.feed, block.centripetal / bend));
    }
    LaneVec first = all_lanes(1e-9F);
    for (unsigned i = 1; i < kPlaces; i += 2) {
        first = larger(first, largest_near(q[i - 1].first, q[i].first, q[i + 1].first));
    }
    const LaneVec ratio = quotient(to_lanes(limits_.velocity), first);
    station.cap = least(cap, product(ratio, ratio));
    station.kept = kept_at(station, joints, speed);
    const Kinks kinks = kinks_of(q);
    station.kept.bend_acceleration =
        product(kinks.second, inverse_acceleration_) * kKeptAcceleration;
    station.kept.bend = product(kinks.third, inverse_jerk_) * kKeptJerk;
    for (const LawJoint& joint : joints) {
        station.acceleration_at_end =
            station.acceleration_at_end || (joint.at <= to && joint.at > from);
    }
    Vec3f moving{};
    const Vec3f used = to_vec(first);
    const Vec3f turned = to_vec(station.kept.turn);
    for (unsigned i = 0; i < 3; ++i) {
        moving[i] = used[i] > 1e-6F || turned[i] > 0 ? 1.0F : 0.0F;
    }
    station.moving = to_lanes(moving);
    for (unsigned i = 0; i < kPlacesOfCell; ++i) {
        const LaneDerivatives& place = q[i * kRowEach];
        station.places[i] = {product(place.first, inverse_jerk_),
                             product(place.second, inverse_jerk_),
                             product(place.third, inverse_jerk_)};
    }
    return station;
}

// The shares of joints within reach of the filters; none for bends.
KeptShares StationMaker::kept_at(const Station& station,
                                 Span<const LawJoint> joints,
                                 float speed) const noexcept
{
    const LaneVec none = all_lanes(0.0F);
    KeptShares kept{none, none, none, none, none, none};
    const std::int64_t to = station.begin + station.travel;
    for (const LawJoint& joint : joints) {
        const float window = joint.window + static_cast<float>(kReachTicks) * kServoTick;
        const float reach = kReach * speed * window + station.length;
        if (distance(to, joint.first) > reach || distance(joint.at, station.begin) > reach) {
            continue;
        }
        kept.always = smaller(kept.always + joint.always, all_lanes(kMostAlways));
        kept.jump = kept.jump + joint.jump;
        kept.turn = kept.turn + joint.turn;
        kept.turn_acceleration = kept.turn_acceleration + joint.turn_acceleration;
    }
    return kept;
}

// The longest element from rest at an end of the stretch that the filters do not let feel a joint,
// mm, at most `most`; its jerk is at most `jerk`, along the path.
float StationMaker::smooth_length(const LawPath& path,
                                  PathCursor cursor,
                                  std::int64_t rest,
                                  bool at_end,
                                  float jerk,
                                  float most) const noexcept
{
    const auto speed_at = [jerk](float s) {
        return cube_root(4.5F * jerk * s * s);
    };
    const float speed = speed_at(most);
    const std::int64_t beyond =
        at_end ? cursor.begin + path[cursor.block].block->length - rest : rest - cursor.begin;
    float length = -to_mm(beyond);
    for (unsigned i = 0; i < kElementBlocks; ++i) {
        const Block& block = *path[cursor.block].block;
        length += to_mm(block.length);
        const bool is_last =
            at_end ? cursor.block == path.begin().block : cursor.block + 1 == path.end();
        const float window =
            kReach * static_cast<float>(block.filter.first + block.filter.second + kReachTicks) *
            kServoTick;
        if (length > most + speed * window || is_last) {
            return std::min(length, most);
        }
        const PathCursor before{at_end ? cursor.block - 1 : cursor.block, 0};
        const LawJoint between = joint(path, before);
        if (greatest(0.0F, between.always + between.turn * speed + between.jump * (speed * speed)) >
            kFeltJoint) {
            float d = std::min(length, most);
            for (unsigned k = 0; k < kShortenings && d + speed_at(d) * window > length; ++k) {
                d *= kShorter;
            }
            return d;
        }
        cursor.block = at_end ? cursor.block - 1 : cursor.block + 1;
    }
    return std::min(length, most);
}

StopElement StationMaker::element(const LawPath& path,
                                  PathCursor cursor,
                                  std::int64_t rest,
                                  bool at_end,
                                  const StopChoice& choice,
                                  float most) const noexcept
{
    const auto at = [&](float s) {
        const auto units = static_cast<std::int64_t>(s * kPathUnitsPerMillimetre);
        const std::int64_t place = rest + (at_end ? -units : units);
        path.seek(cursor, place, at_end);
        return path.derivatives(cursor, place);
    };
    const LaneVec along = larger(magnitude(at(0.0F).first), all_lanes(1e-9F));
    const auto along_path = [&along](const Vec3f& limit) {
        return least(kUnlimited, quotient(to_lanes(limit), along));
    };
    float jerk = choice.share * along_path(limits_.jerk);
    const float acceleration = along_path(limits_.acceleration);
    const float speed = std::min(along_path(limits_.velocity), std::sqrt(path[cursor.block].feed));
    const float time = std::min(
        choice.time, std::min(kElementAcceleration * acceleration / jerk, std::sqrt(speed / jerk)));
    const float wanted = jerk * time * time * time * (1.0F / 6.0F);
    const float d = smooth_length(path, cursor, rest, at_end, jerk,
                                  std::min(std::min(wanted, kLongestElement), most));
    // A whole number of path units.
    StopElement element{
        std::max(std::floor(d * kPathUnitsPerMillimetre), 1.0F) / kPathUnitsPerMillimetre, 0.0F};
    // s from rest: v^3 = 9/2 w s^2, v u = 3 w s, u^3 = 6 w^2 s.
    float s = element.length;
    for (unsigned i = 0; i < kElementPlaces; ++i, s *= kNearerRest) {
        LaneDerivatives q = at(s);
        q.second = q.second * (at_end ? -1.0F : 1.0F);
        const LaneVec by_jerk =
            larger(magnitude(q.first + q.second * (9.0F * s) + q.third * (4.5F * s * s)),
                   all_lanes(1e-9F));
        jerk = std::min(
            jerk, choice.share * least(kUnlimited, quotient(to_lanes(limits_.jerk), by_jerk)));
        const float speed_root = cube_root(4.5F * s * s);
        const LaneVec by_acceleration =
            larger(magnitude(q.first * cube_root(6.0F * s) + q.second * (speed_root * speed_root)),
                   all_lanes(1e-9F));
        const float root =
            std::sqrt(least(1e12F, quotient(to_lanes(limits_.acceleration), by_acceleration)));
        jerk = std::min(jerk, root * root * root);
    }
    const float root = cube_root(4.5F * jerk * element.length * element.length);
    element.cap = root * root;
    return element;
}

}  // namespace cusp::planner
