// The rows' places serve: what is kept for all between is added.
#include "firmware/planner/law_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/planner/law_rows.hpp"

namespace cusp::planner {
namespace {

constexpr float kLeastRoot = 1e-6F;
constexpr float kUseOfCrawl = 0.8F;

LaneVec zero() noexcept { return all_lanes(0.0F); }

// a times the sign of b.
LaneVec with_sign(const LaneVec& a, const LaneVec& b) noexcept
{
    return quotient(product(a, b), larger(magnitude(b), all_lanes(1e-12F)));
}

void add_place(WarpBounds& bounds,
               const LaneDerivatives& q,
               const KeptShares& kept,
               const LaneVec& ratio,
               const SquaredSpeed& x) noexcept
{
    const float root = std::sqrt(std::max(x.value, kLeastRoot * kLeastRoot));
    const LawRow jerk = jerk_row(q, kept, x, root);
    const LawRow acceleration = acceleration_row(q, kept, ratio, x, root);
    const LaneVec one = all_lanes(1.0F);
    bounds.speed = larger(bounds.speed, product(magnitude(q.first), ratio) * (root * kPlanShare));
    const LaneVec along = with_sign(acceleration.value, q.first) * kPlanShare;
    const LaneVec apart = one - acceleration.left;
    bounds.braking = smaller(bounds.braking, along - apart);
    bounds.speeding = larger(bounds.speeding, along + apart);
    const LaneVec bend = kept.bend * (x.value * root);
    const LaneVec jerk_along = with_sign(jerk.value, q.first);
    bounds.falling = smaller(bounds.falling, (jerk_along - bend) * kPlanShare);
    bounds.rising = larger(bounds.rising, (jerk_along + bend) * kPlanShare);
    bounds.joint = larger(bounds.joint, (one - jerk.left - bend) * kPlanShare);
}

constexpr float kPackedOne = 16384.0F;
constexpr float kMostJerk = 1.99F;
constexpr float kPartsOfShare = 127.0F;

// The next number below. A plan uses no more than its share.
std::int8_t packed_acceleration(float value) noexcept
{
    const float parts = value * (kPartsOfShare / kPlanShare);
    return static_cast<std::int8_t>(std::floor(std::clamp(parts, -kPartsOfShare, kPartsOfShare)));
}

std::int16_t packed_jerk(float value) noexcept
{
    return static_cast<std::int16_t>(
        std::floor(std::clamp(value, -kMostJerk, kMostJerk) * kPackedOne));
}

std::uint16_t upper_half(float value) noexcept
{
    std::uint32_t bits = 0;
    static_assert(sizeof(bits) == sizeof(value));
    __builtin_memcpy(&bits, &value, sizeof(bits));
    return static_cast<std::uint16_t>(bits >> 16U);
}

float from_upper_half(std::uint16_t half) noexcept
{
    const std::uint32_t bits = std::uint32_t{half} << 16U;
    float value = 0;
    __builtin_memcpy(&value, &bits, sizeof(bits));
    return value;
}

WarpBounds none() noexcept
{
    const LaneVec much = all_lanes(1e3F);
    return {zero(), much, much * -1.0F, much, much * -1.0F, zero(), 0.0F};
}

}  // namespace

PackedBounds::PackedBounds(const WarpBounds& bounds) noexcept : time_{upper_half(bounds.time)}
{
    const AxisVecf speed = to_vec(bounds.speed);
    const AxisVecf braking = to_vec(bounds.braking);
    const AxisVecf speeding = to_vec(bounds.speeding);
    const AxisVecf falling = to_vec(bounds.falling);
    const AxisVecf rising = to_vec(bounds.rising);
    const AxisVecf joint = to_vec(bounds.joint);
    for (unsigned i = 0; i < kAxisCount; ++i) {
        speed_[i] = static_cast<std::uint16_t>(upper_half(speed[i]) + 1U);
        braking_[i] = packed_acceleration(braking[i]);
        speeding_[i] = static_cast<std::int8_t>(-packed_acceleration(-speeding[i]));
        falling_[i] = packed_jerk(falling[i]);
        rising_[i] = static_cast<std::int16_t>(-packed_jerk(-rising[i]));
        joint_[i] = static_cast<std::int16_t>(-packed_jerk(-joint[i]));
    }
}

WarpBounds PackedBounds::unpacked() const noexcept
{
    AxisVecf speed{};
    AxisVecf braking{};
    AxisVecf speeding{};
    AxisVecf falling{};
    AxisVecf rising{};
    AxisVecf joint{};
    for (unsigned i = 0; i < kAxisCount; ++i) {
        speed[i] = from_upper_half(speed_[i]);
        constexpr float kPart = kPlanShare / kPartsOfShare;
        braking[i] = static_cast<float>(braking_[i]) * kPart;
        speeding[i] = static_cast<float>(speeding_[i]) * kPart;
        falling[i] = static_cast<float>(falling_[i]) / kPackedOne;
        rising[i] = static_cast<float>(rising_[i]) / kPackedOne;
        joint[i] = static_cast<float>(joint_[i]) / kPackedOne;
    }
    return {to_lanes(speed),  to_lanes(braking), to_lanes(speeding),    to_lanes(falling),
            to_lanes(rising), to_lanes(joint),   from_upper_half(time_)};
}

WarpBounds bounds_of_cell(const Station& station,
                          const SquaredSpeed& start,
                          const LaneVec& ratio) noexcept
{
    WarpBounds bounds = none();
    constexpr std::array<float, kPlacesOfCell> kSimpson{1.0F / 6.0F, 4.0F / 6.0F, 1.0F / 6.0F};
    for (unsigned i = 0; i < kPlacesOfCell; ++i) {
        const float part = static_cast<float>(i) / (kPlacesOfCell - 1);
        const SquaredSpeed x = advanced(start, part * station.length);
        bounds.time +=
            kSimpson[i] * station.length / std::sqrt(std::max(x.value, kLeastRoot * kLeastRoot));
        add_place(bounds, station.places[i], station.kept, ratio, x);
    }
    return bounds;
}

WarpBounds bounds_of_element(const Station& station,
                             unsigned place,
                             float squared,
                             const StopElement& element,
                             bool starts,
                             const LaneVec& ratio) noexcept
{
    // s = w t^3/6 up to v = w t^2/2.
    const float speed = std::sqrt(std::max(squared, kLeastRoot));
    const float time = 3.0F * element.length / speed;
    const float acceleration = (starts ? 2.0F : -2.0F) * speed / time;
    const float jerk = 2.0F * speed / (time * time);
    WarpBounds bounds = none();
    const LaneDerivatives& q = station.places[place];
    add_place(bounds, q, station.kept, ratio, {squared, 2.0F * acceleration, 2.0F * jerk / speed});
    // Direction and so the axes' parts may change within it.
    const LaneVec along = larger(magnitude(q.first), element.along) * kPlanShare;
    const LaneVec most = product(along, ratio);
    bounds.speed = larger(bounds.speed, most * speed);
    bounds.braking = smaller(bounds.braking, starts ? zero() : most * acceleration);
    bounds.speeding = larger(bounds.speeding, starts ? most * acceleration : zero());
    bounds.falling = smaller(bounds.falling, zero());
    bounds.rising = larger(bounds.rising, along * jerk);
    bounds.time = time;
    return bounds;
}

WarpBounds bounds_of_crawl(float squared, float time, const LaneVec& inverse_acceleration) noexcept
{
    return {inverse_acceleration * std::sqrt(squared),
            all_lanes(-kUseOfCrawl),
            all_lanes(kUseOfCrawl),
            all_lanes(-kUseOfCrawl),
            all_lanes(kUseOfCrawl),
            zero(),
            time};
}

}  // namespace cusp::planner
