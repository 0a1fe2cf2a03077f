// Merges cells of one colour along columns.
#include <cmath>
#include <optional>
#include <vector>

#include "host_tools/judge/report/colour_runs.hpp"
#include "host_tools/judge/report/colour_scale.hpp"
#include "host_tools/judge/report/picture_frame.hpp"
#include "host_tools/judge/report/report.hpp"

#include "fmt/format.h"

namespace cusp::report {

using job::Job;
using verify::HeightGrid;
using verify::Verification;

namespace {

// Colours beside the scale: not cut, or higher than the bound.
constexpr int kUncut = kColourSteps;
constexpr int kOver = kColourSteps + 1;
constexpr const char* kOverColour = "#d7191c";
constexpr std::size_t kMostCells = 400;  // along the longer side of the picture

// The highest value of a square of grid points; an uncut point counts as the highest.
int step_of_square(
    const Verification& result, std::size_t i0, std::size_t j0, std::size_t size, double highest)
{
    std::optional<double> most;
    for (std::size_t i = i0; i < std::min(result.grid.nx, i0 + size); ++i) {
        for (std::size_t j = j0; j < std::min(result.grid.ny, j0 + size); ++j) {
            const double left = result.left[result.grid.index(i, j)];
            if (!std::isnan(left)) {
                most = std::max(most.value_or(left), left);
            }
        }
    }
    if (!most) {
        return ColourRuns::kNothing;
    }
    return std::isinf(*most) ? kUncut : *most > highest ? kOver : step_of(*most, 0, highest);
}

}  // namespace

std::string left_picture(const Job& job, const Verification& result)
{
    const HeightGrid& grid = result.grid;
    const double half = grid.pitch / 2;
    const PictureFrame frame{
        grid.x0 - half, grid.x0 + static_cast<double>(grid.nx) * grid.pitch - half, grid.y0 - half,
        grid.y0 + static_cast<double>(grid.ny) * grid.pitch - half};
    const std::size_t size =
        std::max<std::size_t>(1, (std::max(grid.nx, grid.ny) + kMostCells - 1) / kMostCells);
    const double highest =
        result.figures.scallop_bound.value_or(std::max(1e-3, result.figures.scallop_p99));
    ColourRuns runs{kColourSteps + 2};
    bool any_over = false;
    const double side = static_cast<double>(size) * grid.pitch;
    for (std::size_t i = 0; i < grid.nx; i += size) {
        for (std::size_t j = 0; j < grid.ny; j += size) {
            const int step = step_of_square(result, i, j, size, highest);
            any_over = any_over || step == kOver;
            runs.add(i / size, j / size, step);
        }
    }
    std::string out = frame.head() + frame.panel(0, "Stock left above the reachable height");
    out += runs.text(frame.x_low, frame.flipped(frame.y_low), side,
                     [](int k) {
                         return "stroke=\"" +
                                (k == kUncut  ? std::string{"black"}
                                 : k == kOver ? std::string{kOverColour}
                                              : colour_of_step(k)) +
                                "\"";
                     }) +
           walls(job, frame) + "</g>\n";
    out += frame.ruler();
    const char* bound = result.figures.scallop_bound ? "scallop bound" : "99 % of the floor";
    out += frame.scale(0, highest, "left, mm");
    int row = 0;
    const auto legend = [&](const char* colour, const std::string& title) {
        out += frame.legend(
            row++, fmt::format("stroke=\"{}\" stroke-width=\"{:.3f}\"", colour, frame.text()),
            title);
    };
    legend(colour_of_step(kColourSteps - 1).c_str(), fmt::format("{:.3g}: {}", highest, bound));
    if (any_over) {
        legend(kOverColour, fmt::format("to {:.3g}", result.figures.scallop_max));
    }
    if (result.figures.uncut_share > 0) {
        legend("black", "uncut");
    }
    return out + "</svg>\n";
}

}  // namespace cusp::report
