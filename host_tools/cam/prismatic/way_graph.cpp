// Dijkstra's search from the tool's place, along ways that are cut.
#include "host_tools/cam/prismatic/way_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

namespace cusp::prismatic {

namespace {

// Numbers places; those within kEndsMeet of each other have one number.
class Places {
public:
    std::size_t number_of(Vec3d p)
    {
        const auto cell = [](double x) {
            return static_cast<long long>(std::floor(x / kEndsMeet));
        };
        const long long i = cell(p.x);
        const long long j = cell(p.y);
        for (long long a = i - 1; a <= i + 1; ++a) {
            for (long long b = j - 1; b <= j + 1; ++b) {
                const auto found = cells_.find({a, b});
                if (found == cells_.end()) {
                    continue;
                }
                for (const std::size_t n : found->second) {
                    if (norm(places_[n] - p) < kEndsMeet) {
                        return n;
                    }
                }
            }
        }
        cells_[{i, j}].push_back(places_.size());
        places_.push_back(p);
        return places_.size() - 1;
    }
    std::size_t count() const { return places_.size(); }

private:
    std::vector<Vec3d> places_;
    std::map<std::pair<long long, long long>, std::vector<std::size_t>> cells_;
};

}  // namespace

WayGraph::WayGraph(std::vector<Way> ways) : ways_{std::move(ways)}, cut_(ways_.size(), false)
{
    Places places;
    for (const Way& way : ways_) {
        nodes_of_.push_back({places.number_of(way.start), places.number_of(way.end)});
    }
    at_node_.resize(places.count());
    for (std::size_t k = 0; k < ways_.size(); ++k) {
        at_node_[nodes_of_[k][0]].push_back(k);
        if (nodes_of_[k][1] != nodes_of_[k][0]) {
            at_node_[nodes_of_[k][1]].push_back(k);
        }
    }
}

std::optional<WayGraph::Step> WayGraph::best_at(std::size_t node) const
{
    std::optional<Step> best;
    std::tuple<bool, double> least{};
    for (const std::size_t k : at_node_[node]) {
        if (cut_[k]) {
            continue;
        }
        const bool backward = nodes_of_[k][0] != node;
        const std::vector<std::size_t>& beyond = at_node_[nodes_of_[k][backward ? 0 : 1]];
        const bool goes_on = std::any_of(beyond.begin(), beyond.end(), [&](std::size_t other) {
            return other != k && !cut_[other];
        });
        const std::tuple<bool, double> rank{goes_on, ways_[k].length};
        if (!best || rank < least) {
            best = Step{k, backward};
            least = rank;
        }
    }
    return best;
}

std::optional<WayGraph::Link> WayGraph::link_to_uncut(std::size_t way,
                                                      bool at_end,
                                                      double limit) const
{
    struct Reached {
        double length;
        std::size_t from;
        Step step;
    };
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    std::map<std::size_t, Reached> reached;
    const std::size_t begin = nodes_of_[way][at_end ? 1 : 0];
    reached[begin] = {0, begin, {}};
    open.push({0, begin});
    while (!open.empty()) {
        const auto [length, node] = open.top();
        open.pop();
        if (length > reached[node].length) {
            continue;
        }
        if (const auto next = best_at(node)) {
            Link link{{}, next->way, next->backward, length};
            for (std::size_t at = node; at != begin; at = reached[at].from) {
                link.steps.push_back(reached[at].step);
            }
            std::reverse(link.steps.begin(), link.steps.end());
            return link;
        }
        for (const std::size_t k : at_node_[node]) {
            const bool backward = nodes_of_[k][0] != node;
            const std::size_t other = nodes_of_[k][backward ? 0 : 1];
            const double sum = length + ways_[k].length;
            const auto known = reached.find(other);
            if (sum <= limit && (known == reached.end() || sum < known->second.length)) {
                reached[other] = {sum, node, {k, backward}};
                open.push({sum, other});
            }
        }
    }
    return std::nullopt;
}

}  // namespace cusp::prismatic
