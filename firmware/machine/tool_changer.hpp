// ToolChanger: takes the spindle to where its tool is changed, and touches the new tool off.
//
// Up; over G59.3; the operator changes the tool; down onto the tool setter, fast, then slowly; up;
// back over the part; down until the tip is where it was. $341 chooses how much of this is done.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/machine/machine_state.hpp"
#include "firmware/machine/motion.hpp"

namespace cusp::machine {

// $341, grblHAL's numbers.
enum class ToolChangeMode : std::uint8_t {
    kPause,     // a pause at the present position
    kAtTop,     // changed at the top of Z
    kAtPlace,   // changed at G59.3
    kTouchOff,  // changed over G59.3, touched off there
    kIgnore,
};

ToolChangeMode tool_change_mode(const Settings& settings) noexcept;

// The axes that must be homed.
AxisMask axes_to_home(ToolChangeMode mode) noexcept;

// Context: main loop.
class ToolChanger {
public:
    struct Change {
        ToolChangeMode mode{ToolChangeMode::kAtTop};  // kAtTop, kAtPlace or kTouchOff
        Position place;                   // G59.3: where the tool is changed, or the search begins
        std::int64_t offset_nm{0};        // tool length offset in force
        std::int64_t first_length_nm{0};  // of the new tool, if it is the first that is touched off
        std::uint32_t line{0};            // for reports
    };

    // Precondition: motion.settled(), the axes of axes_to_home() are homed.
    void begin(const Change& change, const Motion& motion) noexcept;

    enum class Progress : std::uint8_t {
        kWaiting,
        kStepped,
        kAtChange,  // the tool can be changed: call step() once it is
        kMeasured,  // length_nm() is known
        kOverPart,  // spindle and coolant may start; rest() until they have
        kFinished,
        kFailed,
    };

    // Performs the next step, if its conditions hold.
    Progress step(Motion& motion, const Settings& settings) noexcept;

    void rest(std::uint32_t until_tick) noexcept
    {
        resting_ = true;
        rest_until_ = until_tick;
    }

    // The new tool against the first that was touched off: positive where it is longer.
    std::int64_t length_nm() const noexcept { return length_nm_; }
    // Why it failed: kProbeInitial, kProbeContact, or kSoftLimit where a place is beyond the travel.
    Alarm alarm() const noexcept { return alarm_; }

    // The next tool that is touched off is the first.
    void forget_reference() noexcept { reference_z_.reset(); }

private:
    // In the order of a change.
    enum class Phase : std::uint8_t {
        kLift,
        kToPlace,
        kLower,
        kChange,
        kApproach,
        kSeek,
        kBackOff,
        kLocate,
        kLiftAgain,
        kBack,
        kOverPart,
        kDescend,
        kDone,
    };

    bool leaves_out(Phase phase) const noexcept;
    void next_phase() noexcept;
    Progress start_phase(Motion& motion, const Settings& settings) noexcept;
    Progress finish_phase(Motion& motion, const Settings& settings) noexcept;
    Progress travel(Motion& motion, Position to) noexcept;
    Progress probe(Motion& motion, const Settings& settings) noexcept;
    Progress measure(std::int64_t contact_z, const Settings& settings) noexcept;
    void push(Motion& motion, Position to, path::MoveKind kind, float mm_per_minute) const noexcept;
    Progress stepped(Progress progress) noexcept;
    Progress fail(Alarm alarm) noexcept;

    Change change_;
    Position back_{};                          // where the tip was, for the length in force
    std::optional<std::int64_t> reference_z_;  // where a tool of length 0 touches
    std::int64_t contact_z_{0};                // of the fast search
    std::int64_t length_nm_{0};
    Phase phase_{Phase::kDone};
    bool moving_{false};
    bool resting_{false};
    std::uint32_t rest_until_{0};
    Alarm alarm_{Alarm::kNone};
};

}  // namespace cusp::machine
