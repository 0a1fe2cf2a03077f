// Behaviour of each register of the modelled chip, after its data sheet.
#include "tests/unit/hal_rp2350/pico_model.hpp"

namespace cusp::test {
namespace {

constexpr std::size_t kQueue = 8;  // joined
constexpr std::uint32_t kIncrement = 1U << 4U;
constexpr std::uint32_t kIsolated = 1U << 8U;
constexpr std::uint32_t kCoreFunction = 5;
constexpr std::uint32_t kPio0Function = 6;
constexpr std::uint32_t kNoFunction = 31;
constexpr std::uint32_t kFlashBytes = 4 * 1024 * 1024;
constexpr std::uint32_t kAvailable = 1U << 10U;

}  // namespace

PicoModel* PicoModel::current = nullptr;

std::uint32_t PicoWord::read() { return PicoModel::current->on_read(*this); }
void PicoWord::write(std::uint32_t written) { PicoModel::current->on_write(*this, written); }

PicoModel::PicoModel()
{
    current = this;
    machine.pio = &pio0;
    for (auto& pin : functions.pin) {
        pin.ctrl.value = kNoFunction;
    }
    for (auto& pad : pads.pin) {
        pad.value = kIsolated;
    }
    resets.reset.value = 0x1FFFFFFF;
    for (auto* multiplier : {&core_multiplier, &usb_multiplier}) {
        multiplier->pwr.value = 0x2D;
    }
    clocks.ref.selected.value = 1;
    clocks.sys.selected.value = 1;
}
PicoModel::~PicoModel() { current = nullptr; }

void MachineModel::out(std::uint32_t instruction)
{
    const unsigned count = (instruction & 0x1FU) == 0 ? 32 : instruction & 0x1FU;
    const std::uint32_t data = count == 32 ? osr_ : osr_ & ((1U << count) - 1);
    osr_ = count == 32 ? 0 : osr_ >> count;
    const std::uint32_t control = pio->machine[0].pinctrl.value;
    const unsigned base = control & 0x1FU;
    const std::uint32_t mask = ((1U << (control >> 20U & 0x3FU)) - 1) << base;
    switch (instruction >> 5U & 7U) {
        case 0:
            pins = (pins & ~mask) | (data << base & mask);
            break;
        case 1:
            x_ = data;
            break;
        case 4:
            directions = (directions & ~mask) | (data << base & mask);
            break;
        default:
            ++violations;
    }
}

void MachineModel::execute(std::uint32_t instruction)
{
    delay_ = instruction >> 8U & 0x1FU;
    const std::uint32_t plain = instruction & 0xE0FFU;
    if (plain == 0x8080) {  // pull noblock
        osr_ = queue.empty() ? x_ : queue.front();
        if (!queue.empty()) {
            queue.pop_front();
        }
    } else if (plain >> 13U == 3) {
        out(plain);
    } else if (plain == 0x4030) {  // in x, 16, to the left
        violations += (pio->machine[0].shiftctrl.value >> 18U & 1U) != 0 ? 1U : 0U;
        isr_ = isr_ << 16U | (x_ & 0xFFFFU);
    } else if (plain == 0xA026) {  // mov x, isr
        x_ = isr_;
    } else if (plain == 0xA0EB) {  // mov osr, ~null
        osr_ = 0xFFFFFFFF;
    } else if (plain == 0x0000) {  // jmp 0
        pc = 0;
    } else {
        ++violations;
    }
}

void MachineModel::run_cycle()
{
    if (!on) {
        return;
    }
    if (delay_ > 0) {
        --delay_;
        return;
    }
    const unsigned at = pc;
    const std::uint32_t exec = pio->machine[0].execctrl.value;
    pc = at == (exec >> 12U & 0x1FU) ? exec >> 7U & 0x1FU : at + 1;
    execute(pio->instr_mem[at].value);
}

std::uint32_t PicoModel::bus_address(const volatile void* memory)
{
    addresses_.push_back(memory);
    return static_cast<std::uint32_t>(addresses_.size() - 1);
}

std::uint32_t PicoModel::levels() const
{
    std::uint32_t found = last_levels_;
    for (unsigned pin = 0; pin < hal::rp2350::kPinCount; ++pin) {
        const std::uint32_t bit = 1U << pin;
        const std::uint32_t function = functions.pin[pin].ctrl.value & 0x1FU;
        const bool by_core = function == kCoreFunction && (core_pins.enable.value & bit) != 0;
        const bool by_pio = function == kPio0Function && (machine.directions & bit) != 0;
        if ((pads.pin[pin].value & kIsolated) != 0 || (!by_core && !by_pio)) {
            continue;
        }
        const std::uint32_t from = by_core ? core_pins.out.value : machine.pins;
        found = (found & ~bit) | (from & bit);
    }
    return found;
}

void PicoModel::note_pins()
{
    const std::uint32_t now = levels();
    if (((now ^ last_levels_) & watched) != 0) {
        changes.push_back({now_, now & watched});
    }
    last_levels_ = now;
}

// 12.6: a word whenever the queue asks for one.
void PicoModel::feed()
{
    auto& channel = dma.channel[0];
    while (busy_ && (channel.ctrl.value & 1U) != 0 && machine.queue.size() < kQueue) {
        const auto* words =
            static_cast<const volatile std::uint32_t*>(addresses_[channel.read_addr_start.value]);
        machine.queue.push_back(std::uint32_t{words[fetched_]});
        fetched_ += (channel.ctrl.value & kIncrement) != 0 ? 1U : 0U;
        --left_;
        if (left_ == 0) {
            busy_ = false;
            dma.raised.value |= 1;
        }
    }
}

void PicoModel::run_microsecond()
{
    constexpr unsigned kCycles = 10;
    ++now_;
    if (machine.on && pio0.machine[0].clkdiv.value != 15U << 16U) {
        ++violations;
    }
    for (unsigned i = 0; i < kCycles; ++i) {
        machine.run_cycle();
        feed();
    }
    note_pins();
    violations += machine.violations;
    machine.violations = 0;
}

std::uint32_t PicoModel::on_read(PicoWord& word)
{
    if (&word == &pio0.flevel) {
        return static_cast<std::uint32_t>(machine.queue.size());
    }
    if (&word == &core_pins.in) {
        return levels();
    }
    if (&word == &dma.channel[0].ctrl) {
        return word.value | (busy_ ? 1U << 26U : 0U);
    }
    if (&word == &resets.done) {
        return ~resets.reset.value;
    }
    if (&word == &uart0.fr) {
        return (uart_in.empty() ? 1U << 4U : 0U) | (uart_out.size() >= 32 ? 1U << 5U : 0U);
    }
    if (&word == &uart0.dr) {
        const std::uint32_t entry = uart_in.empty() ? 0 : uart_in.front();
        violations += uart_in.empty() ? 1U : 0U;
        if (!uart_in.empty()) {
            uart_in.pop_front();
        }
        return entry;
    }
    if (&word == &usb.ints) {
        const std::uint32_t status = usb.sie_status.value;
        return ((usb.buff_status.value != 0 ? 1U << 4U : 0U) | (status >> 19U & 1U) << 12U |
                (status >> 4U & 1U) << 14U | (status >> 11U & 1U) << 15U |
                (status >> 17U & 1U) << 16U) &
               usb.inte.value;
    }
    return word.value;
}

void PicoModel::on_write(PicoWord& word, std::uint32_t value)
{
    if (write_dma(word, value) || write_pio(word, value) || write_pins(word, value) ||
        write_usb(word, value)) {
        note_pins();
        return;
    }
    if (&word == &uart0.dr) {
        uart_out.push_back(static_cast<std::uint8_t>(value));
        return;
    }
    word.value = value;
    write_clock(word);
    note_pins();
}

bool PicoModel::write_dma(PicoWord& word, std::uint32_t value)
{
    auto& channel = dma.channel[0];
    if (&word == &channel.read_addr_start || &word == &channel.write_addr ||
        &word == &channel.count) {
        violations += busy_ ? 1U : 0U;
        word.value = value;
        if (&word == &channel.read_addr_start) {
            busy_ = true;
            fetched_ = 0;
            left_ = channel.count.value;
            feed();
        }
        return true;
    }
    if (&word == &channel.ctrl) {
        // 12.6.10: the error stays until both of its kinds are written.
        const std::uint32_t error = (value & 3U << 29U) != 0 ? 0 : word.value & 1U << 31U;
        word.value = (value & ~(7U << 29U)) | error;
        return true;
    }
    if (&word == &dma.abort) {
        // Erratum E5: the channel must be off.
        violations += (channel.ctrl.value & 1U) != 0 ? 1U : 0U;
        busy_ = false;
        return true;
    }
    if (&word == &dma.pending_0 || &word == &dma.raised) {
        dma.raised.value &= ~value;
        return true;
    }
    return false;
}

bool PicoModel::write_pio(PicoWord& word, std::uint32_t value)
{
    if (&word == &pio0.ctrl) {
        machine.on = (value & 1U) != 0;
        return true;
    }
    if (&word == &pio0.txf[0]) {
        machine.queue.push_back(value);
        return true;
    }
    if (&word == &pio0.machine[0].instr) {
        violations += machine.on ? 1U : 0U;
        machine.execute(value);
        machine.run_cycle();
        return true;
    }
    if (&word == &pio0.machine[0].shiftctrl) {
        if (((word.value ^ value) >> 30U) != 0) {
            machine.queue.clear();
        }
        word.value = value;
        return true;
    }
    return false;
}

bool PicoModel::write_pins(PicoWord& word, std::uint32_t value)
{
    if (&word == &core_pins.out_set) {
        core_pins.out.value |= value;
    } else if (&word == &core_pins.out_clear) {
        core_pins.out.value &= ~value;
    } else if (&word == &core_pins.enable_set) {
        core_pins.enable.value |= value;
    } else {
        return false;
    }
    return true;
}

bool PicoModel::write_usb(PicoWord& word, std::uint32_t value)
{
    if (&word == &usb.buff_status || &word == &usb.sie_status || &word == &usb.ep_abort_done) {
        word.value &= ~value;
        return true;
    }
    if (&word == &usb.ep_abort) {
        usb.ep_abort_done.value |= value;
        return true;
    }
    for (auto& buffer : usb_memory.buffer) {
        if (&word == &buffer) {
            // 12.7.3.7.1: the rest of the word before.
            const bool comes = (value & kAvailable) != 0 && (word.value & kAvailable) == 0;
            violations += comes && (word.value | kAvailable) != value ? 1U : 0U;
            word.value = value;
            return true;
        }
    }
    return false;
}

// Chapter 8: what is chosen is selected, and ready, where it works.
void PicoModel::write_clock(PicoWord& word)
{
    // 8.6: a clock that comes from a multiplier is off while that is in reset.
    const bool runs = ((clocks.peri.ctrl.value | clocks.usb.ctrl.value) & 1U << 11U) != 0;
    const bool multiplied = clocks.sys.selected.value != 1;
    if (&word == &resets.reset && (word.value >> 14U & 3U) != 0 && (runs || multiplied)) {
        ++violations;
    }
    if (&word == &crystal.ctrl) {
        crystal.status.value = crystal_works && word.value >> 12U == 0xFAB ? 1U << 31U : 0U;
    }
    for (auto* multiplier : {&core_multiplier, &usb_multiplier}) {
        if (&word == &multiplier->pwr && (word.value & 0x21U) == 0 && multipliers_work) {
            violations += (resets.reset.value >> 14U & 3U) != 0 ? 1U : 0U;
            multiplier->cs.value |= 1U << 31U;
        }
    }
    if (&word == &clocks.ref.ctrl) {
        const unsigned choice = word.value & 3U;
        violations += choice == 2 && crystal.status.value == 0 ? 1U : 0U;
        clocks.ref.selected.value = 1U << choice;
    }
    if (&word == &clocks.sys.ctrl) {
        const unsigned choice = word.value & 1U;
        violations += choice == 1 && core_multiplier.cs.value >> 31U == 0 ? 1U : 0U;
        clocks.sys.selected.value = 1U << choice;
    }
}

void PicoModel::erase_flash(std::uint32_t offset, std::uint32_t size)
{
    if (offset % 4096 != 0 || size % 4096 != 0 || offset < kFlashBytes - 8192 ||
        offset + size > kFlashBytes) {
        ++violations;
        return;
    }
    --power_left;
    if (power_left >= 0) {
        flash.erase(flash.lower_bound(offset), flash.lower_bound(offset + size));
    }
}

void PicoModel::program_flash(std::uint32_t offset, const hal::rp2350::FlashPage& page)
{
    if (offset % page.size() != 0 || offset < kFlashBytes - 8192 || offset >= kFlashBytes) {
        ++violations;
        return;
    }
    --power_left;
    if (power_left < 0) {
        return;
    }
    for (std::size_t i = 0; i < page.size(); ++i) {
        if (page[i] != 0xFF) {
            auto& byte = flash.emplace(offset + i, std::uint8_t{0xFF}).first->second;
            byte = static_cast<std::uint8_t>(byte & page[i]);
        }
    }
}

std::uint32_t PicoModel::read_memory(std::uint32_t address)
{
    std::uint32_t word = 0;
    for (unsigned i = 0; i < 4; ++i) {
        const auto found = flash.find(address - hal::rp2350::kFlashAddress + i);
        word |= (found == flash.end() ? 0xFFU : std::uint32_t{found->second}) << 8U * i;
    }
    return word;
}

}  // namespace cusp::test
