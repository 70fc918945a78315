// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The firmware as a whole: measure a frame, stamp it, queue it for the host; do what the host says.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "acts_firmware/board/board.hpp"
#include "acts_firmware/board/clock.hpp"
#include "acts_firmware/board/scanner.hpp"
#include "acts_firmware/board/wiring.hpp"
#include "acts_firmware/frame.hpp"
#include "acts_firmware/led.hpp"
#include "acts_firmware/model/model_store.hpp"
#include "acts_firmware/recovery/model_output.hpp"
#include "acts_firmware/sampling/sampler.hpp"
#include "acts_firmware/settings.hpp"
#include "acts_firmware/wire/command.hpp"
#include "acts_firmware/wire/packet.hpp"
#include "acts_firmware/wire/packet_receiver.hpp"
#include "acts_firmware/wire/published_ascii.hpp"
#include "acts_firmware/wire/results.hpp"
#include "acts_firmware/wire/transmit_queue.hpp"

namespace acts {

enum class Protocol : std::uint8_t {
  kBinary,       // packets, docs/wire_protocol.md
  kRasterAscii,  // the authors' published raster sketch, which listens to nobody
};

// Large (325 KB, and the memory for models): make it static, or on the heap at the start.
class Firmware {
 public:
  Firmware(Board& board, const Wiring& wiring, Protocol protocol, ModelMemory& models);

  // Takes the settings over as a whole, or says which one is refused and leaves everything as it was. Where only
  // others than those of sampling change, sampling goes on undisturbed.
  SettingField configure(const Settings& settings);
  const Settings& settings() const { return settings_; }
  const Sampler& sampler() const { return sampler_; }

  // Takes bytes from the host, cut anywhere, carries out the commands that they complete and queues the replies. May
  // change settings(): look at them again for the next frame.
  void receive(const std::uint8_t* data, std::size_t length);

  // Measures one frame and queues it; drops it whole, and counts that, where the queue is full.
  const SampleFrame& measure_frame();

  // Makes of the frame measured last what settings().output says besides samples, and queues it. True where there was
  // anything to do. Apart from measure_frame(), so that samples can be sent before this takes its time.
  bool recover_frame();

  // Frames that could not be measured in time: their numbers are used up, and they count as overruns.
  void skip_frames(std::uint32_t count);

  // Looks at the clock. Due at least once in 71 min, the wrap of micros(), where no frames are measured.
  void keep_time() { clock_.extend(board_.micros()); }

  // A host has begun to read: forget what is left of the last one's stream and start with a delimiter. Settings and
  // model stay.
  void start_stream();

  // Nobody reads: frames are measured on but not queued, and are no overruns.
  void stop_stream();

  TransmitQueue& output() { return output_; }
  std::uint32_t overruns() const { return overruns_; }

  // What was uploaded, and what can be sent with it: settings().output, or samples only where the model does not fit.
  const ModelStore& models() const { return models_; }
  Output active_output() const;

 private:
  // Replies that the queue to the host has no room for yet. When these are full as well, commands are not carried out.
  static constexpr std::size_t kMaxWaitingAnswers = 32;

  void queue_frame();
  bool queue_packet(std::size_t length);
  std::size_t encode_recovered(const float* counts, std::uint64_t start_us);
  std::size_t encode_recognised(const ObjectResult& result, std::uint64_t start_us);
  std::uint32_t computed_since(std::uint64_t start_us);

  void take_packet();
  Answer execute(const Command& command);
  Answer take_settings(const Command& command, Answer answer);
  Answer take_upload(const Command& command, Answer answer);
  Answer take_map(const Command& command, Answer answer);
  void send_answers();

  Board& board_;
  Wiring wiring_;
  Scanner scanner_;
  Led led_;
  Sampler sampler_;
  Settings settings_;
  ModelStore models_;
  ModelOutput model_output_;
  Protocol protocol_;
  ExtendedClock clock_;
  SampleFrame frame_;
  TransmitQueue output_;
  PacketReceiver receiver_;
  std::array<Answer, kMaxWaitingAnswers> answers_{};
  std::size_t first_answer_ = 0;
  std::size_t waiting_answers_ = 0;
  bool streaming_ = false;
  std::uint32_t sequence_ = 0;
  std::uint32_t overruns_ = 0;
  std::uint32_t bad_commands_ = 0;
  std::array<std::uint8_t, kMaxAsciiBytes> message_{};
  std::array<std::uint8_t, kMaxWireBytes> wire_{};
};

static_assert(kMaxPacketBytes >= kMaxImageBytes && kMaxPacketBytes >= kMaxObjectBytes && kMaxPacketBytes >= kReplyBytes,
              "message_ and wire_ hold any packet");
static_assert(kMaxAsciiBytes >= kMaxPacketBytes, "message_ holds either protocol's");
static_assert(TransmitQueue::kCapacity >= 2 * kMaxAsciiBytes, "the largest message must fit");

}  // namespace acts
