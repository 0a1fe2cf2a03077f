// A panel for each tool. A stretch over the limit has a wide red edge, its own colour between.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host_tools/judge/report/colour_scale.hpp"
#include "host_tools/judge/report/picture_frame.hpp"
#include "host_tools/judge/report/report.hpp"

#include "fmt/format.h"

namespace cusp::report {

using job::Job;
using verify::EngagementFigures;
using verify::EngagementRun;
using verify::StepKind;
using verify::ToolPositions;
using verify::Verification;

namespace {

constexpr double kMostDegrees = 180.0;
constexpr double kStretch = 0.5;  // mm: one colour, that of its greatest engagement
constexpr double kChord = 0.02;   // mm between the path and its picture
// Lines after the steps of the scale: these over the limit, and those without a colour of it.
constexpr int kStepsOver = kColourSteps;
constexpr int kAirLine = 2 * kColourSteps;
constexpr int kEntryLine = kAirLine + 1;
constexpr int kOverLine = kAirLine + 2;
constexpr int kNoLine = -1;
constexpr std::size_t kLines = kAirLine + 3;

std::string stroke_of(int line, const PictureFrame& frame)
{
    const double width = frame.line();
    switch (line) {
        case kAirLine:
            return fmt::format("stroke=\"#b0b0b0\" stroke-width=\"{:.3f}\"", width / 2);
        case kEntryLine:
            return fmt::format(
                "stroke=\"black\" stroke-width=\"{:.3f}\" stroke-dasharray=\"{:.3f}\"", width,
                2 * width);
        case kOverLine:
            return fmt::format("stroke=\"#d7191c\" stroke-width=\"{:.3f}\"", 6 * width);
        default:
            return fmt::format("stroke=\"{}\" stroke-width=\"{:.3f}\"",
                               colour_of_step(line % kColourSteps), 3 * width);
    }
}

// Lines of one kind are one path, so that the file of a long program is small.
class LinesByKind {
public:
    explicit LinesByKind(const PictureFrame& frame) : frame_{frame} {}

    void begin_run() { ends_.fill(kNowhere); }

    // The way from `begin` to `end` of a run's tips.
    void add(const std::vector<Vec3d>& tips, std::size_t begin, std::size_t end, int line)
    {
        const auto number = static_cast<std::size_t>(line);
        std::string& path = paths_[number];
        if (ends_[number] != begin) {
            path += 'M';
            point(tips[begin], path);
        }
        ends_[number] = end;
        for (std::size_t from = begin; from < end;) {
            const std::size_t to = end_of_chord(tips, from, end);
            path += 'L';
            point(tips[to], path);
            from = to;
        }
    }

    std::string text() const
    {
        std::string out;
        const auto draw = [&](int line) {
            const std::string& path = paths_[static_cast<std::size_t>(line)];
            if (!path.empty()) {
                out += fmt::format("<path fill=\"none\" {} d=\"{}\"/>\n", stroke_of(line, frame_),
                                   path);
            }
        };
        draw(kAirLine);
        for (int step = 0; step < kColourSteps; ++step) {
            draw(step);
        }
        draw(kOverLine);
        for (int step = 0; step < kColourSteps; ++step) {
            draw(kStepsOver + step);
        }
        draw(kEntryLine);
        return out;
    }

private:
    static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

    void point(Vec3d p, std::string& path) const
    {
        path += fmt::format("{:.2f},{:.2f}", p.x, frame_.flipped(p.y));
    }

    // The last of the next tips that a straight line from `from` passes within kChord of all.
    static std::size_t end_of_chord(const std::vector<Vec3d>& tips,
                                    std::size_t from,
                                    std::size_t end)
    {
        constexpr std::size_t kMost = 64;
        std::size_t to = from + 1;
        for (; to < end && to - from < kMost; ++to) {
            const Vec2d way{tips[to + 1].x - tips[from].x, tips[to + 1].y - tips[from].y};
            const double length = norm(way);
            for (std::size_t k = from + 1; k <= to; ++k) {
                const Vec2d p{tips[k].x - tips[from].x, tips[k].y - tips[from].y};
                const double away =
                    length > 0 ? std::abs(way.x * p.y - way.y * p.x) / length : norm(p);
                if (away > kChord || dot(p, way) < 0) {
                    return to;
                }
            }
        }
        return to;
    }

    const PictureFrame& frame_;
    std::array<std::string, kLines> paths_;
    std::array<std::size_t, kLines> ends_{};  // of each kind's last line
};

int line_of(StepKind kind, double angle, bool is_over)
{
    switch (kind) {
        case StepKind::kRapid:
            return kNoLine;
        case StepKind::kAir:
            return kAirLine;
        case StepKind::kEntry:
            return kEntryLine;
        case StepKind::kCut:
            break;
    }
    return (is_over ? kStepsOver : 0) + step_of(angle, 0, kMostDegrees);
}

// Stretches of one kind, at most kStretch long where the tool cuts.
void add_run(const ToolPositions& run, const EngagementRun& found, LinesByKind& lines)
{
    const double over = found.counts_over;
    const std::size_t count = run.tips.size();
    for (std::size_t k = 1; k < count;) {
        const StepKind kind = found.kinds[k];
        const bool is_over = static_cast<double>(found.angles[k]) > over;
        const std::size_t begin = k - 1;
        double most = 0;
        double length = 0;
        for (; k < count && found.kinds[k] == kind; ++k) {
            const auto angle = static_cast<double>(found.angles[k]);
            const bool is_full = kind == StepKind::kCut && length >= kStretch;
            if (is_full || (angle > over) != is_over) {
                break;
            }
            most = std::max(most, angle);
            length += norm(run.tips[k] - run.tips[k - 1]);
        }
        const int line = line_of(kind, most, is_over);
        if (line != kNoLine) {
            lines.add(run.tips, begin, k - 1, line);
        }
        if (is_over) {
            lines.add(run.tips, begin, k - 1, kOverLine);
        }
    }
}

bool has_feed(const EngagementRun& found)
{
    return std::any_of(found.kinds.begin(), found.kinds.end(),
                       [](StepKind kind) { return kind != StepKind::kRapid; });
}

// Numbers of the tools that move at a feed, in the order of their first.
std::vector<int> moving_tools(const Verification& result)
{
    std::vector<int> tools;
    for (std::size_t k = 0; k < result.positions.size(); ++k) {
        const int number = result.positions[k].tool.number;
        if (has_feed(result.engagement[k]) &&
            std::find(tools.begin(), tools.end(), number) == tools.end()) {
            tools.push_back(number);
        }
    }
    return tools;
}

PictureFrame frame_of(const Verification& result)
{
    const verify::HeightGrid& grid = result.grid;
    const double half = grid.pitch / 2;
    PictureFrame frame{grid.x0 - half, grid.x0 + static_cast<double>(grid.nx) * grid.pitch - half,
                       grid.y0 - half, grid.y0 + static_cast<double>(grid.ny) * grid.pitch - half};
    for (std::size_t run = 0; run < result.positions.size(); ++run) {
        const auto& tips = result.positions[run].tips;
        for (std::size_t k = 1; k < tips.size(); ++k) {
            if (result.engagement[run].kinds[k] != StepKind::kRapid) {
                frame.x_low = std::min(frame.x_low, tips[k].x);
                frame.x_high = std::max(frame.x_high, tips[k].x);
                frame.y_low = std::min(frame.y_low, tips[k].y);
                frame.y_high = std::max(frame.y_high, tips[k].y);
            }
        }
    }
    return frame;
}

std::string legends(const PictureFrame& frame, const EngagementFigures& figures)
{
    std::string out = frame.scale(0, kMostDegrees, "engagement, degrees");
    int row = 0;
    if (figures.limit) {
        const double length = 0.6 * frame.margin();
        out += fmt::format("<path fill=\"none\" {} d=\"M{:.3f} {:.3f}h{:.3f}\"/>\n",
                           stroke_of(kOverLine, frame), frame.scale_x() - length,
                           frame.scale_y(*figures.limit / kMostDegrees), length);
        out += frame.legend(row++, stroke_of(kOverLine, frame),
                            fmt::format("over {:.4g}°", *figures.limit));
    }
    out += frame.legend(row++, stroke_of(kEntryLine, frame), "entry");
    return out + frame.legend(row, stroke_of(kAirLine, frame), "air");
}

}  // namespace

std::string engagement_picture(const Job& job, const Verification& result)
{
    PictureFrame frame = frame_of(result);
    const std::vector<int> tools = moving_tools(result);
    frame.panels = std::max(1, static_cast<int>(tools.size()));
    std::string out = frame.head();
    for (int panel = 0; panel < static_cast<int>(tools.size()); ++panel) {
        const int number = tools[static_cast<std::size_t>(panel)];
        LinesByKind lines{frame};
        std::string title;
        for (std::size_t k = 0; k < result.positions.size(); ++k) {
            const ToolPositions& run = result.positions[k];
            if (run.tool.number == number) {
                title = fmt::format("T{} {}", number, tool_title(run.tool));
                lines.begin_run();
                add_run(run, result.engagement[k], lines);
            }
        }
        out += frame.panel(panel, title) + walls(job, frame) + lines.text() + "</g>\n";
    }
    return out + frame.ruler() + legends(frame, *result.figures.engagement) + "</svg>\n";
}

}  // namespace cusp::report
