// The state kept from line to line: the modal state, and the offsets that turn program coordinates
// into machine coordinates. Plain data; `$G` and `$#` read it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/base/vec.hpp"
#include "firmware/gcode/tool_table.hpp"
#include "firmware/path/path.hpp"

namespace cusp::gcode {

// Modal group 1, G80 included.
enum class Motion : std::uint8_t {
    kRapid,                // G0
    kLine,                 // G1
    kArcClockwise,         // G2
    kArcCounterClockwise,  // G3
    kUniformNurbs,         // G5.2, until its G5.3
    kNurbs,                // G6.2, until its last closing knot
    kProbeTowards,         // G38.2, an alarm where nothing is found
    kProbeTowardsQuietly,  // G38.3
    kProbeAway,            // G38.4, an alarm where contact is not lost
    kProbeAwayQuietly,     // G38.5
    kNone,                 // G80: axis words have no meaning
    kDrill,                // G81
    kDrillWithDwell,       // G82
    kDrillPecking,         // G83
    kDrillChipBreaking,    // G73
    kBore,                 // G85: out at the feed
    kBoreStopping,         // G86: out with the spindle at rest
    kBoreWithDwell,        // G89
};

constexpr bool is_arc(Motion motion) noexcept
{
    return motion == Motion::kArcClockwise || motion == Motion::kArcCounterClockwise;
}

// G73, G81 to G83, G85, G86 and G89.
constexpr bool is_cycle(Motion motion) noexcept { return motion >= Motion::kDrill; }

// True for a cycle with a P word, the dwell at the bottom.
constexpr bool dwells(Motion motion) noexcept
{
    return motion == Motion::kDrillWithDwell || motion == Motion::kBoreStopping ||
           motion == Motion::kBoreWithDwell;
}

// True for a cycle with a Q word, the depth of a peck.
constexpr bool pecks(Motion motion) noexcept
{
    return motion == Motion::kDrillPecking || motion == Motion::kDrillChipBreaking;
}

enum class SpindleMode : std::uint8_t { kOff, kClockwise, kCounterClockwise };  // M5 M3 M4

// The word of a line; M7 and M8 leave the other on.
enum class Coolant : std::uint8_t { kOff, kMist, kFlood };  // M9 M7 M8

struct ModalState {
    Motion motion{Motion::kRapid};
    path::Plane plane{path::Plane::kXY};
    bool inches{false};               // G20
    bool incremental{false};          // G91
    bool inverse_time{false};         // G93
    bool absolute_centres{false};     // G90.1: I J K are coordinates
    bool return_to_clearance{false};  // G99: cycles return to R, not to the height before the first
    bool exact_path{false};           // G61
    bool default_tolerance{true};     // G64 alone: the tolerance of $11
    std::uint8_t coordinate_system{0};  // 0 is G54, 8 is G59.3
    SpindleMode spindle{SpindleMode::kOff};
    bool flood{false};           // M8
    bool mist{false};            // M7
    std::uint8_t tool{0};        // T
    std::uint8_t in_spindle{0};  // T of the last M6
    float path_tolerance{0};     // mm, of G64 P; meaningful where neither flag above is set
    float feed{0};               // mm/min; 1/min with G93; 0 where none was given yet
    float spindle_speed{0};      // rpm
};

inline constexpr unsigned kCoordinateSystems = 9;
inline constexpr std::array<std::string_view, kCoordinateSystems> kCoordinateSystemNames{
    "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"};

// Offsets and stored positions; machine nanometres. The machine keeps all but G92 and the tool length
// offset through a power cycle; a reset clears those two.
struct Parameters {
    static constexpr std::size_t kPositions = kCoordinateSystems + 3;  // they come first

    std::array<Position, kCoordinateSystems> work_offsets{};  // G54 to G59.3
    Position home{};                                          // G28
    Position second_home{};                                   // G30
    Position coordinate_offset{};                             // G92, G52
    std::int64_t tool_length_offset_nm{0};                    // G43, G43.1, along Z
    ToolTable tools;                                          // G10 L1
};

// Machine minus program coordinates: what `WCO:` reports.
constexpr Position work_offset(const ModalState& modal, const Parameters& parameters) noexcept
{
    Position sum = parameters.work_offsets[modal.coordinate_system] + parameters.coordinate_offset;
    sum.z += parameters.tool_length_offset_nm;
    return sum;
}

}  // namespace cusp::gcode
