// The memory functions that GCC and its headers call even in freestanding code, without a C
// library.
#include <cstddef>
#include <cstdint>

namespace {

using Byte = unsigned char;
// May alias anything, as the bytes it copies may belong to any object.
using Word = std::uint32_t __attribute__((may_alias));

constexpr bool aligned(std::uintptr_t address) { return address % sizeof(Word) == 0; }

std::uintptr_t address_of(const void* pointer) { return reinterpret_cast<std::uintptr_t>(pointer); }

}  // namespace

extern "C" {

void* memcpy(void* to, const void* from, std::size_t size);
void* memmove(void* to, const void* from, std::size_t size);
void* memset(void* to, int value, std::size_t size);
int memcmp(const void* left, const void* right, std::size_t size);
std::size_t strlen(const char* text);
const void* memchr(const void* from, int value, std::size_t size);

void* memcpy(void* to, const void* from, std::size_t size)
{
    auto* target = static_cast<Byte*>(to);
    const auto* source = static_cast<const Byte*>(from);
    if (aligned(address_of(to)) && aligned(address_of(from))) {
        while (size >= sizeof(Word)) {
            *reinterpret_cast<Word*>(target) = *reinterpret_cast<const Word*>(source);
            target += sizeof(Word);
            source += sizeof(Word);
            size -= sizeof(Word);
        }
    }
    while (size-- > 0) {
        *target++ = *source++;
    }
    return to;
}

void* memmove(void* to, const void* from, std::size_t size)
{
    if (address_of(to) - address_of(from) >= size) {
        return memcpy(to, from, size);
    }
    auto* target = static_cast<Byte*>(to);
    const auto* source = static_cast<const Byte*>(from);
    while (size-- > 0) {
        target[size] = source[size];
    }
    return to;
}

void* memset(void* to, int value, std::size_t size)
{
    auto* target = static_cast<Byte*>(to);
    const auto byte = static_cast<Byte>(value);
    while (size > 0 && !aligned(address_of(target))) {
        *target++ = byte;
        --size;
    }
    const Word word = byte * 0x01010101U;
    while (size >= 8 * sizeof(Word)) {
        auto* words = reinterpret_cast<Word*>(target);
        words[0] = word;
        words[1] = word;
        words[2] = word;
        words[3] = word;
        words[4] = word;
        words[5] = word;
        words[6] = word;
        words[7] = word;
        target += 8 * sizeof(Word);
        size -= 8 * sizeof(Word);
    }
    while (size >= sizeof(Word)) {
        *reinterpret_cast<Word*>(target) = word;
        target += sizeof(Word);
        size -= sizeof(Word);
    }
    while (size-- > 0) {
        *target++ = byte;
    }
    return to;
}

int memcmp(const void* left, const void* right, std::size_t size)
{
    const auto* a = static_cast<const Byte*>(left);
    const auto* b = static_cast<const Byte*>(right);
    for (std::size_t i = 0; i < size; ++i) {
        if (a[i] != b[i]) {
            return a[i] - b[i];
        }
    }
    return 0;
}

std::size_t strlen(const char* text)
{
    std::size_t size = 0;
    while (text[size] != '\0') {
        ++size;
    }
    return size;
}

const void* memchr(const void* from, int value, std::size_t size)
{
    const auto* bytes = static_cast<const Byte*>(from);
    for (std::size_t i = 0; i < size; ++i) {
        if (bytes[i] == static_cast<Byte>(value)) {
            return bytes + i;
        }
    }
    return nullptr;
}
}
