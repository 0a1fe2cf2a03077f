// Each plane's pass is the drop of the tool along a line.
#include "host_tools/adaptive_isocurve/parallel_planes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "host_tools/adaptive_isocurve/isocurve_floor.hpp"
#include "host_tools/adaptive_isocurve/scallop_width.hpp"
#include "host_tools/adaptive_isocurve/surface_operation.hpp"
#include "host_tools/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::host {
namespace {

constexpr int kSlopeLooks = 150;
constexpr double kPlaneLooks = 1.0;  // mm
constexpr int kPlaneEndHalvings = 20;
constexpr double kLeastCosine = 0.05;  // of the slope across: steeper places don't set the step

// Spacing of planes for the ridge at one place: the width on the surface, seen in plan across the
// planes. `across` is horizontal.
double plane_step(const SurfacePoint& p, Vec3d across, double radius, double ridge)
{
    const Vec3d normal = upward_normal(p);
    if (dot(normal, normal) == 0) {
        return 2 * radius;
    }
    const double along_u = dot(p.dv, across);
    const double along_v = -dot(p.du, across);
    const Vec3d tangent = p.du * along_u + p.dv * along_v;
    const Vec3d step = cross(normal, tangent);
    const double length = norm(step);
    if (length == 0) {
        return 2 * radius;
    }
    // The step by du and dv, for its normal curvature.
    const double e = dot(p.du, p.du);
    const double f = dot(p.du, p.dv);
    const double g = dot(p.dv, p.dv);
    const double det = e * g - f * f;
    const double a = (dot(step, p.du) * g - dot(step, p.dv) * f) / det;
    const double b = (dot(step, p.dv) * e - dot(step, p.du) * f) / det;
    const Vec3d bend = p.duu * (a * a) + p.duv * (2 * a * b) + p.dvv * (b * b);
    const double curvature = dot(normal, bend) / (length * length);
    const double cosine = std::abs(dot(step, across)) / length;
    return scallop_width(radius, ridge, curvature) * std::max(kLeastCosine, cosine);
}

class PlanePlanner {
public:
    PlanePlanner(const Job& job, const Operation& operation)
        : operation_{operation}, work_{job, operation, operation.floor}
    {
        across_ = operation.direction == 'u' ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    }

    PlannedOperation plan()
    {
        const double step = operation_.step_over ? *operation_.step_over : step_for_scallop();
        const Vec3d low = work_.model().box_low();
        const Vec3d high = work_.model().box_high();
        const double width = dot(high - low, across_);
        const int planes = std::max(1, static_cast<int>(std::ceil(width / step)));
        for (int k = 0; k <= planes; ++k) {
            const double shift = width * k / planes;
            Vec3d from{low.x, low.y, low.z};
            Vec3d to = across_.y == 1 ? Vec3d{high.x, low.y, low.z} : Vec3d{low.x, high.y, low.z};
            add_plane(from + across_ * shift, to + across_ * shift);
        }
        return finished(step);
    }

private:
    // The step keeps ridges between planes on one smooth surface within the scallop, that is all.
    PlannedOperation finished(double step)
    {
        const bool known = operation_.scallop && !operation_.step_over &&
                           work_.surfaces().size() == 1 && is_plain(work_.surfaces().front());
        PlannedOperation planned =
            work_.finish(step, known ? *operation_.scallop : operation_.tool.radius);
        if (!known) {
            planned.stats.warnings.push_back(
                "parallel_planes proves nothing of what is left beside walls, edges and on steep "
                "ground, or with step_over: adaptive_isocurve does");
        }
        return planned;
    }

    double step_for_scallop() const
    {
        const double ridge = *operation_.scallop - work_.outward();
        double least = 2 * operation_.tool.radius;
        for (std::size_t k = 0; k < work_.surfaces().size(); ++k) {
            const Surface& s = work_.surfaces()[k];
            for (int i = 0; i <= kSlopeLooks; ++i) {
                for (int j = 0; j <= kSlopeLooks; ++j) {
                    const SurfacePoint p = work_.model().evaluate(
                        static_cast<int>(k),
                        s.u_begin() + (s.u_end() - s.u_begin()) * i / kSlopeLooks,
                        s.v_begin() + (s.v_end() - s.v_begin()) * j / kSlopeLooks);
                    least = std::min(least, plane_step(p, across_, operation_.tool.radius, ridge));
                }
            }
        }
        return 0.99 * least;
    }

    // The tip where the axis is over the model.
    std::optional<Vec3d> tip(Vec3d at) { return work_.certified().dropped(at.x, at.y); }

    // The parts of the line over which the tool meets the model.
    void add_plane(Vec3d from, Vec3d to)
    {
        const int parts = std::max(2, static_cast<int>(std::ceil(norm(to - from) / kPlaneLooks)));
        const auto place = [&](double t) {
            return from + (to - from) * t;
        };
        double begin = 0;
        bool was_on = tip(from).has_value();
        for (int k = 1; k <= parts; ++k) {
            const double t = static_cast<double>(k) / parts;
            const bool on = tip(place(t)).has_value();
            if (on != was_on) {
                const double last = static_cast<double>(k - 1) / parts;
                const double edge = on ? last_off(place, last, t) : last_off(place, t, last);
                if (on) {
                    begin = edge;
                } else {
                    add_run(place(begin), place(edge));
                }
                was_on = on;
            }
        }
        if (was_on) {
            add_run(place(begin), place(1));
        }
    }

    template <class Place>
    double last_off(const Place& place, double off, double on)
    {
        for (int turn = 0; turn < kPlaneEndHalvings; ++turn) {
            const double middle = 0.5 * (off + on);
            (tip(place(middle)).has_value() ? on : off) = middle;
        }
        return on;
    }

    void add_run(Vec3d from, Vec3d to)
    {
        if (norm(to - from) > 1e-3) {
            work_.add_pass(work_.certified().sample_dropped(from, to));
        }
    }

    const Operation& operation_;
    SurfaceOperation work_;
    Vec3d across_;
};

}  // namespace

std::vector<PlannedOperation> plan_parallel_planes(const Job& job, const Operation& operation)
{
    const auto begin = std::chrono::steady_clock::now();
    if (!operation.step_over && !operation.scallop) {
        throw InputError(
            fmt::format("{}: {}: give step_over or scallop", job.file, operation.strategy));
    }
    PlannedOperation planned = PlanePlanner{job, operation}.plan();
    planned.stats.planning_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return {std::move(planned)};
}

}  // namespace cusp::host
