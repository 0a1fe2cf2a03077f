// RM0090 section 8.4.
#include "tests/target/cosim/port_model.hpp"

namespace cusp::cosim {

PortModel::PortModel(Circuit& circuit, char letter) : Model{circuit}, letter_{letter}
{
    outside_.fill(-1);
    PortModel::reset();
}

void PortModel::reset()
{
    moder_ = letter_ == 'A' ? 0xA8000000U : letter_ == 'B' ? 0x00000280U : 0U;
    pupdr_ = letter_ == 'A' ? 0x64000000U : letter_ == 'B' ? 0x00000100U : 0U;
    otyper_ = 0;
    ospeedr_ = 0;
    odr_ = 0;
    afr_ = {};
    outputs_ = outputs();
    look();
}

std::uint16_t PortModel::outputs() const
{
    std::uint32_t pins = 0;
    for (unsigned pin = 0; pin < 16; ++pin) {
        pins |= (mode(pin) == 1 ? 1U : 0U) << pin;
    }
    return static_cast<std::uint16_t>(pins);
}

std::uint32_t PortModel::levels() const
{
    std::uint32_t levels = 0;
    for (unsigned pin = 0; pin < 16; ++pin) {
        const unsigned pull = pupdr_ >> 2 * pin & 3U;
        const bool high = driven(pin)          ? (odr_ >> pin & 1U) != 0
                          : outside_[pin] >= 0 ? outside_[pin] != 0
                                               : pull == 1;
        levels |= (high ? 1U : 0U) << pin;
    }
    return levels;
}

void PortModel::drive(unsigned pin, int level)
{
    outside_[pin] = level;
    if (level >= 0 && driven(pin)) {
        circuit_.violate(std::string{"P"} + letter_ + std::to_string(pin) +
                         ": driven from outside and from inside");
    }
}

std::uint32_t PortModel::read(std::uint32_t offset)
{
    switch (offset) {
        case 0x00:
            return moder_;
        case 0x04:
            return otyper_;
        case 0x08:
            return ospeedr_;
        case 0x0C:
            return pupdr_;
        case 0x10:
            return levels();
        case 0x14:
            return odr_;
        case 0x1C:
            return lckr_;
        case 0x20:
        case 0x24:
            return afr_[(offset - 0x20) / 4];
        default:
            return 0;
    }
}

void PortModel::write(std::uint32_t offset, std::uint32_t value)
{
    switch (offset) {
        case 0x00:
            moder_ = value;
            outputs_ = outputs();
            break;
        case 0x04:
            otyper_ = value;
            break;
        case 0x08:
            ospeedr_ = value;
            break;
        case 0x0C:
            pupdr_ = value;
            break;
        case 0x14:
            odr_ = value & 0xFFFFU;
            break;
        case 0x18:
            set_reset(value);
            break;
        case 0x1C:
            lckr_ = value;
            break;
        case 0x20:
        case 0x24:
            afr_[(offset - 0x20) / 4] = value;
            break;
        default:
            circuit_.violate(std::string{"port "} + letter_ + ": write to a register to be read, " +
                             hexadecimal(offset));
    }
    look();
}

void PortModel::write_by_dma(std::uint32_t offset, std::uint32_t value)
{
    if (offset != 0x18) {
        circuit_.violate(std::string{"port "} + letter_ + ": DMA writes register " +
                         hexadecimal(offset));
        return;
    }
    if (value == 0) {
        return;
    }
    if (((value | value >> 16U) & 0xFFFFU & ~std::uint32_t{outputs_}) != 0) {
        circuit_.violate(std::string{"port "} + letter_ + ": DMA drives a pin that is no output");
    }
    set_reset(value);
    look();
}

void PortModel::look()
{
    if (note(circuit_.now, outputs_, odr_ & outputs_)) {
        for (const Listener& listener : listeners_) {
            listener.call();
        }
    }
}

}  // namespace cusp::cosim
