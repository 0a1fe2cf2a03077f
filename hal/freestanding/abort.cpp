// Called by the standard library where one of its preconditions is violated: a fault, as for our
// own.
#include "firmware/base/assert.hpp"

extern "C" {

[[noreturn]] void abort();
int __aeabi_atexit(void* object, void (*destroy)(void*), void* dso);
void* __dso_handle = nullptr;
}

// Called by the library's headers: a substr() of a view begins beyond its end.
namespace std {
[[noreturn]] void __throw_out_of_range_fmt(const char*, ...);
void __throw_out_of_range_fmt(const char* /*format*/, ...) { abort(); }
}  // namespace std

extern "C" {

void abort() { cusp::fault("abort", __FILE__, __LINE__); }

// An image never ends: the destructors of its static objects never run.
int __aeabi_atexit(void*, void (*)(void*), void*) { return 0; }
}
