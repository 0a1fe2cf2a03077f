// Each operation by its words in docs/job_file.md: sides, depths, shapes of tools.
#include "host_tools/judge/verify/cut_regions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/job/job/chamfer_tip.hpp"
#include "host_tools/job/job/hole_depth.hpp"
#include "host_tools/job/job/loop_shape.hpp"
#include "host_tools/job/job/thread.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/part_heights.hpp"

namespace cusp::verify {

using job::Chain;
using job::Hole;
using job::Job;
using job::loop_polyline;
using job::NestedLoop;
using job::Operation;
using job::Prismatic;
using job::ProfileSide;
using job::radius_of_hole;
using toolpath::end_height;
using toolpath::Tool;

namespace {

constexpr double kBoxChord = 0.01;  // mm

// mm: the widest that a profile clears beside its wall: the tool, the allowance, its leads. A lead is a quarter of a
// circle, and its far end the square root of two radii from where it meets the contour: beside convex walls and
// corners that is how far it may lead away from the wall.
double widest(const Operation& operation)
{
    const Prismatic& cut = *operation.prismatic;
    const double radius = operation.tool.radius;
    const double lead =
        std::sqrt(2.0) * std::max(cut.lead_in.value_or(radius), cut.lead_out.value_or(radius));
    return 2 * radius + operation.passes.allowance + lead + cut.width;
}

// mm: half the width of a groove along curves.
double half_width(const Operation& operation)
{
    return std::max(operation.tool.radius,
                    operation.cuts(job::Region::kGrooves) ? operation.prismatic->width / 2 : 0.0);
}

bool is_round_bolts(const Operation& operation)
{
    const job::Thread* const thread = thread_of(operation);
    return thread != nullptr && thread->outside;
}

// mm: of a mill's way round a bolt, from the grooves out to where it comes on and off.
double ring_width(const Operation& operation)
{
    constexpr double kLeads = 1.0;  // mm over the blank
    const job::Thread& thread = *thread_of(operation);
    return (thread.blank() - thread.wall()) / 2 + 2 * operation.tool.radius + kLeads;
}

// A closed loop on an open chain: no line from its end to its start.
Chain there_and_back(Chain chain)
{
    for (std::size_t k = chain.size(); k-- > 0;) {
        chain.push_back(reversed(chain[k]));
    }
    return chain;
}

// The tip of an engraving on a floor, by drops at places along its curves.
class EngravedTips {
public:
    EngravedTips(const Operation& operation, double spacing)
        : tip_{toolpath::tip_of(operation.tool)},
          depth_{operation.prismatic->depth},
          spacing_{spacing},
          model_{operation.part.floor}
    {
    }

    std::vector<Vec3d> along(const std::vector<Vec2d>& line)
    {
        out_.clear();
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const Vec2d way = line[i + 1] - line[i];
            const int steps = std::max(1, static_cast<int>(std::ceil(norm(way) / spacing_)));
            for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
                if (const auto at = dropped(line[i] + (static_cast<double>(k) / steps) * way)) {
                    if (!out_.empty()) {
                        refine(out_.back(), *at);
                    }
                    out_.push_back(*at);
                }
            }
        }
        return out_;
    }

    double top() const { return top_; }

private:
    std::optional<Vec3d> dropped(Vec2d at)
    {
        const std::optional<double> z = model_.drop_height(tip_, at.x, at.y, guess_);
        if (!z) {
            return std::nullopt;
        }
        guess_ = z;
        top_ = std::max(top_, *z);
        return Vec3d{at.x, at.y, *z - depth_};
    }

    // Over creases positions lie so close that the straight line between them is the tip's way.
    void refine(Vec3d from, Vec3d to)
    {
        constexpr double kStraight = 5e-5;  // mm
        constexpr double kShortest = 5e-4;  // mm
        const auto middle = dropped(0.5 * (in_plan(from) + in_plan(to)));
        if (!middle || norm(in_plan(to) - in_plan(from)) < kShortest ||
            std::abs(middle->z - 0.5 * (from.z + to.z)) <= kStraight) {
            return;
        }
        refine(from, *middle);
        out_.push_back(*middle);
        refine(*middle, to);
    }

    toolpath::Tool tip_;
    double depth_;
    double spacing_;
    part_model::PartModel model_;
    std::optional<double> guess_;
    std::vector<Vec3d> out_;
    double top_{-kUnbounded};
};

// The stock that an engraving on a floor leaves: cut by its tool, the tip wherever the curves say,
// as deep below the surfaces as it has to be.
std::vector<double> engraved_heights(const Operation& operation, const HeightGrid& grid)
{
    const toolpath::Tool tip = toolpath::tip_of(operation.tool);
    const double spacing =
        std::min(grid.pitch / 2, tip.radius > 0.01 ? tip.radius / 10 : grid.pitch / 4);
    EngravedTips tips{operation, spacing};
    std::vector<ToolPositions> runs;
    for (const Chain& chain : operation.prismatic->chains) {
        ToolPositions run{operation.tool, tips.along(open_polyline(chain, kBoxChord / 10)), {}};
        run.rapid.resize(run.tips.size(), false);
        runs.push_back(std::move(run));
    }
    MachinedStock stock{grid, tips.top() + operation.prismatic->depth + end_height(operation.tool)};
    for (const ToolPositions& run : runs) {
        stock.cut(run, spacing, [](double) {});
    }
    return stock.heights();
}

}  // namespace

std::vector<Vec2d> open_polyline(const Chain& chain, double chord)
{
    std::vector<Vec2d> line = loop_polyline(chain, chord);
    line.back() = in_plan(point_at(chain.back(), chain.back().domain_end()));
    return line;
}

CutRegion::CutRegion(const Operation& operation, const HeightGrid& grid)
    : operation_{&operation},
      grid_{grid},
      cap_{operation.prismatic ? widest(operation) + 2 * grid.pitch
                               : 2 * operation.tool.radius + 2 * grid.pitch}
{
    if (operation.outline.boundary) {
        walls_.emplace_back(*operation.outline.boundary, true, cap_);
        for (const auto& island : operation.outline.islands) {
            walls_.emplace_back(island, false, cap_);
        }
    } else if (operation.prismatic && !operation.cuts(job::Region::kHoles)) {
        for (const NestedLoop& loop : operation.prismatic->loops) {
            walls_.emplace_back(loop.loop, true, cap_);
        }
        for (const Chain& chain : operation.prismatic->chains) {
            walls_.emplace_back(there_and_back(chain), true, cap_);
            if (operation.cuts(job::Region::kOutline) &&
                operation.prismatic->side != ProfileSide::kOn) {
                lines_.emplace_back(open_polyline(chain, kWallChord));
            }
        }
    }
    if (operation.cuts(job::Region::kGrooves) && !operation.part.floor.empty()) {
        heights_ = engraved_heights(operation, grid);
    }
    if (!operation.prismatic) {
        heights_ = part_heights(operation.part.floor, operation.part.mesh, grid).z;
        if (stays_with_ground(operation)) {
            ground_.emplace(operation, heights_, grid);
        }
    }
}

// A chamfer may have some loops of a part alone, such as mouths of holes: the nearest says where the material is.
double CutRegion::beside_edges(double x, double y) const
{
    constexpr double kCommon = 1e-6;  // mm: loops with an edge in common
    double least = kUnbounded;
    double inward = -cap_;
    for (std::size_t n = 0; n < walls_.size(); ++n) {
        const double d = (operation_->prismatic->loops[n].hole ? -1 : 1) * walls_[n].at(x, y);
        const bool is_nearer = std::abs(d) < least - kCommon;
        if (is_nearer || (std::abs(d) <= least + kCommon && d > 0)) {
            least = std::min(least, std::abs(d));
            inward = d;
        }
    }
    return inward;
}

double CutRegion::from_curves(double x, double y) const
{
    double least = cap_;
    for (const WallDistance& wall : walls_) {
        least = std::min(least, std::abs(wall.at(x, y)));
    }
    return least;
}

double CutRegion::into_material(double x, double y) const
{
    if (operation_->cuts(job::Region::kEdges)) {
        return beside_edges(x, y);
    }
    double least = cap_;
    bool inside = false;
    for (const WallDistance& wall : walls_) {
        const double d = wall.at(x, y);
        inside = inside != (d > 0);
        least = std::min(least, std::abs(d));
    }
    return inside ? least : -least;
}

std::size_t CutRegion::nearest_loop(double x, double y) const
{
    std::size_t best = 0;
    double least = kUnbounded;
    for (std::size_t n = 0; n < walls_.size(); ++n) {
        const double d = std::abs(walls_[n].at(x, y));
        best = d < least ? n : best;
        least = std::min(least, d);
    }
    return best;
}

double CutRegion::room(double x, double y) const
{
    if (operation_->outline.boundary) {
        double least = cap_;
        for (const WallDistance& wall : walls_) {
            least = std::min(least, wall.at(x, y));
        }
        return least;
    }
    if (operation_->cuts(job::Region::kHoles)) {
        return hole_at(x, y).inside;
    }
    if (!lines_.empty()) {
        return beside_lines(x, y).value_or(-cap_);
    }
    const double inward = into_material(x, y);
    const bool within = operation_->cuts(job::Region::kValleys) ||
                        operation_->prismatic->side == ProfileSide::kInside;
    return within ? inward : -inward;
}

std::optional<double> CutRegion::beside_lines(double x, double y) const
{
    std::size_t best = 0;
    double nearest = kUnbounded;
    for (std::size_t n = 0; n < walls_.size(); ++n) {
        const double away = std::abs(walls_[n].at(x, y));
        best = away < nearest ? n : best;
        nearest = std::min(nearest, away);
    }
    if (nearest >= cap_) {
        return cap_;
    }
    const std::optional<double> left = lines_[best].left(x, y);
    if (!left) {
        return std::nullopt;
    }
    return operation_->prismatic->side == ProfileSide::kInside ? *left : -*left;
}

RegionAt CutRegion::profile_at(double x, double y) const
{
    const Prismatic& cut = *operation_->prismatic;
    const double bottom = cut.top - cut.depth;
    if (cut.side == ProfileSide::kOn) {
        return engraved_at(x, y);
    }
    // round the ends of lines the tool may be on either side
    const double away =
        lines_.empty() ? room(x, y) : beside_lines(x, y).value_or(from_curves(x, y));
    return {std::min(away, widest(*operation_) - away), bottom};
}

// The nearest bolt: the ring that a thread mill clears around its grooves.
RegionAt CutRegion::ring_at(double x, double y) const
{
    const Prismatic& cut = *operation_->prismatic;
    double inside = -kUnbounded;
    for (const Hole& hole : cut.holes) {
        const double away = norm(Vec2d{x, y} - hole.at) - hole.diameter / 2;
        inside = std::max(inside, std::min(away, ring_width(*operation_) - away));
    }
    return {inside, cut.top - cut.depth};
}

// The nearest hole's wall: drilled as wide as the tool, bored as wide as drawn.
RegionAt CutRegion::hole_at(double x, double y) const
{
    const Prismatic& cut = *operation_->prismatic;
    if (is_round_bolts(*operation_)) {
        return ring_at(x, y);
    }
    const Tool& tool = operation_->tool;
    double beyond = kUnbounded;
    double tip = cut.top - cut.depth;
    for (const Hole& hole : cut.holes) {
        const double d = norm(Vec2d{x, y} - hole.at) - radius_of_hole(cut, hole, tool);
        tip = d < beyond ? tip_in_hole(cut, hole, tool) : tip;
        beyond = std::min(beyond, d);
    }
    return {-beyond,
            tip + profile_height(tool, std::clamp(beyond + tool.radius, 0.0, tool.radius))};
}

// The groove of a cone whose tip runs beside the edge: its inner flank breaks the edge, its outer one rises again.
RegionAt CutRegion::beside_edge_at(double x, double y) const
{
    const Prismatic& cut = *operation_->prismatic;
    const Tool& tool = operation_->tool;
    const double slope = 1 / elementary::tan(tool.tip_angle / 2);
    const double away = tool.tip_radius + job::kChamferTip;
    const double inward = into_material(x, y);
    const double from_tip = std::clamp(std::abs(inward + away), 0.0, tool.radius);
    return {std::min(cut.width - inward, away + tool.radius + inward),
            cut.top - (cut.width + job::kChamferTip) * slope + profile_height(tool, from_tip), 0.0,
            operation_->tolerance.plan * slope, 0.0};
}

// Flanks of the vee rise to the outlines. The tip's flat leaves no more beside the axis than its
// radius over the slope.
RegionAt CutRegion::carved_at(double x, double y) const
{
    const Prismatic& cut = *operation_->prismatic;
    const double slope = 1 / elementary::tan(operation_->tool.tip_angle / 2);
    const double inward = into_material(x, y);
    const bool on_floor = inward * slope >= cut.depth;
    const double beside = operation_->tolerance.plan * slope;
    const double deep = std::clamp(inward * slope, 0.0, cut.depth);
    return {inward, cut.top - deep,
            operation_->tool.tip_radius * slope + (on_floor ? *operation_->tolerance.scallop : 0.0),
            std::min(beside, cut.depth - deep), std::min(beside, deep)};
}

// The groove of the tool's profile; a path within its tolerance has it so much nearer or farther.
RegionAt CutRegion::engraved_at(double x, double y) const
{
    const Tool& tool = operation_->tool;
    const double away = from_curves(x, y);
    const double tolerance = operation_->tolerance.plan;
    const double half = half_width(*operation_);
    const double level = half - tool.radius;  // of its bottom, on either side
    const auto height = [&](double distance) {
        return profile_height(tool, std::clamp(distance - level, 0.0, tool.radius));
    };
    const double exact = height(away);
    return {half - away, operation_->prismatic->top - operation_->prismatic->depth + exact, 0.0,
            exact - height(std::min(away, half) - tolerance),
            away + tolerance < half ? height(away + tolerance) - exact : kUnbounded};
}

RegionAt CutRegion::at(double x, double y, std::size_t k) const
{
    if (!operation_->prismatic) {
        const double inside = ground_ ? ground_->room(x, y) : walls_.empty() ? cap_ : room(x, y);
        return {inside, std::isfinite(heights_[k]) ? heights_[k] : -kUnbounded};
    }
    const Prismatic& cut = *operation_->prismatic;
    const double bottom = cut.top - cut.depth;
    const double radius = operation_->tool.radius;
    if (operation_->cuts(job::Region::kLevelPocket)) {
        return {room(x, y), bottom,
                operation_->tool.corner_radius > 0 ? *operation_->tolerance.scallop : 0.0};
    }
    if (operation_->cuts(job::Region::kValleys)) {
        return carved_at(x, y);
    }
    if (operation_->cuts(job::Region::kOutline)) {
        return profile_at(x, y);
    }
    if (operation_->cuts(job::Region::kHoles)) {
        return hole_at(x, y);
    }
    if (operation_->cuts(job::Region::kGrooves)) {
        if (!heights_.empty()) {
            return {radius - from_curves(x, y), heights_[k]};
        }
        return engraved_at(x, y);
    }
    if (operation_->cuts(job::Region::kEdges)) {
        return beside_edge_at(x, y);
    }
    return {cap_, bottom};  // face
}

RegionAt CutRegion::around(Vec2d place) const
{
    const double near = grid_.pitch / 2;
    RegionAt lowest = at(place.x, place.y, 0);
    if (heights_.empty()) {
        return lowest;
    }
    lowest.floor = kUnbounded;
    for (std::size_t i = grid_.first_column(place.x - near); i < grid_.end_column(place.x + near);
         ++i) {
        for (std::size_t j = grid_.first_row(place.y - near); j < grid_.end_row(place.y + near);
             ++j) {
            const double z = heights_[grid_.index(i, j)];
            lowest.floor = std::min(lowest.floor, std::isfinite(z) ? z : -kUnbounded);
        }
    }
    return lowest;
}

std::vector<CutRegion> cut_regions(const Job& job, const HeightGrid& grid)
{
    std::vector<CutRegion> regions;
    for (const Operation& operation : job.operations) {
        regions.emplace_back(operation, grid);
    }
    return regions;
}

std::optional<PlanBox> prismatic_box(const Job& job)
{
    PlanBox box{{kUnbounded, kUnbounded}, {-kUnbounded, -kUnbounded}};
    const auto widen = [&](Vec2d p, double by) {
        box.low = {std::min(box.low.x, p.x - by), std::min(box.low.y, p.y - by)};
        box.high = {std::max(box.high.x, p.x + by), std::max(box.high.y, p.y + by)};
    };
    for (const Operation& operation : job.operations) {
        if (!operation.prismatic) {
            continue;
        }
        const double around =
            operation.cuts(job::Region::kOutline) &&
                    operation.prismatic->side != ProfileSide::kInside
                ? widest(operation)
            : is_round_bolts(operation)
                ? operation.prismatic->holes.front().diameter / 2 + ring_width(operation)
                : half_width(operation);
        const auto add = [&](const Chain& chain) {
            for (const Vec2d p : loop_polyline(chain, kBoxChord)) {
                widen(p, around);
            }
        };
        for (const NestedLoop& loop : operation.prismatic->loops) {
            add(loop.loop);
        }
        std::for_each(operation.prismatic->chains.begin(), operation.prismatic->chains.end(), add);
        for (const Hole& hole : operation.prismatic->holes) {
            widen(hole.at, around);
        }
        if (operation.outline.boundary) {
            add(*operation.outline.boundary);
        }
    }
    return box.low.x < box.high.x ? std::optional{box} : std::nullopt;
}

}  // namespace cusp::verify
