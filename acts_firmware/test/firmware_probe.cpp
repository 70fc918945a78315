// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// A whole firmware behind C functions, for ctypes: bytes in, bytes out, frames of a still field.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "acts_firmware/board/wiring.hpp"
#include "acts_firmware/firmware.hpp"
#include "acts_firmware/wire/results.hpp"
#include "board/wired_board.hpp"

namespace {

constexpr std::uint32_t kMeasurementUs = 10;

// Every taxel has the same counts; a measurement takes 10 us.
class EvenBoard final : public acts::WiredBoard {
 public:
  EvenBoard(int side, std::uint64_t id) : WiredBoard(side, side, id), led_pin_(acts::wiring_for(side, side).led_pin) {}

  void press(std::uint16_t counts) { counts_ = counts; }
  bool led() const { return led_; }
  void write_pin(std::uint8_t pin, bool high) override {
    WiredBoard::write_pin(pin, high);
    if (pin == led_pin_) {
      led_ = high;
    }
  }
  std::uint16_t read_adc() override {
    now_us_ += kMeasurementUs;
    return static_cast<std::uint16_t>(adc_input());
  }
  std::uint32_t micros() override { return now_us_; }

 protected:
  double taxel_counts(int /*row*/, int /*col*/) override { return counts_; }

 private:
  std::uint8_t led_pin_;
  std::uint16_t counts_ = 0;
  std::uint32_t now_us_ = 0;
  bool led_ = false;
};

struct FirmwareProbe {
  FirmwareProbe(int side, std::uint64_t id)
      : board(side, id), firmware(board, acts::wiring_for(side, side), acts::Protocol::kBinary, models) {}

  EvenBoard board;
  acts::ModelMemory models{};
  acts::Firmware firmware;
};

}  // namespace

extern "C" {

FirmwareProbe* firmware_new(int side, std::uint64_t id) {
  return std::make_unique<FirmwareProbe>(side, id).release();
}

void firmware_free(FirmwareProbe* probe) {
  delete probe;
}

void firmware_start_stream(FirmwareProbe* probe) {
  probe->firmware.start_stream();
}

void firmware_stop_stream(FirmwareProbe* probe) {
  probe->firmware.stop_stream();
}

void firmware_receive(FirmwareProbe* probe, const std::uint8_t* data, std::size_t length) {
  probe->firmware.receive(data, length);
}

void firmware_measure(FirmwareProbe* probe, int counts) {
  probe->board.press(static_cast<std::uint16_t>(counts));
  probe->firmware.measure_frame();
}

std::size_t firmware_read(FirmwareProbe* probe, std::uint8_t* out, std::size_t room) {
  acts::TransmitQueue& output = probe->firmware.output();
  std::size_t written = 0;
  while (written < room && output.size() > 0) {
    const acts::TransmitQueue::Piece piece = output.front();
    const std::size_t length = std::min(piece.length, room - written);
    std::copy_n(piece.data, length, out + written);
    output.pop(length);
    written += length;
  }
  return written;
}

int firmware_led(const FirmwareProbe* probe) {
  return probe->board.led() ? 1 : 0;
}

int firmware_active_output(const FirmwareProbe* probe) {
  return static_cast<int>(probe->firmware.active_output());
}

// Copies the model in force, values then class numbers; returns its bytes.
std::size_t firmware_model(const FirmwareProbe* probe, std::uint8_t* out) {
  const acts::Model& model = probe->firmware.models().model();
  if (model.values == nullptr) {
    return 0;
  }
  const std::size_t bytes = std::size_t{4} * model.rows * model.columns;
  std::copy_n(reinterpret_cast<const std::uint8_t*>(model.values), bytes, out);
  if (model.classes == nullptr) {
    return bytes;
  }
  std::copy_n(model.classes, model.columns, out + bytes);
  return bytes + model.columns;
}

std::size_t encode_image(std::uint32_t sequence, std::uint64_t board_us, std::uint32_t duration_us, int rows, int cols,
                         const float* counts, std::uint8_t* out) {
  return acts::encode_image({sequence, board_us, duration_us, rows, cols, counts}, out);
}

std::size_t encode_object(std::uint32_t sequence, std::uint64_t board_us, std::uint32_t duration_us, int object,
                          int objects, const float* residuals, std::uint8_t* out) {
  return acts::encode_object({sequence, board_us, duration_us, object, objects, residuals}, out);
}

}  // extern "C"
