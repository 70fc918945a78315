// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the plain checks of the core share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include "acts_firmware/firmware.hpp"
#include "board/wired_board.hpp"

extern int failures;

#define CHECK(condition)                                                                 \
  do {                                                                                   \
    if (!(condition)) {                                                                  \
      std::fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, __LINE__, __func__, #condition); \
      ++failures;                                                                        \
    }                                                                                    \
  } while (false)

using Bytes = std::vector<std::uint8_t>;

// Each taxel reads its own index (modulo the ADC's range), a measurement takes 10 us.
class IndexBoard : public acts::WiredBoard {
 public:
  IndexBoard(int rows, int cols, std::uint32_t start_us = 0) : WiredBoard(rows, cols), cols_(cols), now_us_(start_us) {}

  void write_pin(std::uint8_t pin, bool high) override {
    levels_[pin] = high;
    WiredBoard::write_pin(pin, high);
  }
  std::uint16_t read_adc() override {
    now_us_ += 10;
    return static_cast<std::uint16_t>(adc_input());
  }
  std::uint32_t micros() override { return now_us_; }
  bool level(std::size_t pin) const { return levels_[pin]; }
  int high_pins(std::size_t first, std::size_t last) const {
    int count = 0;
    for (std::size_t pin = first; pin <= last; ++pin) {
      count += levels_[pin] ? 1 : 0;
    }
    return count;
  }

 protected:
  double taxel_counts(int row, int col) override { return (row * cols_ + col) % (acts::kCountMax + 1); }

 private:
  int cols_;
  std::uint32_t now_us_;
  std::array<bool, 256> levels_{};
};

// A firmware for the published wiring; all share the memory for models.
std::unique_ptr<acts::Firmware> make_firmware(acts::Board& board, acts::Protocol protocol = acts::Protocol::kBinary);

// So many bytes without a zero.
Bytes run_of(std::size_t length);

// Stuffed, without delimiter.
Bytes encoded(const Bytes& data);

// The number in `size` bytes.
std::uint64_t little_endian(const Bytes& bytes, std::size_t at, int size);

// Checks of another file than that of main().
void test_commands();
