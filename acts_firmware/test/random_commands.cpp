// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Thousands of random commands to the firmware, right ones and wrong ones, with frames and recoveries between them. The
// program is built with sanitizers (target/test_sanitized_core.py), which end it at what C++ leaves undefined.
#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <vector>

#include "acts_firmware/firmware.hpp"
#include "acts_firmware/sampling/random.hpp"
#include "board/wired_board.hpp"

namespace {

using Bytes = std::vector<std::uint8_t>;

acts::Pcg32 source(1, 1);

std::uint32_t below(std::uint32_t bound) {
  return source.below(bound);
}

std::uint32_t one_of(std::initializer_list<std::uint32_t> values) {
  return values.begin()[below(static_cast<std::uint32_t>(values.size()))];
}

void put(Bytes& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFFU));
  }
}

Bytes noise(std::uint32_t longest) {
  Bytes bytes(below(longest));
  std::generate(bytes.begin(), bytes.end(), [] { return static_cast<std::uint8_t>(below(256)); });
  return bytes;
}

// Readings without a pattern, of a clock that soon wraps.
class RandomBoard final : public acts::WiredBoard {
 public:
  using WiredBoard::WiredBoard;
  std::uint16_t read_adc() override {
    now_us_ += below(40);
    return static_cast<std::uint16_t>(adc_input());
  }
  std::uint32_t micros() override { return now_us_; }

 protected:
  double taxel_counts(int /*row*/, int /*col*/) override { return below(4) == 0 ? 0.0 : below(1024); }

 private:
  std::uint32_t now_us_ = 0xFFFFF000U;
};

// As on the wire; one in a hundred is damaged.
Bytes packet(std::uint32_t type, const Bytes& body) {
  Bytes plain;
  put(plain, type, 1);
  put(plain, acts::kPacketVersion, 1);
  put(plain, acts::kCommandHeadBytes + body.size() + acts::kPacketCrcBytes, 2);
  put(plain, below(1000), 4);
  plain.insert(plain.end(), body.begin(), body.end());
  put(plain, acts::crc32(plain.data(), plain.size()), 4);
  Bytes wire(acts::cobs_bytes_max(plain.size()));
  wire.resize(acts::cobs_encode(plain.data(), plain.size(), wire.data()));
  wire.push_back(acts::kDelimiter);
  if (below(100) == 0) {
    wire[below(static_cast<std::uint32_t>(wire.size()))] ^= 0x10U;
  }
  return wire;
}

Bytes configure(const acts::SamplingConfig& present) {
  const bool same = below(2) == 0;
  const std::uint32_t rows = same ? static_cast<std::uint32_t>(present.rows) : 1 + below(64);
  const std::uint32_t cols = same ? static_cast<std::uint32_t>(present.cols) : 1 + below(64);
  const std::uint32_t m = one_of({1, 1 + below(64), 1 + below(rows * cols), rows * cols, rows * cols + 1});
  Bytes body;
  put(body, rows, 1);
  put(body, cols, 1);
  put(body, 1 + below(8), 1);
  put(body, below(2), 1);
  put(body, m, 2);
  put(body, one_of({0, 180, 1023, 1024}), 2);
  put(body, one_of({1, 1 + below(m), m}), 2);
  put(body, one_of({1, 1 + below(m), m}), 2);
  put(body, one_of({0, 60, 1023}), 2);
  put(body, below(3), 1);
  put(body, below(5), 1);
  put(body, one_of({0, 1000, 1'000'000, 1'000'001}), 4);
  put(body, below(1000), 8);
  put(body, below(rows), 2);
  put(body, below(cols), 2);
  put(body, one_of({0, 1, 5, 4096}), 2);
  return packet(17, body);
}

// A map of the skin with every taxel once; some end with a wrong checksum.
std::vector<Bytes> arrange(const acts::SamplingConfig& present) {
  const auto taxels = static_cast<std::uint32_t>(present.taxels());
  std::vector<std::uint32_t> order(taxels);
  for (std::uint32_t i = 0; i < taxels; ++i) {
    order[i] = i;
    std::swap(order[i], order[below(i + 1)]);
  }
  Bytes head;
  put(head, static_cast<std::uint32_t>(present.rows), 1);
  put(head, static_cast<std::uint32_t>(present.cols), 1);
  put(head, one_of({255, below(20)}), 1);
  put(head, 0, 1);
  Bytes entries;
  for (const std::uint32_t taxel : order) {
    put(entries, taxel | below(16) << 12U, 2);
  }
  put(head, acts::crc32(entries.data(), entries.size(), acts::crc32(head.data(), head.size())) + below(8) / 7, 4);
  std::vector<Bytes> packets;
  for (std::size_t place = 0; place < taxels; place += acts::kMaxMapPiece) {
    Bytes body;
    put(body, place, 2);
    const std::size_t end = std::min(2 * (place + acts::kMaxMapPiece), entries.size());
    body.insert(body.end(), entries.begin() + static_cast<std::ptrdiff_t>(2 * place),
                entries.begin() + static_cast<std::ptrdiff_t>(end));
    packets.push_back(packet(21, body));
  }
  packets.push_back(packet(22, head));
  return packets;
}

// A dictionary of patches, or a library of the present array; entries from tiny to huge.
std::vector<Bytes> upload(const acts::SamplingConfig& present) {
  const bool library = below(2) == 0;
  const std::uint32_t side = 1 + below(8);
  const std::uint32_t rows = library ? static_cast<std::uint32_t>(present.taxels()) : side * side;
  const std::uint32_t columns = 1 + below(std::min(200U, 60000U / rows));
  const std::uint32_t objects = library ? 1 + below(std::min(64U, columns)) : 0;
  Bytes model;
  for (std::uint32_t i = 0; i < rows * columns; ++i) {
    put(model, (below(2) << 31U) | (below(250) << 23U) | below(1U << 23U), 4);  // a finite float
  }
  for (std::uint32_t i = 0; library && i < columns; ++i) {
    put(model, i % objects, 1);
  }
  Bytes head;
  put(head, library ? 2 : 1, 1);
  put(head, library ? 0 : side, 1);
  put(head, library ? 0 : 1 + below(side), 1);
  put(head, objects, 1);
  put(head, rows, 2);
  put(head, columns, 2);
  put(head, model.size(), 4);
  put(head, acts::crc32(model.data(), model.size()), 4);
  std::vector<Bytes> packets = {packet(18, head)};
  for (std::size_t at = 0; at < model.size(); at += acts::kMaxUploadPiece) {
    Bytes body;
    put(body, at, 4);
    const std::size_t end = std::min(at + acts::kMaxUploadPiece, model.size());
    body.insert(body.end(), model.begin() + static_cast<std::ptrdiff_t>(at),
                model.begin() + static_cast<std::ptrdiff_t>(end));
    packets.push_back(packet(19, body));
  }
  packets.push_back(packet(20, {}));
  return packets;
}

// A piece of a map or of a model that belongs anywhere, also beyond the end.
Bytes stray() {
  const bool map = below(2) == 0;
  Bytes body;
  put(body, map ? below(acts::kMaxTaxels + 100) : below(acts::kModelBytes + 100), map ? 2 : 4);
  const Bytes rest = noise(1024);
  body.insert(body.end(), rest.begin(), rest.end());
  return packet(map ? 21 : 19, body);
}

std::vector<Bytes> something(const acts::SamplingConfig& present) {
  switch (below(9)) {
    case 0:
      return arrange(present);
    case 1:
      return upload(present);
    case 2:
      return {noise(3000)};
    case 3:
      return {packet(below(30), noise(1200))};
    case 4:
      return {packet(16, {})};
    case 5:
      return {packet(22, Bytes(8))};  // no map
    case 6:
      return {stray()};
    default:
      return {configure(present)};
  }
}

// Whether the frame is as large as was told, and of taxels of its array.
bool is_sound(const acts::SampleFrame& frame, const acts::Sampler& sampler) {
  return frame.m == sampler.frame_size() && std::all_of(frame.indices.begin(), frame.indices.begin() + frame.m,
                                                        [&](int taxel) { return taxel < frame.rows * frame.cols; });
}

void read_some(acts::TransmitQueue& output) {
  while (below(3) != 0 && output.size() > 0) {
    output.pop(1 + below(static_cast<std::uint32_t>(output.front().length)));
  }
}

// A host's life with a board; false where a frame is not sound.
bool live(acts::ModelMemory& models) {
  const bool wide = below(2) == 0;
  const int most = wide ? 64 : 32;
  RandomBoard board(1 + static_cast<int>(below(static_cast<std::uint32_t>(most))),
                    1 + static_cast<int>(below(static_cast<std::uint32_t>(most))));
  const auto firmware =
      std::make_unique<acts::Firmware>(board, wide ? acts::wide_wiring() : acts::published_wiring(),
                                       below(20) == 0 ? acts::Protocol::kRasterAscii : acts::Protocol::kBinary, models);
  firmware->start_stream();
  for (int step = 0; step < 60; ++step) {
    for (const Bytes& bytes : something(firmware->settings().sampling)) {
      firmware->receive(bytes.data(), bytes.size());
    }
    for (std::uint32_t frames = below(4); frames > 0; --frames) {
      if (!is_sound(firmware->measure_frame(), firmware->sampler())) {
        return false;
      }
      firmware->recover_frame();
    }
    read_some(firmware->output());
    if (below(20) == 0) {
      firmware->stop_stream();
    } else if (below(10) == 0) {
      firmware->start_stream();
    }
  }
  return true;
}

}  // namespace

int main() {
  const auto models = std::make_unique<acts::ModelMemory>();
  for (int life = 0; life < 60; ++life) {
    if (!live(*models)) {
      std::fprintf(stderr, "an unsound frame in life %d\n", life);
      return 1;
    }
  }
  return 0;
}
