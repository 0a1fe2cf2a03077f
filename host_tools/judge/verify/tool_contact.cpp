// Branch and bound over tiles of each band; only what is deeper than the worst so far is looked for.
#include "host_tools/judge/verify/tool_contact.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/job/job/finish_keys.hpp"

namespace cusp::verify {

using job::Job;
using job::Operation;
using job::ToolFacts;
using toolpath::Tool;

namespace {

constexpr std::size_t kTile = 16;  // points a side
constexpr double kTouch = 1e-3;    // mm: less is no contact

// mm: what passes at several heights along a wall may differ by.
double flute_slack(const Job& job)
{
    double slack = 0.02;
    for (const Operation& operation : job.operations) {
        slack = std::max({slack, 2 * operation.tolerance.plan, 2 * operation.tolerance.floor});
    }
    return slack;
}

bool lies_in_stock(const Operation& operation)
{
    return operation.prismatic ? !operation.cuts(job::Region::kTop)
                               : operation.outline.boundary && !finishes_ground(operation);
}

}  // namespace

std::vector<ToolDisc> tool_discs(const Job& job, const Tool& tool, double slack)
{
    const auto found = job.tool_facts.find(tool.number);
    if (found == job.tool_facts.end()) {
        return {};
    }
    const ToolFacts& facts = found->second;
    const double clearance = facts.holder_clearance;
    std::vector<ToolDisc> discs;
    const auto add = [&](BodyPart part, double radius, double above, double least) {
        if (radius > slack) {
            discs.push_back({part, radius - slack, above, std::max(kTouch, slack + least)});
        }
    };
    if (facts.flute_length) {
        const double least = flute_slack(job);
        const double above = *facts.flute_length;
        add(BodyPart::kBeyondFlutes, radius_at_height(tool, above) - least, above, least);
        constexpr int kSteps = 4;  // up the cutter's round or sloping part beyond the flutes
        const double more = std::max(0.0, end_height(tool) - above) / kSteps;
        for (int k = 1; k <= kSteps && more > 0; ++k) {
            add(BodyPart::kBeyondFlutes, radius_at_height(tool, above + k * more) - least, above,
                k * more + least);
        }
    }
    if (facts.shank_diameter && *facts.shank_diameter / 2 > tool.radius) {
        add(BodyPart::kShank, *facts.shank_diameter / 2 + clearance,
            *facts.flute_length - clearance, 0);
    }
    double above = facts.length.value_or(0) - clearance;
    double widest = 0;
    for (const auto& [diameter, length] : facts.holder) {
        if (diameter > widest) {  // a narrower one above a wider touches nothing that this does not
            add(BodyPart::kHolder, diameter / 2 + clearance, above, 0);
            widest = diameter;
        }
        above += length;
    }
    return discs;
}

StockExtent stock_around(const Job& job, const HeightGrid& grid)
{
    StockExtent around;
    around.top = job.stock_top;
    if (!std::all_of(job.operations.begin(), job.operations.end(), lies_in_stock)) {
        return around;
    }
    // the grid ends up to a pitch before what it covers
    const auto side = [&](double first, std::size_t count) {
        const double low = first - grid.pitch / 2;
        return std::array{low, low + static_cast<double>(count + 1) * grid.pitch};
    };
    if (!job.stock_x) {
        around.x = side(grid.x0, grid.nx);
    }
    if (!job.stock_y) {
        around.y = side(grid.y0, grid.ny);
    }
    return around;
}

double long_enough(const Job& job, const Tool& tool, const BodyContact& contact)
{
    constexpr double kHundred = 100;
    const ToolFacts& facts = job.tool_facts.at(tool.number);
    const double now = contact.part == BodyPart::kHolder ? facts.length.value_or(0)
                                                         : facts.flute_length.value_or(0);
    return std::ceil((now + contact.depth) * kHundred) / kHundred;
}

const char* name_of_figure(BodyPart part)
{
    return part == BodyPart::kBeyondFlutes ? "beyond_flutes_max_mm"
           : part == BodyPart::kShank      ? "shank_contact_max_mm"
                                           : "holder_contact_max_mm";
}

ContactTrace::ContactTrace(const HeightGrid& grid,
                           const ToolPositions& positions,
                           std::vector<ToolDisc> discs,
                           const StockExtent& around)
    : grid_{grid}, positions_{positions}, discs_{std::move(discs)}, around_{around}
{
    for (const ToolDisc& disc : discs_) {
        beyond_.push_back({disc.part, 0, 0});
    }
    for (Tiles& tiles : tiles_) {
        for (const ToolDisc& disc : discs_) {
            tiles.searches.push_back({{disc.part, 0, 0}});
        }
    }
}

void ContactTrace::look_around(std::size_t k)
{
    const Vec3d tip = positions_.tips[k];
    const double inside = std::min(
        {tip.x - around_.x[0], around_.x[1] - tip.x, tip.y - around_.y[0], around_.y[1] - tip.y});
    for (std::size_t d = 0; d < discs_.size(); ++d) {
        const double depth = around_.top - (tip.z + discs_[d].above);
        if (inside < discs_[d].radius && depth > std::max(discs_[d].slack, beyond_[d].depth)) {
            beyond_[d] = {discs_[d].part, depth, k};
        }
    }
}

void ContactTrace::look(const std::vector<double>& heights,
                        std::size_t k,
                        std::size_t band,
                        std::size_t begin,
                        std::size_t end)
{
    Tiles& tiles = tiles_[band];
    const Vec3d tip = positions_.tips[k];
    if (band == 0) {
        look_around(k);
    }
    for (std::size_t d = 0; d < discs_.size(); ++d) {
        const ToolDisc& disc = discs_[d];
        Search& search = tiles.searches[d];
        const double height = tip.z + disc.above + std::max(disc.slack, search.worst.depth);
        if (height >= around_.top ||
            (height >= search.height &&
             norm(in_plan(tip) - search.centre) + disc.radius < search.free)) {
            continue;
        }
        if (tiles.tops.empty()) {
            tiles.rows = (grid_.ny + kTile - 1) / kTile;
            tiles.tops.assign((end - begin + kTile - 1) / kTile * tiles.rows, kUnbounded);
        }
        look_for({heights, begin, end}, disc, k, tiles, search);
    }
}

// First for stock that a lower position would meet too, so that ways down are cleared at once.
void ContactTrace::look_for(
    const Columns& columns, const ToolDisc& disc, std::size_t k, Tiles& tiles, Search& search) const
{
    constexpr double kLower = 0.25;  // mm
    constexpr double kLeast = 2;     // mm
    const Vec2d centre = in_plan(positions_.tips[k]);
    const double z = positions_.tips[k].z + disc.above;
    const double limit = disc.radius + std::max(kLeast, disc.radius / 4);
    double height = z + std::max(disc.slack, search.worst.depth);
    Nearest found = nearest(columns, centre, disc.radius, limit, height - kLower, tiles);
    if (found.top > height) {
        search.worst = {disc.part, found.top - z, k};
        height = found.top;
    }
    if (found.distance > disc.radius) {
        height -= kLower;
    } else {
        found = nearest(columns, centre, disc.radius, limit, height, tiles);
    }
    search.centre = centre;
    search.free = found.distance;
    search.height = height;
}

double ContactTrace::box_distance(const Columns& columns,
                                  std::size_t column,
                                  std::size_t row,
                                  Vec2d p) const
{
    const auto beside = [&](double first, std::size_t index, std::size_t origin, double at) {
        const double low =
            first + (static_cast<double>(origin + index * kTile) - 0.5) * grid_.pitch;
        return std::max({0.0, low - at, at - (low + kTile * grid_.pitch)});
    };
    return elementary::hypot(beside(grid_.x0, column, columns.begin, p.x),
                             beside(grid_.y0, row, 0, p.y));
}

ContactTrace::Nearest ContactTrace::nearest(const Columns& columns,
                                            Vec2d centre,
                                            double radius,
                                            double limit,
                                            double height,
                                            Tiles& tiles) const
{
    Nearest found{limit, -kUnbounded};
    const std::size_t first = std::max(columns.begin, grid_.first_column(centre.x - limit));
    const std::size_t stop = std::min(columns.end, grid_.end_column(centre.x + limit));
    const std::size_t first_row = grid_.first_row(centre.y - limit) / kTile;
    const std::size_t stop_row = (grid_.end_row(centre.y + limit) + kTile - 1) / kTile;
    if (first >= stop) {
        return found;
    }
    for (std::size_t a = (first - columns.begin) / kTile;
         a < (stop - columns.begin + kTile - 1) / kTile; ++a) {
        for (std::size_t b = first_row; b < stop_row; ++b) {
            if (tiles.tops[a * tiles.rows + b] > height &&
                box_distance(columns, a, b, centre) < std::max(radius, found.distance)) {
                scan(columns, a, b, centre, radius, height, tiles, found);
            }
        }
    }
    return found;
}

void ContactTrace::scan(const Columns& columns,
                        std::size_t column,
                        std::size_t row,
                        Vec2d centre,
                        double radius,
                        double height,
                        Tiles& tiles,
                        Nearest& found) const
{
    double top = -kUnbounded;
    double squared = found.distance * found.distance;
    const double inside = radius * radius;
    const std::size_t i0 = columns.begin + column * kTile;
    const std::size_t i1 = std::min(columns.end, i0 + kTile);
    const std::size_t j1 = std::min(grid_.ny, (row + 1) * kTile);
    for (std::size_t i = i0; i < i1; ++i) {
        for (std::size_t j = row * kTile; j < j1; ++j) {
            const double h = columns.heights[grid_.index(i, j)];
            top = std::max(top, h);
            if (h > height) {
                const double dx = grid_.x(i, j) - centre.x;
                const double dy = grid_.y(i, j) - centre.y;
                const double away = dx * dx + dy * dy;
                squared = std::min(squared, away);
                found.top = away <= inside ? std::max(found.top, h) : found.top;
            }
        }
    }
    found.distance = std::sqrt(squared);
    tiles.tops[column * tiles.rows + row] = top;
}

std::vector<BodyContact> ContactTrace::finish() const
{
    std::vector<BodyContact> worst = beyond_;
    for (const Tiles& tiles : tiles_) {
        for (std::size_t d = 0; d < worst.size(); ++d) {
            const BodyContact& other = tiles.searches[d].worst;
            const bool deeper = other.depth > worst[d].depth;
            const bool sooner = other.depth == worst[d].depth && other.depth > 0 &&
                                other.position < worst[d].position;
            if (deeper || sooner) {
                worst[d] = other;
            }
        }
    }
    return worst;
}

}  // namespace cusp::verify
