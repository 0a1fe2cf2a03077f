// Runs are collected line by line and then ordered from line to line.
#include "host_tools/cam/grid_pocket/zigzag_runs.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

namespace cusp::grid_pocket {
namespace {

Cell at(char axis, int line, int place)
{
    return axis == 'x' ? Cell{place, line} : Cell{line, place};
}

int place_of(char axis, Cell c) { return axis == 'x' ? c.column : c.row; }

using Lines = std::vector<std::vector<GridRun>>;

Lines gather(const CellGrid& grid,
             char axis,
             Tracks& tracks,
             const std::function<bool(Cell, Cell)>& clear)
{
    const int count = axis == 'x' ? grid.rows() : grid.columns();
    const int places = axis == 'x' ? grid.columns() : grid.rows();
    Lines lines(static_cast<std::size_t>(count));
    for (int line = 0; line < count; ++line) {
        auto& runs = lines[static_cast<std::size_t>(line)];
        for (int place = 0; place + 1 < places; ++place) {
            const Cell a = at(axis, line, place);
            const Cell b = at(axis, line, place + 1);
            if (!grid.inside(a) || !grid.inside(b)) {
                continue;
            }
            const bool track = axis == 'x' ? tracks.east(a) : tracks.north(a);
            if (track || !clear(a, b)) {
                continue;
            }
            tracks.add(a, b);
            if (!runs.empty() && runs.back().last == a) {
                runs.back().last = b;
            } else {
                runs.push_back({a, b});
            }
        }
    }
    return lines;
}

class RunOrder {
public:
    RunOrder(Lines lines, char axis) : lines_{std::move(lines)}, axis_{axis} {}

    std::vector<GridRun> order()
    {
        for (std::size_t line = 0; line < lines_.size(); ++line) {
            while (!lines_[line].empty()) {
                take(line, 0, false);
                follow(static_cast<int>(line));
            }
        }
        return std::move(out_);
    }

private:
    // Cells between the end of a run and the start of the next in the neighbouring line.
    static constexpr int kNear = 6;
    Lines lines_;
    char axis_;
    std::vector<GridRun> out_;

    void take(std::size_t line, std::size_t index, bool turned)
    {
        GridRun run = lines_[line][index];
        lines_[line].erase(lines_[line].begin() + static_cast<std::ptrdiff_t>(index));
        if (turned) {
            std::swap(run.first, run.last);
        }
        out_.push_back(run);
    }

    void follow(int line)
    {
        int step = 1;
        for (;;) {
            if (try_line(line + step)) {
                line += step;
            } else if (try_line(line - step)) {
                step = -step;
                line += step;
            } else if (!try_line(line)) {
                return;
            }
        }
    }

    bool try_line(int line)
    {
        if (line < 0 || line >= static_cast<int>(lines_.size())) {
            return false;
        }
        const auto& runs = lines_[static_cast<std::size_t>(line)];
        const int here = place_of(axis_, out_.back().last);
        int least = kNear + 1;
        std::optional<std::pair<std::size_t, bool>> best;
        // Runs of a line are ascending: only those around the cell can be near.
        const auto after = std::partition_point(runs.begin(), runs.end(), [&](const GridRun& r) {
            return place_of(axis_, r.last) < here - kNear;
        });
        for (auto it = after; it != runs.end() && place_of(axis_, it->first) <= here + kNear;
             ++it) {
            for (const bool turned : {false, true}) {
                const int start = place_of(axis_, turned ? it->last : it->first);
                if (std::abs(start - here) < least) {
                    least = std::abs(start - here);
                    best = {static_cast<std::size_t>(it - runs.begin()), turned};
                }
            }
        }
        if (best) {
            take(static_cast<std::size_t>(line), best->first, best->second);
        }
        return best.has_value();
    }
};

}  // namespace

std::vector<GridRun> zigzag_runs(const CellGrid& grid,
                                 char axis,
                                 Tracks& tracks,
                                 const std::function<bool(Cell, Cell)>& clear)
{
    return RunOrder{gather(grid, axis, tracks, clear), axis}.order();
}

}  // namespace cusp::grid_pocket
