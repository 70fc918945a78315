// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "faults.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace acts {

namespace {

struct KindInfo {
  FaultKind kind;
  const char* name;
  const char* unit;
  double minimum;
  double maximum;
  double usual;  // where no value is given
  bool is_whole;
  const char* help;
};

constexpr double kLongestS = 3600.0;
constexpr double kMost = 1e6;
constexpr double kLatestS = 1e9;

const std::vector<KindInfo>& kinds() {
  static const std::vector<KindInfo> kKinds = {
      {FaultKind::kUnplug, "unplug", "S", 0.0, kLongestS, 1.0, false,
       "port and link gone for S seconds, from the middle of a packet on; back under another name"},
      {FaultKind::kReset, "reset", "S", 0.0, kLongestS, 0.0, false,
       "board starts anew in the middle of a packet; its port is gone for S seconds, with 0 it stays"},
      {FaultKind::kStall, "stall", "S", 0.0, kLongestS, 0.1, false,
       "link silent for S seconds from the middle of a packet on, while the board measures; then it catches up"},
      {FaultKind::kFreeze, "freeze", "S", 0.0, kLongestS, 0.1, false,
       "board does nothing for S seconds; its clock goes on, its sequence does not"},
      {FaultKind::kJump, "jump", "S", -kLongestS, kLongestS, 1.0, false, "board's clock jumps by S seconds"},
      {FaultKind::kGarbage, "garbage", "N", 1.0, kMost, 100.0, true, "N random bytes before a packet"},
      {FaultKind::kFlip, "flip", "N", 1.0, kMost, 1.0, true, "N random bits of a packet turned over"},
      {FaultKind::kFlipRate, "flip-rate", "P", 0.0, 1.0, 1e-4, false,
       "from now on each bit is turned over with probability P; 0 ends it"},
      {FaultKind::kDrop, "drop", "N", 1.0, kMost, 1.0, true, "N frames do not arrive"},
      {FaultKind::kDouble, "double", "N", 1.0, kMost, 1.0, true, "N frames arrive twice"},
      {FaultKind::kTruncate, "truncate", "N", 1.0, kMost, 1.0, true, "N frames end early, each anywhere"},
      {FaultKind::kLose, "lose", "N", 1.0, kMost, 10.0, true,
       "N bytes in a row do not arrive, from the middle of a packet on, delimiters included"},
      {FaultKind::kVersion, "version", "V", 0.0, 255.0, 2.0, true,
       "from now on packets are of version V, with a right CRC; 1 ends it"},
  };
  return kKinds;
}

std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool whole_text = !text.empty() && end == text.c_str() + text.size();
  return whole_text && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

}  // namespace

Fault parse_fault(const std::string& text) {
  const std::size_t at = text.find('@');
  const std::string fault = text.substr(0, at);
  const std::size_t colon = fault.find(':');
  const std::string name = fault.substr(0, colon);
  std::string names;
  for (const KindInfo& info : kinds()) {
    names += (names.empty() ? "" : ", ") + std::string(info.name);
    if (name != info.name) {
      continue;
    }
    const std::optional<double> value = colon == std::string::npos ? info.usual : number(fault.substr(colon + 1));
    if (!value || *value < info.minimum || *value > info.maximum || (info.is_whole && *value != std::floor(*value))) {
      std::ostringstream allowed;
      allowed << fault << ": allowed is a " << (info.is_whole ? "whole " : "") << "number " << info.unit << " from "
              << std::lround(info.minimum) << " to " << std::lround(info.maximum);
      throw FaultError(allowed.str());
    }
    const std::optional<double> due_s = at == std::string::npos ? 0.0 : number(text.substr(at + 1));
    if (!due_s || *due_s < 0.0 || *due_s > kLatestS) {
      throw FaultError(text + ": the time after @ is in seconds since the start, 0 to 1000000000");
    }
    return {info.kind, *value, static_cast<std::int64_t>(*due_s * 1e9), fault};
  }
  throw FaultError("unknown fault '" + name + "'; allowed are " + names);
}

std::string fault_help() {
  std::string text;
  for (const KindInfo& info : kinds()) {
    std::string left = std::string("  ") + info.name + ":" + info.unit;
    left.resize(26, ' ');
    text += left + info.help + "\n";
  }
  return text;
}

void FaultPlan::add(const Fault& fault) {
  // Before those that are due at the same time, so that they are taken in the order in which they came.
  const auto place = std::lower_bound(faults_.begin(), faults_.end(), fault,
                                      [](const Fault& a, const Fault& b) { return a.due_ns > b.due_ns; });
  faults_.insert(place, fault);
}

std::optional<Fault> FaultPlan::take(std::int64_t since_start_ns) {
  if (faults_.empty() || faults_.back().due_ns > since_start_ns) {
    return std::nullopt;
  }
  Fault fault = faults_.back();
  faults_.pop_back();
  return fault;
}

}  // namespace acts
