// The simulator's order of bytes and servo ticks (host_tools/controller/simulate), through a serial port.
#include "tests/target/cosim/golden_sender.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr Picoseconds kNoTime = 1;  // an instruction, in picoseconds
// A core that goes round in circles: neither a tick nor an answer comes within so many. The most that
// was seen, while NURBS are read ahead, is 99 million (program 2089 of on_chip.py).
constexpr std::uint64_t kMostInstructions = 400'000'000;
// Ticks without an edge after a refusal: slow moves step a few times a second.
constexpr std::uint64_t kSilence = 2000;

bool starts_with(const std::string& text, const char* with) { return text.rfind(with, 0) == 0; }

// True if a program may come to a hold of its own.
bool has_pause(const std::string& line)
{
    for (std::size_t at = line.find_first_of("Mm"); at != std::string::npos;
         at = line.find_first_of("Mm", at + 1)) {
        std::size_t digit = at + 1;
        while (digit < line.size() && (line[digit] == ' ' || line[digit] == '0')) {
            ++digit;
        }
        const char next = digit < line.size() ? line[digit] : ' ';
        if (next == '1' || next == '6' || next < '0' || next > '9') {
            return true;
        }
    }
    return false;
}

}  // namespace

PinName pin_name(const std::string& text)
{
    const bool named = text.size() >= 3 && ((text[0] == 'P' && text[1] >= 'A' && text[1] <= 'I') ||
                                            (text[0] == 'G' && text[1] == 'P'));
    const int number = named ? std::stoi(text.substr(2)) : -1;
    if (number < 0 || number > (text[0] == 'G' ? 31 : 15)) {
        throw std::runtime_error{"no such pin: " + text};
    }
    return {text[1], static_cast<unsigned>(number)};
}

GoldenSender::GoldenSender(ChipUnderTest& chip, GoldenJob job) : chip_{chip}, job_{std::move(job)}
{
    may_hold_ =
        !job_.script.empty() || std::any_of(job_.lines.begin(), job_.lines.end(), has_pause);
}

int GoldenSender::run()
{
    chip_.line().set_receiver([this](char byte) { hear(byte); });
    // To a place where the main loop has nothing left to do, with half a tick still to go.
    chip_.set_tick_listener([this] { silent_since_ = 1; });
    chip_.run(5 * kMillisecond, [this] { return std::exchange(silent_since_, 0) == 1; });
    silent_since_ = 0;
    chip_.core().set_instruction_time(kNoTime);
    chip_.line().set_instant(true);
    chip_.set_flash_times(0, 0);
    for (const auto& port : chip_.ports()) {
        port.second->forget_changes();
    }
    start_ = chip_.circuit().now;
    chip_.set_tick_listener([this] { on_tick(); });
    while (!job_.script.empty() && job_.script.front().first == 0) {
        chip_.line().send({job_.script.front().second});
        job_.script.pop_front();
    }
    begin_line();
    chip_.limit_instructions(kMostInstructions);
    while (!done_) {
        const std::uint64_t before = tick_;
        chip_.run(100 * kMillisecond, [this] { return on_settled(); });
        const bool stands_still = chip_.exhausted() || (!done_ && tick_ == before);
        if (stands_still || tick_ > job_.most_ticks || !chip_.powered() ||
            chip_.core().locked_up()) {
            const char* const why = chip_.exhausted()          ? "the core goes round in circles"
                                    : stands_still             ? "no servo tick comes"
                                    : !chip_.powered()         ? "the power is off"
                                    : chip_.core().locked_up() ? "the core is locked up"
                                                               : "it lasts too long";
            throw std::runtime_error{"the program does not come to its end: " + std::string{why} +
                                     ", line " + std::to_string(next_line_) + ", tick " +
                                     std::to_string(tick_) + ", heard: " + heard_};
        }
    }
    // The lines in flight.
    chip_.set_tick_listener({});
    chip_.run(4 * kMillisecond);
    chip_.limit_instructions(std::numeric_limits<std::uint64_t>::max() / 2);
    collect();
    return refused_ ? 1 : 0;
}

// Before the firmware hears of the tick: what comes now is read in the slices after it.
void GoldenSender::on_tick()
{
    if (first_boundary_ < 0) {
        first_boundary_ = chip_.circuit().now;
    }
    ++tick_;
    chip_.limit_instructions(kMostInstructions);
    asked_ = false;
    resumed_ = false;
    may_begin_line_ = true;
    while (!refused_ && !job_.script.empty() && job_.script.front().first <= tick_) {
        chip_.line().send({job_.script.front().second});
        job_.script.pop_front();
    }
    if (!waiting_) {
        begin_line();
    }
}

void GoldenSender::begin_line()
{
    if (waiting_ || refused_ || ended_ || !may_begin_line_ || next_line_ >= job_.lines.size()) {
        return;
    }
    waiting_ = true;
    chip_.line().send(job_.lines[next_line_] + "\n");
    ++next_line_;
}

void GoldenSender::hear(char byte)
{
    if (byte == '\n') {
        take(heard_);
        heard_.clear();
    } else if (byte != '\r') {
        heard_.push_back(byte);
    }
}

void GoldenSender::take(const std::string& answer)
{
    const bool error = starts_with(answer, "error:");
    if (starts_with(answer, "ALARM:") || starts_with(answer, "Grbl ") || error) {
        refused_ = true;
    }
    ended_ = ended_ || answer == "[MSG:Pgm End]";
    if (answer == "ok" || error) {
        waiting_ = false;
        chip_.limit_instructions(kMostInstructions);
        begin_line();
    }
    if (starts_with(answer, "<Hold:0") && job_.script.empty() && !refused_ && !resumed_) {
        resumed_ = true;
        may_begin_line_ = false;
        chip_.line().send("~");
    } else if (starts_with(answer, "<Idle") && finished() && !refused_) {
        done_ = true;
    }
}

// Since the last call. Other pins of the lines' ports change, too.
bool GoldenSender::lines_changed()
{
    bool changed = false;
    std::map<char, unsigned> lines;
    for (const PinName& pin : job_.pins) {
        lines[pin.port] |= 1U << pin.number;
    }
    for (const auto& [letter, mask] : lines) {
        const std::vector<PinChange>& changes = chip_.port(letter).changes();
        Seen& seen = seen_[letter];
        for (; seen.count < changes.size(); ++seen.count) {
            const unsigned high = changes[seen.count].high & mask;
            changed = changed || high != seen.high;
            seen.high = high;
        }
    }
    return changed;
}

// The main loop has nothing left to do in this tick.
bool GoldenSender::on_settled()
{
    if (refused_) {
        if (lines_changed()) {
            silent_since_ = tick_;
        }
        done_ = done_ || tick_ - silent_since_ > kSilence;
        return done_;
    }
    // Asleep amid a line or an answer: there is more to do in this tick, and it may begin a hold.
    if (!chip_.line().quiet()) {
        return done_;
    }
    if (!asked_ && (may_hold_ || finished())) {
        asked_ = true;
        chip_.line().send("?");
    }
    return done_;
}

void GoldenSender::collect()
{
    struct Change {
        Picoseconds time;
        char port;
        std::uint32_t high;
    };
    std::vector<Change> changes;
    for (const auto& [letter, port] : chip_.ports()) {
        for (const PinChange& change : port->changes()) {
            changes.push_back({change.time, letter, change.high});
        }
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& a, const Change& b) { return a.time < b.time; });
    unsigned levels = 0;
    bool pending = false;  // a change whose other ports are still to come
    for (std::size_t i = 0; i < changes.size(); ++i) {
        unsigned after = levels;
        for (unsigned line = 0; line < job_.pins.size(); ++line) {
            if (job_.pins[line].port == changes[i].port) {
                const unsigned high = changes[i].high >> job_.pins[line].number & 1U;
                after = (after & ~(1U << line)) | (high ^ (job_.inverted >> line & 1U)) << line;
            }
        }
        const bool more_at_once = i + 1 < changes.size() && changes[i + 1].time == changes[i].time;
        const bool changed = std::exchange(levels, after) != after || pending;
        pending = changed && more_at_once;
        // Changes before the start give the initial levels of the pins.
        if (!changed || more_at_once || changes[i].time < start_) {
            continue;
        }
        const Picoseconds since = changes[i].time - first_boundary_ - chip_.frame_delay();
        if (since % kMicrosecond != 0) {
            chip_.circuit().violate("an edge is " + std::to_string(since % kMicrosecond) +
                                    " ps off its microsecond");
        }
        const std::int64_t tick = since / kMicrosecond;
        edges_.push_back(static_cast<std::uint64_t>(tick) << 8U | levels);
    }
}

}  // namespace cusp::cosim
