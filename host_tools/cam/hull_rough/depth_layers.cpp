// The tops of boxes divide the stock; better planes are found with a height map of the quartered
// patches.
#include "host_tools/cam/hull_rough/depth_layers.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace cusp::hull_rough {
namespace {

// Tops nearer than this are one plane; far below any depth of cut, far above rounding.
constexpr double kSamePlane = 1e-6;

// A corner patch may keep its top however often it is quartered: after so many times the layer is
// divided equally.
constexpr int kMostQuarterings = 8;

// Patches by the height of their boxes' tops, and the layers between them.
class Slices {
public:
    Slices(std::vector<HullPatch> patches, double top, double bottom) : top_{top}, bottom_{bottom}
    {
        for (HullPatch& patch : patches) {
            add(std::move(patch), 0);
        }
    }

    std::vector<double> planes() const
    {
        std::vector<double> out{top_};
        for (auto it = by_top_.rbegin(); it != by_top_.rend(); ++it) {
            if (it->first < out.back() - kSamePlane && it->first > bottom_ + kSamePlane) {
                out.push_back(it->first);
            }
        }
        out.push_back(bottom_);
        return out;
    }

    // Quarters the patches whose boxes end at `plane`; false where none may be quartered again.
    bool quarter_at(double plane)
    {
        std::vector<std::pair<HullPatch, int>> found;
        const auto first = by_top_.lower_bound(plane - kSamePlane);
        const auto last = by_top_.upper_bound(plane + kSamePlane);
        for (auto it = first; it != last;) {
            // Quarters of a flat patch have its height.
            const auto& [patch, times] = it->second;
            if (times < kMostQuarterings && patch.top - patch.bottom > kSamePlane) {
                found.push_back(std::move(it->second));
                it = by_top_.erase(it);
            } else {
                ++it;
            }
        }
        for (const auto& [patch, times] : found) {
            for (HullPatch& quarter : quarters(patch)) {
                add(std::move(quarter), times + 1);
            }
        }
        return !found.empty();
    }

    // The next top below `plane`, or the bottom.
    double next_below(double plane) const
    {
        const auto above = by_top_.lower_bound(plane - kSamePlane);
        return above == by_top_.begin() ? bottom_ : std::max(bottom_, std::prev(above)->first);
    }

    std::vector<HullPatch> take_patches()
    {
        std::vector<HullPatch> out;
        for (auto& [top, patch] : by_top_) {
            out.push_back(std::move(patch.first));
        }
        return out;
    }

private:
    double top_;
    double bottom_;
    std::multimap<double, std::pair<HullPatch, int>> by_top_;

    void add(HullPatch patch, int times)
    {
        const double top = patch.top;
        by_top_.emplace(top, std::make_pair(std::move(patch), times));
    }
};

// Splits from the top down; layers still too thick after all quarterings are divided equally.
std::vector<double> split_thick(Slices& slices, double top, double bottom, double max_thickness)
{
    std::vector<double> planes{top};
    while (planes.back() > bottom + kSamePlane) {
        const double above = planes.back();
        double below = slices.next_below(above);
        while (above - below > max_thickness + kSamePlane && slices.quarter_at(above)) {
            below = slices.next_below(above);
        }
        const double count = std::ceil((above - below - kSamePlane) / max_thickness);
        for (int i = 1; i < static_cast<int>(count); ++i) {
            planes.push_back(above + (below - above) * i / count);
        }
        planes.push_back(below < bottom + kSamePlane ? bottom : below);
    }
    return planes;
}

void merge_thin(std::vector<double>& planes, DepthLimits limits)
{
    bool merged = true;
    while (merged) {
        merged = false;
        for (std::size_t i = planes.size() - 2; i > 0 && !merged; --i) {
            const bool thin = planes[i] - planes[i + 1] < limits.min_thickness - kSamePlane;
            if (thin && planes[i - 1] - planes[i + 1] <= limits.max_thickness + kSamePlane) {
                planes.erase(planes.begin() + static_cast<std::ptrdiff_t>(i));
                merged = true;
            }
        }
    }
}

// The share of the plan view that the patches cover at each height, from the tops of small boxes on
// a raster. It only chooses planes; the exact boxes decide what is cut.
class CoveredShare {
public:
    CoveredShare(const std::vector<HullPatch>& patches, double bottom)
    {
        window_ = plan_box(patches.front());
        for (const HullPatch& patch : patches) {
            const Rectangle box = plan_box(patch);
            window_ = {std::min(window_.x_min, box.x_min), std::min(window_.y_min, box.y_min),
                       std::max(window_.x_max, box.x_max), std::max(window_.y_max, box.y_max)};
        }
        heights_.assign(kCells * kCells, bottom);
        for (const HullPatch& patch : patches) {
            draw(patch, kDeepest);
        }
        std::sort(heights_.begin(), heights_.end());
    }

    double above(double z) const
    {
        const auto first = std::upper_bound(heights_.begin(), heights_.end(), z + kSamePlane);
        return static_cast<double>(heights_.end() - first) / static_cast<double>(heights_.size());
    }

private:
    static constexpr int kCells = 256;
    static constexpr int kDeepest = 5;
    Rectangle window_;
    std::vector<double> heights_;

    int cell(double value, double low, double high) const
    {
        const double share = high > low ? (value - low) / (high - low) : 0.0;
        return std::clamp(static_cast<int>(share * kCells), 0, kCells - 1);
    }

    void draw(const HullPatch& patch, int levels)
    {
        const Rectangle box = plan_box(patch);
        const int i0 = cell(box.x_min, window_.x_min, window_.x_max);
        const int i1 = cell(box.x_max, window_.x_min, window_.x_max);
        const int j0 = cell(box.y_min, window_.y_min, window_.y_max);
        const int j1 = cell(box.y_max, window_.y_min, window_.y_max);
        if (levels > 0 && (i1 > i0 + 1 || j1 > j0 + 1)) {
            for (const HullPatch& quarter : quarters(patch)) {
                draw(quarter, levels - 1);
            }
            return;
        }
        for (int i = i0; i <= i1; ++i) {
            for (int j = j0; j <= j1; ++j) {
                double& height = heights_[static_cast<std::size_t>(i * kCells + j)];
                height = std::max(height, patch.top);
            }
        }
    }
};

// Candidate heights of planes, descending: those of the plan, and equally spaced ones.
std::vector<double> candidates(const LayerPlan& plan, DepthLimits limits)
{
    const double top = plan.planes.front();
    const double bottom = plan.planes.back();
    std::vector<double> out = plan.planes;
    for (const HullPatch& patch : plan.patches) {
        if (patch.top < top && patch.top > bottom) {
            out.push_back(patch.top);
        }
    }
    const double step = std::max(limits.min_thickness, limits.max_thickness / 4) / 8;
    const int count = static_cast<int>((top - bottom) / step);
    for (int i = 1; i < count; ++i) {
        out.push_back(top - i * step);
    }
    std::sort(out.begin(), out.end(), [](double a, double b) { return a > b; });
    std::vector<double> apart{top};
    for (const double z : out) {
        if (z < apart.back() - step / 8 && z > bottom + step / 8) {
            apart.push_back(z);
        }
    }
    apart.push_back(bottom);
    return apart;
}

}  // namespace

LayerPlan depth_layers(std::vector<HullPatch> patches,
                       double top,
                       double bottom,
                       DepthLimits limits)
{
    Slices slices{std::move(patches), top, bottom};
    LayerPlan plan;
    plan.raw_layers = static_cast<int>(slices.planes().size()) - 1;
    plan.planes = split_thick(slices, top, bottom, limits.max_thickness);
    plan.split_layers = static_cast<int>(plan.planes.size()) - 1;
    merge_thin(plan.planes, limits);
    plan.patches = slices.take_patches();
    return plan;
}

std::vector<double> least_leftover_planes(const LayerPlan& plan, DepthLimits limits)
{
    const std::vector<double> z = candidates(plan, limits);
    const CoveredShare share{plan.patches, plan.planes.back()};
    const std::size_t layers = plan.planes.size() - 1;
    // cost[k][j]: the least volume left over the part by k layers that end at z[j].
    std::vector<std::vector<double>> cost(layers + 1, std::vector<double>(z.size(), kInfinite));
    std::vector<std::vector<std::size_t>> from(layers + 1, std::vector<std::size_t>(z.size(), 0));
    std::vector<double> covered;
    for (const double height : z) {
        covered.push_back(share.above(height));
    }
    cost[0][0] = 0;
    for (std::size_t k = 1; k <= layers; ++k) {
        for (std::size_t j = 1; j < z.size(); ++j) {
            for (std::size_t i = j; i-- > 0 && z[i] - z[j] <= limits.max_thickness + kSamePlane;) {
                const double thickness = z[i] - z[j];
                const double sum = cost[k - 1][i] + thickness * covered[j];
                if (thickness >= limits.min_thickness - kSamePlane && sum < cost[k][j]) {
                    cost[k][j] = sum;
                    from[k][j] = i;
                }
            }
        }
    }
    std::size_t best = 0;
    for (std::size_t k = 1; k <= layers; ++k) {
        if (cost[k].back() < (best == 0 ? kInfinite : cost[best].back())) {
            best = k;
        }
    }
    if (best == 0) {
        return plan.planes;
    }
    std::vector<double> planes{z.back()};
    for (std::size_t k = best, j = z.size() - 1; k > 0; --k) {
        j = from[k][j];
        planes.push_back(z[j]);
    }
    std::reverse(planes.begin(), planes.end());
    return planes;
}

}  // namespace cusp::hull_rough
