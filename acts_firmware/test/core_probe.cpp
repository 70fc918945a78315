// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The core behind C functions, for ctypes. Fields are measured through the model of the wiring.
#include <algorithm>
#include <cstdint>
#include <memory>

#include "acts_firmware/board/wiring.hpp"
#include "acts_firmware/sampling/division_order.hpp"
#include "acts_firmware/sampling/random.hpp"
#include "acts_firmware/sampling/sampler.hpp"
#include "acts_firmware/wire/command.hpp"
#include "acts_firmware/wire/packet.hpp"
#include "board/published_timing.hpp"
#include "board/wired_board.hpp"

namespace {

class StillBoard final : public acts::WiredBoard {
 public:
  StillBoard(int rows, int cols) : WiredBoard(rows, cols), cols_(cols) {}

  void show(const std::uint16_t* field) { field_ = field; }
  std::uint16_t read_adc() override { return static_cast<std::uint16_t>(adc_input()); }
  std::uint32_t micros() override { return 0; }

 protected:
  double taxel_counts(int row, int col) override { return field_[row * cols_ + col]; }

 private:
  int cols_;
  const std::uint16_t* field_ = nullptr;
};

struct Probe {
  explicit Probe(const acts::SamplingConfig& config)
      : board(config.rows, config.cols),
        scanner(board, acts::wiring_for(config.rows, config.cols)),
        refused(sampler.configure(config)) {}

  StillBoard board;
  acts::Scanner scanner;
  acts::Sampler sampler;
  acts::SampleFrame frame;
  acts::SettingField refused;
};

}  // namespace

extern "C" {

// `settings` as on the wire.
Probe* probe_new(const std::uint8_t* settings) {
  auto probe = std::make_unique<Probe>(acts::read_settings(settings).sampling);
  return probe->refused == acts::SettingField::kNone ? probe.release() : nullptr;
}

// `entries`: u16, little-endian. Non-zero where the map is in force.
int probe_arrange(Probe* probe, int rows, int cols, int no_skin, std::uint32_t crc32, const std::uint8_t* entries) {
  const bool taken = probe->sampler.put_map(0, entries, rows * cols);
  return taken && probe->sampler.finish_map(rows, cols, no_skin, crc32) ? 1 : 0;
}

void probe_free(Probe* probe) {
  delete probe;
}

int probe_sample(Probe* probe, const std::uint16_t* field, std::uint16_t* indices, std::uint16_t* counts) {
  probe->board.show(field);
  probe->sampler.sample(probe->scanner, probe->frame);
  std::copy_n(probe->frame.indices.begin(), probe->frame.m, indices);
  std::copy_n(probe->frame.counts.begin(), probe->frame.m, counts);
  return probe->frame.m;
}

int probe_division_order(int rows, int cols, std::uint16_t* out) {
  auto order = std::make_unique<acts::DivisionOrder>();
  order->build(rows, cols);
  for (int rank = 0; rank < order->size(); ++rank) {
    out[rank] = static_cast<std::uint16_t>((*order)[rank]);
  }
  return order->size();
}

void probe_spacing(int rows, int cols, int m, int* out) {
  const acts::Spacing spacing = acts::uniform_spacing(rows, cols, m);
  out[0] = spacing.row;
  out[1] = spacing.col;
}

int probe_quota_of(double share, int m) {
  return acts::quota_of(share, m);
}

double probe_published_sample_us(const std::uint8_t* settings) {
  return acts::published_sample_us(acts::read_settings(settings).sampling);
}

void probe_random(std::uint64_t seed, std::uint64_t stream, std::uint32_t bound, int count, std::uint32_t* out) {
  acts::Pcg32 random(seed, stream);
  for (int i = 0; i < count; ++i) {
    out[i] = bound == 0 ? random.next() : random.below(bound);
  }
}

std::size_t probe_cobs_encode(const std::uint8_t* data, std::size_t length, std::uint8_t* out) {
  return acts::cobs_encode(data, length, out);
}

std::size_t probe_cobs_decode(const std::uint8_t* data, std::size_t length, std::uint8_t* out) {
  return acts::cobs_decode(data, length, out);
}

std::size_t probe_encode(std::uint32_t sequence, std::uint64_t board_us, std::uint32_t duration_us,
                         std::uint32_t overruns, int scheme, int rows, int cols, int m, const std::uint16_t* indices,
                         const std::uint16_t* counts, std::uint8_t* out) {
  auto frame = std::make_unique<acts::SampleFrame>();
  frame->sequence = sequence;
  frame->board_us = board_us;
  frame->duration_us = duration_us;
  frame->overruns = overruns;
  frame->scheme = static_cast<acts::Scheme>(scheme);
  frame->rows = static_cast<std::uint8_t>(rows);
  frame->cols = static_cast<std::uint8_t>(cols);
  for (int i = 0; i < m; ++i) {
    frame->append(indices[i], counts[i]);
  }
  return acts::encode_samples(*frame, out);
}

}  // extern "C"
