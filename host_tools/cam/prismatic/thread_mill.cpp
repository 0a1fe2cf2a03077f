// One helix a pass for a single point, a turn a block of teeth else: onto the wall and off it in step with the pitch.
#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/hole_tour.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/job/job/hole_depth.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"
#include "host_tools/job/job/thread.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::CutDirection;
using job::Hole;
using job::Job;
using job::Operation;
using job::OutputForm;
using job::Thread;
using offset::arc_edge;
using offset::Edge;
using offset::line_edge;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;
using Kind = job::KeyKind;

namespace {

std::any read_thread_keys(const job::KeyValues& values,
                          const Operation& /*operation*/,
                          const job::Refuse& refuse)
{
    Thread thread;
    thread.text = values.find<std::string>("thread").value_or("");
    const auto form = job::thread_of_text(thread.text);
    if (!form) {
        refuse(
            "thread",
            thread.text.empty()
                ? std::string{"is missing: a designation such as \"M6\", \"M6x0.75\" or \"1/4-20\""}
                : fmt::format("is \"{}\", it must be a designation such as \"M6\", \"M6x0.75\" or "
                              "\"1/4-20\", no coarser than the coarse series",
                              thread.text));
    }
    thread.form = form.value();
    thread.oversize = values.get<double>("oversize");
    thread.teeth = static_cast<int>(values.get<double>("teeth"));
    thread.passes = static_cast<int>(values.get<double>("passes"));
    thread.left = values.get<bool>("left_handed");
    thread.outside = values.get<std::string>("side") == "outside";
    return thread;
}

void check_thread_mill(const Operation& operation, const job::Refuse& refuse)
{
    const Thread& thread = *thread_of(operation);
    check_sideways(operation, refuse);
    if (is_conical(operation.tool) || operation.tool.corner_radius > 0) {
        refuse("tool",
               fmt::format("tool {} is {}: a thread mill counts as a flat end as wide as its teeth",
                           operation.tool.number, name_of(operation.tool.shape)));
    }
    if (!thread.outside && 2 * operation.tool.radius >= thread.blank()) {
        refuse("tool", fmt::format("tool {} of {:g} mm does not go into the bore of {}, {:.3f} mm",
                                   operation.tool.number, 2 * operation.tool.radius, thread.text,
                                   thread.blank()));
    }
    job::need(!operation.prismatic->file.empty(), "boundary",
              "a drawing or a model with holes, such as \"plate.dxf#holes\"", operation, refuse);
}

// A way on or off the wall, in plan, and the turn of its azimuth about the thread's axis, radians.
struct Lead {
    Edge edge;
    double turn;
};

class ThreadPlanner {
public:
    ThreadPlanner(const Job& job, const Operation& operation)
        : job_{job},
          operation_{operation},
          thread_{*thread_of(operation)},
          tool_{operation.tool.radius},
          top_{operation.prismatic->top},
          above_{rapid_end(job, top_)},
          climbs_{operation.passes.direction_of_cut == CutDirection::kClimb},
          // The spindle turns clockwise: its mill climbs against the clock in a hole, and with it round a bolt.
          turn_{climbs_ == thread_.outside ? -1 : 1},
          rise_{(turn_ > 0) != thread_.left ? thread_.form.pitch : -thread_.form.pitch},
          form_{operation.output != OutputForm::kLines, operation.tolerance.plan / 2, climbs_,
                true},
          planned_{begun(job,
                         operation,
                         fmt::format("{} {}, {}",
                                     thread_.text,
                                     thread_.outside ? "outside" : "inside",
                                     counted(operation.prismatic->holes.size(), "place")))},
          writer_{planned_.path.moves, {job.stock_top + job.clearance}}
    {
    }

    PlannedOperation plan()
    {
        check_bores();
        const std::vector<Hole>& holes = operation_.prismatic->holes;
        for (const std::size_t k : hole_tour(holes)) {
            for (int pass = 1; pass <= thread_.passes; ++pass) {
                cut(holes[k], pass);
            }
        }
        writer_.retract();
        slow_down();
        count_moves(writer_, passes_, 1, planned_);
        planned_.stats.counts.emplace_back("holes", static_cast<double>(holes.size()));
        return planned_;
    }

private:
    // mm, of the axis: each pass takes an equal part of the triangle of the profile.
    double radius_of(int pass) const
    {
        const double blank = thread_.axis_radius(thread_.blank(), tool_);
        const double wall = thread_.axis_radius(thread_.wall(), tool_);
        return blank + (wall - blank) * std::sqrt(static_cast<double>(pass) / thread_.passes);
    }

    // The teeth leave the top by a quarter of a pitch. The lowest way onto the wall, or off it, begins at the bottom; blocks are
    // whole pitches apart.
    void cut(const Hole& hole, int pass)
    {
        const double bottom = tip_in_hole(*operation_.prismatic, hole, operation_.tool);
        constexpr double kOver = 0.25;
        constexpr double kRounding = 1e-9;
        const double pitch = thread_.form.pitch;
        const int turns = static_cast<int>(std::ceil((top_ - bottom) / pitch + kOver - kRounding));
        const int each = thread_.teeth;
        const int blocks = each == 1 ? 1 : (turns + each - 1) / each;
        for (int k = 0; k < blocks; ++k) {
            const int block = rise_ > 0 ? k : blocks - 1 - k;
            const double low = bottom +
                               lead(hole.at, radius_of(pass), true).turn / (2 * kPi) * pitch +
                               block * each * pitch;
            const int length = each == 1 ? turns : 1;
            const double first = rise_ > 0 ? low : low + length * pitch;
            helix(hole.at, radius_of(pass), first, length);
        }
        ++passes_;
    }

    void helix(Vec2d centre, double radius, double first, int turns)
    {
        const double last = first + turns * rise_;
        const Lead in = lead(centre, radius, true);
        const Lead out = lead(centre, radius, false);
        go_to(in.edge.start, first - in.turn / (2 * kPi) * rise_);
        write_edges({in.edge}, writer_.at().z, first, form_, writer_);
        const Vec2d right{centre.x + radius, centre.y};
        const Vec2d left{centre.x - radius, centre.y};
        std::vector<Edge> edges;
        for (int k = 0; k < turns; ++k) {
            edges.push_back(arc_edge(right, left, centre, turn_));
            edges.push_back(arc_edge(left, right, centre, turn_));
        }
        write_edges(edges, first, last, form_, writer_);
        write_edges({out.edge}, last, last + out.turn / (2 * kPi) * rise_, form_, writer_);
    }

    // In a hole half a circle from the middle, along which the azimuth grows as the way does; round a bolt the tangent,
    // from where the teeth are clear of the blank.
    Lead lead(Vec2d centre, double radius, bool in) const
    {
        const Vec2d wall{centre.x + radius, centre.y};
        if (!thread_.outside) {
            const Vec2d middle = 0.5 * (centre + wall);
            return {
                in ? arc_edge(centre, wall, middle, turn_) : arc_edge(wall, centre, middle, turn_),
                kPi / 2};
        }
        constexpr double kClear = 0.5;  // mm
        const double clear = thread_.axis_radius(thread_.blank(), tool_) + kClear;
        const double length = std::sqrt(clear * clear - radius * radius);
        const Vec2d aside{wall.x, wall.y + (in ? -turn_ : turn_) * length};
        return {in ? line_edge(aside, wall) : line_edge(wall, aside),
                elementary::atan(length / radius)};
    }

    // From the end of a block beside the wall straight to the next one's start, else over the stock.
    void go_to(Vec2d place, double z)
    {
        constexpr double kHere = 1e-6;
        const bool is_here = writer_.started() && norm(in_plan(writer_.at()) - place) < kHere;
        if (!is_here) {
            writer_.approach(place, above_);
        }
        writer_.line(is_here && z > writer_.at().z ? MoveKind::kRapid : MoveKind::kPlunge,
                     {place.x, place.y, z});
    }

    // The feed is that of the teeth at the wall: the axis of a mill in a hole is slower.
    void slow_down()
    {
        const double share = thread_.outside ? 1.0 : 1 - 2 * tool_ / thread_.wall();
        for (toolpath::ToolMove& move : planned_.path.moves) {
            if (move.kind == MoveKind::kCut || move.kind == MoveKind::kPlungingCut) {
                move.feed = share * planned_.path.feed;
            }
        }
    }

    // Holes of earlier operations at the same place; a mill can't drill.
    void check_bores()
    {
        if (thread_.outside || !job_.stock_programs.empty() || !operation_.rest.after.empty() ||
            job_.setup) {
            return;
        }
        std::size_t missing = 0;
        for (const Hole& hole : operation_.prismatic->holes) {
            const double bored = bored_before(hole.at);
            if (bored > 0 && bored < 2 * tool_) {
                throw InputError(fmt::format(
                    "{}the hole at x {:.6g} y {:.6g} is {:g} mm wide by then, tool {} is {:g} mm",
                    operation_text(job_, operation_), hole.at.x, hole.at.y, bored,
                    operation_.tool.number, 2 * tool_));
            }
            missing += bored > 0 ? 0 : 1;
        }
        if (missing > 0) {
            planned_.stats.warnings.push_back(fmt::format(
                "{}no operation before it makes {} of {:.4g} mm for {}: the tool goes down there",
                operation_text(job_, operation_), counted(missing, "hole"), thread_.blank(),
                thread_.text));
        }
    }

    // mm; 0: none.
    double bored_before(Vec2d at) const
    {
        constexpr double kSamePlace = 0.01;
        double widest = 0;
        for (const Operation& before : job_.operations) {
            if (before.number >= operation_.number || !before.cuts(job::Region::kHoles)) {
                continue;
            }
            for (const Hole& hole : before.prismatic->holes) {
                if (norm(hole.at - at) < kSamePlace) {
                    widest =
                        std::max(widest, 2 * radius_of_hole(*before.prismatic, hole, before.tool));
                }
            }
        }
        return widest;
    }

    const Job& job_;
    const Operation& operation_;
    const Thread& thread_;
    double tool_;
    double top_;
    double above_;
    bool climbs_;
    int turn_;
    double rise_;  // mm of a turn
    EdgeForm form_;
    PlannedOperation planned_;
    ToolpathWriter writer_;
    int passes_{0};
};

std::vector<PlannedOperation> plan_thread_mill(const Job& job, const Operation& operation)
{
    return {ThreadPlanner{job, operation}.plan()};
}

}  // namespace

const job::Strategy kThreadMill{
    "thread_mill",
    "screw threads in the holes of a drawing or of a model, or round its circles, along helices",
    job::shared_keys({"output", "direction_of_cut", "top", "may_open"}),
    {{"thread", Kind::kText, "needed", "`\"M6\"`, `\"M6x0.75\"`, `\"1/4-20\"`, `\"#10-32\"`"},
     job::choice("side", {"inside", "outside"}, "in holes, or round bolts"),
     {"depth", Kind::kLength, "needed; of a model that of each hole",
      "below `top`: of the tool's tip", job::kPositive},
     {"diameter", Kind::kInterval, "all",
      "only circles or holes of this diameter, or `[least, greatest]`; points are left out then",
      job::kPositive},
     {"teeth",
      Kind::kCount,
      "1",
      "pitches that the mill's teeth span; 1: a single point",
      {1, 100}},
     {"passes", Kind::kCount, "1", "to the full depth of the thread", {1, 20}},
     {"left_handed", Kind::kFlag, "false", "a left-hand thread"},
     {"oversize", Kind::kLength, "0", "on the thread's diameter, for its fit", {-1, 1}}},
    {job::Region::kHoles},
    read_thread_keys,
    check_thread_mill,
    plan_thread_mill};

}  // namespace cusp::prismatic
