// What the reports tell.
#include "firmware/machine/reports.hpp"

#include "firmware/machine/report_units.hpp"

namespace cusp::machine {

bool Reports::due() const noexcept
{
    constexpr std::uint32_t kLeast = 100;
    const std::uint32_t interval = core_.settings().whole(Setting::kReportInterval);
    const std::uint32_t since = core_.motion.ticks() - reported_at_;
    return interval != 0 && since >= (interval < kLeast ? kLeast : interval);
}

void Reports::write_status() noexcept
{
    const Motion& motion = core_.motion;
    reported_at_ = motion.ticks();
    StatusFields status;
    status.state = core_.system.state();
    status.substate = cycle_.substate();
    status.position = motion.position();
    status.work_offset =
        gcode::work_offset(core_.interpreter.modal(), core_.interpreter.parameters());
    status.free_blocks = motion.free_blocks();
    status.free_bytes = core_.lines.room();
    status.line = motion.finished() ? 0 : motion.executing_line();
    status.feed = motion.speed() * kSecondsPerMinute;
    status.spindle = core_.outputs.spindle_speed();
    status.inputs = motion.inputs().steady();
    const std::optional<unsigned> axis = core_.settings().second_motor_axis();
    if (axis && core_.input_on(kFourthLimit)) {  // by the letter of its axis
        const unsigned others = status.inputs & ~unsigned{kFourthLimit};
        status.inputs = static_cast<std::uint16_t>(others | limit_input(*axis));
    }
    status.overrides = core_.outputs.overrides();
    status.accessories = core_.outputs.accessories();
    const std::uint32_t start = core_.replies.place();
    core_.reporter.write(status, core_.settings(), core_.replies);
    core_.lines.end_report(start);
}

bool Reports::write_line() noexcept
{
    const ListingSource source{
        core_.keeper.stored(), core_.interpreter.parameters(),    core_.last_probe,
        planner_blocks_,       protocol::ReceiveQueue::kCapacity, core_.motion.inputs().glitches()};
    return write_listing_line(listing_, listing_index_++, source, core_.replies);
}

}  // namespace cusp::machine
