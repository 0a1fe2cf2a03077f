// The greeting: waits for the controller, reads its settings, enables checks, resumes.
#include <algorithm>
#include <map>

#include "firmware/base/inch.hpp"
#include "host_tools/controller/stream/streamer.hpp"

namespace cusp::stream {

using dialect::ControllerStatus;
using dialect::FlowWindow;
using dialect::numbered_line;
using dialect::ProgramLines;
using std::chrono::milliseconds;

void Streamer::greet()
{
    const auto start = Clock::now();
    send_realtime('?');
    while (statuses_ == 0) {
        pump(kPump);
        if (Clock::now() - start > options_.greeting_limit) {
            throw Ending{StreamOutcome::kNotReady,
                         "no controller answers on this port within " +
                             std::to_string(options_.greeting_limit.count() / 1000) + " s"};
        }
    }
    if (options_.resume) {
        come_to_idle();
        return;
    }
    if (is_state("Alarm")) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is in alarm: home it ($H) or unlock it ($X) first"};
    }
    in_check_mode_ = is_state("Check");
    if (!is_state("Idle") && !in_check_mode_) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is not idle but in state " + progress_.status.state};
    }
}

// Before a resume: motion of the earlier run is held, and all modes are set to the defaults.
void Streamer::come_to_idle()
{
    hold_and_reset();
    stopping_ = false;
    constexpr milliseconds kLastBanner{300};
    const auto start = Clock::now();
    while (Clock::now() - start < kLastBanner) {
        pump(kPump);
    }
    const std::uint64_t before = statuses_;
    send_realtime('?');
    while (statuses_ == before) {
        pump(kPump);
    }
    if (!is_state("Idle") && !is_state("Alarm")) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is not idle but in state " + progress_.status.state};
    }
}

void Streamer::learn_controller()
{
    for (const char* command : {"$I", "$$", "$G", "$#"}) {
        if (checked_) {
            ask_checked(command);
        } else {
            ask(command);
        }
    }
    if (checked_ && facts_.receive_buffer()) {
        checked_->set_capacity(*facts_.receive_buffer());
    }
    window_.set_capacity(options_.window != 0 ? options_.window
                                              : std::max(facts_.receive_buffer().value_or(0),
                                                         FlowWindow::kGrblBuffer));
}

// Sends a command of the streamer's own and waits for the answer, which may be a refusal.
void Streamer::ask(const std::string& command)
{
    // A controller that resets when its port is opened may do so now, and one that checks lines
    // ignores the command; then it is sent again.
    constexpr int kAttempts = 4;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        const std::uint64_t answers = own_answers_;
        const std::uint64_t banners = banners_;
        const auto start = Clock::now();
        window_.clear();
        send_line(0, command);
        while (banners_ == banners && Clock::now() - start < options_.greeting_limit / 2) {
            if (own_answers_ != answers) {
                return;
            }
            pump(kPump);
        }
    }
    throw Ending{StreamOutcome::kNotReady, "the controller answers ? but not " + command};
}

// The command is sent checked, but its listing comes back unchecked: a line of it is accepted if it
// was received twice.
void Streamer::ask_checked(const std::string& command)
{
    constexpr int kMostTimes = 6;
    std::map<std::string, int> seen;
    std::vector<std::string> before;
    for (int time = 0; time < kMostTimes; ++time) {
        listing_.clear();
        send_checked_command(command);
        for (const std::string& line : listing_) {
            if (++seen[line] == 2) {
                facts_.take(line);
            }
        }
        if (time > 0 && listing_ == before) {
            return;
        }
        before = listing_;
    }
}

void Streamer::send_checked_command(const std::string& command)
{
    checked_->add(0, command);
    while (!checked_->empty()) {
        send_checked_lines();
        pump(milliseconds{5});
    }
}

// Homing is answered when it is finished; meanwhile reports show that the link works.
void Streamer::home()
{
    constexpr std::chrono::minutes kHomingLimit{10};
    const std::uint64_t answers = own_answers_;
    const std::uint64_t errors = own_errors_;
    const auto start = Clock::now();
    if (checked_) {
        checked_->add(0, "$H");
    } else {
        send_line(0, "$H");
    }
    while (own_answers_ == answers && !(checked_ && checked_->empty())) {
        if (checked_) {
            send_checked_lines();
        }
        pump(kPump);
        if (Clock::now() - start > kHomingLimit) {
            throw Ending{StreamOutcome::kNotReady, "homing does not end"};
        }
    }
    if (own_errors_ != errors) {
        throw Ending{StreamOutcome::kAlarm, "homing failed"};
    }
    const std::uint64_t before = statuses_;
    send_realtime('?');
    while (statuses_ == before) {
        pump(kPump);
    }
}

Position Streamer::machine_position() const
{
    const ControllerStatus& status = progress_.status;
    AxisVecd at = status.machine_position.value_or(AxisVecd{});
    if (!status.machine_position && status.work_position) {
        at = *status.work_position + progress_.work_offset;
    }
    const bool inches = facts_.settings().on(machine::Setting::kReportInches);
    for (unsigned axis = 0; inches && axis < kLinearAxes; ++axis) {
        at[axis] *= kMillimetresPerInch;
    }
    return to_position(at);
}

void Streamer::prepare_record()
{
    record_.start = facts_.start_at(machine_position());
    executed_.begin_at(1);
}

// Prepares a resume: where and how the program continues.
void Streamer::prepare_resume(ProgramLines& program)
{
    const StreamResume& resume = *options_.resume;
    const bool homes = is_state("Alarm");
    if (homes && !facts_.settings().on(machine::Setting::kHoming)) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is in alarm and can't home ($22=0): see that its position is "
                     "true and unlock it ($X) first"};
    }
    const Vec3d gone = xyz(to_millimetres(resume.record.last_seen));
    constexpr double kNear = 0.01;
    const bool lost = !homes && machine_position() == Position{} && norm(gone) > kNear;
    const bool goes_on = resume.confirm(facts_, machine_position(), homes, lost);
    last_heard_ = last_asked_ = Clock::now();
    if (!goes_on) {
        throw Ending{StreamOutcome::kNotReady, "not resumed"};
    }
    // The checks may have lapsed while waiting for the user.
    if (checked_) {
        checked_.reset();
        switch_checks_on();
    }
    if (homes) {
        home();
    }
    for (const std::string& line : resume.approach(facts_, machine_position())) {
        // With the number of the line that follows them.
        first_lines_.push_back(
            {0, options_.checked || !options_.numbers ? line : numbered_line(line, resume.line)});
    }
    record_.start = resume.record.start;
    executed_.begin_at(resume.line);
    while (auto line = program.next()) {
        if (line->number >= resume.line) {
            first_lines_.push_back(std::move(*line));
            break;
        }
        checks_.add(*line);
    }
}

// $CRC=1 itself is not protected: if damaged it is answered with an error, or not at all.
void Streamer::switch_checks_on()
{
    constexpr int kAttempts = 20;
    constexpr milliseconds kWait{300};
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        window_.clear();
        const std::uint64_t answers = own_answers_;
        const std::uint64_t errors = own_errors_;
        const auto start = Clock::now();
        send_line(0, "$CRC=1");
        while (own_answers_ == answers && Clock::now() - start < kWait) {
            pump(kPump);
        }
        if (own_answers_ != answers && own_errors_ == errors) {
            window_.clear();
            checked_.emplace(std::max(window_.capacity(), facts_.receive_buffer().value_or(0)));
            return;
        }
    }
    throw Ending{StreamOutcome::kNotReady, "the controller does not know checked lines ($CRC=1)"};
}

// An interrupted transfer has left checking on: the refusal contains the number that ends it.
void Streamer::leave_checks(const std::string& refusal)
{
    const auto number = refused_number(refusal);
    if (number) {
        window_.clear();
        outgoing_ += checked_line(*number, "$CRC=0") + "\n";
        send_waiting();
    }
}

}  // namespace cusp::stream
