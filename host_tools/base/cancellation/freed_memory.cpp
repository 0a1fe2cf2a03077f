// Bounds the freed memory that the GNU allocator keeps; other allocators keep what they like.
#include "host_tools/base/cancellation/cancellation.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace cusp::cancellation {

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

void return_freed_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace cusp::cancellation
