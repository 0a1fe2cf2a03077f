// Joints around the next station, and the turns that were read last.
#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "firmware/planner/station_spacing.hpp"

namespace cusp::planner {
namespace {

constexpr float kNegligibleJoint = 1e-3F;
constexpr float kGroupOfWindow = 0.125F;
constexpr unsigned kSlowings = 24;
constexpr float kSlowing = 0.85F;
constexpr float kReachBehind = 2.0F;  // of joints: the speed may grow

}  // namespace

// Keeps a turn in mind; those within a part of a window count as one.
void StationSpacing::add_turn(std::int64_t at, float turned, float window) noexcept
{
    if (!turns_.empty() && distance(turns_.back().first, at) < kGroupOfWindow * window) {
        turns_.back().last = at;
        turns_.back().turned += turned;
        return;
    }
    if (turns_.full()) {
        std::copy(turns_.begin() + 1, turns_.end(), turns_.begin());
        turns_.shrink(kTurnGroups - 1);
    }
    (void)turns_.try_push_back({at, at, turned});
}

// The turns on a way up to a place, that at it too.
float StationSpacing::turned_near(std::int64_t at, float way) const noexcept
{
    float sum = 0;
    for (const TurnGroup& group : turns_) {
        sum += distance(group.last, at) <= way ? group.turned : 0.0F;
    }
    return sum;
}

// The speed, at most the one given, at which the filters take a joint and the turns before it, as stations
// count them.
float StationSpacing::speed_through(const ReadJoint& joint,
                                    float speed,
                                    float second) const noexcept
{
    const float each = 1.0F / std::max(joint.turned, kNegligibleTurn);
    const float jerk = greatest(0.0F, joint.turn) * each;
    const float acceleration = greatest(0.0F, joint.turn_acceleration) * each;
    for (unsigned i = 0; i < kSlowings; ++i) {
        const float within = turned_near(joint.at, maker_.way_of_joints(joint.window, speed));
        const float on_slope = turned_near(joint.at, maker_.way_of_joints(second, speed));
        if (speed * std::max(jerk * std::min(2.0F * on_slope, within), acceleration * within) <=
            1) {
            break;
        }
        speed *= kSlowing;
    }
    return speed;
}

// The joints of the blocks up to a place, as far as they are known.
void StationSpacing::collect_joints(std::int64_t until) noexcept
{
    while (collected_.block != read_.block && collected_.begin < until) {
        collect_joints_of_block();
        collected_.begin += path_[collected_.block].block->length;
        ++collected_.block;
    }
}

void StationSpacing::collect_joints_of_block() noexcept
{
    const LawBlock law_block = path_[collected_.block];
    const Block& block = *law_block.block;
    const LaneVec none = all_lanes(0.0F);
    std::uint32_t begin = 0;
    // A shaper leaves a bend by what the tool travels around it, not only in it.
    for (std::uint8_t i = 0; maker_.shaper_length() > 0 && i < stretch_count(block); ++i) {
        const Stretch stretch = StretchReader{block, i}.next();
        const float bend = norm(stretch.derivatives.second);
        if (bend > kTinyBound) {
            add_joint({collected_.begin + begin, collected_.begin + stretch.end, none, none, none,
                       none, none, 0.0F, law_block.centripetal / bend, 0.0F});
        }
        begin = stretch.end;
    }
    if (collected_.block + 1 == path_.end()) {
        return;
    }
    ReadJoint joint = maker_.joint(path_, collected_);
    const float speed = std::min(law_block.feed, path_[collected_.block + 1].feed);
    const float root = std::sqrt(speed);
    const float jerk =
        greatest(0.0F, joint.always + magnitude(joint.jump) * speed + joint.turn * root);
    if (jerk < kNegligibleJoint && joint.turned < kNegligibleTurn) {
        return;
    }
    // Those within one window of filters and shaper act together.
    const float way = root * (joint.window + maker_.shaper_length());
    float turned = joint.turned;
    for (const LawJoint& before : joints_) {
        turned += distance(before.at, joint.at) < way ? before.turned : 0.0F;
    }
    joint.cap = std::min(joint.cap, maker_.cap_of_turn(law_block, turned, 0.0F));
    add_joint(joint);
}

void StationSpacing::add_joint(const LawJoint& joint) noexcept
{
    if (joints_.full()) {
        merge_nearest_joints();
    }
    (void)joints_.try_push_back(joint);
}

// Joints too dense for their table: the two that are nearest to each other count as one.
void StationSpacing::merge_nearest_joints() noexcept
{
    std::size_t nearest = 0;
    float least_extent = kUnlimited;
    for (std::size_t i = 0; i + 1 < joints_.size(); ++i) {
        const float extent = distance(joints_[i].first, joints_[i + 1].at);
        nearest = extent < least_extent ? i : nearest;
        least_extent = std::min(least_extent, extent);
    }
    LawJoint& a = joints_[nearest];
    const LawJoint& b = joints_[nearest + 1];
    a.at = std::max(a.at, b.at);
    a.always = a.always + b.always;
    a.loose = a.loose + b.loose + magnitude(a.jump) + magnitude(b.jump);
    a.jump = all_lanes(0.0F);
    a.turn = a.turn + b.turn;
    a.turn_acceleration = a.turn_acceleration + b.turn_acceleration;
    a.window = std::max(a.window, b.window);
    a.cap = std::min(a.cap, b.cap);
    a.turned += b.turned;
    std::copy(joints_.begin() + nearest + 2, joints_.end(), joints_.begin() + nearest + 1);
    joints_.shrink(joints_.size() - 1);
}

// mm, no shorter than stations look for joints.
float StationSpacing::reach_of_joints(float speed) const noexcept
{
    const AxisFilter filter = path_[cursor_.block].block->filter;
    const float window =
        static_cast<float>(filter.first + filter.second + kReachTicks) * kServoTick;
    const float gain = greatest(0.0F, to_lanes(limits_.acceleration)) * window;
    return kReach * (speed * (window + maker_.shaper_length()) + gain * window);
}

// Joints that no station from `at_` on can feel.
void StationSpacing::drop_joints() noexcept
{
    const std::int64_t after = at_ + to_units(2.0F * last_);
    const float speed = std::sqrt(std::max(expected_at(at_), expected_at(after)));
    const float reach = kReachBehind * reach_of_joints(speed) + 2.0F * last_;
    std::size_t kept = 0;
    for (const LawJoint& joint : joints_) {
        if (distance(joint.at, at_) < reach) {
            joints_[kept] = joint;
            ++kept;
        }
    }
    joints_.shrink(kept);
}

}  // namespace cusp::planner
