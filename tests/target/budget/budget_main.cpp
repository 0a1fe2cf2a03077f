// Counts the instructions of the firmware's hot paths on the target's core, under QEMU. The counts
// are held by tests/target/budgets.txt.
#include "firmware/base/math.hpp"
#include "firmware/gcode/interpreter.hpp"
#include "firmware/interpolator/interpolator.hpp"
#include "firmware/nurbs/arc_length_table.hpp"
#include "firmware/planner/planner.hpp"
#include "firmware/pulse/pulse_maker.hpp"
#include "hal/cortex_m/reset_report.hpp"
#include "hal/cortex_m/vectors.hpp"
#include "hal/stm32f4/dma_pulse_player.hpp"
#include "tests/target/budget/instruction_meter.hpp"
#include "tests/target/budget/law_budget.hpp"
#include "tests/target/budget/pio_budget.hpp"

namespace {

using namespace cusp;
using hal::stm32f4::DeviceWord;
using hal::stm32f4::Dma;
using hal::stm32f4::Gpio;
using hal::stm32f4::Timer;
using test::InstructionMeter;

planner::PathQueue path_queue;
planner::Planner plan{path_queue, MachineLimits{}};
interpolator::Interpolator interpolator{plan};
pulse::PulseMaker pulse_maker{pulse::StepSettings{}};
gcode::Interpreter lines;
PulseFrame frame;
hal::qemu::HostFile out;
test::LawBudget law_budget;

// QEMU has no DMA: the player's registers are plain memory.
struct StillChip {
    using Word = DeviceWord;
    static inline Dma<Word> dma{};
    static inline Timer<Word> timer{};
    static inline Timer<Word> gate{};
    static inline hal::stm32f4::Debug<Word> debugger{};
    static inline Gpio<Word> gpio{};
    static auto& dma2() noexcept { return dma; }
    static auto& timer8() noexcept { return timer; }
    static auto& port(char) noexcept { return gpio; }
    static auto& timer2() noexcept { return gate; }
    static auto& debug() noexcept { return debugger; }
    static std::uint32_t bus_address(const volatile void* memory) noexcept
    {
        return hal::stm32f4::Chip::bus_address(memory);
    }
};
struct OnePort {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'C', 0}, {'C', 1}, {'C', 2}, {'C', 3}, {'C', 4}, {'C', 5}}};
};
hal::stm32f4::DmaPulsePlayer<StillChip, OnePort, hal::stm32f4::Timer8Pace<StillChip>> player;

constexpr float kFeed = 50.0F;

path::Move move_to(Position end, const path::Path& path, float tolerance)
{
    path::Move move;
    move.path = path;
    move.start = plan.tail();
    move.end = end;
    move.feed = kFeed;
    move.tolerance = tolerance;
    return move;
}

// Plays all that the planner holds; each tick that moves counts.
void count_ticks(InstructionMeter& meter)
{
    plan.close();
    for (unsigned tick = 0; tick < 20000; ++tick) {
        plan.work();
        meter.begin();
        static_cast<void>(interpolator.tick());
        meter.end();
        if (plan.empty() && interpolator.at_rest()) {
            break;
        }
    }
}

void begin_at_zero()
{
    plan.reset({});
    interpolator.reset({});
}

void count_one_move(std::string_view name, Position end, const path::Path& path)
{
    InstructionMeter meter{name};
    begin_at_zero();
    plan.push(move_to(end, path, 0.0F));
    count_ticks(meter);
    meter.report(out);
}

// A piece as PieceStream hands it over: short enough for its table of arc length. A longer one
// would be followed as a line.
void count_one_curve(std::string_view name, const path::BezierPiece& piece)
{
    nurbs::ArcLengthTable table;
    CUSP_ASSERT(nurbs::make_arc_length_table(piece, table));
    const AxisVecf end = piece.points[piece.order - 1U];
    count_one_move(name,
                   to_position({static_cast<double>(end.x), static_cast<double>(end.y),
                                static_cast<double>(end.z)}),
                   piece);
}

void count_interpolation()
{
    count_one_move("tick_line", to_position({60.0, 30.0, 10.0}), path::Line{});
    const path::Arc helix{
        {20.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 5.0}, 20.0, 0.0, kPi};
    count_one_move("tick_arc", to_position({40.0, 0.0, 5.0}), helix);
    count_one_curve("tick_cubic",
                    {4,
                     {{}, {4.0F, 6.0F, 1.0F}, {9.0F, 7.0F, 2.0F}, {14.0F, 3.0F, 2.5F}},
                     {1.0F, 1.0F, 1.0F, 1.0F, 1.0F}});
    count_one_curve(
        "tick_rational_quartic",
        {5,
         {{}, {3.0F, 2.0F, 0.5F}, {6.0F, 3.5F, 1.0F}, {9.0F, 3.0F, 1.5F}, {12.0F, 1.0F, 2.0F}},
         {1.0F, 1.3F, 1.1F, 0.9F, 1.0F}});
}

// All three axes at this many nanometres a tick, reached by `gain` a tick; 800 steps/mm. Each axis
// has its own place between the steps and a rate that drifts, so that few edges coincide.
// A call that nothing moves into what is counted.
[[gnu::noipa]] Position moved(Position at, std::int64_t speed, unsigned tick)
{
    return {at.x + speed, at.y + speed + tick % 7, at.z - speed};
}

void count_pulses(std::string_view frame_name,
                  std::string_view fill_name,
                  std::int64_t travel,
                  std::int64_t gain)
{
    InstructionMeter make{frame_name};
    InstructionMeter fill{fill_name};
    Position at{0, -400, 400};
    pulse_maker.reset(at);
    player.start(168000000, 84000000);
    StillChip::gate.cr1.write(1);
    std::int64_t speed = 0;
    for (unsigned tick = 0; tick < 200; ++tick) {
        speed = speed + gain < travel ? speed + gain : travel;
        at = moved(at, speed, tick);
        make.begin();
        pulse_maker.make_frame(at, frame);
        make.end();
        // The other half has just begun; the frame goes into the one that has been played.
        constexpr std::uint32_t kHalfTransfer = 1U << 10U;
        constexpr std::uint32_t kTransferComplete = 1U << 11U;
        StillChip::dma.stream[1].ndtr.write(tick % 2 == 0 ? 2000 : 1000);
        fill.begin();
        const bool taken = player.try_play(frame);
        StillChip::dma.lisr.write(tick % 2 == 0 ? kHalfTransfer : kTransferComplete);
        StillChip::dma.stream[1].ndtr.write(tick % 2 == 0 ? 1000 : 2000);
        static_cast<void>(player.on_interrupt());
        fill.end();
        CUSP_ASSERT(taken && !player.underrun());
    }
    for (unsigned tick = 0; tick < 5; ++tick) {
        pulse_maker.make_frame(at, frame);
    }
    make.report(out);
    fill.report(out);
}

struct ThreePorts {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'E', 2}, {'D', 5}, {'A', 15}, {'E', 1}, {'D', 4}, {'A', 8}}};
};
hal::stm32f4::DmaPulsePlayer<StillChip, ThreePorts, hal::stm32f4::Timer8Pace<StillChip>>
    player_of_three_ports;
hal::rp2350::PioPulsePlayer<test::StillPico, test::StillLines> player_of_pio;

// Lines on three ports: a frame with an edge in each microsecond, the most that there can be.
void count_three_ports()
{
    InstructionMeter fill{"player_3_ports_full"};
    frame.edges.clear();
    for (std::uint16_t tick = 0; tick < kPulseTicksPerFrame; ++tick) {
        const PulseLines steps = 7;
        const bool rise = tick % 2 == 0;
        CUSP_ASSERT(frame.edges.try_push_back(
            {tick, rise ? steps : PulseLines{0}, rise ? PulseLines{0} : steps}));
    }
    player_of_three_ports.start(168000000, 84000000);
    for (unsigned tick = 0; tick < 20; ++tick) {
        StillChip::gate.cr1.write(1);
        for (const unsigned stream : {1U, 3U, 4U}) {
            StillChip::dma.stream[stream].ndtr.write(tick % 2 == 0 ? 1900 : 900);
        }
        fill.begin();
        const bool taken = player_of_three_ports.try_play(frame);
        StillChip::dma.lisr.write(tick % 2 == 0 ? 1U << 10U : 1U << 11U);
        static_cast<void>(player_of_three_ports.on_interrupt());
        fill.end();
        CUSP_ASSERT(taken && !player_of_three_ports.underrun());
    }
    fill.report(out);
}

// Dense lines of 0.1 mm along a circle of 30 mm, played as they come.
void count_planning()
{
    InstructionMeter meter{"plan_g1"};
    constexpr unsigned kLines = 1500;
    begin_at_zero();
    for (unsigned line = 1; line <= kLines; ++line) {
        const auto angle = sin_cos(static_cast<double>(line) * (0.1 / 30.0));
        const Position end = to_position({30.0 * angle.sin, 30.0 - 30.0 * angle.cos, 0.001 * line});
        while (!plan.has_room()) {
            static_cast<void>(interpolator.tick());
            plan.work();
        }
        const path::Move move = move_to(end, path::Line{}, 0.01F);
        meter.begin();
        plan.push(move);
        plan.work();
        meter.end();
    }
    meter.report(out);
}

// One line of a program, from its characters to its move.
void count_line(std::string_view name, std::string_view first, std::string_view second)
{
    InstructionMeter meter{name};
    lines.reset();
    lines.set_position({});
    for (unsigned line = 0; line < 100; ++line) {
        gcode::Action action;
        meter.begin();
        const Status status = lines.execute(line % 2 == 0 ? first : second, line);
        const bool acts = lines.next(action);
        meter.end();
        CUSP_ASSERT(status && acts);
        while (lines.next(action)) {
        }
    }
    meter.report(out);
}

void count_parsing()
{
    count_line("parse_g1", "G1 X12.345 Y-6.789 Z0.25 F1200", "X-3.2 Y14.006 Z0.1");
    count_line("parse_g2", "G2 X10 Y0 I5 J0 Z-1 F1200", "G3 X0 Y0 I-5 J0 Z0");
}

}  // namespace

void cusp_main()
{
    out = hal::qemu::HostFile{":tt", hal::qemu::FileMode::kWrite};
    InstructionMeter::start_clock();
    count_interpolation();
    count_pulses("frame_at_0", "player_at_0", 0, 0);
    // The whole speed within a tick: more than any settings allow, and the dearest frame there is.
    count_pulses("frame_at_50k", "player_at_50k", 62500, 62500);
    count_pulses("frame_at_250k", "player_at_250k", 312500, 312500);
    // 10 m/s^2 on each axis.
    count_pulses("frame_to_250k", "player_to_250k", 312500, 10000);
    count_planning();
    count_three_ports();
    // The same frame.
    test::count_pio(player_of_pio, frame, out);
    count_parsing();
    test::count_law(law_budget, out);
    hal::qemu::exit_qemu(0);
}

extern "C" {
void cusp_rest() {}
void cusp_board_stop()
{
    hal::qemu::Console console;
    hal::cortex_m::report_last_fault(console);
    hal::qemu::exit_qemu(3);
}
void cusp_servo_tick() {}
void cusp_player_interrupt() {}
void cusp_serial_interrupt() {}
}

namespace {

constexpr std::array<hal::cortex_m::InterruptEntry, 0> kInterrupts{};

__attribute__((section(".vectors"), used)) constexpr auto kVectors =
    hal::cortex_m::make_vectors<hal::stm32f4::kInterruptCount>(
        &cusp_stack_top, cusp_reset, cusp_exception, cusp_servo_tick, kInterrupts);

}  // namespace
