// A scale of monotonic brightness, so that it is readable in grey as well.
#include "host_tools/judge/report/colour_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

#include "fmt/format.h"

namespace cusp::report {
namespace {

struct Colour {
    double red, green, blue;
};

// Samples of the map "viridis" of matplotlib (van der Walt and Smith, CC0).
constexpr std::array<Colour, 6> kStops{Colour{68, 1, 84},    Colour{65, 68, 135},
                                       Colour{42, 120, 142}, Colour{34, 168, 132},
                                       Colour{122, 209, 81}, Colour{253, 231, 37}};

constexpr double kSlack = 1e-6;  // of a step between the numbers of a scale
constexpr int kLeastDecade = -22;

}  // namespace

double round_below(double limit)
{
    if (!(limit > 0)) {
        return 1;
    }
    int decade = kLeastDecade;
    while (decade < -kLeastDecade && elementary::power_of_ten(decade + 1) <= limit) {
        ++decade;
    }
    const double power = elementary::power_of_ten(decade);
    const double share = limit / power;
    return power * (share >= 5 ? 5 : share >= 2 ? 2 : 1);
}

std::string colour_of_step(int step)
{
    const double place = static_cast<double>(step) / (kColourSteps - 1) * (kStops.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
    const double share = place - static_cast<double>(low);
    const auto mixed = [&](double a, double b) {
        return static_cast<int>(std::lround(a + share * (b - a)));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", mixed(kStops[low].red, kStops[low + 1].red),
                       mixed(kStops[low].green, kStops[low + 1].green),
                       mixed(kStops[low].blue, kStops[low + 1].blue));
}

int step_of(double value, double low, double high)
{
    if (!(high > low)) {
        return 0;
    }
    const double share = (value - low) / (high - low);
    return std::clamp(static_cast<int>(share * kColourSteps), 0, kColourSteps - 1);
}

std::string scale_bar(const ScaleLayout& layout, double low, double high, const std::string& title)
{
    const auto [x, y, height, text] = layout;
    const double width = 1.4 * text;
    const double step_height = height / kColourSteps;
    std::string out = fmt::format(
        "<text x=\"{:.3f}\" y=\"{:.3f}\" font-size=\"{:.3f}\" "
        "font-family=\"sans-serif\">{}</text>\n",
        x, y - text, text, title);
    for (int k = 0; k < kColourSteps; ++k) {
        out += fmt::format(
            "<rect x=\"{:.3f}\" y=\"{:.3f}\" width=\"{:.3f}\" height=\"{:.3f}\" fill=\"{}\"/>\n", x,
            y + (kColourSteps - 1 - k) * step_height, width, 1.05 * step_height, colour_of_step(k));
    }
    const double step = round_below((high - low) / 4);
    for (double number = std::ceil(low / step - kSlack) * step; number <= high + kSlack * step;
         number += step) {
        const double share = high > low ? (number - low) / (high - low) : 0;
        // rounding must not print as "-1e-17"
        const double shown = std::abs(number) < kSlack * step ? 0 : number;
        out += fmt::format(
            "<text x=\"{:.3f}\" y=\"{:.3f}\" font-size=\"{:.3f}\" "
            "font-family=\"sans-serif\">{:.3g}</text>\n",
            x + 1.3 * width, y + (1 - share) * height + text / 3, text, shown);
    }
    return out;
}

}  // namespace cusp::report
