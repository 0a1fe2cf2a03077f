// The pass of a plane is the tool dropped along a line.
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/finishing/contact_tracker.hpp"
#include "host_tools/cam/steep_shallow/section_step.hpp"

#include "fmt/format.h"

namespace cusp::steep_shallow {

using finishing::CcParameterList;
using finishing::ContactTracker;
using finishing::faceted;
using finishing::FinishArea;
using finishing::Points;
using finishing::SurfaceOperation;
using job::Job;
using job::Operation;
using nurbs::Surface;
using toolpath::PlannedOperation;

namespace {

constexpr int kSlopeSamples = 150;
constexpr double kPlaneSamples = 1 / 3.0;  // of the reach of the tool
constexpr int kPlaneEndHalvings = 20;
constexpr double kShortestPlaneRun = 1e-3;  // mm
// Share of the stepover on level ground: points that require less (75 degrees steep, or nearly as
// hollow as the ball) do not count; they get passes of their own.
constexpr double kLeastPlaneShare = 0.25;
constexpr double kSteepestAcross = 0.96;  // sine of the slope of facets, likewise
constexpr double kMostPlanes = 20000;

class PlanePasses {
public:
    PlanePasses(const Job& job,
                const Operation& operation,
                const SurfaceOperation& work,
                const FinishArea& area,
                FinishCompletion& passes)
        : job_{job},
          operation_{operation},
          work_{work},
          area_{area},
          passes_{passes},
          tool_{work.path_fitter()}
    {
        low_ = work.model().box_low();
        high_ = work.model().box_high();
        const job::FinishKeys& keys = finish_keys(operation);
        along_ = keys.direction == 'u' ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
        across_ = {along_.y, along_.x, 0};
        if (keys.plane_angle != 0) {
            const double turn = keys.plane_angle * kPi / 180;
            const double c = elementary::cos(turn);
            const double s = elementary::sin(turn);
            along_ = {c * along_.x - s * along_.y, s * along_.x + c * along_.y, 0};
            across_ = {c * across_.x - s * across_.y, s * across_.x + c * across_.y, 0};
        }
        // The box as the planes see it.
        const auto least = [&](Vec3d way) {
            return std::min(low_.x * way.x, high_.x * way.x) +
                   std::min(low_.y * way.y, high_.y * way.y);
        };
        origin_ = along_ * least(along_) + across_ * least(across_) + Vec3d{0, 0, low_.z};
        length_ = -least(-along_) - least(along_);
        width_ = -least(-across_) - least(across_);
        reach_ = work.path_fitter().offset_tool().radius;
    }

    double cut()
    {
        const double step =
            operation_.passes.step_over ? *operation_.passes.step_over : step_for_scallop();
        if (width_ + 2 * reach_ > kMostPlanes * step) {
            throw InputError(fmt::format(
                "{}: {}: planes {:.3g} mm apart ({}) over a part of {:g} mm and what the tool "
                "reaches beyond it would be {:.0f}, at most {:g} are made",
                job_.file, operation_.name(), step,
                operation_.passes.step_over ? "step_over" : "by the scallop", width_,
                std::ceil((width_ + 2 * reach_) / step), kMostPlanes));
        }
        beyond_area_ = area_.is_everything() ? 0 : step;
        const int planes = std::max(1, static_cast<int>(std::ceil(width_ / step)));
        // A ball on a slope that ends in a rim is beyond the rim.
        const double lean = std::min(step, 0.5 * reach_) / reach_;
        least_facing_ = std::sqrt(1 - lean * lean);
        const int beyond = static_cast<int>(std::ceil(reach_ / step));
        for (int k = -beyond; k <= planes + beyond; ++k) {
            const int before = std::min(k, 0);
            const int after = std::max(k - planes, 0);
            add_plane(width_ * (k - before - after) / planes + step * (before + after));
            job_.report_progress(kSectionsDone * (k + beyond + 1) / (planes + 2 * beyond + 1));
        }
        return step;
    }

private:
    double step_for_scallop() const
    {
        const SectionStep section{work_, *operation_.tolerance.scallop};
        double least = section.widest();
        const auto ask = [&](double step) {
            least = step < kLeastPlaneShare * section.widest() ? least : std::min(least, step);
        };
        for (const auto& facet : operation_.part.mesh) {
            const Vec3d n = cross(facet[1] - facet[0], facet[2] - facet[0]);
            const Vec3d normal = n / (n.z < 0 ? -norm(n) : norm(n));
            const Vec3d middle = (facet[0] + facet[1] + facet[2]) / 3.0;
            const double size = norm(facet[1] - facet[0]) + norm(facet[2] - facet[0]);
            const double sine = dot(normal, across_);
            if (sine * sine < kSteepestAcross * kSteepestAcross &&
                !area_.is_beyond(middle, size, normal, 0)) {
                least = std::min(least, section.on_facet(normal, across_));
            }
        }
        for (std::size_t k = 0; k < work_.surfaces().size(); ++k) {
            const Surface& s = work_.surfaces()[k];
            for (int i = 0; i <= kSlopeSamples; ++i) {
                for (int j = 0; j <= kSlopeSamples; ++j) {
                    const double u = s.u_begin() + (s.u_end() - s.u_begin()) * i / kSlopeSamples;
                    const double v = s.v_begin() + (s.v_end() - s.v_begin()) * j / kSlopeSamples;
                    const int surface = static_cast<int>(k);
                    if (const auto step = section.at(surface, u, v, across_, kLeastPlaneShare);
                        step && is_in_area(surface, u, v) &&
                        work_.model().inside_trims(surface, u, v)) {
                        ask(*step);
                    }
                }
            }
        }
        return least;
    }

    bool is_in_area(int surface, double u, double v) const
    {
        if (area_.is_everything()) {
            return true;
        }
        const auto at = work_.model().cc_point(surface, u, v, 0);
        return area_.holds(at.point, at.normal);
    }

    Vec3d place(double s, double t) const { return origin_ + along_ * s + across_ * t; }

    // The tool dropped there, where it touches the model. Beyond the model's box it may overhang the
    // rim by a step, since the last pass is less than a step from the rim.
    std::optional<ContactTracker::Position> touching(double s, double t)
    {
        const Vec3d at = place(s, t);
        std::optional<ContactTracker::Position> found = tool_.at(at.x, at.y);
        const bool over_box =
            at.x >= low_.x && at.x <= high_.x && at.y >= low_.y && at.y <= high_.y;
        if (found && !over_box && found->facing < least_facing_) {
            found.reset();
        }
        return found;
    }

    bool is_on(double s, double t)
    {
        const auto found = touching(s, t);
        return found && area_.holds(found->point, found->lean);
    }

    // Adds the parts of the plane at t where the tool is on the model, in the area.
    void add_plane(double t)
    {
        const double from = -reach_;
        const double to = length_ + reach_;
        const int parts = static_cast<int>(std::ceil((to - from) / (kPlaneSamples * reach_)));
        double begin = from;
        double last = from;
        bool was_on = is_on(from, t);
        for (int k = 1; k <= parts; ++k) {
            const double s = from + (to - from) * k / parts;
            const bool on = is_on(s, t);
            if (on && !was_on) {
                begin = run_end(last, s, t);
            } else if (!on && was_on) {
                add_run(begin, run_end(s, last, t), t);
            }
            was_on = on;
            last = s;
        }
        if (was_on) {
            add_run(begin, to, t);
        }
    }

    double run_end(double outside, double inside, double t)
    {
        for (int turn = 0; turn < kPlaneEndHalvings; ++turn) {
            const double middle = 0.5 * (outside + inside);
            (is_on(middle, t) ? inside : outside) = middle;
        }
        if (beyond_area_ == 0) {
            return inside;
        }
        // Out of the area, as far as the tool touches the model.
        const double way = outside > inside ? 1 : -1;
        double end = inside;
        for (double out : {0.25, 0.5, 1.0}) {
            const double next = inside + way * out * beyond_area_;
            if (!touching(next, t)) {
                break;
            }
            end = next;
        }
        return end;
    }

    void add_run(double from, double to, double t)
    {
        if (to - from > kShortestPlaneRun) {
            CcParameterList cc_parameters;
            const Points dense =
                work_.path_fitter().sample_dropped(place(from, t), place(to, t), &cc_parameters);
            passes_.cut(dense, cc_parameters);
        }
    }

    const Job& job_;
    const Operation& operation_;
    const SurfaceOperation& work_;
    const FinishArea& area_;
    FinishCompletion& passes_;
    ContactTracker tool_;
    Vec3d across_;
    Vec3d along_;
    Vec3d low_;
    Vec3d high_;
    Vec3d origin_;
    double length_{};       // mm, of planes over the box
    double width_{};        // mm, across them
    double reach_{};        // mm: how far beyond the box the tool can touch the model
    double beyond_area_{};  // mm: how far passes go on beyond the area
    double least_facing_{};
};

}  // namespace

double cut_planes(const Job& job,
                  const Operation& operation,
                  const SurfaceOperation& work,
                  const FinishArea& area,
                  FinishCompletion& passes)
{
    return PlanePasses{job, operation, work, area, passes}.cut();
}

std::vector<PlannedOperation> plan_parallel_planes(const Job& job, const Operation& given)
{
    const auto begin = std::chrono::steady_clock::now();
    check_sizes(job, given);
    const Operation operation = faceted(given);
    SurfaceOperation work{job, operation, operation.part.floor};
    FinishCompletion passes{job, operation, work};
    const double step = cut_planes(job, operation, work, work.area(), passes);
    PlannedOperation planned = passes.finished(step);
    planned.stats.planning_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return {std::move(planned)};
}

}  // namespace cusp::steep_shallow
