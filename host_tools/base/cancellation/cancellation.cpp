// Texts are prepared in fixed places; handlers only write them out.
#include "host_tools/base/cancellation/cancellation.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <csignal>
#include <new>
#include <sys/resource.h>
#include <unistd.h>

namespace cusp::cancellation {
namespace {

constexpr std::size_t kLongestWork = 400;
constexpr int kCannotUse = 2;  // exit status
constexpr double kMega = 1e6;

// The work is written where no handler reads: a signal finds the old text or the new one.
struct Work {
    std::array<std::array<char, kLongestWork>, 2> texts{};
    std::atomic<int> current{0};
    std::atomic<int> percent{-1};  // negative: not known
};
Work work;
std::atomic<int> finishing{0};
rlim_t memory_limit = RLIM_INFINITY;
thread_local Part::Text part{};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use it");

template <std::size_t Size>
void put(std::array<char, Size>& to, std::size_t& at, std::string_view text)
{
    const std::size_t count = std::min(text.size(), Size - 1 - at);
    std::copy_n(text.data(), count, to.data() + at);
    at += count;
    to[at] = 0;
}

template <std::size_t Size>
void put_number(std::array<char, Size>& to, std::size_t& at, long long number)
{
    std::array<char, 24> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    put(to, at, {digits.data(), static_cast<std::size_t>(end - digits.data())});
}

// For handlers: no allocation, no lock.
void write_line(std::string_view why, rlim_t megabytes)
{
    std::array<char, kLongestWork + std::tuple_size_v<Part::Text> + 200> line{};
    std::size_t at = 0;
    put(line, at, "\ncusp: ");
    put(line, at, why);
    if (megabytes > 0) {
        put(line, at, " (--memory ");
        put_number(line, at, static_cast<long long>(megabytes));
        put(line, at, " MB)");
    }
    const char* what = work.texts[static_cast<std::size_t>(work.current)].data();
    if (what[0] != 0) {
        put(line, at, " while ");
        put(line, at, what);
    }
    if (part[0] != 0) {
        put(line, at, ", at ");
        put(line, at, part.data());
    }
    if (work.percent >= 0) {
        put(line, at, ", ");
        put_number(line, at, work.percent);
        put(line, at, " % done");
    }
    put(line, at, ": nothing is written\n");
    // A closed terminal takes no line, and the process ends all the same.
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), at);
}

extern "C" void stop_by_signal(int signal)
{
    if (finishing > 0) {
        return;
    }
    write_line("interrupted", 0);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

// A large request may fail where there is room for smaller ones: the process ends all the same.
[[noreturn]] void stop_without_memory()
{
    const bool limited = memory_limit != RLIM_INFINITY;
    write_line("out of memory",
               limited ? static_cast<rlim_t>(static_cast<double>(memory_limit) / kMega) : 0);
    _exit(kCannotUse);
}

// A sanitizer reserves more addresses than any machine has memory. GCC defines macros, Clang has features.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define CUSP_SANITIZED
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CUSP_SANITIZED
#endif
#if defined(CUSP_SANITIZED)
constexpr bool kLimitsMemory = false;
#else
constexpr bool kLimitsMemory = true;
#endif

void limit_memory(rlim_t bytes)
{
    rlimit limit{};
    if (kLimitsMemory && getrlimit(RLIMIT_DATA, &limit) == 0) {
        limit.rlim_cur = std::min(bytes, limit.rlim_max);
        setrlimit(RLIMIT_DATA, &limit);
    }
}

}  // namespace

void stop_with_message(std::size_t memory)
{
    std::set_new_handler(stop_without_memory);
    std::signal(SIGINT, stop_by_signal);
    std::signal(SIGTERM, stop_by_signal);
    if (memory > 0) {
        memory_limit = memory;
        limit_memory(memory_limit);
    }
}

std::size_t half_of_memory()
{
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0
               ? static_cast<std::size_t>(pages) / 2 * static_cast<std::size_t>(size)
               : 0;
}

void set_work(std::string_view what)
{
    const int other = 1 - work.current;
    std::size_t at = 0;
    put(work.texts[static_cast<std::size_t>(other)], at, what);
    work.current = other;
    work.percent = -1;
}

void set_share(double share) { work.percent = static_cast<int>(100 * std::clamp(share, 0.0, 1.0)); }

Part::Part(std::string_view before, int number, std::string_view after) : outer_{part}
{
    std::size_t at = 0;
    put(part, at, before);
    put_number(part, at, number);
    put(part, at, after);
}

Part::Part(const Text& text) : outer_{part} { part = text; }

const Part::Text& Part::current() { return part; }

Part::~Part() { part = outer_; }

FinishOutput::FinishOutput()
{
    ++finishing;
    limit_memory(RLIM_INFINITY);
}

FinishOutput::~FinishOutput()
{
    limit_memory(memory_limit);
    --finishing;
}

}  // namespace cusp::cancellation
