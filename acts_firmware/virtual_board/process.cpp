#include "process.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "field.hpp"
#include "published_timing.hpp"

namespace acts {

namespace {

constexpr std::int64_t kCatchUpNs = 250'000'000;  // later than this, frames are skipped
constexpr std::int64_t kNapNs = 50'000'000;       // the terminal is looked after at least this often

std::string json_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
    }
    quoted += c;
  }
  return quoted + "\"";
}

std::unique_ptr<Field> make_field(const Options& options, std::int64_t start_ns) {
  const SamplingConfig& sampling = options.sampling;
  if (!options.recording.empty()) {
    return open_recording(options.recording, sampling.rows, sampling.cols, options.recording_rate_hz, options.loop,
                          start_ns);
  }
  if (!options.field_ring.empty()) {
    return watch_ring(options.field_ring, static_cast<std::size_t>(sampling.rows * sampling.cols));
  }
  return std::make_unique<UntouchedField>();
}

}  // namespace

Process::Process(const Options& options, const volatile std::sig_atomic_t& stop_requested)
    : options_(options),
      stop_requested_(stop_requested),
      epoch_(read_epoch()),
      time_(epoch_.monotonic_ns, options.drift_ppm),
      board_(options.sampling.rows, options.sampling.cols, make_field(options, epoch_.monotonic_ns), time_,
             options.noise_counts, options.sampling.seed),
      firmware_(board_, wiring_for(options.sampling.rows, options.sampling.cols), options.protocol),
      terminal_(options.link) {
  board_.set_faults(options.wiring_faults);
  firmware_.configure(options.sampling);
  set_pace();
}

void Process::set_pace() {
  double sample_us = options_.sample_us;
  if (sample_us == 0.0) {
    sample_us = options_.protocol == Protocol::kRasterAscii ? kRasterSketchSampleUs
                                                            : published_sample_us(firmware_.sampler().config());
  }
  sample_ns_ = std::lround(sample_us * 1000.0);
  duration_ns_ = firmware_.sampler().frame_size() * sample_ns_;
  step_ns_ = std::max(duration_ns_, static_cast<std::int64_t>(std::lround(1e9 / options_.rate_hz)));
}

void Process::run() {
  print_start();
  std::int64_t start_ns = 0;
  std::int64_t next_status_ns = status_period_ns();
  while (wait_for(start_ns + duration_ns_)) {
    const std::int64_t late_ns = time_.to_board_ns(now_ns(CLOCK_MONOTONIC)) - (start_ns + duration_ns_);
    if (late_ns > kCatchUpNs) {
      const std::int64_t skipped = late_ns / step_ns_;
      firmware_.skip_frames(static_cast<std::uint32_t>(skipped));
      start_ns += skipped * step_ns_;
    }
    serve_terminal();
    board_.begin_frame(start_ns, sample_ns_, firmware_.sampler().frame_size());
    firmware_.measure_frame();
    ++frames_;
    send();
    if (next_status_ns > 0 && start_ns >= next_status_ns) {
      print_status();
      next_status_ns += status_period_ns();
    }
    start_ns += step_ns_;
  }
}

bool Process::wait_for(std::int64_t board_ns) {
  const std::int64_t wake_ns = time_.to_host_ns(board_ns);
  for (std::int64_t now = now_ns(CLOCK_MONOTONIC); now < wake_ns && stop_requested_ == 0;
       now = now_ns(CLOCK_MONOTONIC)) {
    sleep_until(std::min(wake_ns, now + kNapNs));
    if (now + kNapNs < wake_ns) {
      serve_terminal();
      send();
    }
  }
  return stop_requested_ == 0;
}

void Process::serve_terminal() {
  switch (terminal_.service()) {
    case PseudoTerminal::Event::kOpened:
      firmware_.start_stream();
      break;
    case PseudoTerminal::Event::kClosed:
      firmware_.stop_stream();
      break;
    case PseudoTerminal::Event::kNone:
      break;
  }
}

void Process::send() {
  TransmitQueue& output = firmware_.output();
  while (output.size() > 0) {
    const TransmitQueue::Piece piece = output.front();
    const std::size_t taken = terminal_.write(piece.data, piece.length);
    output.pop(taken);
    if (taken < piece.length) {
      return;  // the rest goes first next time
    }
  }
}

std::int64_t Process::status_period_ns() const {
  return static_cast<std::int64_t>(options_.status_period_s * 1e9);
}

void Process::print_start() const {
  if (!options_.print_status) {
    return;
  }
  const SamplingConfig& sampling = options_.sampling;
  std::ostringstream line;
  line << "{\"link\": " << json_text(options_.link) << ", \"port\": " << json_text(terminal_.port())
       << ", \"pid\": " << getpid() << ", \"epoch_realtime_ns\": " << epoch_.realtime_ns
       << ", \"epoch_monotonic_ns\": " << epoch_.monotonic_ns << ", \"drift_ppm\": " << options_.drift_ppm
       << ", \"rows\": " << sampling.rows << ", \"cols\": " << sampling.cols << ", \"scheme\": \""
       << name_of(sampling.scheme) << "\", \"m\": " << sampling.m
       << ", \"frame_period_us\": " << static_cast<double>(step_ns_) / 1000.0 << "}";
  std::cout << line.str() << std::endl;
}

void Process::print_status() const {
  std::cout << "{\"frames\": " << frames_ << ", \"overruns\": " << firmware_.overruns()
            << ", \"connected\": " << (terminal_.open() ? "true" : "false") << "}" << std::endl;
}

}  // namespace acts
