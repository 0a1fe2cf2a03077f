// Colours for numbers, and their scale, for SVG pictures.
#pragma once

#include <string>

namespace cusp::report {

// Steps of the scale: few enough that neighbouring points of one colour can be merged.
inline constexpr int kColourSteps = 32;

// "#rrggbb" of a step, 0 to kColourSteps - 1: dark violet, blue, green, yellow.
std::string colour_of_step(int step);

// The step of a value between low and high; clamped.
int step_of(double value, double low, double high);

// 1, 2 or 5 times a power of ten, at most `limit`; 1 where that is not above 0.
double round_below(double limit);

// Position and size of a scale, in the picture's units.
struct ScaleLayout {
    double x, y;    // of the upper left corner
    double height;  // of the bar
    double text;    // size of the text
};

// The scale from `low` to `high` as a vertical bar with round numbers.
std::string scale_bar(const ScaleLayout& layout, double low, double high, const std::string& title);

}  // namespace cusp::report
