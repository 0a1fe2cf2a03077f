// Helices about each hole's axis, from the middle outward, each down to the bottom; then the wall at once.
#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/hole_tour.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/job/job/hole_depth.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::CutDirection;
using job::Hole;
using job::Job;
using job::Operation;
using job::OutputForm;
using job::parameters_of;
using job::tip_in_hole;
using offset::arc_edge;
using offset::Edge;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;
using Kind = job::KeyKind;

namespace {

struct BoreKeys {
    std::optional<double> pitch;  // mm
};

std::any read_bore_keys(const job::KeyValues& values,
                        const Operation& /*operation*/,
                        const job::Refuse& /*refuse*/)
{
    return BoreKeys{values.number("pitch")};
}

void check_bore(const Operation& operation, const job::Refuse& refuse)
{
    check_sideways(operation, refuse);
    if (is_conical(operation.tool) || operation.tool.corner_radius >= operation.tool.radius) {
        refuse("tool", fmt::format("tool {} is {}: bore needs a flat or a bull end",
                                   operation.tool.number, name_of(operation.tool.shape)));
    }
    job::need(!operation.prismatic->file.empty(), "boundary",
              "a drawing or a model with holes, such as \"plate.dxf#holes\"", operation, refuse);
}

// Half turns about a centre, from the side of x and back to it.
std::vector<Edge> turns_about(Vec2d centre, double radius, int turn, int count)
{
    const Vec2d right{centre.x + radius, centre.y};
    const Vec2d left{centre.x - radius, centre.y};
    std::vector<Edge> edges;
    for (int k = 0; k < count; ++k) {
        edges.push_back(arc_edge(right, left, centre, turn));
        edges.push_back(arc_edge(left, right, centre, turn));
    }
    return edges;
}

class BorePlanner {
public:
    BorePlanner(const Job& job, const Operation& operation)
        : operation_{operation},
          top_{operation.prismatic->top},
          above_{rapid_end(job, top_)},
          turn_{operation.passes.direction_of_cut == CutDirection::kClimb ? 1 : -1},
          form_{operation.output != OutputForm::kLines, operation.tolerance.plan / 2, turn_ > 0},
          planned_{begun(job, operation, counted(operation.prismatic->holes.size(), "hole"))},
          writer_{planned_.path.moves, {job.stock_top + job.clearance}}
    {
    }

    PlannedOperation plan()
    {
        const std::vector<Hole>& holes = operation_.prismatic->holes;
        for (const std::size_t k : hole_tour(holes)) {
            bore(holes[k]);
        }
        writer_.retract();
        count_moves(writer_, passes_, 1, planned_);
        planned_.stats.counts.emplace_back("holes", static_cast<double>(holes.size()));
        warn_of_narrower_holes(operation_, planned_);
        return planned_;
    }

private:
    // mm of a turn: 3 degrees, but a tenth of the tool's diameter at least and half of it at most.
    double drop_of_turn(double radius) const
    {
        constexpr double kSlope = 0.0524;
        const double tool = operation_.tool.radius;
        return parameters_of<BoreKeys>(operation_)
            .pitch.value_or(std::clamp(2 * kPi * radius * kSlope, 0.2 * tool, tool));
    }

    void bore(const Hole& hole)
    {
        const double wall = hole.diameter / 2 - operation_.tool.radius;
        const double bottom = tip_in_hole(*operation_.prismatic, hole, operation_.tool);
        const double rough = wall - operation_.passes.allowance;
        writer_.approach(hole.at, above_);
        if (rough > 0) {
            // no pillar is left in the middle
            const double step =
                std::min(operation_.passes.step_over.value_or(operation_.tool.radius),
                         operation_.tool.radius);
            const int count = std::max(1, static_cast<int>(std::ceil(rough / step)));
            for (int k = 1; k <= count; ++k) {
                helix(hole.at, rough * k / count, bottom);
                rise(hole.at, k < count);
            }
        }
        if (rough <= 0) {
            helix(hole.at, wall, bottom);
            rise(hole.at, false);
        } else if (operation_.passes.allowance > 0) {
            finish(hole.at, wall, bottom);
        }
    }

    // Down to the bottom, and once around on it.
    void helix(Vec2d centre, double radius, double bottom)
    {
        writer_.line(MoveKind::kRapid, {centre.x + radius, centre.y, above_});
        writer_.line(MoveKind::kPlunge, {centre.x + radius, centre.y, top_});
        const int turns = static_cast<int>(
            std::max(1.0, std::ceil((top_ - bottom) / drop_of_turn(radius) - 1e-9)));
        write_edges(turns_about(centre, radius, turn_, turns), top_, bottom, form_, writer_);
        write_edges(turns_about(centre, radius, turn_, 1), bottom, bottom, form_, writer_);
        ++passes_;
    }

    // Off the wall, and up in the middle where another helix follows.
    void rise(Vec2d centre, bool goes_on)
    {
        writer_.line(MoveKind::kCut, {centre.x, centre.y, writer_.at().z});
        if (goes_on) {
            writer_.line(MoveKind::kRapid, {centre.x, centre.y, above_});
        }
    }

    // At the bottom from the middle onto the wall and off it on half circles.
    void finish(Vec2d centre, double radius, double bottom)
    {
        const Vec2d start{centre.x + radius, centre.y};
        const Vec2d middle = 0.5 * (centre + start);
        std::vector<Edge> edges{arc_edge(centre, start, middle, turn_)};
        for (const Edge& edge : turns_about(centre, radius, turn_, 1)) {
            edges.push_back(edge);
        }
        edges.push_back(arc_edge(start, centre, middle, turn_));
        write_edges(edges, bottom, bottom, form_, writer_);
        ++passes_;
    }

    const Operation& operation_;
    double top_;
    double above_;
    int turn_;
    EdgeForm form_;
    PlannedOperation planned_;
    ToolpathWriter writer_;
    int passes_{0};
};

std::vector<PlannedOperation> plan_bore(const Job& job, const Operation& operation)
{
    return {BorePlanner{job, operation}.plan()};
}

}  // namespace

const job::Strategy kBore{
    "bore",
    "holes of a drawing or of a model, of any diameter over the tool's, down a helix",
    job::shared_keys({"output", "direction_of_cut", "allowance", "step_over", "top", "may_open"}),
    {{"depth", Kind::kLength, "needed; of a model that of each hole",
      "below `top`: of the tool's tip", job::kPositive},
     {"diameter", Kind::kInterval, "all",
      "only circles or holes of this diameter, or `[least, greatest]`; points are left out then",
      job::kPositive},
     {"pitch", Kind::kLength, "a slope of 3 degrees", "of a helix: the most that a turn descends",
      job::kPositive}},
    {job::Region::kHoles},
    read_bore_keys,
    check_bore,
    plan_bore};

}  // namespace cusp::prismatic
