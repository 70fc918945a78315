#include "acts_firmware/firmware.hpp"

namespace acts {

Firmware::Firmware(Board& board, const Wiring& wiring, Protocol protocol, ModelMemory& models)
    : board_(board),
      wiring_(wiring),
      scanner_(board, wiring),
      led_(board, wiring.led_pin),
      models_(models),
      protocol_(protocol) {}

SettingField Firmware::configure(const Settings& settings) {
  SettingField refused = out_of_range(settings, wiring_.lines);
  if (refused == SettingField::kNone && !(settings.sampling == settings_.sampling)) {
    refused = field_of(sampler_.configure(settings.sampling));
  }
  if (refused == SettingField::kNone) {
    settings_ = settings;
    led_.show(settings_.led);
  }
  return refused;
}

const SampleFrame& Firmware::measure_frame() {
  const std::uint64_t start_us = clock_.extend(board_.micros());
  sampler_.sample(scanner_, frame_);
  frame_.board_us = clock_.extend(board_.micros());
  frame_.duration_us = static_cast<std::uint32_t>(frame_.board_us - start_us);
  frame_.sequence = sequence_++;
  frame_.overruns = overruns_;
  led_.show(settings_.led, frame_, settings_.touch_counts);
  if (streaming_) {
    send_answers();  // first, or a slow host would never see them behind its frames
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
    queued = queue_packet(encode_samples(frame_, message_.data()));
  }
  if (!queued) {
    ++overruns_;
  }
}

bool Firmware::queue_packet(std::size_t length) {
  const std::size_t stuffed = cobs_encode(message_.data(), length, wire_.data());
  wire_[stuffed] = kDelimiter;
  return output_.push(wire_.data(), stuffed + 1);
}

void Firmware::skip_frames(std::uint32_t count) {
  sequence_ += count;
  overruns_ += count;
}

void Firmware::start_stream() {
  output_.clear();
  receiver_.reset();
  waiting_answers_ = 0;
  streaming_ = true;
  if (protocol_ == Protocol::kBinary) {
    output_.push(&kDelimiter, 1);
  }
}

void Firmware::stop_stream() {
  output_.clear();
  waiting_answers_ = 0;
  streaming_ = false;
}

Output Firmware::active_output() const {
  const Model& model = models_.model();
  const SamplingConfig& sampling = settings_.sampling;
  bool fits = true;
  switch (settings_.output) {
    case Output::kSamples:
      break;
    case Output::kImage:
      fits = model.kind == ModelKind::kPatchDictionary && model.patch_side <= sampling.rows &&
             model.patch_side <= sampling.cols;
      break;
    case Output::kObject:
      fits = model.kind == ModelKind::kObjectLibrary && model.rows == sampling.rows * sampling.cols;
      break;
  }
  return fits ? settings_.output : Output::kSamples;
}

}  // namespace acts
