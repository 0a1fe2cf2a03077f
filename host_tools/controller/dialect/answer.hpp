// Answers of a controller: status reports, errors, alarms, messages, one line each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "firmware/base/vec.hpp"

namespace cusp::dialect {

// A status report `<State[:sub]|MPos:...|...>`. Missing fields have no value.
struct ControllerStatus {
    std::string state;  // "Idle", "Run", "Hold", "Jog", "Alarm", "Door", "Check", "Home", "Sleep"
    int substate{-1};
    // As reported: mm, or inches with $13=1, and degrees of A; 0 where the machine has none.
    std::optional<AxisVecd> machine_position;
    std::optional<AxisVecd> work_position;
    std::optional<AxisVecd> work_offset;
    std::optional<std::uint32_t> line;
    std::optional<double> feed;
    std::optional<int> feed_override;  // per cent
    std::optional<int> free_blocks;    // of the planner
};

enum class AnswerKind : std::uint8_t {
    kOk,
    kError,    // code
    kAlarm,    // code
    kStatus,   // status
    kBanner,   // the controller has started
    kMessage,  // text between [ and ]
    kOther,
};

// One line from the controller.
struct Answer {
    AnswerKind kind{AnswerKind::kOther};
    int code{0};
    ControllerStatus status;
    std::string text;
};

//   line  without its end
Answer parse_answer(std::string_view line);

constexpr std::string_view kUnknownCode = "unknown";

// The text of an error or alarm code; kUnknownCode for other codes.
std::string_view error_text(int code);
std::string_view alarm_text(int code);

}  // namespace cusp::dialect
