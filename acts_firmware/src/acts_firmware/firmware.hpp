// The firmware as a whole: measure a frame, stamp it, queue it for the host.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/board/board.hpp"
#include "acts_firmware/board/clock.hpp"
#include "acts_firmware/board/scanner.hpp"
#include "acts_firmware/board/wiring.hpp"
#include "acts_firmware/frame.hpp"
#include "acts_firmware/sampling/sampler.hpp"
#include "acts_firmware/wire/packet.hpp"
#include "acts_firmware/wire/published_ascii.hpp"
#include "acts_firmware/wire/transmit_queue.hpp"

namespace acts {

enum class Protocol : std::uint8_t {
  kBinary,       // packets, docs/wire_protocol.md
  kRasterAscii,  // the authors' published raster sketch
};

// Large (about 260 KB): make it static, or on the heap at the start.
class Firmware {
 public:
  Firmware(Board& board, const Wiring& wiring, Protocol protocol);

  ConfigError configure(const SamplingConfig& config) { return sampler_.configure(config); }
  const Sampler& sampler() const { return sampler_; }

  // Measures one frame and queues it; drops it whole, and counts that, where the queue is full.
  const SampleFrame& measure_frame();

  // Frames that could not be measured in time: their numbers are used up, and they count as overruns.
  void skip_frames(std::uint32_t count);

  // A host has begun to read: forget what is left of the last one's stream and start with a delimiter.
  void start_stream();

  // Nobody reads: frames are measured on but not queued, and are no overruns.
  void stop_stream();

  TransmitQueue& output() { return output_; }
  std::uint32_t overruns() const { return overruns_; }

 private:
  void queue_frame();

  Board& board_;
  Scanner scanner_;
  Sampler sampler_;
  Protocol protocol_;
  ExtendedClock clock_;
  SampleFrame frame_;
  TransmitQueue output_;
  bool streaming_ = false;
  std::uint32_t sequence_ = 0;
  std::uint32_t overruns_ = 0;
  std::array<std::uint8_t, kMaxAsciiBytes> message_{};
  std::array<std::uint8_t, kMaxWireBytes> wire_{};
};

static_assert(kMaxAsciiBytes >= kMaxPacketBytes, "message_ holds either");
static_assert(TransmitQueue::kCapacity >= 2 * kMaxAsciiBytes, "the largest message must fit");

}  // namespace acts
