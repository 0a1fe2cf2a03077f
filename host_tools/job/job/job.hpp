// A job: what to cut, with which tool, how. Plain data, everything in millimetres; `import` reads
// it, strategies and `verify` take it.
//
//     job::Job job;
//     job.feed = 1200;  // mm/min
//     job::Operation finish;
//     finish.strategy = &adaptive_isocurve::kAdaptiveIsocurve;
//     finish.part.floor = surfaces;
//     finish.tool = {1, toolpath::ToolShape::kBall, 3.0, 3.0};
//     finish.tolerance.scallop = 0.02;
//     finish.tolerance.floor = finish.tolerance.plan = 0.01;
//     job.operations.push_back(finish);
//
// docs/job_file.md explains the keys of the file; each has a member here.
#pragma once

#include <any>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/toolpath/entry_kind.hpp"
#include "host_tools/geometry/toolpath/post.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/machine_tool.hpp"
#include "host_tools/job/job/prismatic_keys.hpp"
#include "host_tools/job/job/setup.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::job {

enum class OutputForm : std::uint8_t { kLines, kArcs, kNurbs };
enum class ToleranceSide : std::uint8_t { kOutside, kBoth };
enum class CutDirection : std::uint8_t { kClimb, kConventional };
using toolpath::EntryKind;
enum class Traversal : std::uint8_t { kZigzag, kOneWay };

// The tool fits nowhere into a pocket. Other pockets of the same drawing are still cut.
class PocketRefusal : public InputError {
public:
    using InputError::InputError;
};

// A closed chain of curves, in order, counter-clockwise seen from above; z is ignored.
using Loop = std::vector<nurbs::Curve>;

// The feed follows the engagement, so that the thickest chip stays that of half the diameter.
struct ChipLoad {
    std::optional<double> feed_min;  // mm/min; none: the feed
    std::optional<double> feed_max;  // none: twice the feed
};

// The part: surfaces or triangles, and the files that they come from.
struct CutPart {
    std::vector<nurbs::Surface> floor;
    std::vector<std::string> floor_files;
    // Files of the bodies that the floor was intersected with; `floor` is the result.
    std::vector<std::string> intersect_files;
    // The triangles, where all of the floor is STL and the strategy takes a mesh; `floor` is empty then.
    std::vector<std::array<Vec3d, 3>> mesh;
    // mm: how far triangles may be off surfaces that they stand for.
    double facet_error{};
};

// The loops in which it is cut, seen from above.
struct CutOutline {
    std::optional<Loop> boundary;
    std::string boundary_file;
    std::vector<Loop> islands;
    std::vector<std::string> island_files;
};

// How near the cut comes to the part; mm.
struct CutTolerance {
    double plan{};   // across walls
    double floor{};  // of the path against the floor
    // The floor's is a level floor's default, which a post's decimals make smaller for the path: fit_to_post.
    bool default_floor{false};
    ToleranceSide side{ToleranceSide::kOutside};
    std::optional<double> scallop;
    bool default_scallop{false};
    std::optional<double> join_gaps;  // of drawings; none: as `plan` and the drawing say
};

// How deep a layer goes; mm.
struct CutLevels {
    std::optional<double> max_depth;
    std::optional<double> min_depth;
    std::vector<double> layers;  // depths, below stock.top
};

// How the tool goes over an area or along a wall.
struct CutPasses {
    CutDirection direction_of_cut{CutDirection::kClimb};
    EntryKind entry{EntryKind::kAuto};
    Traversal traversal{Traversal::kZigzag};
    bool roughing{false};             // in levels, before the finish
    double allowance{};               // mm
    std::optional<double> step_over;  // mm, the most between passes
    // clearing = "adaptive": degrees
    std::optional<double> max_engagement;
    std::optional<ChipLoad> chip_load;
};

// Only what earlier programs leave is cut.
struct CutRest {
    std::vector<std::string> after;   // programs, beside those of the stock
    std::optional<double> tolerance;  // mm: stock thinner than this may stay
};

struct Operation {
    int number{1};  // its place in the job
    const Strategy* strategy{&kNoStrategy};
    CutPart part;
    CutOutline outline;
    toolpath::Tool tool;
    // Tools that rough, or from which the strategy chooses; otherwise `tool` alone.
    std::vector<toolpath::Tool> tools;
    OutputForm output{OutputForm::kLines};
    CutTolerance tolerance;
    CutLevels levels;
    CutPasses passes;
    CutRest rest;
    bool may_open{false};  // into what the other side of a stock that was turned over has cut
    // Keys of 2.5-D strategies; the floor and boundary of a pocket are set too.
    std::optional<Prismatic> prismatic;
    std::any parameters;  // the strategy's own: parameters_of()

    const std::string& name() const { return strategy->name; }
    bool cuts(Region region) const { return strategy->traits.region == region; }
};

// The strategy's own parameters, their default values where the operation has none.
// Throws std::bad_any_cast where it has those of another strategy.
template <class Parameters>
const Parameters& parameters_of(const Operation& operation)
{
    static const Parameters kDefault{};
    return operation.parameters.has_value() ? std::any_cast<const Parameters&>(operation.parameters)
                                            : kDefault;
}

// The same, to be changed.
template <class Parameters>
Parameters& parameters_of(Operation& operation)
{
    if (!operation.parameters.has_value()) {
        operation.parameters = Parameters{};
    }
    return std::any_cast<Parameters&>(operation.parameters);
}

// Fraction of an operation's progress at which roughing ends, where a finish follows.
inline constexpr double kRoughingDone = 0.5;

inline constexpr double kHolderClearance = 0.5;  // mm, where none is given

// Data of a tool's library besides shape and rates.
struct ToolFacts {
    std::string name;
    int flutes{};                        // 0: none given
    std::optional<double> flute_length;  // mm
    std::optional<double> length;        // mm, out of the holder
    // mm, of the shank from the flutes to the holder; only with flute_length
    std::optional<double> shank_diameter{};
    // Cylinders of the holder, each {diameter, length} in mm, from its lower face up; only with length.
    std::vector<std::array<double, 2>> holder{};
    double holder_clearance{kHolderClearance};  // mm, that shank and holder keep to stock
};

// A fixture that holds the stock: a box or a vertical cylinder, from the table to `top`. Neither tool nor
// shank comes nearer than `margin`.
struct Fixture {
    std::string name;
    Vec2d low;  // corners of a box; of a cylinder both are the centre
    Vec2d high;
    double radius{};  // mm, of a cylinder
    double top{};     // z
    double margin{};  // mm
};

inline constexpr double kLeastFloor = 0.5;  // mm, where none is given

struct Job {
    std::string file;
    bool inch{false};  // of the G-code written; everything in this struct is mm
    std::vector<toolpath::Tool> tools;
    double feed{};                        // mm/min
    double plunge_feed{};                 // mm/min
    double spindle{};                     // rpm
    std::map<int, ToolFacts> tool_facts;  // by number, of tools that have any
    toolpath::Post post;
    MachineTool machine;
    double stock_top{};
    // z of the highest point that operations without a boundary cut; no value: all have a boundary.
    std::optional<double> part_top;
    double clearance{};  // above stock_top
    std::optional<double> stock_bottom;
    double least_floor{kLeastFloor};  // mm, that is to be left between the cuts of two sides
    std::optional<std::array<double, 2>> stock_x;
    std::optional<std::array<double, 2>> stock_y;
    // All there is of the stock in plan: its outline, then its holes. stock_x and stock_y are its box
    // then. None: that box, or the parts'.
    std::vector<Loop> stock_outline;
    // Programs that have been cut before: the stock is what they leave.
    std::vector<std::string> stock_programs;
    // Likewise, in set-ups whose stock lay otherwise. If there are any, the stock has a box.
    std::vector<SetupProgram> turned_programs;
    // Texts of programs that are in no file, by the names that are used for them here.
    std::map<std::string, std::shared_ptr<const std::string>> programs;
    std::optional<Setup> setup;  // none: the job has no table of them
    std::vector<Fixture> fixtures;
    bool group_by_tool{true};
    std::vector<Operation> operations;
    std::vector<std::string> notes;  // sentences on what the readers left out or changed
    // Progress: planners call it repeatedly with the approximate fraction of an operation done, 0 to
    // 1; may be empty.
    std::function<void(double)> progress;

    // begun  fraction of the operation that was done before this part began
    void report_progress(double share, double begun = 0.0) const
    {
        if (progress) {
            progress(begun + (1.0 - begun) * share);
        }
    }
};

// Adds a program that was cut before, in the set-up `of` of the same job, to those of the stock.
//
// Precondition: the stock has a box where the two set-ups differ in their flip.
void add_earlier_program(Job& job, const Setup& of, const std::string& file);

// The rates of a tool, the job's where it has none of its own.
toolpath::CuttingRates rates_of(const Job& job, const toolpath::Tool& tool);

// Gives the path its tool, with the tool's rates and name.
void set_tool(toolpath::Toolpath& path, const Job& job, const toolpath::Tool& tool);

}  // namespace cusp::job
