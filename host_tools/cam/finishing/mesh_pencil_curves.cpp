// Finds the sides of a grid that a pencil curve crosses, bisects them and chains them by cells.
#include "host_tools/cam/finishing/mesh_pencil_curves.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

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

using Dropped = PartModel::DroppedTool;

class PencilCurveFinder {
public:
    PencilCurveFinder(const GougeFreePathFitter& path_fitter, double pitch)
        : path_fitter_{path_fitter}, radius_{path_fitter.offset_tool().radius}
    {
        const Vec3d low = path_fitter.model().box_low();
        const Vec3d high = path_fitter.model().box_high();
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
        dropped_.resize(places_.size());
        parallel::for_each(nx_, [&](std::size_t i) {
            path_fitter.model().forget_queries();
            for (std::size_t k = i * ny_; k < (i + 1) * ny_; ++k) {
                dropped_[k] = drop_at(places_[k]);
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
            if (length_of(tips) > kShortestCrease * radius_) {
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

}  // namespace cusp::finishing
