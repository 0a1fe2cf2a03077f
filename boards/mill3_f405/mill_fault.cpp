// What a fault does on the mill: steps low, drives off, spindle off, the reason kept, a fresh
// start.
#include "boards/mill3_f405/board_traits.hpp"
#include "hal/stm32f4/fault_record.hpp"

namespace {

using Chip = cusp::hal::stm32f4::Chip;
using cusp::hal::stm32f4::FaultRecord;

[[noreturn]] void stop_and_reset()
{
    constexpr std::uint32_t kResetRequest = 0x05FA0004;
    cusp::boards::ChipTraits::PulsePlayer::stop();
    cusp::boards::ChipTraits::Panel{}.set({});
    __asm volatile("dsb" ::: "memory");
    Chip::system().aircr.write(kResetRequest);
    for (;;) {
    }
}

}  // namespace

namespace cusp {

namespace hal::stm32f4 {

// The start-up code does not touch this section.
__attribute__((section(".retained"))) FaultRecord last_fault;

void core_fault(std::uint32_t exception,
                std::uint32_t program_counter,
                std::uint32_t link_register,
                std::uint32_t fault_status) noexcept
{
    last_fault = {FaultRecord::kWritten, nullptr,       nullptr,     0, exception,
                  program_counter,       link_register, fault_status};
    stop_and_reset();
}

}  // namespace hal::stm32f4

void fault(const char* expression, const char* file, int line) noexcept
{
    hal::stm32f4::last_fault = {FaultRecord::kWritten, expression, file, line, 0, 0, 0, 0};
    stop_and_reset();
}

}  // namespace cusp
