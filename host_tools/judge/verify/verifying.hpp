// The state of a verification: each stage reads the job and what stages before it found.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/standing_stock.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::verify {

struct Wall {
    std::string boundary;  // the pocket's; empty where it has none
    job::Loop loop;
    bool outer;  // the boundary itself
};

// The parts and walls of all operations, each file once.
struct Scene {
    std::vector<nurbs::Surface> surfaces;
    std::vector<std::array<Vec3d, 3>> mesh;
    std::vector<Wall> walls;
    double floor_tolerance{};
    double plan_tolerance{};
    std::optional<double> scallop;
    double path_clearance{};  // mm: the floor tolerance where it is one-sided
    bool has_levels{false};   // some operation is 2.5-D

    bool has_floor() const { return !surfaces.empty() || !mesh.empty(); }
};

// The job's tool of this number. Errors: InputError, naming the program, for one that it has not, and for 0, that of a
// program that names no tool, where the job has several.
const toolpath::Tool& tool_of(const job::Job& job, int number, const std::string& program);

struct Verifying {
    const job::Job& job;
    const std::string& program_file;
    const VerifySettings& settings;
    const Progress& progress;
    Scene scene{};
    double spacing{};                       // mm between positions
    std::vector<ToolPositions> runs{};      // of the program, a new one at every change of tool
    std::optional<MachinedStock> stock{};   // as the program leaves it, from cut_program() on
    std::optional<StandingStock> before{};  // as earlier programs leave it
    double removed_before{};                // mm^3, by earlier programs
    std::vector<double> heights{};          // of the stock, where it is judged
    Verification result{};
};

// The figures of a tool: new ones where it has none yet.
ToolFigures& figures_of(const toolpath::Tool& tool, VerifyFigures& figures);

}  // namespace cusp::verify
