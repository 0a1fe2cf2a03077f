// The stock that is left between the cuts of the two sides of a stock that was turned over.
//
//     if (const auto floor = floor_between_sides(job, grid, stock.heights(), spacing)) {
//         floor->thickness;  // mm; 0 or less: the cuts meet
//     }
//
// docs/job_file.md, Set-ups, says which cuts are judged.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

// The thinnest place of a floor that 2.5-D operations leave over a cut of the other side.
struct FloorBetweenSides {
    double thickness;  // mm, along z
    Vec3d place;       // on the floor
    int operation;     // its number in the job
    std::string strategy;
};

// heights  of the stock, cut from above by all programs of this side
// spacing  mm between positions of the tools of the other side
//
// Returns nothing where no operation is judged or no floor of theirs lies over a cut of the other
// side. Points of the grid are looked at; narrower grooves may be missed.
// Precondition: the stock has a box, where programs were turned over.
std::optional<FloorBetweenSides> floor_between_sides(const job::Job& job,
                                                     const HeightGrid& grid,
                                                     const std::vector<double>& heights,
                                                     double spacing);

// As above, of the stock cut by a program of the job and by those before it.
std::optional<FloorBetweenSides> floor_between_sides(const job::Job& job,
                                                     const std::string& program_file);

// True if the floor is thinner than the job allows.
bool is_too_thin(const job::Job& job, const FloorBetweenSides& floor);

// "0.4 mm are left between ... at x 3 y 4 z -5 mm (operation 3, pocket); ..."
std::string sentence_of(const job::Job& job, const FloorBetweenSides& floor);

}  // namespace cusp::verify
