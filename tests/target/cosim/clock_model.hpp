// ClockModel: RCC and PWR: oscillators, multiplier, buses, which blocks have a clock, why it was reset.
#pragma once

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

// Parts that are soldered on the board, and values printed in the data sheet.
struct ClockFacts {
    std::uint32_t crystal_hz{8000000};  // 0: none
    std::uint32_t most_hz{168000000};
    std::uint32_t most_slow_hz{42000000};
    std::uint32_t most_fast_hz{84000000};
    std::uint32_t hz_per_wait_state{30000000};
    std::uint32_t full_scale{1};  // VOS that most_hz asks for
    bool external{false};         // a clock from outside drives OSC_IN in place of a crystal
};

class ClockModel final : public Model {
public:
    ClockModel(Circuit& circuit, const ClockFacts& facts);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    std::uint32_t read_power(std::uint32_t offset) const;
    void write_power(std::uint32_t offset, std::uint32_t value);

    std::uint32_t core_hz() const { return core_hz_; }
    std::uint32_t slow_bus_hz() const { return core_hz_ / divisor(cfgr_ >> 10U & 7U); }
    std::uint32_t fast_bus_hz() const { return core_hz_ / divisor(cfgr_ >> 13U & 7U); }
    std::uint32_t slow_timer_hz() const { return timer_hz(slow_bus_hz(), cfgr_ >> 10U & 7U); }
    std::uint32_t fast_timer_hz() const { return timer_hz(fast_bus_hz(), cfgr_ >> 13U & 7U); }
    // The multiplier's other output; 0 while it is off.
    std::uint32_t usb_hz() const;
    // The clock that timer 11 can measure: the crystal divided by RTCPRE; 0 if nothing oscillates.
    std::uint32_t divided_crystal_hz() const;

    bool ahb1_on(unsigned bit) const { return (ahb1enr_ >> bit & 1U) != 0; }
    bool ahb2_on(unsigned bit) const { return (ahb2enr_ >> bit & 1U) != 0; }
    bool apb1_on(unsigned bit) const { return (apb1enr_ >> bit & 1U) != 0; }
    bool apb2_on(unsigned bit) const { return (apb2enr_ >> bit & 1U) != 0; }

    // Wait states of the flash, as FLASH_ACR says: checked against the core's rate.
    void set_wait_states(std::uint32_t count);
    // Counts each change of rates.
    std::uint32_t changes() const { return changes_; }

    // The crystal stops, while it runs.
    void kill_crystal();
    enum class ResetCause : std::uint8_t { kPowerUp, kPin, kSoftware, kWatchdog };
    void note_reset(ResetCause cause);

private:
    static std::uint32_t divisor(std::uint32_t field) { return field < 4 ? 1U : 2U << (field - 4); }
    static std::uint32_t timer_hz(std::uint32_t bus, std::uint32_t field)
    {
        return field < 4 ? bus : 2 * bus;
    }
    std::uint64_t inside_hz() const;
    std::uint32_t multiplier_hz() const;
    bool crystal_fits() const
    {
        return crystal_alive_ && ((cr_ >> 18U & 1U) != 0) == facts_.external;
    }
    std::uint32_t control() const;
    void write_control(std::uint32_t value);
    void update();
    void check_rates();

    ClockFacts facts_;
    bool crystal_alive_;
    std::uint32_t cr_{0}, pllcfgr_{0}, cfgr_{0}, cir_{0}, csr_{0};
    std::uint32_t ahb1enr_{0}, ahb2enr_{0}, apb1enr_{0}, apb2enr_{0};
    std::uint32_t power_cr_{0};
    Picoseconds crystal_since_{0}, multiplier_since_{0};
    std::uint32_t wait_states_{0};
    std::uint32_t core_hz_{16000000};
    std::uint32_t changes_{0};
};

}  // namespace cusp::cosim
