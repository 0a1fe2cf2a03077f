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
constexpr float kEvenedOut = 2.0F;            // of the third derivative at the rows beside a peak
constexpr float kElementAcceleration = 0.8F;  // of what the axes allow
constexpr unsigned kElementBlocks = 16;       // that it may span
constexpr float kMostAlways = 0.5F;           // of the jerk
constexpr float kReachTime = static_cast<float>(kReachTicks) * kServoTick;
constexpr unsigned kShortenings = 30;
constexpr float kShorter = 0.8F;
constexpr float kFeltJoint = 0.01F;      // share of the jerk
constexpr unsigned kElementPlaces = 40;  // of an element that are judged, closer near rest
constexpr float kNearerRest = 0.9F;      // from one to the next
constexpr float kDipOfJerk = 0.5F;       // twice the quarter: the jerk along the path may be more

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

// By how much the third derivative between two rows exceeds what the axis filters even out of a peak so
// short. A turn of a micrometre may lie between rows.
LaneVec hidden_peak(const CellPlaces& q) noexcept
{
    LaneVec peak = all_lanes(0.0F);
    for (unsigned i = 0; i + 1 < kPlaces; i += kRowEach) {
        const LaneVec rows = larger(magnitude(q[i].third), magnitude(q[i + kRowEach].third));
        const LaneVec between = larger(magnitude(q[i + 1].third), magnitude(q[i + 2].third));
        peak = larger(peak, between - rows * kEvenedOut);
    }
    return peak;
}

}  // namespace

void StationMaker::set_limits(const MachineLimits& limits) noexcept
{
    limits_ = limits;
    const LaneVec one = all_lanes(1.0F);
    inverse_jerk_ = quotient(one, to_lanes(limits.jerk));
    inverse_acceleration_ = quotient(one, to_lanes(limits.acceleration));
    greatest_jerk_ = greatest(0.0F, to_lanes(limits.jerk));
    greatest_acceleration_ = greatest(0.0F, to_lanes(limits.acceleration));
}

ReadJoint StationMaker::joint(const LawPath& path, const PathCursor& before) const noexcept
{
    const Block& last = *path[before.block].block;
    const Block& next = *path[before.block + 1].block;
    LaneDerivatives a =
        derivatives_at(last, static_cast<float>(last.length) / kPathUnitsPerMillimetre);
    const LaneDerivatives b = derivatives_at(next, 0.0F);
    const float speed = std::min(std::sqrt(path[before.block].feed), limits_.whole_velocity());
    if (is_within_half_tick(last, speed)) {
        const AxisVecf start = to_vec(derivatives_at(last, 0.0F).first);
        a.first = to_lanes(felt_end(last, start, to_vec(a.first)));
    }
    const float first = static_cast<float>(last.filter.first) * kServoTick;
    const float second = static_cast<float>(last.filter.second) * kServoTick;
    const LaneVec bend = (b.second - a.second) / first;
    const LaneVec turn = magnitude(b.first - a.first) / first;
    const std::int64_t at = before.begin + last.length;
    // The greatest acceleration along the path that the axes allow on both sides.
    const LaneVec along = larger(larger(magnitude(a.first), magnitude(b.first)), all_lanes(1e-9F));
    const float acceleration = least(kUnlimited, quotient(to_lanes(limits_.acceleration), along));
    const LaneVec always = product(turn, inverse_jerk_) * acceleration;
    const float turned = norm(b.first - a.first);
    const float beside = std::max(norm(a.second), norm(b.second));
    return {{at, at, smaller(always, all_lanes(kMostAlways)), product(bend, inverse_jerk_),
             all_lanes(0.0F), product(turn, inverse_jerk_) / second,
             product(turn, inverse_acceleration_), first + second,
             cap_of_turn(path[before.block], turned, beside), turned},
            product(magnitude(b.third - a.third), inverse_jerk_)};
}

// A turn dT is left by dT v/2 times the mean of |t| under the kernel, a bend by its centripetal
// acceleration times half the kernel's variance.
float StationMaker::cap_of_turn(const LawBlock& block, float turned, float bend) const noexcept
{
    const float first = static_cast<float>(block.block->filter.first) * kServoTick;
    const float second = static_cast<float>(block.block->filter.second) * kServoTick;
    const float square =
        (first * first + second * second - 2.0F * kServoTick * kServoTick) / 24.0F +
        0.5F * shaper_square_;
    const float deviation = block.centripetal * std::max(square, 1e-12F);
    const float half = 0.25F * turned * (0.25F * first + second / 12.0F + shaper_mean_time_);
    const float root = std::sqrt(half * half + bend * square * deviation);
    const float speed = deviation / std::max(half + root, 1e-9F);
    return speed * speed;
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
    path.seek(cursor, from);
    station.kind = path[cursor.block].block->kind;
    station.percent = path[cursor.block].percent;
    CellPlaces q;
    float cap = kUnlimited;
    for (unsigned i = 0; i < kPlaces; ++i) {
        const std::int64_t at = from + (to - from) * i / (kPlaces - 1);
        path.seek(cursor, at, i + 1 == kPlaces);
        q[i] = path.derivatives(cursor, at);
        const LawBlock block = path[cursor.block];
        const float bend = std::max(norm(q[i].second), 1e-20F);
        cap = std::min(cap, std::min(block.feed, block.centripetal / bend));
    }
    LaneVec first = all_lanes(1e-9F);
    for (unsigned i = 1; i < kPlaces; i += 2) {
        first = larger(first, largest_near(q[i - 1].first, q[i].first, q[i + 1].first));
    }
    const LaneVec ratio = quotient(to_lanes(limits_.velocity), first);
    station.cap = least(cap, product(ratio, ratio));
    feel_joints(station, joints, speed,
                static_cast<float>(path[cursor.block].block->filter.second) * kServoTick);
    const Kinks kinks = kinks_of(q);
    station.kept.bend_acceleration =
        product(kinks.second, inverse_acceleration_) * kKeptAcceleration;
    station.kept.bend = product(larger(kinks.third * kKeptJerk, hidden_peak(q)), inverse_jerk_);
    AxisVecf moving{};
    const AxisVecf used = to_vec(first);
    const AxisVecf turned = to_vec(station.kept.turn);
    for (unsigned i = 0; i < kAxisCount; ++i) {
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

// Caps and shares of a station by the joints around it.
void StationMaker::feel_joints(Station& station,
                               Span<const LawJoint> joints,
                               float speed,
                               float second) const noexcept
{
    const std::int64_t from = station.begin;
    const std::int64_t to = from + station.travel;
    for (const LawJoint& joint : joints) {
        const float reach = kReach * speed * (joint.window + shaper_length_) + station.length;
        if (distance(to, joint.first) < reach && distance(joint.at, from) < reach) {
            station.cap = std::min(station.cap, joint.cap);
        }
        station.acceleration_at_end =
            station.acceleration_at_end || (joint.at <= to && joint.at > from);
    }
    station.kept = kept_at(station, joints, speed, second);
    if (greatest(0.0F, station.kept.turn) > 0) {
        // As many turns act together as are counted.
        const float counted = way_of_joints(second, speed) / (kReach * (second + kReachTime));
        station.cap = std::min(station.cap, counted * counted);
    }
}

// The shares of joints within reach of the filters; none for bends.
KeptShares StationMaker::kept_at(const Station& station,
                                 Span<const LawJoint> joints,
                                 float speed,
                                 float second) const noexcept
{
    const LaneVec none = all_lanes(0.0F);
    KeptShares kept{none, none, none, none, none, none};
    JumpSums sums{none, none, none, none, 0.0F};
    StaticVector<const LawJoint*, kMostJoints> near;
    const std::int64_t to = station.begin + station.travel;
    for (const LawJoint& joint : joints) {
        const float reach = way_of_joints(joint.window, speed) + station.length;
        if (distance(to, joint.first) > reach || distance(joint.at, station.begin) > reach) {
            continue;
        }
        kept.always = smaller(kept.always + joint.always, all_lanes(kMostAlways));
        kept.jump = kept.jump + joint.loose;
        sums.run = sums.run + joint.jump;
        sums.high = larger(sums.high, sums.run);
        sums.low = smaller(sums.low, sums.run);
        sums.magnitudes = sums.magnitudes + magnitude(joint.jump);
        sums.window = std::max(sums.window, joint.window);
        (void)near.try_push_back(&joint);
    }
    keep_turns(kept, {near.begin(), near.size()}, speed, second);
    keep_jumps(kept, sums, speed);
    return kept;
}

float StationMaker::way_of_joints(float time, float speed) const noexcept
{
    const float window = time + kReachTime;
    return kReach * (speed + greatest_acceleration_ * window) * window;
}

// The filters' kernel has slopes at both its ends, as long as the second filter, and they alone make jerk of a
// turn; its whole length makes acceleration. No more turns act together than lie on such ways.
void StationMaker::keep_turns(KeptShares& kept,
                              Span<const LawJoint* const> joints,
                              float speed,
                              float second) const noexcept
{
    const LaneVec none = all_lanes(0.0F);
    LaneVec most_within = none;
    LaneVec most_on_slope = none;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        LaneVec on_slope = none;
        LaneVec within = none;
        LaneVec acceleration = none;
        const float slope = way_of_joints(second, speed);
        const float whole = way_of_joints(joints[i]->window, speed);
        for (std::size_t k = i + 1; k-- > 0;) {
            const float way = std::max(distance(joints[k]->at, joints[i]->first), 0.0F);
            if (way >= whole) {
                break;
            }
            on_slope = on_slope + (way < slope ? joints[k]->turn : none);
            within = within + joints[k]->turn;
            acceleration = acceleration + joints[k]->turn_acceleration;
        }
        most_on_slope = larger(most_on_slope, on_slope);
        most_within = larger(most_within, within);
        kept.turn_acceleration = larger(kept.turn_acceleration, acceleration);
    }
    kept.turn = kept.turn + smaller(most_within, most_on_slope * 2.0F);
}

// The axis filters weigh jumps by their kernel, which rises and falls once: their sum is at most the
// greatest net change over consecutive ones. A speed with a least value among them, v, makes two hills
// of it, by j T^2/(4 v) of the weight. Nor is it above the sum of magnitudes, which is less where v is low.
void StationMaker::keep_jumps(KeptShares& kept, const JumpSums& sums, float speed) const noexcept
{
    const float dip = kDipOfJerk * greatest_jerk_ * sums.window * sums.window;
    const AxisVecf net = to_vec(sums.high - sums.low);
    const AxisVecf magnitudes = to_vec(sums.magnitudes);
    AxisVecf jump{};
    AxisVecf turn{};
    for (unsigned i = 0; i < kAxisCount; ++i) {
        // Faster than by the sum of magnitudes alone it is not passed, whatever is expected.
        const float most = std::min(speed, 1.0F / std::sqrt(std::max(magnitudes[i], 1e-12F)));
        const bool cancels = net[i] * (most + dip) < magnitudes[i] * most;
        jump[i] = cancels ? net[i] : magnitudes[i];
        turn[i] = cancels ? net[i] * dip : 0.0F;
    }
    kept.jump = kept.jump + to_lanes(jump);
    kept.turn = kept.turn + to_lanes(turn);
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
        const ReadJoint between = joint(path, before);
        if (greatest(0.0F, between.always + between.turn * speed +
                               magnitude(between.jump) * (speed * speed)) > kFeltJoint) {
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
    const auto along_path = [&along](const AxisVecf& limit) {
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
    element.along = magnitude(at(0.0F).first);
    for (unsigned i = 0; i < kElementPlaces; ++i, s *= kNearerRest) {
        LaneDerivatives q = at(s);
        element.along = larger(element.along, magnitude(q.first));
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
    element.along = product(element.along, inverse_jerk_);
    return element;
}

}  // namespace cusp::planner
