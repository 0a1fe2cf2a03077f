// Instructions of the time law on a path of helical arcs, which move all three axes.
#pragma once

#include <array>
#include <cmath>

#include "firmware/planner/corner_overlap.hpp"
#include "firmware/planner/law_check.hpp"
#include "firmware/planner/station_spacing.hpp"
#include "tests/target/budget/instruction_meter.hpp"

namespace cusp::test {

struct LawBudget {
    planner::LawPath path;
    planner::TimeLaw law;
    planner::StationSpacing spacing{path};
    planner::LawPlans plans;
    std::array<planner::Block, 12> arcs;
};

// Lays the path, and gives it to the law from its start to its end.
inline void count_law(LawBudget& now, const hal::qemu::HostFile& out)
{
    constexpr float kRadius = 8.0F;
    constexpr float kAngle = 1.2F;
    InstructionMeter station{"law_station"};
    InstructionMeter step{"law_step"};
    InstructionMeter check{"law_check"};
    for (unsigned i = 0; i < now.arcs.size(); ++i) {
        planner::Block& arc = now.arcs[i];
        arc = {};
        arc.shape = planner::BlockShape::kArc;
        arc.filter = {4, 2};
        const float heading = kAngle * static_cast<float>(i);
        const float sine = static_cast<float>(sin_cos(static_cast<double>(heading)).sin);
        const float cosine = static_cast<float>(sin_cos(static_cast<double>(heading)).cos);
        const float way = std::sqrt(kRadius * kRadius + 1.0F);
        arc.arc = {{cosine, sine, 0},
                   {-sine, cosine, 0},
                   {0, 0, 1},
                   kRadius,
                   0,
                   1 / (way * kPathUnitsPerMillimetre)};
        set_length(arc, static_cast<std::uint32_t>(way * kAngle * kPathUnitsPerMillimetre));
        arc.feed = 10000.0F;
        arc.centripetal = 1e6F;
        now.path.append(arc);
    }
    now.path.close();
    const MachineLimits limits;
    now.law.set_limits(limits);
    now.spacing.set_limits(limits, now.law.station_time());
    now.spacing.begin(planner::full_stop(limits), {}, 0);
    now.spacing.set_stop(planner::full_stop(limits));
    planner::StopElement element;
    CUSP_ASSERT(now.spacing.start(element));
    now.law.begin(element);
    planner::PathCursor cursor;
    while (now.law.state() != planner::TimeLaw::State::kDone) {
        while (!now.spacing.finished() && now.law.has_room()) {
            planner::Station next;
            station.begin();
            CUSP_ASSERT(now.spacing.next(next));
            now.law.add(next);
            station.end();
            if (now.spacing.finished()) {
                now.law.end(now.spacing.stop());
            }
        }
        const std::uint32_t steps = now.law.steps();
        step.begin();
        now.law.work();
        if (now.law.steps() != steps) {
            step.end();
        }
        if (now.law.state() == planner::TimeLaw::State::kChecks) {
            check.begin();
            CUSP_ASSERT(planner::greatest_use(now.law, now.path, cursor, limits) < 1.01F);
            check.end();
            now.law.accept(now.plans);
        }
        planner::LawCell cell;
        for (std::uint32_t i = 0; i < 16 && now.plans.next(cell); ++i) {
        }
    }
    station.report(out);
    step.report(out);
    check.report(out);
}

}  // namespace cusp::test
