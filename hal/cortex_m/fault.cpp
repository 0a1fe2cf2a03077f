// The end of every fault: its reason is kept over the reset that follows, and the board stops motion.
#include "hal/cortex_m/fault_record.hpp"
#include "hal/cortex_m/vectors.hpp"

namespace cusp {

namespace hal::cortex_m {

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

}  // namespace hal::cortex_m

void fault(const char* expression, const char* file, int line) noexcept
{
    hal::cortex_m::last_fault = {
        hal::cortex_m::FaultRecord::kWritten, expression, file, line, 0, 0, 0, 0};
    cusp_board_stop();
}

}  // namespace cusp
