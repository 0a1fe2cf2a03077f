// Cells are shared out to copies of the check, the same cells to a copy for any number of threads.
#include <algorithm>
#include <atomic>
#include <mutex>

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/joined_tips.hpp"
#include "host_tools/cam/finishing/scallop_check.hpp"
#include "host_tools/cam/finishing/shares_of_neighbours.hpp"

namespace cusp::finishing {

using nurbs::Surface;

namespace {

constexpr std::size_t kCellShares = 16;  // each with a drop cutter of its own where one is needed
// Effort of a copy, which then gives half of the rest to another: 16 and 64 shares differ by 10 % of time.
constexpr std::size_t kEnough = 80'000;  // some 0.4 s
constexpr std::size_t kReports = 64;
constexpr std::size_t kCellsBetween = 16;  // ends of parts of a share
constexpr std::size_t kMiddles = 4096;     // evaluated by one thread
constexpr double kSharedCell = 4;          // in stepovers: larger cells are divided before
constexpr int kSharedHalvings = 12;

}  // namespace

ScallopCheck::ScallopCheck(const ScallopCheck& other, ForThread /*tag*/)
    : surfaces_{other.surfaces_},
      path_fitter_{other.path_fitter_},
      radius_{other.radius_},
      scallop_{other.scallop_},
      path_off_{other.path_off_},
      max_uncovered_{other.max_uncovered_},
      places_{other.places_},
      has_checked_{true},
      visibility_{other.visibility_},
      walls_{path_fitter_, places_}
{
}

ReachableHeight::Drops ScallopCheck::work_at(
    OpenShare& share, const std::function<void(ScallopCheck&, std::size_t)>& work) const
{
    ScallopCheck copy{*this, ForThread{}};
    copy.places_.begin_with(share.take_known());
    const part_model::PartModel::SharedQueries::Part queries{path_fitter_.model()};
    copy.queries_ = &queries;
    std::size_t enough = kEnough;
    std::size_t between = 0;
    while (const std::optional<std::size_t> k = share.next()) {
        if (between++ == kCellsBetween) {
            queries.next();
            between = 1;
        }
        work(copy, *k);
        if (copy.effort() >= enough && share.left() > 1) {
            share.give_half(copy.places_.drops());
            enough = copy.effort() + kEnough;
        }
    }
    return copy.places_.take_drops();
}

void ScallopCheck::share_out(const std::vector<Cell>& cells,
                             const std::function<void(ScallopCheck&, std::size_t)>& work,
                             const std::function<void(double)>& progress)
{
    std::vector<Vec2d> middles(cells.size());
    parallel::for_each((cells.size() + kMiddles - 1) / kMiddles, [&](std::size_t some) {
        const std::size_t end = std::min((some + 1) * kMiddles, cells.size());
        for (std::size_t k = some * kMiddles; k < end; ++k) {
            const Cell& cell = cells[k];
            const Vec3d at =
                path_fitter_.model()
                    .evaluate(cell.surface, 0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1))
                    .point;
            middles[k] = {at.x, at.y};
        }
    });
    const auto shares = shares_of_neighbours(middles, kCellShares);
    const std::size_t apart = 1 + cells.size() / kReports;
    std::mutex guard;
    std::atomic<std::size_t> done{0};
    const auto count = [&] {
        if (++done % apart == 0) {
            const std::lock_guard lock{guard};
            progress(static_cast<double>(done) / static_cast<double>(cells.size()));
        }
    };
    // Later calls look near the same places.
    places_.share(places_.take_drops());
    std::vector<ReachableHeight::Drops> drops;
    {
        const part_model::PartModel::SharedQueries shared{path_fitter_.model()};
        drops = work_in_shares(shares, [&](OpenShare& share) {
            return work_at(share, [&](ScallopCheck& copy, std::size_t k) {
                work(copy, k);
                count();
            });
        });
    }
    path_fitter_.model().forget_queries();
    for (ReachableHeight::Drops& some : drops) {
        places_.share(std::move(some));
    }
}

void ScallopCheck::divide(const Cell& cell, int depth, std::vector<Cell>& out) const
{
    const auto [long_u, long_v] = sides_of(cell);
    if (depth == 0 || std::max(long_u, long_v) <= kSharedCell * places_.step()) {
        out.push_back(cell);
        return;
    }
    for (const Cell& half : halves_of(cell, long_u >= long_v)) {
        divide(half, depth - 1, out);
    }
}

void ScallopCheck::check_all(const std::function<void(double)>& progress)
{
    take_waiting();
    std::vector<Cell> cells;
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        const Surface& s = surfaces_[k];
        for (const Cell& cell :
             cells_of(static_cast<int>(k), {s.u_begin(), s.v_begin()}, {s.u_end(), s.v_end()})) {
            divide(cell, kSharedHalvings, cells);
        }
    }
    struct Found {
        std::vector<Cell> uncovered;
        bool overflowed;
    };
    std::vector<Found> found(cells.size());
    share_out(
        cells,
        [&](ScallopCheck& copy, std::size_t k) {
            const cancellation::Part part{"face ", cells[k].surface + 1, " of the floor"};
            copy.check_cell(cells[k], copy.corners_of(cells[k]), kDeepestCheck);
            found[k] = {std::move(copy.uncovered_), copy.overflowed_};
            copy.uncovered_.clear();
        },
        progress);
    for (const Found& some : found) {
        overflowed_ = overflowed_ || some.overflowed ||
                      uncovered_.size() + some.uncovered.size() > max_uncovered_;
        if (!overflowed_) {
            uncovered_.insert(uncovered_.end(), some.uncovered.begin(), some.uncovered.end());
        }
    }
}

// measure  also the stock left where a pass is missing
std::vector<ScallopCheck::CellFinding> ScallopCheck::findings_of(const std::vector<Cell>& cells,
                                                                 bool measure)
{
    std::vector<CellFinding> out(cells.size());
    share_out(
        cells,
        [&](ScallopCheck& copy, std::size_t k) {
            const cancellation::Part part{"face ", cells[k].surface + 1, " of the floor"};
            CellFinding& finding = out[k];
            copy.moved_clear_ = false;
            const std::optional<MissingPass> found = copy.uncovered_point(cells[k]);
            finding.missing = found.has_value();
            finding.moved_clear = copy.moved_clear_;
            if (found && measure) {
                copy.left_beside_edges_ = 0;
                finding.left = copy.scallop_over_reachable(
                    copy.corner(cells[k].surface, found->place.u, found->place.v), 0);
                finding.beside_edges = copy.left_beside_edges_;
            }
        },
        [](double) {});
    return out;
}

// The pass over the next cell of the surface where one is still missing; empty where none is.
Points ScallopCheck::next_trace(OpenOnSurface& surface, OpenCells& open) const
{
    while (surface.next < surface.cells.size()) {
        const std::size_t k = surface.cells[surface.next++];
        const Cell& cell = open.cells[k];
        if (queries_ != nullptr) {
            queries_->next();
        } else {
            path_fitter_.model().forget_many_cells();
        }
        moved_clear_ = open.findings[k].moved_clear;
        const std::optional<MissingPass> found = uncovered_point(cell);
        open.findings[k].missing = found.has_value();
        open.findings[k].moved_clear = moved_clear_;
        if (found) {
            return longest_trace(cell, *found);
        }
    }
    return {};
}

// Cuts passes over the cells that miss one. The surfaces take turns: passes for the next cell of each
// are traced at once, then cut one after the other. Two passes of one turn may overlap where surfaces
// meet.
void ScallopCheck::cut_missing(OpenCells& open,
                               const std::function<void(const Points&)>& cut,
                               const std::function<void(double)>& progress)
{
    std::map<int, OpenOnSurface> by_surface;
    std::size_t missing = 0;
    for (std::size_t k = 0; k < open.cells.size(); ++k) {
        if (open.findings[k].missing) {
            by_surface[open.cells[k].surface].cells.push_back(k);
            ++missing;
        }
    }
    while (!by_surface.empty()) {
        for (const Points& one : next_traces(by_surface, open)) {
            for (const Points& run : joined_tips(one, path_fitter_, places_.step())) {
                cut(run);
            }
        }
        std::size_t left = 0;
        for (auto at = by_surface.begin(); at != by_surface.end();) {
            const std::size_t more = at->second.cells.size() - at->second.next;
            left += more;
            at = more == 0 ? by_surface.erase(at) : std::next(at);
        }
        progress(1 - static_cast<double>(left) / static_cast<double>(missing));
    }
}

// The next pass of each surface. The last surface is searched by this check itself, which keeps what it
// has found; copies begin anew.
std::vector<Points> ScallopCheck::next_traces(std::map<int, OpenOnSurface>& by_surface,
                                              OpenCells& open)
{
    if (by_surface.size() == 1) {
        return {next_trace(by_surface.begin()->second, open)};
    }
    std::vector<Cell> first;
    std::vector<OpenOnSurface*> turn;
    for (auto& [number, surface] : by_surface) {
        first.push_back(open.cells[surface.cells[surface.next]]);
        turn.push_back(&surface);
    }
    std::vector<Points> traces(turn.size());
    share_out(
        first,
        [&](ScallopCheck& copy, std::size_t k) { traces[k] = copy.next_trace(*turn[k], open); },
        [](double) {});
    return traces;
}

// Cells with a new pass, and those where passes cut since may have left a steep step.
std::vector<ScallopCheck::Cell> ScallopCheck::cells_changed(const OpenCells& open)
{
    std::vector<char> changed(open.cells.size());
    share_out(
        open.cells,
        [&](const ScallopCheck& copy, std::size_t k) {
            changed[k] = open.findings[k].missing || copy.is_steep(copy.corners_of(open.cells[k]));
        },
        [](double) {});
    std::vector<Cell> out;
    for (std::size_t k = 0; k < changed.size(); ++k) {
        if (changed[k] != 0) {
            out.push_back(open.cells[k]);
        }
    }
    return out;
}

// The cells that still miss a pass stay; of the others, those beside edges are appended.
void ScallopCheck::measure_left(std::vector<Cell>& beside_edges)
{
    const std::vector<CellFinding> findings = findings_of(uncovered_, true);
    std::vector<Cell> left;
    for (std::size_t k = 0; k < findings.size(); ++k) {
        const CellFinding& finding = findings[k];
        most_left_ = std::max(most_left_, finding.left);
        left_beside_edges_ = std::max(left_beside_edges_, finding.beside_edges);
        if (finding.missing) {
            left.push_back(uncovered_[k]);
        } else if (finding.moved_clear) {
            beside_edges.push_back(uncovered_[k]);
        }
    }
    uncovered_ = std::move(left);
}

}  // namespace cusp::finishing
