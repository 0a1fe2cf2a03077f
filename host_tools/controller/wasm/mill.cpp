// The C ABI of the virtual mill: the whole firmware and its machine tool behind a serial line, one servo tick at a time.
// host_tools/judge/view/web/src/port/mill_core.ts calls it.
//
// cusp_text() and settings there, cusp_mill_open(); then bytes by cusp_text() and cusp_mill_send(), time by cusp_mill_tick(),
// and the controller's bytes after each of the two. One mill at a time; opening it again is a power-up at the first place.
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "boards/sim/simulated_controller.hpp"
#include "host_tools/controller/dialect/line_source.hpp"
#include "host_tools/controller/program_run/edge_checksum.hpp"
#include "host_tools/controller/program_run/mill_setup.hpp"
#include "host_tools/controller/program_run/settings_lines.hpp"
#include "host_tools/controller/wasm/wasm.hpp"

namespace {

using namespace cusp;

// The edges since the last mark.
class MarkedEdges : public hal::FrameListener {
public:
    void mark(const hal::SimulatedPlayer& player)
    {
        edges_.emplace(player.next_frame_start(), player.levels());
    }
    std::uint32_t value() const { return edges_ ? edges_->value() : 0; }
    void frame_played(std::uint64_t start_tick, const PulseFrame& frame) override
    {
        if (edges_) {
            edges_->frame_played(start_tick, frame);
        }
    }

private:
    std::optional<program_run::EdgeChecksum> edges_;
};

// Figures in the order that mill_core.ts expects.
constexpr std::size_t kMillFigures = 11;

struct Mill {
    explicit Mill(const hal::MillGeometry& of_settings)
        : geometry{of_settings}, controller{of_settings}
    {
        controller.board().pulse_player.add_listener(edges);
    }
    hal::MillGeometry geometry;
    MarkedEdges edges;
    board_sim::SimulatedController controller;
    std::string answers;
    std::array<double, kMillFigures> figures{};
};

std::unique_ptr<Mill>& the_mill()
{
    static std::unique_ptr<Mill> mill;
    return mill;
}

std::uint32_t take_answers(Mill& mill)
{
    mill.answers = mill.controller.board().byte_link.take_answers();
    return static_cast<std::uint32_t>(mill.answers.size());
}

}  // namespace

// The text is the settings. plate: height of the probe plate over the tool's first place, mm; NaN: there is none.
// Returns 0 where the settings are refused.
CUSP_EXPORT(cusp_mill_open) int cusp_mill_open(double plate)
{
    machine::Settings settings;
    auto lines = dialect::LineSource::of_text("settings", wasm::text_of_caller());
    if (program_run::read_settings(lines, settings)) {
        return 0;
    }
    const auto probe_z = std::isnan(plate) ? std::nullopt : std::optional{plate};
    the_mill() = std::make_unique<Mill>(
        program_run::mill_geometry(settings, probe_z, program_run::kAmidTravel));
    Mill& mill = *the_mill();
    program_run::store_settings(settings, mill.controller.board().settings_store);
    mill.controller.power_on();
    mill.controller.tick();
    return 1;
}

// The text goes to the controller, which works until nothing is left to do before the next tick. Returns the number of bytes
// that it answers.
CUSP_EXPORT(cusp_mill_send) std::uint32_t cusp_mill_send()
{
    Mill& mill = *the_mill();
    mill.controller.board().byte_link.send(wasm::text_of_caller());
    mill.controller.settle();
    return take_answers(mill);
}

// One servo tick. Returns the number of bytes that the controller has sent in it.
CUSP_EXPORT(cusp_mill_tick) std::uint32_t cusp_mill_tick()
{
    the_mill()->controller.tick();
    return take_answers(*the_mill());
}

// Of the last call of one of these two.
CUSP_EXPORT(cusp_mill_answers) const char* cusp_mill_answers()
{
    return the_mill()->answers.data();
}

// Edges count from here.
CUSP_EXPORT(cusp_mill_mark) void cusp_mill_mark()
{
    the_mill()->edges.mark(the_mill()->controller.board().pulse_player);
}

// A person at the mill: inputs that read high or low whatever the switches say (bits of InputBit), the probe plate, the power.
CUSP_EXPORT(cusp_mill_inputs) void cusp_mill_inputs(std::uint32_t high, std::uint32_t low)
{
    hal::SimulatedMill& mill = the_mill()->controller.board().mill;
    mill.force_high(static_cast<std::uint16_t>(high));
    mill.force_low(static_cast<std::uint16_t>(low));
}
CUSP_EXPORT(cusp_mill_plate) void cusp_mill_plate(double plate)
{
    Mill& mill = *the_mill();
    mill.geometry.plate_above_start = plate;
    mill.controller.board().mill.set_geometry(mill.geometry);
}
CUSP_EXPORT(cusp_mill_power) void cusp_mill_power(int on)
{
    if (on != 0) {
        the_mill()->controller.power_on();
    } else {
        the_mill()->controller.power_off();
    }
}

// Place of the slides, mm from the upper ends of the travel; steps taken of each axis; checksum of the edges since the mark;
// inputs; spindle's duty, 0 to 1; flood and mist.
CUSP_EXPORT(cusp_mill_figures) const double* cusp_mill_figures()
{
    Mill& mill = *the_mill();
    const hal::SimulatedMill& iron = mill.controller.board().mill;
    const Vec3d at = iron.place();
    const hal::OutputLevels& outputs = iron.outputs();
    const auto& steps = iron.steps_taken();
    const auto whole = [](auto number) {
        return static_cast<double>(number);
    };
    const double duty = outputs.spindle_on ? whole(outputs.spindle_pwm) / whole(kFullDuty) : 0.0;
    mill.figures = {at.x,
                    at.y,
                    at.z,
                    whole(steps[0]),
                    whole(steps[1]),
                    whole(steps[2]),
                    whole(mill.edges.value()),
                    whole(iron.inputs()),
                    duty,
                    outputs.flood ? 1.0 : 0.0,
                    outputs.mist ? 1.0 : 0.0};
    return mill.figures.data();
}
