# A second architecture for the core and its tests: riscv64 Linux programs, run under qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR riscv64)
set(CMAKE_CXX_COMPILER riscv64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-riscv64;-L;/usr/riscv64-linux-gnu)
# Atomic operations on bytes are functions here.
set(CMAKE_CXX_STANDARD_LIBRARIES_INIT -latomic)
