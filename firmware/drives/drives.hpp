// Drives: sets the motors' drives before anything moves, each as its kind asks for, and watches them from then on.
//
//   drives.configure(registers, motors);
//   if (const auto request = drives.next(tick)) { send it; }          // main loop, again and again
//   drives.take(answer, tick);                                        // once it came, or did not
//   drives.ready()   -> motion may begin
//
// One datagram at a time: the one that is on its way is waited for without blocking. A drive that does
// not answer, or wrongly, is asked again; the third time it is a fault, after which nothing is asked until
// restart(). What can be read of a drive is read back and compared; what can't is proven by its count of
// accepted writes, or by what it mirrors.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/drives/drive_kind.hpp"

namespace cusp::drives {

// The motors of X, Y and Z, and the second motor of an axis: bits 0 to 3 of a mask.
inline constexpr unsigned kMostDrives = 4;

struct DriveRequest {
    unsigned drive;
    DriveKind kind;
    Datagram bytes;
    bool replies;  // an answer follows
};
// The registers by which a drive of this kind does what its motor needs.
DriveRegisters registers_for(DriveKind kind, const MotorSetup& setup) noexcept;

enum class FaultKind : std::uint8_t {
    kSilent,        // no answer
    kGarbled,       // answers that are none
    kOtherChip,     // not of the kind that it should be
    kUnset,         // it does not keep what is written
    kRestarted,     // its supply was gone, and its settings with it
    kUndervoltage,  // its supply sank, and it was off meanwhile
    kHot,           // it has switched off for its temperature
    kShort,         // of a motor's coil, to ground or supply
};
struct DriveFault {
    unsigned drive;
    FaultKind kind;
    DriveKind wanted;  // what it should be
};

// Context: main loop. `tick` counts servo ticks and wraps.
class Drives {
public:
    // The drives of `motors` shall have these settings. If it is something else than before, or another set of them,
    // all are set anew; they keep their current meanwhile.
    void configure(const std::array<DriveRegisters, kMostDrives>& registers,
                   std::uint8_t motors) noexcept;
    // As at power-up: nothing is known of any drive, and no fault.
    void restart(std::uint32_t tick) noexcept;

    // All are set, or there is none: motion may begin.
    bool ready() const noexcept { return phase_ == Phase::kWatching || motors_ == 0; }
    // All were set once: the drives may have current.
    bool may_have_current() const noexcept
    {
        return motors_ == 0 || (were_set_ && phase_ != Phase::kFailed);
    }
    std::optional<DriveFault> fault() const noexcept
    {
        return phase_ == Phase::kFailed ? std::optional<DriveFault>{fault_} : std::nullopt;
    }

    // The request that is to be sent now; its answer is waited for.
    std::optional<DriveRequest> next(std::uint32_t tick) noexcept;
    bool waits() const noexcept { return waits_; }
    // The answer can't come any more.
    bool overdue(std::uint32_t tick) const noexcept;
    // The answer to the last request: empty where none came, or none was asked for.
    void take(Span<const std::uint8_t> answer, std::uint32_t tick) noexcept;
    // The last request was not sent to its end: it is sent anew, after a pause in which the drive forgets it.
    // Precondition: waits().
    void put_off(std::uint32_t tick) noexcept;

private:
    enum class Phase : std::uint8_t { kStarting, kSetting, kWatching, kFailed };

    void begin() noexcept;
    const Recipe& recipe() const noexcept;
    const Step& step() const noexcept;
    bool replies() const noexcept;
    std::uint32_t wanted_value() const noexcept;
    void judge(std::uint32_t value, std::uint32_t tick) noexcept;
    std::optional<FaultKind> fault_in(std::uint32_t value) const noexcept;
    bool kept(std::uint32_t value) noexcept;
    void go_on(std::uint32_t tick) noexcept;
    void next_drive() noexcept;
    void suspect(FaultKind kind, std::uint32_t tick) noexcept;
    void ask_again(FaultKind reason, std::uint32_t tick) noexcept;
    void set_again(std::uint32_t tick) noexcept;
    void fail(FaultKind kind) noexcept;

    std::array<DriveRegisters, kMostDrives> registers_{};
    std::uint8_t motors_{0};
    Phase phase_{Phase::kStarting};
    bool were_set_{false};
    bool waits_{false};
    bool stale_{false};  // the answer that is waited for is to something that is over
    unsigned drive_{0};
    unsigned step_{0};      // of what is done with a drive
    unsigned attempts_{0};  // of this step
    unsigned rounds_{0};    // of setting this drive
    std::uint32_t writes_before_{0};
    std::uint32_t due_{0};    // tick of the next request
    std::uint32_t asked_{0};  // tick of the last one
    DriveFault fault_{0, FaultKind::kSilent, DriveKind::kTmc2209};
};

}  // namespace cusp::drives
