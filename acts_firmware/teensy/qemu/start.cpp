// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// From reset to main() on QEMU's Cortex-M7. A Teensy starts by its own core; this is for the tests alone.
#include <cstdint>
#include <cstdlib>

#include "semihosting.hpp"

extern "C" {

// From imxrt1062.ld; only their addresses mean something.
extern std::uint32_t code_begin, code_end, code_load, data_begin, data_end, data_load, bss_begin, bss_end, stack_top;

void __libc_init_array();
// main(), which C++ itself does not let anybody call.
int run_program(int argc, char** argv) __asm__("main");

// Called by the C library at the start and the end of a program; these classic sections are empty here.
void _init() {}
void _fini() {}

[[noreturn]] void start();
[[noreturn]] void fault();
}

namespace {

constexpr std::uintptr_t kVectorTableRegister = 0xE000ED08;
constexpr std::uintptr_t kCoprocessorRegister = 0xE000ED88;
constexpr std::uint32_t kFullFpuAccess = 0xFU << 20U;
constexpr std::size_t kSystemVectors = 16;

volatile std::uint32_t& hardware(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

using Handler = void (*)();

struct Vectors {
  std::uint32_t* stack;
  Handler handlers[kSystemVectors - 1];
};

__attribute__((section(".vectors"), used, aligned(128))) const Vectors vectors = {
    &stack_top,
    {start, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault}};

}  // namespace

// Runs from flash, while there is no code in ITCM yet: nothing may be called, and volatile keeps the compiler from
// making a memcpy of a loop.
__attribute__((section(".startup"))) void start() {
  *reinterpret_cast<volatile std::uint32_t*>(kCoprocessorRegister) = kFullFpuAccess;
  __asm__ volatile("dsb\n isb" ::: "memory");
  volatile std::uint32_t* to = &code_begin;
  for (const volatile std::uint32_t* from = &code_load; to < &code_end; ++from, ++to) {
    *to = *from;
  }
  to = &data_begin;
  for (const volatile std::uint32_t* from = &data_load; to < &data_end; ++from, ++to) {
    *to = *from;
  }
  for (to = &bss_begin; to < &bss_end; ++to) {
    *to = 0;
  }
  __asm__ volatile("dsb\n isb" ::: "memory");
  hardware(kVectorTableRegister) = reinterpret_cast<std::uintptr_t>(&vectors);
  __libc_init_array();
  const acts::Arguments arguments = acts::command_line();
  std::exit(run_program(arguments.count, arguments.values));
}

void fault() {
  acts::say_and_stop("the processor took a fault\n");
}
