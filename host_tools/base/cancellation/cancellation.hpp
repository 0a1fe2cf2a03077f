// The progress of a long computation, for the line printed when Ctrl-C or the end of memory stops it.
//
//     cancellation::stop_with_message(8'000'000'000);            // bytes; once, before the work
//     cancellation::set_work("planning operation 1 of 2 (adaptive_isocurve)");
//     for (int face = 0; face < faces; ++face) {
//         const cancellation::Part part{"face ", face + 1, " of part.step"};
//         cancellation::set_share(static_cast<double>(face) / faces);
//         plan(face);                                          // stops the process, and says where
//     }
//     const cancellation::FinishOutput finish;                   // files are written to their end
//
// The process ends inside a signal handler or the handler of operator new, whatever loop runs: no
// loop has to look for an interruption, and no memory is needed for the line.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace cusp::cancellation {

// From this call on Ctrl-C, SIGTERM and the end of memory print one line and end the process: a
// signal as signals do (128 + its number in a shell), the end of memory with exit status 2.
//
// memory  bytes that the process may allocate; 0: no limit
void stop_with_message(std::size_t memory);

// Half of the machine's memory, bytes.
std::size_t half_of_memory();

// Lets the system have large blocks as soon as they are freed. Once, before the work.
void keep_large_blocks_apart();
// Gives the system what was freed: after a phase that took much more than it left.
void return_freed_memory();

// The work of the process; a long text is cut off. For one thread at a time.
void set_work(std::string_view what);
// The share of it that is done, 0 to 1; from any thread.
void set_share(double share);

// Names the part of the work that this thread does while the object lives; objects may be nested.
class Part {
public:
    // As in {"face ", 12, " of part.step"}.
    Part(std::string_view before, int number, std::string_view after);
    // The name that another thread has for the work that this one takes a share of.
    using Text = std::array<char, 160>;  // ends with 0
    explicit Part(const Text& text);
    ~Part();
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

    // The work of this thread; empty if it has none.
    static const Text& current();

private:
    Text outer_;
};

// While the object lives signals are ignored and memory is not limited.
class FinishOutput {
public:
    FinishOutput();
    ~FinishOutput();
    FinishOutput(const FinishOutput&) = delete;
    FinishOutput& operator=(const FinishOutput&) = delete;
};

}  // namespace cusp::cancellation
