// One pass over the cells; dead ends search outwards over what was visited.
#include "host_tools/grid_pocket/grid_navigation.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace cusp::host {
namespace {

struct Heading {
    int x;
    int y;
};

// In the order of the paper's priority numbers, for travel along `h`.
std::array<Heading, 4> priorities(Heading h)
{
    return {Heading{h.y, -h.x}, h, Heading{-h.y, h.x}, Heading{-h.x, -h.y}};
}

Cell towards(Cell c, Heading h) { return {c.column + h.x, c.row + h.y}; }

class Navigator {
public:
    Navigator(const CellGrid& grid, const NavigationRules& rules)
        : grid_{grid},
          rules_{rules},
          state_(grid.size(), State::kClosed),
          seen_(grid.size(), 0),
          from_(grid.size(), 0)
    {
        for (std::size_t i = 0; i < grid.size(); ++i) {
            if (rules.free(grid.cell(i))) {
                state_[i] = State::kFree;
            }
        }
    }

    Navigation run()
    {
        // Cells are numbered row by row, so the first free one is the left-most of least y.
        for (std::size_t i = 0; i < grid_.size(); ++i) {
            if (state_[i] == State::kFree) {
                visit(grid_.cell(i), StepKind::kEnter);
                heading_ = {1, 0};
                while (advance() || leave_dead_end()) {
                }
            }
        }
        return std::move(out_);
    }

private:
    enum class State : std::uint8_t { kClosed, kFree, kVisited };
    const CellGrid& grid_;
    const NavigationRules& rules_;
    std::vector<State> state_;
    std::vector<std::uint32_t> seen_;  // number of the search that reached the cell
    std::vector<std::size_t> from_;
    std::uint32_t search_{0};
    Navigation out_;
    Cell here_{};
    Heading heading_{1, 0};

    bool is(Cell c, State state) const
    {
        return grid_.within(c) && state_[grid_.index(c)] == state;
    }

    void visit(Cell c, StepKind kind)
    {
        state_[grid_.index(c)] = State::kVisited;
        out_.steps.push_back({c, kind});
        here_ = c;
    }

    std::optional<Heading> choice(Cell c, Heading heading) const
    {
        for (const Heading h : priorities(heading)) {
            const Cell next = towards(c, h);
            if (is(next, State::kFree) && rules_.clear_step(c, next)) {
                return h;
            }
        }
        return std::nullopt;
    }

    bool advance()
    {
        const auto h = choice(here_, heading_);
        if (h) {
            visit(towards(here_, *h), StepKind::kNeighbour);
            heading_ = *h;
        }
        return h.has_value();
    }

    // The visited cells from here to the nearest one with a free neighbour, both ends included.
    std::vector<Cell> way_out()
    {
        ++search_;
        std::vector<std::size_t> queue{grid_.index(here_)};
        seen_[queue[0]] = search_;
        for (std::size_t done = 0; done < queue.size(); ++done) {
            const Cell c = grid_.cell(queue[done]);
            if (choice(c, heading_)) {
                std::vector<Cell> way{c};
                for (std::size_t i = queue[done]; i != queue[0]; i = from_[i]) {
                    way.push_back(grid_.cell(from_[i]));
                }
                std::reverse(way.begin(), way.end());
                return way;
            }
            for (const Heading h : priorities(heading_)) {
                const Cell next = towards(c, h);
                if (is(next, State::kVisited) && seen_[grid_.index(next)] != search_ &&
                    rules_.clear_step(c, next)) {
                    seen_[grid_.index(next)] = search_;
                    from_[grid_.index(next)] = queue[done];
                    queue.push_back(grid_.index(next));
                }
            }
        }
        return {};
    }

    bool leave_dead_end()
    {
        const std::vector<Cell> way = way_out();
        if (way.empty()) {
            return false;
        }
        ++out_.dead_ends;
        const Cell before = way[way.size() - 2];
        const Heading arriving{way.back().column - before.column, way.back().row - before.row};
        const Heading h = *choice(way.back(), arriving);
        const Cell target = towards(way.back(), h);
        add_link(way, target);
        visit(target, kind_of_step_to(target));
        heading_ = h;
        return true;
    }

    StepKind kind_of_step_to(Cell target) const
    {
        const Cell last = out_.steps.back().cell;
        const int way = std::abs(last.column - target.column) + std::abs(last.row - target.row);
        return way == 1 ? StepKind::kNeighbour : StepKind::kLink;
    }

    // Few straight links over the way: each is tried to its end, then half as far, and so on.
    void add_link(const std::vector<Cell>& way, Cell target)
    {
        std::vector<Cell> stops = way;
        stops.push_back(target);
        for (std::size_t at = 0; at + 1 < stops.size();) {
            std::size_t next = stops.size() - 1;
            while (next > at + 1 && !rules_.clear_link(stops[at], stops[next])) {
                next = at + std::max<std::size_t>(1, (next - at) / 2);
            }
            if (next + 1 < stops.size()) {
                out_.steps.push_back({stops[next], StepKind::kLink});
                ++out_.backtracks;
            }
            at = next;
        }
    }
};

}  // namespace

Navigation navigate(const CellGrid& grid, const NavigationRules& rules)
{
    return Navigator{grid, rules}.run();
}

Navigation reversed(Navigation navigation)
{
    // A step's kind says how its cell is reached; the other way round that belongs to the cell
    // before.
    auto& steps = navigation.steps;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        steps[i].kind = steps[i + 1].kind;
    }
    if (!steps.empty()) {
        steps.back().kind = StepKind::kEnter;
    }
    std::reverse(steps.begin(), steps.end());
    return navigation;
}

}  // namespace cusp::host
