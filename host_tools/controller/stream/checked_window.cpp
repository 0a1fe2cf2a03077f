// Resends from the first missing line.
#include "host_tools/controller/stream/checked_window.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

#include "firmware/protocol/crc32.hpp"

namespace cusp::stream {
namespace {

using std::chrono::milliseconds;

// Longer than the delay of answers to sent lines.
constexpr milliseconds kDry{40};
// Shorter than the silence after which the controller stops checking.
constexpr milliseconds kMostPatience{1600};
constexpr std::size_t kDigits = 8;

std::uint32_t crc_of(std::string_view text)
{
    protocol::Crc32 crc;
    for (const char character : text) {
        crc.add(static_cast<std::uint8_t>(character));
    }
    return crc.value();
}

// The number behind `word` at the end of the text.
std::optional<std::uint32_t> number_after(std::string_view text, std::string_view word)
{
    const std::size_t at = text.rfind(word);
    std::uint32_t number = 0;
    if (at == std::string_view::npos) {
        return std::nullopt;
    }
    const char* first = text.data() + at + word.size();
    const char* last = text.data() + text.size();
    const auto [end, failed] = std::from_chars(first, last, number);
    return failed == std::errc{} && end == last ? std::optional{number} : std::nullopt;
}

}  // namespace

std::string checked_line(std::uint32_t number, std::string_view text)
{
    const std::string counted = fmt::format("N{}{}", number, text);
    return fmt::format("{}*{:08X}", counted, crc_of(counted));
}

std::optional<std::string> checked_answer(std::string_view line)
{
    const std::size_t star = line.rfind('*');
    if (star == std::string_view::npos || line.size() != star + 1 + kDigits) {
        return std::nullopt;
    }
    std::uint32_t given = 0;
    const char* last = line.data() + line.size();
    const auto [end, failed] = std::from_chars(line.data() + star + 1, last, given, 16);
    if (failed != std::errc{} || end != last || given != crc_of(line.substr(0, star))) {
        return std::nullopt;
    }
    return std::string{line.substr(0, star)};
}

std::optional<std::uint32_t> refused_number(std::string_view line)
{
    const auto answer = checked_answer(line);
    return answer && answer->rfind("resend", 0) == 0 ? number_after(*answer, " N") : std::nullopt;
}

void CheckedWindow::add(std::uint64_t program_line, std::string_view text)
{
    lines_.push_back({next_number_, program_line, checked_line(next_number_, text) + "\n"});
    ++next_number_;
}

// True if lines are sent but no further answer to them is due.
bool CheckedWindow::wants_to_ask(Clock::time_point now) const
{
    return sent_ > 0 && !draining_ && (under_way_ == 0 || now - quiet_since_ >= patience_);
}

std::optional<std::string> CheckedWindow::next(Clock::time_point now)
{
    if (draining_ && (under_way_ == 0 || now - quiet_since_ >= kDry)) {
        draining_ = false;
        rewind(now);
    }
    if (wants_to_ask(now)) {
        patience_ = std::min(2 * patience_, kMostPatience);
        quiet_since_ = now;
        ++under_way_;
        return "\n";
    }
    if (draining_ || sent_ == lines_.size()) {
        return std::nullopt;
    }
    const std::string& wire = lines_[sent_].wire;
    if (sent_ > 0 && sent_bytes_ + wire.size() > room_) {
        return std::nullopt;
    }
    if (sent_ == 0) {
        quiet_since_ = now;
    }
    ++sent_;
    ++under_way_;
    sent_bytes_ += wire.size();
    return wire;
}

void CheckedWindow::rewind(Clock::time_point now)
{
    resent_ += sent_;
    sent_ = 0;
    sent_bytes_ = 0;
    under_way_ = 0;
    quiet_since_ = now;
}

CheckedWindow::Verdict CheckedWindow::finish_before(std::uint32_t number)
{
    Verdict verdict;
    while (!lines_.empty() && lines_.front().number < number) {
        ++verdict.done_lines;
        verdict.program_line = lines_.front().program_line;
        done_ = lines_.front().number;
        program_lines_.push_back(verdict.program_line);
        if (sent_ > 0) {
            --sent_;
            sent_bytes_ -= lines_.front().wire.size();
        }
        lines_.pop_front();
    }
    while (program_lines_.size() > kMostRemembered) {
        program_lines_.pop_front();
    }
    return verdict;
}

std::optional<CheckedWindow::Verdict> CheckedWindow::take(std::string_view line,
                                                          Clock::time_point now)
{
    const auto answer = checked_answer(line);
    if (!answer) {
        count_damaged(line);
        return std::nullopt;
    }
    const auto number = number_after(*answer, " N");
    // A number that was never sent is not an answer to this sender.
    if (!number || *number == 0 || *number > next_number_) {
        return std::nullopt;
    }
    quiet_since_ = now;
    patience_ = kFirstPatience;
    plain_answers_ = 0;
    under_way_ -= under_way_ > 0 ? 1U : 0U;
    if (answer->rfind("resend", 0) == 0) {
        const Verdict verdict = finish_before(*number);
        if (sent_ > 0 && !draining_) {
            draining_ = true;
            room_ /= 2;
        }
        return verdict;
    }
    constexpr std::size_t kGrowth = 16;
    room_ = std::min(capacity_, room_ + kGrowth);
    Verdict verdict = finish_before(*number + 1);
    if (answer->rfind("error:", 0) == 0) {
        std::from_chars(answer->data() + 6, answer->data() + answer->size(), verdict.error);
    }
    return verdict;
}

// Neither a report nor a message, so it must be a damaged answer.
void CheckedWindow::count_damaged(std::string_view line)
{
    if (line.empty() || line.front() == '<' || line.front() == '[') {
        return;
    }
    under_way_ -= under_way_ > 0 ? 1U : 0U;
    const std::string_view code =
        line.substr(0, 6) == "error:" ? line.substr(6) : std::string_view{};
    const bool plain = line == "ok" || (!code.empty() && code.size() <= 2);
    plain_answers_ = plain ? plain_answers_ + 1 : 0;
}

std::uint64_t CheckedWindow::program_line_of(std::uint32_t number) const
{
    if (number > done_) {
        for (const Line& line : lines_) {
            if (line.number == number) {
                return line.program_line;
            }
        }
        return 0;
    }
    const std::uint32_t back = done_ - number;
    return back < program_lines_.size() ? program_lines_[program_lines_.size() - 1 - back] : 0;
}

}  // namespace cusp::stream
