// The installed core in a program of its own, that answers for faults as every board does: the
// controller says hello.
#include <cstdlib>

#include "firmware/app/app.hpp"

[[noreturn]] void cusp::fault(const char* /*text*/, const char* /*file*/, int /*line*/) noexcept
{
    std::abort();
}

int main()
{
    static cusp::planner::PathQueue queue;
    static cusp::machine::Machine machine{queue, {}};
    machine.start(cusp::machine::LogState::kEmpty);
    return machine.replies().empty() ? 1 : 0;
}
