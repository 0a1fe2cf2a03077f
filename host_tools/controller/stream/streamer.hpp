// Streamer: sends a program to a Grbl controller line by line, keeps its buffer full, and reports
// how the transfer ended. The front door of `stream`.
//
//     const std::unique_ptr<Transport> transport = open_transport("/dev/ttyUSB0", 115200);
//     dialect::ProgramLines program{"part.ngc"};
//     Streamer streamer{*transport, watcher, {}};  // watcher: your StreamWatcher
//     const StreamReport report = streamer.run(program, stop);
//     if (report.outcome == StreamOutcome::kError) { ... report.text ... }
//
// Flow control counts characters (FlowWindow). Realtime bytes are sent before waiting lines. Only
// unanswered lines are held in memory.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/controller/dialect/dialect.hpp"
#include "host_tools/controller/stream/checked_window.hpp"
#include "host_tools/controller/stream/controller_facts.hpp"
#include "host_tools/controller/stream/executed_line.hpp"
#include "host_tools/controller/stream/program_check.hpp"
#include "host_tools/controller/stream/transfer_record.hpp"
#include "host_tools/controller/stream/transport.hpp"

namespace cusp::stream {

// The way to resume an interrupted program.
struct StreamResume {
    TransferRecord record;
    std::uint64_t line{0};  // of the file, the first to send
    // Asks the user. The controller is at rest. homes: it will be homed first. place_lost: the tool
    // position seems to be lost.
    std::function<bool(const ControllerFacts&, Position machine, bool homes, bool place_lost)>
        confirm;
    // The lines to be sent before the program's.
    std::function<std::vector<std::string>(const ControllerFacts&, Position machine)> approach;
};

struct StreamOptions {
    // Bytes of the controller's receive buffer; 0: query it, 128 if unknown.
    std::size_t window{0};
    std::chrono::milliseconds status_interval{200};
    // Silence, despite status requests, after which the link is considered lost.
    std::chrono::milliseconds silence_limit{5000};
    // For an answer while the controller reports that it is idle, beside the program's longest dwell.
    std::chrono::milliseconds answer_limit{30'000};
    // Lines with numbers and CRCs, for bad serial lines; the controller must support them.
    bool checked{false};
    // Longest time until the controller's first output.
    std::chrono::milliseconds greeting_limit{5000};
    // Lines get their number in the file as N word, so that reports can refer to them.
    bool numbers{true};
    std::optional<StreamResume> resume;
    // Receives the data needed to resume, from time to time and at the end.
    std::function<void(const TransferRecord&)> keep;
};

struct StreamProgress {
    std::uint64_t lines_sent{0};
    std::uint64_t lines_answered{0};
    std::uint64_t line{0};             // of the file, answered last
    double sent_fraction{0.0};         // of the file's bytes
    dialect::ControllerStatus status;  // the latest
    std::uint64_t lines_resent{0};
    AxisVecd work_offset;
    int feed_override{100};
    bool done{false};  // all of it, and the machine is at rest
};

enum class StreamKey : std::uint8_t {
    kNone,
    kHold,
    kResume,
    kFeedNormal,
    kFeedUpTen,
    kFeedDownTen,
    kFeedUpOne,
    kFeedDownOne,
    kAbort,
};

// Observes and controls a transfer.
class StreamWatcher {
public:
    StreamWatcher() = default;
    StreamWatcher(const StreamWatcher&) = delete;
    StreamWatcher& operator=(const StreamWatcher&) = delete;
    virtual ~StreamWatcher() = default;

    // The controller answers; nothing is sent yet.
    virtual void ready(const ControllerFacts& facts) = 0;
    // Called some fifty times a second.
    virtual void progress(const StreamProgress& progress) = 0;
    // A message to the user at the machine.
    virtual void notice(const std::string& text) = 0;
    // The key that was pressed; kNone if none was.
    virtual StreamKey key() = 0;
};

enum class StreamOutcome : std::uint8_t {
    kDone,
    kStopped,  // by the user: held, then reset
    kError,    // the controller refused a line
    kAlarm,
    kLinkLost,
    kNotReady,  // the controller is in alarm, or does not answer: nothing was sent
};

struct StreamReport {
    StreamOutcome outcome{StreamOutcome::kDone};
    std::string text;  // what happened, in words; empty after success
    StreamProgress progress;
    // The data needed to resume; none if nothing of the program was sent.
    std::optional<TransferRecord> record;
};

class Streamer {
public:
    // All three must outlive the streamer.
    Streamer(Transport& transport, StreamWatcher& watcher, const StreamOptions& options);

    // Sends the program and waits until the machine is at rest.
    //
    // stop  set by a signal handler: holds, then resets; set to 2 or more: resets at once
    StreamReport run(dialect::ProgramLines& program, const std::atomic<int>& stop);

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kPump{20};

    // Each throws Ending if the transfer is over.
    struct Ending {
        StreamOutcome outcome;
        std::string text;
    };
    void greet();
    void come_to_idle();
    void home();
    void learn_controller();
    void ask(const std::string& command);
    void ask_checked(const std::string& command);
    void send_checked_command(const std::string& command);
    void send_checked_lines();
    void prepare_record();
    void prepare_resume(dialect::ProgramLines& program);
    std::optional<dialect::ProgramLine> next_line(dialect::ProgramLines& program);
    void keep_record(const std::string& ending);
    void send_program(dialect::ProgramLines& program);
    void switch_checks_on();
    void leave_checks(const std::string& refusal);
    void send_checked_program(dialect::ProgramLines& program);
    void wait_for_rest();
    void hold_and_reset();

    void send_waiting();
    void send_line(std::uint64_t number, std::string text);
    void send_realtime(char byte);
    void pump(std::chrono::milliseconds wait);
    static std::string without_checksum(const std::string& line);
    void take_line(const std::string& line);
    void take_listing(const std::string& line);
    void take_status(const dialect::ControllerStatus& status);
    void take_answer(const dialect::Answer& answer);
    void take_checked(const std::string& line);
    void take_key(StreamKey key);
    void take_error(std::uint64_t line, int code);
    void check_silence();
    // A line that is sent is answered from now on; that it is answered counts as life.
    void note_answer() { last_answered_ = Clock::now(); }
    bool waits_for_answer() const;
    void take_bytes(const std::string& bytes);
    void refuse_realtime_byte(const dialect::ProgramLine& line);
    Position machine_position() const;
    bool is_state(const char* state) const { return progress_.status.state == state; }

    Transport& transport_;
    StreamWatcher& watcher_;
    StreamOptions options_;
    const std::atomic<int>* stop_{nullptr};
    std::string file_;
    dialect::FlowWindow window_;
    std::optional<CheckedWindow> checked_;
    StreamProgress progress_;
    std::string incoming_;
    bool after_return_{false};  // the last byte that came was a carriage return
    bool is_noise_{false};      // the line that is coming holds bytes of no answer
    std::string outgoing_;
    Clock::time_point last_heard_;        // a line of text
    Clock::time_point last_answered_;     // or sent, where none was waited for
    std::chrono::milliseconds dwell_{0};  // the longest of the program so far
    Clock::time_point last_asked_;
    std::uint64_t statuses_{0};
    std::uint64_t banners_{0};
    std::uint64_t own_answers_{0};
    std::uint64_t own_errors_{0};
    bool stopping_{false};
    ControllerFacts facts_;
    // of the last query, with checked lines
    std::vector<std::string> listing_;
    bool in_check_mode_{false};
    std::deque<dialect::ProgramLine> first_lines_;  // of the approach, and the first of the program
    bool sending_{false};                           // the program, or the approach to it
    TransferRecord record_;
    ExecutedLine executed_;
    ProgramChecks checks_;
    Clock::time_point last_kept_;
};

}  // namespace cusp::stream
