// Cells are shared out to copies of the check, the same cells to the same copy for any number of threads.
#include <algorithm>
#include <mutex>

#include "host_tools/cancellation/cancellation.hpp"
#include "host_tools/finishing/scallop_check.hpp"
#include "host_tools/parallel/parallel.hpp"

namespace cusp::finishing {

using nurbs::Surface;

namespace {

constexpr std::size_t kCopies = 4;       // each with a drop cutter of its own where one is needed
constexpr std::size_t kCellsAtOnce = 4;  // of a copy, before cells of the model are forgotten
constexpr std::size_t kFindingsAtOnce = 256;
constexpr std::size_t kCellsBetween = 16;  // ends of parts of a run
constexpr double kSharedCell = 24;         // in stepovers: larger cells are divided before
constexpr int kSharedHalvings = 12;

// Runs of `at_once` numbers below a count, dealt out to the copies in turn. A copy takes its runs in
// order, so what it finds does not depend on the threads; the copies do not wait for each other.
class DealtRuns {
public:
    DealtRuns(std::size_t count, std::size_t at_once, const std::function<void(double)>& progress)
        : count_{count}, at_once_{at_once}, progress_{progress}
    {
        for (std::size_t copy = 0; copy < kCopies; ++copy) {
            next_[copy] = copy * at_once;
        }
    }

    struct Run {
        std::size_t copy;
        std::size_t begin;
        std::size_t end;
    };
    // The next run of the copy that is farthest behind, of those that are free; none at the end.
    std::optional<Run> take()
    {
        const std::lock_guard lock{guard_};
        std::size_t copy = kCopies;
        for (std::size_t k = 0; k < kCopies; ++k) {
            const bool waits = !busy_[k] && next_[k] < count_;
            if (waits && (copy == kCopies || next_[k] < next_[copy])) {
                copy = k;
            }
        }
        if (copy == kCopies) {
            return std::nullopt;
        }
        busy_[copy] = true;
        return Run{copy, next_[copy], std::min(count_, next_[copy] + at_once_)};
    }

    void give_back(const Run& run)
    {
        const std::lock_guard lock{guard_};
        busy_[run.copy] = false;
        next_[run.copy] += kCopies * at_once_;
        done_ += run.end - run.begin;
        progress_(static_cast<double>(done_) / static_cast<double>(count_));
    }

private:
    std::size_t count_;
    std::size_t at_once_;
    const std::function<void(double)>& progress_;
    std::mutex guard_;
    std::array<std::size_t, kCopies> next_{};
    std::array<bool, kCopies> busy_{};
    std::size_t done_{0};
};

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

void ScallopCheck::share_out(std::size_t count,
                             std::size_t at_once,
                             const std::function<void(ScallopCheck&, std::size_t)>& work,
                             const std::function<void(double)>& progress)
{
    while (copies_.size() < kCopies) {
        copies_.push_back(std::unique_ptr<ScallopCheck>{new ScallopCheck{*this, ForThread{}}});
    }
    {
        DealtRuns runs{count, at_once, progress};
        const part_model::PartModel::SharedQueries shared{path_fitter_.model()};
        parallel::for_each(kCopies, [&](std::size_t) {
            while (const auto run = runs.take()) {
                const part_model::PartModel::SharedQueries::Part queries{path_fitter_.model()};
                ScallopCheck& copy = *copies_[run->copy];
                copy.queries_ = &queries;
                for (std::size_t k = run->begin; k < run->end; ++k) {
                    if (k > run->begin && (k - run->begin) % kCellsBetween == 0) {
                        queries.next();
                    }
                    work(copy, k);
                }
                copy.queries_ = nullptr;
                runs.give_back(*run);
            }
        });
    }
    path_fitter_.model().forget_queries();
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
    std::vector<std::vector<Cell>> found(cells.size());
    share_out(
        cells.size(), kCellsAtOnce,
        [&](ScallopCheck& copy, std::size_t k) {
            const cancellation::Part part{"face ", cells[k].surface + 1, " of the floor"};
            copy.check_cell(cells[k], copy.corners_of(cells[k]), kDeepestCheck);
            found[k] = std::move(copy.uncovered_);
            copy.uncovered_.clear();
        },
        progress);
    for (const std::vector<Cell>& some : found) {
        overflowed_ = overflowed_ || uncovered_.size() + some.size() > max_uncovered_;
        if (!overflowed_) {
            uncovered_.insert(uncovered_.end(), some.begin(), some.end());
        }
    }
    for (const std::unique_ptr<ScallopCheck>& copy : copies_) {
        overflowed_ = overflowed_ || copy->overflowed_;
    }
}

// measure  also the stock left where a pass is missing
std::vector<ScallopCheck::CellFinding> ScallopCheck::findings_of(const std::vector<Cell>& cells,
                                                                 bool measure)
{
    std::vector<CellFinding> out(cells.size());
    share_out(
        cells.size(), kFindingsAtOnce,
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
