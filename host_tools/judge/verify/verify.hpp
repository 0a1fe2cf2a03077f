// Verification: cuts a job's stock with a program in memory, and compares the stock left with the
// part.
//
//     const Verification result = verify(job, "part.ngc", {}, [](double) {});
//     for (const std::string& bound : result.broken) { fmt::print("broken: {}\n", bound); }
//     result.figures.gouge_max;  // mm; result.left is the map of the stock left
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/between_sides.hpp"
#include "host_tools/judge/verify/engagement.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/part_heights.hpp"
#include "host_tools/judge/verify/program_moves.hpp"
#include "host_tools/judge/verify/tool_contact.hpp"

namespace cusp::verify {

struct VerifySettings {
    std::optional<double> pitch;    // mm between heights; else 0.173 and fine enough for the tools
    std::optional<double> spacing;  // mm between tool positions; else 0.1, likewise
    bool engagement{false};         // look for it too
    std::optional<double> max_engagement;  // degrees, of all tools; else that of the operations
};

// Stock left over the surface that the tools can cut.
struct ThickestLeft {
    double thickness;  // mm, the shortest distance through it
    Vec3d place;       // the lowest point that the tools can reach there
};

// Stock left where a 2.5-D operation clears a level.
struct LevelLeft {
    double height;  // mm over what it cuts
    Vec2d place;
    int operation;  // its number in the job
    std::string strategy;
};

// The place of a fault, and the move to blame.
struct FaultPlace {
    Vec3d place;
    std::uint32_t line{};  // 0: of no move of the program
    int tool{};            // its number
};

// A profile of which a tab is cut away, and where one is missing: as far from those that stand as there is.
struct LostTab {
    int operation;
    std::string strategy;
    FaultPlace at;
};

// Stock left beside a wall of a 2.5-D operation, or how far the tool leaves the curve that it has to follow.
struct WallStock {
    double thickness{};  // mm, square to the wall
    FaultPlace at{};     // with the move that comes nearest
};

// Figures of one tool of the program.
struct ToolFigures {
    toolpath::Tool tool;
    FaultPlace first_cut{};  // the end of its first move at feed
    double cut_length{};     // mm
    // mm: the deepest cut, along the axis, at one position
    double cut_depth_max{};
};

// The worst contact of a part of any tool with stock, mm along the axis and with the clearance.
struct ContactFigures {
    BodyPart part;
    double depth{};
    // Where there is one:
    Vec3d tip{};
    std::uint32_t line{};
    int tool{};            // its number
    double long_enough{};  // mm: flutes, or the tool out of its holder
};

// In mm; heights are along the normal.
struct VerifyFigures {
    toolpath::MoveCounts moves;
    double cut_length{};
    double rapid_length{};  // without the program's first move
    std::size_t tool_positions{};
    std::size_t cells{};                   // of the floor that the tools reach
    double gouge_max{};                    // cut below the surface, from the height map
    std::optional<double> ball_gouge_max;  // deepest gouge by a ball, from exact distances
    std::optional<double> wall_gouge_max;  // deepest cut through a boundary or an island
    std::optional<double> wall_left_max;   // beside walls, above the reachable height
    double rapid_cut_max{};                // along the whole move
    // where bounds do not hold:
    std::optional<FaultPlace> rapid_cut_at;
    std::optional<FaultPlace> gouge_at;
    std::optional<FaultPlace> ball_gouge_at;
    std::optional<FaultPlace> wall_gouge_at;
    // The deepest into a fixture grown by its margin, and where; nothing where the job has none.
    std::optional<double> fixture_hit_max;
    std::string fixture_hit_at;  // fixture and place; empty where there is no hit
    // Figures of each part of a tool that the job gives lengths of.
    std::vector<ContactFigures> contacts;
    double cut_depth_max{};
    std::vector<ToolFigures> tools;  // those that cut, in the order of their first cut
    double unreachable_share{};      // of the part, where no tool of the program fits
    double uncut_share{};
    std::optional<double> scallop_bound;
    // Numbers of tools that finish ground with another end than a ball: where such an end can't touch, the
    // stock is measured here, and no plan proves it.
    std::vector<int> measured_tools;
    // Stock left above the surface, or above the reachable height. Along the normal; the greatest
    // is no more than the distance of the stock's top from what stays under or beside it.
    double scallop_max{};
    double scallop_p99{};
    double scallop_mean{};
    double left_volume{};                       // mm^3
    std::optional<ThickestLeft> thickest_left;  // if it is more than scallop and tolerance
    double uncovered_share{};                   // of the floor: left above the scallop bound
    std::optional<FaultPlace> uncovered_at{};   // where most of that is left
    // For 2.5-D operations: the most stock left over the tolerance, and the tabs of all profiles.
    std::optional<LevelLeft> level_left;
    std::optional<WallStock> wall_stock;  // the thickest over the tolerance
    int tabs_standing{};
    int tabs_wanted{};
    std::optional<LostTab> lost_tab;  // of the first operation that has fewer than it should
    // The thinnest floor over a cut of the other side, of a stock that was turned over.
    std::optional<FloorBetweenSides> between_sides;
    std::optional<EngagementFigures> engagement;  // if requested
};

// The limits of the figures, mm. The error of the judgement is added to each.
struct VerifyBounds {
    double floor_tolerance{};  // gouges of the floor
    double plan_tolerance{};   // gouges of walls
    double rapid_cut{};        // the deepest allowed cut of a rapid move
    double uncovered_share{};  // allowed share of the floor above the scallop
};

struct Verification {
    VerifyFigures figures;
    VerifyBounds bounds;
    std::vector<std::string> broken;  // each bound that does not hold, in words; empty: all hold
    // for pictures
    HeightGrid grid;
    std::vector<double> left;   // mm above the reachable height; NaN outside the floor, +inf uncut
    std::vector<double> gouge;  // mm cut below the part inside the walls; 0 where none is
    std::vector<double> part;   // z; NaN where there is none, the stock's top beyond walls
    Program program;
    // where the engagement was asked for: the runs of all tools, and what was found on each
    std::vector<ToolPositions> positions;
    std::vector<EngagementRun> engagement;
};

// The bounds are those of the job. Gouges: the floor tolerances. Walls: the plan tolerances.
// Scallop: that of the last operation that has one, on 99 % of the floor. Thickness of the stock
// left: that scallop and the floor tolerance, everywhere. Rapid moves: no cut. Floors over cuts of the
// other side of a stock that was turned over: least_floor. Slivers beside
// cliffs may be high along the normal, and yet thin.
//
// The programs of the job's stock, and those its operations come after, are cut first.
//
// Errors: InputError if a program cannot be read or names a tool that the job lacks.
Verification verify(const job::Job& job,
                    const std::string& program_file,
                    const VerifySettings& settings,
                    const Progress& progress);

}  // namespace cusp::verify
