// Rows spaced for level ground first; strips between two rows are halved where necessary.
#include "host_tools/cam/adaptive_isocurve/mesh_isocurves.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/finishing/mesh_check.hpp"
#include "host_tools/cam/finishing/mesh_pencil_curves.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/surface_operation.hpp"
#include "host_tools/geometry/part_model/tool_cap.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_isocurve {

using finishing::kUprightNormal;
using finishing::mesh_pencil_curves;
using finishing::MeshCheck;
using finishing::MeshLeft;
using finishing::Points;
using finishing::report_uncovered_points;
using finishing::report_walls_over_nothing;
using finishing::SurfaceOperation;
using job::Job;
using job::kRoughingDone;
using job::Operation;
using part_model::cap_reach;
using part_model::PartModel;
using part_model::ToolProfile;
using toolpath::PlannedOperation;
using toolpath::ToolShape;

namespace {

constexpr double kRowShare = 0.9;        // of the stepover on level ground
constexpr double kWidest = 1.8;          // radii: the same
constexpr double kSampleShare = 0.5;     // of it: between samples along a row
constexpr double kNarrowest = 1.0 / 64;  // of it: between neighbours
// Share of the scallop allowed in the middle between neighbours: the ridge is a little higher.
constexpr double kMiddleShare = 0.85;
constexpr int kRowEndHalvings = 20;
// Cosine between the normal and the direction to the centre, from which on a ball beside the mesh
// touches a facet, not a rim; and beyond its box.
constexpr double kFacing = 0.985;
constexpr double kOutside = 0.9995;
constexpr double kShortestRun = 1e-3;  // mm
constexpr double kRowsDone = 0.2;      // of the progress
constexpr double kStripsDone = 0.7;

struct Range {
    double from;
    double to;
};

// A strip between two neighbours, with the ranges in which a middle may be missing.
struct MeshStrip {
    double low;
    double high;
    std::vector<Range> ranges;
};

// The scallop of passes iso_distance apart on level ground, the tolerance included.
double scallop_of(const Job& job, const Operation& operation, double outward)
{
    if (!finish_keys(operation).iso_distance) {
        return *operation.tolerance.scallop;
    }
    if (operation.tool.shape != ToolShape::kBall) {
        throw InputError(fmt::format(
            "{}: {}: iso_distance goes with a ball; give the scallop for tool {}, which is {}",
            job.file, operation.name(), operation.tool.number, name_of(operation.tool.shape)));
    }
    const double radius = operation.tool.radius;
    const double half = std::min(0.5 * *finish_keys(operation).iso_distance, 0.95 * radius);
    return outward + radius - std::sqrt(radius * radius - half * half);
}

class MeshPlanner {
public:
    MeshPlanner(const Job& job, const Operation& operation, const LevelFloors& floors)
        : job_{job},
          operation_{operation},
          work_{job, operation, {}},
          tool_{work_.path_fitter().offset_tool()},
          radius_{tool_.radius},
          scallop_{scallop_of(job, operation, work_.outward())},
          scallop_check_{finishing::mesh_check(
              operation.part.mesh, work_.path_fitter(), scallop_, work_.path_off())}
    {
        leave_out(floors, work_);
        const Vec3d low = work_.model().box_low();
        const Vec3d high = work_.model().box_high();
        if (finish_keys(operation).direction == 'v') {
            along_ = {0, 1, 0};
            across_ = {1, 0, 0};
        }
        origin_ = {low.x, low.y, 0};
        length_ = dot(high - low, along_);
        width_ = dot(high - low, across_);
        row_ = kRowShare * std::min(kWidest * operation.tool.radius,
                                    2 * cap_reach(ToolProfile{operation.tool}, {0, 0, 1}, {1, 0, 0},
                                                  scallop_ - work_.outward()));
        if (finish_keys(operation).iso_distance) {
            row_ = std::min(row_, 0.999 * *finish_keys(operation).iso_distance);
        }
        sample_pitch_ = kSampleShare * row_;
    }

    PlannedOperation plan()
    {
        add_rows();
        add_pencil_passes();
        scallop_check_->check();
        scallop_check_->add_missing_passes([&](const Points& tips) { add_pass(tips); });
        return finished();
    }

private:
    void report(double share) const
    {
        job_.report_progress(share, operation_.passes.roughing ? kRoughingDone : 0);
    }

    using Dropped = PartModel::DroppedTool;

    Vec3d place(double s, double t) const { return origin_ + along_ * s + across_ * t; }

    Range whole() const { return {-radius_, length_ + radius_}; }

    std::optional<Dropped> drop_at(double s, double t) const
    {
        const Vec3d at = place(s, t);
        std::optional<Dropped> found = work_.model().drop_tool(tool_, at.x, at.y);
        if (found && ((!work_.model().height_at(at.x, at.y) && !is_on(*found, s, t)) ||
                      !work_.area().holds(found->point, found->lean))) {
            return std::nullopt;
        }
        return found;
    }

    // Beside the mesh, a tool that touches a rim or a wall only has nothing to cut.
    bool is_on(const Dropped& at, double s, double t) const
    {
        const double facing = dot(at.lean, at.normal);
        const bool outside = s < 0 || s > length_ || t < 0 || t > width_;
        return outside ? facing >= kOutside && at.normal.z >= kUprightNormal : facing >= kFacing;
    }

    void add_pass(const Points& tips) { scallop_check_->add(work_.add_pass(tips)); }

    void add_rows()
    {
        // A ball on a slope that ends in a rim is beyond the rim.
        const int rows = std::max(1, static_cast<int>(std::ceil(width_ / row_)));
        const int beyond = static_cast<int>(std::ceil(radius_ / row_));
        std::vector<MeshStrip> strips;
        std::vector<Cut> cuts;
        for (int k = -beyond; k <= rows + beyond; ++k) {
            const double t = width_ * k / rows;
            cuts.push_back({whole(), t});
            if (k > -beyond) {
                strips.push_back({width_ * (k - 1) / rows, t, {whole()}});
            }
        }
        add(cuts);
        report(kRowsDone);
        while (!strips.empty()) {
            strips = halved(strips);
        }
        report(kStripsDone);
    }

    // The halves of strips whose middle misses passes, which are added. Every second strip is looked
    // at at once: neighbours see each other's passes.
    std::vector<MeshStrip> halved(const std::vector<MeshStrip>& strips)
    {
        std::vector<std::vector<Range>> missing(strips.size());
        for (std::size_t first = 0; first < 2; ++first) {
            scallop_check_->share_out(
                (strips.size() + 1 - first) / 2, [&](const MeshCheck& check, std::size_t k) {
                    missing[2 * k + first] = missing_in(strips[2 * k + first], check);
                });
            std::vector<Cut> cuts;
            for (std::size_t k = first; k < strips.size(); k += 2) {
                for (const Range& range : missing[k]) {
                    cuts.push_back({range, 0.5 * (strips[k].low + strips[k].high)});
                }
            }
            add(cuts);
        }
        std::vector<MeshStrip> out;
        for (std::size_t k = 0; k < strips.size(); ++k) {
            if (!missing[k].empty()) {
                const double middle = 0.5 * (strips[k].low + strips[k].high);
                out.push_back({strips[k].low, middle, missing[k]});
                out.push_back({middle, strips[k].high, missing[k]});
            }
        }
        return out;
    }

    std::vector<Range> missing_in(const MeshStrip& strip, const MeshCheck& check) const
    {
        std::vector<Range> missing;
        if (strip.high - strip.low >= kNarrowest * row_) {
            for (const Range& range : strip.ranges) {
                find_missing(range, strip, check, missing);
            }
        }
        return missing;
    }

    // The parts of a range, a sample longer, where a pass is missing in the middle of the strip.
    void find_missing(const Range& range,
                      const MeshStrip& strip,
                      const MeshCheck& check,
                      std::vector<Range>& missing) const
    {
        const int samples =
            std::max(1, static_cast<int>(std::ceil((range.to - range.from) / sample_pitch_)));
        for (int k = 0; k <= samples; ++k) {
            const double s = range.from + (range.to - range.from) * k / samples;
            if (!is_missing(s, strip, check)) {
                continue;
            }
            const Range around{std::max(whole().from, s - sample_pitch_),
                               std::min(whole().to, s + sample_pitch_)};
            if (!missing.empty() && around.from <= missing.back().to) {
                missing.back().to = std::max(missing.back().to, around.to);
            } else {
                missing.push_back(around);
            }
        }
    }

    bool is_missing(double s, const MeshStrip& strip, const MeshCheck& check) const
    {
        const std::optional<Dropped> here = drop_at(s, 0.5 * (strip.low + strip.high));
        if (!here) {
            return false;
        }
        return !check.is_covered(here->point, here->lean, kMiddleShare) ||
               (finish_keys(operation_).iso_distance && too_far_apart(s, strip));
    }

    // If the tip or its contact jumps, no distance is small enough: such places do not count.
    bool too_far_apart(double s, const MeshStrip& strip) const
    {
        const std::optional<Dropped> low = drop_at(s, strip.low);
        const std::optional<Dropped> high = drop_at(s, strip.high);
        const double delta = *finish_keys(operation_).iso_distance;
        const auto far = [&](Vec3d a, Vec3d b) {
            const double way = norm(b - a);
            return way > delta && way < delta + 4 * (strip.high - strip.low);
        };
        return low && high && (far(low->tip, high->tip) || far(low->point, high->point));
    }

    // A part of a row.
    struct Cut {
        Range range;
        double t;
    };

    // Adds passes where the tool is on the mesh.
    void add(const std::vector<Cut>& cuts)
    {
        std::vector<std::vector<SurfaceOperation::FittedPass>> passes(cuts.size());
        parallel::for_each(cuts.size(), [&](std::size_t k) {
            work_.model().forget_queries();
            for (const Range& run : runs_in(cuts[k])) {
                passes[k].push_back(work_.fitted_pass(work_.path_fitter().sample_dropped(
                    place(run.from, cuts[k].t), place(run.to, cuts[k].t))));
            }
        });
        work_.model().forget_queries();
        for (std::vector<SurfaceOperation::FittedPass>& some : passes) {
            for (SurfaceOperation::FittedPass& pass : some) {
                scallop_check_->add(work_.add(std::move(pass)));
                ++curves_;
            }
        }
    }

    std::vector<Range> runs_in(const Cut& cut) const
    {
        const Range& range = cut.range;
        std::vector<Range> out;
        const auto close = [&](Range run) {
            if (run.to - run.from > kShortestRun) {
                out.push_back(run);
            }
        };
        const int samples =
            std::max(1, static_cast<int>(std::ceil((range.to - range.from) / sample_pitch_)));
        bool was_on = false;
        double begin = range.from;
        double last = range.from;
        for (int k = 0; k <= samples; ++k) {
            const double s = range.from + (range.to - range.from) * k / samples;
            const bool on = drop_at(s, cut.t).has_value();
            if (on && !was_on) {
                begin = k > 0 ? run_end(last, s, cut.t) : s;
            } else if (!on && was_on) {
                close({begin, run_end(s, last, cut.t)});
            }
            was_on = on;
            last = s;
        }
        if (was_on) {
            close({begin, range.to});
        }
        return out;
    }

    double run_end(double outside, double inside, double t) const
    {
        for (int turn = 0; turn < kRowEndHalvings; ++turn) {
            const double middle = 0.5 * (outside + inside);
            (drop_at(middle, t) ? inside : outside) = middle;
        }
        return inside;
    }

    void add_pencil_passes()
    {
        for (const Points& crease : mesh_pencil_curves(work_.path_fitter(), sample_pitch_)) {
            for (const Points& pass : work_.creases_in_area(crease)) {
                add_pass(pass);
            }
        }
    }

    PlannedOperation finished()
    {
        const MeshLeft left = scallop_check_->left();
        PlannedOperation planned = work_.finish(
            row_, left.overflowed ? operation_.tool.radius : std::max(scallop_, left.most_left));
        report_uncovered_points(planned.stats, left.uncovered, left.overflowed);
        report_walls_over_nothing(planned.stats, left.over_nothing);
        report_blocked(planned.stats, left, operation_.tool);
        planned.stats.counts.emplace_back("isocurves", curves_);
        planned.stats.counts.emplace_back("triangles",
                                          static_cast<double>(operation_.part.mesh.size()));
        return planned;
    }

    const Job& job_;
    const Operation& operation_;
    SurfaceOperation work_;
    toolpath::Tool tool_;  // with the band's offset
    double radius_;        // mm, of that
    double scallop_;
    std::unique_ptr<MeshCheck> scallop_check_;
    Vec3d along_{1, 0, 0};
    Vec3d across_{0, 1, 0};
    Vec3d origin_;
    double length_{};
    double width_{};
    double row_{};           // mm between first rows
    double sample_pitch_{};  // mm along rows
    int curves_{};
};

}  // namespace

PlannedOperation plan_mesh_isocurves(const Job& job,
                                     const Operation& operation,
                                     const LevelFloors& floors)
{
    return MeshPlanner{job, operation, floors}.plan();
}

}  // namespace cusp::adaptive_isocurve
