// Panels of curves; lengths are pixels.
#include "host_tools/judge/report/motion_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "firmware/base/axis.hpp"
#include "host_tools/judge/report/colour_scale.hpp"

#include "fmt/format.h"

namespace cusp::report {

using program_run::MotionProfile;
using program_run::ProfileStretch;

namespace {

constexpr double kLeft = 64;
constexpr double kPlotWidth = 840;
constexpr double kRight = 190;  // for the legend
constexpr double kPanelHeight = 120;
constexpr double kGap = 46;
constexpr double kTop = 30;
constexpr double kTextSize = 12;
constexpr double kNoteHeight = 12;
constexpr double kPercent = 100;

// Palette of Okabe and Ito: distinct for the colour-blind, and in grey.
constexpr const char* kSpeedColour = "#000000";
constexpr const char* kJerkColour = "#56b4e9";
constexpr const char* kAccelerationColour = "#e69f00";
constexpr const char* kVelocityColour = "#0072b2";

// Third differences of positions rounded by half a nanometre, at 1 kHz.
constexpr const char* kRoundingNote =
    "Set points are whole nanometres: up to 4000 mm/s³ of jerk is rounding.";

struct Curve {
    std::string name;
    const char* colour;
    std::vector<double> values;  // one for each stretch
};

std::string text_at(double x, double y, const char* anchor, const std::string& text)
{
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y,
                       anchor, text);
}

std::string line_between(double x1, double y1, double x2, double y2, const char* style)
{
    return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" {}/>\n", x1, y1, x2, y2, style);
}

// Position and axes of one panel.
struct MotionPanel {
    int row;
    double seconds;  // at the right end
    double top;      // value at the upper end

    double bottom() const { return kTop + row * (kPanelHeight + kGap) + kPanelHeight; }
    double x(double time) const { return kLeft + kPlotWidth * time / seconds; }
    double y(double value) const { return bottom() - kPanelHeight * std::min(1.0, value / top); }

    std::string axes(const std::string& title, double step) const
    {
        constexpr const char* kGrid = "stroke=\"#d0d0d0\" stroke-width=\"1\"";
        constexpr double kRounding = 1e-9;
        std::string out = text_at(kLeft, bottom() - kPanelHeight - 6, "start", title);
        for (double value = 0; value <= top * (1 + kRounding); value += step) {
            out += line_between(kLeft, y(value), kLeft + kPlotWidth, y(value), kGrid);
            out += text_at(kLeft - 6, y(value) + 4, "end", fmt::format("{:g}", value));
        }
        const double time_step = round_below(seconds / 5);
        for (int k = 0; k * time_step <= seconds * (1 + kRounding); ++k) {
            const double time = k * time_step;
            out += line_between(x(time), bottom(), x(time), bottom() - kPanelHeight, kGrid);
            out += text_at(x(time), bottom() + 15, "middle", fmt::format("{:g} s", time));
        }
        return out;
    }

    // The greatest value of each pixel's stretches.
    std::string curve(const Curve& curve, double seconds_each) const
    {
        std::string points;
        int column = -1;
        double greatest = 0;
        const auto finish = [&] {
            if (column >= 0) {
                points += fmt::format("{}{:.1f}", points.empty() ? "M" : "L", kLeft + column) +
                          fmt::format(" {:.1f}", y(greatest));
            }
        };
        for (std::size_t k = 0; k < curve.values.size(); ++k) {
            const int here =
                static_cast<int>(x((static_cast<double>(k) + 0.5) * seconds_each) - kLeft);
            if (here != column) {
                finish();
                column = here;
                greatest = 0;
            }
            greatest = std::max(greatest, curve.values[k]);
        }
        finish();
        return points.empty() ? std::string{}
                              : fmt::format(
                                    "<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\" "
                                    "stroke-linejoin=\"round\" d=\"{}\"/>\n",
                                    curve.colour, points);
    }

    std::string legend(const std::vector<Curve>& curves) const
    {
        std::string out;
        double at = bottom() - kPanelHeight + 14;
        for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve, at += 20) {
            out += fmt::format("<path d=\"M{:.1f} {:.1f}h20\" stroke=\"{}\" stroke-width=\"3\"/>\n",
                               kLeft + kPlotWidth + 14, at - 4, curve->colour);
            out += text_at(kLeft + kPlotWidth + 40, at, "start", curve->name);
        }
        return out;
    }
};

template <class Value>
std::vector<double> values_of(const MotionProfile& profile, const Value& value)
{
    std::vector<double> values;
    for (const ProfileStretch& stretch : profile.stretches()) {
        values.push_back(value(stretch));
    }
    return values;
}

std::string panel_of(const MotionPanel& panel,
                     const std::string& title,
                     double step,
                     const std::vector<Curve>& curves,
                     double seconds_each)
{
    std::string out = panel.axes(title, step);
    for (const Curve& curve : curves) {
        out += panel.curve(curve, seconds_each);
    }
    return out + panel.legend(curves);
}

std::string speed_panel(const MotionProfile& profile, double seconds)
{
    const std::vector<Curve> curves{
        {"along the path", kSpeedColour,
         values_of(profile, [](const ProfileStretch& s) { return s.speed; })}};
    const std::vector<double>& speeds = curves.front().values;
    const double greatest = speeds.empty() ? 0.0 : *std::max_element(speeds.begin(), speeds.end());
    const double step = round_below(std::max(1e-3, greatest) / 2);
    const double top = step * std::max(1.0, std::ceil(greatest / step));
    return panel_of({0, seconds, top}, "Speed, mm/s", step, curves, profile.seconds_each());
}

std::string axis_panel(const MotionProfile& profile,
                       const MachineLimits& limits,
                       unsigned axis,
                       double seconds)
{
    const auto share = [&](AxisVecd ProfileStretch::*member, AxisVecf limit) {
        return values_of(profile, [member, limit, axis](const ProfileStretch& s) {
            return kPercent * (s.*member)[axis] / static_cast<double>(limit[axis]);
        });
    };
    // The velocity is drawn last: the jerk alone would hide it.
    const std::vector<Curve> curves{
        {fmt::format("jerk, of {:g} mm/s³", limits.jerk[axis]), kJerkColour,
         share(&ProfileStretch::jerk, limits.jerk)},
        {fmt::format("acceleration, of {:g} mm/s²", limits.acceleration[axis]), kAccelerationColour,
         share(&ProfileStretch::acceleration, limits.acceleration)},
        {fmt::format("velocity, of {:g} mm/s", limits.velocity[axis]), kVelocityColour,
         share(&ProfileStretch::velocity, limits.velocity)}};
    constexpr std::array<char, kLinearAxes> kNames{'X', 'Y', 'Z'};
    constexpr double kUpper = 110;  // kRoundingNote
    constexpr double kStep = 50;
    const std::string title = fmt::format("{}, % of its limits", kNames.at(axis));
    return panel_of({static_cast<int>(axis) + 1, seconds, kUpper}, title, kStep, curves,
                    profile.seconds_each());
}

}  // namespace

std::string motion_picture(const MotionProfile& profile, const MachineLimits& limits)
{
    const double seconds = std::max(profile.seconds(), 1e-3);
    const double width = kLeft + kPlotWidth + kRight;
    const double height = kTop + 4 * (kPanelHeight + kGap) + kNoteHeight;
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
        "viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"sans-serif\" font-size=\"{:g}\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        width, height, width, height, kTextSize);
    out += speed_panel(profile, seconds);
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        out += axis_panel(profile, limits, axis, seconds);
    }
    out += text_at(kLeft, height - 8, "start", kRoundingNote);
    return out + "</svg>\n";
}

}  // namespace cusp::report
