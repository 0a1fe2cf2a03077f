// Lines of the approach. Lengths are millimetres with six decimals: exact.
#include "host_tools/controller/stream/approach.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>

namespace cusp::stream {
namespace {

using gcode::ModalState;
using gcode::Motion;

// The plunge feed if the program never moved straight down.
constexpr float kPlungeFeed = 100.0F;  // mm/min

std::string words_of(std::int64_t nanometres)
{
    constexpr std::int64_t kMillimetre = 1'000'000;
    const std::int64_t size = std::llabs(nanometres);
    return fmt::format("{}{}.{:06}", nanometres < 0 ? "-" : "", size / kMillimetre,
                       size % kMillimetre);
}

// The word of A; nothing where the machine has none.
std::string turn(Position at, unsigned axes)
{
    return axes > kLinearAxes ? "A" + words_of(at[kLinearAxes]) : "";
}

std::string place(Position at, unsigned axes)
{
    return fmt::format("X{}Y{}Z{}{}", words_of(at.x), words_of(at.y), words_of(at.z),
                       turn(at, axes));
}

void restore_offsets(const ResumePoint& point,
                     const gcode::Parameters& before,
                     std::vector<std::string>& lines)
{
    lines.push_back("G92.1");
    lines.push_back("G49");
    for (std::size_t i = 0; i < gcode::kCoordinateSystems; ++i) {
        const Position wanted = point.parameters.work_offsets[i];
        if (wanted != before.work_offsets[i]) {
            lines.push_back(fmt::format("G10L2P{}{}", i + 1, place(wanted, point.axes)));
        }
    }
    if (point.parameters.tool_length_offset_nm != 0) {
        lines.push_back("G43.1Z" + words_of(point.parameters.tool_length_offset_nm));
    }
}

void restore_accessories(const ModalState& modal, std::vector<std::string>& lines)
{
    if (modal.tool != 0) {
        lines.push_back(fmt::format("T{}", modal.tool));
    }
    lines.push_back(fmt::format("S{:.3f}", static_cast<double>(modal.spindle_speed)));
    if (modal.spindle != gcode::SpindleMode::kOff) {
        lines.push_back(modal.spindle == gcode::SpindleMode::kClockwise ? "M3" : "M4");
        lines.push_back("G4P3");  // spindle start-up time
    }
    if (modal.mist) {
        lines.push_back("M7");
    }
    if (modal.flood) {
        lines.push_back("M8");
    }
}

// The modal state for the program's own lines; in millimetres up to the last of them.
void restore_modal(const ModalState& modal, std::vector<std::string>& lines)
{
    if (modal.feed > 0 && !modal.inverse_time) {
        lines.push_back(fmt::format("F{:.4f}", static_cast<double>(modal.feed)));
    }
    // A reset controller has the defaults; a stock Grbl may not know these words.
    if (modal.exact_path) {
        lines.push_back("G61");
    } else if (!modal.default_tolerance) {
        lines.push_back(fmt::format("G64P{:.6f}", static_cast<double>(modal.path_tolerance)));
    }
    const bool rapid = modal.motion == Motion::kRapid;
    const bool none = modal.motion == Motion::kNone;
    lines.push_back(rapid ? "G0" : none ? "G80" : "G1");
    constexpr std::array<std::string_view, 3> kPlanes{"G17", "G18", "G19"};
    lines.emplace_back(kPlanes[static_cast<std::size_t>(modal.plane)]);
    if (modal.return_to_clearance) {
        lines.push_back("G99");
    }
    if (modal.absolute_centres) {
        lines.push_back("G90.1");
    }
    lines.push_back(modal.inverse_time ? "G93" : "G94");
    lines.push_back(modal.incremental ? "G91" : "G90");
    lines.push_back(modal.inches ? "G20" : "G21");
}

}  // namespace

Approach make_approach(const ResumePoint& point,
                       const gcode::Parameters& before,
                       const gcode::Parameters& now,
                       Position machine,
                       std::optional<double> safe_z)
{
    const std::size_t system = point.modal.coordinate_system;
    const Position shift = point.parameters.coordinate_offset;
    const std::int64_t length = point.parameters.tool_length_offset_nm;
    // Coordinates without G92, used until the point is reached.
    const Position was = point.parameters.work_offsets[system] + Position{0, 0, length};
    const bool changed = point.parameters.work_offsets[system] != before.work_offsets[system];
    const Position is = changed ? was : now.work_offsets[system] + Position{0, 0, length};
    const Position goal = point.position - was;
    const std::int64_t tool_z = machine.z - is.z;
    const std::int64_t wanted_z =
        safe_z ? to_nanometres(*safe_z) + shift.z : point.highest_z_nm - was.z;
    const std::int64_t travel_z = std::max({wanted_z, tool_z, goal.z});

    Approach approach;
    approach.lines = {"G21", "G90", "G94", "G17", "G40", "G80"};
    approach.lines.emplace_back(gcode::kCoordinateSystemNames[system]);
    restore_offsets(point, before, approach.lines);
    approach.lines.push_back("G0Z" + words_of(travel_z));
    approach.lines.push_back("G0X" + words_of(goal.x) + "Y" + words_of(goal.y) +
                             turn(goal, point.axes));
    // Rapid down to the program's own travel height; at the plunge feed from there.
    const std::int64_t down_z = std::max(wanted_z, goal.z);
    if (down_z < travel_z) {
        approach.lines.push_back("G0Z" + words_of(down_z));
    }
    restore_accessories(point.modal, approach.lines);
    if (shift != Position{}) {
        Position above = goal;
        above.z = down_z;
        approach.lines.push_back("G92" + place(above - shift, point.axes));
    }
    approach.plunges = down_z > goal.z;
    approach.plunge_feed = static_cast<double>(point.plunge_feed.value_or(kPlungeFeed));
    if (approach.plunges) {
        approach.lines.push_back(
            fmt::format("G1Z{}F{:.4f}", words_of(goal.z - shift.z), approach.plunge_feed));
    }
    restore_modal(point.modal, approach.lines);
    approach.point = to_millimetres(goal - shift);
    approach.safe_z = xyz(to_millimetres(Position{0, 0, travel_z - shift.z})).z;
    return approach;
}

}  // namespace cusp::stream
