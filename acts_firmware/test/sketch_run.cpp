// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Runs the sketch itself on a model of the Teensy and of the wiring, in virtual time, on the host or on the Teensy's
// processor under QEMU. The only argument names a script of lines
//
//   <time_us> open | close            the host opens or closes the port
//   <time_us> stall | read            it stops reading though the port is open; reads again
//   <time_us> press ROW COL COUNTS    this taxel reads so many counts from now on
//   <time_us> send HEX                bytes from the host
//   <time_us> hold US                 something holds the processor up for so long
//   <time_us> delay US                USB does so when the sketch next looks after it, between two frames
//   <time_us> end
//
// in the order of time. Prints `data <time_us> <hex>` for all the host read in a USB frame, and in the end a line each
// about the watchdog, the ADC, pins that were written without being outputs, and the LED.
#include <Arduino.h>

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <utility>

#include "board/wired_board.hpp"

volatile std::uint32_t CCM_CCGR3 = 0;
volatile std::uint16_t WDOG1_WCR = WDOG_WCR_WDA | WDOG_WCR_SRS;
volatile std::uint16_t WDOG1_WSR = 0;
volatile std::uint16_t WDOG1_WMCR = 1;
volatile std::uint32_t HW_OCOTP_MAC0 = 0xAB0012D6;

UsbSerial Serial;

namespace {

constexpr int kSide = 32;
constexpr std::int64_t kReadAdcNs = 17098;  // published, for a raster scan
constexpr std::int64_t kWritePinNs = 30;
constexpr std::int64_t kReadClockNs = 50;
constexpr std::int64_t kUsbFrameNs = 125000;
constexpr std::int64_t kOpenDelayNs = 15'000'000;  // from DTR until Serial is true
constexpr std::size_t kUsbBuffer = 3 * 2048;
constexpr std::size_t kPins = 55;
constexpr std::uint8_t kLed = 40;

struct Command {
  char verb[8] = "";
  std::int64_t time_ns = 0;
  char text[4200] = "";
};

class Model final : public acts::WiredBoard {
 public:
  Model() : WiredBoard(kSide, kSide) {}

  bool open_script(const char* path) {
    script_ = std::fopen(path, "r");
    return script_ != nullptr && next_command();
  }
  bool ended() const { return ended_; }

  void pass(std::int64_t ns) {
    now_ns_ += ns;
    while (!ended_ && command_.time_ns <= now_ns_) {
      obey();
    }
    for (; usb_ns_ <= now_ns_; usb_ns_ += kUsbFrameNs) {
      host_reads();
    }
    if ((WDOG1_WCR & WDOG_WCR_WDE) != 0 && WDOG1_WSR == 0xAAAA) {
      fed_ns_ = now_ns_;
      ++feeds_;
      WDOG1_WSR = 0;
    }
    if ((WDOG1_WCR & WDOG_WCR_WDE) != 0 && fed_ns_ >= 0) {
      hungry_ns_ = std::max(hungry_ns_, now_ns_ - fed_ns_);
    }
  }

  void make_output(std::uint8_t pin) { outputs_.at(pin) = true; }
  void write_pin(std::uint8_t pin, bool high) override {
    pass(kWritePinNs);
    if (pin >= kPins || !outputs_[pin]) {
      ++wrong_pins_;
    }
    if (pin == kLed) {
      led_changes_ += led_ != high ? 1 : 0;
      led_ = high;
      return;
    }
    WiredBoard::write_pin(pin, high);
  }
  std::uint16_t read_adc() override {
    const double counts = adc_input();
    pass(kReadAdcNs);
    return static_cast<std::uint16_t>(counts);
  }
  std::uint32_t micros() override {
    pass(kReadClockNs);
    return static_cast<std::uint32_t>(now_ns_ / 1000);
  }

  bool open() {
    now_ns_ += std::exchange(delay_ns_, 0);
    return open_ && now_ns_ - opened_ns_ >= kOpenDelayNs;
  }
  int room() const { return static_cast<int>(kUsbBuffer - std::min(kUsbBuffer, to_host_.size())); }
  void give_host(const std::uint8_t* data, std::size_t length) { to_host_.insert(to_host_.end(), data, data + length); }
  std::deque<std::uint8_t>& from_host() { return from_host_; }

  unsigned adc_bits = 0;
  unsigned adc_averaged = 0;

  void report(int loops) const {
    std::printf("watchdog %u %" PRId32 "\n", static_cast<unsigned>(WDOG1_WCR),
                static_cast<std::int32_t>(hungry_ns_ / 1000));
    std::printf("feeds %d\nloops %d\n", feeds_, loops);
    std::printf("adc %u %u\nwrong_pins %d\nled %d %d\n", adc_bits, adc_averaged, wrong_pins_, led_ ? 1 : 0,
                led_changes_);
  }

 protected:
  double taxel_counts(int row, int col) override { return field_[static_cast<std::size_t>(row * kSide + col)]; }

 private:
  bool next_command() {
    command_ = {};
    std::int32_t time_us = 0;
    char line[sizeof command_.text + 32];
    if (std::fgets(line, sizeof line, script_) == nullptr ||
        std::sscanf(line, "%" SCNd32 " %7s %4199[^\n]", &time_us, command_.verb, command_.text) < 2) {
      return false;
    }
    command_.time_ns = std::int64_t{time_us} * 1000;
    return true;
  }

  void obey() {
    const auto is = [this](const char* verb) { return std::strcmp(command_.verb, verb) == 0; };
    std::int64_t hold_ns = 0;
    if (is("open") || is("close")) {
      host_reads();  // Linux lowers DTR before it ceases to read; what a stalled host left comes out at the next
                     // opening
      open_ = reading_ = is("open");
      opened_ns_ = now_ns_;
    } else if (is("stall") || is("read")) {
      reading_ = is("read");
    } else if (is("press")) {
      int row = 0;
      int col = 0;
      int counts = 0;
      std::sscanf(command_.text, "%d %d %d", &row, &col, &counts);
      field_.at(static_cast<std::size_t>(row * kSide + col)) = counts;
    } else if (is("send")) {
      unsigned byte = 0;
      for (const char* hex = command_.text; std::sscanf(hex, "%2x", &byte) == 1; hex += 2) {
        from_host_.push_back(static_cast<std::uint8_t>(byte));
      }
    } else if (is("hold") || is("delay")) {
      int for_us = 0;
      std::sscanf(command_.text, "%d", &for_us);
      (is("hold") ? hold_ns : delay_ns_) = std::int64_t{for_us} * 1000;
    } else {
      ended_ = true;
    }
    ended_ = !next_command() || ended_;
    now_ns_ += hold_ns;
  }

  void host_reads() {
    if (!reading_ || to_host_.empty()) {
      return;
    }
    std::printf("data %" PRId32 " ", static_cast<std::int32_t>(usb_ns_ / 1000));
    for (const std::uint8_t byte : to_host_) {
      std::printf("%02x", byte);
    }
    std::printf("\n");
    to_host_.clear();
  }

  std::FILE* script_ = nullptr;
  Command command_;
  bool ended_ = false;
  std::int64_t now_ns_ = 0;
  std::int64_t usb_ns_ = 0;
  std::int64_t opened_ns_ = 0;
  std::int64_t fed_ns_ = -1;
  std::int64_t hungry_ns_ = 0;
  int feeds_ = 0;  // how often the watchdog had been fed when the sketch took time next
  std::int64_t delay_ns_ = 0;
  bool open_ = false;
  bool reading_ = false;
  bool led_ = false;
  int led_changes_ = 0;
  int wrong_pins_ = 0;
  std::array<bool, kPins> outputs_{};
  std::array<int, kSide * kSide> field_{};
  std::deque<std::uint8_t> to_host_;
  std::deque<std::uint8_t> from_host_;
};

Model model;

}  // namespace

void pinMode(std::uint8_t pin, std::uint8_t mode) {
  if (mode == OUTPUT) {
    model.make_output(pin);
  }
}
void digitalWriteFast(std::uint8_t pin, std::uint8_t level) {
  model.write_pin(pin, level == HIGH);
}
int analogRead(std::uint8_t pin) {
  return pin == A0 ? model.read_adc() : 0;
}
void analogReadResolution(unsigned bits) {
  model.adc_bits = bits;
}
void analogReadAveraging(unsigned count) {
  model.adc_averaged = count;
}
std::uint32_t micros() {
  return model.micros();
}

UsbSerial::operator bool() {
  return model.open();
}
int UsbSerial::available() {
  return static_cast<int>(model.from_host().size());
}
std::size_t UsbSerial::readBytes(char* out, std::size_t length) {
  std::deque<std::uint8_t>& bytes = model.from_host();
  length = std::min(length, bytes.size());
  std::copy_n(bytes.begin(), length, out);
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
  return length;
}
int UsbSerial::availableForWrite() {
  return model.room();
}
std::size_t UsbSerial::write(const std::uint8_t* data, std::size_t length) {
  model.give_host(data, length);
  return length;
}
void UsbSerial::send_now() {}

int main(int argc, char** argv) {
  if (argc != 2 || !model.open_script(argv[1])) {
    std::fputs("sketch_run: no script, or none that can be read\n", stderr);
    return 2;
  }
  setup();
  int loops = 0;
  for (; !model.ended(); ++loops) {
    loop();
  }
  model.report(loops);
  return 0;
}
