// Tools as options of the command line: "ball:6", "flat:8", "bull:10:1.5", "drill:5", "vee:6:60",
// "taper:6:5:0.5".
#pragma once

#include <string>

namespace cusp::import {

// Lengths in the unit of the request.
struct NamedTool {
    std::string shape;  // as in job files: "ball", "flat", "bull", "drill", "vee", "taper"
    double diameter{};
    double corner_radius{};  // of a bull-nose end, or of the ball of a taper; else 0
    double tip_angle{};      // degrees, of a vee or a drill; else 0
    double taper_angle{};    // degrees, of a taper's flank from its axis; else 0
    double tip_diameter{};   // of the flat at a vee's tip; else 0
};

// text  SHAPE:DIAMETER, bull:DIAMETER:CORNER_RADIUS, vee:DIAMETER:ANGLE[:TIP_DIAMETER],
//       drill:DIAMETER[:ANGLE], taper:DIAMETER:ANGLE:BALL_RADIUS, angles in degrees; each length may end in "mm" or "in"
// inch  whether the result, and lengths without an ending, are in inches
//
// Errors: InputError with the text, its fault and the expected form.
NamedTool tool_of_text(const std::string& text, bool inch);

// "ball 6 mm", "bull 10 mm with corners of 1.5 mm".
std::string words_of(const NamedTool& tool, bool inch);

}  // namespace cusp::import
