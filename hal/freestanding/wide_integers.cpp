// From float to 64-bit integers without double, which the compiler's own runtime uses: the servo
// tick converts, and must not use doubles.
#include <cstdint>

namespace {

// The whole part of |x| below 2^64; what lies beyond is 0, as undefined as in C++.
std::uint64_t whole_part(std::uint32_t bits)
{
    constexpr std::uint32_t kFractionBits = 23;
    constexpr std::uint32_t kHidden = 1U << kFractionBits;
    const std::uint32_t exponent = bits >> kFractionBits & 0xFFU;
    if (exponent < 127 || exponent >= 127 + 64) {
        return 0;
    }
    const std::uint64_t fraction = (bits & (kHidden - 1)) | kHidden;
    const std::uint32_t shift = exponent - 127;
    return shift >= kFractionBits ? fraction << (shift - kFractionBits)
                                  : fraction >> (kFractionBits - shift);
}

std::uint32_t bits_of(float x)
{
    std::uint32_t bits = 0;
    __builtin_memcpy(&bits, &x, sizeof bits);
    return bits;
}

}  // namespace

extern "C" {

// Names of the Arm run-time ABI, which passes these floats in integer registers.
__attribute__((pcs("aapcs"))) std::uint64_t __aeabi_f2ulz(float x);
__attribute__((pcs("aapcs"))) std::int64_t __aeabi_f2lz(float x);

std::uint64_t __aeabi_f2ulz(float x)
{
    const std::uint32_t bits = bits_of(x);
    return bits >> 31U != 0 ? 0 : whole_part(bits);
}

std::int64_t __aeabi_f2lz(float x)
{
    const std::uint32_t bits = bits_of(x);
    const auto size = static_cast<std::int64_t>(whole_part(bits));
    return bits >> 31U != 0 ? -size : size;
}
}
