// Cuts the stock run by run, and stores its heights after equal lengths of path.
#include "host_tools/judge/view/stock_frames.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

namespace cusp::view {

using job::Job;
using toolpath::Tool;
using verify::cut_earlier_programs;
using verify::earlier_positions;
using verify::HeightGrid;
using verify::MachinedStock;
using verify::ToolPositions;
using verify::UncutStock;

namespace {

constexpr std::size_t kFrames = 60;
constexpr double kMostPoints = 90000;
constexpr double kSteps = 65535;

const Tool& tool_of(const Job& job, int number)
{
    for (const Tool& tool : job.tools) {
        if (tool.number == number) {
            return tool;
        }
    }
    return job.tools.front();
}

// The heights quantised to whole steps.
std::vector<std::uint16_t> steps_of(const std::vector<double>& heights, double low, double high)
{
    std::vector<std::uint16_t> out(heights.size());
    const double scale = high > low ? kSteps / (high - low) : 0.0;
    std::transform(heights.begin(), heights.end(), out.begin(), [&](double z) {
        return static_cast<std::uint16_t>(std::lround(std::clamp((z - low) * scale, 0.0, kSteps)));
    });
    return out;
}

double lowest_tip(const CuttingPath& path, const Job& job, double top)
{
    double low = top;
    for (const ToolPositions& run : earlier_positions(job, kUnbounded)) {
        for (const Vec3d tip : run.tips) {
            // holes that another set-up has cut end at the bottom
            low = std::min(low, std::max(tip.z, job.stock_bottom.value_or(-kUnbounded)));
        }
    }
    for (const CuttingPath::Run& run : path.runs()) {
        for (const Vec3d tip : run.tips) {
            low = std::min(low, tip.z);
        }
    }
    return low;
}

}  // namespace

void CuttingPath::add(Vec3d tip, std::uint64_t tick, int tool, bool rapid)
{
    if (runs_.empty() || runs_.back().tool != tool) {
        runs_.push_back({tool, {}, {}, {}});
    }
    Run& run = runs_.back();
    if (!run.tips.empty() && norm(tip - run.tips.back()) < spacing_) {
        return;
    }
    run.tips.push_back(tip);
    run.rapid.push_back(rapid);
    run.ticks.push_back(tick);
}

HeightGrid coarse_grid(const HeightGrid& fine)
{
    const double points = static_cast<double>(fine.size());
    const auto times =
        static_cast<std::size_t>(std::max(1.0, std::ceil(std::sqrt(points / kMostPoints))));
    const double shift = (static_cast<double>(times) - 1) / 2 * fine.pitch;
    return {fine.x0 + shift,
            fine.y0 + shift,
            fine.pitch * static_cast<double>(times),
            std::max<std::size_t>(1, fine.nx / times),
            std::max<std::size_t>(1, fine.ny / times),
            false};
}

namespace {

Bytes framed(const HeightGrid& grid,
             double low,
             double high,
             const std::vector<double>& ticks,
             const Bytes& planes)
{
    Bytes out;
    out.put_u32(grid.nx);
    out.put_u32(grid.ny);
    out.put_u32(ticks.size() + 1);
    for (const double value : {grid.x0, grid.y0, grid.pitch, low, high}) {
        out.put_f64(value);
    }
    for (const double value : ticks) {
        out.put_f64(value);
    }
    out.put(deflated(planes.text()));
    return out;
}

}  // namespace

Bytes stock_frames(const CuttingPath& path, const Job& job, const HeightGrid& grid)
{
    const double high = job.stock_top;
    const double low = lowest_tip(path, job, high);
    std::size_t positions = 0;
    for (const CuttingPath::Run& run : path.runs()) {
        positions += run.tips.size();
    }
    const std::size_t each = std::max<std::size_t>(1, (positions + kFrames - 1) / kFrames);

    MachinedStock stock = UncutStock{job}.on(grid);
    // the page begins with stock everywhere
    std::vector<std::uint16_t> last = steps_of(std::vector<double>(grid.size(), high), low, high);
    std::vector<double> ticks;
    Bytes planes;
    const auto keep_frame = [&](std::uint64_t tick) {
        std::vector<std::uint16_t> now = steps_of(stock.heights(), low, high);
        for (unsigned plane = 0; plane < 2; ++plane) {
            for (std::size_t k = 0; k < now.size(); ++k) {
                planes.put_u8(static_cast<unsigned>(last[k] - now[k]) >> 8U * plane);
            }
        }
        last = std::move(now);
        ticks.push_back(static_cast<double>(tick));
    };
    cut_earlier_programs(job, grid.pitch, stock);
    if (stock.removed_volume() > 0 || !job.stock_outline.empty()) {
        keep_frame(0);
    }
    std::size_t left = each;
    std::uint64_t tick = 0;
    for (const CuttingPath::Run& run : path.runs()) {
        for (std::size_t begin = 0; begin < run.tips.size();) {
            const std::size_t end = std::min(run.tips.size(), begin + left);
            // Overlaps by one position: the flat of a cutter is swept from it.
            const auto from = static_cast<std::ptrdiff_t>(begin > 0 ? begin - 1 : 0);
            const auto to = static_cast<std::ptrdiff_t>(end);
            ToolPositions piece{tool_of(job, run.tool),
                                {run.tips.begin() + from, run.tips.begin() + to},
                                {run.rapid.begin() + from, run.rapid.begin() + to}};
            stock.cut(piece, grid.pitch, [](double) {});
            tick = run.ticks[end - 1];
            left -= end - begin;
            begin = end;
            if (left == 0) {
                keep_frame(tick);
                left = each;
            }
        }
    }
    if (left < each) {
        keep_frame(tick);
    }
    return framed(grid, low, high, ticks, planes);
}

}  // namespace cusp::view
