// Weights of the stages, and the moments that the planner counts with.
#include "firmware/planner/input_shaper.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "firmware/base/path_units.hpp"

namespace cusp::planner {
namespace {

constexpr double kOne = 1 << kShaperBits;
// The zeros of an extra insensitive shaper that lets V = 5 % of the vibration pass at its frequency:
// (1 + V)/4 + (1 - V)/2 z + (1 + V)/4 z^2 = 0 at the angles pi -+ acos((1 - V)/(1 + V)), 0.440510
// of pi: the frequencies' distance is 0.140219.
constexpr double kInsensitiveWidth = 0.140219;

// e^x, 0 <= x < 700: of a 256th by its series, squared eight times. Relative error below 1e-12.
double exponential(double x) noexcept
{
    constexpr unsigned kSquarings = 8;
    const double part = x / 256.0;
    double sum = 1.0;
    for (int i = 12; i > 0; --i) {
        sum = 1.0 + part / i * sum;
    }
    for (unsigned i = 0; i < kSquarings; ++i) {
        sum *= sum;
    }
    return sum;
}

std::int32_t rounded(double weight) noexcept
{
    return static_cast<std::int32_t>(std::floor(weight * kOne + 0.5));
}

// Taps at 0, n and n + 1 ticks, half a damped period d being n to n + 1 of them. At the end of the
// stage a vibration begun t ticks after its beginning is e^(at) (cos bt, sin bt) of one begun first,
// with a the decay a tick and b the angle: the weights' sum of these is zero. sin bn is not negative,
// sin b(n + 1) is; both cosines are, for at least two ticks half a period.
ShaperStage make_stage(double frequency, double damping) noexcept
{
    const double turn = 2.0 * kPi * frequency * static_cast<double>(kServoTick);
    const double angle = turn * std::sqrt(1.0 - damping * damping);
    const double growth = turn * damping;
    const double ticks = std::floor(kPi / angle);
    const double first = exponential(growth * ticks);
    const double second = exponential(growth * (ticks + 1.0));
    const SinCos<double> at_first = sin_cos(angle * ticks);
    const SinCos<double> at_second = sin_cos(angle * (ticks + 1.0));
    // As parts of the second tap's weight.
    const double last = std::max(0.0, -first * at_first.sin / (second * at_second.sin));
    const double now = -first * at_first.cos - last * second * at_second.cos;
    const double sum = now + 1.0 + last;
    ShaperStage stage{static_cast<std::uint32_t>(ticks), 0, 0, rounded(last / sum)};
    stage.now = rounded(now / sum);
    stage.later = (1 << kShaperBits) - stage.now - stage.last;
    return stage;
}

void add_stages(InputShaper& shaper, const AxisVibration& axis) noexcept
{
    const auto frequency = static_cast<double>(axis.frequency);
    const auto damping = static_cast<double>(axis.damping);
    const bool wide = axis.type == ShaperType::kExtraInsensitive;
    const double width = wide ? kInsensitiveWidth : 0.0;
    (void)shaper.stages.try_push_back(make_stage(frequency * (1.0 - width), damping));
    if (axis.type != ShaperType::kZeroVibration) {
        (void)shaper.stages.try_push_back(make_stage(frequency * (1.0 + width), damping));
    }
}

}  // namespace

InputShaper make_input_shaper(const PerAxis<AxisVibration>& axes) noexcept
{
    InputShaper shaper;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const auto* const begin = axes.data();
        const bool named_before = std::find(begin, begin + i, axes[i]) != begin + i;
        if (axes[i].type != ShaperType::kNone && !named_before) {
            add_stages(shaper, axes[i]);
        }
    }
    float mean = 0;
    for (const ShaperStage& stage : shaper.stages) {
        const float n = static_cast<float>(stage.ticks) * kServoTick;
        const float later = static_cast<float>(stage.later) / static_cast<float>(kOne);
        const float last = static_cast<float>(stage.last) / static_cast<float>(kOne);
        const float far = n + kServoTick;
        const float centre = later * n + last * far;
        mean += centre;
        shaper.square += later * n * n + last * far * far - centre * centre;
        shaper.ticks += stage.ticks + 1;
    }
    shaper.length = static_cast<float>(shaper.ticks) * kServoTick;
    shaper.mean_time = std::sqrt(shaper.square);
    shaper.reach = std::max(mean, shaper.length - mean);
    return shaper;
}

}  // namespace cusp::planner
