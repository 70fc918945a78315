// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "process.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "acts_firmware/board/pacer.hpp"
#include "board/published_recovery.hpp"
#include "board/published_timing.hpp"
#include "option_error.hpp"

namespace acts {

namespace {

// Later than this, frames are skipped, as on a Teensy. Up to then the board measures afterwards what the field was, as
// if it had not stood still: a board of its own does not, where a busy host's core does. The ring holds more than this.
constexpr std::int64_t kCatchUpNs = std::int64_t{FramePacer::kCatchUpUs} * 1000;
constexpr std::int64_t kNapNs = 50'000'000;  // the terminal is looked after at least this often
// And this often while a packet waits for room there: the largest is twice what a terminal takes at once.
constexpr std::int64_t kSendingNapNs = 1'000'000;

// A terminal's Ctrl-C and `ros2 launch` signal all processes together. The host is to close its port before the board
// is gone, and `ros2 launch` reports code 255 for a process that ends while it sends a signal itself.
constexpr std::int64_t kGoOnNs = 300'000'000;

std::unique_ptr<Field> make_field(const Options& options, std::int64_t start_ns) {
  const SamplingConfig& sampling = options.sampling;
  if (!options.recording.empty()) {
    try {
      return open_recording(options.recording, sampling.rows, sampling.cols, options.recording_rate_hz, options.loop,
                            start_ns);
    } catch (const std::runtime_error& error) {
      throw OptionError(std::string("--recording ") + error.what());
    }
  }
  if (!options.field_ring.empty()) {
    return watch_ring(options.field_ring, static_cast<std::size_t>(sampling.rows * sampling.cols));
  }
  return std::make_unique<UntouchedField>();
}

Settings settings_of(const Options& options) {
  constexpr double kRounding = 1e-6;  // so that a rate of 1 / (333 us) does not become 334 us
  Settings settings;
  settings.sampling = options.sampling;
  settings.frame_period_us = static_cast<std::uint32_t>(std::ceil(1e6 / options.rate_hz - kRounding));
  return settings;
}

}  // namespace

Process::Process(const Options& options, const volatile std::sig_atomic_t& stop_requested)
    : options_(options),
      stop_requested_(stop_requested),
      epoch_(read_epoch()),
      time_(epoch_.monotonic_ns, options.drift_ppm),
      field_(make_field(options, epoch_.monotonic_ns)),
      claim_(options.link.empty() ? nullptr : std::make_unique<Claim>(options.link)),
      terminal_(options.link),
      link_(options.sampling.seed, options.protocol,
            [this](const Fault& fault, bool is_over) { report(fault, is_over); }) {
  if (!options.control.empty()) {
    control_ = std::make_unique<ControlPipe>(options.control);
  }
  for (const Fault& fault : options.faults) {
    plan_.add(fault);
  }
  power_up(epoch_.monotonic_ns);
}

void Process::power_up(std::int64_t monotonic_ns) {
  const SamplingConfig& sampling = options_.sampling;
  time_ = BoardTime(monotonic_ns, options_.drift_ppm);
  firmware_.reset();  // before the board that it holds on to
  board_ = std::make_unique<VirtualBoard>(sampling.rows, sampling.cols, *field_, time_, options_.noise_counts,
                                          sampling.seed, options_.board_id);
  board_->set_faults(options_.wiring_faults);
  firmware_ = std::make_unique<Firmware>(*board_, wiring_for(sampling.rows, sampling.cols), options_.protocol, models_);
  firmware_->configure(settings_of(options_));
  start_ns_ = 0;
  last_start_ns_ = 0;
  set_pace();
}

void Process::set_pace() {
  double sample_us = options_.sample_us;
  if (sample_us == 0.0) {
    sample_us = options_.protocol == Protocol::kRasterAscii ? kRasterSketchSampleUs
                                                            : published_sample_us(firmware_->sampler().config());
  }
  sample_ns_ = std::lround(sample_us * 1000.0);
  duration_ns_ = firmware_->sampler().frame_size() * sample_ns_;
  computing_ns_ = 0;
  const Output output = firmware_->active_output();
  if (output != Output::kSamples) {
    const double published_us = published_recovery_us(output, firmware_->models().model(),
                                                      firmware_->sampler().config(), firmware_->sampler().frame_size());
    computing_ns_ = std::lround(options_.recovery_us.value_or(published_us) * 1000.0);
  }
  board_->set_computing_ns(computing_ns_);
  step_ns_ = std::max(duration_ns_ + computing_ns_, std::int64_t{firmware_->settings().frame_period_us} * 1000);
}

void Process::run() {
  print_start();
  while (wait_for_frame()) {
    if (serve_terminal()) {
      send();
      continue;
    }
    const std::int64_t now = now_ns(CLOCK_MONOTONIC);
    const std::int64_t late_ns = time_.to_board_ns(now) - (start_ns_ + duration_ns_);
    if (late_ns > kCatchUpNs) {
      const std::int64_t skipped = late_ns / step_ns_;
      firmware_->skip_frames(static_cast<std::uint32_t>(skipped));
      start_ns_ += skipped * step_ns_;
    }
    board_->begin_frame(start_ns_, sample_ns_);
    firmware_->measure_frame();
    ++frames_;
    last_start_ns_ = start_ns_;
    start_ns_ += step_ns_;
    send();
    recover_frame();
    print_status_if_due(now);
  }
}

void Process::recover_frame() {
  if (firmware_->active_output() == Output::kSamples || !terminal_.open()) {
    return;
  }
  const std::int64_t done_ns = time_.to_host_ns(last_start_ns_ + duration_ns_ + computing_ns_);
  for (std::int64_t now = now_ns(CLOCK_MONOTONIC); now < done_ns && !ended(); now = now_ns(CLOCK_MONOTONIC)) {
    sleep_until(std::min(done_ns, now + kNapNs));
  }
  firmware_->recover_frame();
  send();
}

bool Process::ended() {
  if (stop_requested_ == 0 || stop_requested_ == SIGTERM) {
    return stop_requested_ != 0;
  }
  const std::int64_t now = now_ns(CLOCK_MONOTONIC);
  if (!ends_at_ns_) {
    ends_at_ns_ = now + kGoOnNs;
  }
  return now >= *ends_at_ns_;
}

bool Process::wait_for_frame() {
  while (!ended()) {
    const std::int64_t now = now_ns(CLOCK_MONOTONIC);
    notice_host();  // in pauses, too, when nobody hears what it says
    take_faults(now);
    if (!frozen_.empty()) {
      let_time_pass(now);
      print_status_if_due(now);
      std::int64_t wake_ns = now + kNapNs;
      for (const LastingFault& freeze : frozen_) {
        wake_ns = std::min(wake_ns, freeze.until_ns);
      }
      sleep_until(wake_ns);
      continue;
    }
    if (!field_->refresh(now)) {
      // As frozen: a board that sent frames of a dead world would tell the host of a touch that is none.
      stands_still_ = true;
      let_time_pass(now);
      print_status_if_due(now);
      sleep_until(now + kNapNs);
      continue;
    }
    if (stands_still_) {
      stands_still_ = false;
      let_time_pass(now);
    }
    const std::int64_t wake_ns = time_.to_host_ns(start_ns_ + duration_ns_);
    if (now >= wake_ns) {
      return true;
    }
    const std::int64_t nap_ns = link_.has_rest() ? kSendingNapNs : kNapNs;
    sleep_until(std::min(wake_ns, now + nap_ns));
    if (now + nap_ns < wake_ns) {
      print_status_if_due(now_ns(CLOCK_MONOTONIC));
      serve_terminal();
      send();
    }
  }
  return false;
}

void Process::let_time_pass(std::int64_t monotonic_ns) {
  start_ns_ = time_.to_board_ns(monotonic_ns);
  board_->begin_frame(start_ns_, sample_ns_);
  firmware_->keep_time();
}

bool Process::notice_host() {
  switch (terminal_.service()) {
    case PseudoTerminal::Event::kOpened:
      link_.clear();
      firmware_->start_stream();
      break;
    case PseudoTerminal::Event::kClosed: {
      const bool changed = hear_host();  // what a host says before it leaves counts as well
      link_.clear();
      firmware_->stop_stream();
      return changed;
    }
    case PseudoTerminal::Event::kNone:
      break;
  }
  return false;
}

bool Process::serve_terminal() {
  const bool changed = notice_host();
  return hear_host() || changed;
}

bool Process::hear_host() {
  constexpr int kMaxReads = 4;  // a host that floods the board must not keep it from measuring
  std::array<std::uint8_t, 4096> data{};
  bool heard = false;
  for (int i = 0; i < kMaxReads; ++i) {
    const std::size_t length = terminal_.read(data.data(), data.size());
    if (length == 0) {
      break;
    }
    firmware_->receive(data.data(), length);
    heard = true;
  }
  if (!heard) {
    return false;
  }
  const std::int64_t duration_ns = duration_ns_;
  const std::int64_t step_ns = step_ns_;
  set_pace();
  if (duration_ns_ == duration_ns && step_ns_ == step_ns) {
    return false;
  }
  // The frame under way is begun again with the new settings, at the new distance from the last one, but not in the
  // past: that would be made up for.
  start_ns_ = std::max(last_start_ns_ + step_ns_, time_.to_board_ns(now_ns(CLOCK_MONOTONIC)));
  return true;
}

void Process::send() {
  notice_host();  // what the last host was to get is none of one that has come meanwhile
  const std::int64_t now = now_ns(CLOCK_MONOTONIC);
  if (const std::optional<Fault> cut = link_.send(firmware_->output(), terminal_, now)) {
    cut_stream(*cut, now);
  }
}

}  // namespace acts
