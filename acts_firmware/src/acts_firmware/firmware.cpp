// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/firmware.hpp"

#include "acts_firmware/wire/results.hpp"

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
    refused = sampler_.configure(settings.sampling);
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

bool Firmware::recover_frame() {
  const Output output = active_output();
  const SamplingConfig& sampling = settings_.sampling;
  // The host may have set another array since the frame was measured.
  const bool current = frame_.rows == sampling.rows && frame_.cols == sampling.cols;
  if (output == Output::kSamples || !current || !streaming_ || protocol_ != Protocol::kBinary) {
    return false;
  }
  const std::uint64_t start_us = clock_.extend(board_.micros());
  std::size_t length = 0;
  if (output == Output::kImage) {
    const float* counts = model_output_.image(models_.model(), frame_, settings_.touch_counts, board_);
    if (counts == nullptr) {
      return false;
    }
    length = encode_recovered(counts, start_us);
  } else {
    length = encode_recognised(model_output_.object(models_.model(), frame_, settings_.touch_counts), start_us);
  }
  queue_packet(length);  // where the host does not keep up this one is missing: its frame's number tells
  return true;
}

std::uint32_t Firmware::computed_since(std::uint64_t start_us) {
  board_.computed();
  return static_cast<std::uint32_t>(clock_.extend(board_.micros()) - start_us);
}

std::size_t Firmware::encode_recovered(const float* counts, std::uint64_t start_us) {
  RecoveredImage image;
  image.sequence = frame_.sequence;
  image.board_us = frame_.board_us;
  image.duration_us = computed_since(start_us);
  image.rows = frame_.rows;
  image.cols = frame_.cols;
  image.counts = counts;
  return encode_image(image, message_.data());
}

std::size_t Firmware::encode_recognised(const ObjectResult& result, std::uint64_t start_us) {
  RecognisedObject object;
  object.sequence = frame_.sequence;
  object.board_us = frame_.board_us;
  object.duration_us = computed_since(start_us);
  object.object = result.touched ? result.best : -1;
  object.objects = result.classes;
  object.residuals = result.residuals.data();
  return encode_object(object, message_.data());
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
