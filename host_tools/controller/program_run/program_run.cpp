// The run: sender, controller and instruments around one clock of servo ticks.
#include "host_tools/controller/program_run/program_run.hpp"

#include "boards/sim/simulated_controller.hpp"
#include "firmware/machine/tool_changer.hpp"
#include "host_tools/controller/dialect/answer.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"
#include "host_tools/controller/dialect/refusal.hpp"
#include "host_tools/controller/dialect/stock_grbl.hpp"
#include "host_tools/controller/program_run/instruments.hpp"
#include "host_tools/controller/program_run/mill_setup.hpp"

namespace cusp::program_run {

using board_sim::SimulatedController;
using dialect::Answer;
using dialect::AnswerKind;
using dialect::LineSource;

namespace {

using machine::State;

// A controller at rest that has not answered for a day of machine time is stuck.
constexpr std::uint64_t kPatience = 24ULL * 3600 * kServoTicksPerSecond;

// The sender: one line at a time, each after the answer to the one before.
class Sender {
public:
    Sender(SimulatedController& controller, RunResult& result)
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

    // Processes the controller's output.
    void listen()
    {
        for (const char byte : controller_.board().byte_link.take_answers()) {
            if (byte == '\n') {
                take(dialect::parse_answer(heard_));
                heard_.clear();
            } else if (byte != '\r') {
                heard_.push_back(byte);
            }
        }
    }

    // From now on a banner means that the controller was reset and the program lost.
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
            const dialect::Refusal found = dialect::refusal(answer.code, block_);
            result_.errors.push_back({number_, answer.code, found.text, block_,
                                      block_.substr(found.begin, found.end - found.begin)});
        } else if (answer.kind == AnswerKind::kAlarm) {
            result_.alarm = answer.code;
            result_.errors.push_back({number_, answer.code,
                                      "alarm: " + std::string{dialect::alarm_text(answer.code)}, "",
                                      ""});
        } else if (answer.kind == AnswerKind::kBanner && begun_) {
            waiting_ = false;
            result_.errors.push_back({number_, 0, "the controller was reset", "", ""});
        }
    }

    SimulatedController& controller_;
    RunResult& result_;
    std::string heard_;
    std::string block_;
    std::uint64_t number_{0};
    bool waiting_{false};
    bool begun_{false};
};

enum class Phase : std::uint8_t { kHoming, kRunning, kResting, kDone };

}  // namespace

class ProgramRun::Implementation {
public:
    Implementation(LineSource& source, const RunOptions& options)
        : options_{options},
          source_{source},
          controller_{mill_geometry(options.settings, options.probe_z, kNearHome)},
          sender_{controller_, result_}
    {
        // A store in memory accepts them: no power cut is set.
        store_settings(options.settings, controller_.board().settings_store);
        controller_.power_on();
        // The length of the pulse on the probe, the limits: all is as it was stored.
        controller_.tick();
        sender_.listen();
        if (options_.settings.on(machine::Setting::kHoming)) {
            sender_.send("$H", "", 0);
        }
    }

    bool advance()
    {
        switch (phase_) {
            case Phase::kHoming:
                home();
                break;
            case Phase::kRunning:
                step();
                break;
            case Phase::kResting:
                come_to_rest();
                break;
            case Phase::kDone:
                break;
        }
        return phase_ != Phase::kDone;
    }

    void stop()
    {
        result_.stopped = true;
        no_more_lines_ = true;
        if (phase_ == Phase::kRunning) {
            phase_ = Phase::kResting;
        }
    }

    double fraction() const { return source_.progress(); }
    std::uint64_t line() const { return source_.line_number(); }
    double seconds() const { return instruments_ ? instruments_->seconds() : 0.0; }
    const RunResult& result() const { return result_; }

private:
    const machine::Machine& machine() const { return controller_.machine(); }

    void home()
    {
        if (sender_.waiting() && !sender_.failed()) {
            controller_.tick();
            sender_.listen();
            return;
        }
        controller_.board().byte_link.set_bits_per_second(options_.bits_per_second);
        instruments_.emplace(controller_, options_);
        sender_.begin();
        phase_ = Phase::kRunning;
    }

    // Sends what can be sent now, then advances one servo tick.
    void step()
    {
        if (sender_.failed()) {
            phase_ = Phase::kResting;
            return;
        }
        send_script();
        controller_.settle();
        sender_.listen();
        while (!sender_.waiting() && !sender_.failed() && send_next()) {
            controller_.settle();
            sender_.listen();
            after_answer();
        }
        go_on_after_pause();
        if (!sender_.waiting() && no_more_lines_ && machine().idle() &&
            machine().motion().settled()) {
            phase_ = Phase::kResting;
            return;
        }
        count_waiting();
        instruments_->tick();
        sender_.listen();
        after_answer();
        ++ticks_;
    }

    void send_script()
    {
        for (; next_byte_ < options_.script.size() && options_.script[next_byte_].tick <= ticks_;
             ++next_byte_) {
            const auto byte = static_cast<char>(options_.script[next_byte_].byte);
            controller_.board().byte_link.send({&byte, 1});
        }
    }

    bool send_next()
    {
        while (!no_more_lines_) {
            const auto line = source_.next();
            if (!line || end_line_.at(*line)) {
                no_more_lines_ = true;
                break;
            }
            if (options_.stock_grbl && refused_by_stock_grbl(*line)) {
                return false;
            }
            const std::string words = dialect::bare_line(*line);
            if (words.empty()) {
                continue;
            }
            if (const auto byte = dialect::realtime_byte(words)) {
                refuse_byte(*line, words.substr(*byte, 1));
                return false;
            }
            const std::string numbered = dialect::numbered_line(words, source_.line_number());
            effects_ = instruments_->read(numbered, source_.line_number());
            no_more_lines_ = effects_.ends_program;
            if (effects_.ignores_rotary) {
                result_.rotary_line = source_.line_number();
            }
            if (effects_.pauses) {
                note_pause();
            }
            measured_tool_ =
                effects_.changes_tool &&
                machine::tool_change_mode(options_.settings) == machine::ToolChangeMode::kTouchOff;
            sender_.send(numbered, *line, source_.line_number());
            return true;
        }
        return false;
    }

    // A line that a controller would take for a command of the operator is not sent.
    void refuse_byte(const std::string& line, const std::string& byte)
    {
        constexpr int kNoLetter = 1;
        result_.errors.push_back(
            {source_.line_number(), kNoLetter, dialect::refusal(kNoLetter, line).text, line, byte});
        no_more_lines_ = true;
    }

    bool refused_by_stock_grbl(const std::string& line)
    {
        const dialect::StockGrblRefusal found =
            dialect::stock_grbl_refusal(line, instruments_->shadow().interpreter());
        if (found.code == 0) {
            return false;
        }
        result_.errors.push_back({source_.line_number(), found.code,
                                  dialect::refusal_text(found.code, found.word, line) +
                                      ": stock Grbl 1.1 does not take it",
                                  line, found.word});
        no_more_lines_ = true;
        return true;
    }

    void after_answer()
    {
        if (effects_.moves_by_itself && !sender_.waiting()) {
            effects_.moves_by_itself = false;
            instruments_->shadow().set_position(machine().motion().tail());
        }
        if (measured_tool_ && !sender_.waiting()) {
            measured_tool_ = false;
            instruments_->shadow().tool_changed(machine().motion().tail(), machine().parameters());
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
        // Only bytes in transit on the line are left.
        if (rests && controller_.board().byte_link.unread() > 0) {
            ++result_.starved_ticks;
        }
        resting_ticks_ = rests ? resting_ticks_ + 1 : 0;
        if (resting_ticks_ > kPatience) {
            result_.errors.push_back({source_.line_number(), 0,
                                      "the controller is at rest and does not answer", "", ""});
        }
    }

    // After an error, accepted lines are still executed, as on a real machine.
    void come_to_rest()
    {
        const bool held = machine().state() == State::kHold && machine().motion().at_rest();
        if (!machine().motion().settled() && !held && come_to_rest_ticks_ < kPatience) {
            ++come_to_rest_ticks_;
            instruments_->tick();
            return;
        }
        if (instruments_->shadow().in_nurbs() && !sender_.failed()) {
            constexpr int kInvalidTarget = 33;
            result_.errors.push_back(
                {source_.line_number(), kInvalidTarget, "the program ends inside a NURBS", "", ""});
        }
        instruments_->finish(result_);
        result_.lines = source_.line_number();
        phase_ = Phase::kDone;
    }

    const RunOptions& options_;
    LineSource& source_;
    dialect::EndLine end_line_;
    RunResult result_;
    SimulatedController controller_;
    Sender sender_;
    std::optional<Instruments> instruments_;
    LineEffects effects_;
    Phase phase_{Phase::kHoming};
    bool no_more_lines_{false};
    bool measured_tool_{false};  // the line sent last may measure the tool
    std::uint64_t ticks_{0};
    std::size_t next_byte_{0};  // of the script
    std::uint64_t resting_ticks_{0};
    std::uint64_t come_to_rest_ticks_{0};
};

ProgramRun::ProgramRun(LineSource& source, const RunOptions& options)
    : implementation_{std::make_unique<Implementation>(source, options)}
{
}

ProgramRun::~ProgramRun() = default;

bool ProgramRun::advance() { return implementation_->advance(); }
void ProgramRun::stop() { implementation_->stop(); }
double ProgramRun::fraction() const { return implementation_->fraction(); }
std::uint64_t ProgramRun::line() const { return implementation_->line(); }
double ProgramRun::seconds() const { return implementation_->seconds(); }
const RunResult& ProgramRun::result() const { return implementation_->result(); }

std::string fault_text(const RunResult& result, const RunError& error)
{
    if (error.code == 0) {
        return error.text;
    }
    const char* kind = result.alarm != 0 ? "ALARM:" : "error:";
    return kind + std::to_string(error.code) + ": " + error.text;
}

}  // namespace cusp::program_run
