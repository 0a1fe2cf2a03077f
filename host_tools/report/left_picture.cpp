// Cells of the map, merged along columns where their colours agree.
#include <array>
#include <cmath>
#include <vector>

#include "host_tools/report/colour_scale.hpp"
#include "host_tools/report/picture_frame.hpp"
#include "host_tools/report/pictures.hpp"

#include "fmt/format.h"

namespace cusp::host {
namespace {

constexpr int kNothing = -1;
constexpr int kUncut = -2;
constexpr std::size_t kMostCells = 400;  // along the longer side of the picture

// The highest of the values of a square of grid points; an uncut one beats all.
int step_of_square(
    const Verification& result, std::size_t i0, std::size_t j0, std::size_t size, double highest)
{
    double most = -1e300;
    bool any = false;
    for (std::size_t i = i0; i < std::min(result.grid.nx, i0 + size); ++i) {
        for (std::size_t j = j0; j < std::min(result.grid.ny, j0 + size); ++j) {
            const double left = result.left[result.grid.index(i, j)];
            if (!std::isnan(left)) {
                any = true;
                most = std::max(most, left);
            }
        }
    }
    if (!any) {
        return kNothing;
    }
    return std::isinf(most) ? kUncut : step_of(most, 0, highest);
}

// Runs of squares of one colour as strokes of a single path, in whole numbers of squares: a tenth
// of the text of single rectangles.
class Runs {
public:
    void add(std::size_t column, std::size_t begin, std::size_t end, int step)
    {
        paths_[static_cast<std::size_t>(step == kUncut ? kColourSteps : step)] +=
            fmt::format("M{} {}v{}", column, begin, end - begin);
    }

    // x, y  of the lower left corner of the first square, `side` of a square, in the picture
    std::string text(double x, double y, double side) const
    {
        constexpr double kOverlap = 1.05;  // no gaps between neighbours
        std::string out = fmt::format(
            "<g transform=\"translate({:.4f} {:.4f}) scale({:.6f} {:.6f})\" fill=\"none\" "
            "stroke-width=\"{}\">\n",
            x + side / 2, y, side, -side, kOverlap);
        for (std::size_t k = 0; k < paths_.size(); ++k) {
            const std::string colour =
                k == kColourSteps ? "black" : colour_of_step(static_cast<int>(k));
            if (!paths_[k].empty()) {
                out += fmt::format("<path stroke=\"{}\" d=\"{}\"/>\n", colour, paths_[k]);
            }
        }
        return out + "</g>\n";
    }

private:
    std::array<std::string, kColourSteps + 1> paths_;
};

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
    Runs runs;
    const double side = static_cast<double>(size) * grid.pitch;
    for (std::size_t i = 0; i < grid.nx; i += size) {
        std::size_t begin = 0;
        int current = kNothing;
        for (std::size_t j = 0; j < grid.ny + size; j += size) {
            const int step = j < grid.ny ? step_of_square(result, i, j, size, highest) : kNothing;
            if (step == current) {
                continue;
            }
            if (current != kNothing) {
                runs.add(i / size, begin / size, j / size, current);
            }
            begin = j;
            current = step;
        }
    }
    std::string out = frame.head() + frame.panel(0, "Metal left over what the tool reaches");
    out += runs.text(frame.x_low, frame.flipped(frame.y_low), side) + walls(job, frame) + "</g>\n";
    out += frame.ruler();
    out += scale_bar(frame.scale_x(), frame.y_low, 0.75 * frame.height(), 0, highest, "left, mm");
    if (result.figures.uncut_share > 0) {
        out += frame.legend(
            0, fmt::format("stroke=\"black\" stroke-width=\"{:.3f}\"", frame.text()), "uncut");
    }
    return out + "</svg>\n";
}

}  // namespace cusp::host
