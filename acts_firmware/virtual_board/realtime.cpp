// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "realtime.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>

namespace acts {

namespace {

constexpr rlim_t kUnbrokenUs = 1'000'000;
constexpr rlim_t kLastResortUs = 3'000'000;

constexpr char kGivenUp[] =
    "virtual_board: computed for 1 s without a sleep under SCHED_FIFO: the ordinary scheduler has it now, until it is "
    "started anew\n";

// Comes in the very thread that runs away. Nothing but system calls: anything may be under way.
void give_up(int /*signal*/) {
  const int error = errno;
  const sched_param ordinary{};
  sched_setscheduler(0, SCHED_OTHER, &ordinary);
  const ssize_t written = write(STDERR_FILENO, kGivenUp, sizeof(kGivenUp) - 1);
  static_cast<void>(written);
  errno = error;
}

// RLIMIT_RTTIME: the time since the last sleep. The signal comes at the soft limit, the end at the hard one.
void limit_unbroken_runs() {
  struct sigaction action{};
  action.sa_handler = give_up;
  action.sa_flags = SA_RESTART;
  sigaction(SIGXCPU, &action, nullptr);
  rlimit limit{};
  getrlimit(RLIMIT_RTTIME, &limit);
  limit.rlim_cur = std::min(limit.rlim_cur, kUnbrokenUs);
  limit.rlim_max = std::min(limit.rlim_max, kLastResortUs);
  setrlimit(RLIMIT_RTTIME, &limit);
}

cpu_set_t own_cores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  sched_getaffinity(0, sizeof(cores), &cores);
  return cores;
}

int core(const std::string& text, const std::string& digits, const cpu_set_t& allowed) {
  constexpr std::size_t kMaxDigits = 5;
  const bool is_number =
      !digits.empty() && digits.size() <= kMaxDigits &&
      std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  const int number = is_number ? std::stoi(digits) : -1;
  if (number < 0 || number >= CPU_SETSIZE || !CPU_ISSET(static_cast<std::size_t>(number), &allowed)) {
    std::string known;
    for (int i = 0; i < CPU_SETSIZE; ++i) {
      known += CPU_ISSET(static_cast<std::size_t>(i), &allowed) ? " " + std::to_string(i) : "";
    }
    throw std::invalid_argument(text + ": allowed are cores and ranges, as in 0,2-3, of this process's own:" + known);
  }
  return number;
}

std::string set_priority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) {
    return "";
  }
  const int error = errno;
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  if (error == EPERM && limit.rlim_cur < static_cast<rlim_t>(priority)) {
    return "no more than priority " + std::to_string(limit.rlim_cur) + " is allowed and " + std::to_string(priority) +
           " is asked for (`ulimit -r`); `acts doctor` tells the command that mends it";
  }
  return std::string("the kernel refuses SCHED_FIFO (") + std::strerror(error) + "); `acts doctor` tells more";
}

std::string set_cores(const std::vector<int>& cores) {
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  for (const int number : cores) {
    CPU_SET(static_cast<std::size_t>(number), &wanted);
  }
  return sched_setaffinity(0, sizeof(wanted), &wanted) == 0
             ? ""
             : std::string("it cannot be bound to its cores (") + std::strerror(errno) + ")";
}

// struct sched_attr of the kernel; the C library has it only since glibc 2.41.
struct SchedulingAttributes {
  std::uint32_t size;
  std::uint32_t policy;
  std::uint64_t flags;
  std::int32_t nice;
  std::uint32_t priority;
  std::uint64_t runtime_ns;
  std::uint64_t deadline_ns;
  std::uint64_t period_ns;
};

// As acts_core/runtime/scheduling/time_slices.py, which says why.
void shorten_time_slice() {
  constexpr std::uint64_t kShortestNs = 100'000;
  SchedulingAttributes attributes{};
  if (syscall(SYS_sched_getattr, 0, &attributes, sizeof(attributes), 0) == 0 &&
      (attributes.policy == SCHED_OTHER || attributes.policy == SCHED_BATCH)) {
    attributes.runtime_ns = kShortestNs;
    syscall(SYS_sched_setattr, 0, &attributes, 0);
  }
}

}  // namespace

std::vector<int> parse_cores(const std::string& text) {
  const cpu_set_t allowed = own_cores();
  std::vector<int> cores;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    part.erase(std::remove(part.begin(), part.end(), ' '), part.end());
    if (part.empty()) {
      continue;
    }
    const std::size_t dash = part.find('-');
    const int first = core(text, part.substr(0, dash), allowed);
    const int last = dash == std::string::npos ? first : core(text, part.substr(dash + 1), allowed);
    if (last < first) {
      throw std::invalid_argument(text + ": " + part + " is no range");
    }
    for (int number = first; number <= last; ++number) {
      cores.push_back(core(text, std::to_string(number), allowed));
    }
  }
  return cores;
}

std::string enter_realtime(const Realtime& wanted) {
  std::string done;
  std::string problems;
  const auto note = [&done, &problems](const std::string& words, const std::string& problem) {
    if (!words.empty()) {
      done += (done.empty() ? "" : ", ") + words;
    }
    problems += problem.empty() ? "" : "; " + problem;
  };
  shorten_time_slice();
  if (wanted.priority > 0) {
    limit_unbroken_runs();
    const std::string problem = set_priority(wanted.priority);
    note(problem.empty() ? "SCHED_FIFO priority " + std::to_string(wanted.priority) : "ordinary scheduler", problem);
  }
  if (!wanted.cores.empty()) {
    std::string list;
    for (const int number : wanted.cores) {
      list += (list.empty() ? "" : ",") + std::to_string(number);
    }
    const std::string problem = set_cores(wanted.cores);
    note(problem.empty() ? "cores " + list : "any core", problem);
  }
  return done + problems;
}

}  // namespace acts
