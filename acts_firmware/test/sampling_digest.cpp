// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What every scheme samples of made-up fields, a line with a digest for each: must be the same on the host and on the
// Teensy's processor.
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "acts_firmware/sampling/random.hpp"
#include "acts_firmware/sampling/sampler.hpp"

namespace {

constexpr int kFrames = 40;
constexpr std::uint64_t kFieldStream = 7;

// Noise with a pressed square in it that wanders from frame to frame.
class WanderingField final : public acts::TaxelReader {
 public:
  WanderingField(int rows, int cols) : rows_(rows), cols_(cols), random_(1, kFieldStream) { step(); }

  void step() {
    row_ = static_cast<int>(random_.below(static_cast<std::uint32_t>(rows_)));
    col_ = static_cast<int>(random_.below(static_cast<std::uint32_t>(cols_)));
    side_ = 1 + static_cast<int>(random_.below(9));
  }

  std::uint16_t measure(int row, int col) override {
    const bool pressed = row >= row_ && row < row_ + side_ && col >= col_ && col < col_ + side_;
    return static_cast<std::uint16_t>(random_.below(pressed ? acts::kCountMax + 1 : 120));
  }

 private:
  int rows_;
  int cols_;
  acts::Pcg32 random_;
  int row_ = 0;
  int col_ = 0;
  int side_ = 1;
};

// Fowler, Noll and Vo's FNV-1a.
class Digest {
 public:
  void add(unsigned value) {
    for (const unsigned byte : {value & 0xFFU, value >> 8U}) {
      hash_ = (hash_ ^ byte) * 1099511628211ULL;
    }
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

bool print_digest(const acts::SamplingConfig& config) {
  auto sampler = std::make_unique<acts::Sampler>();
  auto frame = std::make_unique<acts::SampleFrame>();
  if (sampler->configure(config) != acts::SettingField::kNone) {
    std::fputs("settings refused\n", stderr);
    return false;
  }
  WanderingField field(config.rows, config.cols);
  Digest digest;
  for (int i = 0; i < kFrames; ++i) {
    sampler->sample(field, *frame);
    for (std::size_t k = 0; k < frame->m; ++k) {
      digest.add(frame->indices[k]);
      digest.add(frame->counts[k]);
    }
    field.step();
  }
  std::printf("%dx%d scheme %d m %d order %d: %08" PRIx32 "%08" PRIx32 "\n", config.rows, config.cols,
              static_cast<int>(config.scheme), sampler->frame_size(), static_cast<int>(config.neighbour_order),
              static_cast<std::uint32_t>(digest.value() >> 32U), static_cast<std::uint32_t>(digest.value()));
  return true;
}

struct Size {
  int rows;
  int cols;
  int m;  // also of a uniform grid
};

}  // namespace

int main() {
  bool right = true;
  for (const Size& size : {Size{32, 32, 64}, Size{15, 7, 20}, Size{64, 64, 256}}) {
    for (const acts::SchemeInfo& scheme : acts::Schemes::kInfos) {
      for (const auto order : {acts::NeighbourOrder::kColumns, acts::NeighbourOrder::kRows}) {
        acts::SamplingConfig config;
        config.rows = size.rows;
        config.cols = size.cols;
        config.scheme = scheme.number;
        config.m = size.m;
        config.neighbour_order = order;
        config.set_own(acts::Hybrid::kAdaptiveQuota, size.m / 2);
        right = print_digest(config) && right;
      }
    }
  }
  return right ? 0 : 1;
}
