// Vfd: a spindle whose drive is spoken to by Modbus: told what it shall do, and asked how fast it turns.
//
//   vfd.configure(setup, times);
//   vfd.want(turning, rpm);                                    // main loop, again and again
//   if (const auto message = vfd.next(tick)) { send it; }
//   vfd.take(answer, tick);                                    // once it came, or can't come any more
//   vfd.at_speed()   -> motion may begin
//
// One message at a time, its answer waited for without blocking. One that is lost, late or garbled is asked
// for again after a pause in which whatever still comes is not heard; the third time it is a fault. From then
// on nothing but a stop is sent, again and again until it is answered, and until a stop is what is wanted.
// A stop goes before everything else.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/vfd/vfd_protocol.hpp"

namespace cusp::vfd {

enum class FaultKind : std::uint8_t {
    kSilent,   // no answer
    kGarbled,  // answers that are none
    kRefused,  // it answers that it will not
};

struct VfdTimes {
    std::uint32_t answer{50};  // servo ticks that an answer may take, the message included
    float tolerance{0.05F};    // part of the speed by which it may differ and count as reached
};

// Context: main loop. `tick` counts servo ticks and wraps.
class Vfd {
public:
    // If it is another drive, it is stopped first.
    void configure(const VfdSetup& setup, const VfdTimes& times) noexcept;
    // As at power-up: nothing is known of the drive, and no fault.
    void restart() noexcept;

    bool in_use() const noexcept { return setup_.protocol != Protocol::kNone; }

    // rpm: 0 stops it.
    void want(Turning turning, float rpm) noexcept;
    // It does what is wanted: stopped when it has taken that, running when it was read twice to be as fast.
    bool at_speed() const noexcept;

    // A fault that nobody has heard of yet.
    std::optional<FaultKind> fault() const noexcept { return fault_; }
    void fault_heard() noexcept { fault_.reset(); }

    // The message that is to be sent now; its answer is waited for.
    std::optional<Message> next(std::uint32_t tick) noexcept;
    bool waits() const noexcept { return waits_; }
    // True if these bytes are a whole answer, or none can come any more.
    bool is_over(Span<const std::uint8_t> bytes, std::uint32_t tick) const noexcept;
    // Takes the bytes that came after the last message. Precondition: waits().
    void take(Span<const std::uint8_t> bytes, std::uint32_t tick) noexcept;
    // The last message was not sent to its end: it is sent anew, after a pause. Precondition: waits().
    void put_off(std::uint32_t tick) noexcept;

private:
    std::optional<Query> due_query(std::uint32_t tick) const noexcept;
    void accept(std::uint16_t value, std::uint32_t tick) noexcept;
    void reject(FaultKind kind) noexcept;
    void forgive() noexcept;
    std::uint16_t wanted_word() const noexcept { return speed_word(setup_, wanted_rpm_, scale_); }

    VfdSetup setup_;
    VfdTimes times_;
    Turning wanted_{Turning::kOff};
    float wanted_rpm_{0};
    // Settings that the drive has taken.
    std::optional<Turning> turning_;
    std::optional<std::uint16_t> word_;
    float scale_{0};        // 0: not known
    unsigned readings_{0};  // in a row that agree with what is wanted
    bool failed_{false};    // only a stop is sent
    std::optional<FaultKind> fault_;

    bool waits_{false};
    bool stale_{false};  // the answer is to another drive, or to one before the restart
    Query query_{Query::kRun};
    Message message_;
    Turning sent_turning_{Turning::kOff};
    std::uint16_t sent_word_{0};
    unsigned attempts_{0};
    std::uint32_t asked_{0};    // tick of the last message
    std::uint32_t over_at_{0};  // tick of the end of its answer
    std::uint32_t pause_{0};    // ticks after that
    std::uint32_t read_at_{0};  // tick of the last reading
};

}  // namespace cusp::vfd
