// The viewBox is in mm, so that every picture is to scale.
#include "host_tools/judge/report/picture_frame.hpp"

#include "host_tools/job/job/loop_shape.hpp"
#include "host_tools/judge/report/colour_scale.hpp"

#include "fmt/format.h"

namespace cusp::report {

using job::Job;
using job::Loop;
using job::loop_polyline;
using job::Operation;
using toolpath::Tool;

namespace {

constexpr int kPixels = 900;      // of a picture with one panel
constexpr double kScaleRoom = 9;  // width beside the panels, in heights of text

std::string text_at(double x, double y, double size, const std::string& text)
{
    return fmt::format(
        "<text x=\"{:.3f}\" y=\"{:.3f}\" font-size=\"{:.3f}\" "
        "font-family=\"sans-serif\">{}</text>\n",
        x, y, size, text);
}

}  // namespace

double PictureFrame::line() const { return std::max(width(), height()) / kPixels; }

std::string PictureFrame::head() const
{
    const double m = margin();
    const double one = width() + 2 * m + kScaleRoom * text();
    const double w = one + (panels - 1) * stride();
    const double h = height() + 5 * m;
    const double pixels = kPixels * w / one;
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
        "viewBox=\"{:.3f} {:.3f} {:.3f} {:.3f}\">\n"
        "<rect x=\"{:.3f}\" y=\"{:.3f}\" width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        pixels, pixels * h / w, x_low - m, y_low - 2 * m, w, h, x_low - m, y_low - 2 * m);
}

std::string PictureFrame::panel(int number, const std::string& title) const
{
    return fmt::format("<g transform=\"translate({:.3f} 0)\">\n", number * stride()) +
           text_at(x_low, y_low - 0.6 * margin(), text(), title);
}

std::string PictureFrame::ruler() const
{
    const double length = round_below(width() / 4);
    const double y = y_high + 1.2 * margin();
    const double tick = 0.25 * margin();
    return fmt::format(
               "<path fill=\"none\" stroke=\"black\" stroke-width=\"{:.3f}\" "
               "d=\"M{:.3f} {:.3f}v{:.3f}h{:.3f}v{:.3f}\"/>\n",
               1.5 * line(), x_low, y, tick, length, -tick) +
           text_at(x_low, y + tick + 1.1 * text(), text(), fmt::format("{:g} mm", length));
}

std::string PictureFrame::scale(double low, double high, const std::string& title) const
{
    // room for ten numbers
    const double size = std::min(0.8 * text(), height() / 14);
    return scale_bar({scale_x(), y_low, scale_height(), size}, low, high, title);
}

std::string PictureFrame::legend(int row, const std::string& stroke, const std::string& title) const
{
    const double y = y_low + 0.86 * height() + 1.6 * row * text();
    const double length = 1.5 * margin();
    return fmt::format("<path fill=\"none\" {} d=\"M{:.3f} {:.3f}h{:.3f}\"/>\n", stroke, scale_x(),
                       y, length) +
           text_at(scale_x() + length + 0.4 * margin(), y + 0.35 * text(), text(), title);
}

std::string tool_title(const Tool& tool)
{
    return fmt::format("{} {:g} mm", name_of(tool.shape), 2 * tool.radius);
}

std::string walls(const Job& job, const PictureFrame& frame)
{
    constexpr double kChord = 0.01;
    std::string out;
    const auto add = [&](const Loop& loop) {
        out += fmt::format(
            "<polyline fill=\"none\" stroke=\"black\" stroke-width=\"{:.3f}\" points=\"",
            2 * frame.line());
        for (const Vec2d p : loop_polyline(loop, kChord)) {
            out += fmt::format("{:.3f},{:.3f} ", p.x, frame.flipped(p.y));
        }
        out += "\"/>\n";
    };
    for (const Operation& operation : job.operations) {
        if (operation.outline.boundary) {
            add(*operation.outline.boundary);
        }
        std::for_each(operation.outline.islands.begin(), operation.outline.islands.end(), add);
    }
    return out;
}

}  // namespace cusp::report
