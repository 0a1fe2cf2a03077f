// One traversal of the cells; from dead ends a search runs over visited cells.
#include "host_tools/cam/grid_pocket/grid_navigation.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace cusp::grid_pocket {
namespace {

struct Heading {
    int x;
    int y;
};

// In the order of the paper's priorities, for travel along `h`.
std::array<Heading, 4> priorities(Heading h)
{
    return {Heading{h.y, -h.x}, h, Heading{-h.y, h.x}, Heading{-h.x, -h.y}};
}

Cell towards(Cell c, Heading h) { return {c.column + h.x, c.row + h.y}; }

class Navigator {
public:
    // tried_exits  number of free cells that are tried for a straight link from a dead end
    Navigator(const CellGrid& grid, const NavigationRules& rules, std::size_t tried_exits)
        : grid_{grid},
          rules_{rules},
          tried_exits_{tried_exits},
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
    std::size_t tried_exits_;
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
        out_.steps.push_back({c, kind, {}});
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

    // A visited cell with a free neighbour, and the free cell that the priorities select from it.
    struct Exit {
        Cell beside;
        Cell target;
        Heading heading;
    };

    // Searches over visited cells for exits, nearest first: the first one with a straight link
    // among those tried, else the nearest.
    std::optional<Exit> find_exit()
    {
        ++search_;
        std::vector<std::size_t> queue{grid_.index(here_)};
        seen_[queue[0]] = search_;
        std::optional<Exit> nearest;
        std::size_t looked = 0;
        std::size_t last = grid_.size();  // limit of the search
        for (std::size_t done = 0; done < std::min(queue.size(), last); ++done) {
            const Cell c = grid_.cell(queue[done]);
            if (const auto exit = exit_at(c, done == 0 ? queue[done] : from_[queue[done]])) {
                if (rules_.clear_link(grid_.centre(here_), grid_.centre(exit->target))) {
                    return exit;
                }
                if (!nearest) {
                    nearest = exit;
                    last = 4 * done + 1000;
                }
                if (++looked >= tried_exits_) {
                    return nearest;
                }
            }
            spread(queue, done);
        }
        return nearest;
    }

    std::optional<Exit> exit_at(Cell c, std::size_t before) const
    {
        const Cell from = grid_.cell(before);
        const Heading arriving =
            from == c ? heading_ : Heading{c.column - from.column, c.row - from.row};
        const auto h = choice(c, arriving);
        return h ? std::optional<Exit>{{c, towards(c, *h), *h}} : std::nullopt;
    }

    void spread(std::vector<std::size_t>& queue, std::size_t at)
    {
        const Cell c = grid_.cell(queue[at]);
        for (const Heading h : priorities(heading_)) {
            const Cell next = towards(c, h);
            if (is(next, State::kVisited) && seen_[grid_.index(next)] != search_ &&
                rules_.clear_step(c, next)) {
                seen_[grid_.index(next)] = search_;
                from_[grid_.index(next)] = queue[at];
                queue.push_back(grid_.index(next));
            }
        }
    }

    bool leave_dead_end()
    {
        const auto exit = find_exit();
        if (!exit) {
            return false;
        }
        ++out_.dead_ends;
        std::vector<Vec2d> bends = bends_to(*exit);
        const int apart =
            std::abs(here_.column - exit->target.column) + std::abs(here_.row - exit->target.row);
        const bool next = bends.empty() && apart == 1;
        visit(exit->target, next ? StepKind::kNeighbour : StepKind::kLink);
        out_.backtracks += static_cast<int>(bends.size());
        out_.steps.back().bends = std::move(bends);
        heading_ = exit->heading;
        return true;
    }

    std::vector<Vec2d> bends_to(const Exit& exit) const
    {
        const Vec2d from = grid_.centre(here_);
        const Vec2d to = grid_.centre(exit.target);
        if (rules_.clear_link(from, to)) {
            return {};
        }
        std::vector<Vec2d> way;
        const std::size_t first = grid_.index(here_);
        for (std::size_t i = grid_.index(exit.beside); i != first; i = from_[i]) {
            way.push_back(grid_.centre(grid_.cell(i)));
        }
        std::reverse(way.begin(), way.end());
        if (auto bends = fewest_bends(from, to, stops_beside(way))) {
            return std::move(*bends);
        }
        return bends_on_path(from, to, way);
    }

    // Candidates for the bends of a link along the path: points of the path, and corners of walls
    // near it.
    std::vector<Vec2d> stops_beside(const std::vector<Vec2d>& way) const
    {
        constexpr std::size_t kOfWay = 24;
        constexpr std::size_t kOfCorners = 32;
        std::vector<std::pair<double, Vec2d>> corners;
        for (const Vec2d corner : rules_.corners) {
            double least = kUnbounded;
            for (const Vec2d p : way) {
                least = std::min(least, norm(p - corner));
            }
            corners.push_back({least, corner});
        }
        const std::size_t count = std::min(kOfCorners, corners.size());
        std::partial_sort(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count),
                          corners.end(),
                          [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<Vec2d> stops;
        for (std::size_t i = 0; i < count; ++i) {
            stops.push_back(corners[i].second);
        }
        const std::size_t stride = way.size() / kOfWay + 1;
        for (std::size_t i = 0; i < way.size(); i += stride) {
            stops.push_back(way[i]);
        }
        return stops;
    }

    // Breadth-first search over the candidates that are mutually visible; none if there is no path.
    std::optional<std::vector<Vec2d>> fewest_bends(Vec2d from,
                                                   Vec2d to,
                                                   const std::vector<Vec2d>& stops) const
    {
        constexpr std::size_t kNone = ~std::size_t{0};
        std::vector<std::size_t> before(stops.size(), kNone);
        std::vector<std::size_t> queue;
        const auto look_from = [&](std::size_t at) {
            const Vec2d place = at == stops.size() ? from : stops[at];
            for (std::size_t i = 0; i < stops.size(); ++i) {
                if (before[i] == kNone && rules_.clear_link(place, stops[i])) {
                    before[i] = at;
                    queue.push_back(i);
                }
            }
        };
        look_from(stops.size());
        for (std::size_t done = 0; done < queue.size(); ++done) {
            const std::size_t at = queue[done];
            if (rules_.clear_link(stops[at], to)) {
                std::vector<Vec2d> bends;
                for (std::size_t i = at; i != stops.size(); i = before[i]) {
                    bends.push_back(stops[i]);
                }
                std::reverse(bends.begin(), bends.end());
                return bends;
            }
            look_from(at);
        }
        return std::nullopt;
    }

    // Bends on the path itself: a straight line to its end is tried first, then half as far, and so
    // on.
    std::vector<Vec2d> bends_on_path(Vec2d from, Vec2d to, const std::vector<Vec2d>& way) const
    {
        std::vector<Vec2d> stops{from};
        stops.insert(stops.end(), way.begin(), way.end());
        stops.push_back(to);
        std::vector<Vec2d> bends;
        for (std::size_t at = 0; at + 1 < stops.size();) {
            std::size_t next = stops.size() - 1;
            while (next > at + 1 && !rules_.clear_link(stops[at], stops[next])) {
                next = at + std::max<std::size_t>(1, (next - at) / 2);
            }
            if (next + 1 < stops.size()) {
                bends.push_back(stops[next]);
            }
            at = next;
        }
        return bends;
    }
};

// Replaces the links with the most bends by lifts, until bends are within a hundredth of the steps.
void lift_worst_links(Navigation& navigation)
{
    std::vector<NavigationStep*> bent;
    for (NavigationStep& step : navigation.steps) {
        if (!step.bends.empty()) {
            bent.push_back(&step);
        }
    }
    std::stable_sort(bent.begin(), bent.end(), [](const auto* a, const auto* b) {
        return a->bends.size() > b->bends.size();
    });
    const int most = static_cast<int>(navigation.steps.size() / 100);
    for (NavigationStep* step : bent) {
        if (navigation.backtracks <= most) {
            return;
        }
        navigation.backtracks -= static_cast<int>(step->bends.size());
        ++navigation.lifts;
        step->bends.clear();
        step->kind = StepKind::kEnter;
    }
}

}  // namespace

Navigation navigate(const CellGrid& grid, const NavigationRules& rules)
{
    constexpr std::size_t kInSight = 64;
    Navigation best = Navigator{grid, rules, 1}.run();
    if (best.backtracks > 0) {
        Navigation other = Navigator{grid, rules, kInSight}.run();
        if (other.backtracks < best.backtracks) {
            best = std::move(other);
        }
    }
    lift_worst_links(best);
    return best;
}

Navigation reversed(Navigation navigation)
{
    // A step's kind and bends describe the move to its cell; reversed they belong to the cell
    // before.
    auto& steps = navigation.steps;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        steps[i].kind = steps[i + 1].kind;
        steps[i].bends = std::move(steps[i + 1].bends);
        std::reverse(steps[i].bends.begin(), steps[i].bends.end());
    }
    if (!steps.empty()) {
        steps.back().kind = StepKind::kEnter;
        steps.back().bends.clear();
    }
    std::reverse(steps.begin(), steps.end());
    return navigation;
}

}  // namespace cusp::grid_pocket
