// Nothing moves before consent.
#include "host_tools/controller/stream/resume_dialogue.hpp"

#include <utility>

#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::stream {

namespace {

// The record of the interrupted transfer, or one for the given line.
TransferRecord record_to_resume(const std::string& program, std::uint64_t line)
{
    const auto kept = read_record(program);
    if (!kept && line == 0) {
        throw InputError{fmt::format(
            "{}: no interrupted transfer is recorded in {}; name the line: --resume-line N",
            program, record_file(program))};
    }
    TransferRecord record = kept.value_or(TransferRecord{});
    if (line != 0) {
        record.executed_line = line;
        record.checked_line = 0;
    }
    return record;
}

}  // namespace

ResumeDialogue::ResumeDialogue(std::string program,
                               std::uint64_t line,
                               std::optional<double> safe_z,
                               Consent consent)
    : program_{std::move(program)},
      safe_z_{safe_z},
      consent_{std::move(consent)},
      record_{record_to_resume(program_, line)},
      point_{find_resume_point(program_, record_)}
{
}

StreamResume ResumeDialogue::resume() const
{
    return {record_, point_.line,
            [this](const ControllerFacts& facts, Position machine, bool homes, bool lost) {
                return consent_(text_of(approach(facts, machine), homes, lost), lost);
            },
            [this](const ControllerFacts& facts, Position machine) {
                return approach(facts, machine).lines;
            }};
}

Approach ResumeDialogue::approach(const ControllerFacts& facts, Position machine) const
{
    return make_approach(point_, record_.start.parameters, facts.parameters(), machine, safe_z_);
}

std::string ResumeDialogue::text_of(const Approach& way, bool homes, bool lost) const
{
    std::string text = fmt::format("{}:{} was executing; resuming at line {}\n", program_,
                                   record_.executed_line, point_.line);
    if (homes) {
        text += "  homes the machine ($H)\n";
    }
    if (point_.modal.tool != 0) {
        text += fmt::format("  tool T{} must be in the spindle\n", point_.modal.tool);
    }
    text += fmt::format("  travels at Z {:.3f} to X {:.3f} Y {:.3f}", way.safe_z, way.point.x,
                        way.point.y);
    if (point_.axes > kLinearAxes) {
        text += fmt::format(" A {:.3f}", way.point[kLinearAxes]);
    }
    if (point_.modal.spindle != gcode::SpindleMode::kOff) {
        text += fmt::format(", spindle at {:.0f}", point_.modal.spindle_speed);
    }
    if (way.plunges) {
        text +=
            fmt::format(", goes down to Z {:.3f} at {:.0f} mm/min", way.point.z, way.plunge_feed);
    }
    text += "\n";
    if (lost) {
        text +=
            "  the controller reports 0,0,0: it was probably restarted and has lost the position "
            "of the tool\n";
    }
    return text;
}

}  // namespace cusp::stream
