// --threads and --memory.
#include "host_tools/cli/resource_options.hpp"

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/parallel/parallel.hpp"

#include "CLI/CLI.hpp"

namespace cusp::cli {
namespace {

constexpr int kMostThreads = 1024;

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
    cancellation::keep_large_blocks_apart();
    if (resources.threads > 0) {
        parallel::set_threads(resources.threads);
    }
    cancellation::stop_with_message(resources.memory > 0 ? resources.memory
                                                         : cancellation::half_of_memory());
}

}  // namespace cusp::cli
