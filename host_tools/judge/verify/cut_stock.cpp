// Cuts are wider by half a sliver, so that what is not in one of them is no sliver.
#include "host_tools/judge/verify/cut_stock.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/job/job/stock_sides.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Tool;

namespace {

constexpr double kWider = CutStock::kSliver / 2;  // mm
constexpr double kLeastHalf = 0.001;              // mm, of squares
constexpr double kDeeper = 1e-4;                  // mm: less than this is no deeper place
constexpr double kFarthest = 50;                  // mm, from the edge of an outline
constexpr double kMostCells = 4e6;

}  // namespace

struct CutStock::Search {
    const ToolWay& way;
    double wider;  // mm: of the cuts
    std::optional<StandingPlace> deepest{};
    Vec2d place{};  // in plan, where the stock stands

    double least() const { return deepest ? deepest->depth + kDeeper : kRapidCutAllowed; }
};

ToolWay CutStock::way_of(const Tool& tool, Vec3d from, Vec3d to)
{
    return {tool, std::max(0.0, tool.radius - kReduced), from, to};
}

CutStock::CutStock(const Job& job, const PartBox& stock, const std::vector<ToolWay>& ways)
    : job_{job}
{
    const job::StockSides sides = stock_sides(job);
    low_ = {std::max(stock.x_low, sides.x_low), std::max(stock.y_low, sides.y_low)};
    high_ = {std::min(stock.x_high, sides.x_high), std::min(stock.y_high, sides.y_high)};
    for (const job::Loop& loop : job.stock_outline) {
        edges_.emplace_back(loop, edges_.empty(), kFarthest);
    }
    if (ways.empty()) {
        return;
    }
    Vec2d low = ways.front().low();
    Vec2d high = ways.front().high();
    for (const ToolWay& way : ways) {
        low = {std::min(low.x, way.low().x), std::min(low.y, way.low().y)};
        high = {std::max(high.x, way.high().x), std::max(high.y, way.high().y)};
    }
    corner_ = low;
    pitch_ = std::max(pitch_, std::sqrt((high.x - low.x) * (high.y - low.y) / kMostCells));
    nx_ = static_cast<std::size_t>((high.x - low.x) / pitch_) + 1;
    ny_ = static_cast<std::size_t>((high.y - low.y) / pitch_) + 1;
    looked_at_.assign(nx_ * ny_, 0);
    cells_.resize(nx_ * ny_);
    for (const ToolWay& way : ways) {
        visit_cells(way, [&](std::size_t cell) { looked_at_[cell] = 1; });
    }
}

template <typename Visit>
void CutStock::visit_cells(const ToolWay& way, Visit visit) const
{
    const Vec2d low = way.low() - Vec2d{kWider, kWider} - corner_;
    const Vec2d high = way.high() + Vec2d{kWider, kWider} - corner_;
    const double reach = way.radius() + kWider + pitch_;
    if (nx_ == 0 || std::min(high.x, high.y) < 0) {
        return;
    }
    const auto end = [&](double at, std::size_t count) {
        return static_cast<std::size_t>(
            std::clamp(at / pitch_ + 1, 0.0, static_cast<double>(count)));
    };
    const auto first = [&](double at) {
        return static_cast<std::size_t>(std::clamp(at / pitch_, 0.0, kMostCells));
    };
    for (std::size_t i = first(low.x); i < end(high.x, nx_); ++i) {
        for (std::size_t j = first(low.y); j < end(high.y, ny_); ++j) {
            const Vec2d middle = Vec2d{static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5};
            if (way.away(corner_ + middle * pitch_) <= reach) {
                visit(i * ny_ + j);
            }
        }
    }
}

void CutStock::cut(const Tool& tool, Vec3d from, Vec3d to)
{
    const ToolWay sweep{tool, tool.radius, from, to};
    if (sweep.least_z() >= job_.stock_top) {
        return;
    }
    const auto number = static_cast<std::uint32_t>(sweeps_.size());
    bool any = false;
    visit_cells(sweep, [&](std::size_t cell) {
        if (looked_at_[cell] != 0) {
            cells_[cell].push_back(number);
            any = true;
        }
    });
    if (any) {
        sweeps_.push_back(sweep);
    }
}

// In each cell the latest first: they lie lowest, mostly.
CutStock::Sweeps CutStock::near(const ToolWay& way, std::size_t cuts) const
{
    Sweeps out;
    std::vector<bool> is_known(cuts);
    visit_cells(way, [&](std::size_t cell) {
        const Sweeps& all = cells_[cell];
        for (auto k = std::lower_bound(all.begin(), all.end(), cuts); k != all.begin();) {
            --k;
            if (!is_known[*k]) {
                is_known[*k] = true;
                out.push_back(*k);
            }
        }
    });
    return out;
}

double CutStock::height_at(Vec2d place, const Sweeps& sweeps, double wider) const
{
    double height = job_.stock_top;
    for (const std::uint32_t k : sweeps) {
        if (sweeps_[k].is_below(place, wider, height)) {
            height = std::min(height, sweeps_[k].lowest(place, wider));
        }
    }
    return height;
}

// mm from the stock's edge; negative beside it.
double CutStock::inside(Vec2d place) const
{
    double least =
        std::min({place.x - low_.x, high_.x - place.x, place.y - low_.y, high_.y - place.y});
    for (const WallDistance& edge : edges_) {
        least = std::min(least, edge.at(place.x, place.y));
    }
    return least;
}

void CutStock::look(const Square& square, const Sweeps& sweeps, Search& search) const
{
    const double corner = std::sqrt(2.0) * square.half;
    const double low = search.way.lowest(square.middle, corner) + search.least();
    if (low >= job_.stock_top || inside(square.middle) <= -corner) {
        return;
    }
    // All that cut here count, those over the tool too: they leave the less the deeper places are known.
    Sweeps cutting;
    for (const std::uint32_t k : sweeps) {
        if (sweeps_[k].is_below(square.middle, search.wider - corner, low)) {
            return;
        }
        if (sweeps_[k].is_below(square.middle, search.wider + corner, job_.stock_top)) {
            cutting.push_back(k);
        }
    }
    const double bottom = search.way.lowest(square.middle, 0);
    if (bottom < kUnbounded && inside(square.middle) >= 0) {
        const double depth = height_at(square.middle, cutting, search.wider) - bottom;
        if (depth > search.least()) {
            search.deepest = {depth, search.way.tip_over(square.middle)};
            search.place = square.middle;
        }
    }
    if (square.half <= kLeastHalf) {
        return;
    }
    const double half = square.half / 2;
    for (const Vec2d at : {Vec2d{-half, -half}, {half, -half}, {-half, half}, {half, half}}) {
        look({square.middle + at, half}, cutting, search);
    }
}

std::optional<StandingPlace> CutStock::under(const ToolWay& way, std::size_t cuts) const
{
    const Sweeps all = near(way, cuts);
    Search search{way, kWider};
    const Vec2d low = way.low();
    const Vec2d high = way.high();
    const double half = 0.5 * std::max(high.x - low.x, high.y - low.y);
    look({0.5 * (low + high), half}, all, search);
    if (search.deepest) {  // no sliver: it is measured between the cuts as they are
        search.wider = 0;
        look({search.place, kSliver}, all, search);
    }
    return search.deepest;
}

}  // namespace cusp::verify
