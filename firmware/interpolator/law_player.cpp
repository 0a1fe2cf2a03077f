// Cells by their series in time, their ends by Newton's steps.
#include "firmware/interpolator/law_player.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/path_units.hpp"

namespace cusp::interpolator {
namespace {

using planner::LawPiece;
using planner::SquaredSpeed;

constexpr float kLeastSquare = 1e-12F;  // mm^2/s^2
constexpr int kNewtonSteps = 3;
constexpr float kNear = 1e-5F;  // s; the next step changes its square
constexpr float kRestOfElement = 1e-6F;

// Speed, acceleration and k of a state.
struct Series {
    explicit Series(const SquaredSpeed& x) noexcept
        : v{std::sqrt(std::max(x.value, kLeastSquare))}, u{0.5F * x.slope}, k{0.5F * x.bend}
    {
    }
    float travel(float t) const noexcept
    {
        return t *
               (v + t * (0.5F * u + t * k *
                                        (v * (1.0F / 6.0F) +
                                         t * (u * (1.0F / 24.0F) + t * k * v * (1.0F / 120.0F)))));
    }
    float speed(float t) const noexcept
    {
        return v + t * (u + t * k * (0.5F * v + t * u * (1.0F / 6.0F)));
    }
    float v, u, k;
};

}  // namespace

void LawPlayer::play(const planner::LawCell& cell) noexcept
{
    cell_ = cell;
    length_ = static_cast<float>(cell.travel) / kPathUnitsPerMillimetre;
    place_ = 0;
    gone_ = 0;
    elapsed_ = 0;
    finished_ = cell.travel == 0;
    // s = w t^3/6 and v = w t^2/2; a brake leaves half of v = w t^2 after s = v t - w t^3/6.
    const float speed = std::sqrt(std::max(cell.start.value, kLeastSquare));
    duration_ = cell.piece == LawPiece::kCell    ? 0.0F
                : cell.piece == LawPiece::kBrake ? 1.2F * length_ / speed
                                                 : 3.0F * length_ / speed;
}

// Precondition: place <= length_.
std::uint32_t LawPlayer::go_to(float place) noexcept
{
    place_ = place;
    const auto at = static_cast<std::uint32_t>(place * kPathUnitsPerMillimetre + 0.5F);
    const std::uint32_t before = gone_;
    gone_ = std::max(before, std::min(at, cell_.travel));
    return gone_ - before;
}

std::uint32_t LawPlayer::advance_element(float& left) noexcept
{
    const float step = std::min(left, duration_ - elapsed_);
    left -= step;
    elapsed_ += step;
    if (elapsed_ >= duration_ * (1.0F - kRestOfElement)) {
        return go_to_end();
    }
    const float part = elapsed_ / duration_;
    const float left_part = 1.0F - part;
    if (cell_.piece == LawPiece::kStart) {
        return go_to(length_ * (part * part * part));
    }
    if (cell_.piece == LawPiece::kBrake) {
        return go_to(length_ * part * (1.2F - 0.2F * part * part));
    }
    return go_to(length_ * (1.0F - left_part * left_part * left_part));
}

std::uint32_t LawPlayer::go_to_end() noexcept
{
    finished_ = true;
    const std::uint32_t before = gone_;
    gone_ = cell_.travel;
    return gone_ - before;
}

std::uint32_t LawPlayer::advance(float& left) noexcept
{
    if (cell_.piece != LawPiece::kCell) {
        return advance_element(left);
    }
    const Series series{advanced(cell_.start, place_)};
    const float room = length_ - place_;
    const float travel = series.travel(left);
    // The cell has ended before the series would turn back.
    if (travel < room && series.speed(left) > 0) {
        left = 0;
        return go_to(place_ + travel);
    }
    float time = std::min(left, room / series.v);
    for (int i = 0; i < kNewtonSteps; ++i) {
        const float before = time;
        time -= (series.travel(time) - room) / series.speed(time);
        time = std::clamp(time, 0.0F, left);
        if (std::fabs(time - before) < kNear) {
            break;
        }
    }
    left -= time;
    return go_to_end();
}

float LawPlayer::speed() const noexcept
{
    if (finished_) {
        return 0;
    }
    if (cell_.piece == LawPiece::kCell) {
        return Series{advanced(cell_.start, place_)}.v;
    }
    const float speed = std::sqrt(cell_.start.value);
    const float part = elapsed_ / duration_;
    if (cell_.piece == LawPiece::kStart) {
        return speed * part * part;
    }
    if (cell_.piece == LawPiece::kBrake) {
        return speed * (1.0F - 0.5F * part * part);
    }
    return speed * (1.0F - part) * (1.0F - part);
}

}  // namespace cusp::interpolator
