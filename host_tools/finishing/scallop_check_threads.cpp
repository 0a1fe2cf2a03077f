// Cells are shared out to copies of the check, the same cells to a copy for any number of threads.
#include <algorithm>
#include <mutex>

#include "host_tools/cancellation/cancellation.hpp"
#include "host_tools/finishing/scallop_check.hpp"
#include "host_tools/finishing/shares_of_neighbours.hpp"
#include "host_tools/parallel/parallel.hpp"

namespace cusp::finishing {

using nurbs::Surface;

namespace {

constexpr std::size_t kCellShares = 8;     // each with a drop cutter of its own where one is needed
constexpr std::size_t kCellsBetween = 16;  // ends of parts of a share
constexpr double kSharedCell = 24;         // in stepovers: larger cells are divided before
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
      visibility_{other.visibility_}
{
}

void ScallopCheck::share_out(const std::vector<Cell>& cells,
                             const std::function<void(ScallopCheck&, std::size_t)>& work,
                             const std::function<void(double)>& progress)
{
    std::vector<Vec2d> middles;
    middles.reserve(cells.size());
    for (const Cell& cell : cells) {
        const Vec3d at =
            path_fitter_.model()
                .evaluate(cell.surface, 0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1))
                .point;
        middles.push_back({at.x, at.y});
    }
    const auto shares = shares_of_neighbours(middles, kCellShares);
    std::mutex guard;
    std::size_t done = 0;
    // Later calls look near the same places.
    places_.share(places_.take_drops());
    std::vector<ReachableHeight::Drops> drops(shares.size());
    {
        const part_model::PartModel::SharedQueries shared{path_fitter_.model()};
        parallel::for_each(shares.size(), [&](std::size_t share) {
            ScallopCheck copy{*this, ForThread{}};
            const part_model::PartModel::SharedQueries::Part queries{path_fitter_.model()};
            copy.queries_ = &queries;
            std::size_t between = 0;
            for (const std::size_t k : shares[share]) {
                if (between++ == kCellsBetween) {
                    queries.next();
                    between = 1;
                }
                work(copy, k);
            }
            drops[share] = copy.places_.take_drops();
            const std::lock_guard lock{guard};
            done += shares[share].size();
            progress(static_cast<double>(done) / static_cast<double>(cells.size()));
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
            const std::optional<Place> place = copy.uncovered_point(cells[k]);
            finding.missing = place.has_value();
            finding.moved_clear = copy.moved_clear_;
            if (place && measure) {
                copy.left_beside_edges_ = 0;
                finding.left = copy.scallop_over_reachable(
                    copy.corner(cells[k].surface, place->u, place->v), 0);
                finding.beside_edges = copy.left_beside_edges_;
            }
        },
        [](double) {});
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
