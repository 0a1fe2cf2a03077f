// Reads a program once and chooses where its parts begin.
#include "host_tools/controller/simulate/program_parts.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "firmware/gcode/interpreter.hpp"
#include "firmware/path/move.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"

namespace cusp::simulate {

using gcode::ModalState;
using gcode::Motion;

namespace {

// A part without a lift begins at any line after so many times the least, and is counted so long
// after, s.
constexpr double kLongest = 1.3;
constexpr double kRunUp = 3;
constexpr double kRapidSpeed = 50;  // mm/s; only to balance the parts

constexpr double kNanometresPerMillimetre = 1e6;

// Place and modal state before a line.
struct Before {
    std::size_t offset;
    std::uint32_t line;
    ModalState modal;
    Position at;
    bool has_offset;  // program and machine coordinates differ
};

bool has_motion_word(std::string_view words)
{
    return words.size() > 2 && words[0] == 'G' && words[1] >= '0' && words[1] <= '3' &&
           (words[2] < '0' || words[2] > '9') && words[2] != '.';
}

// True if head_of() restores the state.
bool can_begin(const Before& before, std::string_view words)
{
    const ModalState& modal = before.modal;
    const bool plain = !modal.incremental && !modal.inverse_time && !modal.return_to_clearance &&
                       !modal.absolute_centres && !before.has_offset;
    const bool keeps_motion = modal.motion == Motion::kRapid || modal.motion == Motion::kLine;
    const bool in_curve = modal.motion == Motion::kUniformNurbs || modal.motion == Motion::kNurbs;
    return plain && !in_curve && (keeps_motion || has_motion_word(words));
}

std::string path_word(const ModalState& modal)
{
    if (modal.exact_path) {
        return "G61";
    }
    return modal.default_tolerance ? "G64" : fmt::format("G64 P{:.9g}", modal.path_tolerance);
}

std::string_view plane_word(path::Plane plane)
{
    switch (plane) {
        case path::Plane::kZX:
            return "G18";
        case path::Plane::kYZ:
            return "G19";
        case path::Plane::kXY:
            break;
    }
    return "G17";
}

std::string head_of(const Before& before)
{
    const ModalState& modal = before.modal;
    const auto mm = [](std::int64_t nm) {
        return fmt::format("{:.6f}", static_cast<double>(nm) / kNanometresPerMillimetre);
    };
    std::string head =
        fmt::format("G21 G90 G94 {} {}\n", gcode::kCoordinateSystemNames[modal.coordinate_system],
                    path_word(modal));
    head += fmt::format("G0 X{} Y{} Z{}\n", mm(before.at.x), mm(before.at.y), mm(before.at.z));
    head += fmt::format("T{} S{:.9g}\n", unsigned{modal.tool}, modal.spindle_speed);
    if (modal.spindle != gcode::SpindleMode::kOff) {
        head += modal.spindle == gcode::SpindleMode::kClockwise ? "M3\n" : "M4\n";
    }
    head += modal.flood ? "M8\n" : "";
    head += modal.mist ? "M7\n" : "";
    head += modal.motion == Motion::kRapid ? "G0" : "G1";
    head += modal.feed > 0 ? fmt::format(" F{:.9g}\n", modal.feed) : "\n";
    head += fmt::format("{} {}\n", plane_word(modal.plane), modal.inches ? "G20" : "G21");
    return head;
}

// The effect of a line, as far as the choice of parts depends on it.
struct LineSummary {
    double seconds{0};
    bool moves{false};
    bool lifts{false};  // begins with a rapid move straight up
};

void add_move(const path::Move& move, LineSummary& summary)
{
    if (move.start == move.end && !std::holds_alternative<path::Arc>(move.path)) {
        return;
    }
    const bool rapid = move.kind == path::MoveKind::kRapid;
    if (!summary.moves) {
        summary.lifts = rapid && move.start.x == move.end.x && move.start.y == move.end.y &&
                        move.end.z > move.start.z;
    }
    summary.moves = true;
    const double chord = norm(to_millimetres(move.end - move.start));
    const double way = std::holds_alternative<path::Arc>(move.path) ? path::length(move) : chord;
    summary.seconds += way / (rapid ? kRapidSpeed : static_cast<double>(move.feed));
}

class PartFinder {
public:
    PartFinder(std::string_view program, double least) : program_{program}, least_{least} {}

    std::vector<ProgramPart> found()
    {
        parts_.emplace_back();
        std::uint32_t line = 0;
        for (std::size_t begin = 0; begin < program_.size() && !over_;) {
            const std::size_t end = std::min(program_.find('\n', begin), program_.size());
            const std::string words = dialect::bare_line(program_.substr(begin, end - begin));
            ++line;
            if (!words.empty()) {
                read(words,
                     {begin, line, interpreter_.modal(), interpreter_.position(), has_offset()});
            }
            begin = end + 1;
        }
        return std::move(parts_);
    }

private:
    void read(const std::string& words, const Before& before)
    {
        LineSummary summary;
        if (words.front() == '$' || !execute(words, before.line, summary)) {
            over_ = true;
            return;
        }
        ProgramPart& last = parts_.back();
        if (start_) {
            waited_ += summary.seconds;
            if (summary.moves && (start_lifts_ ? start_->line != before.line : waited_ > kRunUp)) {
                begin_part(before.line);
            }
        } else if ((summary.lifts && last.seconds > least_) || last.seconds > kLongest * least_) {
            if (can_begin(before, words)) {
                start_ = before;
                start_lifts_ = summary.lifts;
                waited_ = summary.seconds;
            }
        }
        parts_.back().seconds += summary.seconds;
    }

    void begin_part(std::uint32_t line)
    {
        parts_.back().end_counted = line;
        ProgramPart part;
        part.head = head_of(*start_);
        part.head_lines =
            static_cast<std::uint32_t>(std::count(part.head.begin(), part.head.end(), '\n'));
        part.begin = start_->offset;
        part.first_line = start_->line;
        part.first_counted = line;
        parts_.push_back(std::move(part));
        start_.reset();
    }

    // False where no part may begin from here on.
    bool execute(const std::string& words, std::uint32_t line, LineSummary& summary)
    {
        if (!interpreter_.execute(words, line)) {
            return false;
        }
        gcode::Action action;
        while (interpreter_.next(action)) {
            if (const auto* move = std::get_if<path::Move>(&action)) {
                add_move(*move, summary);
            } else if (std::holds_alternative<gcode::Probe>(action) ||
                       std::holds_alternative<gcode::ProgramEnd>(action)) {
                return false;
            } else if (const auto* dwell = std::get_if<gcode::Dwell>(&action)) {
                summary.seconds += dwell->seconds;
            } else if (const auto* changed = std::get_if<gcode::ParametersChanged>(&action)) {
                if (changed->keep) {
                    return false;
                }
            }
        }
        return true;
    }

    bool has_offset() const
    {
        return gcode::work_offset(interpreter_.modal(), interpreter_.parameters()) != Position{};
    }

    std::string_view program_;
    double least_;
    gcode::Interpreter interpreter_;
    std::vector<ProgramPart> parts_;
    std::optional<Before> start_;  // of the next part
    bool start_lifts_{false};
    double waited_{0};
    bool over_{false};  // no part may begin any more
};

}  // namespace

std::vector<ProgramPart> program_parts(std::string_view program, double least)
{
    return PartFinder{program, least}.found();
}

dialect::LineSource part_source(std::string name, std::string_view program, const ProgramPart& part)
{
    const std::string_view rest = program.substr(part.begin);
    const auto taken = std::make_shared<std::size_t>(0);
    const std::string_view head = part.head;
    return {std::move(name),
            [head, rest, taken](char* place, std::size_t room) {
                const bool in_head = *taken < head.size();
                const std::string_view left =
                    in_head ? head.substr(*taken) : rest.substr(*taken - head.size());
                const std::size_t count = std::min(room, left.size());
                std::memcpy(place, left.data(), count);
                *taken += count;
                return count;
            },
            head.size() + rest.size()};
}

}  // namespace cusp::simulate
