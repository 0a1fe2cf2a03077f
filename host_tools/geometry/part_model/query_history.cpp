// The memory of queries: proved facts of cells, and the last results of each thread.
#include <algorithm>

#include "host_tools/geometry/part_model/nearest_search.hpp"

namespace cusp::part_model {

bool PartModel::State::outside_trims(const BezierCell& cell) const
{
    const TrimRegion& region = regions[static_cast<std::size_t>(cell.surface())];
    if (!region.trimmed()) {
        return false;
    }
    if (cell.trim() == BezierCell::Trim::kUnknown) {
        const TrimRegion::Part part =
            region.part(cell.u_begin(), cell.u_end(), cell.v_begin(), cell.v_end());
        cell.set_trim(part == TrimRegion::Part::kInside    ? BezierCell::Trim::kInside
                      : part == TrimRegion::Part::kOutside ? BezierCell::Trim::kOutside
                                                           : BezierCell::Trim::kCut);
    }
    return cell.trim() == BezierCell::Trim::kOutside;
}

const BezierCell& PartModel::State::cell_at(int surface, double u, double v) const
{
    const Grid& grid = grids[static_cast<std::size_t>(surface)];
    History& last_query = history();
    if (last_query.last_surface != surface) {
        last_query.last_surface = surface;
        last_query.last_u = last_query.last_v = 0;
    }
    // The next place is usually in or beside the span of the last one.
    const auto span = [](const std::vector<double>& breaks, double at, std::size_t& last) {
        const bool above = last == 0 || breaks[last] <= at;
        if (!above || (last + 1 < breaks.size() && !(at < breaks[last + 1]))) {
            const auto next = std::upper_bound(breaks.begin() + 1, breaks.end(), at);
            last = static_cast<std::size_t>(next - breaks.begin()) - 1;
        }
        return last;
    };
    return *cells[grid.first + span(grid.u, u, last_query.last_u) * grid.v.size() +
                  span(grid.v, v, last_query.last_v)];
}

int PartModel::State::surface_of_edge(std::size_t edge) const
{
    const auto next = std::upper_bound(first_edges.begin(), first_edges.end(), edge);
    return static_cast<int>(next - first_edges.begin()) - 1;
}

std::uint64_t PartModel::State::next_number()
{
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

PartModel::State::History& PartModel::State::history() const
{
    struct Known {
        std::uint64_t number;
        History* history;
    };
    thread_local Known last{0, nullptr};
    if (last.number != number_) {
        const std::lock_guard lock{guard_};
        std::unique_ptr<History>& mine = histories_[std::this_thread::get_id()];
        if (!mine) {
            mine = std::make_unique<History>();
        }
        last = {number_, mine.get()};
    }
    return *last.history;
}

void PartModel::State::forget_cells()
{
    forget_histories();
    for (const std::unique_ptr<BezierCell>& cell : cells) {
        cell->forget();
    }
    halves = 0;
}

void PartModel::State::forget_histories() const
{
    for (const auto& [thread, history] : histories_) {
        *history = {};
    }
}

}  // namespace cusp::part_model
