// What both pictures share: the frame around the part, y upwards, and the walls.
#pragma once

#include <algorithm>
#include <string>

#include "host_tools/job/job.hpp"
#include "host_tools/job/loop_shape.hpp"

#include "fmt/format.h"

namespace cusp::report {

// Room for the scale beside the picture, as a share of its height.
inline constexpr double kScaleRoom = 0.28;
inline constexpr int kPixels = 900;

struct PictureFrame {
    double x_low, x_high, y_low, y_high;  // mm

    double width() const { return x_high - x_low; }
    double height() const { return y_high - y_low; }
    double margin() const { return 0.04 * std::max(width(), height()); }
    // In the picture y grows downwards.
    double flipped(double y) const { return y_high - (y - y_low); }
    double line() const { return std::max(width(), height()) / kPixels; }

    std::string head() const
    {
        const double m = margin();
        const double w = width() + 2 * m + kScaleRoom * height();
        const double h = height() + 3 * m;
        return fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{:.0f}\" "
            "viewBox=\"{:.3f} {:.3f} {:.3f} {:.3f}\">\n"
            "<rect x=\"{:.3f}\" y=\"{:.3f}\" width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
            kPixels, kPixels * h / w, x_low - m, y_low - 2 * m, w, h, x_low - m, y_low - 2 * m);
    }
};

// The walls of all operations as closed lines.
inline std::string walls(const job::Job& job, const PictureFrame& frame)
{
    constexpr double kChord = 0.01;
    std::string out;
    const auto add = [&](const job::Loop& loop) {
        out += fmt::format(
            "<polyline fill=\"none\" stroke=\"black\" stroke-width=\"{:.3f}\" points=\"",
            2 * frame.line());
        for (const Vec2d p : job::loop_polyline(loop, kChord)) {
            out += fmt::format("{:.3f},{:.3f} ", p.x, frame.flipped(p.y));
        }
        out += "\"/>\n";
    };
    for (const job::Operation& operation : job.operations) {
        if (operation.boundary) {
            add(*operation.boundary);
        }
        std::for_each(operation.islands.begin(), operation.islands.end(), add);
    }
    return out;
}

}  // namespace cusp::report
