// Passes over the places of a mesh that miss one: traced in several neighbourhoods at once.
#include <algorithm>
#include <memory>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/joined_tips.hpp"
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"
#include "host_tools/cam/finishing/shares_of_neighbours.hpp"

namespace cusp::finishing {

namespace {

constexpr std::size_t kNeighbourhoods = 8;

}  // namespace

// Cells of one neighbourhood, by number, and the search in it, which keeps what it has found.
struct MeshScallopCheck::Neighbours {
    std::vector<std::size_t> cells;
    std::unique_ptr<MeshScallopCheck> search;
    std::size_t next{0};
    std::optional<std::size_t> found{};  // number of the cell that `trace` passes
    Points trace{};

    bool over() const { return next == cells.size(); }

    // Finds the next cell that misses a pass, and traces that.
    void find_next(const std::vector<Cell>& open)
    {
        found.reset();
        while (!over() && !found) {
            const std::size_t k = cells[next++];
            if (const std::optional<MeshPlace> place = search->uncovered_point(open[k])) {
                found = k;
                trace = search->longest_trace(*place);
            }
        }
    }
};

Points MeshScallopCheck::longest_trace(const MeshPlace& from) const
{
    if (from.normal.z < kUprightNormal) {
        return trace_level(from);
    }
    return longest_over_mesh(from, path_fitter_.model(), step(),
                             [&](const MeshPlace& at) { return missing_tip(at); });
}

std::vector<MeshScallopCheck::Neighbours> MeshScallopCheck::neighbours_of(
    const std::vector<Cell>& open) const
{
    std::vector<Vec2d> middles;
    middles.reserve(open.size());
    for (const Cell& cell : open) {
        middles.push_back({cell.middle().x, cell.middle().y});
    }
    std::vector<Neighbours> out;
    for (std::vector<std::size_t>& share : shares_of_neighbours(middles, kNeighbourhoods)) {
        Neighbours some;
        some.cells = std::move(share);
        some.search.reset(new MeshScallopCheck{*this, ForThread{}});
        out.push_back(std::move(some));
    }
    return out;
}

// Cuts passes over the cells that miss one; returns those cells. The neighbourhoods take turns: in each
// the next pass is traced, all at once, then they are cut, but for those over cells that another
// pass of the turn has cleared.
std::vector<MeshScallopCheck::Cell> MeshScallopCheck::cut_missing(
    const std::vector<Cell>& open, const std::function<void(const Points&)>& cut)
{
    places_.share(places_.take_drops());
    std::vector<Neighbours> all = neighbours_of(open);
    std::vector<std::size_t> changed;
    while (
        std::any_of(all.begin(), all.end(), [](const Neighbours& some) { return !some.over(); })) {
        parallel::for_each(all.size(), [&](std::size_t k) {
            path_fitter_.model().forget_queries();
            all[k].find_next(open);
        });
        path_fitter_.model().forget_queries();
        bool has_cut = false;
        for (const Neighbours& some : all) {
            if (!some.found || (has_cut && !uncovered_point(open[*some.found]))) {
                continue;
            }
            has_cut = true;
            changed.push_back(*some.found);
            for (const Points& run : joined_tips(some.trace, path_fitter_, step())) {
                cut(run);
            }
        }
    }
    for (Neighbours& some : all) {
        places_.share(some.search->places_.take_drops());
    }
    std::sort(changed.begin(), changed.end());
    std::vector<Cell> out;
    out.reserve(changed.size());
    for (const std::size_t k : changed) {
        out.push_back(open[k]);
    }
    return out;
}

}  // namespace cusp::finishing
