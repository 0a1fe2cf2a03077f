// Data sheet of the TMC5160, revision 1.17: section 4.3, SPI timing.
#include "tests/target/cosim/bus_drive_model.hpp"

namespace cusp::cosim {
namespace {

// With a clock of 11 MHz, the least of its own oscillator: one period and 10 ns; two of them.
constexpr Picoseconds kNanosecond = kSecond / 1000000000;
constexpr Picoseconds kLeastPhase = 101 * kNanosecond;
constexpr Picoseconds kLeastDeselected = 192 * kNanosecond;

}  // namespace

BusDriveModel::BusDriveModel(
    Circuit& circuit, std::string name, Wire select, Wire clock, Wire to_drive, Wire from_drive)
    : SocketModel{circuit},
      name_{std::move(name)},
      select_{select},
      clock_{clock},
      to_drive_{to_drive},
      from_drive_{from_drive}
{
    for (const Wire& wire : {select_, clock_, to_drive_}) {
        wire.port.set_listener(wire.pin, [this] { look(); });
    }
}

void BusDriveModel::reset()
{
    chip_.power_up();
    written_at_ = -1;
}

void BusDriveModel::set_missing(bool on)
{
    if (chip_.missing && !on) {
        reset();
    }
    chip_.missing = on;
    answer();
}

double BusDriveModel::baud() const
{
    return bit_ > 0 ? static_cast<double>(kSecond) / static_cast<double>(bit_) : 0;
}

void BusDriveModel::look()
{
    const bool selected = !select_.high();
    const bool clock = clock_.high();
    const bool selects = selected != was_selected_;
    const bool clocks = selected && clock != clock_was_high_;
    judge_times(selects, clocks);
    if (clocks && clock) {
        bit_ = circuit_.now - rose_;
        rose_ = circuit_.now;
    }
    was_selected_ = selected;
    clock_was_high_ = clock;
    const std::uint64_t writes = chip_.writes();
    chip_.set_pins(!selected, clock, to_drive_.high());
    if (chip_.writes() != writes) {
        written_at_ = circuit_.now;
    }
    for (; told_ < chip_.violations().size(); ++told_) {
        circuit_.violate(name_ + ": " + chip_.violations()[told_]);
    }
    if (selects && selected && from_drive_.port.held(from_drive_.pin)) {
        circuit_.violate(name_ + ": two drives are selected");
    }
    answer();
}

void BusDriveModel::judge_times(bool selects, bool clocks)
{
    if (!selects && !clocks) {
        return;
    }
    const Picoseconds passed = circuit_.now - last_edge_;
    const bool was_deselected = selects && !was_selected_;
    const bool by_driver = selects ? select_.driven() : clock_.driven();
    if (by_driver && passed < (was_deselected ? kLeastDeselected : kLeastPhase)) {
        circuit_.violate(name_ + ": " + std::to_string(passed / kNanosecond) + " ns between edges");
    }
    last_edge_ = circuit_.now;
}

// Only while it is selected it drives the line.
void BusDriveModel::answer()
{
    const std::optional<bool> level = chip_.data_out();
    if (level) {
        from_drive_.port.drive(from_drive_.pin, *level ? 1 : 0);
    } else if (holds_line_) {
        from_drive_.port.drive(from_drive_.pin, -1);
    }
    holds_line_ = level.has_value();
}

}  // namespace cusp::cosim
