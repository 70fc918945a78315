// A process around the firmware: pseudo-terminal, pace, status. docs/virtual_board.md describes it.
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <ctime>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>

#include "acts_firmware/firmware.hpp"
#include "field.hpp"
#include "options.hpp"
#include "pseudo_terminal.hpp"
#include "virtual_board.hpp"

namespace acts {

namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;
constexpr std::int64_t kCatchUpNs = 250'000'000;  // later than this, frames are skipped
constexpr std::int64_t kNapNs = 50'000'000;       // the terminal is looked after at least this often

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int /*signal*/) {
  stop_requested = 1;
}

std::int64_t now_ns(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * kNsPerS + time.tv_nsec;
}

void sleep_until(std::int64_t monotonic_ns) {
  timespec time{};
  time.tv_sec = monotonic_ns / kNsPerS;
  time.tv_nsec = monotonic_ns % kNsPerS;
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);  // a signal ends it early
}

struct Epoch {
  std::int64_t monotonic_ns;
  std::int64_t realtime_ns;
};

Epoch read_epoch() {
  const std::int64_t before = now_ns(CLOCK_MONOTONIC);
  const std::int64_t realtime = now_ns(CLOCK_REALTIME);
  const std::int64_t after = now_ns(CLOCK_MONOTONIC);
  return {before + (after - before) / 2, realtime};
}

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

// Frame after frame at its own virtual time; the process wakes once a frame, at its end.
class Process {
 public:
  explicit Process(const Options& options)
      : options_(options),
        epoch_(read_epoch()),
        time_(epoch_.monotonic_ns, options.drift_ppm),
        sample_ns_(std::lround(options.sample_us * 1000.0)),
        board_(options.sampling.rows, options.sampling.cols, make_field(options, epoch_.monotonic_ns), time_,
               sample_ns_, options.noise_counts, options.sampling.seed),
        firmware_(board_, wiring_for(options.sampling.rows, options.sampling.cols), options.protocol),
        terminal_(options.link) {
    firmware_.configure(options.sampling);
    duration_ns_ = firmware_.sampler().frame_size() * sample_ns_;
    step_ns_ = std::max(duration_ns_, static_cast<std::int64_t>(std::lround(1e9 / options.rate_hz)));
  }

  void run() {
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
      board_.begin_frame(start_ns, start_ns + duration_ns_);
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

 private:
  // False when the process is to end.
  bool wait_for(std::int64_t board_ns) {
    const std::int64_t wake_ns = time_.to_host_ns(board_ns);
    for (std::int64_t now = now_ns(CLOCK_MONOTONIC); now < wake_ns && stop_requested == 0;
         now = now_ns(CLOCK_MONOTONIC)) {
      sleep_until(std::min(wake_ns, now + kNapNs));
      if (now + kNapNs < wake_ns) {
        serve_terminal();
        send();
      }
    }
    return stop_requested == 0;
  }

  void serve_terminal() {
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

  void send() {
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

  std::int64_t status_period_ns() const { return static_cast<std::int64_t>(options_.status_period_s * 1e9); }

  void print_start() const {
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

  void print_status() const {
    std::cout << "{\"frames\": " << frames_ << ", \"overruns\": " << firmware_.overruns()
              << ", \"connected\": " << (terminal_.open() ? "true" : "false") << "}" << std::endl;
  }

  const Options options_;
  const Epoch epoch_;
  const BoardTime time_;
  const std::int64_t sample_ns_;
  VirtualBoard board_;
  Firmware firmware_;
  PseudoTerminal terminal_;
  std::int64_t duration_ns_ = 0;
  std::int64_t step_ns_ = 0;
  std::uint64_t frames_ = 0;
};

void install_signals() {
  struct sigaction action{};
  action.sa_handler = request_stop;  // without SA_RESTART: ends the sleep
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
}

}  // namespace

}  // namespace acts

int main(int argc, char** argv) {
  try {
    const acts::Options options = acts::parse_options(argc, argv);
    if (options.help) {
      std::cout << acts::help_text();
      return 0;
    }
    acts::install_signals();
    prctl(PR_SET_TIMERSLACK, 1000UL);  // wake within a microsecond or so of the time asked for, not fifty
    std::make_unique<acts::Process>(options)->run();
    return 0;
  } catch (const acts::OptionError& error) {
    std::cerr << "virtual_board: " << error.what() << std::endl;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "virtual_board: " << error.what() << std::endl;
    return 1;
  }
}
