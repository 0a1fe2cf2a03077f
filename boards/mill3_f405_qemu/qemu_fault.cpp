// A fault under QEMU: the reason on the terminal, the end of the run.
#include <cstdint>
#include <string_view>

#include "boards/mill3_f405_qemu/qemu_traits.hpp"
#include "hal/stm32f4/fault_record.hpp"
#include "hal/stm32f4/reset_reason.hpp"

namespace {

constexpr std::uint32_t kFaultStatus = 3;

// As much of a byte link as the report needs.
struct Console {
    std::uint32_t write_room() const noexcept { return 1; }
    void write(cusp::Span<const std::uint8_t> bytes) const noexcept { file.write(bytes); }
    cusp::hal::qemu::HostFile file{":tt", cusp::hal::qemu::FileMode::kWrite};
};

[[noreturn]] void report_and_exit()
{
    cusp::boards::QemuTraits::PulsePlayer::stop();
    Console console;
    cusp::hal::stm32f4::report_last_fault(console);
    cusp::hal::qemu::exit_qemu(kFaultStatus);
}

}  // namespace

namespace cusp {

namespace hal::stm32f4 {

__attribute__((section(".retained"))) FaultRecord last_fault;

void core_fault(std::uint32_t exception,
                std::uint32_t program_counter,
                std::uint32_t link_register,
                std::uint32_t fault_status) noexcept
{
    last_fault = {FaultRecord::kWritten, nullptr,       nullptr,     0, exception,
                  program_counter,       link_register, fault_status};
    report_and_exit();
}

}  // namespace hal::stm32f4

void fault(const char* expression, const char* file, int line) noexcept
{
    hal::stm32f4::last_fault = {
        hal::stm32f4::FaultRecord::kWritten, expression, file, line, 0, 0, 0, 0};
    report_and_exit();
}

}  // namespace cusp
