// Colours for numbers, and the scale that explains them, for SVG pictures.
#pragma once

#include <string>

namespace cusp::report {

// Steps of the scale: few enough that neighbours merge in the picture.
inline constexpr int kColourSteps = 32;

// "#rrggbb" of a step, 0 to kColourSteps - 1: dark violet, blue, green, yellow.
std::string colour_of_step(int step);

// The step of a value between low and high; clamped.
int step_of(double value, double low, double high);

// 1, 2 or 5 times a power of ten, at most `most`; 1 where that is not above 0.
double round_below(double most);

// The scale as a vertical bar with round numbers.
//
// x, y          of its upper left corner
// height, text  height of the bar and size of its text, in the picture's units
std::string scale_bar(double x,
                      double y,
                      double height,
                      double text,
                      double low,
                      double high,
                      const std::string& title);

}  // namespace cusp::report
