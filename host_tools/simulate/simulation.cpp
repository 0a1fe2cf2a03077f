// The run: sender, controller and instruments around one clock of servo ticks.
#include "host_tools/simulate/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "boards/sim/simulated_controller.hpp"
#include "firmware/pulse/pulse_maker.hpp"
#include "host_tools/dialect/answer.hpp"
#include "host_tools/dialect/line_source.hpp"
#include "host_tools/dialect/program_lines.hpp"
#include "host_tools/dialect/refusal.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/simulate/mill_setup.hpp"
#include "host_tools/simulate/samples_writer.hpp"
#include "host_tools/simulate/vcd_writer.hpp"

namespace cusp::simulate {

using dialect::alarm_text;
using dialect::Answer;
using dialect::AnswerKind;
using dialect::bare_line;
using dialect::LineSource;
using dialect::numbered_line;
using dialect::parse_answer;
using dialect::refusal_text;
using dialect::refused_word;

namespace {

using board_sim::SimulatedController;
using machine::State;

constexpr double kSecondsPerTick = 1.0 / kServoTicksPerSecond;
// A controller at rest that answers nothing for a day of its time will not answer any more.
constexpr std::uint64_t kPatience = 24ULL * 3600 * kServoTicksPerSecond;

// Everything that looks at the controller while it runs.
class Instruments {
public:
    Instruments(SimulatedController& controller, const SimulationOptions& options)
        : controller_{controller},
          motion_{controller.machine().motion()},
          player_{controller.board().pulse_player},
          options_{options},
          start_steps_{controller.board().mill.steps_taken()},
          start_tick_{player_.next_frame_start()},
          statistics_{motion_.position()},
          shadow_{motion_.position()},
          delay_us_{pulse::PulseMaker::kDelayTicks * kPulseTicksPerFrame +
                    controller.machine().settings().steps().direction_setup_us}
    {
        if (!options.vcd_file.empty()) {
            vcd_ = std::make_unique<VcdWriter>(options.vcd_file, controller.board().mill,
                                               start_tick_, player_.levels());
            player_.add_listener(*vcd_);
        }
        if (!options.samples_file.empty()) {
            samples_ = std::make_unique<SamplesWriter>(options.samples_file);
            samples_->write(time_of_set_point() - kPulseTicksPerFrame, motion_.position());
        }
    }

    // One servo tick of everything.
    void tick()
    {
        controller_.tick_firmware();
        const Position at = motion_.position();
        const std::uint32_t line = motion_.executing_line();
        if (samples_) {
            samples_->write(time_of_set_point(), at);
        }
        statistics_.add(at);
        tool_times_.add_tick(line);
        shadow_.deviation().add_set_point(at);
        if (line != line_ && options_.line_started) {
            options_.line_started(line, static_cast<double>(statistics_.ticks()) * kSecondsPerTick);
        }
        line_ = line;
        controller_.tick_world();
    }

    // Plays what is in flight and fills in what was measured.
    void finish(SimulationResult& result)
    {
        controller_.tick_world();
        controller_.tick_world();
        statistics_.finish();
        if (vcd_) {
            vcd_->close();
        }
        if (samples_) {
            samples_->close();
        }
        result.duration_s = static_cast<double>(statistics_.moving_ticks()) * kSecondsPerTick;
        result.total_s = static_cast<double>(statistics_.ticks()) * kSecondsPerTick;
        result.moves = shadow_.moves();
        result.end = statistics_.end();
        result.length_mm = statistics_.length();
        result.max_velocity = statistics_.max_velocity();
        result.max_acceleration = statistics_.max_acceleration();
        result.max_jerk = statistics_.max_jerk();
        result.max_deviation_mm = shadow_.deviation().greatest();
        result.max_deviation_line = shadow_.deviation().line();
        result.tools = tool_times_.times();
        result.tool_changes = tool_times_.changes();
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            result.steps[axis] = controller_.board().mill.steps_taken()[axis] - start_steps_[axis];
        }
    }

    // The next line of the program, before it is sent.
    LineEffects read(std::string_view line, std::uint64_t number)
    {
        const LineEffects effects = shadow_.read(line, number);
        tool_times_.read_line(number, shadow_.tool());
        return effects;
    }

    ProgramShadow& shadow() { return shadow_; }
    double seconds() const { return static_cast<double>(statistics_.ticks()) * kSecondsPerTick; }

private:
    // When the last set point is reached, on the clock of the trace: the frame just handed over
    // ends one tick of the pulse maker's delay before it.
    std::uint64_t time_of_set_point() const
    {
        return player_.next_frame_start() - start_tick_ + kPulseTicksPerFrame + delay_us_;
    }

    SimulatedController& controller_;
    const machine::Motion& motion_;
    hal::SimulatedPlayer& player_;
    const SimulationOptions& options_;
    PerAxis<std::uint64_t> start_steps_;
    std::uint64_t start_tick_;
    MotionStatistics statistics_;
    ProgramShadow shadow_;
    ToolTimes tool_times_;
    std::uint64_t delay_us_;
    std::unique_ptr<VcdWriter> vcd_;
    std::unique_ptr<SamplesWriter> samples_;
    std::uint32_t line_{0};
};

// The sender: one line at a time, the next as soon as the answer is there.
class Sender {
public:
    Sender(SimulatedController& controller, SimulationResult& result)
        : controller_{controller}, result_{result}
    {
    }

    //   line   as it goes to the controller
    //   block  as the program has it
    void send(const std::string& line, const std::string& block, std::uint64_t number)
    {
        controller_.board().byte_link.send(line + "\n");
        block_ = block;
        number_ = number;
        waiting_ = true;
    }

    // Reads what the controller has said.
    void listen()
    {
        for (const char byte : controller_.board().byte_link.take_answers()) {
            if (byte == '\n') {
                take(parse_answer(heard_));
                heard_.clear();
            } else if (byte != '\r') {
                heard_.push_back(byte);
            }
        }
    }

    // From here on a banner means that the program is gone.
    void begin() { begun_ = true; }
    bool waiting() const { return waiting_; }
    bool failed() const { return !result_.errors.empty() || result_.alarm != 0; }

private:
    void take(const Answer& answer)
    {
        if (answer.kind == AnswerKind::kOk) {
            waiting_ = false;
        } else if (answer.kind == AnswerKind::kError) {
            waiting_ = false;
            result_.errors.push_back({number_, answer.code, refusal_text(answer.code, block_), block_,
                                      refused_word(answer.code, block_)});
        } else if (answer.kind == AnswerKind::kAlarm) {
            result_.alarm = answer.code;
            result_.errors.push_back(
                {number_, answer.code, "alarm: " + std::string{alarm_text(answer.code)}, "", ""});
        } else if (answer.kind == AnswerKind::kBanner && begun_) {
            waiting_ = false;
            result_.errors.push_back({number_, 0, "the controller was reset", "", ""});
        }
    }

    SimulatedController& controller_;
    SimulationResult& result_;
    std::string heard_;
    std::string block_;
    std::uint64_t number_{0};
    bool waiting_{false};
    bool begun_{false};
};

class Simulation {
public:
    Simulation(const std::string& program, const SimulationOptions& options)
        : options_{options},
          source_{program},
          controller_{mill_geometry(options.settings, options.probe_z, kNearHome)},
          sender_{controller_, result_}
    {
        if (!store_settings(options.settings, controller_.board().settings_store)) {
            throw InputError{"the simulated settings store can't be written"};
        }
        controller_.power_on();
        // The length of the pulse on the probe, the limits: all is as it was stored.
        controller_.tick();
        sender_.listen();
    }

    SimulationResult run()
    {
        const auto start = std::chrono::steady_clock::now();
        home();
        controller_.board().byte_link.set_bits_per_second(options_.bits_per_second);
        Instruments instruments{controller_, options_};
        sender_.begin();
        while (!sender_.failed() && !done_) {
            step(instruments);
        }
        come_to_rest(instruments);
        if (instruments.shadow().in_nurbs() && !sender_.failed()) {
            constexpr int kInvalidTarget = 33;
            result_.errors.push_back(
                {source_.line_number(), kInvalidTarget, "the program ends inside a NURBS", "", ""});
        }
        instruments.finish(result_);
        result_.lines = source_.line_number();
        result_.wall_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result_;
    }

private:
    const machine::Machine& machine() const { return controller_.machine(); }

    void home()
    {
        if (!options_.settings.on(machine::Setting::kHoming)) {
            return;
        }
        sender_.send("$H", "", 0);
        while (sender_.waiting() && !sender_.failed()) {
            controller_.tick();
            sender_.listen();
        }
    }

    // Sends all that can be sent now, then lets one servo tick pass.
    void step(Instruments& instruments)
    {
        send_script();
        controller_.settle();
        sender_.listen();
        while (!sender_.waiting() && !sender_.failed() && send_next(instruments)) {
            controller_.settle();
            sender_.listen();
            after_answer(instruments.shadow());
        }
        go_on_after_pause();
        if (!sender_.waiting() && no_more_lines_ && machine().idle() &&
            machine().motion().settled()) {
            done_ = true;
            return;
        }
        count_waiting();
        instruments.tick();
        sender_.listen();
        after_answer(instruments.shadow());
        if (++ticks_ % 1024 == 0) {
            report(instruments);
        }
    }

    void send_script()
    {
        for (; next_byte_ < options_.script.size() && options_.script[next_byte_].tick <= ticks_;
             ++next_byte_) {
            const auto byte = static_cast<char>(options_.script[next_byte_].byte);
            controller_.board().byte_link.send({&byte, 1});
        }
    }

    bool send_next(Instruments& instruments)
    {
        while (!no_more_lines_) {
            const auto line = source_.next();
            if (!line) {
                no_more_lines_ = true;
                break;
            }
            const std::string uncovered = bare_line(*line);
            if (uncovered.empty()) {
                continue;
            }
            const std::string numbered = numbered_line(uncovered, source_.line_number());
            effects_ = instruments.read(numbered, source_.line_number());
            no_more_lines_ = effects_.ends_program;
            if (effects_.pauses) {
                note_pause();
            }
            sender_.send(numbered, *line, source_.line_number());
            return true;
        }
        return false;
    }

    void after_answer(ProgramShadow& shadow)
    {
        if (effects_.moves_by_itself && !sender_.waiting()) {
            effects_.moves_by_itself = false;
            shadow.set_position(machine().motion().tail());
        }
    }

    void note_pause()
    {
        constexpr std::size_t kMostListed = 1000;
        ++result_.pauses;
        if (result_.pause_lines.size() < kMostListed) {
            result_.pause_lines.push_back(source_.line_number());
        }
    }

    void go_on_after_pause()
    {
        const bool scripted = next_byte_ < options_.script.size();
        if (!scripted && machine().state() == State::kHold && machine().motion().at_rest()) {
            controller_.board().byte_link.send("~");
            controller_.settle();
            sender_.listen();
        }
    }

    void count_waiting()
    {
        const bool rests = machine().motion().finished();
        // Bytes that the line still carries, and nothing to do meanwhile.
        if (rests && controller_.board().byte_link.unread() > 0) {
            ++result_.starved_ticks;
        }
        resting_ticks_ = rests ? resting_ticks_ + 1 : 0;
        if (resting_ticks_ > kPatience) {
            result_.errors.push_back(
                {source_.line_number(), 0, "the controller rests and answers no more", "", ""});
        }
    }

    // After an error what was taken already is still done, as on a real machine.
    void come_to_rest(Instruments& instruments)
    {
        for (std::uint64_t tick = 0; tick < kPatience && !machine().motion().settled(); ++tick) {
            if (machine().state() == State::kHold && machine().motion().at_rest()) {
                break;
            }
            instruments.tick();
        }
    }

    void report(const Instruments& instruments)
    {
        const auto now = std::chrono::steady_clock::now();
        if (now - last_report_ < std::chrono::milliseconds{100}) {
            return;
        }
        last_report_ = now;
        if (options_.progress) {
            options_.progress({source_.progress(), source_.line_number(), instruments.seconds()});
        }
        if (options_.stop && options_.stop()) {
            result_.stopped = true;
            done_ = true;
        }
    }

    const SimulationOptions& options_;
    LineSource source_;
    SimulationResult result_;
    SimulatedController controller_;
    Sender sender_;
    LineEffects effects_;
    bool no_more_lines_{false};
    bool done_{false};
    std::uint64_t ticks_{0};
    std::size_t next_byte_{0};  // of the script
    std::uint64_t resting_ticks_{0};
    std::chrono::steady_clock::time_point last_report_{};
};

}  // namespace

SimulationResult simulate(const std::string& program_file, const SimulationOptions& options)
{
    return std::make_unique<Simulation>(program_file, options)->run();
}

}  // namespace cusp::simulate
