// The end of every fault: its reason is kept over the reset that follows, and the board stops motion.
#include "hal/stm32f4/fault_record.hpp"
#include "hal/stm32f4/vectors.hpp"

namespace cusp {

namespace hal::stm32f4 {

// The start-up code does not touch this section.
__attribute__((section(".retained"))) FaultRecord last_fault;
__attribute__((section(".retained"))) ResetRecord last_reset;

void core_fault(std::uint32_t exception,
                std::uint32_t program_counter,
                std::uint32_t link_register,
                std::uint32_t fault_status) noexcept
{
    last_fault = {FaultRecord::kWritten, nullptr,       nullptr,     0, exception,
                  program_counter,       link_register, fault_status};
    cusp_board_stop();
}

}  // namespace hal::stm32f4

void fault(const char* expression, const char* file, int line) noexcept
{
    hal::stm32f4::last_fault = {
        hal::stm32f4::FaultRecord::kWritten, expression, file, line, 0, 0, 0, 0};
    cusp_board_stop();
}

}  // namespace cusp
