// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// As much of an Arduino Mega as examples/arduino_16x16 uses, and a skin that is pressed at row 5, column 11.
// Its standard output is the serial line, at the pace of a real one. For test_own_array.py.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>

constexpr int INPUT = 0;
constexpr int OUTPUT = 1;
constexpr int LOW = 0;
constexpr int HIGH = 1;
constexpr int A0 = 54;

namespace model {

constexpr int PINS = 70;
constexpr double READING_US = 112;

inline int mode[PINS];
inline int level[PINS];
inline double now_us = 0;
inline const auto start = std::chrono::steady_clock::now();

inline double pressed(int row, int col) {
  const double distance = (row - 5) * (row - 5) + (col - 11) * (col - 11);
  return 600 * std::exp(-distance / 4);
}

}  // namespace model

inline void pinMode(int pin, int mode) {
  model::mode[pin] = mode;
}

inline void digitalWrite(int pin, int level) {
  if (model::mode[pin] == OUTPUT) {
    model::level[pin] = level;
  }
}

inline int analogRead(int pin) {
  model::now_us += model::READING_US;
  int col = 0;
  for (int bit = 0; bit < 4; bit++) {
    col |= model::level[4 + bit] << bit;
  }
  double sum = 0;
  for (int row = 0; row < 16; row++) {
    sum += model::level[22 + row] == HIGH ? model::pressed(row, col) : 0;
  }
  return pin == A0 ? std::min(1023, static_cast<int>(sum)) : 0;
}

inline unsigned long micros() {
  return static_cast<unsigned long>(model::now_us);
}

class SerialLine {
 public:
  void begin(unsigned long baud) { baud_ = static_cast<double>(baud); }
  void print(int value) { line_ += std::to_string(value); }
  void print(char character) { line_ += character; }

  void println(unsigned long value) {
    line_ += std::to_string(value) + "\r\n";
    model::now_us += static_cast<double>(line_.size()) * 10e6 / baud_;
    std::this_thread::sleep_until(model::start + std::chrono::microseconds(static_cast<long>(model::now_us)));
    for (size_t done = 0; done < line_.size();) {
      const ssize_t written = write(STDOUT_FILENO, line_.data() + done, line_.size() - done);
      if (written <= 0) {
        std::exit(0);
      }
      done += static_cast<size_t>(written);
    }
    line_.clear();
  }

 private:
  double baud_ = 0;
  std::string line_;
};

inline SerialLine Serial;

void setup();
void loop();

int main() {
  setup();
  while (true) {
    loop();
  }
}
