// --threads and --memory.
#include "host_tools/cli/resource_options.hpp"

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/parallel/parallel.hpp"

#include "CLI/CLI.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace cusp::cli {
namespace {

constexpr int kMostThreads = 1024;

// The allocator's own bound rises to the largest block freed, up to 32 MB; what is freed below it
// stays in pieces between other blocks. Only 440 of a plan's 660 MB were in use.
void keep_large_blocks_apart()
{
#ifdef __GLIBC__
    constexpr int kLargeBlock = 512 * 1024;  // bytes
    constexpr int kMostFreeAtEnd =
        8 * 1024 * 1024;  // bytes: fewer calls of the system than by default
    mallopt(M_MMAP_THRESHOLD, kLargeBlock);
    mallopt(M_TRIM_THRESHOLD, kMostFreeAtEnd);
#endif
}

}  // namespace

void add_resource_options(CLI::App& command, Resources& resources)
{
    command
        .add_option("--threads", resources.threads,
                    "how many to use; the result is the same for any number (default: one a core)")
        ->check(CLI::Range(1, kMostThreads))
        ->type_name("N");
    command
        .add_option("--memory", resources.memory,
                    "the most to use, such as 4GB (default: half of the machine's)")
        ->transform(CLI::AsSizeValue(true))
        ->type_name("SIZE");
}

void apply(const Resources& resources)
{
    keep_large_blocks_apart();
    if (resources.threads > 0) {
        parallel::set_threads(resources.threads);
    }
    cancellation::stop_with_message(resources.memory > 0 ? resources.memory
                                                         : cancellation::half_of_memory());
}

void return_freed_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace cusp::cli
