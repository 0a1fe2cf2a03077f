// Marching squares: the sides of a grid that curves cross, chained cell by cell.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace cusp::part_model {

// A side of a grid: its lower node, and whether it runs to the next column.
using GridSide = std::pair<std::size_t, bool>;

// rows  nodes in a column
inline std::size_t end_node(const GridSide& side, std::size_t rows)
{
    return side.first + (side.second ? rows : 1);
}

class CellChains {
public:
    // Joins the crossed sides of a cell in pairs.
    //
    // node     the cell's node of lowest column and row
    // rows     nodes in a column
    // crossed  crossed(side): whether a curve crosses a GridSide
    template <class Crossed>
    void join(std::size_t node, std::size_t rows, const Crossed& crossed)
    {
        const std::array<GridSide, 4> around{
            {{node, true}, {node + rows, false}, {node + 1, true}, {node, false}}};
        std::vector<GridSide> sides;
        for (const GridSide& side : around) {
            if (crossed(side)) {
                sides.push_back(side);
            }
        }
        for (std::size_t n = 0; n + 1 < sides.size(); n += 2) {
            neighbours_[sides[n]].push_back(sides[n + 1]);
            neighbours_[sides[n + 1]].push_back(sides[n]);
        }
    }

    // Every side is in one chain; a closed chain ends with its first side.
    std::vector<std::vector<GridSide>> chains() const;

private:
    std::map<GridSide, std::vector<GridSide>> neighbours_;
};

}  // namespace cusp::part_model
