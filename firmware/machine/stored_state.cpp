// Plain bytes and short texts.
#include "firmware/machine/stored_state.hpp"

#include <algorithm>

#include "firmware/base/assert.hpp"

namespace cusp::machine {

std::string_view StoredText::view() const noexcept
{
    const auto* const end = std::find(characters.begin(), characters.end() - 1, '\0');
    return {characters.data(), static_cast<std::size_t>(end - characters.begin())};
}

void StoredText::set(std::string_view text) noexcept
{
    CUSP_ASSERT(text.size() <= kStoredTextLength);
    characters.fill('\0');
    std::copy(text.begin(), text.end(), characters.begin());
}

// NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): trivially copyable, read as bytes only.
Span<std::uint8_t> StoredState::bytes() noexcept
{
    return {reinterpret_cast<std::uint8_t*>(this), sizeof(StoredState)};
}

Span<const std::uint8_t> StoredState::bytes() const noexcept
{
    return {reinterpret_cast<const std::uint8_t*>(this), sizeof(StoredState)};
}
// NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)

}  // namespace cusp::machine
