#include "acts_firmware/firmware.hpp"

namespace acts {

Firmware::Firmware(Board& board, const Wiring& wiring, Protocol protocol)
    : board_(board), scanner_(board, wiring), protocol_(protocol) {}

const SampleFrame& Firmware::measure_frame() {
  const std::uint64_t start_us = clock_.extend(board_.micros());
  sampler_.sample(scanner_, frame_);
  frame_.board_us = clock_.extend(board_.micros());
  frame_.duration_us = static_cast<std::uint32_t>(frame_.board_us - start_us);
  frame_.sequence = sequence_++;
  frame_.overruns = overruns_;
  if (streaming_) {
    queue_frame();
  }
  return frame_;
}

void Firmware::queue_frame() {
  bool queued = false;
  if (protocol_ == Protocol::kRasterAscii) {
    const std::size_t length = encode_raster_line(frame_, message_.data());
    queued = output_.push(message_.data(), length);
  } else {
    const std::size_t length = encode_samples(frame_, message_.data());
    const std::size_t stuffed = cobs_encode(message_.data(), length, wire_.data());
    wire_[stuffed] = kDelimiter;
    queued = output_.push(wire_.data(), stuffed + 1);
  }
  if (!queued) {
    ++overruns_;
  }
}

void Firmware::skip_frames(std::uint32_t count) {
  sequence_ += count;
  overruns_ += count;
}

void Firmware::start_stream() {
  output_.clear();
  streaming_ = true;
  if (protocol_ == Protocol::kBinary) {
    output_.push(&kDelimiter, 1);
  }
}

void Firmware::stop_stream() {
  output_.clear();
  streaming_ = false;
}

}  // namespace acts
