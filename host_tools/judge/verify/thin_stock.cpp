// Cuts are wider by half a sliver, so that what is not in one of them is no sliver.
#include "host_tools/judge/verify/thin_stock.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/job/job/stock_sides.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::radius_at_height;
using toolpath::Tool;

namespace {

constexpr double kWider = ThinStock::kSliver / 2;  // mm
constexpr double kLeastHalf = 0.001;               // mm, of squares
constexpr double kReduced = 0.01;                  // mm: the radius of the tool that is looked at
constexpr double kFarthest = 50;                   // mm, from the edge of an outline
constexpr double kMostCells = 4e6;

double away_from(Vec2d p, Vec2d a, Vec2d b)
{
    const Vec2d along = b - a;
    const double squared = dot(along, along);
    const double share = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
    return norm(p - (a + share * along));
}

// mm: how wide the tool is cut at z, a little more; below its tip less than nothing.
double half_width(const Tool& tool, double tip, double z)
{
    return z < tip ? -1.0 : radius_at_height(tool, z - tip) + kWider;
}

}  // namespace

struct ThinStock::Search {
    const Tool& tool;
    Vec3d from;
    Vec3d to;
    double radius;
    std::optional<StandingPlace> deepest{};

    double away(Vec2d p) const { return away_from(p, in_plan(from), in_plan(to)); }
    double bottom(double away) const
    {
        return from.z + profile_height(tool, std::clamp(away, 0.0, radius));
    }
    double least() const { return deepest ? deepest->depth : kLeastDepth; }
};

ThinStock::ThinStock(const Job& job, Place stock, const std::vector<Place>& places)
    : job_{job}, stock_{stock}
{
    const job::StockSides sides = stock_sides(job);
    stock_.low = {std::max(stock.low.x, sides.x_low), std::max(stock.low.y, sides.y_low)};
    stock_.high = {std::min(stock.high.x, sides.x_high), std::min(stock.high.y, sides.y_high)};
    for (const job::Loop& loop : job.stock_outline) {
        edges_.emplace_back(loop, edges_.empty(), kFarthest);
    }
    if (places.empty()) {
        return;
    }
    Vec2d low = places.front().low;
    Vec2d high = places.front().high;
    for (const Place& place : places) {
        low = {std::min(low.x, place.low.x), std::min(low.y, place.low.y)};
        high = {std::max(high.x, place.high.x), std::max(high.y, place.high.y)};
    }
    corner_ = low;
    pitch_ = std::max(pitch_, std::sqrt((high.x - low.x) * (high.y - low.y) / kMostCells));
    nx_ = static_cast<std::size_t>((high.x - low.x) / pitch_) + 1;
    ny_ = static_cast<std::size_t>((high.y - low.y) / pitch_) + 1;
    looked_at_.assign(nx_ * ny_, 0);
    cells_.resize(nx_ * ny_);
    for (const Place& place : places) {
        visit_cells(place.low, place.high, [&](std::size_t cell) { looked_at_[cell] = 1; });
    }
}

template <typename Visit>
void ThinStock::visit_cells(Vec2d low, Vec2d high, Visit visit) const
{
    const auto cell = [&](double at, std::size_t count) {
        return static_cast<std::size_t>(
            std::clamp(at / pitch_, 0.0, static_cast<double>(count - 1)));
    };
    const Vec2d most = corner_ + Vec2d{static_cast<double>(nx_), static_cast<double>(ny_)} * pitch_;
    if (nx_ == 0 || high.x < corner_.x || high.y < corner_.y || low.x > most.x || low.y > most.y) {
        return;
    }
    for (std::size_t i = cell(low.x - corner_.x, nx_); i <= cell(high.x - corner_.x, nx_); ++i) {
        for (std::size_t j = cell(low.y - corner_.y, ny_); j <= cell(high.y - corner_.y, ny_);
             ++j) {
            visit(i * ny_ + j);
        }
    }
}

void ThinStock::add(const Sweep& sweep)
{
    const double beside = sweep.tool->radius + kWider;
    const Vec2d low{std::min(sweep.from.x, sweep.to.x) - beside,
                    std::min(sweep.from.y, sweep.to.y) - beside};
    const Vec2d high{std::max(sweep.from.x, sweep.to.x) + beside,
                     std::max(sweep.from.y, sweep.to.y) + beside};
    const auto number = static_cast<std::uint32_t>(sweeps_.size());
    bool any = false;
    visit_cells(low, high, [&](std::size_t cell) {
        if (looked_at_[cell] != 0) {
            const Vec2d middle = corner_ + Vec2d{static_cast<double>(cell / ny_) + 0.5,
                                                 static_cast<double>(cell % ny_) + 0.5} *
                                               pitch_;
            if (away_from(middle, sweep.from, sweep.to) <= beside + pitch_) {
                cells_[cell].push_back(number);
                any = true;
            }
        }
    });
    if (any) {
        sweeps_.push_back(sweep);
    }
}

void ThinStock::cut(const Tool& tool, Vec3d from, Vec3d to)
{
    const double high = std::max(from.z, to.z);
    if (std::min(from.z, to.z) >= job_.stock_top) {
        return;
    }
    if (high < job_.stock_top) {
        add({&tool, in_plan(from), in_plan(to), high});
    }
    if (from.z != to.z) {
        const Vec3d lower = from.z < to.z ? from : to;
        add({&tool, in_plan(lower), in_plan(lower), lower.z});
    }
}

ThinStock::Sweeps ThinStock::near(Vec2d low, Vec2d high) const
{
    Sweeps out;
    ++query_;
    last_query_.resize(sweeps_.size(), 0);
    visit_cells(low, high, [&](std::size_t cell) {
        for (const std::uint32_t k : cells_[cell]) {
            if (last_query_[k] != query_) {
                last_query_[k] = query_;
                out.push_back(k);
            }
        }
    });
    return out;
}

double ThinStock::height_at(Vec2d place, const Sweeps& sweeps) const
{
    double height = job_.stock_top;
    for (const std::uint32_t k : sweeps) {
        const Sweep& sweep = sweeps_[k];
        const double away = std::max(0.0, away_from(place, sweep.from, sweep.to) - kWider);
        if (away <= sweep.tool->radius) {
            height = std::min(height, sweep.z + profile_height(*sweep.tool, away));
        }
    }
    return height;
}

// mm from the stock's edge; negative beside it.
double ThinStock::inside(Vec2d place) const
{
    double least = std::min({place.x - stock_.low.x, stock_.high.x - place.x,
                             place.y - stock_.low.y, stock_.high.y - place.y});
    for (const WallDistance& edge : edges_) {
        least = std::min(least, edge.at(place.x, place.y));
    }
    return least;
}

void ThinStock::look(const Square& square, const Sweeps& sweeps, Search& search) const
{
    const double corner = std::sqrt(2.0) * square.half;
    const double away = search.away(square.middle);
    const double nearest = std::max(0.0, away - corner);
    const double low = search.bottom(nearest) + search.least();
    if (nearest >= search.radius || low >= job_.stock_top || inside(square.middle) <= -corner) {
        return;
    }
    const double high = search.bottom(away + corner) + search.least();
    Sweeps touching;
    for (const std::uint32_t k : sweeps) {
        const Sweep& sweep = sweeps_[k];
        const double from = away_from(square.middle, sweep.from, sweep.to);
        if (from + corner <= half_width(*sweep.tool, sweep.z, low)) {
            return;
        }
        if (from - corner < half_width(*sweep.tool, sweep.z, high)) {
            touching.push_back(k);
        }
    }
    if (away < search.radius) {
        const double bottom = search.bottom(away);
        const double depth = height_at(square.middle, touching) - bottom;
        if (depth > search.least() && inside(square.middle) > 0) {
            const Vec2d from = in_plan(search.from);
            const Vec2d along = in_plan(search.to) - from;
            const double squared = dot(along, along);
            const double share =
                squared > 0 ? std::clamp(dot(square.middle - from, along) / squared, 0.0, 1.0)
                            : 0.0;
            const Vec2d tip = from + share * along;
            search.deepest = {depth, {tip.x, tip.y, search.from.z}};
        }
    }
    if (square.half <= kLeastHalf) {
        return;
    }
    const double half = square.half / 2;
    for (const Vec2d at : {Vec2d{-half, -half}, {half, -half}, {-half, half}, {half, half}}) {
        look({square.middle + at, half}, touching, search);
    }
}

std::optional<StandingPlace> ThinStock::under(const Tool& tool, Vec3d from, Vec3d to) const
{
    Search search{tool, from, to, std::max(0.0, tool.radius - kReduced)};
    const Vec2d low{std::min(from.x, to.x), std::min(from.y, to.y)};
    const Vec2d high{std::max(from.x, to.x), std::max(from.y, to.y)};
    const Vec2d beside{tool.radius, tool.radius};
    const double half = 0.5 * std::max(high.x - low.x, high.y - low.y) + tool.radius;
    look({0.5 * (low + high), half}, near(low - beside, high + beside), search);
    return search.deepest;
}

}  // namespace cusp::verify
