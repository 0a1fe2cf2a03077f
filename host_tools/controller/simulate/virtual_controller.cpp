// Runs the simulated controller in real time.
#include "host_tools/controller/simulate/virtual_controller.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <poll.h>

#include "boards/sim/simulated_controller.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/program_run/mill_setup.hpp"
#include "host_tools/controller/simulate/fault_command.hpp"
#include "host_tools/controller/simulate/serial_end.hpp"
#include "host_tools/controller/simulate/settings_file.hpp"
#include "host_tools/controller/simulate/vcd_writer.hpp"

namespace cusp::simulate {

using program_run::kAmidTravel;
using program_run::mill_geometry;
using program_run::store_settings;
using program_run::stored_settings;

namespace {

using Clock = std::chrono::steady_clock;
using board_sim::SimulatedController;

constexpr std::chrono::microseconds kTick{1'000'000 / kServoTicksPerSecond};
// After a suspended host resumes, the mill does not catch up the missed time.
constexpr std::chrono::milliseconds kMostLag{100};

// The message of a board with USB when a sender raises DTR.
constexpr const char* kBanner = "\r\nGrbl 1.1h ['$' for help]\r\n";

SerialEnd open_end(const ServeOptions& options)
{
    return options.tcp ? SerialEnd{*options.tcp} : SerialEnd{options.pty_link};
}

// Fills the store from the settings file.
void fill_store(const ServeOptions& options, hal::SimulatedStore& store)
{
    if (options.settings_file.empty()) {
        return;
    }
    const std::string kept = options.settings_file + ".store";
    if (!store.keep_in(kept)) {
        throw InputError{kept + ": can't be used as a settings store"};
    }
    if (std::filesystem::exists(options.settings_file) &&
        !store_settings(read_settings_file(options.settings_file), store)) {
        throw InputError{kept + ": can't be written"};
    }
}

class VirtualController {
public:
    explicit VirtualController(const ServeOptions& options)
        : options_{options},
          end_{open_end(options)},
          to_controller_{options.faults, options.seed},
          from_controller_{options.faults, options.seed + 1}
    {
        hal::SimulatedBoard& board = controller_.board();
        fill_store(options, board.settings_store);
        geometry_ =
            mill_geometry(stored_settings(board.settings_store), options.probe_z, kAmidTravel);
        board.mill.set_geometry(geometry_);
        board.settings_store.cut_power_after(options.cut_power_after);
        board.mill.force_high(options.stuck_high);
        board.mill.force_low(options.stuck_low);
        controller_.power_on();
        // Its first output is lost without a sender; a sender gets the banner on connecting.
        controller_.settle();
        controller_.board().byte_link.take_answers();
        if (options.control) {
            control_.emplace(*options.control);
        }
        if (!options.vcd_file.empty()) {
            vcd_ = std::make_unique<VcdWriter>(options.vcd_file, board.mill, 0, PulseLines{0},
                                               stored_settings(board.settings_store).axes());
            board.pulse_player.add_listener(*vcd_);
        }
        keep_settings();
        words_kept_ = board.settings_store.words_written();
        say("serving on " + end_.name());
    }

    void run(const std::atomic<int>& stop)
    {
        auto next_tick = Clock::now();
        bool busy = false;
        while (stop.load() == 0) {
            if (!busy) {
                wait_until(next_tick);
            }
            busy = exchange();
            const auto now = Clock::now();
            if (now - next_tick > kMostLag) {
                next_tick = now;
            }
            while (next_tick <= now) {
                if (now - next_tick > kTick) {
                    controller_.tick();  // late: the work between ticks is due as well
                } else {
                    controller_.tick_amid_work();
                }
                to_controller_.advance();
                from_controller_.advance();
                next_tick += kTick;
            }
            run_control_commands();
            watch_store();
        }
        if (vcd_) {
            vcd_->close();
        }
    }

private:
    void wait_until(Clock::time_point time)
    {
        const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(time - Clock::now());
        if (left.count() <= 0) {
            return;
        }
        pollfd sources[] = {{end_.descriptor(), POLLIN, 0},
                            {control_ ? control_->descriptor() : -1, POLLIN, 0}};
        const timespec timeout{0, static_cast<long>(left.count())};
        ::ppoll(sources, 2, &timeout, nullptr);
    }

    // Bytes in, a slice of the firmware's work, bytes out. Returns whether work is left, so that
    // neither a status request nor a tick waits until all is done.
    bool exchange()
    {
        constexpr unsigned kSlices = 32;
        bool busy = false;
        // Read before the look at the line: a sender that reconnects in between would find its
        // first line read, and the answer dropped because nobody was there.
        const std::string received = end_.read();
        const bool had_peer = end_.has_peer();
        if (end_.update_peer()) {
            say("a sender has connected");
            if (controller_.is_on()) {
                end_.write(kBanner);
            }
        } else if (had_peer && !end_.has_peer()) {
            say("the sender has disconnected");
        }
        to_controller_.put(received);
        const std::string arrived = to_controller_.take();
        if (controller_.is_on()) {
            controller_.board().byte_link.send(arrived);
            busy = controller_.work(kSlices);
            from_controller_.put(controller_.board().byte_link.take_answers());
        }
        end_.write(from_controller_.take());
        return busy;
    }

    void run_control_commands()
    {
        if (!control_) {
            return;
        }
        control_->update_peer();
        control_text_ += control_->read();
        std::size_t end = 0;
        while ((end = control_text_.find('\n')) != std::string::npos) {
            const std::string line = control_text_.substr(0, end);
            control_text_.erase(0, end + 1);
            control_->write(run_command(line) + "\n");
        }
        control_->write({});
    }

    std::string run_command(const std::string& line)
    {
        const auto command = parse_fault_command(line);
        if (!command) {
            return "unknown: " + line;
        }
        hal::SimulatedMill& mill = controller_.board().mill;
        switch (command->kind) {
            case FaultKind::kUnplug:
                end_.unplug();
                to_controller_.clear();
                from_controller_.clear();
                break;
            case FaultKind::kPlug:
                end_.plug();
                break;
            case FaultKind::kPowerOff:
                controller_.power_off();
                break;
            case FaultKind::kPowerOn:
                controller_.board().settings_store.cut_power_after(std::nullopt);
                controller_.power_on();
                break;
            case FaultKind::kCutPowerAfter:
                controller_.board().settings_store.cut_power_after(
                    static_cast<std::uint64_t>(command->value));
                break;
            case FaultKind::kInputHigh:
                stuck_high_ = static_cast<std::uint16_t>(stuck_high_ | command->inputs);
                break;
            case FaultKind::kInputLow:
                stuck_low_ = static_cast<std::uint16_t>(stuck_low_ | command->inputs);
                break;
            case FaultKind::kInputFree:
                stuck_high_ = static_cast<std::uint16_t>(stuck_high_ & ~command->inputs);
                stuck_low_ = static_cast<std::uint16_t>(stuck_low_ & ~command->inputs);
                break;
            case FaultKind::kProbePlate:
                geometry_.plate_above_start = command->value;
                mill.set_geometry(geometry_);
                break;
            case FaultKind::kLineFaults:
                to_controller_.set_faults(command->faults);
                from_controller_.set_faults(command->faults);
                break;
            case FaultKind::kLoseFrame:
                controller_.board().pulse_player.lose_next_frame();
                break;
            case FaultKind::kOverrun:
                controller_.board().byte_link.mark_overrun();
                break;
            case FaultKind::kWhere:
                return where();
        }
        mill.force_high(stuck_high_);
        mill.force_low(stuck_low_);
        return "ok";
    }

    std::string where() const
    {
        const hal::SimulatedMill& mill = controller_.board().mill;
        const Vec3d at = mill.place();
        const hal::OutputLevels& outputs = mill.outputs();
        return fmt::format(
            "iron {:.4f},{:.4f},{:.4f} steps {},{},{} inputs {} spindle {} flood {} "
            "mist {} power {}",
            at.x, at.y, at.z, mill.steps()[0], mill.steps()[1], mill.steps()[2], mill.inputs(),
            outputs.spindle_on ? int{outputs.spindle_pwm} / (kFullDuty / 1000) : 0,
            int{outputs.flood}, int{outputs.mist}, controller_.is_on() ? "on" : "off");
    }

    // A change of the store may be a change of settings. A power cut stops the controller.
    void watch_store()
    {
        const hal::SimulatedStore& store = controller_.board().settings_store;
        if (store.power_is_cut() && controller_.is_on()) {
            say("the power failed during a write to the settings store");
            controller_.power_off();
        }
        if (store.words_written() != words_kept_) {
            words_kept_ = store.words_written();
            keep_settings();
        }
    }

    void keep_settings()
    {
        if (options_.settings_file.empty() || !controller_.is_on()) {
            return;
        }
        const std::string fresh = options_.settings_file + ".new";
        files::TextFile file{fresh};
        file.write(settings_text(controller_.machine().settings()));
        file.close();
        std::filesystem::rename(fresh, options_.settings_file);
    }

    void say(const std::string& text) const
    {
        if (options_.notice) {
            options_.notice(text);
        }
    }

    const ServeOptions& options_;
    hal::MillGeometry geometry_;
    SimulatedController controller_{hal::MillGeometry{}};
    SerialEnd end_;
    std::optional<SerialEnd> control_;
    std::string control_text_;
    hal::FaultyLine to_controller_;
    hal::FaultyLine from_controller_;
    std::unique_ptr<VcdWriter> vcd_;
    std::uint64_t words_kept_{0};
    std::uint16_t stuck_high_{options_.stuck_high};
    std::uint16_t stuck_low_{options_.stuck_low};
};

}  // namespace

void serve(const ServeOptions& options, const std::atomic<int>& stop)
{
    std::make_unique<VirtualController>(options)->run(stop);
}

}  // namespace cusp::simulate
