// The machine's rates and its travel.
#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/gcode/decimal.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/stages.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::Job;
using job::MachineLimit;
using job::MachineTool;
using machine::Setting;
using toolpath::PlannedOperation;
using toolpath::ToolMove;

namespace {

constexpr unsigned kAxes = 3;

double along(Vec3d point, unsigned axis)
{
    return axis == 0 ? point.x : axis == 1 ? point.y : point.z;
}

// An end of the program along an axis, and the operation that goes there.
struct Reached {
    double at;
    const PlannedOperation* by{nullptr};
};

struct Extent {
    Reached low{kUnbounded};
    Reached high{-kUnbounded};

    void take(double at, const PlannedOperation& by)
    {
        if (at < low.at) {
            low = {at, &by};
        }
        if (at > high.at) {
            high = {at, &by};
        }
    }
};

using Extents = std::array<Extent, kAxes>;

// The way of the tip, within `kChord` of curves. Programs begin with a lift, then a rapid move in x and y.
Extents extents_of(const PlannedProgram& program, double clearance)
{
    constexpr double kChord = 1e-3;  // mm
    Extents extents;
    for (const PlannedOperation& operation : program.operations) {
        Vec3d at{0, 0, clearance};
        bool begun = false;  // the first move starts where the tool was
        extents[2].take(clearance, operation);
        for (const ToolMove& move : operation.path.moves) {
            const auto points =
                begun ? points_of(move, at, kChord) : std::vector<Vec3d>{end_of(move)};
            for (const Vec3d& point : points) {
                for (unsigned axis = 0; axis < kAxes; ++axis) {
                    extents[axis].take(along(point, axis), operation);
                }
            }
            at = end_of(move);
            begun = true;
        }
    }
    return extents;
}

// Errors: InputError where the controller, and with it verify() and the run for the times, would refuse the target.
void refuse_far(const Job& job, const Reached& reached, unsigned axis)
{
    constexpr double kNanometres = 1e6;  // of a millimetre
    constexpr double kFarthest = static_cast<double>(gcode::kMaxCoordinateNm) / kNanometres;
    if (reached.by != nullptr && !(std::abs(reached.at) <= kFarthest)) {
        throw InputError(fmt::format(
            "{}: {} goes to {} {:.10g} mm, controllers take {:g} mm from the origin at most: "
            "origin = \"corner\" in [placing] (--origin corner) moves the part there",
            job.file, words_of(*reached.by), "xyz"[axis], reached.at, kFarthest));
    }
}

void put_limit(const std::optional<MachineLimit>& limit,
               Setting setting,
               unsigned axis,
               machine::Settings& settings)
{
    if (limit) {
        const machine::SettingEntry& entry =
            machine::setting_entry(machine::index_of(setting, axis));
        settings.put(entry.number,
                     std::clamp(static_cast<float>(limit->value), entry.least, entry.most));
    }
}

}  // namespace

void take_machine(Planning& planning)
{
    const MachineTool& mill = planning.job.machine;
    machine::Settings& settings = planning.settings;
    for (unsigned axis = 0; axis < kAxes; ++axis) {
        put_limit(mill.max_rate[axis], Setting::kMaxRate, axis, settings);
        put_limit(mill.acceleration[axis], Setting::kAcceleration, axis, settings);
    }
    constexpr double kSeconds = 60;  // of a minute
    const auto of_axes = [&](Setting setting, double unit) {
        return Vec3d{settings.value(setting, 0) / unit, settings.value(setting, 1) / unit,
                     settings.value(setting, 2) / unit};
    };
    planning.rates.velocity = of_axes(Setting::kMaxRate, kSeconds);
    planning.rates.acceleration = of_axes(Setting::kAcceleration, 1);
}

void prove_travel(Planning& planning)
{
    const Job& job = planning.job;
    const job::AxisValues& travel = job.machine.travel;
    const Extents extents = extents_of(planning.program, job.stock_top + job.clearance);
    for (unsigned axis = 0; axis < kAxes; ++axis) {
        const auto& [low, high] = extents[axis];
        refuse_far(job, low, axis);
        refuse_far(job, high, axis);
        if (!travel[axis] || high.at - low.at <= travel[axis]->value) {
            continue;
        }
        const char name = "xyz"[axis];
        throw InputError(
            fmt::format("{}: the program needs {:.6g} mm of {}, from {:.6g} ({}) to {:.6g} ({}); "
                        "{} allows {:.6g} mm",
                        job.file, high.at - low.at, name, low.at, words_of(*low.by), high.at,
                        words_of(*high.by), travel[axis]->place, travel[axis]->value),
            {job.file, 0, "machine", "",
             fmt::format("{:.6g} mm of {}", travel[axis]->value, name)});
    }
}

}  // namespace cusp::plan
