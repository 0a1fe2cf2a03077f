// The frame of all pictures: panels, y upwards, the walls, and a ruler.
#pragma once

#include <algorithm>
#include <string>

#include "host_tools/job/job/job.hpp"

namespace cusp::report {

// The part in plan, in one or several panels side by side, at one scale. Lengths in the picture are
// in mm.
struct PictureFrame {
    double x_low, x_high, y_low, y_high;  // mm
    int panels{1};

    double width() const { return x_high - x_low; }
    double height() const { return y_high - y_low; }
    double margin() const { return 0.04 * std::max(width(), height()); }
    double text() const { return 0.8 * margin(); }
    // y in the picture, which is positive downwards.
    double flipped(double y) const { return y_high - (y - y_low); }
    double line() const;
    // Distance between panels.
    double stride() const { return width() + margin(); }
    // x to the right of the last panel.
    double scale_x() const { return x_high + (panels - 1) * stride() + margin(); }
    // y in the picture of a value on the scale, 0 to 1 of the way from its low end to the high one.
    double scale_y(double share) const { return y_low + (1 - share) * scale_height(); }
    double scale_height() const { return 0.75 * height(); }

    std::string head() const;
    // Opens a panel with its title, which "</g>" closes. number: from 0.
    std::string panel(int number, const std::string& title) const;
    // A bar of a round length, below the first panel.
    std::string ruler() const;
    // The scale of colours.
    std::string scale(double low, double high, const std::string& title) const;
    // A line of the legend below the scale; `stroke` as SVG attributes.
    std::string legend(int row, const std::string& stroke, const std::string& title) const;
};

// "ball 12 mm"
std::string tool_title(const toolpath::Tool& tool);

// The walls of all operations as closed lines.
std::string walls(const job::Job& job, const PictureFrame& frame);

}  // namespace cusp::report
