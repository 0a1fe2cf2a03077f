// EdgeTrace: every edge with its tick, to a file of the host.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/pulse_frame.hpp"
#include "hal/qemu/semihosting.hpp"

namespace cusp::hal::qemu {

// The file: eight bytes an edge, lowest byte first: the levels of the six lines (PulseLines) after
// the edge, then the pulse tick since the first frame in seven bytes. Edges that change no level
// are left out, as in a value change dump.
class EdgeTrace {
public:
    void open(const char* name) noexcept { file_ = HostFile{name, FileMode::kWrite}; }
    bool is_open() const noexcept { return file_.is_open(); }

    void note(std::uint64_t tick, PulseLines levels) noexcept
    {
        if (!is_open() || levels == last_) {
            return;
        }
        last_ = levels;
        edges_[count_] = tick << 8U | levels;
        ++count_;
        if (count_ == kRoom) {
            flush();
        }
    }

    // Context: with the player's interrupt off or silent.
    void flush() noexcept
    {
        if (is_open() && count_ > 0) {
            file_.write({reinterpret_cast<const std::uint8_t*>(edges_.data()),
                         count_ * sizeof(std::uint64_t)});
            count_ = 0;
        }
    }

private:
    static constexpr std::uint32_t kRoom = 1024;

    HostFile file_;
    std::array<std::uint64_t, kRoom> edges_{};
    std::uint32_t count_{0};
    PulseLines last_{0};
};

}  // namespace cusp::hal::qemu
