// Finds the sides of a grid that a pencil curve crosses, bisects them and chains them by cells.
#include "host_tools/cam/finishing/mesh_pencil_curves.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/geometry/part_model/cell_chains.hpp"

namespace cusp::finishing {

using part_model::CellChains;
using part_model::end_node;
using part_model::GridSide;
using part_model::PartModel;

namespace {

constexpr double kTurned = 0.94;          // cosine between normals on both sides
constexpr double kApart = 0.05;           // radii: between contacts on both sides
constexpr double kFound = 1e-5;           // mm: accuracy of a crossing
constexpr double kSag = 0.2;              // of the band's offset: between points of a curve
constexpr int kCrossingHalvings = 6;      // between two crossings
constexpr double kShortestCrease = 0.05;  // radii
constexpr std::size_t kMostGrid = 700;
constexpr int kWaysDown = 24;
constexpr double kLeastTurn = 1e-3;
constexpr double kLeastStep = 1.0 / 64;  // pitches
constexpr double kDownCells = 3;

using Dropped = PartModel::DroppedTool;

class PencilCurveFinder {
public:
    PencilCurveFinder(const GougeFreePathFitter& path_fitter,
                      double pitch,
                      const std::vector<Vec3d>* places = nullptr)
        : path_fitter_{path_fitter},
          radius_{path_fitter.offset_tool().radius},
          pitch_{pitch},
          is_near_{places != nullptr}
    {
        const Vec3d beyond = Vec3d{1, 1, 0} * (is_near_ ? radius_ : 0);
        const Vec3d low = path_fitter.model().box_low() - beyond;
        const Vec3d high = path_fitter.model().box_high() + beyond;
        nx_ = count(high.x - low.x, pitch);
        ny_ = count(high.y - low.y, pitch);
        for (std::size_t i = 0; i < nx_; ++i) {
            for (std::size_t j = 0; j < ny_; ++j) {
                // Shifted, so that edges of the part do not coincide with lines of the grid.
                const double x = (static_cast<double>(i) + 0.37) / static_cast<double>(nx_);
                const double y = (static_cast<double>(j) + 0.41) / static_cast<double>(ny_);
                places_.push_back({low.x + (high.x - low.x) * x, low.y + (high.y - low.y) * y});
            }
        }
        const std::vector<char> wanted =
            is_near_ ? nodes_near(*places, low, high) : std::vector<char>(places_.size(), 1);
        dropped_.resize(places_.size());
        parallel::for_each(nx_, [&](std::size_t i) {
            path_fitter.model().forget_queries();
            for (std::size_t k = i * ny_; k < (i + 1) * ny_; ++k) {
                if (wanted[k] != 0) {
                    dropped_[k] = drop_at(places_[k]);
                }
            }
        });
        path_fitter.model().forget_queries();
    }

    std::vector<Points> curves()
    {
        find_crossings();
        CellChains chains;
        for (std::size_t i = 0; i + 1 < nx_; ++i) {
            for (std::size_t j = 0; j + 1 < ny_; ++j) {
                chains.join(i * ny_ + j, ny_,
                            [&](const GridSide& side) { return crossings_.count(side) > 0; });
            }
        }
        std::vector<Points> out;
        for (Points& tips : tips_along(chains.chains())) {
            if (is_near_) {
                std::reverse(tips.begin(), tips.end());
                go_down(tips);
                std::reverse(tips.begin(), tips.end());
                go_down(tips);
            }
            if (is_near_ || length_of(tips) > kShortestCrease * radius_) {
                out.push_back(std::move(tips));
            }
        }
        return out;
    }

private:
    struct Crossing {
        Vec2d from;
        Vec2d to;
        Vec3d tip;
    };

    static std::size_t count(double length, double pitch)
    {
        return std::clamp<std::size_t>(static_cast<std::size_t>(length / pitch) + 2, 4, kMostGrid);
    }

    // The nodes of the grid so near to places, in x and in y, that a tool there may be over one.
    std::vector<char> nodes_near(const std::vector<Vec3d>& places, Vec3d low, Vec3d high) const
    {
        const auto dilated = [](std::vector<char>& nodes, std::size_t first, std::size_t step,
                                std::size_t many, std::size_t reach) {
            std::size_t left = 0;  // nodes that the last one reaches yet
            const auto pass = [&](std::size_t k) {
                char& node = nodes[first + k * step];
                left = node == 1 ? reach : left - (left > 0 ? 1 : 0);
                node = node == 0 && left > 0 ? 2 : node;
            };
            for (std::size_t k = 0; k < many; ++k) {
                pass(k);
            }
            left = 0;
            for (std::size_t k = many; k-- > 0;) {
                pass(k);
            }
            for (std::size_t k = 0; k < many; ++k) {
                nodes[first + k * step] = nodes[first + k * step] != 0 ? 1 : 0;
            }
        };
        const auto node_at = [](double share, std::size_t many) {
            return static_cast<std::size_t>(
                std::clamp(share * static_cast<double>(many), 0.0, static_cast<double>(many - 1)));
        };
        std::vector<char> out(places_.size(), 0);
        for (const Vec3d& place : places) {
            out[node_at((place.x - low.x) / (high.x - low.x), nx_) * ny_ +
                node_at((place.y - low.y) / (high.y - low.y), ny_)] = 1;
        }
        const auto reach = [&](double length, std::size_t many) {
            return static_cast<std::size_t>(radius_ / length * static_cast<double>(many)) + 2;
        };
        for (std::size_t i = 0; i < nx_; ++i) {
            dilated(out, i * ny_, 1, ny_, reach(high.y - low.y, ny_));
        }
        for (std::size_t j = 0; j < ny_; ++j) {
            dilated(out, j, ny_, nx_, reach(high.x - low.x, nx_));
        }
        return out;
    }

    // Goes on from the last tip to the lowest one, as far as two cells: curves end in a cell, not at the
    // tip that they share with others.
    void go_down(Points& tips) const
    {
        const Vec3d from = tips.back();
        const auto drop_beside = [&](Vec3d at, double step, double turn) {
            return path_fitter_.drop(at.x + step * elementary::cos(turn),
                                     at.y + step * elementary::sin(turn));
        };
        Vec3d at = from;
        for (double step = pitch_; step > kLeastStep * pitch_;) {
            std::optional<Vec3d> best;
            double best_turn = 0;
            const auto try_turn = [&](double turn) {
                const auto tip = drop_beside(at, step, turn);
                if (tip && tip->z < (best ? best->z : at.z)) {
                    best = tip;
                    best_turn = turn;
                }
            };
            for (int k = 0; k < kWaysDown; ++k) {
                try_turn(2 * kPi * k / kWaysDown);
            }
            // Between steep walls only one way goes down.
            for (double way = kPi / kWaysDown; best && way > kLeastTurn; way *= 0.5) {
                const double turn = best_turn;
                try_turn(turn - way);
                try_turn(turn + way);
            }
            if (best && norm(*best - from) < kDownCells * pitch_) {
                at = *best;
                tips.push_back(at);
            } else {
                step *= 0.5;
            }
        }
    }

    std::optional<Dropped> drop_at(Vec2d at) const
    {
        return path_fitter_.model().drop_tool(path_fitter_.offset_tool(), at.x, at.y);
    }

    // Distance of two contacts less that of the tips.
    static double jump(const Dropped& a, const Dropped& b)
    {
        return norm(b.point - a.point) - norm(b.tip - a.tip);
    }

    bool turned(const Dropped& a, const Dropped& b) const
    {
        return dot(a.lean, b.lean) < kTurned && norm(b.point - a.point) > kApart * radius_ &&
               jump(a, b) > 0;
    }

    std::optional<Crossing> crossing(Vec2d from, Vec2d to) const
    {
        const std::optional<Dropped> at_from = drop_at(from);
        const std::optional<Dropped> at_to = drop_at(to);
        if (!at_from || !at_to || !turned(*at_from, *at_to)) {
            return std::nullopt;
        }
        Dropped a = *at_from;
        Dropped b = *at_to;
        Vec2d low = from;
        Vec2d high = to;
        while (elementary::hypot(high.x - low.x, high.y - low.y) > kFound) {
            const Vec2d middle = (low + high) * 0.5;
            const std::optional<Dropped> m = drop_at(middle);
            if (!m) {
                return std::nullopt;
            }
            if (jump(a, *m) > jump(*m, b)) {
                b = *m;
                high = middle;
            } else {
                a = *m;
                low = middle;
            }
        }
        if (!turned(a, b)) {
            return std::nullopt;
        }
        return Crossing{
            from, to,
            (a.tip.z < b.tip.z ? a.tip : b.tip) + Vec3d{0, 0, path_fitter_.band().offset}};
    }

    // The crossings of all sides of the grid.
    void find_crossings()
    {
        std::vector<std::vector<std::pair<GridSide, Crossing>>> columns(nx_);
        parallel::for_each(nx_, [&](std::size_t i) {
            path_fitter_.model().forget_queries();
            for (std::size_t k = i * ny_; k < (i + 1) * ny_; ++k) {
                for (const bool to_next_column : {false, true}) {
                    const GridSide side{k, to_next_column};
                    if (to_next_column ? i + 1 == nx_ : k + 1 == (i + 1) * ny_) {
                        continue;
                    }
                    if (const auto found = crossing(side)) {
                        columns[i].emplace_back(side, *found);
                    }
                }
            }
        });
        path_fitter_.model().forget_queries();
        for (const auto& column : columns) {
            crossings_.insert(column.begin(), column.end());
        }
    }

    std::optional<Crossing> crossing(const GridSide& side) const
    {
        const std::size_t end = end_node(side, ny_);
        const std::optional<Dropped>& a = dropped_[side.first];
        const std::optional<Dropped>& b = dropped_[end];
        return a && b && turned(*a, *b) ? crossing(places_[side.first], places_[end])
                                        : std::nullopt;
    }

    // A polyline for each chain.
    std::vector<Points> tips_along(const std::vector<std::vector<GridSide>>& chains) const
    {
        std::vector<std::vector<Crossing>> at;
        std::vector<std::pair<std::size_t, std::size_t>> stretches;  // of a chain; its end
        for (const std::vector<GridSide>& chain : chains) {
            for (std::size_t k = 1; k < chain.size(); ++k) {
                stretches.emplace_back(at.size(), k);
            }
            at.push_back(crossings_along(chain));
        }
        std::vector<Points> between(stretches.size());
        parallel::for_each(stretches.size(), [&](std::size_t n) {
            path_fitter_.model().forget_queries();
            const auto [chain, k] = stretches[n];
            append(at[chain][k - 1], at[chain][k], 0, between[n]);
        });
        path_fitter_.model().forget_queries();
        std::vector<Points> out;
        for (const std::vector<Crossing>& crossings : at) {
            out.push_back({crossings.front().tip});
        }
        for (std::size_t n = 0; n < stretches.size(); ++n) {
            Points& tips = out[stretches[n].first];
            tips.insert(tips.end(), between[n].begin(), between[n].end());
        }
        return out;
    }

    std::vector<Crossing> crossings_along(const std::vector<GridSide>& chain) const
    {
        std::vector<Crossing> at;
        for (const GridSide& side : chain) {
            Crossing next = crossings_.at(side);
            // `from` is on the same side of the curve everywhere, so segments between two crossings
            // cross the curve.
            if (!at.empty() && farther(at.back(), next)) {
                std::swap(next.from, next.to);
            }
            at.push_back(next);
        }
        return at;
    }

    static bool farther(const Crossing& a, const Crossing& b)
    {
        const auto square = [](Vec2d d) {
            return d.x * d.x + d.y * d.y;
        };
        return square(b.from - a.from) + square(b.to - a.to) >
               square(b.to - a.from) + square(b.from - a.to);
    }

    void append(const Crossing& a, const Crossing& b, int depth, Points& tips) const
    {
        const double allowed = std::max(1e-5, kSag * path_fitter_.band().offset);
        if (depth < kCrossingHalvings) {
            const auto middle = crossing((a.from + b.from) * 0.5, (a.to + b.to) * 0.5);
            if (middle && norm(middle->tip - (a.tip + b.tip) * 0.5) > allowed) {
                append(a, *middle, depth + 1, tips);
                append(*middle, b, depth + 1, tips);
                return;
            }
            if (middle) {
                tips.push_back(middle->tip);
            }
        }
        tips.push_back(b.tip);
    }

    const GougeFreePathFitter& path_fitter_;
    double radius_;
    double pitch_;
    bool is_near_;
    std::size_t nx_{};
    std::size_t ny_{};
    std::vector<Vec2d> places_;
    std::vector<std::optional<Dropped>> dropped_;
    std::map<GridSide, Crossing> crossings_;
};

}  // namespace

std::vector<Points> mesh_pencil_curves(const GougeFreePathFitter& path_fitter, double pitch)
{
    return PencilCurveFinder{path_fitter, pitch}.curves();
}

std::vector<Points> mesh_pencil_curves_near(const std::vector<Vec3d>& places,
                                            const GougeFreePathFitter& path_fitter,
                                            double pitch)
{
    return PencilCurveFinder{path_fitter, pitch, &places}.curves();
}

}  // namespace cusp::finishing
