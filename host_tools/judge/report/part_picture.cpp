// Heights on a grid of some 300 squares along the longer side; loops as filled lines.
#include "host_tools/judge/report/part_picture.hpp"

#include <array>
#include <cmath>

#include "host_tools/judge/report/colour_runs.hpp"
#include "host_tools/judge/report/colour_scale.hpp"
#include "host_tools/judge/report/picture_frame.hpp"
#include "host_tools/judge/verify/part_heights.hpp"

namespace cusp::report {

using job::ClosedLoop;
using job::OpenChain;
using job::PartLayer;
using part_info::BallReach;
using part_info::Ground;
using part_info::kLevelDegrees;
using part_info::PartInfo;
using verify::HeightGrid;
using verify::PartHeights;

namespace {

constexpr double kSquares = 300;  // along the longer side
constexpr int kShades = 12;

std::string label(const PictureFrame& frame, Vec2d at, const std::string& text, const char* colour)
{
    return fmt::format(
        "<text x=\"{:.3f}\" y=\"{:.3f}\" font-size=\"{:.3f}\" font-family=\"sans-serif\" "
        "fill=\"{}\" stroke=\"white\" stroke-width=\"{:.3f}\" paint-order=\"stroke\">{}</text>\n",
        at.x + 8 * frame.line(), frame.flipped(at.y) - 8 * frame.line(), 18 * frame.line(), colour,
        4 * frame.line(), text);
}

// radius  mm
std::string ring(const PictureFrame& frame, Vec2d at, double radius, const char* colour)
{
    return fmt::format(
        "<circle cx=\"{:.3f}\" cy=\"{:.3f}\" r=\"{:.3f}\" fill=\"none\" stroke=\"{}\" "
        "stroke-width=\"{:.3f}\"/>\n",
        at.x, frame.flipped(at.y), radius, colour, 2 * frame.line());
}

std::string mark(const PictureFrame& frame, Vec3d at, const std::string& text)
{
    const Vec2d place = in_plan(at);
    return ring(frame, place, 6 * frame.line(), "white") +
           ring(frame, place, 8 * frame.line(), "black") + label(frame, place, text, "black");
}

// Shade relative to a horizontal surface, 0 to kShades.
int shade_of(double lean_x, double lean_y, double cosine)
{
    // light from the upper left, 45 degrees high
    const double light = (-0.5 * lean_x + 0.5 * lean_y) + std::sqrt(0.5) * cosine;
    return std::clamp(static_cast<int>(std::lround((std::sqrt(0.5) - light) * kShades)), 0,
                      kShades);
}

std::string ground_picture(const PartInfo& info, const PictureFrame& frame)
{
    HeightGrid grid;
    grid.pitch = std::max(frame.width(), frame.height()) / kSquares;
    grid.nx = std::max<std::size_t>(1, static_cast<std::size_t>(frame.width() / grid.pitch));
    grid.ny = std::max<std::size_t>(1, static_cast<std::size_t>(frame.height() / grid.pitch));
    grid.x0 = frame.x_low + grid.pitch / 2;
    grid.y0 = frame.y_low + grid.pitch / 2;
    grid.shifted = false;
    const PartHeights heights = part_heights(info.part.surfaces, info.part.triangles, grid);
    const double low = info.part.box_low.z;
    const double high = info.part.box_high.z;
    ColourRuns colours{kColourSteps};
    ColourRuns shades{kShades + 1};
    for (std::size_t i = 0; i < grid.nx; ++i) {
        for (std::size_t j = 0; j < grid.ny; ++j) {
            const std::size_t k = grid.index(i, j);
            const bool uncovered = std::isnan(heights.z[k]);
            colours.add(i, j, uncovered ? ColourRuns::kNothing : step_of(heights.z[k], low, high));
            const auto lean = heights.lean[k];
            const int shade = shade_of(static_cast<double>(lean[0]), static_cast<double>(lean[1]),
                                       heights.cosine[k]);
            shades.add(i, j, uncovered || shade == 0 ? ColourRuns::kNothing : shade);
        }
    }
    const double y = frame.flipped(frame.y_low);
    std::string out = colours.text(frame.x_low, y, grid.pitch, [](int step) {
        return "stroke=\"" + colour_of_step(step) + "\"";
    });
    constexpr double kDarkest = 0.6;
    out += shades.text(frame.x_low, y, grid.pitch, [](int shade) {
        return fmt::format("stroke=\"black\" stroke-opacity=\"{:.3f}\"",
                           kDarkest * shade / kShades);
    });
    return out + frame.scale(low, high, "height, mm");
}

std::string marks_of(const PartInfo& info, const PictureFrame& frame)
{
    std::string out;
    const Ground& ground = *info.ground;
    if (ground.steepest_slope && *ground.steepest_slope > kLevelDegrees) {
        out += mark(frame, ground.steepest_slope_at,
                    fmt::format("steepest, {:.1f} degrees", *ground.steepest_slope));
    }
    if (ground.hidden_at && ground.hidden_area > 0) {
        out += mark(frame, *ground.hidden_at, "undercut");
    }
    if (const BallReach& ball = *info.ball; ball.radius) {
        out += ball.corner ? mark(frame, ball.at, "sharp corner")
                           : mark(frame, ball.at, fmt::format("ball {:.3g} mm", 2 * *ball.radius)) +
                                 ring(frame, in_plan(ball.at), *ball.radius, "black");
    }
    return out;
}

std::string line_of(const PictureFrame& frame,
                    const std::vector<Vec2d>& outline,
                    const std::string& paint)
{
    std::string out =
        fmt::format("<polyline {} stroke-width=\"{:.3f}\" points=\"", paint, 2 * frame.line());
    for (const Vec2d p : outline) {
        out += fmt::format("{:.3f},{:.3f} ", p.x, frame.flipped(p.y));
    }
    return out + "\"/>\n";
}

std::string layer_picture(const PartLayer& layer, const PictureFrame& frame)
{
    constexpr std::array<const char*, 2> kFills{"#bcd4ee", "#ffffff"};
    std::string lines;
    std::string labels;
    // Larger loops first, so that inner loops are drawn over them.
    for (std::size_t k = 0; k < layer.loops.loops.size(); ++k) {
        const ClosedLoop& loop = layer.loops.loops[k];
        const bool hole = loop.depth % 2 == 1;
        lines += line_of(frame, loop.outline,
                         fmt::format("fill=\"{}\" stroke=\"{}\"", kFills[hole ? 1 : 0],
                                     hole ? "#b05a00" : "#123a6b"));
        labels += label(frame, loop.outline.front(), fmt::format("{}", k + 1),
                        hole ? "#b05a00" : "#123a6b");
    }
    for (const OpenChain& chain : layer.loops.open) {
        lines += line_of(frame, chain.outline, "fill=\"none\" stroke=\"red\"");
        labels += ring(frame, chain.begin, 5 * frame.line(), "red") +
                  ring(frame, chain.end, 5 * frame.line(), "red");
    }
    return lines + labels;
}

}  // namespace

std::string part_picture(const PartInfo& info)
{
    const PictureFrame frame{info.part.box_low.x, info.part.box_high.x, info.part.box_low.y,
                             info.part.box_high.y};
    std::string out = frame.head();
    if (info.is_drawing()) {
        const bool all_hidden = std::all_of(info.part.layers.begin(), info.part.layers.end(),
                                            [](const PartLayer& layer) { return layer.hidden; });
        for (const PartLayer& layer : info.part.layers) {
            out += layer.hidden && !all_hidden ? "" : layer_picture(layer, frame);
        }
    } else {
        out += ground_picture(info, frame) + marks_of(info, frame);
    }
    return out + frame.ruler() + "</svg>\n";
}

}  // namespace cusp::report
