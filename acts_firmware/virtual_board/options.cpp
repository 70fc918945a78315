// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "options.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <utility>
#include <vector>

namespace acts {

namespace {

// Smaller shares would all mean the same: one taxel of even the largest array.
constexpr double kMinShare = 0.0001;

constexpr int kMaxPriority = 99;

struct Option {
  std::string name;
  const char* value;  // what stands for the value in the help; empty for a switch
  std::string help;
  std::function<void(const std::string&)> set;
};

std::string shortest(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

double number(const std::string& name, const std::string& text, double minimum, double maximum) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value) || value < minimum || value > maximum) {
    throw OptionError(name + " " + text + ": allowed is a number from " + shortest(minimum) + " to " +
                      shortest(maximum));
  }
  return value;
}

int whole(const std::string& name, const std::string& text, int minimum, int maximum) {
  char* end = nullptr;
  errno = 0;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || errno != 0 || value < minimum || value > maximum) {
    throw OptionError(name + " " + text + ": allowed is a whole number from " + std::to_string(minimum) + " to " +
                      std::to_string(maximum));
  }
  return static_cast<int>(value);
}

// Decimal, or hexadecimal after 0x.
std::uint64_t whole64(const std::string& name, const std::string& text) {
  char* end = nullptr;
  errno = 0;
  // Not base 0, of which 010 would be 8; nor a sign or blanks, of which strtoull makes -1 the largest number.
  const bool hexadecimal = text.rfind("0x", 0) == 0 || text.rfind("0X", 0) == 0;
  const unsigned long long value = std::strtoull(text.c_str(), &end, hexadecimal ? 16 : 10);
  if (std::isdigit(static_cast<unsigned char>(text[0])) == 0 || *end != '\0' || errno != 0) {
    throw OptionError(name + " " + text + ": allowed is a whole number from 0 to 18446744073709551615");
  }
  return value;
}

template <typename T>
T word(const std::string& name, const std::string& text, const std::vector<std::pair<const char*, T>>& words) {
  std::string allowed;
  for (const auto& [known, value] : words) {
    if (text == known) {
      return value;
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string(known);
  }
  throw OptionError(name + " " + text + ": allowed is one of " + allowed);
}

// What a fault refuses, as an option's error.
void named(const std::string& name, const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& error) {
    throw OptionError(name + " " + error.what());
  }
}

std::string path_or_none(const std::string& text) {
  return text == "none" ? "" : text;
}

std::vector<std::pair<const char*, Scheme>> schemes() {
  std::vector<std::pair<const char*, Scheme>> words;
  for (const SchemeInfo& info : Schemes::kInfos) {
    words.emplace_back(info.name, info.number);
  }
  return words;
}

std::string scheme_names() {
  std::string names;
  for (const SchemeInfo& info : Schemes::kInfos) {
    names += (names.empty() ? "" : ", ") + std::string(info.name);
  }
  return names;
}

// search_share: --search-share
std::string option_name(const char* setting) {
  std::string name = std::string("--") + setting;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

Option own_option(Options& o, const OwnSetting& setting) {
  if (setting.is_share()) {
    const std::string name = option_name(setting.share_name);
    double& share = o.shares[setting.place()];
    return {name, "F", std::string(setting.share_description) + " (" + shortest(setting.share_initial) + ")",
            [&share, name](const std::string& v) { share = number(name, v, kMinShare, 1.0); }};
  }
  const std::string name = option_name(setting.name);
  return {name, "N", std::string(setting.description) + " (" + std::to_string(setting.initial) + ")",
          [&o, setting, name](const std::string& v) {
            o.sampling.set_own(setting, whole(name, v, setting.minimum, setting.maximum));
          }};
}

std::vector<Option> common_options(Options& o) {
  SamplingConfig& s = o.sampling;
  return {
      {"--link", "PATH", "symbolic link to the pseudo-terminal, made at the start and removed at the end",
       [&o](const std::string& v) { o.link = path_or_none(v); }},
      {"--field-ring", "PATH", "pressure field of a simulated world (acts_sim/shared/timed_ring.py); none: no world",
       [&o](const std::string& v) { o.field_ring = path_or_none(v); }},
      {"--recording", "FILE.npy", "play frames (n, rows, cols) uint16 instead of the world; none: no recording",
       [&o](const std::string& v) { o.recording = path_or_none(v); }},
      {"--recording-rate-hz", "R", "frames per second of the recording (1000)",
       [&o](const std::string& v) { o.recording_rate_hz = number("--recording-rate-hz", v, 0.001, 1e6); }},
      {"--loop", "", "start the recording over at its end; without, its last frame is held",
       [&o](const std::string&) { o.loop = true; }},
      {"--rows", "N", "rows of the array, 1 to 64 (32)",
       [&s](const std::string& v) { s.rows = whole("--rows", v, 1, kMaxSide); }},
      {"--cols", "N", "columns of the array, 1 to 64 (32)",
       [&s](const std::string& v) { s.cols = whole("--cols", v, 1, kMaxSide); }},
      {"--scheme", "NAME", scheme_names() + " (" + name_of(s.scheme) + ")",
       [&s](const std::string& v) { s.scheme = word<Scheme>("--scheme", v, schemes()); }},
      {"--m", "M", "taxels measured per frame (55); raster measures all",
       [&s](const std::string& v) { s.m = whole("--m", v, 1, kMaxTaxels); }},
      {"--rate-hz", "R", "largest number of frames per second (1000)",
       [&o](const std::string& v) { o.rate_hz = number("--rate-hz", v, 1.0, 1e5); }},
      {"--sample-us", "T", "time of one measurement in microseconds (as published for the scheme and M)",
       [&o](const std::string& v) { o.sample_us = number("--sample-us", v, 0.1, 1000.0); }},
      {"--recovery-us", "T", "time of recovery or classification of a frame in microseconds (as published)",
       [&o](const std::string& v) { o.recovery_us = number("--recovery-us", v, 0.0, 1e6); }},
      {"--threshold", "COUNTS",
       "counts above which adaptive and hybrid search a taxel's neighbours and tracking follows it (180)",
       [&s](const std::string& v) { s.threshold = whole("--threshold", v, 0, kCountMax); }},
      {"--neighbour-order", "ORDER", "of that search: columns or rows (columns)",
       [&s](const std::string& v) {
         s.neighbour_order = word<NeighbourOrder>(
             "--neighbour-order", v, {{"columns", NeighbourOrder::kColumns}, {"rows", NeighbourOrder::kRows}});
       }},
      {"--noise-counts", "S", "standard deviation of the noise in counts (1.5)",
       [&o](const std::string& v) { o.noise_counts = number("--noise-counts", v, 0.0, 1000.0); }},
      {"--seed", "N", "of the noise and of random and hybrid sampling (1)",
       [&s](const std::string& v) { s.seed = whole64("--seed", v); }},
      {"--drift-ppm", "D", "how much faster the board's clock runs than the host's, in millionths (0)",
       [&o](const std::string& v) { o.drift_ppm = number("--drift-ppm", v, -10000.0, 10000.0); }},
      {"--hardware-fault", "FAULT",
       "break the wiring: open-row=R, open-col=C, short-rows=R,R, short-cols=C,C, dead=R,C, stuck=R,C,COUNTS or "
       "address-bit=B; may be given again",
       [&o](const std::string& v) { named("--hardware-fault", [&o, &v] { o.wiring_faults.add(v); }); }},
      {"--board-id", "N", "the board's serial number, in decimal or as 0x... (0x4143545300000001)",
       [&o](const std::string& v) { o.board_id = whole64("--board-id", v); }},
      {"--protocol", "NAME", "binary, or raster_ascii: the authors' raster sketch (binary)",
       [&o](const std::string& v) {
         o.protocol =
             word<Protocol>("--protocol", v, {{"binary", Protocol::kBinary}, {"raster_ascii", Protocol::kRasterAscii}});
       }},
      {"--fault", "FAULT", "a fault at a time, KIND[:VALUE][@SECONDS]; may be given again and again",
       [&o](const std::string& v) { named("--fault", [&o, &v] { o.faults.push_back(parse_fault(v)); }); }},
      {"--control", "PATH", "named pipe to which faults can be written at any time, a line each; none: no pipe",
       [&o](const std::string& v) { o.control = path_or_none(v); }},
      {"--print-status", "", "print a line of JSON at the start (link, port, time of board time 0) and for every fault",
       [&o](const std::string&) { o.print_status = true; }},
      {"--status-period-s", "T", "print another such line with frames and overruns every T seconds (0: never)",
       [&o](const std::string& v) { o.status_period_s = number("--status-period-s", v, 0.0, 1e6); }},
      {"--realtime-priority", "N",
       "run under SCHED_FIFO with this priority, 1 to 99, where the limits allow it (0: do not)",
       [&o](const std::string& v) { o.realtime.priority = whole("--realtime-priority", v, 0, kMaxPriority); }},
      {"--cpu-affinity", "CORES", "cores to run on, as in 2 or 0,2-3; none: any",
       [&o](const std::string& v) {
         named("--cpu-affinity", [&o, &v] { o.realtime.cores = parse_cores(path_or_none(v)); });
       }},
      {"--help", "", "print this and stop", [&o](const std::string&) { o.help = true; }},
  };
}

std::vector<Option> make_options(Options& o) {
  std::vector<Option> options = common_options(o);
  for (const OwnSetting& setting : kAllOwnSettings) {
    options.insert(options.end() - 1, own_option(o, setting));  // the last is --help
  }
  return options;
}

void check_own_settings(const SamplingConfig& sampling, const std::string& size) {
  const SettingField refused = check(sampling);
  for (const OwnSetting& setting : scheme_info(sampling.scheme)->own_settings) {
    if (setting.number != 0 && refused == static_cast<SettingField>(setting.number)) {
      throw OptionError(option_name(setting.name) + " " + std::to_string(sampling.own(setting)) +
                        ": there is none in an array of " + size);
    }
  }
}

void check_sampling(const Options& options) {
  const SamplingConfig& sampling = options.sampling;
  const std::string size = std::to_string(sampling.rows) + " x " + std::to_string(sampling.cols);
  const int taxels = sampling.rows * sampling.cols;
  if (sampling.m > taxels) {
    throw OptionError("--m " + std::to_string(sampling.m) + ": an array of " + size + " has " + std::to_string(taxels) +
                      " taxels");
  }
  if (Schemes::takes(sampling.scheme, sampling.rows, sampling.cols, sampling.m)) {
    check_own_settings(sampling, size);
    return;
  }
  std::string possible;
  for (int m = 1; m <= taxels; ++m) {
    if (Schemes::takes(sampling.scheme, sampling.rows, sampling.cols, m)) {
      possible += " " + std::to_string(m);
    }
  }
  throw OptionError("--m " + std::to_string(sampling.m) + ": no " + name_of(sampling.scheme) + " frame of " + size +
                    " has so many taxels; allowed are" + possible);
}

}  // namespace

Options parse_options(int argc, const char* const* argv) {
  Options options;
  const std::vector<Option> known = make_options(options);
  for (int i = 1; i < argc && std::string(argv[i]) != "--ros-args"; ++i) {
    std::string name = argv[i];
    const std::size_t equals = name.find('=');
    const bool joined = equals != std::string::npos;
    const std::string joined_value = joined ? name.substr(equals + 1) : "";
    name = name.substr(0, equals);

    const Option* option = nullptr;
    for (const Option& candidate : known) {
      option = name == candidate.name ? &candidate : option;
    }
    if (option == nullptr) {
      throw OptionError("unknown option " + name + "; --help lists what there is");
    }
    const bool takes_value = option->value[0] != '\0';
    if (joined && !takes_value) {
      throw OptionError(name + " takes no value");
    }
    if (!takes_value || joined) {
      option->set(joined_value);
    } else if (i + 1 < argc && std::string(argv[i + 1]) != "--ros-args") {
      option->set(argv[++i]);
    } else {
      throw OptionError(name + " needs a value: " + option->help);
    }
  }
  if (options.protocol == Protocol::kRasterAscii) {
    options.sampling.scheme = Raster::kInfo.number;
  }
  options.sampling.m = options.sampling.frame_size();
  for (const OwnSetting& setting : kAllOwnSettings) {
    if (setting.is_share()) {
      options.sampling.set_own(setting, quota_of(options.shares[setting.place()], options.sampling.m));
    }
  }
  check_sampling(options);
  named("--hardware-fault", [&options] { options.wiring_faults.check(options.sampling.rows, options.sampling.cols); });
  return options;
}

std::string help_text() {
  Options options;
  std::string text =
      "virtual_board: the ACTS firmware on the host, behind a pseudo-terminal.\n"
      "usage: virtual_board [options] [--ros-args ...]   (what follows --ros-args is left alone)\n";
  for (const Option& option : make_options(options)) {
    std::string left = "  " + option.name + " " + option.value;
    left.resize(left.size() < 26 ? 26 : left.size() + 1, ' ');
    text += left + option.help + "\n";
  }
  return text + "faults:\n" + fault_help();
}

const char* name_of(Scheme scheme) {
  const SchemeInfo* info = scheme_info(scheme);
  return info != nullptr ? info->name : "unknown";
}

Shares initial_shares() {
  Shares shares{};
  for (const OwnSetting& setting : kAllOwnSettings) {
    shares[setting.place()] = setting.share_initial;
  }
  return shares;
}

}  // namespace acts
