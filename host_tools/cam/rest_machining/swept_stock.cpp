// Squares are halved until one sweep covers each, or a point shows stock in the tool. Each square
// lists only the sweeps that may be the lowest somewhere in it.
#include "host_tools/cam/rest_machining/swept_stock.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::rest_machining {

namespace {

constexpr double kRounding = 1e-7;            // mm
constexpr double kLeastHalf = 1e-3;           // mm: of the smallest square
constexpr int kMostCells = 20000;             // of one proof
constexpr std::size_t kMostKept = 1U << 20U;  // cells in memory
constexpr double kMostBuckets = 250000;
constexpr double kBucket = 1.0;  // mm
constexpr double kBesideSweeps =
    20.0;  // mm: of buckets beside all sweeps, where tools may be in part

}  // namespace

void SweptStock::add(const EndProfile& end, Vec3d from, Vec3d to)
{
    if (std::min(from.z, to.z) + end.raised < top_ && end.radius > 0) {
        sweeps_.emplace_back(end, from, to);
        prepared_ = false;
    }
}

void SweptStock::add_near(const SweptStock& other, Vec2d low, Vec2d high)
{
    const auto add = [&](const ToolSweep& sweep) {
        if (sweep.low().x < high.x && low.x < sweep.high().x && sweep.low().y < high.y &&
            low.y < sweep.high().y) {
            sweeps_.push_back(sweep);
            prepared_ = false;
        }
    };
    if (!other.prepared_) {
        std::for_each(other.sweeps_.begin(), other.sweeps_.end(), add);
        return;
    }
    std::vector<std::uint32_t> found;
    for (std::size_t i = other.column_of(low.x); i <= other.column_of(high.x); ++i) {
        for (std::size_t j = other.row_of(low.y); j <= other.row_of(high.y); ++j) {
            const std::vector<std::uint32_t>& here = other.listed_[i * other.rows_ + j];
            found.insert(found.end(), here.begin(), here.end());
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::for_each(found.begin(), found.end(), [&](std::uint32_t k) { add(other.sweeps_[k]); });
}

std::size_t SweptStock::column_of(double x) const
{
    const double place = std::floor((x - origin_.x) / size_);
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(columns_) - 1));
}

std::size_t SweptStock::row_of(double y) const
{
    const double place = std::floor((y - origin_.y) / size_);
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(rows_) - 1));
}

SweptStock::Square SweptStock::square_of(std::size_t column, std::size_t row) const
{
    return {{origin_.x + (static_cast<double>(column) + 0.5) * size_,
             origin_.y + (static_cast<double>(row) + 0.5) * size_},
            size_ / 2};
}

// Lists each sweep in the buckets that its box touches.
void SweptStock::prepare() const
{
    cells_.clear();
    Vec2d low{kUnbounded, kUnbounded};
    Vec2d high{-kUnbounded, -kUnbounded};
    for (const ToolSweep& sweep : sweeps_) {
        low = {std::min(low.x, sweep.low().x), std::min(low.y, sweep.low().y)};
        high = {std::max(high.x, sweep.high().x), std::max(high.y, sweep.high().y)};
    }
    origin_ = sweeps_.empty() ? Vec2d{0, 0} : low - Vec2d{kBesideSweeps, kBesideSweeps};
    const Vec2d extent =
        sweeps_.empty() ? Vec2d{0, 0} : high - low + Vec2d{2 * kBesideSweeps, 2 * kBesideSweeps};
    size_ = std::max(kBucket, std::sqrt(extent.x * extent.y / kMostBuckets));
    columns_ = static_cast<std::size_t>(extent.x / size_) + 1;
    rows_ = static_cast<std::size_t>(extent.y / size_) + 1;
    listed_.assign(columns_ * rows_, {});
    roots_.assign(columns_ * rows_, -1);
    for (std::size_t k = 0; k < sweeps_.size(); ++k) {
        const ToolSweep& sweep = sweeps_[k];
        for (std::size_t i = column_of(sweep.low().x); i <= column_of(sweep.high().x); ++i) {
            for (std::size_t j = row_of(sweep.low().y); j <= row_of(sweep.high().y); ++j) {
                if (sweep.distance(square_of(i, j).middle) <= sweep.radius() + 0.8 * size_) {
                    listed_[i * rows_ + j].push_back(static_cast<std::uint32_t>(k));
                }
            }
        }
    }
    prepared_ = true;
}

std::vector<std::uint32_t> SweptStock::lowest_in(const Square& square,
                                                 const std::vector<std::uint32_t>& candidates) const
{
    const double reach = square.half * std::sqrt(2.0);
    const double h = square.half;
    const std::array corners{square.middle + Vec2d{-h, -h}, square.middle + Vec2d{h, -h},
                             square.middle + Vec2d{-h, h}, square.middle + Vec2d{h, h}};
    double least = top_;  // that the stock is at most, all over the square
    std::uint32_t best = 0;
    bool has_best = false;
    std::vector<std::pair<std::uint32_t, double>> bounds;  // with the least height of each
    for (const std::uint32_t k : candidates) {
        const ToolSweep& sweep = sweeps_[k];
        if (sweep.distance(square.middle) > sweep.radius() + reach) {
            continue;
        }
        const SupportPlane plane = sweep.plane_below(square.middle);
        double highest = -kUnbounded;
        double lowest = kUnbounded;
        for (const Vec2d corner : corners) {
            highest = std::max(highest, sweep.height(corner));
            lowest = std::min(lowest, plane.at(corner));
        }
        if (highest < least) {
            least = highest;
            best = k;
            has_best = true;
        }
        bounds.emplace_back(k, std::max(lowest, sweep.lowest()));
    }
    std::vector<std::uint32_t> out;
    if (has_best) {
        out.push_back(best);
    }
    for (const auto& [k, lowest] : bounds) {
        if (lowest < least - kRounding && !(has_best && k == best)) {
            out.push_back(k);
        }
    }
    return out;
}

std::int32_t SweptStock::bucket(std::size_t column, std::size_t row) const
{
    const std::size_t k = column * rows_ + row;
    if (roots_[k] < 0) {
        roots_[k] = static_cast<std::int32_t>(cells_.size());
        cells_.push_back({lowest_in(square_of(column, row), listed_[k]), -1});
    }
    return roots_[k];
}

std::int32_t SweptStock::children_of(std::int32_t cell, const Square& square) const
{
    if (cells_[static_cast<std::size_t>(cell)].children < 0) {
        const auto first = static_cast<std::int32_t>(cells_.size());
        const double h = square.half / 2;
        for (const Vec2d off : {Vec2d{-h, -h}, Vec2d{h, -h}, Vec2d{-h, h}, Vec2d{h, h}}) {
            cells_.push_back(
                {lowest_in({square.middle + off, h}, cells_[static_cast<std::size_t>(cell)].sweeps),
                 -1});
        }
        cells_[static_cast<std::size_t>(cell)].children = first;
    }
    return cells_[static_cast<std::size_t>(cell)].children;
}

// True if one sweep, or the stock's top, is nowhere in the square above the plane.
bool SweptStock::is_covered(std::int32_t cell,
                            const Square& square,
                            const SupportPlane& plane) const
{
    const double h = square.half;
    const std::array corners{square.middle + Vec2d{-h, -h}, square.middle + Vec2d{h, -h},
                             square.middle + Vec2d{-h, h}, square.middle + Vec2d{h, h}};
    const auto is_below = [&](const auto& height) {
        return std::all_of(corners.begin(), corners.end(), [&](Vec2d corner) {
            return height(corner) <= plane.at(corner) + kRounding;
        });
    };
    if (is_below([&](Vec2d) { return top_; })) {
        return true;
    }
    const std::vector<std::uint32_t>& sweeps = cells_[static_cast<std::size_t>(cell)].sweeps;
    return std::any_of(sweeps.begin(), sweeps.end(), [&](std::uint32_t k) {
        return is_below([&](Vec2d corner) { return sweeps_[k].height(corner); });
    });
}

// Recursion as deep as the halvings of a bucket, some ten.
bool SweptStock::is_clear_in(const ToolSweep& tool,
                             std::int32_t cell,
                             const Square& square,
                             int& budget) const
{
    if (tool.distance(square.middle) > tool.radius() + square.half * std::sqrt(2.0)) {
        return true;
    }
    if (is_covered(cell, square, tool.plane_below(square.middle))) {
        return true;
    }
    const double over = tool.height(square.middle);
    if (over < kInfinite) {
        double stock = top_;
        for (const std::uint32_t k : cells_[static_cast<std::size_t>(cell)].sweeps) {
            stock = std::min(stock, sweeps_[k].height(square.middle));
        }
        if (stock > over + kRounding) {
            return false;
        }
    }
    if (square.half < kLeastHalf || --budget < 0) {
        return false;
    }
    const std::int32_t first = children_of(cell, square);
    const double h = square.half / 2;
    return is_clear_in(tool, first, {square.middle + Vec2d{-h, -h}, h}, budget) &&
           is_clear_in(tool, first + 1, {square.middle + Vec2d{h, -h}, h}, budget) &&
           is_clear_in(tool, first + 2, {square.middle + Vec2d{-h, h}, h}, budget) &&
           is_clear_in(tool, first + 3, {square.middle + Vec2d{h, h}, h}, budget);
}

bool SweptStock::is_contained(const ToolSweep& tool) const
{
    const std::size_t k = column_of(tool.from().x) * rows_ + row_of(tool.from().y);
    return std::any_of(listed_[k].begin(), listed_[k].end(),
                       [&](std::uint32_t i) { return sweeps_[i].contains(tool); });
}

double SweptStock::height(Vec2d p) const
{
    if (!prepared_) {
        prepare();
    }
    double z = top_;
    for (const std::uint32_t k : listed_[column_of(p.x) * rows_ + row_of(p.y)]) {
        z = std::min(z, sweeps_[k].height(p));
    }
    return z;
}

bool SweptStock::is_clear(const ToolSweep& tool) const
{
    if (tool.lowest() >= top_) {
        return true;
    }
    if (!prepared_ || cells_.size() > kMostKept) {
        prepare();
    }
    const Vec2d low = tool.low();
    const Vec2d high = tool.high();
    // Beyond the buckets the stock is uncut.
    if (low.x < origin_.x || low.y < origin_.y ||
        high.x > origin_.x + size_ * static_cast<double>(columns_) ||
        high.y > origin_.y + size_ * static_cast<double>(rows_)) {
        return false;
    }
    if (is_contained(tool)) {
        return true;
    }
    int budget = kMostCells;
    for (std::size_t i = column_of(low.x); i <= column_of(high.x); ++i) {
        for (std::size_t j = row_of(low.y); j <= row_of(high.y); ++j) {
            if (!is_clear_in(tool, bucket(i, j), square_of(i, j), budget)) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace cusp::rest_machining
