// From bounds of the derivatives to bounds of speed and acceleration along the path.
#include "firmware/planner/speed_limit.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::planner {
namespace {

constexpr float kTiny = 1e-20F;

// The least of the cube roots. Rounding aside a root rises with its cube: of all floats below 1e15
// none has a root below that of one smaller by more than 7e-8 of it.
constexpr float kNextCube = 1.0F + 1e-4F;

float least_root(Vec3f cubes, float least_cube) noexcept
{
    float least = cube_root(least_cube);
    for (const float cube : {cubes.x, cubes.y, cubes.z}) {
        if (cube != least_cube && cube <= kNextCube * least_cube) {
            least = std::min(least, cube_root(cube));
        }
    }
    return least;
}

Line line(const ShareLine& shares) noexcept { return {shares.at_rest, shares.at_cap}; }

// At part of the squared speed's cap.
float value(const Line& line, float part) noexcept
{
    return line.at_rest - (line.at_rest - line.at_cap) * part;
}

float value(const BentLine& bent, float part) noexcept
{
    return part < 0.5F ? bent.at_rest - 2.0F * (bent.at_rest - bent.at_half) * part
                       : bent.at_cap + 2.0F * (bent.at_half - bent.at_cap) * (1.0F - part);
}

// The second line falls no less steeply than the first: a chord of the two is not above them.
void straighten(BentLine& bent) noexcept
{
    bent.at_rest = std::min(bent.at_rest, 2.0F * bent.at_half - bent.at_cap);
}

// The line of each axis under (j - k y^1.5)/(p + q y^0.5), y being the part of the squared speed's
// cap. From y = 1/2 on it is not below (j - k (y - c (1 - y)))/(p + q (1 + y)/2), with c = 1 -
// 2^-0.5, and up to there not below (j - k y 2^-0.5)/(p + q (y + 1/2) 2^-0.5). Both are convex: not
// below their tangents at 1 and at 1/2. Returns the least of the axes.
BentLine jerk_bound(LaneVec j, LaneVec k, LaneVec p, LaneVec q) noexcept
{
    constexpr float kRootOfHalf = 0.70710678F;
    const LaneVec whole = p + q;
    const LaneVec left = j - k;
    const LaneVec at_cap = quotient(left, whole);
    const LaneVec fall = quotient(
        product(k * (2.0F - kRootOfHalf), whole) + product(left * 0.5F, q), product(whole, whole));
    const LaneVec part = p + q * kRootOfHalf;
    const LaneVec rest = j - k * (0.5F * kRootOfHalf);
    const LaneVec at_half = at_cap + fall * 0.5F;
    const LaneVec at_rest =
        quotient(rest, part) +
        quotient((product(k, part) + product(rest, q)) * (0.5F * kRootOfHalf), product(part, part));
    // As straighten().
    return {least(kUnlimited, smaller(at_rest, at_half * 2.0F - at_cap)),
            least(kUnlimited, at_half), least(kUnlimited, at_cap)};
}

// A bound r - d v^2 of the acceleration at the speed v of the tool.
struct Fall {
    float r;
    float d;
};

// The acceleration u with which a bound at the speed v + h u is u itself.
float behind(const Fall& bound, float v, float h) noexcept
{
    const float d = bound.d;
    const float left = bound.r - d * v * v;
    const float b = 1.0F + 2.0F * d * v * h;
    return 2.0F * left / (b + std::sqrt(b * b + 4.0F * d * h * h * left));
}

// Under both lines of a bound: the first holds where the tool is at no more than half the cap.
struct TwoFalls {
    TwoFalls(const BentLine& bent, float cap) noexcept
        : twice{2.0F / cap},
          first{bent.at_rest, twice * (bent.at_rest - bent.at_half)},
          second{bent.at_half + (bent.at_half - bent.at_cap), twice * (bent.at_half - bent.at_cap)}
    {
    }
    float behind(float v, float h) const noexcept
    {
        const float u = planner::behind(first, v, h);
        const float tool = v + h * u;
        return twice * tool * tool <= 1.0F ? u : planner::behind(second, v, h);
    }

    float twice;  // over the cap
    Fall first;
    Fall second;
};

}  // namespace

PathDerivatives larger(const PathDerivatives& a, const PathDerivatives& b) noexcept
{
    return {larger(a.first, b.first), larger(a.second, b.second), larger(a.third, b.third)};
}

void restrict_to(Allowance& a, const Allowance& b) noexcept
{
    // The lower cap is all of itself.
    const bool by_b = b.cap < a.cap;
    const Allowance& low = by_b ? b : a;
    const Allowance& high = by_b ? a : b;
    const float part = low.cap / high.cap;
    const auto least = [part](const Line& of_low, const Line& of_high) {
        return Line{std::min(of_low.at_rest, of_high.at_rest),
                    std::min(value(of_low, 1.0F), value(of_high, part))};
    };
    const BentLine& jerk = low.by_jerk;
    const BentLine by_jerk{std::min(jerk.at_rest, high.by_jerk.at_rest),
                           std::min(value(jerk, 0.5F), value(high.by_jerk, 0.5F * part)),
                           std::min(jerk.at_cap, value(high.by_jerk, part))};
    const Line by_acceleration = least(low.by_acceleration, high.by_acceleration);
    if (a.jerk_left.at_cap.is_whole() && b.jerk_left.at_cap.is_whole()) {
        a.jerk_left = {1, 1};
    } else {
        const Line left = least(line(low.jerk_left), line(high.jerk_left));
        a.jerk_left = {left.at_rest, left.at_cap};
    }
    a.cap = low.cap;
    a.feed = std::min(a.feed, b.feed);
    a.by_acceleration = by_acceleration;
    a.by_jerk = by_jerk;
    a.acceleration_left = std::min(a.acceleration_left, b.acceleration_left);
}

// A bound of kUnlimited stays; a line's value at its cap need not be at_cap itself, for rounding.
void restrict_to_feed(Allowance& a, float squared_feed) noexcept
{
    const auto again = [](const Line& line) {
        return Line{line.at_rest, value(line, 1.0F)};
    };
    a.feed = std::min(a.feed, squared_feed);
    a.by_acceleration = again(a.by_acceleration);
    a.by_jerk.at_half = value(a.by_jerk, 0.5F);
    if (a.jerk_left.at_cap.is_whole()) {
        a.jerk_left = {1, 1};
    } else {
        const Line left = again(line(a.jerk_left));
        a.jerk_left = {left.at_rest, left.at_cap};
    }
}

bool binds(const Allowance& a, const Allowance& b) noexcept
{
    if (a.cap < b.cap || a.feed < b.feed || a.acceleration_left < b.acceleration_left) {
        return true;
    }
    const float part_of_a = b.cap / a.cap;
    const auto lower = [part_of_a](const Line& of_a, const Line& of_b) {
        return of_a.at_rest < of_b.at_rest || value(of_a, part_of_a) < of_b.at_cap;
    };
    const bool leaves_less =
        !a.jerk_left.at_cap.is_whole() && lower(line(a.jerk_left), line(b.jerk_left));
    return leaves_less || lower(a.by_acceleration, b.by_acceleration) ||
           a.by_jerk.at_rest < b.by_jerk.at_rest ||
           value(a.by_jerk, 0.5F * part_of_a) < b.by_jerk.at_half ||
           value(a.by_jerk, part_of_a) < b.by_jerk.at_cap;
}

bool are_alike(const Allowance& a, const Allowance& b) noexcept
{
    constexpr float kDifference = 0.03F;
    const auto differ = [](float x, float y, float scale) {
        return std::fabs(x - y) > kDifference * scale;
    };
    const auto lines_differ = [&differ](const auto& x, const auto& y) {
        return differ(x.at_rest, y.at_rest, x.at_rest) || differ(x.at_cap, y.at_cap, x.at_rest);
    };
    return !differ(a.cap, b.cap, a.cap) && !lines_differ(a.by_acceleration, b.by_acceleration) &&
           !lines_differ(a.by_jerk, b.by_jerk);
}

SpeedLimit speed_limit(const Allowance& allowance, float half_filter) noexcept
{
    // The product of two falling lines is convex: above its tangents, at the cap and at half of it.
    const BentLine& jerk = allowance.by_jerk;
    const Line left = line(allowance.jerk_left);
    const float half_left = 0.5F * (left.at_rest + left.at_cap);
    const float share = allowance.acceleration_left;
    const Line acceleration{share * allowance.by_acceleration.at_rest,
                            share * allowance.by_acceleration.at_cap};
    BentLine bent{
        jerk.at_rest * half_left + jerk.at_half * (left.at_rest - half_left),
        jerk.at_half * left.at_cap + jerk.at_cap * (half_left - left.at_cap),
        jerk.at_cap * left.at_cap,
    };
    bent.at_rest = std::min(bent.at_rest, acceleration.at_rest);
    bent.at_half = std::min(bent.at_half, value(acceleration, 0.5F));
    bent.at_cap = std::min(bent.at_cap, acceleration.at_cap);
    straighten(bent);
    const float least = bent.at_cap;
    SpeedLimit limit{allowance.cap, least, least, allowance.feed, 1.0F, 1.0F};
    const float least_from = std::sqrt(allowance.cap) - half_filter * least;
    if (bent.at_rest > least && least_from > 0) {
        const TwoFalls falls{bent, allowance.cap};
        limit.at_rest = falls.behind(0.0F, half_filter);
        limit.half = falls.behind(0.5F * least_from, half_filter) / limit.at_rest;
        limit.most = falls.behind(0.75F * least_from, half_filter) / limit.at_rest;
    }
    return limit;
}

Allowance allowance(const LaneDerivatives& derivatives,
                    const MachineLimits& limits,
                    float filter_s,
                    float max_centripetal,
                    float max_speed,
                    float jerk_share) noexcept
{
    const auto& [first, second, third] = derivatives;
    const LaneVec tiny = all_lanes(kTiny);
    const LaneVec acceleration = to_lanes(limits.acceleration);
    const LaneVec jerk = to_lanes(limits.jerk);
    const LaneVec along = larger(first, tiny);
    const LaneVec ratio = quotient(to_lanes(limits.velocity), along);
    float cap = least(max_speed * max_speed, product(ratio, ratio));
    cap = least(cap, quotient(acceleration * kCentripetalShare, larger(second, tiny)));
    cap = std::min(cap, max_centripetal / std::max(norm(second), kTiny));
    float speed = std::sqrt(cap);
    const LaneVec cubes = quotient(jerk * jerk_share, larger(third, tiny));
    const float least_cube = least(kUnlimited, cubes);
    // No root, mostly: of a cube above that of the speed the square is above the cap, as
    // cube_root() is below the true root by less than 1e-6 of it.
    if (least_cube < 1e15F && least_cube < kNextCube * cap * speed) {
        const float jerk_speed = least_root(to_vec(cubes), least_cube);
        cap = std::min(cap, jerk_speed * jerk_speed);
        speed = std::sqrt(cap);
    }

    Allowance allowed = kAllowsAll;
    allowed.cap = cap;
    allowed.by_acceleration = {least(kUnlimited, quotient(acceleration, along)),
                               least(kUnlimited, quotient(acceleration - second * cap, along))};
    allowed.by_jerk =
        jerk_bound(jerk, third * speed * cap, along / filter_s, second * 3.0F * speed);
    return allowed;
}

}  // namespace cusp::planner
