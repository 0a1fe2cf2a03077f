// A panel for each tool. Polylines of one colour each, so that the file of a long path is small.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "host_tools/judge/report/colour_scale.hpp"
#include "host_tools/judge/report/picture_frame.hpp"
#include "host_tools/judge/report/report.hpp"
#include "host_tools/judge/verify/cut_regions.hpp"
#include "host_tools/judge/verify/part_heights.hpp"

#include "fmt/format.h"

namespace cusp::report {

using job::Job;
using job::Operation;
using nurbs::Surface;
using toolpath::Tool;
using verify::append_points;
using verify::part_box;
using verify::PartBox;
using verify::Program;
using verify::ProgramMove;

namespace {

// mm between points: of curves, and of arcs, whose chords may be off by kSagitta.
constexpr double kSpacing = 0.5;
constexpr double kSagitta = 0.02;

std::vector<Vec3d> points_of(const path::Move& move)
{
    std::vector<Vec3d> points{xyz(to_millimetres(move.start))};
    double spacing = kSpacing;
    if (std::holds_alternative<path::Line>(move.path)) {
        spacing = kUnbounded;
    } else if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        spacing = std::max(kSpacing, std::sqrt(8 * arc->radius * kSagitta));
    }
    append_points(move, spacing, points);
    return points;
}

struct Extent {
    PictureFrame frame;
    double z_low, z_high;  // of what is cut
};

Extent extent_of(const Job& job, const Program& program)
{
    std::vector<Surface> surfaces;
    std::vector<std::array<Vec3d, 3>> mesh;
    for (const Operation& operation : job.operations) {
        surfaces.insert(surfaces.end(), operation.part.floor.begin(), operation.part.floor.end());
        mesh.insert(mesh.end(), operation.part.mesh.begin(), operation.part.mesh.end());
    }
    PartBox box = part_box(surfaces, mesh);
    if (const auto plan = verify::prismatic_box(job)) {
        box.x_low = std::min(box.x_low, plan->low.x);
        box.x_high = std::max(box.x_high, plan->high.x);
        box.y_low = std::min(box.y_low, plan->low.y);
        box.y_high = std::max(box.y_high, plan->high.y);
    }
    Extent extent{{box.x_low, box.x_high, box.y_low, box.y_high}, kUnbounded, -kUnbounded};
    for (std::size_t k = 1; k < program.moves.size(); ++k) {
        const path::Move& move = program.moves[k].move;
        if (move.kind == path::MoveKind::kRapid) {
            continue;
        }
        for (const Vec3d p : points_of(move)) {
            PictureFrame& f = extent.frame;
            f.x_low = std::min(f.x_low, p.x);
            f.x_high = std::max(f.x_high, p.x);
            f.y_low = std::min(f.y_low, p.y);
            f.y_high = std::max(f.y_high, p.y);
            extent.z_low = std::min(extent.z_low, p.z);
            extent.z_high = std::max(extent.z_high, p.z);
        }
    }
    extent.z_high = std::max(extent.z_low, std::min(extent.z_high, job.stock_top));
    return extent;
}

constexpr int kRapid = -1;

std::string rapid_stroke(const PictureFrame& frame)
{
    return fmt::format("stroke=\"#c03030\" stroke-width=\"{:.3f}\" stroke-dasharray=\"{:.3f}\"",
                       frame.line(), 5 * frame.line());
}

class PathLines {
public:
    PathLines(const PictureFrame& frame, std::string& out) : frame_{frame}, out_{out} {}

    // From a to b, in the colour of a step, or dashed for kRapid.
    void add(Vec3d a, Vec3d b, int step)
    {
        if (!open_ || step != step_) {
            close();
            const std::string stroke = step == kRapid
                                           ? rapid_stroke(frame_)
                                           : fmt::format("stroke=\"{}\" stroke-width=\"{:.3f}\"",
                                                         colour_of_step(step), frame_.line());
            out_ += fmt::format("<polyline fill=\"none\" {} points=\"", stroke);
            point(a);
            open_ = true;
            step_ = step;
        }
        point(b);
    }
    void close()
    {
        out_ += open_ ? "\"/>\n" : "";
        open_ = false;
    }

private:
    void point(Vec3d p) { out_ += fmt::format("{:.2f},{:.2f} ", p.x, frame_.flipped(p.y)); }

    const PictureFrame& frame_;
    std::string& out_;
    bool open_{false};
    int step_{0};
};

// T words of the tools that cut, in the order of their first cut; 0 where the program has none.
std::vector<int> cutting_tools(const Program& program)
{
    std::vector<int> tools;
    for (const ProgramMove& m : program.moves) {
        const bool cuts = m.move.kind != path::MoveKind::kRapid;
        if (cuts && std::find(tools.begin(), tools.end(), m.tool) == tools.end()) {
            tools.push_back(m.tool);
        }
    }
    return tools;
}

std::string title_of(const Job& job, int number)
{
    for (const Tool& tool : job.tools) {
        if (tool.number == number || number == 0) {
            return fmt::format("T{} {}", tool.number, tool_title(tool));
        }
    }
    return fmt::format("T{}", number);
}

void add_moves(const Program& program, int tool, const Extent& extent, std::string& out)
{
    PathLines lines{extent.frame, out};
    // the first move starts at an unknown position of the machine
    for (std::size_t k = 2; k < program.moves.size(); ++k) {
        const path::Move& move = program.moves[k].move;
        if (program.moves[k].tool != tool) {
            continue;
        }
        const std::vector<Vec3d> points = points_of(move);
        for (std::size_t i = 1; i < points.size(); ++i) {
            const double z = (points[i - 1].z + points[i].z) / 2;
            const int step = move.kind == path::MoveKind::kRapid
                                 ? kRapid
                                 : step_of(z, extent.z_low, extent.z_high);
            lines.add(points[i - 1], points[i], step);
        }
    }
    lines.close();
}

}  // namespace

std::string path_picture(const Job& job, const Program& program)
{
    Extent extent = extent_of(job, program);
    const std::vector<int> tools = cutting_tools(program);
    PictureFrame& frame = extent.frame;
    frame.panels = std::max(1, static_cast<int>(tools.size()));
    std::string out = frame.head();
    for (int k = 0; k < static_cast<int>(tools.size()); ++k) {
        const int tool = tools[static_cast<std::size_t>(k)];
        out += frame.panel(k, title_of(job, tool)) + walls(job, frame);
        add_moves(program, tool, extent, out);
        out += "</g>\n";
    }
    out += frame.ruler();
    out += frame.scale(extent.z_low, extent.z_high, "tip z, mm");
    out += frame.legend(0, rapid_stroke(frame), "rapid");
    return out + "</svg>\n";
}

}  // namespace cusp::report
