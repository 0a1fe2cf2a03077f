// Open chains first: each starts at a side that only one cell joins.
#include "host_tools/geometry/part_model/cell_chains.hpp"

#include <algorithm>
#include <set>

namespace cusp::part_model {

std::vector<std::vector<GridSide>> CellChains::chains() const
{
    std::set<GridSide> used;
    const auto walk = [&](GridSide from) {
        std::vector<GridSide> chain{from};
        used.insert(from);
        for (bool extended = true; extended;) {
            extended = false;
            for (const GridSide& next : neighbours_.at(chain.back())) {
                if (used.insert(next).second) {
                    chain.push_back(next);
                    extended = true;
                    break;
                }
            }
        }
        const auto& back = neighbours_.at(chain.back());
        if (chain.size() > 2 && std::find(back.begin(), back.end(), from) != back.end()) {
            chain.push_back(from);
        }
        return chain;
    };
    std::vector<std::vector<GridSide>> out;
    for (const bool open : {true, false}) {
        for (const auto& [side, neighbours] : neighbours_) {
            if (used.count(side) == 0 && (neighbours.size() == 1 || !open)) {
                out.push_back(walk(side));
            }
        }
    }
    return out;
}

}  // namespace cusp::part_model
