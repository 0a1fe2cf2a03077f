// Douglas-Peucker splitting without recursion.
#include "host_tools/judge/view/path_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/base/pulse_frame.hpp"

namespace cusp::view {

namespace {

constexpr std::size_t kLongestStretch = 8192;
constexpr std::uint8_t kNoVertex = 255;

double square_of_distance(const std::array<double, 4>& p,
                          const std::array<double, 4>& a,
                          const std::array<double, 4>& chord,
                          double chord_square)
{
    double along = 0;
    for (unsigned k = 0; k < 4; ++k) {
        along += (p[k] - a[k]) * chord[k];
    }
    const double share = chord_square > 0 ? std::clamp(along / chord_square, 0.0, 1.0) : 0.0;
    double sum = 0;
    for (unsigned k = 0; k < 4; ++k) {
        const double d = p[k] - a[k] - share * chord[k];
        sum += d * d;
    }
    return sum;
}

std::uint8_t level_of(double missed)
{
    unsigned level = 0;
    for (double limit = 4 * PathVertices::kFinest;
         level + 1 < PathVertices::kLevels && missed > limit; limit *= 4) {
        ++level;
    }
    return static_cast<std::uint8_t>(level);
}

}  // namespace

void PathVertices::add(Position at, double deviation, bool corner)
{
    const Vec3d place = xyz(to_millimetres(at));
    double speed = 0;
    if (!points_.empty()) {
        const auto& last = points_.back().at;
        speed = norm(place - Vec3d{last[0], last[1], last[2]}) *
                static_cast<double>(kServoTicksPerSecond);
    }
    points_.push_back({{place.x, place.y, place.z, speed * kFinest}});
    deviations_.push_back(deviation);
    if (points_.size() > 1 && (corner || points_.size() > kLongestStretch)) {
        end_stretch();
    }
}

void PathVertices::end_stretch()
{
    const std::size_t last = points_.size() - 1;
    levels_.assign(points_.size(), kNoVertex);
    if (first_tick_ == 0) {
        levels_.front() = kLevels - 1;
    }
    levels_.back() = kLevels - 1;
    split({0, last, std::numeric_limits<double>::infinity()});
    for (std::size_t k = 0; k <= last; ++k) {
        if (levels_[k] != kNoVertex) {
            put(k, levels_[k]);
        }
    }
    const Point end = points_.back();
    points_.assign(1, end);
    deviations_.assign(1, 0.0);
    first_tick_ += last;
}

void PathVertices::split(Stretch whole)
{
    open_.assign(1, whole);
    while (!open_.empty()) {
        const Stretch stretch = open_.back();
        open_.pop_back();
        const auto& a = points_[stretch.begin].at;
        std::array<double, 4> chord{};
        double chord_square = 0;
        for (unsigned k = 0; k < 4; ++k) {
            chord[k] = points_[stretch.end].at[k] - a[k];
            chord_square += chord[k] * chord[k];
        }
        double worst = 0;
        std::size_t at = stretch.begin;
        for (std::size_t k = stretch.begin + 1; k < stretch.end; ++k) {
            const double square = square_of_distance(points_[k].at, a, chord, chord_square);
            if (square > worst) {
                worst = square;
                at = k;
            }
        }
        const double missed = std::min(stretch.max_deviation, std::sqrt(worst));
        if (missed > kFinest) {
            levels_[at] = level_of(missed);
            open_.push_back({stretch.begin, at, missed});
            open_.push_back({at, stretch.end, missed});
        }
    }
}

void PathVertices::put(std::size_t tick_of_stretch, unsigned level)
{
    const std::uint64_t tick = first_tick_ + tick_of_stretch;
    const auto begin =
        static_cast<std::ptrdiff_t>(std::max(last_vertex_, first_tick_) - first_tick_);
    const double worst =
        *std::max_element(deviations_.begin() + begin,
                          deviations_.begin() + static_cast<std::ptrdiff_t>(tick_of_stretch) + 1);
    constexpr double kUnits = 1e5;  // of 10 nm in a millimetre
    ticks_.put_varint(tick - last_vertex_);
    level_bytes_.put_u8(level);
    deviation_bytes_.put_u16(static_cast<std::uint64_t>(std::min(65535.0, worst * kUnits)));
    last_vertex_ = tick;
    ++count_;
}

Bytes PathVertices::finish()
{
    if (points_.size() > 1 || count_ == 0) {
        end_stretch();
    }
    Bytes out;
    out.put_u32(count_);
    out.put(ticks_.text());
    out.put(level_bytes_.text());
    out.put(deviation_bytes_.text());
    return out;
}

}  // namespace cusp::view
