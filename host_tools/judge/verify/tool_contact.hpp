// Contacts of stock with what does not cut: the tool beyond its flutes, its shank, its holder.
//
//     ContactTrace trace{grid, positions, tool_discs(job, positions.tool), stock_around(job, grid)};
//     stock.cut(positions, spacing, progress, nullptr, &trace);
//     for (const BodyContact& contact : trace.finish()) { contact.depth; }  // mm
//
// Stock in a height map has no undercuts. Thus a cylinder of the tool meets stock exactly where
// stock inside its radius is higher than its lower end. Each cylinder is therefore a disc at a
// height over the tip, grown by `holder_clearance` in radius and downward. A tool that is longer by
// the depth of the worst contact has no contact.
//
// - Beyond the flutes: stock that the cutter removes higher over its tip than the flutes are long. Less
//   than 0.02 mm, or twice the job's tolerance, of it in height or width does not count.
// - A shank that is no wider than the cutter moves where the cutter has cut; it has no disc.
//
// Accuracy: a place of the stock that holds a circle of a radius of 1.5 pitches is not missed; its
// height over the disc is found within half the distance of two positions. With the default grid that
// is 0.26 mm, half the default clearance, and 0.05 mm. tests/unit/verify/tool_contact_test.cpp cuts and
// tests every point of a raster.
//
// Time: each tile of the grid has a bound of its stock's height. A position without stock nearby
// clears all positions that are nearer to it than the nearest stock, since stock is only removed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/bands.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

enum class BodyPart : std::uint8_t { kBeyondFlutes, kShank, kHolder };
inline constexpr std::size_t kBodyParts = 3;

struct ToolDisc {
    BodyPart part;
    double radius;  // mm, with the clearance
    double above;   // mm over the tip, less the clearance
    double slack;   // mm: no deeper contact is none
};

// mm: shrinks all discs of a program that was written with rounded numbers.
inline constexpr double kProgramSlack = 0.01;

// The discs for which the job gives lengths.
//
// slack  mm: discs are narrower by it, and no deeper contact is none
std::vector<ToolDisc> tool_discs(const job::Job& job, const toolpath::Tool& tool, double slack = 0);

// Stock up to `top` beyond these limits, which no tool cuts; infinite limits: none.
struct StockExtent {
    std::array<double, 2> x{-kUnbounded, kUnbounded};
    std::array<double, 2> y{-kUnbounded, kUnbounded};
    double top{};
};

// All around what operations with a boundary and 2.5-D operations cut, where [stock] has no x or no
// y. None if an operation has neither, or faces the stock.
StockExtent stock_around(const job::Job& job, const HeightGrid& grid);

// The worst contact of a part of a tool; depth 0: none.
struct BodyContact {
    BodyPart part;
    double depth{};  // mm, along the axis, clearance included
    std::size_t position{};
};

// mm, rounded up to a hundredth: the flute_length (for a holder: the length) that avoids the contact.
double long_enough(const job::Job& job, const toolpath::Tool& tool, const BodyContact& contact);

// Its key in the figures of `cusp verify`.
const char* name_of_figure(BodyPart part);

class ContactTrace {
public:
    // Grid and positions have to outlive the trace.
    ContactTrace(const HeightGrid& grid,
                 const ToolPositions& positions,
                 std::vector<ToolDisc> discs,
                 const StockExtent& around);

    // To be called before position k cuts the columns [begin, end) of `band`.
    void look(const std::vector<double>& heights,
              std::size_t k,
              std::size_t band,
              std::size_t begin,
              std::size_t end);

    // Without discs there is nothing to look for.
    bool is_idle() const { return discs_.empty(); }

    // One for each disc.
    std::vector<BodyContact> finish() const;

private:
    // No stock over `height` is nearer than `free` to `centre`.
    struct Search {
        BodyContact worst;
        Vec2d centre{};
        double free{-1};
        double height{kUnbounded};
    };
    struct Tiles {
        std::size_t rows{};
        std::vector<double> tops;  // no stock is higher; column by column
        std::vector<Search> searches;
    };
    struct Columns {
        const std::vector<double>& heights;
        std::size_t begin;
        std::size_t end;
    };
    // Stock over a height: its least distance, up to a limit, and its top within the radius.
    struct Nearest {
        double distance;
        double top;
    };

    void look_around(std::size_t k);
    void look_for(const Columns& columns,
                  const ToolDisc& disc,
                  std::size_t k,
                  Tiles& tiles,
                  Search& search) const;
    Nearest nearest(const Columns& columns,
                    Vec2d centre,
                    double radius,
                    double limit,
                    double height,
                    Tiles& tiles) const;
    double box_distance(const Columns& columns, std::size_t column, std::size_t row, Vec2d p) const;
    void scan(const Columns& columns,
              std::size_t column,
              std::size_t row,
              Vec2d centre,
              double radius,
              double height,
              Tiles& tiles,
              Nearest& found) const;

    const HeightGrid& grid_;
    const ToolPositions& positions_;
    std::vector<ToolDisc> discs_;
    StockExtent around_;
    std::array<Tiles, kBands> tiles_;
    std::vector<BodyContact> beyond_;  // contacts with the stock around
};

}  // namespace cusp::verify
