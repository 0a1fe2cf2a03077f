// StoredState: everything kept over a power cycle, as one record of plain bytes.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "firmware/base/span.hpp"
#include "firmware/gcode/modal_state.hpp"
#include "firmware/machine/settings.hpp"

namespace cusp::machine {

inline constexpr std::size_t kStoredTextLength = 79;
inline constexpr unsigned kStartupLineCount = 2;

// A short text, ended by 0.
struct StoredText {
    std::array<char, kStoredTextLength + 1> characters{};

    std::string_view view() const noexcept;
    // Precondition: text.size() <= kStoredTextLength.
    void set(std::string_view text) noexcept;
};

struct StoredState {
    Settings settings;
    gcode::Parameters parameters;
    std::array<StoredText, kStartupLineCount> startup;
    StoredText build;

    Span<std::uint8_t> bytes() noexcept;
    Span<const std::uint8_t> bytes() const noexcept;
};

static_assert(std::is_trivially_copyable_v<StoredState>);
static_assert(sizeof(StoredState) % 4 == 0, "the store is written in words");

}  // namespace cusp::machine
